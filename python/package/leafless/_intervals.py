"""Arrays of intervals."""

from __future__ import annotations

from typing import Any, Iterator, SupportsIndex, overload

import numpy as np
import numpy.typing as npt

from ._leafless import Interval


class Intervals:
    """An array of intervals that contain the truth: two arrays of one shape, `lower` and `upper`.

    >>> bounds = Intervals([1.0, 2.0], [1.5, 2.0])
    >>> bounds[0], bounds.width
    (1 to 1.5, array([0.5, 0. ]))
    >>> bounds.contain([1.2, 3.0])
    array([ True, False])

    `<`, `<=`, `>` and `>=` compare element by element, with numbers or with intervals. They are true where they hold
    for every value that the interval contains. Where an interval is in doubt, both `<` and `>` are false.

    >>> bounds < 1.2, bounds > 1.2
    (array([False, False]), array([False,  True]))
    """

    #: Makes NumPy's operators defer to this class.
    __array_ufunc__ = None

    __slots__ = ("__weakref__", "lower", "upper")

    lower: npt.NDArray[np.float64]
    upper: npt.NDArray[np.float64]

    def __init__(self, lower: npt.ArrayLike, upper: npt.ArrayLike) -> None:
        self.lower = np.asarray(lower, dtype=np.float64)
        self.upper = np.asarray(upper, dtype=np.float64)
        if self.lower.shape != self.upper.shape:
            raise ValueError("lower and upper must have one shape")
        if not (self.lower <= self.upper).all():
            raise ValueError("lower must not be above upper, and neither may be NaN")

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of both arrays."""
        return self.lower.shape

    @property
    def middle(self) -> npt.NDArray[np.float64]:
        """The midpoints; where both ends are the same infinity, that infinity."""
        with np.errstate(invalid="ignore"):
            return np.where(self.lower == self.upper, self.lower, 0.5 * self.lower + 0.5 * self.upper)

    @property
    def width(self) -> npt.NDArray[np.float64]:
        """The widths: upper minus lower."""
        with np.errstate(invalid="ignore"):
            return np.where(self.lower == self.upper, 0.0, self.upper - self.lower)

    def contain(self, values: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Returns an array of booleans: whether `values` lie in their intervals."""
        values = np.asarray(values)
        return (self.lower <= values) & (values <= self.upper)

    def __lt__(self, other: Intervals | Interval | npt.ArrayLike) -> npt.NDArray[np.bool_]:
        found: npt.NDArray[np.bool_] = np.less(self.upper, _ends(other)[0])
        return found

    def __le__(self, other: Intervals | Interval | npt.ArrayLike) -> npt.NDArray[np.bool_]:
        found: npt.NDArray[np.bool_] = np.less_equal(self.upper, _ends(other)[0])
        return found

    def __gt__(self, other: Intervals | Interval | npt.ArrayLike) -> npt.NDArray[np.bool_]:
        found: npt.NDArray[np.bool_] = np.greater(self.lower, _ends(other)[1])
        return found

    def __ge__(self, other: Intervals | Interval | npt.ArrayLike) -> npt.NDArray[np.bool_]:
        found: npt.NDArray[np.bool_] = np.greater_equal(self.lower, _ends(other)[1])
        return found

    def __contains__(self, value: object) -> bool:
        raise TypeError("which of the intervals? intervals.contain(values) tells of each")

    # The number of remaining axes decides whether the result is an interval or an array, so no type says which.
    @overload
    def __getitem__(self, index: slice | list[int] | list[bool] | npt.NDArray[Any]) -> Intervals: ...
    @overload
    def __getitem__(self, index: SupportsIndex | tuple[Any, ...]) -> Any: ...
    def __getitem__(self, index: Any) -> Interval | Intervals:
        lower, upper = self.lower[index], self.upper[index]
        if np.ndim(lower) == 0:
            return Interval(float(lower), float(upper))
        return Intervals(lower, upper)

    def __len__(self) -> int:
        return len(self.lower)

    def __iter__(self) -> Iterator[Any]:
        for index in range(len(self)):
            yield self[index]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Intervals):
            return NotImplemented
        return np.array_equal(self.lower, other.lower) and np.array_equal(self.upper, other.upper)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        if self.lower.size > 24:
            return f"<Intervals of shape {self.shape}>"
        return f"Intervals({self._text(())})"

    def _text(self, place: tuple[int, ...]) -> str:
        if len(place) == len(self.shape):
            return repr(Interval(float(self.lower[place]), float(self.upper[place])))
        inner = (self._text((*place, index)) for index in range(self.shape[len(place)]))
        return f"[{', '.join(inner)}]"


def _ends(value: Intervals | Interval | npt.ArrayLike) -> tuple[Any, Any]:
    """Returns the lower and the upper ends of the other side of a comparison."""
    if isinstance(value, (Intervals, Interval)):
        return value.lower, value.upper
    return np.asarray(value), np.asarray(value)


Intervals.__module__ = "leafless"
