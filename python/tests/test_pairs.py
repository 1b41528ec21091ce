"""Queries of two solids: overlap, distance and deviation, one by one and under many placements; surfaces."""

import pathlib

import numpy as np
import pytest

import leafless as lf
from conftest import PLATE_VOLUME
from leafless._leafless import frame_of_pair


def kinds(csg):
    """One solid in all its forms."""
    return [csg, lf.surface(csg, tolerance=1e-4), lf.build(csg, depth=7), lf.build(csg, surfaces=True)]


BLOCK = lf.Csg.cuboid([0, 0, 0], [2, 2, 2])


@pytest.mark.parametrize("a", kinds(BLOCK), ids=repr)
@pytest.mark.parametrize("b", kinds(lf.Csg.cuboid([3, 0, 0], [5, 2, 2])), ids=repr)
def test_blocks_apart(a, b):
    apart = lf.interference(a, b)
    assert apart.verdict == "disjoint" and 0 in apart.volume and apart.ball is None and not apart.clipped
    near = lf.clearance(a, b, tolerance=0.05, max_splits=5000)
    assert 1 in near.distance and near.points.shape == (2, 3)
    assert lf.gap_at_least(a, b, 0.5).verdict == "yes" and lf.gap_at_least(a, b, 1.5).verdict == "no"
    places = [lf.Affine.translation([x, 0, 0]) for x in (0.5, 0, -0.5, -1.5)]
    found = lf.interference(a, b, places)
    assert [one.verdict for one in found] == ["disjoint"] * 3 + ["overlapping"]
    (center, radius) = found[3].ball
    assert radius > 0 and 1.5 <= center[0] <= 2 and found[3].volume.upper >= 2
    distances = lf.clearance(a, b, np.stack([place.matrix for place in places]), tolerance=0.05, max_splits=5000)
    assert all(truth in one.distance for truth, one in zip((1.5, 1, 0.5, 0), distances))
    gaps = [one.verdict for one in lf.gap_at_least(a, b, 0.75, places, max_splits=5000)]
    # Proving that a mesh and cells overlap may take more splits.
    assert gaps[:3] == ["yes", "yes", "no"] and gaps[3] in ("no", "undecided")


def test_one_placement_has_one_answer():
    moved = lf.Affine.translation([1, 0, 0])
    one = lf.interference(BLOCK, BLOCK, moved, tolerance=1e-3)
    assert one.verdict == "overlapping" and 4 in one.volume and one.volume.width <= 1e-3
    assert lf.interference(BLOCK, BLOCK, moved.matrix).verdict == "overlapping"
    assert isinstance(lf.interference(BLOCK, BLOCK, [moved]), list)
    with pytest.raises(lf.ArgumentError, match="placements"):
        lf.interference(BLOCK, BLOCK, np.eye(2))


def test_batches_on_the_frame_of_all_are_one_call():
    pairs = [
        (BLOCK, lf.Csg.ball([0, 0, 0], 1)),
        (BLOCK, lf.surface(lf.Csg.ball([0, 0, 0], 1), tolerance=0.01)),
        (lf.build(BLOCK, depth=6), lf.build(lf.Csg.ball([0, 0, 0], 1), depth=6)),
        (BLOCK, lf.build(lf.Csg.ball([0, 0, 0], 1), depth=6)),
    ]
    places = np.stack([lf.Affine.translation([x, 0.1, 0.2]).matrix for x in (3.5, 4, 9, -0.5)])
    given = lf.Frame([-20, -20, -20], 40, 9)

    def gap(a, b, places, **named):
        return lf.gap_at_least(a, b, 0.75, places, **named)

    for a, b in pairs:
        for wish in ({}, {"depth": 12}, {"frame": given}, {"frame": given, "depth": 11}):
            frame = frame_of_pair(a, b, places, **wish)
            assert frame_of_pair(a, b, places[:1], frame=frame) == frame
            for ask in (lf.interference, lf.clearance, gap):
                whole = ask(a, b, places, max_splits=500, **wish)
                batches = [places[:1], places[1:3], places[3:]]
                parts = [one for batch in batches for one in ask(a, b, batch, max_splits=500, frame=frame)]
                # Answers with arrays have no useful equality.
                assert [vars(one) | {"points": None} for one in parts] == [vars(one) | {"points": None} for one in whole]
    assert frame_of_pair(BLOCK, BLOCK).edge < frame_of_pair(BLOCK, BLOCK, places).edge


def test_contact_is_not_overlap():
    pin, bore = lf.Csg.cylinder(2, -5, 5), lf.Csg.cuboid([-9, -9, 0], [9, 9, 1]) - lf.Csg.cylinder(2, -1, 2)
    assert lf.interference(pin, bore).verdict == "disjoint"
    assert lf.clearance(pin, bore).distance.upper < 1e-4
    assert lf.interference(lf.Csg.cylinder(2.0005, -5, 5), bore).verdict == "overlapping"


