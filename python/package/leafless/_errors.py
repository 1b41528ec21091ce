"""Why an operation was refused. Nothing is changed, and nothing half-made is returned, when one of these is raised.

What the operating system refuses is an `OSError`, and memory that cannot be had a `MemoryError`, as elsewhere in Python.
"""


class Error(Exception):
    """Any error of the library."""


class ArgumentError(Error, ValueError):
    """An argument is outside of its documented range; the message begins with the name of the argument."""


class FrameMismatchError(Error, ValueError):
    """Two octrees or models do not lie on one lattice."""


class FormatError(Error, ValueError):
    """A file is of no known format, or is damaged."""


class MeshError(Error, ValueError):
    """Vertices and triangles do not make a mesh."""


class LimitError(Error):
    """A result would have, or has, more nodes or bytes than the caller allowed."""


class CancelledError(Error):
    """The caller asked to stop."""


for _error in (Error, ArgumentError, FrameMismatchError, FormatError, MeshError, LimitError, CancelledError):
    _error.__module__ = "leafless"
