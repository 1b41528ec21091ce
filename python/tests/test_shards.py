"""Octrees in shards: their bytes are those of a single build. Missing shards are PARTIAL and reported."""

import json
import os
import pickle
import warnings

import numpy as np
import pytest

import leafless as lf
from leafless import shards
from leafless.shards import MassSum, MissingShardWarning, Shard, join, measure_cell

PLATE = lf.Csg.cuboid([0, 0, 0], [8, 6, 1]) - lf.Csg.cylinder_between([4, 3, -1], [4, 3, 2], 1)
TOOL = lf.Csg.ball([2, 2, 0.5], 1.3)
FRAME = lf.Frame([-0.3, -0.2, -4.1], 9.0, 7)


@pytest.fixture(scope="module")
def whole():
    return lf.build(PLATE, FRAME)


@pytest.fixture
def parts(tmp_path):
    return shards.build(PLATE, tmp_path / "plate", FRAME, level=2)


def points(count=3000):
    return np.random.default_rng(3).uniform([-0.5, -0.5, -0.5], [8.5, 6.5, 1.5], (count, 3))


@pytest.mark.parametrize("level", [0, 1, 2, 3])
@pytest.mark.parametrize(
    "how", [{}, {"rule": "inner"}, {"rule": "outer"}, {"rule": "sampled"}, {"surfaces": True}], ids=str
)
def test_joined_they_are_the_whole(tmp_path, level, how):
    whole = lf.build(PLATE, FRAME, **how)
    parts = shards.build(PLATE, tmp_path / "built", FRAME, level=level, **how)
    assert parts.join().to_bytes() == whole.to_bytes()
    again = shards.split(whole, tmp_path / "cut", level=level)
    assert again.join().to_bytes() == whole.to_bytes()
    assert again.codes == parts.codes
    assert parts.statistics() == whole.statistics()
    assert (parts.volume, parts.node_count) == (whole.volume, whole.node_count)
    assert parts.proof == whole.proof and parts.keeps_surfaces == whole.keeps_surfaces
    assert len(shards.open(parts.url)) == len(parts) and not parts.missing


def test_layers_of_a_mesh(tmp_path):
    mesh = lf.surface(PLATE, tolerance=0.01)
    whole = lf.build(mesh, FRAME, surfaces=0.02)
    parts = shards.build(mesh, tmp_path, FRAME, level=2, surfaces=0.02)
    assert parts.join().to_bytes() == whole.to_bytes()
    assert parts.source == mesh.fingerprint is not None


def test_queries_of_shards(whole, parts):
    rows = points()
    assert (parts.contains(rows) == whole.contains(rows)).all()
    assert parts.contains(rows[0]) == whole.contains(rows[0])
    directions = np.random.default_rng(4).normal(size=(len(rows), 3))
    for on in ("inner", "outer"):
        found, expected = (solid.rays(rows, directions, on=on) for solid in (parts, whole))
        assert (found.hit == expected.hit).all()
        assert (found.distance.lower == expected.distance.lower).all()
    for box in (
        [[1, 1, 0.2], [2, 2, 0.8]],
        [[3.5, 2.5, 0.1], [4.5, 3.5, 0.9]],
        [[-3, -3, 3], [-2, -2, 3.5]],
        [[0, 0, 0], [8, 6, 1]],
    ):
        assert parts.classify_box(box) == whole.classify_box(box)
    solid = parts.solid()
    assert lf.interference(solid, TOOL, tolerance=0.5).verdict == "overlapping"
    assert pickle.loads(pickle.dumps(solid)).contains([1, 1, 0.5]) == lf.INSIDE


def test_queries_of_shards_that_keep_surfaces(tmp_path):
    frame = FRAME.with_depth(10)
    whole = lf.build(PLATE, frame, surfaces=True)
    parts = shards.build(PLATE, tmp_path, frame, level=1, surfaces=True)
    assert len(parts) > 2
    rows = points()
    answers = parts.contains(rows)
    assert (answers == whole.contains(rows)).all() and (answers != lf.UNDECIDED).mean() > 0.99
    directions = np.random.default_rng(4).normal(size=(len(rows), 3))
    found, expected = (solid.rays(rows, directions) for solid in (parts, whole))
    assert (found.hit == expected.hit).all()
    both = np.maximum(found.distance.lower, expected.distance.lower) <= np.minimum(
        found.distance.upper, expected.distance.upper
    )
    assert both[found.hit].all()
    for box in ([[1, 1, 0.2], [2, 2, 0.8]], [[3.5, 2.5, 0.1], [4.5, 3.5, 0.9]], [[0, 0, 0], [8, 6, 1]]):
        assert parts.classify_box(box) == whole.classify_box(box)


