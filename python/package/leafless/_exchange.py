"""Conversion from and to the arrays of other packages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._errors import ArgumentError

if TYPE_CHECKING:
    from ._leafless import Mesh


def _plain(given: npt.ArrayLike, name: str) -> npt.NDArray[Any]:
    """Returns an array of NumPy. Masked elements are refused, because their values mean nothing."""
    parts = given if isinstance(given, (list, tuple)) else [given]
    if any(isinstance(part, np.ma.MaskedArray) and np.ma.is_masked(part) for part in parts):
        raise ArgumentError(f"{name}: must have no masked elements; filled and compressed make a plain array")
    try:
        return np.asarray(given)
    except (TypeError, ValueError) as error:
        raise ArgumentError(f"{name}: must be an array of numbers ({error})") from None


def is_lossy(given: object) -> bool:
    """Returns whether `float` would drop a part of an object, or refuses the object."""
    if isinstance(given, np.ndarray):
        return given.ndim > 0 or given.dtype.kind not in "biuf" or np.ma.is_masked(given)
    return isinstance(given, (complex, np.complexfloating))


def numbers(given: npt.ArrayLike, kind: str, name: str) -> npt.NDArray[Any]:
    """Returns a C-contiguous array of one type. Digits may be rounded; any other loss is refused."""
    array = _plain(given, name)
    if np.dtype(kind).kind == "f":
        if array.dtype.kind not in "biuf":
            raise ArgumentError(f"{name}: must be an array of real numbers, not of {array.dtype}")
    elif array.size > 0:
        if array.dtype.kind not in "iu":
            raise TypeError(f"{name}: must be whole numbers, not {array.dtype}")
        least, greatest = np.iinfo(kind).min, np.iinfo(kind).max
        if array.min() < least or array.max() > greatest:
            raise ArgumentError(f"{name}: must be whole numbers from {least} to {greatest}")
    return np.require(array, kind, ["C", "A"])


def samples(array: npt.ArrayLike, axes_reversed: bool) -> tuple[npt.NDArray[Any], str, tuple[int, int, int]]:
    """Returns the array with x varying fastest, the name of its type, and the numbers of samples along x, y and z."""
    array = _plain(array, "array")
    if array.ndim != 3:
        raise ArgumentError(f"array: must have three axes, not {array.ndim}")
    # In the order z, y, x the last axis varies fastest in memory, which is NumPy's default.
    reversed_ = array if axes_reversed else array.transpose()
    kind = reversed_.dtype.newbyteorder("=").name
    z, y, x = reversed_.shape
    reversed_ = np.require(reversed_, reversed_.dtype.newbyteorder("="), ["C", "A"])
    if kind == "bool":
        reversed_ = reversed_.view(np.uint8)
    return reversed_, kind, (x, y, z)


def to_trimesh(mesh: Mesh) -> Any:
    """Returns the mesh as a `trimesh.Trimesh`."""
    import trimesh  # type: ignore[import, unused-ignore]

    # A `trimesh.Trimesh` is mutable, so it gets its own arrays.
    return trimesh.Trimesh(mesh.vertices.copy(), mesh.faces.astype(np.int64), process=False)
