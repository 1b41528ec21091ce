"""To and from the arrays of other packages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._errors import ArgumentError

if TYPE_CHECKING:
    from ._leafless import Mesh


def whole(array: npt.ArrayLike, kind: str, name: str) -> npt.NDArray[Any]:
    """An array of one type of integers, refused if it holds anything that is none of them."""
    given = np.asarray(array)
    if given.size == 0:
        return np.zeros(given.shape, kind)
    if given.dtype.kind not in "iu":
        raise TypeError(f"{name}: must be whole numbers, not {given.dtype}")
    low, high = np.iinfo(kind).min, np.iinfo(kind).max
    if given.min() < low or given.max() > high:
        raise ArgumentError(f"{name}: must be whole numbers from {low} to {high}")
    return given.astype(kind, copy=False)


def samples(array: npt.ArrayLike, axes_reversed: bool) -> tuple[npt.NDArray[Any], str, tuple[int, int, int]]:
    """The array with x varying fastest, the name of its type, and the numbers of samples along x, y and z."""
    array = np.asarray(array)
    if array.ndim != 3:
        raise ArgumentError(f"array: must have three axes, not {array.ndim}")
    # In the order z, y, x the last axis varies fastest in memory, as NumPy likes it.
    reversed_ = array if axes_reversed else array.transpose()
    kind = reversed_.dtype.newbyteorder("=").name
    z, y, x = reversed_.shape
    reversed_ = np.require(reversed_, reversed_.dtype.newbyteorder("="), ["C", "A"])
    if kind == "bool":
        reversed_ = reversed_.view(np.uint8)
    return reversed_, kind, (x, y, z)


def to_trimesh(mesh: Mesh) -> Any:
    """The mesh as one of trimesh."""
    import trimesh  # type: ignore[import, unused-ignore]

    return trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
