"""Sharded octrees on the workers of Dask: built, combined, measured, meshed and listed shard by shard. Many poses or
parameters are evaluated at once.

Each function makes a graph of small tasks and computes it with Dask's current scheduler: threads by default, or the
workers of a `dask.distributed.Client`. A task builds, reads or writes one shard. A task depends only on its arguments,
and writes whole files. So if a worker dies, another worker repeats its tasks, with the same bytes. The memory of a
worker is bounded by the size of a shard. Results equal the results of one machine, byte by byte.

Solids travel to the workers by pickle. All workers must see the folder: on one machine any folder, otherwise a URL of
fsspec.

>>> import leafless as lf, tempfile
>>> from leafless import distributed, shards
>>> ball = lf.Csg.ball([0, 0, 0], 1)
>>> parts = distributed.build(ball, tempfile.mkdtemp(), depth=6, level=1)
>>> parts.join() == lf.build(ball, depth=6)
True
>>> distributed.measure(parts, tolerance=0).volume == lf.measure(parts.join(), tolerance=0).volume
True

Progress is Dask's own: `with dask.diagnostics.ProgressBar(): …` for threads, the dashboard of a client for workers.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, Literal, Optional, Tuple, TypeVar

from . import _leafless
from ._answers import Interference, MassProperties
from ._leafless import Affine, Frame, MassSum, Mesh, Octree, VoxelRecords
from .shards import (
    Entry,
    Folder,
    Recipe,
    ShardedOctree,
    combined,
    combined_top,
    complemented,
    finish,
    recipe,
    store_shard,
    welded,
)

if TYPE_CHECKING:
    from ._leafless import Solid, _Operation, _Rule

__all__ = ["build", "combine", "complement", "interference", "measure", "split", "surface", "sweep", "voxels"]

R = TypeVar("R")

#: Threads of one task. A worker uses several processors by several Dask threads.
THREADS = 1


def _dask() -> Any:
    try:
        import dask  # type: ignore[import, unused-ignore]
    except ImportError as error:
        raise ImportError("leafless.distributed needs Dask: pip install dask[distributed]") from error
    return dask


def _each(task: Callable[..., R], arguments: Iterable[tuple[Any, ...]], **shared: Any) -> list[R]:
    """Returns the results of a task for each of many arguments, in their order. Shared arguments travel once."""
    dask = _dask()
    delayed = dask.delayed(task, pure=False, traverse=False)
    given = {name: dask.delayed(value, traverse=False) for name, value in shared.items()}
    done: tuple[R, ...] = dask.compute(*(delayed(*own, **given) for own in arguments))
    return list(done)


def _built(code: int, solid: Solid, folder: Folder, how: Recipe) -> Entry | bytes:
    return store_shard(folder, how.level, code, how.below(solid, code, threads=THREADS))


def build(
    solid: Solid,
    url: str | os.PathLike[str],
    frame: Frame | Octree | None = None,
    *,
    depth: int | None = None,
    level: int = 3,
    rule: _Rule = "certified",
    surfaces: bool | float | None = None,
) -> ShardedOctree:
    """Builds the octree of a solid in shards, each by a task, into a folder or to a URL. The arguments and the
    resulting bytes are those of `leafless.shards.build`."""
    how, folder = recipe(solid, frame, depth, level, rule, surfaces), Folder(url)
    top = how.top(solid)
    made = _each(_built, ((code,) for code in top.open_cells(level).tolist()), solid=solid, folder=folder, how=how)
    return finish(folder, level, top, made, solid.fingerprint)


def _split(code: int, octree: Octree, folder: Folder, level: int) -> Entry | bytes:
    from .shards import Shard

    return store_shard(folder, level, code, octree.shard(Shard.below(level, code), threads=THREADS))


def split(octree: Octree, url: str | os.PathLike[str], *, level: int = 3) -> ShardedOctree:
    """Cuts an octree into shards, as `leafless.shards.split`. A mapped octree travels as its path."""
    from .shards import Shard

    folder, top = Folder(url), octree.shard(Shard.top(level))
    made = _each(
        _split, ((code,) for code in top.open_cells(level).tolist()), octree=octree, folder=folder, level=level
    )
    return finish(folder, level, top, made, None)


def _combined(code: int, operation: _Operation, a: ShardedOctree, b: ShardedOctree, folder: Folder) -> Entry | bytes:
    return combined(folder, operation, a, b, code)


def combine(operation: _Operation, a: ShardedOctree, b: ShardedOctree, url: str | os.PathLike[str]) -> ShardedOctree:
    """Combines two sharded octrees, as `leafless.shards.combine`: "union", "intersection", "difference" or "xor"."""
    folder, top = Folder(url), combined_top(operation, a, b)
    codes = ((code,) for code in top.open_cells(a.level).tolist())
    return finish(folder, a.level, top, _each(_combined, codes, operation=operation, a=a, b=b, folder=folder), None)


def _complemented(code: int, a: ShardedOctree, folder: Folder) -> Entry | bytes:
    return complemented(folder, a, code)


def complement(a: ShardedOctree, url: str | os.PathLike[str]) -> ShardedOctree:
    """Returns the complement of a sharded octree, as `leafless.shards.complement`."""
    folder = Folder(url)
    codes = ((code,) for code in a.top.open_cells(a.level).tolist())
    top: Any = ~a.top
    return finish(folder, a.level, top, _each(_complemented, codes, a=a, folder=folder), None)


def _present(code: int | None, octree: ShardedOctree) -> bool:
    return code is None or octree.shard(code) is not None


#: The result of a task, or `None` if its shard is missing; and the shards that the task found missing.
Found = Tuple[Optional[R], "dict[int, str]"]


def _measured(code: int | None, octree: ShardedOctree, tolerance: float, absolute: float) -> Found[MassSum]:
    if not _present(code, octree):
        return None, octree.missing
    return octree.measure_part(code, tolerance=tolerance, absolute=absolute, threads=THREADS), {}


def measure(octree: ShardedOctree, *, tolerance: float = 1e-3, absolute: float = 0.0) -> MassProperties:
    """Measures volume, centroid and inertia, as `ShardedOctree.measure`, each shard by a task. Sums are exact, so their
    order does not matter. Missing shards count as undecided and are listed in `octree.missing`."""
    absolute /= len(octree) + 1
    top = octree.measure_part(tolerance=tolerance, absolute=absolute)
    codes = octree.codes
    found = _each(_measured, ((code,) for code in codes), octree=octree, tolerance=tolerance, absolute=absolute)
    parts = [(code, part) for code, part in zip(codes, _told(octree, found)) if part is not None]
    return octree.measure_joined(top, parts).properties


def _told(octree: ShardedOctree, found: list[Found[R]]) -> list[R | None]:
    """Returns the results of tasks, and adds the shards that they found missing to the octree's list."""
    for _, missing in found:
        octree.note_missing(missing)
    return [part for part, _ in found]


