"""The classes of answers."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from numbers import Real
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ._intervals import Intervals
from ._leafless import Interval

if TYPE_CHECKING:
    from typing import Literal, TypeAlias

    from ._leafless import Interval, Proof

    _StopReason: TypeAlias = Literal["tolerance", "budget", "exhausted"]
    _Answer: TypeAlias = Literal["yes", "no", "undecided"]


class Membership(IntEnum):
    """The position of a point: inside, outside or undecided. UNDECIDED has no truth value, so compare:
    `answer == INSIDE`."""

    OUTSIDE = 0
    INSIDE = 1
    UNDECIDED = 2

    def __bool__(self) -> bool:
        if self is Membership.UNDECIDED:
            raise ValueError("the answer is UNDECIDED: compare it with INSIDE or OUTSIDE")
        return self is Membership.INSIDE


class Tag(IntEnum):
    """The state of a cell: EMPTY (outside), BRANCH (split), PARTIAL (undecided) or FULL (inside)."""

    EMPTY = 0
    BRANCH = 1
    PARTIAL = 2
    FULL = 3


class VoxelKind(IntEnum):
    """The kind of a voxel: outside, inside, on the boundary, or refined into the voxels that follow it."""

    OUTSIDE = 0
    INSIDE = 1
    BOUNDARY = 2
    REFINED = 3


@dataclass(frozen=True, eq=False)
class Distance:
    """The distance of one point from a solid."""

    #: The distance.
    distance: Interval
    #: A point of the boundary at that distance, shape (3,); NaN if none is known.
    nearest: npt.NDArray[np.float64]
    #: The number of the triangle or surface at `nearest`; −1 if none is known.
    surface: int
    #: True if the interval is wider than the tolerance.
    undecided: bool


@dataclass(frozen=True, eq=False)
class Distances:
    """The distances of points from a solid."""

    #: The distances, one interval a point.
    distance: Intervals
    #: Points of the boundary at these distances, shape (n, 3); NaN where none is known.
    nearest: npt.NDArray[np.float64]
    #: The numbers of the triangles or surfaces at `nearest`; −1 where none is known.
    surface: npt.NDArray[np.int64]
    #: True where the interval is wider than the tolerance.
    undecided: npt.NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.distance)


@dataclass(frozen=True, eq=False)
class RayHit:
    """The first hit of one ray on a solid."""

    #: True if something stopped the ray.
    hit: bool
    #: The distance along the ray; infinite without a hit. The ray is proven outside before the lower end, inside at the
    #: upper end.
    distance: Interval
    #: The outward normal at the hit, shape (3,); NaN without a hit.
    normal: npt.NDArray[np.float64]
    #: The number of the triangle that was hit; −1 if none is known.
    surface: int


@dataclass(frozen=True, eq=False)
class RayHits:
    """The first hits of rays on a solid."""

    #: True where something stopped a ray.
    hit: npt.NDArray[np.bool_]
    #: The distances along the rays; infinite without a hit. A ray is proven outside before the lower end, inside at the
    #: upper end.
    distance: Intervals
    #: Outward normals at the hits, shape (n, 3); NaN without a hit.
    normal: npt.NDArray[np.float64]
    #: The numbers of triangles that were hit; −1 where none is known.
    surface: npt.NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.hit)


@dataclass(frozen=True)
class MassProperties:
    """Volume, centroid and inertia of a solid."""

    #: The volume (cubic model units).
    volume: Interval
    #: The centroid, shape (3,); `None` if the solid may be empty.
    centroid: Intervals | None
    #: The inertia tensor about the origin for density 1, shape (3, 3).
    inertia_about_origin: Intervals
    #: The inertia tensor about the centroid for density 1, shape (3, 3).
    inertia_about_centroid: Intervals
    #: True if rounding is the only uncertainty.
    exact: bool
    #: Whether the solid may go on beyond the frame.
    clipped: bool
    #: The proven part of the solid; the rest counts as undecided.
    proof: Proof
    #: Why it ended.
    stop_reason: _StopReason
    #: How many times a cell was split.
    splits: int

    def __repr__(self) -> str:
        centroid = "unknown" if self.centroid is None else f"({', '.join(map(repr, self.centroid))})"
        return f"<MassProperties: volume {self.volume}, centroid {centroid}>"


@dataclass(frozen=True)
class SurfaceArea:
    """The area of a solid's boundary."""

    #: The area (square model units).
    area: Interval
    #: Whether the solid may go on beyond the frame.
    clipped: bool
    #: Why it ended.
    stop_reason: _StopReason
    #: How many times a cell was split.
    splits: int

    def __repr__(self) -> str:
        return f"<SurfaceArea: {self.area}>"