def test_measures_are_those_of_the_whole(whole, parts):
    found, expected = parts.measure(tolerance=0), lf.measure(whole, tolerance=0)
    assert found.volume == expected.volume
    assert (found.centroid.lower == expected.centroid.lower).all()
    assert (found.inertia_about_centroid.upper == expected.inertia_about_centroid.upper).all()


def test_measures_of_surfaces_hold_the_truth(tmp_path):
    parts = shards.build(PLATE, tmp_path, FRAME, level=2, surfaces=True)
    found = parts.measure(tolerance=1e-4)
    assert 48 - np.pi in found.volume and found.volume.width < 1e-3 * 48


def test_sums_in_any_order(parts):
    top = parts.measure_part(tolerance=0)
    sums = [(code, parts.measure_part(code, tolerance=0)) for code in parts.codes]
    total = parts.measure_joined(top, sums)
    back = parts.measure_joined(top, [(code, pickle.loads(pickle.dumps(one))) for code, one in reversed(sums)])
    assert total == back
    # The number of splits keeps counting, so only the volumes are compared.
    assert (total - sums[0][1] + sums[0][1]).properties.volume == total.properties.volume
    with pytest.raises(lf.ArgumentError, match="other"):
        MassSum.unknown(FRAME, 0, 0) + MassSum.unknown(FRAME, 1, 3)
    with pytest.raises(lf.ArgumentError, match="other"):
        sums[0][1] - MassSum.unknown(FRAME, 0, 0)
    with pytest.raises(lf.FrameMismatchError):
        MassSum.unknown(FRAME, 0, 0) + MassSum.unknown(FRAME.with_depth(6), 0, 0)
    with pytest.raises(lf.ArgumentError):
        MassSum.from_bytes(b"not one")


@pytest.mark.parametrize("operation", ["union", "intersection", "difference", "xor"])
@pytest.mark.parametrize("surfaces", [None, True])
def test_set_operations(tmp_path, operation, surfaces):
    a, b = (
        shards.build(solid, tmp_path / name, FRAME, level=2, surfaces=surfaces)
        for solid, name in ((PLATE, "a"), (TOOL, "b"))
    )
    found = shards.combine(operation, a, b, tmp_path / "c")
    expected = shards.OPERATIONS[operation](a.join(), b.join())
    assert found.join().to_bytes() == expected.to_bytes()
    if surfaces is None:
        assert found.statistics() == expected.statistics()
    not_a = shards.complement(a, tmp_path / "d")
    assert not_a.join().to_bytes() == (~a.join()).to_bytes()


def test_surfaces_close_across_shards(whole, parts):
    for resolve in ("inner", "outer"):
        found, expected = parts.surface(resolve), lf.surface(whole, method="cubes", resolve=resolve)
        assert found.is_closed
        # All undecided cells are finest cells.
        assert lf.deviation(found, PLATE).distance.upper < 2 * FRAME.cell_size
        assert len(found.vertices) == len(expected.vertices) and len(found.faces) == len(expected.faces)
        place = lambda mesh: np.unique(mesh.vertices[mesh.faces].reshape(-1, 9), axis=0)
        assert (place(found) == place(expected)).all()


def test_voxels_are_those_of_the_whole(whole, parts):
    for outside in (False, True):
        found, expected = parts.voxels(outside=outside), whole.voxels(outside=outside)
        assert (found.codes == expected.codes).all() and (found.levels == expected.levels).all()
        assert (found.kinds == expected.kinds).all()


