"""Shards on the workers of Dask: the results are those of one process, even if a worker dies."""

import os
import signal

import numpy as np
import pytest

import leafless as lf
from leafless import shards

pytest.importorskip("dask")

from leafless import distributed  # noqa: E402

PLATE = lf.Csg.cuboid([0, 0, 0], [8, 6, 1]) - lf.Csg.cylinder_between([4, 3, -1], [4, 3, 2], 1)
TOOL = lf.Csg.ball([2, 2, 0.5], 1.3)
FRAME = lf.Frame([-0.3, -0.2, -4.1], 9.0, 7)


@pytest.fixture(scope="module")
def client():
    """Two worker processes."""
    dask_distributed = pytest.importorskip("distributed")
    with (
        dask_distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, memory_limit=0
        ) as cluster,
        dask_distributed.Client(cluster) as client,
    ):
        yield client


@pytest.mark.parametrize("surfaces", [None, True])
def test_builds_and_operations_are_those_of_one_process(client, tmp_path, surfaces):
    alone = shards.build(PLATE, tmp_path / "alone", FRAME, level=2, surfaces=surfaces)
    parts = distributed.build(PLATE, tmp_path / "plate", FRAME, level=2, surfaces=surfaces)
    assert parts.manifest == alone.manifest
    assert parts.join().to_bytes() == lf.build(PLATE, FRAME, surfaces=surfaces).to_bytes()
    tool = distributed.build(TOOL, tmp_path / "tool", FRAME, level=2, surfaces=surfaces)
    cut = distributed.combine("difference", parts, tool, tmp_path / "cut")
    assert cut.manifest == shards.combine("difference", parts, tool, tmp_path / "cut-alone").manifest
    assert (
        distributed.complement(parts, tmp_path / "not").manifest
        == shards.complement(parts, tmp_path / "not-alone").manifest
    )
    again = distributed.split(parts.join(), tmp_path / "split", level=2)
    assert again.join() == parts.join()
    found, expected = distributed.measure(cut, tolerance=1e-3), cut.measure(tolerance=1e-3)
    assert found.volume == expected.volume and (found.centroid.lower == expected.centroid.lower).all()


def test_surfaces_and_voxels_are_those_of_one_process(client, tmp_path):
    parts = distributed.build(PLATE, tmp_path, FRAME, level=2)
    mesh, alone = distributed.surface(parts), parts.surface()
    assert mesh.is_closed and (mesh.vertices == alone.vertices).all() and (mesh.faces == alone.faces).all()
    records, expected = distributed.voxels(parts), lf.build(PLATE, FRAME).voxels()
    assert (records.codes == expected.codes).all() and (records.kinds == expected.kinds).all()


def test_many_poses(client):
    places = [lf.Affine.translation([x, y, 0]) for x in np.linspace(-4, 9, 20) for y in np.linspace(-4, 7, 20)]
    found = distributed.interference(PLATE, TOOL, places, batch=37)
    expected = lf.interference(PLATE, TOOL, places)
    assert [one.verdict for one in found] == [one.verdict for one in expected]
    assert {one.verdict for one in found} >= {"disjoint", "overlapping"}
    assert distributed.interference(PLATE, TOOL, []) == []


def volume_of(radius, height):
    return lf.measure(lf.Csg.cylinder(radius, 0, height), tolerance=1e-3).volume


def test_sweeps(client):
    found = distributed.sweep(volume_of, [(1.0, 2.0), (2.0, 1.0)])
    assert np.pi * 2 in found[0] and np.pi * 4 in found[1]
    assert distributed.sweep(abs, [-1, 2]) == [1, 2]


def test_a_damaged_shard_is_told(client, tmp_path):
    parts = distributed.build(PLATE, tmp_path, FRAME, level=2)
    code = parts.codes[3]
    path = tmp_path / f"{code:02o}.lfl"
    path.write_bytes(path.read_bytes()[:-100])
    again = shards.open(tmp_path)
    with pytest.warns(shards.MissingShardWarning, match=path.name):
        found = distributed.measure(again, tolerance=0)
    assert again.missing.keys() == {code}
    assert found.volume == again.measure(tolerance=0).volume
    assert 48 - np.pi in found.volume


class Slow(lf.Shape):
    """A slow ball. One of its tasks kills its worker once."""

    bounds = [[-1, -1, -1], [1, 1, 1]]

    def __init__(self, marker, victim):
        super().__init__()
        self.marker, self.victim = marker, victim

    def classify(self, boxes):
        try:
            os.close(os.open(self.marker, os.O_CREAT | os.O_EXCL))
            is_first = os.getpid() != self.victim
        except FileExistsError:
            is_first = False
        if is_first:
            os.kill(os.getpid(), signal.SIGKILL)
        low, high = boxes[:, 0], boxes[:, 1]
        near = np.maximum(0, np.maximum(low, -high))
        far = np.maximum(np.abs(low), np.abs(high))
        inside, outside = (far**2).sum(axis=1) < 1, (near**2).sum(axis=1) > 1
        return np.where(inside, lf.FULL, np.where(outside, lf.EMPTY, lf.PARTIAL))


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="needs signals of Unix")
def test_a_worker_that_dies_is_replaced(tmp_path):
    dask_distributed = pytest.importorskip("distributed")
    frame = lf.Frame([-1.1, -1.1, -1.1], 2.2, 5)
    marker = str(tmp_path / "died")
    (tmp_path / "died").touch()
    expected = lf.build(Slow(marker, os.getpid()), frame).to_bytes()
    (tmp_path / "died").unlink()
    with (
        dask_distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, memory_limit=0
        ) as cluster,
        dask_distributed.Client(cluster),
    ):
        parts = build_with_a_victim(tmp_path, frame, marker)
    assert os.path.exists(marker), "no worker died"
    assert parts.join().to_bytes() == expected


def build_with_a_victim(tmp_path, frame, marker):
    # The top is built in this process, which must survive.
    shape = Slow(marker, os.getpid())
    os.path.exists(marker) or open(marker, "w").close()
    how = shards.recipe(shape, frame, None, 1, "certified", None)
    top = how.top(shape)
    os.remove(marker)
    folder = shards.Folder(tmp_path / "parts")
    codes = ((code,) for code in top.open_cells(1).tolist())
    made = distributed._each(distributed._built, codes, solid=shape, folder=folder, how=how)
    return shards.finish(folder, 1, top, made, None)


def test_without_a_cluster_threads_do_it(tmp_path):
    parts = distributed.build(PLATE, tmp_path, FRAME, level=1)
    assert parts.join().to_bytes() == lf.build(PLATE, FRAME).to_bytes()