def _surface(code: int, octree: ShardedOctree, resolve: Literal["inner", "outer"]) -> tuple[Any, Any]:
    return octree.surface_part(code, resolve, threads=THREADS)


def surface(octree: ShardedOctree, resolve: Literal["inner", "outer"] = "outer") -> Mesh:
    """Makes the surface by marching cubes, as `ShardedOctree.surface`, each cell by a task. The mesh is in the caller's
    memory."""
    return welded(_each(_surface, ((code,) for code in octree.surface_codes()), octree=octree, resolve=resolve))


def _voxels(code: int | None, octree: ShardedOctree, outside: bool) -> Found[VoxelRecords]:
    if not _present(code, octree):
        return None, octree.missing
    return octree.voxels_part(code, outside=outside, threads=THREADS), {}


def voxels(octree: ShardedOctree, *, outside: bool = False) -> VoxelRecords:
    """Returns the voxels as records, as `Octree.voxels` of the joined octree, each shard by a task."""
    codes: list[tuple[int | None]] = [(None,), *((code,) for code in octree.codes)]
    parts = _told(octree, _each(_voxels, codes, octree=octree, outside=outside))
    return octree.voxels_joined([part for part in parts if part is not None])


def _interfered(placements: list[Affine], a: Solid, b: Solid, options: dict[str, Any]) -> list[Interference]:
    found: list[Interference] = _leafless.interference(a, b, placements, threads=THREADS, **options)
    return found


def interference(
    a: Solid, b: Solid, placements: Sequence[Any], *, batch: int = 256, **options: Any
) -> list[Interference]:
    """Returns the answers of `leafless.interference` for many placements of the second solid, `batch` placements per
    task. The options and the verdicts are those of `leafless.interference`: all tasks use the frame of all
    placements."""
    placed = [placement if isinstance(placement, Affine) else Affine(placement) for placement in placements]
    if not placed:
        return []
    frame = _leafless.frame_of_pair(a, b, placed, frame=options.pop("frame", None), depth=options.pop("depth", None))
    options["frame"] = frame
    parts = [(placed[first : first + batch],) for first in range(0, len(placed), batch)]
    found = _each(_interfered, parts, a=a, b=b, options=options)
    return [verdict for part in found for verdict in part]


def sweep(task: Callable[..., R], parameters: Iterable[Any]) -> list[R]:
    """Calls a function for each of many parameters, each by a task, and returns the results: parts of a family that are
    built, measured or compared. A tuple is passed as several arguments."""
    return _each(task, (given if isinstance(given, tuple) else (given,) for given in parameters))
