"""Progress of a command: a bar on the terminal, or a callable."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from phea._project import Progress

# Width of the bar, in characters.
_WIDTH = 30


@contextmanager
def callable_of(progress: Progress, name: str) -> Iterator[Callable[[str, float], object] | None]:
    """The callable for a value of ``progress``; a bar is removed at the end."""
    if progress is False or progress is None:
        yield None
    elif progress is True:
        bar = _Bar(name)
        try:
            yield bar
        finally:
            bar.close()
    elif callable(progress):
        yield progress
    else:
        raise TypeError(f"progress is True, False or a callable of stage and fraction, not {progress!r}")


class _Bar:
    """A line that is written again: fraction and stage."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._length = 0

    def __call__(self, stage: str, fraction: float) -> None:
        done = round(_WIDTH * fraction)
        line = f"{self._name} [{'#' * done}{'.' * (_WIDTH - done)}] {100 * fraction:3.0f} % {stage}"
        self._write(line)

    def _write(self, line: str) -> None:
        sys.stderr.write("\r" + line.ljust(self._length))
        sys.stderr.flush()
        self._length = len(line)

    def close(self) -> None:
        """Removes the line."""
        if self._length:
            self._write("")
            sys.stderr.write("\r")
            sys.stderr.flush()