def test_one_bar_of_progress(capsys):
    pytest.importorskip("tqdm")
    lf.deviation(BLOCK, lf.Csg.cuboid([0, 0, 0], [2, 2, 2.1]), tolerance=0.1, progress=True)
    assert capsys.readouterr().err.count("\n") <= 1


def test_a_given_frame_stands_for_bounds():
    frame = lf.Frame([-4, -4, -4], 8, 6)
    around = ~lf.Csg.ball([0, 0, 0], 1)
    assert 512 - 4 / 3 * np.pi in lf.build(around, frame, surfaces=True).volume
    with pytest.raises(lf.ArgumentError, match="frame"):
        lf.build(around, surfaces=True)


class Unbounded(lf.Shape):
    """A ball without bounds."""

    def distance(self, points):
        return (np.linalg.norm(points, axis=1) - 1) * (1 - 1e-12)


def test_a_given_frame_stands_for_bounds_under_placements():
    frame = lf.Frame([-4, -4, -4], 8, 6)
    block = lf.Csg.cuboid([2, -1, -1], [3, 1, 1])
    places = [lf.Affine.translation([x, 0, 0]) for x in (0, -1.5, 1.5)]
    for solid in (Unbounded(), ~(~lf.Csg.ball([0, 0, 0], 1))):
        found = lf.interference(block, solid, places, frame=frame, max_splits=20_000)
        assert [one.verdict for one in found[:2]] == ["disjoint"] * 2 and found[2].verdict != "disjoint"
        near = lf.clearance(block, solid, places[:2], frame=frame, tolerance=0.25, max_splits=20_000)
        assert 1 in near[0].distance and 2.5 in near[1].distance and near[0].distance.upper < 1.5
        # The solid may lie beyond the frame, at any distance.
        gaps = lf.gap_at_least(block, solid, 4, places[:2], frame=frame, max_splits=20_000)
        assert [one.verdict for one in gaps] == ["no", "no"]
        # The place from which the solid is moved may lie beyond the frame.
        far = lf.Affine.translation([-100, 0, 0])
        assert lf.interference(block, far.inverse() @ solid, far, frame=frame, max_splits=20_000).verdict == "disjoint"
        assert lf.interference(solid, block, places, frame=frame, max_splits=20_000)[0].verdict == "disjoint"
    for ask in (lf.interference, lf.clearance, lf.deviation):
        with pytest.raises(lf.ArgumentError, match="^frame: "):
            ask(block, Unbounded())
    assert lf.deviation(Unbounded(), lf.Csg.ball([0, 0, 0], 1), frame=frame, max_splits=3000).distance.lower == 0


def test_a_given_frame_is_what_a_picture_takes_in():
    frame = lf.Frame([-2, -2, -2], 4, 20)
    with pytest.raises(lf.ArgumentError, match="^frame: "):
        lf.render(Unbounded(), size=(40, 30))
    shown = np.isfinite(lf.render(Unbounded(), size=(80, 60), frame=frame).depth).mean()
    ball = lf.Csg.ball([0, 0, 0], 1)
    assert 0.02 < shown < np.isfinite(lf.render(ball, size=(80, 60)).depth).mean() / 2
    # Half of the ball lies in the frame.
    half = lf.render(ball, size=(80, 60), view=(0, 0), frame=lf.Frame([0, -2, -2], 4, 20))
    assert np.isfinite(half.depth).sum() < 0.75 * np.isfinite(lf.render(ball, size=(80, 60), view=(0, 0), frame=frame).depth).sum()
    octree = lf.build(ball, depth=5)
    assert np.isfinite(lf.render(octree, size=(80, 60), frame=frame).depth).mean() < 0.3


def test_surfaces_ignore_nothing():
    ball = lf.Csg.ball([0, 0, 0], 1)
    octree, volume = lf.build(ball, depth=5), lf.Volume(np.ones((4, 4, 4), np.uint8), 1)
    frame = lf.Frame([-2, -2, -2], 8, 5)
    refused = [
        (octree, {"depth": 6}),
        (octree, {"frame": frame}),
        (octree, {"tolerance": 0.1}),
        (octree, {"method": "nets", "depth": 6}),
        (octree, {"method": "adaptive", "resolve": "inner"}),
        (volume, {"tolerance": 0.1}),
        (volume, {"method": "cubes", "tolerance": 0.1}),
        (volume, {"resolve": "inner"}),
        (ball, {"method": "cubes", "tolerance": 0.1}),
        (ball, {"method": "nets", "resolve": "inner"}),
        (ball, {"resolve": "outer"}),
    ]
    for solid, named in refused:
        with pytest.raises(lf.ArgumentError, match=f"^{list(named)[-1]}: has no meaning"):
            lf.surface(solid, **named)
    # Parameters that have an effect change the mesh.
    assert len(lf.surface(volume, frame=frame, depth=3)) != len(lf.surface(volume))
    assert len(lf.surface(volume, method="cubes", frame=frame)) != len(lf.surface(volume))
    coarse, fine = (lf.surface(octree, method="adaptive", tolerance=tolerance) for tolerance in (0.5, 0.05))
    assert len(coarse) < len(fine)