def damaged(parts, how):
    """Damages the file of one shard, and returns the shard's code."""
    code = parts.codes[len(parts) // 2]
    path = os.path.join(parts.url, next(entry["path"] for entry in parts.manifest["shards"] if entry["code"] == code))
    data = bytearray(open(path, "rb").read())
    if how == "removed":
        os.remove(path)
    elif how == "truncated":
        open(path, "wb").write(data[: len(data) // 2])
    elif how == "empty":
        open(path, "wb").close()
    elif how == "flipped":
        data[len(data) // 2] ^= 1
        open(path, "wb").write(data)
    elif how == "another":
        lf.save(lf.build(TOOL, FRAME), path)
    return code


@pytest.mark.parametrize("how", ["removed", "truncated", "empty", "flipped", "another"])
def test_a_damaged_shard_is_partial_and_told(whole, parts, how):
    code = damaged(parts, how)
    again = shards.open(parts.url)
    with pytest.warns(MissingShardWarning, match=f"{code:02o}.lfl"):
        assert again.check().keys() == {code}
    joined = again.join()
    rows = points()
    answers, expected = again.contains(rows), whole.contains(rows)
    here = FRAME.codes(rows, 2) == code
    assert here.any() and (answers[~here] == expected[~here]).all() and (answers[here] == lf.UNDECIDED).all()
    assert (joined.contains(rows) == answers).all()
    # All intervals contain the truth about the whole.
    truth = lf.measure(PLATE, tolerance=1e-6).volume
    for volume in (again.measure(tolerance=0).volume, again.volume, joined.volume):
        assert volume.lower <= truth.lower and truth.upper <= volume.upper
        assert volume.width > whole.volume.width
    assert again.measure(tolerance=0).volume == lf.measure(joined, tolerance=0).volume
    assert again.statistics() == joined.statistics()
    found, kinds = again.voxels(), joined.voxels()
    assert (found.codes == kinds.codes).all() and (found.kinds == kinds.kinds).all()
    assert again.classify_box([[-0.3, -0.2, -0.1], [8.5, 6.5, 1.5]]) in ("undecided", "crossing")
    # The result of an operation is PARTIAL in the missing cell, and right elsewhere.
    tool = shards.build(TOOL, parts.url + "-tool", FRAME, level=2)
    cut = shards.combine("difference", again, tool, parts.url + "-cut")
    assert cut.join().to_bytes() == (joined - tool.join()).to_bytes()


def test_without_verification_a_mapped_shard_is_not_read(parts):
    damaged(parts, "flipped")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert not shards.open(parts.url, verify=False).check()


def test_a_damaged_top_is_refused(parts):
    path = os.path.join(parts.url, "top.lfl")
    data = open(path, "rb").read()
    open(path, "wb").write(data[:-7])
    with pytest.raises(lf.FormatError, match="top.lfl"):
        shards.open(parts.url).top


def test_a_build_that_was_broken_off_is_no_octree(tmp_path):
    class Broken(lf.Shape):
        bounds = [[0, 0, 0], [1, 1, 1]]
        calls = 0

        def classify(self, boxes):
            type(self).calls += 1
            if self.calls > 20:
                raise RuntimeError("broken off")
            return np.full(len(boxes), lf.PARTIAL)

    with pytest.raises(RuntimeError, match="broken off"):
        shards.build(Broken(), tmp_path, depth=6, level=2)
    with pytest.raises(FileNotFoundError):
        shards.open(tmp_path)
    assert not list(tmp_path.glob(".*"))


def hostile():
    good = {"path": "a.lfl", "bytes": 1, "sha256": "0"}
    shard = {**good, "code": 0, "levels": [[0, 0, 0]] * 4}
    frame = {"origin": [0, 0, 0], "edge": 1.0, "depth": 5}
    whole = {"format": "leafless shards", "version": 1, "frame": frame, "level": 1, "top": good, "shards": [shard]}
    yield {**whole, "format": "something else"}
    yield {**whole, "version": 2}
    yield {**whole, "version": None}
    yield {**whole, "frame": None}
    yield {**whole, "frame": {**frame, "edge": float("nan")}}
    yield {**whole, "frame": {**frame, "depth": 21}}
    yield {**whole, "frame": {**frame, "depth": "5"}}
    yield {**whole, "frame": {**frame, "origin": [0, 0]}}
    for level in (-1, 5, 1.0, True, 10**40, None):
        yield {**whole, "level": level}
    for path in ("../a.lfl", "/etc/passwd", "a/../../b", "", "..\\a", "http://elsewhere/a", None, 3):
        yield {**whole, "top": {**good, "path": path}}
        yield {**whole, "shards": [{**shard, "path": path}]}
    for entry in (
        {"bytes": -1},
        {"bytes": 1e9},
        {"offset": -1},
        {"code": 8},
        {"code": -1},
        {"levels": 3},
        {"levels": [[1, 2]] * 4},
        {"levels": [[-1, 0, 0]] * 4},
        {"levels": [[0, 0, 0]] * 3},
        {"sha256": None},
    ):
        yield {**whole, "shards": [{**shard, **entry}]}
    yield {**whole, "shards": [shard, shard]}
    yield {**whole, "shards": [{**shard, "code": 3}, {**shard, "code": 2}]}
    yield {**whole, "shards": {}}
    yield []
    yield 7


@pytest.mark.parametrize("manifest", list(hostile()), ids=lambda manifest: json.dumps(manifest)[-60:])
def test_a_hostile_manifest_is_refused(tmp_path, manifest):
    (tmp_path / "manifest.json").write_text(json.dumps(manifest))
    with pytest.raises(lf.FormatError, match="manifest.json"):
        shards.open(tmp_path)


def test_the_manifest_that_these_are_made_of_is_good(tmp_path):
    good = {"path": "a.lfl", "bytes": 1, "sha256": "0"}
    frame = {"origin": [0, 0, 0], "edge": 1.0, "depth": 5}
    shard = {**good, "code": 0, "levels": [[0, 0, 0]] * 4}
    whole = {"format": "leafless shards", "version": 1, "frame": frame, "level": 1, "top": good, "shards": [shard]}
    (tmp_path / "manifest.json").write_text(json.dumps({**whole, "what others add": 1}))
    assert shards.open(tmp_path).codes == [0]


@pytest.mark.parametrize("text", ["", "{", "[" * 100_000, "\udcff", "nul"], ids=range(5))
def test_a_manifest_that_is_no_json_is_refused(tmp_path, text):
    (tmp_path / "manifest.json").write_bytes(text.encode("utf-8", "surrogateescape"))
    with pytest.raises(lf.FormatError, match="manifest.json"):
        shards.open(tmp_path)


def test_every_prefix_of_a_manifest_is_refused(parts):
    path = os.path.join(parts.url, "manifest.json")
    text = open(path).read()
    for length in range(0, len(text) - 1, 97):
        open(path, "w").write(text[:length])
        with pytest.raises(lf.FormatError):
            shards.open(parts.url)


def test_by_urls_and_ranges(whole, parts):
    fsspec = pytest.importorskip("fsspec")
    packed = parts.pack("memory://packed/plate")
    again = shards.open("memory://packed/plate")
    assert again.join().to_bytes() == whole.to_bytes()
    assert (again.contains(points()) == whole.contains(points())).all()
    assert packed.codes == parts.codes
    # A damaged range is reported.
    memory = fsspec.filesystem("memory")
    data = bytearray(memory.cat("/packed/plate/shards.lfl.pack"))
    data[len(data) // 2] ^= 1
    memory.pipe("/packed/plate/shards.lfl.pack", bytes(data))
    with pytest.warns(MissingShardWarning):
        assert len(shards.open("memory://packed/plate").check()) == 1
    local = parts.pack(parts.url + "-packed")
    assert local.join().to_bytes() == whole.to_bytes() and not local.missing
    assert len(os.listdir(local.url)) == 3
    remote = shards.build(PLATE, "memory://built/plate", FRAME, level=1)
    assert remote.join().to_bytes() == whole.to_bytes()


def test_few_shards_are_kept(parts):
    again = shards.open(parts.url, keep=2)
    again.check()
    assert len(again._shards) == 2
    assert pickle.loads(pickle.dumps(again)).codes == parts.codes


def test_pieces_of_the_library(whole):
    top = whole.shard(Shard.top(1))
    cells = [whole.shard(Shard.below(1, int(code))) for code in top.open_cells(1)]
    assert join([top, *cells]) == whole
    assert repr(Shard.top(1)) == "Shard.top(1)" and repr(Shard.below(1, 7)) == "Shard.below(1, 7)"
    assert pickle.loads(pickle.dumps(Shard.below(2, 63))) == Shard.below(2, 63) != Shard.top(2)
    assert (Shard.below(2, 63).code, Shard.top(2).code, Shard.top(2).level) == (63, None, 2)
    assert measure_cell(whole, FRAME, tolerance=0).properties.volume == lf.measure(whole, tolerance=0).volume
    with pytest.raises(lf.ArgumentError, match="trees|octrees"):
        join([whole, lf.build(TOOL, FRAME)])
    with pytest.raises(lf.FrameMismatchError):
        join([whole, lf.build(TOOL, FRAME.with_depth(6))])
    for wrong in (
        lambda: Shard.below(1, 8),
        lambda: whole.shard(Shard.top(8)),
        lambda: whole.open_cells(8),
        lambda: join([]),
    ):
        with pytest.raises(lf.ArgumentError):
            wrong()
    for level in (-1, 7, 20):
        with pytest.raises((ValueError, OverflowError)):
            shards.build(PLATE, "nowhere", FRAME, level=level)
    assert (FRAME.codes([[100, 0, 0]], 3) == 2**64 - 1).all()
    assert lf.Csg.ball([0, 0, 0], 1).fingerprint != PLATE.fingerprint == PLATE.fingerprint
