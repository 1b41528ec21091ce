"""Accepted and refused arguments: points, boxes, rays, tuples and arrays."""

import warnings

import numpy as np
import pytest

import leafless as lf

BALL = lf.Csg.ball([0, 0, 0], 1)

masked = np.ma.masked_array

#: Values that are not three numbers, for any layout of axes.
NO_NUMBERS = {
    "complex": [1 + 2j, 0, 0],
    "none": [None, 0, 0],
    "text": ["1", "2", "3"],
    "object": np.array([1, 2, object()]),
    "date": np.array(["2020-01-01"] * 3, "M8[D]"),
    "masked": masked([1.0, 2.0, 3.0], [False, True, False]),
    "masked number": [1.0, np.ma.masked, 3.0],
    "uneven": [[1, 2], 3, 4],
}

#: Functions that take points, boxes, directions, placements and numbers, called with three numbers.
TAKERS = {
    "contains one": lambda three: BALL.contains(three),
    "contains many": lambda three: BALL.contains([three, three]),
    "contains an array": lambda three: BALL.contains(np.ma.asarray(three)[None] if np.ma.is_masked(three) else [three]),
    "distances": lambda three: BALL.distances([three]),
    "origins": lambda three: BALL.rays(three, [1, 0, 0]),
    "directions": lambda three: BALL.rays([0, 0, 0], three),
    "cuboid": lambda three: lf.Csg.cuboid([-9, -9, -9], three),
    "half-space": lambda three: lf.Csg.half_space(three, 1),
    "frame": lambda three: lf.Frame(three, 1, 3),
    "bounds": lambda three: lf.Frame.around([[-9, -9, -9], three]),
    "translation": lambda three: lf.Affine.translation(three),
    "scale": lambda three: lf.Affine.scale(three),
    "map": lambda three: lf.Affine.identity()(three),
    "box": lambda three: lf.build(BALL, depth=3).classify_box([three, [9, 9, 9]]),
    "vertices": lambda three: lf.Mesh([three, [0, 0, 0], [1, 0, 0]], [[0, 1, 2]]),
    "lazy points": lambda three: lf.LazyOctree(BALL).contains(three),
    "lazy ray": lambda three: lf.LazyOctree(BALL).refine(2, ray=(three, [1, 0, 0])),
    "eye": lambda three: lf.build(BALL, depth=3).voxels().depth_order(three),
    "values": lambda three: lf.Channel.fill(three, frame=lf.Frame([0, 0, 0], 1, 1)),
    "plane": lambda three: lf.render(BALL, size=(8, 8), slice=[*three, 0]),
    "quadric": lambda three: lf.Csg.quadric([*three, 0, 0, 0, 0, 0, 0, 1]),
}


@pytest.mark.parametrize("taker", TAKERS)
@pytest.mark.parametrize("wrong", NO_NUMBERS)
def test_what_is_no_number_is_refused(taker, wrong):
    with warnings.catch_warnings():
        # NumPy warns when it drops an imaginary part. It turns a masked number in a list of lists into NaN.
        warnings.simplefilter("error")
        with pytest.raises((TypeError, ValueError, UserWarning)):
            TAKERS[taker](NO_NUMBERS[wrong])


@pytest.mark.parametrize("taker", TAKERS)
@pytest.mark.parametrize("kind", [float, np.float32, np.int8, np.uint64, np.longdouble])
def test_numbers_of_all_kinds_are_taken(taker, kind):
    three = np.array([1, 2, 3], kind)
    for given in (three, three.tolist(), tuple(three), masked(three), three.astype(kind, order="F")):
        TAKERS[taker](given)


def test_the_messages_name_the_argument():
    with pytest.raises(lf.ArgumentError, match="^points: must be an array of real numbers, not of complex128$"):
        BALL.contains(NO_NUMBERS["complex"])
    with pytest.raises(lf.ArgumentError, match="^points: must have no masked elements"):
        BALL.contains(masked(np.zeros((4, 3)), np.eye(4, 3)))
    with pytest.raises(lf.ArgumentError, match="^points: must be an array of real numbers, not of object$"):
        BALL.contains(np.array([1, 2, 3], object))
    with pytest.raises(lf.ArgumentError, match="^array: must have no masked elements"):
        lf.Volume(masked(np.zeros((2, 2, 2), np.uint8), np.ones((2, 2, 2))))


