"""Functions that restore pickled objects."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._leafless import Csg, DexelSolid, Mesh, Octree, Picture, TriDexel, Volume, VoxelRecords, map_path

if TYPE_CHECKING:
    from ._leafless import Frame, Proof, _Order, _Samples, _Threshold, _Triple


def csg(steps: list[tuple[str, tuple[Any, ...]]]) -> Csg:
    made: list[Csg] = []
    for name, arguments in steps:
        # A whole number stands for the result of an earlier step: no function of the class takes one.
        parts = (made[part] if type(part) is int else part for part in arguments)
        made.append(getattr(Csg, name)(*parts))
    return made[-1]


def mesh(*parts: Any) -> Mesh:
    return Mesh._restored(*parts)


def voxels(frame: Frame, arrays: tuple[Any, ...], known: tuple[str, str, Proof]) -> VoxelRecords:
    return VoxelRecords._restored(VoxelRecords(frame, *arrays), *known)


def picture(rgba: Any, depth: Any) -> Picture:
    return Picture._restored(rgba, depth)


def dexel_solid(model: TriDexel) -> DexelSolid:
    return model.solid()


def octree(data: bytes) -> Octree:
    return Octree.from_bytes(data)


def tridexel(data: bytes) -> TriDexel:
    return TriDexel.from_bytes(data)


def mapped(path: str, checksum: int) -> Octree | TriDexel:
    """Maps the solid in a file, which must still be the file that was mapped."""
    return map_path(path, checksum=checksum)


def volume(array: _Samples, threshold: _Threshold, origin: _Triple, spacing: _Triple, order: _Order) -> Volume:
    return Volume(array, threshold, origin=origin, spacing=spacing, order=order)
