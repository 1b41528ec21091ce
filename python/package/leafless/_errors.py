"""Exceptions of the library. An operation that raises one of them changes nothing and returns nothing half-made.

As elsewhere in Python, a refusal of the operating system is an `OSError`, and a lack of memory is a `MemoryError`.
"""


class Error(Exception):
    """The base class of the library's errors."""


class ArgumentError(Error, ValueError):
    """An argument is outside its documented range. The message begins with the argument's name."""


class FrameMismatchError(Error, ValueError):
    """Two octrees or models lie on different lattices."""


class FormatError(Error, ValueError):
    """A file has no known format, or is damaged."""


class MeshError(Error, ValueError):
    """Vertices and triangles do not form a mesh."""


class LimitError(Error):
    """A result has, or would have, more nodes or bytes than the caller allowed."""


class CancelledError(Error):
    """The caller cancelled the operation."""


for _error in (Error, ArgumentError, FrameMismatchError, FormatError, MeshError, LimitError, CancelledError):
    _error.__module__ = "leafless"
