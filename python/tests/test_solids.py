"""Points, distances, rays, set operations and placements, tested on one table of solids of all kinds."""

import pickle

import numpy as np
import pytest

import leafless as lf

SIDE = 4.0


class Block(lf.Shape):
    """The cube of the table, as a classifier of boxes."""

    bounds = [[0, 0, 0], [SIDE] * 3]

    def classify(self, boxes):
        low, high = boxes[:, 0], boxes[:, 1]
        outside = (high <= 0).any(axis=1) | (low >= SIDE).any(axis=1)
        inside = (low >= 0).all(axis=1) & (high <= SIDE).all(axis=1)
        return np.where(outside, lf.EMPTY, np.where(inside, lf.FULL, lf.PARTIAL))

    def inside(self, points):
        return ((points >= 0) & (points <= SIDE)).all(axis=1)


def cube_mesh():
    corners = [[x, y, z] for z in (0, SIDE) for y in (0, SIDE) for x in (0, SIDE)]
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return lf.Mesh(corners, [t for a, b, c, d in quads for t in ([a, b, c], [a, c, d])])


CUBE = lf.Csg.cuboid([0, 0, 0], [SIDE] * 3)
FRAME = lf.Frame([-2, -2, -2], 8, 6)

# All ways to make a solid that is the cube from 0 to 4.
CUBES = {
    "csg": lambda: CUBE,
    "mesh": cube_mesh,
    "octree": lambda: lf.build(CUBE, FRAME),
    "octree with surfaces": lambda: lf.build(CUBE, FRAME, surfaces=True),
    "octree of bytes": lambda: lf.Octree.from_bytes(lf.build(CUBE, FRAME).to_bytes()),
    "volume": lambda: lf.Volume(np.ones((4, 4, 4), bool)),
    "shape": Block,
    "dexels": lambda: lf.dexelize(CUBE, FRAME).to_octree().as_truth(),
    "voxels": lambda: lf.build(CUBE, FRAME).voxels().to_octree(),
    "lazy": lambda: frozen(CUBE),
    "scene": lambda: lf.Csg.from_scene("cube([4, 4, 4]);"),
    "moved mesh": lambda: lf.Affine.translation([-1, 0, 0]) @ (lf.Affine.translation([1, 0, 0]) @ cube_mesh()),
    "moved csg": lambda: np.diag([2, 2, 2, 1.0]) @ lf.Csg.cuboid([0, 0, 0], [2, 2, 2]),
    "expression of a mesh": lambda: lf.Csg.of(cube_mesh()) & lf.Csg.cuboid([-1, -1, -1], [9, 9, 9]),
    "surface": lambda: lf.surface(CUBE),
    "union of halves": lambda: lf.Csg.cuboid([0, 0, 0], [2, 4, 4]) | lf.Csg.cuboid([2, 0, 0], [4, 4, 4]),
    "complement twice": lambda: ~~CUBE,
}


def frozen(solid):
    lazy = lf.LazyOctree(solid, FRAME)
    assert lazy.refine(FRAME.depth)
    return lazy.freeze()


@pytest.fixture(params=CUBES, ids=str)
def cube(request):
    return CUBES[request.param]()


def test_points(cube):
    generator = np.random.default_rng(1)
    points = generator.uniform(-3, 7, (2000, 3))
    truth = ((points > 0) & (points < SIDE)).all(axis=1)
    answers = cube.contains(points)
    assert answers.dtype == np.uint8 and answers.shape == (2000,)
    known = answers != lf.UNDECIDED
    assert (answers[known] == truth[known]).all()
    # The faces of all these cubes lie in planes of their lattices, so points may be undecided only next to faces.
    clear = np.abs(points[:, :, None] - [0, SIDE]).min(axis=(1, 2)) > 0.2
    assert known[clear].all()