def test_deviation():
    found = lf.deviation(BLOCK, lf.Csg.cuboid([0, 0, 0], [2, 2, 2.1]), tolerance=0.01)
    assert 0.1 in found.distance and found.within(0.2) == "yes" and found.within(0.05) == "no"
    assert found.points.shape == (2, 3) and found.a_to_b.upper >= 0.1 and found.b_to_a.upper >= 0.1


@pytest.mark.parametrize("method", [None, "faces", "adaptive", "cubes", "nets", "shrink"])
def test_surfaces(plate, method):
    mesh = lf.surface(plate, method=method, depth=6 if method in ("cubes", "nets", "shrink") else None)
    assert mesh.is_closed
    report = mesh.surface_report
    assert report.method == (method or "faces")
    volume = lf.measure(mesh).volume.middle
    assert abs(volume - PLATE_VOLUME) < (0.05 if report.deviation < 1 else 8)
    if np.isfinite(report.deviation):
        assert report.deviation <= 0.0081 and lf.deviation(mesh, plate, tolerance=1e-3).distance.lower <= report.deviation
    few = lf.simplify(mesh, 0.05)
    before = report.deviation if np.isfinite(report.deviation) else 0
    assert len(few) <= len(mesh) and few.surface_report.deviation <= (0.05 + before) * (1 + 1e-12)
    assert few.surface_report.from_mesh == (not np.isfinite(report.deviation))


def test_surfaces_of_octrees(plate):
    octree = lf.build(plate, depth=6)
    inner, outer = (lf.measure(lf.surface(octree, resolve=resolve)).volume.middle for resolve in ("inner", "outer"))
    assert inner < PLATE_VOLUME < outer
    sampled = lf.build(plate, depth=6, rule="sampled")
    assert lf.surface(sampled).is_closed and lf.surface(sampled, method="nets").is_closed
    kept = lf.build(plate, surfaces=True)
    assert lf.surface(kept).surface_report.method == "faces"
    for wrong in ({"method": "magic"}, {"resolve": "both"}, {"tolerance": -1}):
        with pytest.raises(lf.ArgumentError):
            lf.surface(plate, **wrong)


def test_pictures(plate):
    whole = lf.render(plate, lf.Csg.ball([4, 3, 2], 1), size=(80, 60), colours=[(255, 0, 0), (0, 0, 255, 128)])
    red = (whole.rgba[..., 0] > 150) & (whole.rgba[..., 1] < 100)
    assert red.mean() > 0.1 and whole.to_png().startswith(b"\x89PNG")
    open_ = lf.render(plate, size=(80, 60), clip=[[-1, 0, 0, 4]])
    assert np.isfinite(open_.depth).sum() < np.isfinite(whole.depth).sum()
    section = lf.render(lf.build(plate, depth=5), size=(80, 60), slice=(0, 0, 1, -0.4))
    blue = (section.rgba[..., 2] > 150) & (section.rgba[..., 0] < 40)
    assert 0.1 < blue.mean() < 0.9
    again = lf.render(plate, lf.Csg.ball([4, 3, 2], 1), size=(80, 60), colours=[(255, 0, 0), (0, 0, 255, 128)], threads=1)
    assert (again.rgba == whole.rgba).all()
    for wrong in ({"size": (0, 9)}, {"colours": [(1, 2)]}, {"samples": 5}, {"clip": [[0, 0, 0, 1]]}):
        with pytest.raises(ValueError):
            lf.render(plate, **wrong)
    with pytest.raises(lf.ArgumentError):
        lf.render()


def test_simplified_meshes_add_up_what_they_are_off():
    ball = lf.Csg.ball([0, 0, 0], 1)
    first = lf.surface(ball, tolerance=0.02)
    few = lf.simplify(first, 0.02)
    report = few.surface_report
    assert not report.from_mesh and report.deviation > first.surface_report.deviation
    # No point of the mesh is further from the ball than the deviation.
    corners = few.vertices[few.faces]
    weights = np.random.default_rng(0).dirichlet([1, 1, 1], 20_000)
    points = np.einsum("nk,nkd->nd", weights, corners[np.random.default_rng(1).integers(0, len(few), 20_000)])
    assert np.abs(np.linalg.norm(points, axis=1) - 1).max() <= report.deviation
    # For a mesh from plain arrays no deviation is known.
    assert lf.simplify(lf.Mesh(first.vertices, first.faces), 0.02).surface_report.from_mesh


def test_same_bits():
    """The program, the C libraries and Python give the same bits: see tests/same_bits of the repository."""
    folder = pathlib.Path(__file__).parents[2] / "tests" / "same_bits"
    lower, upper = map(float, (folder / "answers.txt").read_text().split())
    found = lf.clearance(lf.open(folder / "spindle.off"), lf.open(folder / "shard.off"), tolerance=32e-9).distance
    assert (found.lower, found.upper) == (lower, upper)
