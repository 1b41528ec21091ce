"""Whom progress is reported to."""

from __future__ import annotations

from typing import Any, Callable


def reporter(progress: Any) -> Callable[[float], Any]:
    """A function of the part done (0 to 1): the one given, one that moves a bar of tqdm, or for True a bar that is made here."""
    if progress is True:
        from tqdm.auto import tqdm

        progress = tqdm(total=100, unit="%", bar_format="{l_bar}{bar}| {elapsed}<{remaining}")
    if hasattr(progress, "update") and hasattr(progress, "total"):

        def move(part: float) -> None:
            total = progress.total or 1
            progress.update(part * total - progress.n)
            if part == 1:
                progress.refresh()

        return move
    if callable(progress):
        return progress  # type: ignore[no-any-return]
    raise TypeError("progress: must be a function of the part done, a bar of tqdm, or True")