@dataclass(frozen=True)
class BoundingBox:
    """A bounding box with proven bounds of each coordinate."""

    #: The lower and the upper corner, shape (2, 3); `None` if the solid is proven empty.
    corners: Intervals | None
    #: True if the solid is proven not to be empty.
    occupied: bool
    #: Whether the solid may go on beyond the frame.
    clipped: bool
    #: Why it ended.
    stop_reason: _StopReason
    #: How many times a cell was split.
    splits: int

    def __repr__(self) -> str:
        if self.corners is None:
            return "<BoundingBox: empty>"
        low, high = (", ".join(map(repr, corner)) for corner in self.corners)
        return f"<BoundingBox: ({low}) to ({high})>"


@dataclass(frozen=True)
class Interference:
    """The verdict whether two solids overlap, with its evidence."""

    #: "disjoint" (proven: no common point except on the boundaries), "overlapping" (proven) or "undecided".
    verdict: Literal["disjoint", "overlapping", "undecided"]
    #: The volume of the intersection (cubic model units).
    volume: Interval
    #: The centre and the radius of a ball that lies in both solids, if an overlap is proven.
    ball: tuple[tuple[float, float, float], float] | None
    #: Whether a solid may go on beyond the frame.
    clipped: bool
    #: How many cells of each were split.
    splits: tuple[int, int]

    def __repr__(self) -> str:
        return f"<Interference: {self.verdict}, volume {self.volume}>"


@dataclass(frozen=True, eq=False)
class Clearance:
    """The distance between two solids."""

    #: The distance (model units); 0 where the solids overlap.
    distance: Interval
    #: One point of each solid, shape (2, 3), no further apart than the upper bound; `None` if unknown.
    points: npt.NDArray[np.float64] | None
    #: A lower bound of the depth of an overlap; 0 if the solids do not overlap or nothing is known.
    depth: float
    #: Why it ended.
    stop_reason: _StopReason
    #: Whether a solid may go on beyond the frame.
    clipped: bool
    #: How many cells of each were split.
    splits: tuple[int, int]

    def __repr__(self) -> str:
        return f"<Clearance: {self.distance}>"


@dataclass(frozen=True)
class Gap:
    """The verdict whether two solids are far enough apart."""

    #: "yes" (proven), "no" (proven) or "undecided".
    verdict: _Answer
    #: The bounds of the distance when the verdict was found.
    distance: Interval

    def __repr__(self) -> str:
        return f"<Gap: {self.verdict}, distance {self.distance}>"


@dataclass(frozen=True, eq=False)
class Deviation:
    """The deviation between the boundaries of two solids."""

    #: The Hausdorff distance: the greatest distance of a boundary point of one solid from the boundary of the other.
    distance: Interval
    #: The greatest distance of a boundary point of the first solid from the second boundary.
    a_to_b: Interval
    #: The greatest distance of a boundary point of the second solid from the first boundary.
    b_to_a: Interval
    #: A point of one boundary and the nearest point of the other at that distance, shape (2, 3); `None` if unknown.
    points: npt.NDArray[np.float64] | None
    #: Why it ended.
    stop_reason: _StopReason

    def within(self, distance: float) -> _Answer:
        """Returns "yes" if the boundaries are within a `distance` (model units) of each other, else "no" or
        "undecided"."""
        if not isinstance(distance, Real):
            raise TypeError(f"distance: must be a number, not {type(distance).__name__}")
        if self.distance <= distance:
            return "yes"
        return "no" if self.distance > distance else "undecided"

    def __repr__(self) -> str:
        return f"<Deviation: {self.distance}>"


@dataclass(frozen=True, eq=False)
class Cells:
    """A list of cells of an octree."""

    #: The level of each cell; 0 is the universe.
    level: npt.NDArray[np.uint8]
    #: The indices of each cell along x, y and z, counted in cells of its level, shape (n, 3).
    at: npt.NDArray[np.uint32]
    #: The tag of each cell.
    tag: npt.NDArray[np.uint8]

    def __len__(self) -> int:
        return len(self.level)


@dataclass(frozen=True, eq=False)
class DexelRays:
    """The intervals of a tri-dexel model along one axis."""

    #: The index of the ray on the other two axes, the lower axis first, shape (n, 2).
    ray: npt.NDArray[np.uint32]
    #: The coordinates where intervals begin.
    start: npt.NDArray[np.float64]
    #: The coordinates where intervals end.
    end: npt.NDArray[np.float64]
    #: The material of each interval.
    material: npt.NDArray[np.uint32]

    def __len__(self) -> int:
        return len(self.start)


for _kind in (
    *(Membership, Tag, VoxelKind, Distance, Distances, RayHit, RayHits, MassProperties, SurfaceArea, BoundingBox),
    *(Interference, Clearance, Gap, Deviation, Cells, DexelRays),
):
    _kind.__module__ = "leafless"
