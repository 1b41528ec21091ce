"""Public objects can be pickled and copied, or say why not."""

import copy
import pickle
import weakref

import numpy as np
import pytest

import leafless as lf


def copies(thing):
    """Copies of an object: pickled by each protocol that supports classes, and a deep copy."""
    return [*(pickle.loads(pickle.dumps(thing, protocol)) for protocol in range(2, 6)), copy.deepcopy(thing)]


BALL = lf.Csg.ball([0, 0, 0], 1)


def test_long_recipes_need_no_recursion():
    part = lf.Csg.cuboid([0, 0, 0], [4, 4, 4])
    for k in range(2500):
        at = np.array([4 * np.sin(k), 2, 2 + k / 2500])
        part = (part | lf.Csg.ball(at, 0.5)) - lf.Csg.ball(-at, 0.5)
    points = np.random.default_rng(0).uniform(-5, 5, (50, 3))
    for again in copies(part):
        assert (again.contains(points) == part.contains(points)).all()


def test_shared_parts_stay_shared():
    part = BALL
    for k in range(40):
        part = part | lf.Affine.translation([2.0**-k, 0, 0]) @ part
    # Without sharing it would be 2^40 balls.
    for again in copies(part):
        assert len(pickle.dumps(part)) == len(pickle.dumps(again)) < 20_000


class Ball(lf.Shape):
    def distance(self, points):
        return np.linalg.norm(points, axis=1) * (1 - 1e-15) - self.radius


class Plain(Ball):
    def __init__(self, radius):
        self.radius = radius
        self.bounds = [[-radius] * 3, [radius] * 3]


class Slotted(Ball):
    __slots__ = ("radius", "bounds")

    def __init__(self, radius):
        Plain.__init__(self, radius)


class Stated(Ball):
    def __init__(self, radius):
        Plain.__init__(self, radius)
        self.cache = lambda: None

    def __getstate__(self):
        return self.radius

    def __setstate__(self, radius):
        self.__init__(radius)


class Made(Ball):
    def __new__(cls, radius, *, unit):
        self = super().__new__(cls)
        Plain.__init__(self, radius * unit)
        return self

    def __getnewargs_ex__(self):
        return (self.radius,), {"unit": 1}


@pytest.mark.parametrize("shape", [Plain(2), Slotted(2), Stated(2), Made(1, unit=2)], ids=lambda shape: type(shape).__name__)
def test_shapes_are_pickled_as_any_object(shape):
    for again in copies(shape):
        assert type(again) is type(shape) and again.radius == 2 and again.contains([0, 0, 1.9]) == lf.INSIDE
    # One shape at two places stays one.
    for again in copies([shape, {"the same": shape}]):
        assert again[0] is again[1]["the same"]
    for again in copies(shape & lf.Csg.half_space([0, 0, 1], 0)):
        assert again.contains([[0, 0, 1.9], [0, 0, -1.9]]).tolist() == [1, 0]


def plate():
    return lf.Csg.cuboid([0, 0, 0], [4, 4, 1]) - lf.Csg.cylinder_between([2, 2, -1], [2, 2, 2], 1)


def records():
    octree = lf.build(plate(), depth=4)
    return octree.voxels(lf.Channel.fill(lambda points: points[:, :2], octree))


#: An object of each public class that is pickled, or several.
THINGS = {
    "Affine": lambda: [lf.Affine.rotation([1, 2, 3], 77, about=[4, 5, 6])],
    "BoundingBox": lambda: [lf.bounding_box(BALL, max_splits=100)],
    "Cells": lambda: [lf.build(BALL, depth=3).cells()],
    "Clearance": lambda: [lf.clearance(BALL, plate() - BALL, max_splits=100)],
    "Csg": lambda: [plate(), lf.Csg.from_scene("cube([1, 2, 3]);"), lf.Csg.prism([[0, 0], [1, 0], [0, 1]], 0, 1)],
    "Deviation": lambda: [lf.deviation(BALL, lf.Csg.ball([0.1, 0, 0], 1), tolerance=0.1)],
    "DexelRays": lambda: [lf.dexelize(BALL, depth=3).rays(0)],
    "DexelSolid": lambda: [lf.dexelize(BALL, depth=4).solid()],
    "Distance": lambda: [BALL.distances([1, 2, 3])],
    "Distances": lambda: [BALL.distances([[1, 2, 3], [0, 0, 0.5]])],
    "Frame": lambda: [lf.Frame([0, 1, 2], 3, 4)],
    "Gap": lambda: [lf.gap_at_least(BALL, lf.Csg.ball([3, 0, 0], 1), 0.5)],
    "Interference": lambda: [lf.interference(BALL, BALL), lf.interference(BALL, lf.Csg.ball([3, 0, 0], 1))],
    "Interval": lambda: [lf.Interval(1, 2), lf.Interval(0, np.inf)],
    "Intervals": lambda: [lf.Intervals([[1.0, 2.0]], [[2.0, np.inf]])],
    "MassProperties": lambda: [lf.measure(plate()), lf.measure(BALL, max_splits=1)],
    "Membership": lambda: list(lf.Membership),
    "Mesh": lambda: [lf.surface(plate()), lf.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], fill="positive")],
    "Octree": lambda: [lf.build(plate(), depth=4), lf.build(plate(), surfaces=True)],
    "Picture": lambda: [lf.render(BALL, size=(20, 10))],
    "Proof": lambda: [lf.build(BALL, depth=3).proof, lf.Proof(True, False, 0.25)],
    "RayHit": lambda: [BALL.rays([-2, 0, 0], [1, 0, 0]), BALL.rays([-2, 2, 0], [1, 0, 0])],
    "RayHits": lambda: [BALL.rays([[-2, 0, 0], [-2, 2, 0]], [1, 0, 0])],
    "Shape": lambda: [Plain(2)],
    "SurfaceArea": lambda: [lf.surface_area(BALL)],
    "SurfaceReport": lambda: [lf.surface(plate()).surface_report],
    "Tag": lambda: list(lf.Tag),
    "TriDexel": lambda: [lf.dexelize(BALL, depth=4, normals=16)],
    "Volume": lambda: [lf.Volume(np.eye(3, dtype=np.uint8)[None] * 9, 5, spacing=2, order="zyx")],
    "VoxelKind": lambda: list(lf.VoxelKind),
    "VoxelRecords": lambda: [records(), lf.build(BALL, depth=3).voxels(outside=True)],
}