def test_points_one_by_one(cube):
    assert cube.contains([1, 2, 3]) is lf.INSIDE
    assert cube.contains((1, 2, 30)) is lf.OUTSIDE and not cube.contains(np.array([1e9, 0, 0]))
    assert cube.contains([np.nan, 0, 0]) is lf.UNDECIDED
    with pytest.raises(ValueError, match="UNDECIDED"):
        bool(cube.contains([np.nan, 0, 0]))


def test_distances(cube):
    points = np.array([[2, 2, 6], [2, 2, 1], [7, 2, 2], [-3, -4, 2]], float)
    found = cube.distances(points, tolerance=0.01)
    truth = np.array([2, -1, 3, 5.0])
    assert found.distance.contain(truth).all()
    assert (found.distance.width[~found.undecided] <= 0.01).all()
    assert cube.distances(points, to="solid").distance.contain([2, 0, 3, 5]).all()
    assert cube.distances(points, to="complement").distance.contain([0, 1, 0, 0]).all()
    near = found.nearest[~np.isnan(found.nearest).any(axis=1)]
    assert (np.abs(near[:, :, None] - [0, SIDE]).min(axis=(1, 2)) < 0.3).all()


def test_rays(cube):
    origins = np.array([[-1, 1.1, 1.3], [-1, 5.5, 1.3], [2.1, 1.7, 6]])
    directions = np.array([[1, 0, 0], [1, 0, 0], [0, 0, -2.0]])
    hits = cube.rays(origins, directions)
    assert hits.hit.tolist() == [True, False, True]
    assert hits.distance[[0, 2]].contain([1, 1]).all() and np.isinf(hits.distance.lower[1])
    assert np.allclose(hits.normal[[0, 2]], [[-1, 0, 0], [0, 0, 1]], atol=1e-6) and np.isnan(hits.normal[1]).all()


def test_measures(cube):
    found = lf.measure(cube, tolerance=1e-6)
    assert 64 in found.volume and found.volume.width <= 64 * 1e-5
    assert found.centroid.contain([2, 2, 2]).all()
    assert found.inertia_about_centroid.contain(np.diag([64 * 32 / 12] * 3)).all()
    box = lf.bounding_box(cube, tolerance=1e-3)
    assert box.occupied and box.corners.contain([[0, 0, 0], [4, 4, 4]]).all()
    assert 96 in lf.surface_area(cube, max_splits=3000).area


def test_built(cube):
    octree = lf.build(cube, FRAME)
    assert 64 in octree.volume and octree.volume.width < 40
    assert octree.contains([2, 2, 2]) == lf.INSIDE and octree.contains([5, 5, 5]) == lf.OUTSIDE


def test_bounds(cube):
    low, high = np.asarray(cube.bounds)
    # The vertices of a surface are rounded.
    assert (low <= 1e-12).all() and (high >= SIDE - 1e-12).all()


def test_threads_change_nothing(cube):
    one, two = (lf.build(cube, FRAME, threads=threads).to_bytes() for threads in (1, 2))
    assert one == two


def test_solids_are_pickled(cube):
    again = pickle.loads(pickle.dumps(cube))
    points = np.random.default_rng(2).uniform(-3, 7, (300, 3))
    assert (again.contains(points) == cube.contains(points)).all()


def test_pictures(cube):
    picture = lf.render(cube, size=(64, 48))
    assert picture.rgba.shape == (48, 64, 4) and picture.depth.shape == (48, 64)
    assert np.isfinite(picture.depth).mean() > 0.2
    assert cube._repr_png_()[:8] == b"\x89PNG\r\n\x1a\n"


BALL = lf.Csg.ball([4, 4, 4], 2)


def test_operators(cube):
    points = np.random.default_rng(3).uniform(-1, 7, (500, 3))
    a = ((points > 0) & (points < SIDE)).all(axis=1)
    b = np.linalg.norm(points - 4, axis=1) < 2
    for combined, truth in [
        (cube | BALL, a | b),
        (cube & BALL, a & b),
        (cube - BALL, a & ~b),
        (BALL - cube, b & ~a),
        (cube ^ BALL, a ^ b),
        (lf.Csg.difference_of(cube, BALL, BALL), a & ~b),
        (lf.Csg.union_of(cube, BALL), a | b),
        (lf.Csg.xor_of(cube, BALL, BALL), a),
    ]:
        answers = combined.contains(points, frame=lf.Frame([-2, -2, -2], 16, 12 if isinstance(cube, lf.Shape) else 6))
        known = answers != lf.UNDECIDED
        assert (answers[known] == truth[known]).all() and known.mean() > 0.5


