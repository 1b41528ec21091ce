"""Reading and writing of files, at paths and at URLs of fsspec."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from . import _leafless
from ._errors import ArgumentError

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._leafless import Csg, Mesh, Octree, Picture, Taking, TriDexel, Volume


def _url(path: str | os.PathLike[str]) -> str | None:
    return path if isinstance(path, str) and "://" in path else None


def _name(url: str) -> str:
    """Returns the file name in a URL, without the query. In a chain (`zip://part.stl::https://…`) it is the first
    name."""
    first = next(part for part in url.split("::") if "://" in part)
    return first.partition("?")[0].rsplit("/", 1)[-1]


def _path(path: str | os.PathLike[str]) -> str:
    try:
        found = os.fspath(path)
    except TypeError:
        found = path  # type: ignore[assignment]
    if not isinstance(found, str):
        raise TypeError(f"path: must be a str or a path, not {type(path).__name__}")
    return found


def _fsspec() -> Any:
    try:
        import fsspec  # type: ignore[import, unused-ignore]
    except ImportError as error:
        raise ImportError("URLs need fsspec: pip install fsspec") from error
    return fsspec


def open(path: str | os.PathLike[str], **taking: Unpack[Taking]) -> Octree | TriDexel | Mesh | Csg | Volume:
    """Reads a file of any known format: an `Octree` or a `TriDexel` (.lfl), a `Mesh` (STL, OBJ, PLY, OFF, 3MF), a `Csg`
    (.csg) or a `Volume` (NRRD, MetaImage).

    `path` is a path, or a URL of any kind that fsspec supports.

    For meshes, `fill` is the fill rule that defines the inside ("nonzero", "positive", "evenodd"). `unit` is the unit
    of the numbers ("mm", "in"), and `to_unit` the unit that they are converted to. `scale` multiplies the coordinates.
    Hair cracks are closed by default; `sew=False` leaves them open.

    For volumes, `threshold` defines which samples are inside. A volume that this package saved remembers its threshold.
    For other files the default is the middle of the range of the sample type: 127.5 for uint8, 32767.5 for uint16, −0.5
    for signed integers, 0 for floating point. A mask of zeros and ones therefore needs `threshold=0.5`.

    Files longer than `max_bytes` are refused, including files that a scene names. `threads` and `progress` are those of
    every long operation.

    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "ball.lfl")
    >>> save(build(Csg.ball([0, 0, 0], 1), depth=5), path)
    >>> open(path).frame.depth
    5
    """
    url = _url(path)
    if url is None:
        return _leafless.open_path(_path(path), **taking)
    with _fsspec().open(url, "rb") as file:
        limit = taking.get("max_bytes")
        # Reads at most one byte more than the limit; then the file is refused.
        data = file.read(limit + 1 if isinstance(limit, int) else -1)
        return _leafless.open_bytes(data, _name(url), **taking)


def map(path: str | os.PathLike[str], *, verify: bool = False) -> Octree | TriDexel:
    """Maps the octree or the tri-dexel model in the file at `path`. Nothing is copied, and only the queried parts are
    ever read, so mapping takes microseconds for any size. All processes that map the file share its pages.

    While the object lives, the file may be replaced or removed, but must not be made shorter or written to. A damaged
    file may give wrong answers. `verify=True` looks for damage first, which reads the whole file.

    A mapped object is pickled as its path and its checksum.

    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "ball.lfl")
    >>> save(build(Csg.ball([0, 0, 0], 1), depth=5), path)
    >>> map(path).contains([0, 0, 0])
    <Membership.INSIDE: 1>
    """
    if _url(path) is not None:
        raise ArgumentError(f"path: only a file of this machine can be mapped, not {path}; open reads it")
    return _leafless.map_path(_path(path), verify=verify)


def save(object: Octree | TriDexel | Mesh | Volume | Picture, path: str | os.PathLike[str]) -> None:
    """Writes an `object` to a file: an `Octree` or a `TriDexel` (.lfl), a `Mesh` (.stl, .obj, .ply, .off, .3mf), a
    `Volume` (.nrrd, with its threshold) or a `Picture` (.png).

    `path` is a path, or a URL of any kind that fsspec can write to. A file at a path is replaced atomically: at any
    moment it is the old file or the new one.

    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "block.stl")
    >>> save(surface(Csg.cuboid([0, 0, 0], [3, 2, 1])), path)
    >>> open(path)
    <Mesh: 8 vertices, 12 triangles>
    """
    url = _url(path)
    if url is None:
        _leafless.save_path(object, _path(path))
        return
    data = _leafless.save_bytes(object, _name(url))
    with _fsspec().open(url, "wb") as file:
        file.write(data)


for _function in (open, map, save):
    _function.__module__ = "leafless"