#: Classes whose objects cannot be pickled. The comments name the objects that can be pickled instead.
REFUSED = {
    "Channel": lambda: lf.Channel.fill(1.0, frame=lf.Frame([0, 0, 0], 1, 1)),  # The octree that has it.
    "LazyOctree": lambda: lf.LazyOctree(BALL),  # The solid, and the frozen octree.
}

#: Classes without objects of their own, and exceptions, which Python pickles itself.
BASES = {"Solid"} | {name for name in lf.__all__ if name.endswith("Error")}


def test_the_tables_have_all_classes():
    classes = {name for name in lf.__all__ if isinstance(getattr(lf, name), type)}
    assert classes == THINGS.keys() | REFUSED.keys() | BASES


def parts(thing):
    """All values that an object returns without arguments, by name."""
    found = {"repr": repr(thing)}
    for name in dir(thing):
        # The size of an object in memory may change.
        if not name.startswith("_") and name != "nbytes" and not callable(value := getattr(thing, name)):
            found[name] = value
    return found


def same(one, other):
    if isinstance(one, np.ndarray):
        return one.dtype == other.dtype and np.array_equal(one, other, equal_nan=one.dtype.kind == "f")
    return one == other


@pytest.mark.parametrize("name", THINGS)
def test_everything_is_pickled(name):
    for thing in THINGS[name]():
        assert isinstance(thing, getattr(lf, name)) and type(thing).__name__ != "Solid"
        has_equality = type(thing).__eq__ is not object.__eq__
        for again in copies(thing):
            assert type(again) is type(thing) and (again == thing) is (True if has_equality else again is thing)
            before, after = parts(thing), parts(again)
            assert before.keys() == after.keys()
            assert [part for part in before if not same(before[part], after[part])] == []
        if isinstance(thing, lf.Solid):
            points = np.random.default_rng(0).uniform(-1, 4, (200, 3))
            assert (pickle.loads(pickle.dumps(thing)).contains(points) == thing.contains(points)).all()


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_not_pickled_says_why(name):
    with pytest.raises(TypeError, match=f"a {name} .*pickled"):
        pickle.dumps(REFUSED[name]())


@pytest.mark.parametrize("name", [*THINGS, *REFUSED])
def test_everything_can_be_watched(name):
    thing = THINGS[name]()[0] if name in THINGS else REFUSED[name]()
    # Python's numbers have no weak references.
    assert isinstance(thing, int) or weakref.ref(thing)() is thing


def test_errors_are_pickled():
    with pytest.raises(lf.ArgumentError) as caught:
        lf.Frame([0, 0, 0], -1, 3)
    again = pickle.loads(pickle.dumps(caught.value))
    assert type(again) is lf.ArgumentError and str(again) == str(caught.value)


def test_meshes_keep_what_they_carry(tmp_path):
    lf.save(lf.surface(plate()), tmp_path / "plate.obj")
    text = (tmp_path / "plate.obj").read_text().replace("\nf ", "\nusemtl steel\nf ", 1).splitlines()
    half = len(text) - 10
    (tmp_path / "plate.obj").write_text("\n".join([*text[:half], "usemtl brass", *text[half:]]))
    mesh = lf.open(tmp_path / "plate.obj", unit="mm", fill="evenodd")
    assert mesh.attributes == ["material"] and mesh.unit == "mm"
    # The file has the names of the materials.
    lf.save(pickle.loads(pickle.dumps(mesh)), tmp_path / "again.obj")
    assert "usemtl brass" in (tmp_path / "again.obj").read_text()
    thin = lf.simplify(lf.surface(plate(), tolerance=1e-3), 0.01)
    for one in (mesh, thin, mesh.sewn()):
        for again in copies(one):
            assert again.report() == one.report() and again.surface_report == one.surface_report
            assert (again.unit, again.fill, again.attributes) == (one.unit, one.fill, one.attributes)
            for name in one.attributes:
                assert np.array_equal(again.attribute(name), one.attribute(name), equal_nan=True)


def test_voxels_keep_what_is_known_of_them():
    for one in (records(), lf.build(~BALL, lf.Frame([-2, -2, -2], 4, 4)).voxels(outside=True)):
        for again in copies(one):
            assert again.to_octree() == one.to_octree() and again.to_octree().proof == one.to_octree().proof
