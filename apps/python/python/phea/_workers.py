"""Identity of the phea of every worker: two that agree compute the same bytes."""

from __future__ import annotations

import hashlib
import socket
from functools import cache
from typing import TYPE_CHECKING, Any

from phea import _native

if TYPE_CHECKING:
    from phea._engines import Engine


class WorkerMismatch(RuntimeError):
    """Workers whose phea is another one than that of the computer that asks.

    Attributes
    ----------
    workers
        Identities by the names of these workers.
    """

    workers: dict[str, str]

    def __init__(self, own: str, workers: dict[str, str]) -> None:
        listed = "; ".join(f"{name} has {found}" for name, found in sorted(workers.items()))
        super().__init__(f"every worker needs phea {own}: {listed}")
        self.workers = workers
        self._own = own

    def __reduce__(self) -> tuple[Any, ...]:
        return (WorkerMismatch, (self._own, self.workers))


def identity() -> str:
    """Version and build of this phea: two that agree compute the same bytes.

    Examples
    --------
    >>> identity() == identity(), identity().startswith(_native.VERSION)
    (True, True)
    """
    return f"{_native.VERSION} ({_build()[:16]})"


@cache
def _build() -> str:
    with open(str(_native.__file__), "rb") as library:
        return hashlib.sha256(library.read()).hexdigest()


def expect_same_phea(engine: Engine) -> None:
    """The check by the computer that asks, before any work."""
    own = identity()
    others = {name: found for name, found in engine.identities().items() if found != own}
    if others:
        raise WorkerMismatch(own, others)


def expect_same_phea_here(expected: str) -> None:
    """The check by a worker itself, which may have joined after the work began."""
    if identity() != expected:
        raise WorkerMismatch(expected, {socket.gethostname(): identity()})
