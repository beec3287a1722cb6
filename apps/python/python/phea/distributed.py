"""Campaigns, alternatives and sweeps on a cluster: phea's tasks, an engine's scheduling.

Chunks of runs and single alternatives are pure tasks of a Dask client or of Ray; retries, spilling,
dashboards and autoscaling are the engine's. The rows arrive in one table on the computer that asks,
in the order of the runs, and the results of alternatives in one answer: they are the bytes of
`Project.campaign` and of `Project.alternatives` on one machine.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, overload

from phea import _native
from phea._commands import MOST_RUNS, MOST_SEED
from phea._engines import engine_of
from phea._request import alternatives_options, answered, translated
from phea._texts import whole
from phea._workers import WorkerMismatch, expect_same_phea, expect_same_phea_here, identity
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

__all__ = ["WorkerMismatch", "alternatives", "campaign", "identity", "sweep"]

# Commands of a sweep: the methods of a project that return an answer.
_COMMANDS = (
    *("check", "size", "linearize", "verify", "design", "simulate", "campaign", "campaign_run"),
    *("alternatives", "bench", "export", "report"),
)
# Runs of a chunk: some seconds of work, so that the engine's overhead is small.
_CHUNK = 1000


def _lines(project: Project, seed: int, first: int, end: int, expected: str) -> str:
    """Lines of a chunk, computed by a worker with one thread."""
    expect_same_phea_here(expected)
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
    expect_same_phea(engine)
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


def _judged(project: Project, options: dict[str, Any], place: int, expected: str) -> bytes:
    """Result of one alternative, computed by a worker."""
    expect_same_phea_here(expected)
    try:
        return _native.alternative_judged(project._native, options, place)
    except _native.Refused as refused:
        raise translated(refused) from None


def alternatives(
    project: Project,
    client: Any,
    *,
    front: str | None = None,
    sweep: str | None = None,
    points: int | None = None,
    frequencies: str | None = None,
    files: bool = True,
    progress: Progress = False,
) -> AlternativesAnswer:
    """Alternatives on a cluster, each a task, with the answer of `Project.alternatives`.

    A task judges one alternative: of the declared load, of a load case, or at a point of a front.
    It uses all cores of its computer, and returns what is printed about the alternative.

    Parameters
    ----------
    client
        A ``distributed.Client``, or the module ``ray`` after ``ray.init()``.
    front, sweep, points, frequencies, files
        As of `Project.alternatives`.
    progress
        ``True`` for a bar, or a callable that takes stage and fraction.

    Raises
    ------
    WorkerMismatch
        If the phea of a worker is another one, before any alternative is judged.

    Examples
    --------
    >>> import phea
    >>> class Here:  # an engine without other processes, in place of a client
    ...     def identities(self):
    ...         return {}
    ...     def results(self, work, arguments):
    ...         yield from ((place, work(*one)) for place, one in enumerate(arguments))
    >>> late = '''
    ... [[alternative]]
    ... name = "late"
    ... set = { "plant.delay" = "1 ms" }
    ... '''
    >>> project = phea.loads(phea.example("qft/unstable_plant").text + late)
    >>> alternatives(project, Here()).json_text == project.alternatives().json_text
    True
    """
    from phea._progress import callable_of
    from phea.answers import AlternativesAnswer

    name = "alternatives"
    options = alternatives_options(front, sweep, points, frequencies, files)
    engine = engine_of(client)
    expect_same_phea(engine)
    results: list[bytes] = []
    with callable_of(progress, name) as report:
        try:
            count = _native.alternatives_tasks(project._native, options)
        except _native.Refused as refused:
            raise translated(refused) from None
        arguments = [(project, options, place, identity()) for place in range(count)]
        # whatever ends the loop, what is queued is cancelled at once
        with closing(engine.results(_judged, arguments)) as arriving:
            for _, result in arriving:
                results.append(result)
                if report is not None and report("judging", len(results) / count) is False:
                    raise Stopped(f"{name} was stopped")
    joined = _native.alternatives_joined
    return answered(
        AlternativesAnswer, name, lambda _: joined(project._native, options, results), False
    )


def _answer(
    project: Project,
    values: Mapping[str, Value],
    command: str,
    options: dict[str, Any],
    expected: str,
) -> Any:
    """Answer of a command on a project with other values, computed by a worker."""
    expect_same_phea_here(expected)
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
    expect_same_phea(engine)
    arguments = [(project, {path: value}, command, options, identity()) for value in values]
    with closing(engine.results(_answer, arguments)) as results:
        found = dict(results)
    return [found[place] for place in range(len(arguments))]
