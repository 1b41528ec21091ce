"""To and from the arrays of other packages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from ._leafless import Mesh


def indices(faces: npt.ArrayLike) -> npt.NDArray[np.integer[Any]]:
    """An array of integers, refused if it holds anything else."""
    faces = np.asarray(faces)
    if faces.size == 0:
        return np.zeros((0, 3), np.int64)
    if faces.dtype.kind not in "iu":
        raise TypeError(f"faces: must be whole numbers, not {faces.dtype}")
    return faces


def samples(array: npt.ArrayLike, axes_reversed: bool) -> tuple[npt.NDArray[Any], str, tuple[int, int, int]]:
    """The array with x varying fastest, the name of its type, and the numbers of samples along x, y and z."""
    array = np.asarray(array)
    if array.ndim != 3:
        raise ValueError(f"array: must have three axes, not {array.ndim}")
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
