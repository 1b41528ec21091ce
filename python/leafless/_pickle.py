"""How pickled objects are made again."""

from __future__ import annotations

from typing import Any

from ._leafless import Csg, Mesh, Octree, TriDexel, Volume, map_path


def csg(name: str, arguments: tuple[Any, ...]) -> Csg:
    made: Csg = getattr(Csg, name)(*arguments)
    return made


def mesh(vertices: Any, faces: Any, fill: str) -> Mesh:
    return Mesh(vertices, faces, fill=fill)


def octree(data: bytes) -> Octree:
    return Octree.from_bytes(data)


def tridexel(data: bytes) -> TriDexel:
    return TriDexel.from_bytes(data)


def mapped(path: str, checksum: int) -> Any:
    """The solid in a file that must be the one that was mapped."""
    return map_path(path, checksum=checksum)


def volume(array: Any, threshold: Any, origin: Any, spacing: Any, order: str) -> Volume:
    low, high = threshold
    band = low if high is None else (low, high)
    return Volume(array, band, origin=origin, spacing=spacing, order=order)


def shape(kind: type) -> Any:
    return kind.__new__(kind)
