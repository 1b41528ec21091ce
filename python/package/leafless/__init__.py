"""A solid-modelling kernel: certified, closed and exact Booleans on leaf-free octrees.

A `Solid` is anything that has a shape: an expression of half-spaces (`Csg`), a triangle mesh (`Mesh`), a stored octree
(`Octree`), an array of samples (`Volume`), or a shape of your own (`Shape`). Every solid answers queries about points,
rays and distances in arrays of NumPy. Every solid can be measured, compared with another one, built into an octree, and
meshed.

Answers are proven. A point is INSIDE, OUTSIDE or UNDECIDED. A volume or a distance is an interval that contains the
truth. You choose how narrow the interval becomes.

>>> plate = Csg.cuboid([0, 0, 0], [80, 60, 10])
>>> bore = Csg.cylinder_between([20, 30, -1], [20, 30, 11], 8)
>>> part = plate - bore
>>> measure(part, tolerance=1e-6).volume
45989.3798 ± 0.0048
>>> part.contains([[1, 1, 1], [20, 30, 5]])
array([1, 0], dtype=uint8)

Functions that may take long accept the keyword arguments `threads` (0: all processors), `max_bytes`, `max_nodes`,
`max_splits` and `progress` (a function of the part done, a bar of tqdm, or True). Ctrl-C interrupts them. No result
depends on the number of threads.
"""

from ._answers import (
    BoundingBox,
    Cells,
    Clearance,
    Deviation,
    DexelRays,
    Distance,
    Distances,
    Gap,
    Interference,
    MassProperties,
    Membership,
    RayHit,
    RayHits,
    SurfaceArea,
    Tag,
    VoxelKind,
)
from ._errors import (
    ArgumentError,
    CancelledError,
    Error,
    FormatError,
    FrameMismatchError,
    LimitError,
    MeshError,
)
from ._files import map as map, open as open, save
from ._intervals import Intervals
from ._leafless import (
    Affine,
    Channel,
    Csg,
    DexelSolid,
    Frame,
    Interval,
    LazyOctree,
    Mesh,
    Octree,
    Picture,
    Proof,
    Shape,
    Solid,
    SurfaceReport,
    TriDexel,
    Volume,
    VoxelRecords,
    bounding_box,
    build,
    clearance,
    deviation,
    dexelize,
    gap_at_least,
    interference,
    measure,
    render,
    simplify,
    surface,
    surface_area,
)

__version__ = "0.0.1"

INSIDE = Membership.INSIDE
OUTSIDE = Membership.OUTSIDE
UNDECIDED = Membership.UNDECIDED

EMPTY = Tag.EMPTY
FULL = Tag.FULL
PARTIAL = Tag.PARTIAL

# `open` and `map` are missing here: `import *` must not hide Python's own.
__all__ = [
    "EMPTY",
    "FULL",
    "INSIDE",
    "OUTSIDE",
    "PARTIAL",
    "UNDECIDED",
    "Affine",
    "ArgumentError",
    "BoundingBox",
    "CancelledError",
    "Cells",
    "Channel",
    "Clearance",
    "Csg",
    "Deviation",
    "DexelRays",
    "DexelSolid",
    "Distance",
    "Distances",
    "Error",
    "FormatError",
    "Frame",
    "FrameMismatchError",
    "Gap",
    "Interference",
    "Interval",
    "Intervals",
    "LazyOctree",
    "LimitError",
    "MassProperties",
    "Membership",
    "Mesh",
    "MeshError",
    "Octree",
    "Picture",
    "Proof",
    "RayHit",
    "RayHits",
    "Shape",
    "Solid",
    "SurfaceArea",
    "SurfaceReport",
    "Tag",
    "TriDexel",
    "Volume",
    "VoxelKind",
    "VoxelRecords",
    "bounding_box",
    "build",
    "clearance",
    "deviation",
    "dexelize",
    "gap_at_least",
    "interference",
    "measure",
    "render",
    "save",
    "simplify",
    "surface",
    "surface_area",
]
