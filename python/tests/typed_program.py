"""A typed program for strict checkers. `test_types.py` checks it and runs it."""

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from typing_extensions import assert_type

import leafless as lf

Doubles = npt.NDArray[np.float64]


class Ball(lf.Shape):
    def __init__(self, radius: float) -> None:
        self.radius = radius

    @property
    def bounds(self) -> list[list[float]]:
        return [[-self.radius] * 3, [self.radius] * 3]

    def distance(self, points: Doubles) -> Doubles:
        lengths: Doubles = np.linalg.norm(points, axis=1)
        return lengths * (1 - 1e-15) - self.radius


class Cube(lf.Shape):
    bounds: list[list[float]]

    def __init__(self, edge: float) -> None:
        self.bounds = [[0] * 3, [edge] * 3]

    def classify(self, boxes: Doubles) -> npt.NDArray[np.integer[Any]]:
        return np.full(len(boxes), lf.PARTIAL)


def solids() -> tuple[lf.Csg, lf.Octree]:
    plate = lf.Csg.cuboid([0, 0, 0], (8, 6, 1)) - lf.Csg.cylinder_between([4, 3, -1], np.array([4, 3, 2]), 1)
    octree = lf.build(plate, depth=5, rule="sampled", threads=1, progress=lambda part: None)
    assert_type(octree - ~octree, lf.Octree)
    assert_type(lf.Octree.union_of(octree, ~octree, max_bytes=1 << 30), lf.Octree)
    assert_type(octree.cells(lf.FULL, "partial", max_bytes=1 << 30), lf.Cells)
    assert_type(octree | Ball(1) | Cube(2) | plate, lf.Csg)
    assert_type(lf.Affine.translation([1, 0, 0]) @ plate, lf.Csg)
    assert_type(np.eye(4) @ lf.surface(plate), lf.Mesh)
    return plate, octree


def questions(plate: lf.Csg, other: lf.Solid, points: Doubles) -> list[float]:
    mass = lf.measure(plate, tolerance=1e-4, max_splits=10_000)
    assert mass.stop_reason != "exhausted" and mass.centroid is not None and 4 in mass.centroid[0]
    assert_type(plate.contains([1, 2, 0.5]), lf.Membership)
    assert_type(plate.contains([[1, 2, 0.5], [0, 0, 9]]), npt.NDArray[np.uint8])
    assert_type(plate.contains(points), Any)
    found: lf.Distances = plate.distances(points, to="solid", tolerance=1e-3)
    assert_type(found.nearest[~found.undecided], Doubles)
    assert_type(found.distance[:2].upper, Doubles)
    assert_type(plate.distances([1, 2, 0.5]).distance, lf.Interval)
    assert_type(plate.distances([[1, 2, 0.5], [0, 0, 9]]).distance, lf.Intervals)
    assert_type(plate.rays([[1, 2, 0.5], [0, 0, 9]], [0, 0, 1], on="outer").hit, npt.NDArray[np.bool_])
    assert_type(plate.rays([1, 2, 9], [0, 0, -1]).hit, bool)
    assert_type(plate.rays(points, [0, 0, 1], last=9), Any)
    places = [lf.Affine.translation([0, 0, z]) for z in (0, 1, 2)]
    if lf.interference(plate, other, places[1]).verdict == "overlapping":
        low, high = mass.volume
        return [low, high]
    assert_type(lf.gap_at_least(plate, other, 0.5, places), list[lf.Gap])
    return [one.distance.lower for one in lf.clearance(plate, other, places, max_splits=1000)]


def arrays(octree: lf.Octree, mesh: lf.Mesh) -> Doubles:
    again = lf.Mesh(mesh.vertices[:, ::-1], mesh.faces[:, ::-1], fill="evenodd")
    assert_type(again.report()["is_closed"], bool)
    volume = lf.Volume(octree.bitmap(), origin=octree.frame.origin, spacing=octree.frame.cell_size, order="xyz")
    assert_type(volume.values_at([0.1, 0.1, 0.1]), np.float64)
    heat = lf.Channel.fill(lambda points: 20 + 3 * points[:, 2], octree, dtype="float32")
    summary = octree.with_channel("heat", heat).channel("heat").summary(octree)
    assert summary is not None and 20 < summary["mean"].middle[0] < 23
    return heat.values_at([[1, 1, 0.5], [2, 2, 0.5]])


def main(folder: Path) -> None:
    plate, octree = solids()
    lf.save(octree, folder / "plate.lfl")
    lf.save(lf.render(octree, size=(32, 24), colours=[(255, 0, 0)]), str(folder / "plate.png"))
    again = lf.open(folder / "plate.lfl", fill="positive", to_unit="mm")
    assert isinstance(again, lf.Octree) and lf.map(folder / "plate.lfl") == again
    print(questions(plate, lf.Csg.ball([4, 3, 5], 1), np.random.default_rng(0).uniform(0, 8, (10, 3))))
    print(arrays(again, lf.surface(plate, method="faces", tolerance=0.01)))