def test_octrees_are_a_set_algebra():
    a, b = lf.build(CUBE, FRAME), lf.build(lf.Csg.ball([4, 4, 4], 1.5), FRAME)
    assert isinstance(a | b, lf.Octree)
    assert (a - b) == (a & ~b) and ~~b == b
    one, other = (lf.build(solid, FRAME, rule="sampled") for solid in (CUBE, lf.Csg.ball([4, 4, 4], 1.5)))
    assert (one ^ other) == ((one | other) - (one & other)) and (one ^ other) != (one | other)
    assert ~~a == a and (a | b) == ~(~a & ~b) and (a & a) == a
    assert (a | b).to_bytes() == (b | a).to_bytes()
    with pytest.raises(lf.FrameMismatchError, match="different frames"):
        a | lf.build(CUBE, lf.Frame([0, 0, 0], 8, 6))


def test_placements_stand_before_solids():
    move = lf.Affine.translation([10, 0, 0])
    for moved in (move @ CUBE, move.matrix @ CUBE, CUBE.placed(move), move.matrix[:3] @ CUBE):
        assert moved.contains([12, 2, 2]) and not moved.contains([2, 2, 2])
    assert isinstance(move @ cube_mesh(), lf.Mesh) and (move @ cube_mesh()).vertices[:, 0].min() == 10
    with pytest.raises(TypeError, match="before the solid"):
        CUBE @ move
    for other in (1, "text", None, [1]):
        with pytest.raises(TypeError):
            CUBE | other
        with pytest.raises(TypeError):
            other - CUBE


@pytest.mark.parametrize(
    "points, names",
    [([[1, 2]], "shape"), ("abc", "points"), (np.zeros((2, 2, 3)), "shape"), ([[1, 2, 3], [1, 2]], "points")],
)
def test_wrong_points_are_refused(points, names):
    with pytest.raises(ValueError, match=names):
        CUBE.contains(points)


def test_empty_and_odd_arrays():
    assert CUBE.contains(np.zeros((0, 3))).shape == (0,)
    assert CUBE.contains([]).shape == (0,)
    assert len(CUBE.distances([])) == 0 and len(CUBE.rays([], [])) == 0
    points = np.random.default_rng(4).uniform(-1, 5, (50, 3))
    expected = CUBE.contains(points)
    for odd in (np.asfortranarray(points), points.astype(">f8"), points[::-1][::-1], points.tolist()):
        assert (CUBE.contains(odd) == expected).all()
    single = points.astype(np.float32)
    assert (CUBE.contains(single) == CUBE.contains(single.astype(float))).all()
    packed = np.zeros(50, dtype=[("flag", "u1"), ("at", "f8", 3)])
    packed["at"] = points
    assert (CUBE.contains(packed["at"]) == expected).all()


def test_rays_share_what_is_one():
    hits = CUBE.rays([-1, 2, 2], [[1, 0, 0], [0, 1, 0]])
    assert hits.hit.tolist() == [True, False]
    with pytest.raises(lf.ArgumentError, match="directions"):
        CUBE.rays(np.zeros((3, 3)), np.ones((2, 3)))
    with pytest.raises(lf.ArgumentError, match="^directions: "):
        CUBE.rays([0, 0, 0], [0, 0, 0])


