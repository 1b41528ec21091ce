"""What batches of questions are answered with."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from ._intervals import Intervals
from ._leafless import Interval


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


for _kind in (Membership, Tag, VoxelKind, Distance, Distances, RayHit, RayHits, Cells, DexelRays):
    _kind.__module__ = "leafless"
