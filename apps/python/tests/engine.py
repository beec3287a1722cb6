"""An engine without processes, for tests of distributed work."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from typing import Any

from phea import distributed


class Engine:
    """Engine that computes here: in order, reversed, or with a fault."""

    def __init__(self, *, reverse: bool = False, version: str | None = None, fails_at: int = -1) -> None:
        self._reverse = reverse
        self._version = version
        self._fails_at = fails_at
        self.computed = 0
        self.cancelled = 0

    def identities(self) -> dict[str, str]:
        return {"here": self._version or distributed.identity()}

    def results(
        self, work: Callable[..., Any], arguments: Sequence[tuple[Any, ...]]
    ) -> Generator[tuple[int, Any], None, None]:
        places = list(range(len(arguments)))
        try:
            for place in reversed(places) if self._reverse else places:
                if self.computed == self._fails_at:
                    raise RuntimeError("the cluster is gone")
                self.computed += 1
                yield place, work(*arguments[place])
        finally:
            self.cancelled = len(places) - self.computed