def test_one_question_has_one_answer():
    near = CUBE.distances([5, 2, 2], tolerance=1e-6)
    many = CUBE.distances([[5, 2, 2]], tolerance=1e-6)
    assert isinstance(near, lf.Distance) and isinstance(near.distance, lf.Interval) and near.distance == many.distance[0]
    assert near.nearest.shape == (3,) and (near.nearest == many.nearest[0]).all()
    assert near.surface == many.surface[0] and near.undecided is False and many.undecided.tolist() == [False]
    assert CUBE.distances([5, 2, 2], tolerance=0).undecided == CUBE.distances([[5, 2, 2]], tolerance=0).undecided[0]
    hit, hits = CUBE.rays([-1, 2, 2], [1, 0, 0]), CUBE.rays([[-1, 2, 2]], [1, 0, 0])
    assert isinstance(hit, lf.RayHit) and hit.hit is True and hit.distance == hits.distance[0] and 1 in hit.distance
    assert hit.normal.shape == (3,) and (hit.normal == hits.normal[0]).all() and hit.surface == hits.surface[0]
    missed = CUBE.rays([-1, 2, 2], [1, 0, 0], last=0.5)
    assert missed.hit is False and missed.distance.lower == np.inf and np.isnan(missed.normal).all() and missed.surface == -1
    for several in (CUBE.rays([[-1, 2, 2]], [[1, 0, 0]]), CUBE.rays([-1, 2, 2], [[1, 0, 0]])):
        assert isinstance(several, lf.RayHits) and len(several) == 1


def test_what_has_no_bounds_needs_a_frame():
    half = lf.Csg.half_space([0, 0, 1], 0)
    assert half.bounds is None
    with pytest.raises(lf.ArgumentError, match="^frame: "):
        half.contains([0, 0, 1])
    assert half.contains([[0, 0, 0.5], [0, 0, -0.5], [0, 0, 5]], frame=lf.Frame([-1, -1, -1], 2, 8)).tolist() == [1, 0, 2]


def test_unknown_words_are_refused():
    with pytest.raises(lf.ArgumentError, match="'certified'"):
        lf.build(CUBE, rule="rough")
    with pytest.raises(lf.ArgumentError, match="'boundary'"):
        CUBE.distances([0, 0, 0], to="moon")
    with pytest.raises(TypeError, match="thread"):
        lf.build(CUBE, thread=3)
    with pytest.raises(TypeError, match="must be a solid"):
        lf.build("cube")


def test_errors_of_primitives():
    for make in (
        lambda: lf.Csg.ball([0, 0, 0], -1),
        lambda: lf.Csg.ball([0, 0, np.inf], 1),
        lambda: lf.Csg.cuboid([0, 0, 0], [0, 1, 1]),
        lambda: lf.Csg.half_space([0, 0, 0], 1),
        lambda: lf.Csg.prism([[0, 0], [1, 1]], 0, 1),
        lambda: lf.Csg.cylinder(1, 2, 1),
    ):
        with pytest.raises(lf.ArgumentError):
            make()


@pytest.mark.parametrize(
    "solid, volume",
    [
        (lf.Csg.ellipsoid([0, 0, 0], [1, 2, 3]), 8 * np.pi),
        (lf.Csg.cylinder(1, 0, 2), 2 * np.pi),
        (lf.Csg.frustum(1, 0, 0, 3), np.pi),
        (lf.Csg.frustum_between([0, 0, 0], [0, 3, 0], [1, 0]), np.pi),
        (lf.Csg.torus(3, 1), 6 * np.pi**2),
        (lf.Csg.wedge([2, 1, 1], 0), 1),
        (lf.Csg.prism([[0, 0], [2, 0], [0, 2]], 0, 3), 6),
        (lf.Csg.convex([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [-1, -1, -1, 1]]), 1 / 6),
        (lf.Csg.quadric([-1, -1, -1, 0, 0, 0, 0, 0, 0, 1]) & lf.Csg.cuboid([-2] * 3, [2] * 3), 4 / 3 * np.pi),
    ],
    ids=repr,
)
def test_primitives(solid, volume):
    found = lf.measure(solid, tolerance=1e-4).volume
    assert volume in found and found.width <= 1.01e-4 * volume
    assert volume in lf.measure(pickle.loads(pickle.dumps(solid)), tolerance=1e-3).volume
