"""Receivers of progress reports."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable

if TYPE_CHECKING:
    from ._leafless import ProgressBar


def reporter(progress: Callable[[float], object] | ProgressBar | bool) -> Callable[[float], object]:
    """Returns a function of the part done (0 to 1): the given one, or one that moves a bar of tqdm. True makes a new
    bar."""
    if progress is True:
        from tqdm.auto import tqdm  # type: ignore[import, unused-ignore]

        progress = tqdm(total=100, unit="%", bar_format="{l_bar}{bar}| {elapsed}<{remaining}")
    if hasattr(progress, "update") and hasattr(progress, "total"):
        bar: Any = progress

        def move(part: float) -> None:
            total = bar.total or 1
            bar.update(part * total - bar.n)
            if part == 1:
                bar.refresh()

        return move
    if callable(progress):
        return progress
    raise TypeError("progress: must be a function of the part done, a bar of tqdm, or True")
