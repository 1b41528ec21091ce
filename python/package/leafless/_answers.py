"""What questions are answered with."""

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
    """Whether a point lies inside. UNDECIDED is neither true nor false, so compare: `answer == INSIDE`."""

    OUTSIDE = 0
    INSIDE = 1
    UNDECIDED = 2

    def __bool__(self) -> bool:
        if self is Membership.UNDECIDED:
            raise ValueError("the answer is UNDECIDED: compare it with INSIDE or OUTSIDE")
        return self is Membership.INSIDE


class Tag(IntEnum):
    """What is known of a cell."""

    EMPTY = 0
    BRANCH = 1
    PARTIAL = 2
    FULL = 3


class VoxelKind(IntEnum):
    """What a voxel is."""

    OUTSIDE = 0
    INSIDE = 1
    BOUNDARY = 2
    REFINED = 3


@dataclass(frozen=True, eq=False)
class Distance:
    """How far a point is from a solid."""

    #: The distance.
    distance: Interval
    #: A point of the boundary that is as near, shape (3,); NaN if none is known.
    nearest: npt.NDArray[np.float64]
    #: The number of the triangle or surface there; −1 if none is known.
    surface: int
    #: Whether the interval is wider than the tolerance.
    undecided: bool


@dataclass(frozen=True, eq=False)
class Distances:
    """How far points are from a solid."""

    #: The distances, one interval a point.
    distance: Intervals
    #: Points of the boundary that are as near, shape (n, 3); NaN where none is known.
    nearest: npt.NDArray[np.float64]
    #: The numbers of triangles or surfaces there; −1 where none is known.
    surface: npt.NDArray[np.int64]
    #: Where the interval is wider than the tolerance.
    undecided: npt.NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.distance)


@dataclass(frozen=True, eq=False)
class RayHit:
    """Where a ray first meets a solid."""

    #: Whether anything stopped the ray.
    hit: bool
    #: Before the lower end the ray is proven outside, at the upper end inside; infinite without a hit.
    distance: Interval
    #: The outward normal at the hit, shape (3,); NaN without a hit.
    normal: npt.NDArray[np.float64]
    #: The number of the triangle that was hit; −1 if none is known.
    surface: int


@dataclass(frozen=True, eq=False)
class RayHits:
    """Where rays first meet a solid."""

    #: Whether anything stopped a ray.
    hit: npt.NDArray[np.bool_]
    #: Before the lower end a ray is proven outside, at the upper end inside; infinite without a hit.
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
    #: The inertia tensor about the origin, of density 1, shape (3, 3).
    inertia_about_origin: Intervals
    #: The inertia tensor about the centroid, of density 1, shape (3, 3).
    inertia_about_centroid: Intervals
    #: Whether nothing is in doubt but rounding.
    exact: bool
    #: Whether the solid may go on beyond the frame.
    clipped: bool
    #: What of the solid is proven.
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
    """What is proven of a bounding box."""

    #: The lower and the upper corner, shape (2, 3); `None` if the solid is proven empty.
    corners: Intervals | None
    #: Whether the solid is proven not to be empty.
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
    """Whether two solids overlap."""

    #: "disjoint" (proven: no common point but on the boundaries), "overlapping" (proven) or "undecided".
    verdict: Literal["disjoint", "overlapping", "undecided"]
    #: The volume of what both have in common (cubic model units).
    volume: Interval
    #: A ball that lies in both, as its centre and radius, if an overlap is proven.
    ball: tuple[tuple[float, float, float], float] | None
    #: Whether a solid may go on beyond the frame.
    clipped: bool
    #: How many cells of each were split.
    splits: tuple[int, int]

    def __repr__(self) -> str:
        return f"<Interference: {self.verdict}, volume {self.volume}>"


@dataclass(frozen=True, eq=False)
class Clearance:
    """How far two solids are apart."""

    #: The distance (model units); 0 where they overlap.
    distance: Interval
    #: A point of each, as near as the upper bound says, shape (2, 3), if they are known.
    points: npt.NDArray[np.float64] | None
    #: How deep they overlap at the least; 0 if they do not, or nothing is known.
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
    """Whether two solids are far enough apart."""

    #: "yes" (proven), "no" (proven) or "undecided".
    verdict: _Answer
    #: What is known of the distance by then.
    distance: Interval

    def __repr__(self) -> str:
        return f"<Gap: {self.verdict}, distance {self.distance}>"


@dataclass(frozen=True, eq=False)
class Deviation:
    """How far the boundaries of two solids are from each other."""

    #: The greatest distance of a boundary point of one from the boundary of the other (Hausdorff).
    distance: Interval
    #: The same of points of the first only.
    a_to_b: Interval
    #: The same of points of the second only.
    b_to_a: Interval
    #: Where that is: a point of one boundary and the nearest of the other, shape (2, 3), if it is known.
    points: npt.NDArray[np.float64] | None
    #: Why it ended.
    stop_reason: _StopReason

    def within(self, distance: float) -> _Answer:
        """Whether the boundaries are within a `distance` (model units) of each other: "yes", "no" or "undecided"."""
        if not isinstance(distance, Real):
            raise TypeError(f"distance: must be a number, not {type(distance).__name__}")
        if self.distance <= distance:
            return "yes"
        return "no" if self.distance > distance else "undecided"

    def __repr__(self) -> str:
        return f"<Deviation: {self.distance}>"


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells of an octree."""

    #: Their levels, 0 for the universe.
    level: npt.NDArray[np.uint8]
    #: Their indices along x, y and z in cells of that level, shape (n, 3).
    at: npt.NDArray[np.uint32]
    #: Their tags.
    tag: npt.NDArray[np.uint8]

    def __len__(self) -> int:
        return len(self.level)


@dataclass(frozen=True, eq=False)
class DexelRays:
    """Intervals of a tri-dexel model along an axis."""

    #: The index of the ray on the other two axes, the lower axis first, shape (n, 2).
    ray: npt.NDArray[np.uint32]
    #: Where intervals begin.
    start: npt.NDArray[np.float64]
    #: Where they end.
    end: npt.NDArray[np.float64]
    #: What they are made of.
    material: npt.NDArray[np.uint32]

    def __len__(self) -> int:
        return len(self.start)


for _kind in (
    *(Membership, Tag, VoxelKind, Distance, Distances, RayHit, RayHits, MassProperties, SurfaceArea, BoundingBox),
    *(Interference, Clearance, Gap, Deviation, Cells, DexelRays),
):
    _kind.__module__ = "leafless"
