"""Meshes, volumes, octrees, channels, voxels and models as arrays."""

import numpy as np
import pytest

import leafless as lf


def test_meshes_show_their_memory(tetrahedron):
    vertices, faces = tetrahedron.vertices, tetrahedron.faces
    assert vertices.shape == (4, 3) and vertices.dtype == np.float64 and faces.shape == (4, 3)
    assert not vertices.flags.owndata and not vertices.flags.writeable
    with pytest.raises(ValueError):
        vertices[0, 0] = 9
    again = tetrahedron.vertices
    assert again.__array_interface__["data"] == vertices.__array_interface__["data"]
    del tetrahedron, again
    # The array keeps the mesh alive.
    assert vertices.sum() == 3 and faces.max() == 3


@pytest.mark.parametrize(
    "faces, error",
    [
        ([[0, 1, 9]], ValueError),
        ([[0, 1, -1]], ValueError),
        ([[0, 1]], ValueError),
        ([[0, 1, 2.5]], TypeError),
        ([["a", "b", "c"]], TypeError),
    ],
)
def test_wrong_faces_are_refused(faces, error):
    with pytest.raises(error):
        lf.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces)


def test_wrong_vertices_are_refused():
    with pytest.raises(lf.MeshError, match="not a number"):
        lf.Mesh([[0, 0, np.nan], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    with pytest.raises(lf.Error):
        lf.measure(lf.Mesh([[0, 0, 0]], []))


def test_open_meshes_tell(tetrahedron):
    opened = lf.Mesh(tetrahedron.vertices, tetrahedron.faces[:3])
    assert not opened.is_closed and opened.report()["boundary_edges"] == 3
    assert tetrahedron.is_closed and tetrahedron.report()["bodies"] == 1
    # The winding number decides in spite of the hole.
    assert opened.contains([0.1, 0.1, 0.1]) == lf.INSIDE and opened.contains([-1, -1, -1]) == lf.OUTSIDE


def test_trimesh_takes_and_gives(tetrahedron):
    trimesh = pytest.importorskip("trimesh")
    body = tetrahedron.to_trimesh()
    assert body.is_watertight and abs(body.volume - 1 / 6) < 1e-12
    sphere = lf.Mesh.from_trimesh(trimesh.creation.icosphere(subdivisions=2))
    assert abs(lf.measure(sphere).volume.middle - trimesh.creation.icosphere(subdivisions=2).volume) < 1e-9


@pytest.mark.parametrize("dtype", [bool, np.uint8, np.uint16, np.int16, np.float32])
@pytest.mark.parametrize("order", ["xyz", "zyx"])
def test_volumes(dtype, order):
    array = np.zeros((3, 4, 5), dtype)
    array[1, 2, 3] = 1
    volume = lf.Volume(array, 0.5, origin=[10, 20, 30], spacing=2, order=order)
    at = np.array([1, 2, 3] if order == "xyz" else [3, 2, 1])
    centre = np.array([10, 20, 30]) + 2 * (at + 0.5)
    assert volume.contains(centre) == lf.INSIDE and volume.contains(centre + 2) == lf.OUTSIDE
    assert (volume.array == array).all() and volume.array.dtype == array.dtype
    assert 8 in lf.measure(volume).volume
    if order == "zyx":
        assert np.shares_memory(volume.array, array)


def test_volumes_share_memory():
    fortran = np.asfortranarray(np.random.default_rng(0).random((4, 5, 6), np.float32))
    assert np.shares_memory(lf.Volume(fortran, 0.5).array, fortran)
    volume = lf.Volume(fortran, (0.25, 0.75))
    inside = ((fortran >= 0.25) & (fortran <= 0.75)).sum()
    assert float(inside) in lf.build(volume, rule="sampled").volume
    assert float((fortran >= 0.9).sum()) in lf.build(volume.with_threshold(0.9), rule="sampled").volume


def test_wrong_volumes_are_refused():
    with pytest.raises(TypeError, match="float64"):
        lf.Volume(np.zeros((2, 2, 2)))
    with pytest.raises(ValueError, match="three axes"):
        lf.Volume(np.zeros((2, 2), np.uint8))
    with pytest.raises(lf.ArgumentError):
        lf.Volume(np.zeros((0, 2, 2), np.uint8))
    with pytest.raises(lf.ArgumentError):
        lf.Volume(np.zeros((2, 2, 2), np.uint8), spacing=-1)
    with pytest.raises(lf.ArgumentError):
        lf.Volume(np.zeros((2, 2, 2), np.uint8), np.nan)


def test_bitmaps_are_what_points_say():
    frame = lf.Frame([0, 0, 0], 8, 4)
    octree = lf.build(lf.Csg.ball([4, 3, 5], 2.7), frame)
    inner, outer = octree.bitmap(), octree.bitmap(outer=True)
    assert inner.shape == (16, 16, 16) and inner.dtype == bool
    x, y, z = np.mgrid[0:16, 0:16, 0:16]
    centres = (np.stack([x, y, z], axis=-1).reshape(-1, 3) + 0.5) / 2
    answers = octree.contains(centres).reshape(16, 16, 16)
    assert (inner == (answers == lf.INSIDE)).all() and (outer == (answers != lf.OUTSIDE)).all()
    box = octree.bitmap(first=(3, 2, 5), end=(9, 12, 6))
    assert (box == inner[3:9, 2:12, 5:6]).all()
    again = lf.build(lf.Volume(inner, spacing=0.5), frame, rule="sampled")
    assert again.volume.middle == octree.volume.lower


def test_cells_add_up(plate):
    octree = lf.build(plate, depth=6)
    cells = octree.cells()
    edges = octree.frame.edge / 2.0 ** cells.level
    full = (edges[cells.tag == lf.FULL] ** 3).sum()
    partial = (edges[cells.tag == lf.PARTIAL] ** 3).sum()
    assert np.isclose(full, octree.volume.lower) and np.isclose(full + partial, octree.volume.upper)
    assert len(octree.cells("full")) == (cells.tag == lf.FULL).sum()
    for tag in (lf.FULL, lf.PARTIAL, lf.EMPTY, lf.Tag.BRANCH):
        assert (octree.cells(tag).at == octree.cells(tag.name.lower()).at).all()
    assert len(octree.cells("full", lf.EMPTY, lf.FULL)) == len(octree.cells("empty", "full"))
    # The constants of points are numbers, too. None of them is a tag.
    for wrong in (lf.INSIDE, 3, None):
        with pytest.raises(TypeError, match="^tags: "):
            octree.cells(wrong)
    assert np.isclose((edges**3).sum(), octree.frame.edge**3)
    assert octree.tag_at([0, 0, 0]) in tuple(lf.Tag)
    with pytest.raises(lf.ArgumentError, match="^at: "):
        octree.tag_at([1 << octree.frame.depth, 0, 0])
    levels = octree.statistics()
    assert sum(level["full"] for level in levels) == len(octree.cells("full"))


def test_channels():
    octree = lf.build(lf.Csg.ball([4, 4, 4], 3), lf.Frame([0, 0, 0], 8, 4))
    heat = lf.Channel.fill(lambda points: points @ [1, 2, 3], octree)
    warm = octree.with_channel("heat", heat)
    assert warm.channels == ["heat"] and warm.channel("heat").components == 1
    points = np.array([[4.25, 4.25, 4.25], [3.75, 2.25, 5.25]])
    assert np.allclose(warm.channel("heat").values_at(points), points @ [1, 2, 3])
    assert warm.channel("heat").values_at(points[0]) == points[0] @ [1, 2, 3]
    again = lf.Octree.from_bytes(warm.to_bytes()).channel("heat").values_at(points)
    assert (again == warm.channel("heat").values_at(points)).all()
    colour = lf.Channel.fill([255, 0, 7], frame=octree.frame, dtype="uint8")
    assert colour.values_at([1, 1, 1]).tolist() == [255, 0, 7] and colour.nbytes < 10
    summary = warm.channel("heat").summary(octree)
    # The mean of a linear function over a ball is its value at the centre.
    assert 24 in summary["mean"][0] and summary["least"][0] < 24 < summary["greatest"][0]
    holes = lf.Channel.fill(lambda points: np.where(points[:, 0] < 4, np.nan, 1.0), octree)
    assert np.isnan(holes.values_at([2, 4, 4])) and holes.values_at([6, 4, 4]) == 1
    with pytest.raises(ValueError, match="shape"):
        lf.Channel.fill(lambda points: np.zeros((len(points), 9)), octree)
    with pytest.raises(ZeroDivisionError):
        lf.Channel.fill(lambda points: 1 // 0, octree)
    with pytest.raises(lf.ArgumentError, match="no channel"):
        octree.channel("heat")


def test_channels_of_volumes():
    x, y, z = np.mgrid[0:8, 0:8, 0:8]
    volume = lf.Volume((x + 10 * y).astype(np.float32), 0)
    channel = lf.Channel.fill(volume, frame=lf.Frame([0, 0, 0], 8, 3))
    assert channel.values_at([2.5, 3.5, 1.5]) == 32
    assert volume.values_at([[2.5, 3.5, 1.5], [3.0, 3.5, 1.5], [99, 0, 0]])[:2].tolist() == [32, 32.5]


def test_voxels(plate):
    octree = lf.build(plate, lf.Frame([0, 0, 0], 8, 5))
    records = octree.voxels()
    inside = records.kinds == lf.VoxelKind.INSIDE
    assert np.isclose((records.edges()[inside] ** 3).sum(), octree.volume.lower)
    assert (np.diff(records.codes.astype(float)) > 0).all()
    assert sorted(records.depth_order([20, 20, 20]).tolist()) == list(range(len(records)))
    assert (records.depth_order([20, 20, 20], threads=1) == records.depth_order([20, 20, 20])).all()
    own = lf.VoxelRecords(records.frame, records.codes, records.levels, records.kinds)
    assert len(own) == len(records) and own.to_octree().volume.lower == octree.volume.lower
    assert own.to_octree(lf.FULL) == own.to_octree("full") != own.to_octree(lf.PARTIAL) == own.to_octree()
    assert not records.codes.flags.writeable
    heat = lf.Channel.fill(3.5, octree)
    assert (octree.voxels(heat).values[inside] == 3.5).all()
    with pytest.raises(lf.ArgumentError):
        lf.VoxelRecords(records.frame, records.codes[::-1], records.levels[::-1], records.kinds[::-1])


def test_dexels(plate):
    model = lf.dexelize(plate, depth=6, normals=16)
    assert model.directions == "xyz" and abs(model.volume() - (48 - np.pi)) < 0.2
    rays = model.rays(2)
    assert len(rays) == len(rays.start) and (rays.end > rays.start).all()
    assert np.isclose(((rays.end - rays.start).sum()) * model.frame.cell_size**2, model.volume(2))
    tool = lf.dexelize(lf.Csg.cuboid([-1, -1, -1], [2, 9, 9]), model.frame)
    cut = model - tool
    assert cut.volume() < model.volume() and (model & tool).volume() + cut.volume() == pytest.approx(model.volume())
    assert (model ^ tool).volume() == pytest.approx((model | tool).volume() - (model & tool).volume())
    assert ~~tool == tool
    surface = model.surface()
    assert surface.is_closed and abs(lf.measure(surface).volume.middle - (48 - np.pi)) < 0.3
    assert abs(lf.measure(model.solid()).volume.middle - (48 - np.pi)) < 0.6
    with pytest.raises(lf.ArgumentError):
        lf.dexelize(plate, directions="w")
    with pytest.raises(lf.FrameMismatchError):
        model | lf.dexelize(plate, depth=5)


def test_lazy(plate):
    lazy = lf.LazyOctree(plate)
    assert not lazy.refine(level=20, max_splits=10) and lazy.splits == 10
    assert lazy.refine(level=6) and 48 - np.pi in lazy.volume
    before = lazy.splits
    assert lazy.refine(level=12, point=[4, 3, 0.5]) and lazy.refine(level=9, bounds=[[3, 2, 0], [5, 4, 1]])
    assert lazy.refine(level=9, ray=([-1, 3.1, 0.51], [1, 0, 0])) and lazy.splits > before
    assert lazy.contains([[1, 1, 0.5], [4, 3, 0.5]]).tolist() == [1, 0]
    frozen = lazy.freeze()
    again = lf.LazyOctree(plate, resume=frozen, threads=1)
    with pytest.raises(lf.LimitError):
        lf.LazyOctree(plate, resume=frozen, max_nodes=3)
    assert again.volume == lazy.volume and again.freeze() == frozen
    with pytest.raises(lf.Error):
        lf.LazyOctree(lf.Csg.ball([0, 0, 0], 1), resume=frozen)
    with pytest.raises(lf.ArgumentError):
        lazy.refine(3, point=[0, 0, 0], bounds=[[0, 0, 0], [1, 1, 1]])
