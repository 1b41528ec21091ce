"""Octrees that outgrow one machine: built, combined, measured and queried shard by shard.

A sharded octree is a folder, on this machine or at any URL of fsspec. The folder holds a manifest (`manifest.json`),
the *top* of the octree down to a level, and one file for each cell of that level that the top leaves open. Each file is
an ordinary octree on the frame of the whole. It is true of the whole solid and only knows less. So the cell of a
missing or damaged shard is PARTIAL: answers report the doubt, and no answer is wrong.

>>> import leafless as lf, tempfile
>>> from leafless import shards
>>> ball = lf.Csg.ball([0, 0, 0], 1)
>>> parts = shards.build(ball, tempfile.mkdtemp(), depth=7, level=1)
>>> len(parts.codes), parts.missing
(8, {})
>>> parts.join() == lf.build(ball, depth=7)
True
>>> parts.volume == lf.build(ball, depth=7).volume
True

`leafless.distributed` does the same on the workers of Dask. docs/scale.md lists the costs.
"""

from __future__ import annotations

import dataclasses
import hashlib
import json
import os
import warnings
from collections import OrderedDict
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from . import _files, _leafless
from ._answers import MassProperties, Membership, VoxelKind
from ._errors import FormatError
from ._leafless import (
    Frame,
    Interval,
    MassSum,
    Mesh,
    Octree,
    Proof,
    Shard,
    ShardedSolid,
    VoxelRecords,
    join,
    measure_cell,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
    from typing_extensions import Unpack

    from ._leafless import Level, Limits, Solid, _Operation, _Rule

__all__ = [
    "MassSum",
    "MissingShardWarning",
    "Shard",
    "ShardedOctree",
    "ShardedSolid",
    "build",
    "combine",
    "complement",
    "join",
    "measure_cell",
    "open",
    "split",
]

MANIFEST = "manifest.json"
TOP = "top.lfl"
FORMAT = "leafless shards"
VERSION = 1

#: The set operations of two octrees, by name.
OPERATIONS: dict[str, Callable[[Octree, Octree], Any]] = {
    "union": lambda a, b: a | b,
    "intersection": lambda a, b: a & b,
    "difference": lambda a, b: a - b,
    "xor": lambda a, b: a ^ b,
}


class MissingShardWarning(UserWarning):
    """A shard is missing or damaged: its cell is PARTIAL."""


@dataclasses.dataclass(frozen=True)
class Entry:
    """The manifest's entry of one file of a sharded octree."""

    path: str
    bytes: int
    sha256: str
    #: The offset of the octree's first byte in the file.
    offset: int = 0
    #: The Morton code of the cell; −1 for the top.
    code: int = -1
    #: The numbers of nodes, FULL cells and PARTIAL cells in the shard's cell, for each level below the level of the
    #: cell.
    levels: tuple[tuple[int, int, int], ...] = ()

    def told(self) -> dict[str, Any]:
        told: dict[str, Any] = {"path": self.path, "bytes": self.bytes, "sha256": self.sha256}
        if self.offset:
            told["offset"] = self.offset
        return told if self.code < 0 else {"code": self.code, **told, "levels": [list(level) for level in self.levels]}


class Folder:
    """The place of the files of a sharded octree: a folder on this machine, or a URL of fsspec."""

    def __init__(self, url: str | os.PathLike[str]) -> None:
        self.url = os.fspath(url)
        self._is_remote = "://" in self.url

    def path(self, name: str) -> str:
        return f"{self.url.rstrip('/')}/{name}" if self._is_remote else os.path.join(self.url, name)

    def local(self, name: str) -> Path | None:
        """Returns the path of a file on this machine; `None` at a URL."""
        return None if self._is_remote else Path(self.path(name))

    def write(self, name: str, data: bytes) -> None:
        """Writes a file. In a folder it is replaced atomically: at any moment it is the old file or the new one."""
        if self._is_remote:
            with _files._fsspec().open(self.path(name), "wb") as file:
                file.write(data)
            return
        path = Path(self.path(name))
        path.parent.mkdir(parents=True, exist_ok=True)
        draft = path.with_name(f".{path.name}.{os.getpid()}.{os.urandom(4).hex()}")
        try:
            draft.write_bytes(data)
            os.replace(draft, path)
        finally:
            draft.unlink(missing_ok=True)

    def read(self, name: str, offset: int = 0, size: int | None = None) -> bytes:
        """Reads a file, or a range of it."""
        if self._is_remote:
            filesystem, path = _files._fsspec().core.url_to_fs(self.path(name))
            data: bytes = filesystem.cat_file(
                path, None if size is None else offset, None if size is None else offset + size
            )
            return data
        with Path(self.path(name)).open("rb") as file:
            file.seek(offset)
            return file.read() if size is None else file.read(size)


def _name(level: int, code: int) -> str:
    """Returns the name of a shard's file: the octants from the universe down to its cell."""
    return f"{code:0{level}o}.lfl" if level else "0.lfl"


def store(folder: Folder, name: str, octree: Octree) -> Entry:
    """Writes an octree into a folder."""
    data = octree.to_bytes()
    folder.write(name, data)
    return Entry(name, len(data), hashlib.sha256(data).hexdigest())


def store_shard(folder: Folder, level: int, code: int, octree: Octree) -> Entry | bytes:
    """Writes a shard into a folder. A shard whose cell is not split belongs into the top: its octree is returned as
    bytes instead."""
    statistics = octree.statistics()
    if statistics[level]["nodes"] != 1:
        return octree.to_bytes()
    levels = tuple((below["nodes"], below["full"], below["partial"]) for below in statistics[level + 1 :])
    return dataclasses.replace(store(folder, _name(level, code), octree), code=code, levels=levels)


def finish(
    folder: Folder, level: int, top: Octree, made: Iterable[Entry | bytes], source: str | None, **facts: Any
) -> ShardedOctree:
    """Writes the top and the manifest, after the shards have been written. The manifest comes last: a folder without
    one is unfinished."""
    entries: list[Entry] = []
    settled: list[Octree] = []
    for one in made:
        if isinstance(one, Entry):
            entries.append(one)
        else:
            settled.append(Octree.from_bytes(one))
    if settled:
        top = join([top, *settled])
    entries.sort(key=lambda entry: entry.code)
    frame, proof = top.frame, top.proof
    manifest = {
        "format": FORMAT,
        "version": VERSION,
        "frame": {"origin": list(frame.origin), "edge": frame.edge, "depth": frame.depth},
        "level": level,
        "keeps_surfaces": top.keeps_surfaces,
        "proof": {"full": proof.full, "empty": proof.empty, "displacement": proof.displacement},
        "source": source,
        **facts,
        "top": store(folder, TOP, top).told(),
        "shards": [entry.told() for entry in entries],
    }
    folder.write(MANIFEST, _written(manifest))
    return ShardedOctree(folder.url, manifest)


def _written(manifest: dict[str, Any]) -> bytes:
    """Returns a manifest as bytes, one line for each shard."""
    shards = ",\n".join(json.dumps(entry, separators=(",", ":")) for entry in manifest["shards"])
    head = json.dumps({**manifest, "shards": []}, separators=(",", ":"))
    return (head.removesuffix("[]}") + "[\n" + shards + "\n]}\n").encode()


def _checked(manifest: Any, url: str) -> dict[str, Any]:
    """Returns the manifest, or raises `FormatError` if it is invalid."""

    def whole(value: Any, least: int, most: int) -> bool:
        return isinstance(value, int) and not isinstance(value, bool) and least <= value <= most

    def is_file(entry: Any) -> bool:
        if not isinstance(entry, dict) or not isinstance(entry.get("path"), str):
            return False
        path = PurePosixPath(entry["path"])
        is_inside = (
            not path.is_absolute()
            and ".." not in path.parts
            and "\\" not in entry["path"]
            and "://" not in entry["path"]
        )
        numbers = whole(entry.get("bytes"), 0, 2**63) and whole(entry.get("offset", 0), 0, 2**63)
        return is_inside and bool(path.parts) and numbers and isinstance(entry.get("sha256"), str)

    def is_shard(entry: Any) -> bool:
        if not is_file(entry) or not whole(entry.get("code"), 0, 8 ** manifest["level"] - 1):
            return False
        levels = entry.get("levels")
        count = manifest["frame"]["depth"] - manifest["level"]
        return (
            isinstance(levels, list)
            and len(levels) == count
            and all(
                isinstance(level, list) and len(level) == 3 and all(whole(count, 0, 2**63) for count in level)
                for level in levels
            )
        )

    def refuse(what: str) -> FormatError:
        return FormatError(f"{url}: {what}")

    if not isinstance(manifest, dict) or manifest.get("format") != FORMAT:
        raise refuse("is no manifest of a sharded octree")
    if manifest.get("version") != VERSION:
        raise refuse(f"version {manifest.get('version')!r} of the manifest is not known")
    frame = manifest.get("frame")
    if not isinstance(frame, dict) or not {"origin", "edge", "depth"} <= frame.keys():
        raise refuse("the frame is none")
    try:
        Frame(frame["origin"], frame["edge"], frame["depth"])
    except (TypeError, ValueError, OverflowError) as error:
        raise refuse(f"the frame is none: {error}") from None
    if not whole(manifest.get("level"), 0, frame["depth"] - 1):
        raise refuse("the level must be above the frame's depth")
    if not is_file(manifest.get("top")):
        raise refuse("the file of the top is none")
    shards = manifest.get("shards")
    if not isinstance(shards, list) or not all(is_shard(entry) for entry in shards):
        raise refuse("a shard is none")
    codes = [entry["code"] for entry in shards]
    if any(a >= b for a, b in zip(codes, codes[1:])):
        raise refuse("the shards must be in ascending order of their codes")
    return manifest


def _entry(told: dict[str, Any]) -> Entry:
    levels = tuple((level[0], level[1], level[2]) for level in told.get("levels", ()))
    return Entry(told["path"], told["bytes"], told["sha256"], told.get("offset", 0), told.get("code", -1), levels)


class ShardedOctree:
    """An octree in shards. A shard is read when a query needs it.

    A missing or damaged shard causes a `MissingShardWarning` and is listed in `missing`. Its cell is PARTIAL.
    """

    def __init__(self, url: str, manifest: dict[str, Any], *, verify: bool = True, keep: int = 64) -> None:
        self._folder = Folder(url)
        self._manifest = manifest
        self._verify = verify
        self._keep = keep
        self._entries = {entry.code: entry for entry in map(_entry, manifest["shards"])}
        self._shards: OrderedDict[int, Octree] = OrderedDict()
        self._top: Octree | None = None
        self._open: npt.NDArray[np.uint64] | None = None
        self._missing: dict[int, str] = {}

    @property
    def url(self) -> str:
        """The folder or the URL of the files."""
        return self._folder.url

    @property
    def frame(self) -> Frame:
        """The frame of the whole octree."""
        frame = self._manifest["frame"]
        return Frame(frame["origin"], frame["edge"], frame["depth"])

    @property
    def level(self) -> int:
        """The level of the shards' cells."""
        level: int = self._manifest["level"]
        return level

    @property
    def codes(self) -> list[int]:
        """The Morton codes of the cells that have shards, ascending."""
        return list(self._entries)

    @property
    def keeps_surfaces(self) -> bool:
        """True if cells keep the surfaces that cross them."""
        return bool(self._manifest.get("keeps_surfaces"))

    @property
    def proof(self) -> Proof:
        """The proof that the cells give about the source solid."""
        return self.top.proof

    @property
    def source(self) -> str | None:
        """The fingerprint of the source solid, if it has one."""
        source: str | None = self._manifest.get("source")
        return source

    @property
    def manifest(self) -> dict[str, Any]:
        """The parsed manifest."""
        return self._manifest

    @property
    def missing(self) -> dict[int, str]:
        """The codes of the shards that were found missing or damaged, each with the reason. Shards that no query has
        needed yet are not listed: `check` reads all."""
        return dict(self._missing)

    @property
    def top(self) -> Octree:
        """The top: an octree with the cells down to the level of the shards.

        Raises:
            FormatError: the file of the top is damaged, or lies on another frame.
        """
        if self._top is None:
            top = self._read(_entry(self._manifest["top"]))
            if top.frame != self.frame:
                raise FormatError(f"{self._folder.path(TOP)}: does not lie on the frame of the manifest")
            self._top = top
        return self._top

    def _read(self, entry: Entry) -> Octree:
        path = self._folder.local(entry.path)
        # Only a shard with a file of its own can be mapped.
        if path is not None and entry.offset == 0 and path.stat().st_size == entry.bytes:
            if self._verify:
                self._compare(hashlib.sha256(path.read_bytes()).hexdigest(), entry)
            octree = _files.map(path, verify=self._verify)
        else:
            data = self._folder.read(entry.path, entry.offset, entry.bytes)
            if len(data) != entry.bytes:
                raise FormatError(f"{self._folder.path(entry.path)}: has {len(data)} bytes, not {entry.bytes}")
            self._compare(hashlib.sha256(data).hexdigest(), entry)
            octree = Octree.from_bytes(data)
        if not isinstance(octree, Octree):
            raise FormatError(f"{self._folder.path(entry.path)}: is no octree")
        return octree

    def _compare(self, found: str, entry: Entry) -> None:
        if found != entry.sha256:
            raise FormatError(f"{self._folder.path(entry.path)}: the checksum is not that of the manifest")

    def shard(self, code: int) -> Octree | None:
        """Returns the shard of a cell; `None` if the cell has none, or if it is missing or damaged."""
        entry = self._entries.get(code)
        if entry is None or code in self._missing:
            return None
        if code in self._shards:
            self._shards.move_to_end(code)
            return self._shards[code]
        try:
            octree = self._read(entry)
            if octree.frame != self.frame:
                raise FormatError("does not lie on the frame of the manifest")
            if octree.statistics()[self.level]["nodes"] != 1:
                raise FormatError("does not split its cell")
        except (OSError, ValueError) as error:
            self._missing[code] = reason = f"{type(error).__name__}: {error}"
            warnings.warn(
                f"shard {_name(self.level, code)} of {self.url} is PARTIAL: {reason}", MissingShardWarning, stacklevel=3
            )
            return None
        self._shards[code] = octree
        if len(self._shards) > self._keep:
            self._shards.popitem(last=False)
        return octree

    def part(self, code: int) -> Octree:
        """Returns an octree of one cell of the level: its shard, or else the part of the top."""
        return self.shard(code) or self.top.shard(Shard.below(self.level, code))

    def check(self) -> dict[int, str]:
        """Reads all shards and returns `missing`."""
        for code in self._entries:
            self.shard(code)
        return self.missing

    def octrees(self, codes: Iterable[int] | None = None) -> Iterator[Octree]:
        """Iterates over the top and the present shards."""
        yield self.top
        for code in self._entries if codes is None else codes:
            shard = self.shard(code)
            if shard is not None:
                yield shard

    def join(self, **limits: Unpack[Limits]) -> Octree:
        """Joins the shards to one octree. With all shards it has the bytes of a single build. The cells of missing
        shards are PARTIAL."""
        return join(list(self.octrees()), **limits)

    def solid(self, codes: Iterable[int] | None = None) -> ShardedSolid:
        """Returns the shards as a solid for any function that takes a solid, without joining them. `codes` selects
        shards; the cells of other shards are PARTIAL."""
        codes = list(self._entries if codes is None else codes)
        found = [(code, self.shard(code)) for code in codes]
        return ShardedSolid(self.top, self.level, [(code, shard) for code, shard in found if shard is not None])

    def statistics(self) -> list[Level]:
        """Returns the statistics of the joined octree, in the form of `Octree.statistics`. Only the manifest and the
        top are read."""
        above = ((1, 0, 0),) * (self.level + 1)
        known = [(code, above + entry.levels) for code, entry in self._entries.items() if code not in self._missing]
        return _leafless.joined_statistics(self.top, self.level, known)

    @property
    def volume(self) -> Interval:
        """The interval of the volume of the cells (cubic model units)."""
        return self.statistics()[-1]["volume"]

    @property
    def node_count(self) -> int:
        """The number of stored nodes, each counted once."""
        return sum(level["nodes"] for level in self.statistics())

    @property
    def nbytes(self) -> int:
        """The bytes of all files of octrees."""
        total: int = self._manifest["top"]["bytes"] + sum(entry.bytes for entry in self._entries.values())
        return total

    def measure_part(
        self, code: int | None = None, *, tolerance: float = 1e-3, absolute: float = 0.0, **limits: Unpack[Limits]
    ) -> MassSum:
        """Measures the cell of one shard: volume and moments. Without a `code`, the sum contains the top, with open
        cells as unknown. `measure_joined` adds the sums."""
        frame = self.frame
        if code is None:
            # The open cells do not count for the tolerance of the top.
            absolute += len(self._open_cells()) * (frame.edge / 2**self.level) ** 3 * (1 + 1e-9)
            return measure_cell(self.top, frame, tolerance=tolerance, absolute=absolute, **limits)
        return measure_cell(
            self._present(code), frame, self.level, code, tolerance=tolerance, absolute=absolute, **limits
        )

    def measure_joined(self, top: MassSum, parts: Iterable[tuple[int, MassSum]]) -> MassSum:
        """Returns the sum of the top and of shards, given with their codes. Each shard replaces the unknown that the
        top leaves in its cell."""
        for code, part in parts:
            top = top - MassSum.unknown(self.frame, self.level, code) + part
        return top

    def measure(self, *, tolerance: float = 1e-3, absolute: float = 0.0, **limits: Unpack[Limits]) -> MassProperties:
        """Measures volume, centroid and inertia, as `leafless.measure`. Each shard is measured to the tolerance, and
        the sums are exact. Cells of missing shards count as undecided."""
        absolute /= len(self._entries) + 1
        parts = (
            (code, self.measure_part(code, tolerance=tolerance, absolute=absolute, **limits))
            for code in self._entries
            if self.shard(code) is not None
        )
        top = self.measure_part(tolerance=tolerance, absolute=absolute, **limits)
        return self.measure_joined(top, parts).properties

    def _present(self, code: int) -> Octree:
        shard = self.shard(code)
        if shard is None:
            raise LookupError(f"code: no shard of the cell {code} is there")
        return shard

    def _open_cells(self) -> npt.NDArray[np.uint64]:
        if self._open is None:
            self._open = self.top.open_cells(self.level)
        return self._open

    def contains(self, points: ArrayLike) -> Any:
        """Classifies points, as `Octree.contains`. Only the shards of cells in which the top leaves points undecided
        are read, one after the other."""
        rows = np.asarray(points, dtype=np.float64)
        answers = np.atleast_1d(
            np.asarray(self.top.contains(rows.reshape(-1, 3) if rows.ndim == 1 else rows), dtype=np.uint8)
        ).copy()
        places = rows.reshape(-1, 3)
        codes = self.frame.codes(places, self.level)
        undecided = np.flatnonzero((answers == Membership.UNDECIDED) & np.isin(codes, list(self._entries)))
        order = undecided[np.argsort(codes[undecided], kind="stable")]
        for group in np.split(order, np.flatnonzero(np.diff(codes[order])) + 1):
            shard = self.shard(int(codes[group[0]])) if len(group) else None
            if shard is not None:
                answers[group] = shard.contains(places[group])
        return Membership(int(answers[0])) if rows.ndim == 1 else answers

    def _boxes(self) -> tuple[list[int], npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Returns the cells that have shards, with slightly enlarged boxes."""
        codes = list(self._entries)
        all_codes = np.array(codes, dtype=np.uint64)
        at = np.zeros((len(codes), 3))
        for bit in range(self.level):
            for axis in range(3):
                at[:, axis] += ((all_codes >> np.uint64(3 * bit + axis)) & np.uint64(1)).astype(np.float64) * 2.0**bit
        frame = self.frame
        size = frame.edge / 2**self.level
        slack = 1e-9 * (size + np.abs(np.array(frame.origin)).max())
        low = np.array(frame.origin) + at * size
        return codes, low - slack, low + size + slack

    def rays(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        *,
        on: Literal["inner", "outer"] = "inner",
        last: float = float("inf"),
        **limits: Unpack[Limits],
    ) -> Any:
        """Returns the first hits of rays, as `Octree.rays`: a `RayHits`, or a `RayHit` for a single ray. Only shards
        whose cells the rays pass are read."""
        from_, along = (np.asarray(given, dtype=np.float64).reshape(-1, 3) for given in (origins, directions))
        from_, along = np.broadcast_arrays(from_, along)
        codes, low, high = self._boxes()
        passed = np.zeros(len(codes), dtype=bool)
        with np.errstate(divide="ignore", invalid="ignore"):
            for first in range(0, len(from_), 4096):
                start, way = from_[first : first + 4096, None, :], along[first : first + 4096, None, :]
                ends = np.stack([(low - start) / way, (high - start) / way])
                # A ray in the plane of a wall divides 0 by 0. It counts as within.
                near = np.where(np.isnan(ends).any(axis=0), -np.inf, ends.min(axis=0)).max(axis=-1)
                far = np.where(np.isnan(ends).any(axis=0), np.inf, ends.max(axis=0)).min(axis=-1)
                passed |= ((near <= far) & (far >= 0) & (near <= last)).any(axis=0)
        chosen = [code for code, is_passed in zip(codes, passed) if is_passed]
        return self.solid(chosen).rays(origins, directions, on=on, last=last, frame=self.frame, **limits)

    def classify_box(self, bounds: ArrayLike) -> str:
        """Classifies a box (lower and upper corner), as `Octree.classify_box`. The shards of the cells that the box
        meets are joined for this."""
        box = np.asarray(bounds, dtype=np.float64)
        codes, low, high = self._boxes()
        meets = ((low <= box[1]) & (high >= box[0])).all(axis=1)
        chosen = [code for code, is_met in zip(codes, meets) if is_met]
        return join(list(self.octrees(chosen))).classify_box(box)

    def surface_part(
        self, code: int, resolve: Literal["inner", "outer"] = "outer", **limits: Unpack[Limits]
    ) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.uint32]]:
        """Returns the vertices and faces of `surface` in one cell of the level. They need the cell's shard and the
        shards of its neighbours towards +x, +y and +z."""
        near = [self.part(code)]
        near += [self.part(neighbour) for neighbour in _behind(self.level, code)]
        return _leafless.surface_in(join([self.top, *near]), self.level, code, resolve, **limits)

    def surface(self, resolve: Literal["inner", "outer"] = "outer", **limits: Unpack[Limits]) -> Mesh:
        """Makes the surface by marching cubes, as `leafless.surface` of the joined octree with `method="cubes"`: a
        closed mesh. Undecided cells are outside ("inner") or inside ("outer"). At most eight shards are in memory at a
        time, beside the whole mesh."""
        return welded(self.surface_part(code, resolve, **limits) for code in self.surface_codes())

    def surface_codes(self) -> list[int]:
        """Returns the codes of the cells of the level in which the surface may have triangles."""
        if self.keeps_surfaces:
            raise ValueError(
                "an octree that keeps surfaces has few and large cells: join it, and take leafless.surface of that"
            )
        # Outside the frame, before the first cell and behind the last, everything is EMPTY.
        count = 2**self.level
        full, maybe = np.zeros((2, count + 2, count + 2, count + 2), dtype=bool)
        full[1:-1, 1:-1, 1:-1] = self.top.bitmap(self.level)
        maybe[1:-1, 1:-1, 1:-1] = self.top.bitmap(self.level, outer=True)
        # The window holds a cell with its neighbours on both sides. That is more than marching cubes reads, except at
        # the outer sides of the first cells.
        window = np.lib.stride_tricks.sliding_window_view
        is_empty = ~window(maybe, (3, 3, 3)).any(axis=(3, 4, 5))
        is_full = window(full, (3, 3, 3)).all(axis=(3, 4, 5))
        at = np.argwhere(~(is_empty | is_full)).astype(np.uint64)
        codes = np.zeros(len(at), dtype=np.uint64)
        for bit in range(self.level):
            for axis in range(3):
                codes |= (at[:, axis] >> np.uint64(bit) & np.uint64(1)) << np.uint64(3 * bit + axis)
        found: list[int] = np.sort(codes).tolist()
        return found

    def voxels_part(self, code: int | None = None, *, outside: bool = False, **limits: Unpack[Limits]) -> VoxelRecords:
        """Returns the records of `voxels` in the cell of a shard; without a `code`, the records of the top."""
        octree = self.top if code is None else self._present(code)
        found = octree.voxels(outside=outside, **limits)
        if code is None:
            return found
        own = found.codes >> np.uint64(3 * (self.frame.depth - self.level)) == code
        return VoxelRecords(self.frame, found.codes[own], found.levels[own], found.kinds[own])

    def voxels_joined(self, parts: Sequence[VoxelRecords]) -> VoxelRecords:
        """Joins the records of the top, which come first, and of the shards to one list."""
        depth, level = self.frame.depth, self.level
        present = np.array([code for code in self._entries if code not in self._missing], dtype=np.uint64)
        top, codes, levels, kinds = parts[0], [], [], []
        is_whole = np.ones(len(top), dtype=bool)
        for i in np.flatnonzero(top.kinds == VoxelKind.BOUNDARY).tolist():
            # An open cell of the top is covered by shards, and by the cells between them.
            stack = [(int(top.levels[i]), int(top.codes[i]) >> 3 * (depth - int(top.levels[i])))]
            while stack:
                at, cell = stack.pop()
                first, end = (
                    np.searchsorted(present, [cell << 3 * (level - at), (cell + 1) << 3 * (level - at)])
                    if at <= level
                    else (0, 0)
                )
                if first == end:
                    if not is_whole[i]:
                        codes.append(cell << 3 * (depth - at))
                        levels.append(at)
                        kinds.append(int(VoxelKind.BOUNDARY))
                    continue
                is_whole[i] = False
                if at < level:
                    stack.extend((at + 1, cell << 3 | octant) for octant in range(8))
        all_codes = np.concatenate(
            [top.codes[is_whole], np.array(codes, dtype=np.uint64), *(part.codes for part in parts[1:])]
        )
        all_levels = np.concatenate(
            [top.levels[is_whole], np.array(levels, dtype=np.uint8), *(part.levels for part in parts[1:])]
        )
        all_kinds = np.concatenate(
            [top.kinds[is_whole], np.array(kinds, dtype=np.uint8), *(part.kinds for part in parts[1:])]
        )
        order = np.argsort(all_codes, kind="stable")
        return VoxelRecords(self.frame, all_codes[order], all_levels[order], all_kinds[order])

    def voxels(self, *, outside: bool = False, **limits: Unpack[Limits]) -> VoxelRecords:
        """Returns the voxels as records, as `Octree.voxels` of the joined octree. One shard is in memory at a time,
        beside the whole list."""
        codes = [code for code in self._entries if self.shard(code) is not None]
        parts = [self.voxels_part(outside=outside, **limits)]
        parts += [self.voxels_part(code, outside=outside, **limits) for code in codes]
        return self.voxels_joined(parts)

    def note_missing(self, missing: dict[int, str]) -> None:
        """Adds the shards that another process found missing."""
        for code, reason in missing.items():
            if code not in self._missing:
                self._missing[code] = reason
                warnings.warn(
                    f"shard {_name(self.level, code)} of {self.url} is PARTIAL: {reason}",
                    MissingShardWarning,
                    stacklevel=3,
                )

    def pack(self, url: str | os.PathLike[str]) -> ShardedOctree:
        """Writes a copy whose shards lie in one file, one after the other. On object storage each shard is then read as
        a range."""
        folder = Folder(url)
        data, entries = bytearray(), []
        for code, entry in self._entries.items():
            offset = len(data)
            data += self._present(code).to_bytes()
            entries.append(dataclasses.replace(entry, path="shards.lfl.pack", offset=offset))
        folder.write("shards.lfl.pack", bytes(data))
        told = {"top": store(folder, TOP, self.top).told(), "shards": [entry.told() for entry in entries]}
        manifest = {**self._manifest, **told}
        folder.write(MANIFEST, _written(manifest))
        return ShardedOctree(folder.url, manifest, verify=self._verify, keep=self._keep)

    def __len__(self) -> int:
        return len(self._entries)

    def __repr__(self) -> str:
        missing = f", {len(self._missing)} missing" if self._missing else ""
        return f"<ShardedOctree: depth {self.frame.depth}, {len(self)} shards of level {self.level}{missing}, {self.nbytes} bytes>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self.url, self._manifest, self._verify, self._keep)


def _behind(level: int, code: int) -> list[int]:
    """Returns the up to seven neighbours of a cell towards +x, +y and +z."""
    at = [sum((code >> (3 * bit + axis) & 1) << bit for bit in range(level)) for axis in range(3)]
    found = []
    for step in range(1, 8):
        next_ = [at[axis] + (step >> axis & 1) for axis in range(3)]
        if max(next_) < 2**level:
            found.append(sum((next_[axis] >> bit & 1) << (3 * bit + axis) for bit in range(level) for axis in range(3)))
    return found


def welded(parts: Iterable[tuple[npt.NDArray[np.float64], npt.NDArray[np.uint32]]]) -> Mesh:
    """Returns one mesh from the parts of a surface. Vertices of two parts at one place agree to the bit."""
    vertices, faces, count = [np.zeros((0, 3))], [np.zeros((0, 3), dtype=np.uint32)], 0
    for own, triangles in parts:
        vertices.append(own)
        faces.append(triangles + np.uint32(count))
        count += len(own)
    return Mesh(np.concatenate(vertices), np.concatenate(faces))


def _again(url: str, manifest: dict[str, Any], verify: bool, keep: int) -> ShardedOctree:
    return ShardedOctree(url, manifest, verify=verify, keep=keep)


def open(url: str | os.PathLike[str], *, verify: bool = True, keep: int = 64) -> ShardedOctree:
    """Opens the sharded octree in a folder, or at a URL of fsspec. Only the manifest is read. A shard is read when a
    query needs it: it is mapped on this machine, and read as one range elsewhere. At most `keep` shards stay open.

    With `verify` each shard is compared with its checksum, which reads the whole shard. Without it a mapped shard costs
    next to nothing, but damage of the file may go unnoticed.

    Raises:
        FormatError: the manifest is damaged.
        FileNotFoundError: there is no manifest. An interrupted build leaves none.
    """
    folder = Folder(url)
    data = folder.read(MANIFEST)
    try:
        manifest = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise FormatError(f"{folder.path(MANIFEST)}: is no JSON: {error}") from None
    return ShardedOctree(folder.url, _checked(manifest, folder.path(MANIFEST)), verify=verify, keep=keep)


@dataclasses.dataclass(frozen=True)
class Recipe:
    """The parameters for building shards of a solid."""

    frame: Frame
    level: int
    rule: _Rule
    surfaces: bool | float | None

    def shard(self, solid: Solid, shard: Shard, **limits: Unpack[Limits]) -> Octree:
        return _leafless.build(solid, self.frame, rule=self.rule, surfaces=self.surfaces, shard=shard, **limits)

    def top(self, solid: Solid, **limits: Unpack[Limits]) -> Octree:
        return self.shard(solid, Shard.top(self.level), **limits)

    def below(self, solid: Solid, code: int, **limits: Unpack[Limits]) -> Octree:
        return self.shard(solid, Shard.below(self.level, code), **limits)


def recipe(
    solid: Solid,
    frame: Frame | Octree | None,
    depth: int | None,
    level: int,
    rule: _Rule,
    surfaces: bool | float | None,
) -> Recipe:
    """Returns the parameters for building shards of a solid, on the frame that `leafless.build` uses."""
    whole = (
        frame
        if isinstance(frame, Frame) and depth is None
        else _leafless.frame_of(solid, frame, depth=depth, surfaces=surfaces)
    )
    if not 0 <= level < whole.depth:
        raise ValueError(f"level: must be 0 to {whole.depth - 1}, above the frame's depth")
    return Recipe(whole, level, rule, surfaces)


def build(
    solid: Solid,
    url: str | os.PathLike[str],
    frame: Frame | Octree | None = None,
    *,
    depth: int | None = None,
    level: int = 3,
    rule: _Rule = "certified",
    surfaces: bool | float | None = None,
    **limits: Unpack[Limits],
) -> ShardedOctree:
    """Builds the octree of a solid in shards, into a folder or to a URL. Shards are built one after the other, so only
    one is in memory at a time. The other arguments are those of `leafless.build`.

    `level` is the level of the shards' cells. There are at most 8^level shards, and about 4^level for a solid with a
    smooth surface."""
    how, folder = recipe(solid, frame, depth, level, rule, surfaces), Folder(url)
    top = how.top(solid, **limits)
    made = (
        store_shard(folder, level, code, how.below(solid, code, **limits)) for code in top.open_cells(level).tolist()
    )
    return finish(folder, level, top, made, solid.fingerprint)


def split(octree: Octree, url: str | os.PathLike[str], *, level: int = 3, **limits: Unpack[Limits]) -> ShardedOctree:
    """Cuts an octree into shards: the reverse of `ShardedOctree.join`."""
    if not 0 <= level < octree.frame.depth:
        raise ValueError(f"level: must be 0 to {octree.frame.depth - 1}, above the frame's depth")
    folder, top = Folder(url), octree.shard(Shard.top(level), **limits)
    codes = top.open_cells(level).tolist()
    made = (store_shard(folder, level, code, octree.shard(Shard.below(level, code), **limits)) for code in codes)
    return finish(folder, level, top, made, None)


def combine(operation: _Operation, a: ShardedOctree, b: ShardedOctree, url: str | os.PathLike[str]) -> ShardedOctree:
    """Combines two sharded octrees on one frame, shard by shard: "union", "intersection", "difference" or "xor". In the
    cell of a missing shard the result is PARTIAL, unless the other operand decides it."""
    folder, top = Folder(url), combined_top(operation, a, b)
    made = (combined(folder, operation, a, b, code) for code in top.open_cells(a.level).tolist())
    return finish(folder, a.level, top, made, None)


def combined_top(operation: _Operation, a: ShardedOctree, b: ShardedOctree) -> Octree:
    """Returns the top of a result. The cells that it leaves open need shards."""
    if operation not in OPERATIONS:
        raise ValueError(f"operation: must be one of {', '.join(OPERATIONS)}, not {operation!r}")
    if a.frame != b.frame or a.level != b.level:
        raise ValueError("b: must lie on the frame of a, with shards of the same level")
    top: Octree = OPERATIONS[operation](a.top, b.top)
    return top


def combined(folder: Folder, operation: _Operation, a: ShardedOctree, b: ShardedOctree, code: int) -> Entry | bytes:
    """Computes and stores one shard of a result."""
    found: Octree = OPERATIONS[operation](a.part(code), b.part(code))
    return store_shard(folder, a.level, code, found.shard(Shard.below(a.level, code)))


def complement(a: ShardedOctree, url: str | os.PathLike[str]) -> ShardedOctree:
    """Returns the complement of a sharded octree, shard by shard."""
    folder = Folder(url)
    made = (complemented(folder, a, code) for code in a._open_cells().tolist())
    return finish(folder, a.level, ~a.top, made, None)


def complemented(folder: Folder, a: ShardedOctree, code: int) -> Entry | bytes:
    """Computes and stores one shard of a complement."""
    found: Any = ~a.part(code)
    return store_shard(folder, a.level, code, found)