@pytest.mark.parametrize(
    "name, wrong",
    [
        ("codes", [0, -1]),
        ("codes", [0.0, 1.0]),
        ("codes", [0, None]),
        ("codes", [0j, 1j]),
        ("codes", masked([0, 1], [False, True])),
        ("levels", [1, 257]),
        ("levels", [1, -255]),
        ("levels", ["1", "1"]),
        ("kinds", [1, 256 + 1]),
        ("kinds", [True, False]),
        ("values", [1, None]),
        ("values", [1, 2j]),
    ],
)
def test_records_are_not_truncated(name, wrong):
    arrays = {"codes": [0, 1], "levels": [1, 1], "kinds": [1, 1], "values": [0.5, np.nan]}
    frame = lf.Frame([0, 0, 0], 2, 1)
    assert len(lf.VoxelRecords(frame, **arrays)) == 2
    assert len(lf.VoxelRecords(frame, **{**arrays, "kinds": [lf.VoxelKind.INSIDE] * 2})) == 2
    with pytest.raises((TypeError, lf.ArgumentError), match=f"^{name}: "):
        lf.VoxelRecords(frame, **{**arrays, name: wrong})


def sequences(numbers):
    return [tuple(numbers), list(numbers), np.array(numbers)]


def test_any_sequence_of_the_right_length_is_a_tuple():
    octree = lf.build(BALL, depth=3)
    for size, view, white in zip(sequences([16, 8]), sequences([10.0, 20.0]), sequences([255, 255, 255, 0])):
        assert lf.render(BALL, size=size, view=view, background=white).rgba.shape == (8, 16, 4)
    samples = np.arange(8, dtype=np.float32).reshape(2, 2, 2)
    for band in [*sequences([2.0, 5.0]), lf.Volume(samples, [2, 5]).threshold]:
        assert lf.Volume(samples, band).threshold == (2, 5)
        assert lf.Volume(samples, 0).with_threshold(band).threshold == (2, 5)
    assert lf.Volume(samples, lf.Volume(samples, 3).threshold).threshold == (3, None)
    for ray in sequences([[-2.0, 0.0, 0.0], [1.0, 0.0, 0.0]]):
        assert lf.LazyOctree(BALL).refine(2, ray=ray)
    for at, end, radii in zip(sequences([1, 2, 3]), sequences([4, 4, 4]), sequences([1.0, 2.0])):
        assert octree.tag_at(at) in tuple(lf.Tag) and octree.bitmap(first=at, end=end).shape == (3, 2, 1)
        assert lf.Csg.frustum_between([0, 0, 0], [0, 0, 1], radii).contains([0, 0, 0.5])


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: lf.render(BALL, size=[8]),
        lambda: lf.render(BALL, size=[8, 8, 8]),
        lambda: lf.render(BALL, size=[8.5, 8]),
        lambda: lf.render(BALL, size=[-8, 8]),
        lambda: lf.render(BALL, view=[1, 2, 3]),
        lambda: lf.render(BALL, background=[0, 0, 0]),
        lambda: lf.render(BALL, background=[0, 0, 0, 256]),
        lambda: lf.render(BALL, slice=[0, 0, 1]),
        lambda: lf.Volume(np.zeros((2, 2, 2), bool), [1, 2, 3]),
        lambda: lf.Volume(np.zeros((2, 2, 2), bool), "high"),
        lambda: lf.Volume(np.zeros((2, 2, 2), bool), 1j),
        lambda: lf.LazyOctree(BALL).refine(2, ray=[[0, 0, 0]]),
        lambda: lf.Csg.frustum_between([0, 0, 0], [0, 0, 1], [1]),
        lambda: lf.Csg.quadric(np.zeros((1, 10))),
    ],
)
def test_tuples_of_another_length_are_refused(wrong):
    with pytest.raises((TypeError, ValueError, OverflowError)):
        wrong()


def test_meshes_of_trimesh_can_be_changed(tetrahedron):
    pytest.importorskip("trimesh")
    body = tetrahedron.to_trimesh()
    body.vertices[0] = [-1, -1, -1]
    body.faces[0] = body.faces[0][::-1]
    body.vertices *= 2
    assert body.vertices[0].tolist() == [-2] * 3 and tetrahedron.vertices.min() == 0
