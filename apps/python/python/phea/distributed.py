"""Campaigns and sweeps on a cluster: phea's chunks, an engine's scheduling.

Chunks of runs are pure tasks of a Dask client or of Ray; retries, spilling, dashboards and
autoscaling are the engine's. The rows arrive in one table on the computer that asks, in the order
of the runs, and are the bytes of `Project.campaign` on one machine.
"""

from __future__ import annotations

import hashlib
import os
import socket
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from difflib import get_close_matches
from functools import cache
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, overload

from phea import _native
from phea._commands import MOST_RUNS, MOST_SEED
from phea._engines import Engine, engine_of
from phea._request import translated
from phea._texts import whole
from phea.errors import Stopped

if TYPE_CHECKING:
    from phea._project import Progress, Project
    from phea._record import Answer
    from phea._texts import PathLike, Value
    from phea.answers import (
        AlternativesAnswer,
        BenchAnswer,
        LinearizeAnswer,
        ReportAnswer,
        SizeAnswer,
        VerifyAnswer,
    )
    from phea.results import Campaign, Check, Design, Simulation

    Values: TypeAlias = Sequence[Value]

__all__ = ["WorkerMismatch", "campaign", "identity", "sweep"]

# Commands of a sweep: the methods of a project that return an answer.
_COMMANDS = (
    *("check", "size", "linearize", "verify", "design", "simulate", "campaign", "campaign_run"),
    *("alternatives", "bench", "report"),
)
# Runs of a chunk: some seconds of work, so that the engine's overhead is small.
_CHUNK = 1000


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


def _expect_same_phea(engine: Engine) -> None:
    own = identity()
    others = {name: found for name, found in engine.identities().items() if found != own}
    if others:
        raise WorkerMismatch(own, others)


def _expect_same_phea_here(expected: str) -> None:
    """The check by a worker itself, which may have joined after the campaign began."""
    if identity() != expected:
        raise WorkerMismatch(expected, {socket.gethostname(): identity()})


def _lines(project: Project, seed: int, first: int, end: int, expected: str) -> str:
    """Lines of a chunk, computed by a worker with one thread."""
    _expect_same_phea_here(expected)
    try:
        return _native.campaign_lines(project._native, seed, first, end, 1)
    except _native.Refused as refused:
        raise translated(refused) from None


def campaign(
    project: Project,
    *,
    runs: int,
    seed: int = 1,
    out: PathLike,
    client: Any,
    chunk: int = _CHUNK,
    progress: Progress = False,
) -> Campaign:
    """Campaign on a cluster, with the rows and the answer of `Project.campaign`.

    Parameters
    ----------
    runs, seed, out
        As of `Project.campaign`; the table that grows is on the computer that asks.
    client
        A ``distributed.Client``, or the module ``ray`` after ``ray.init()``.
    chunk
        Number of runs of a task; the rows do not depend on it.
    progress
        ``True`` for a bar, or a callable that takes stage and fraction.

    Raises
    ------
    WorkerMismatch
        If the phea of a worker is another one, before any run; of a worker that joins later,
        before its first one.
    """
    from phea._progress import callable_of

    whole("runs", runs, 1, MOST_RUNS)
    whole("seed", seed, 0, MOST_SEED)
    whole("chunk", chunk, 1, MOST_RUNS)
    engine = engine_of(client)
    _expect_same_phea(engine)
    table = _native.CampaignTable(os.fspath(out))
    try:
        with callable_of(progress, "campaign") as report:
            try:
                stored = table.stored(project._native, seed, runs)
            except _native.Refused as refused:
                raise translated(refused) from None
            chunks = [(first, min(first + chunk, runs)) for first in range(stored, runs, chunk)]
            arguments = [(project, seed, first, end, identity()) for first, end in chunks]
            # whatever ends the loop, what is queued is cancelled at once
            with closing(engine.results(_lines, arguments)) as results:
                for done in _in_order(results, table.append):
                    if report is not None and report("driving", chunks[done][1] / runs) is False:
                        raise Stopped("campaign was stopped")
    finally:
        table.close()
    return project.campaign(runs=runs, seed=seed, out=out)


def _in_order(
    results: Iterable[tuple[int, str]], append: Callable[[str], None]
) -> Iterator[int]:
    """Appends results in the order of their places; yields the place of each that is appended."""
    early: dict[int, str] = {}
    place = 0
    for index, lines in results:
        early[index] = lines
        while place in early:
            append(early.pop(place))
            yield place
            place += 1


def _answer(
    project: Project,
    values: Mapping[str, Value],
    command: str,
    options: dict[str, Any],
    expected: str,
) -> Any:
    """Answer of a command on a project with other values, computed by a worker."""
    _expect_same_phea_here(expected)
    return getattr(project.set(values), command)(**options)


@overload
def sweep(
    project: Project, path: str, values: Values, command: Literal["check"],
    client: Any, **options: Any,
) -> list[Check]: ...
@overload
def sweep(
    project: Project, path: str, values: Values, command: Literal["size"],
    client: Any, **options: Any,
) -> list[SizeAnswer]: ...
@overload
def sweep(
    project: Project, path: str, values: Values, command: Literal["linearize"],
    client: Any, **options: Any,
) -> list[LinearizeAnswer]: ...
@overload
def sweep(
    project: Project, path: str, values: Values, command: Literal["verify"],
    client: Any, **options: Any,
) -> list[VerifyAnswer]: ...
@overload
def sweep(
    project: Project, path: str, values: Values, command: Literal["design"],
    client: Any, **options: Any,
) -> list[Design]: ...
@overload
def sweep(
    project: Project, path: str, values: Values, command: Literal["simulate"],
    client: Any, **options: Any,
) -> list[Simulation]: ...
@overload
def sweep(
    project: Project, path: str, values: Values, command: Literal["alternatives"],
    client: Any, **options: Any,
) -> list[AlternativesAnswer]: ...
@overload
def sweep(
    project: Project, path: str, values: Values, command: Literal["bench"],
    client: Any, **options: Any,
) -> list[BenchAnswer]: ...
@overload
def sweep(
    project: Project, path: str, values: Values, command: Literal["report"],
    client: Any, **options: Any,
) -> list[ReportAnswer]: ...
@overload
def sweep(
    project: Project, path: str, values: Values, command: str, client: Any, **options: Any
) -> list[Answer]: ...
def sweep(
    project: Project, path: str, values: Values, command: str, client: Any, **options: Any
) -> Sequence[Answer]:
    """Answers of a command for each value of a key, in the order of the values.

    Parameters
    ----------
    path, values
        Path of the key and its values, as of `Project.set`.
    command
        Name of the method, such as ``"verify"``.
    client
        A ``distributed.Client``, or the module ``ray`` after ``ray.init()``.
    options
        Options of the method.
    """
    if command not in _COMMANDS:
        near = get_close_matches(command, _COMMANDS, 1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        raise ValueError(f"no command is called {command!r}{hint}")
    engine = engine_of(client)
    _expect_same_phea(engine)
    arguments = [(project, {path: value}, command, options, identity()) for value in values]
    with closing(engine.results(_answer, arguments)) as results:
        found = dict(results)
    return [found[place] for place in range(len(arguments))]
