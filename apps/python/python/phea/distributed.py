"""Campaigns and sweeps on a cluster: phea's chunks, an engine's scheduling.

Chunks of runs are pure tasks of a Dask client or of Ray; retries, spilling, dashboards and
autoscaling are the engine's. The rows arrive in one table on the computer that asks, in the order
of the runs, and are the bytes of `Project.campaign` on one machine.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from phea import _native
from phea._extras import imported
from phea._request import translated
from phea.errors import Stopped

if TYPE_CHECKING:
    from phea._project import Progress, Project
    from phea._record import Answer
    from phea._texts import PathLike, Value
    from phea.results import Campaign

__all__ = ["WorkerMismatch", "campaign", "identity", "sweep"]

# Runs of a chunk: some seconds of work, so that the engine's overhead is small.
_CHUNK = 1000
# Times that an engine may repeat a chunk whose worker has died.
_RETRIES = 3

Result = TypeVar("Result")


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


def identity() -> str:
    """Version and build of this phea: two that agree compute the same bytes.

    Examples
    --------
    >>> identity() == identity(), identity().startswith(_native.VERSION)
    (True, True)
    """
    with open(str(_native.__file__), "rb") as library:
        build = hashlib.sha256(library.read()).hexdigest()
    return f"{_native.VERSION} ({build[:16]})"


class _Engine(Protocol):
    """What a campaign needs of an engine."""

    def identities(self) -> dict[str, str]:
        """Identity of the phea of each worker, by its name."""

    def results(
        self, work: Callable[..., Result], arguments: Sequence[tuple[Any, ...]]
    ) -> Generator[tuple[int, Result], None, None]:
        """Results by the places of their arguments, in the order in which they arrive."""


class _Dask:
    """Client of Dask's `distributed`."""

    def __init__(self, client: Any) -> None:
        self._client = client

    def identities(self) -> dict[str, str]:
        found: dict[str, str] = self._client.run(identity)
        return found

    def results(
        self, work: Callable[..., Result], arguments: Sequence[tuple[Any, ...]]
    ) -> Generator[tuple[int, Result], None, None]:
        distributed = imported("distributed", "dask")
        submit = self._client.submit
        futures = {submit(work, *one, pure=False, retries=_RETRIES): i for i, one in enumerate(arguments)}
        try:
            for future in distributed.as_completed(list(futures)):
                yield futures[future], future.result()
        finally:
            self._client.cancel(list(futures))


class _Ray:
    """The module `ray`, connected to a cluster."""

    def __init__(self, ray: Any) -> None:
        self._ray = ray

    def identities(self) -> dict[str, str]:
        from importlib import import_module

        affinity = import_module("ray.util.scheduling_strategies").NodeAffinitySchedulingStrategy
        remote = self._ray.remote(num_cpus=0)(identity)
        nodes = [node["NodeID"] for node in self._ray.nodes() if node["Alive"]]
        found = [remote.options(scheduling_strategy=affinity(node, soft=False)).remote() for node in nodes]
        return dict(zip(nodes, self._ray.get(found), strict=True))

    def results(
        self, work: Callable[..., Result], arguments: Sequence[tuple[Any, ...]]
    ) -> Generator[tuple[int, Result], None, None]:
        remote = self._ray.remote(max_retries=_RETRIES)(work)
        places = {remote.remote(*one): i for i, one in enumerate(arguments)}
        waiting = list(places)
        try:
            while waiting:
                done, waiting = self._ray.wait(waiting, num_returns=1)
                for reference in done:
                    yield places[reference], self._ray.get(reference)
        finally:
            for reference in waiting:
                self._ray.cancel(reference, force=True)


def _engine_of(client: Any) -> _Engine:
    if getattr(client, "__name__", None) == "ray":
        return _Ray(client)
    if all(hasattr(client, name) for name in ("submit", "run", "cancel")):
        return _Dask(client)
    if callable(getattr(client, "results", None)):
        engine: _Engine = client
        return engine
    raise TypeError(f"client is a distributed.Client or the module ray, not {client!r}")


def _expect_same_phea(engine: _Engine) -> None:
    own = identity()
    others = {name: found for name, found in engine.identities().items() if found != own}
    if others:
        raise WorkerMismatch(own, others)


def _lines(project: Project, seed: int, first: int, end: int) -> str:
    """Lines of a chunk, computed by a worker with one thread."""
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
        If the phea of a worker is another one, before any run.
    """
    from phea._progress import callable_of

    if chunk < 1:
        raise ValueError(f"a chunk has at least one run, not {chunk}")
    engine = _engine_of(client)
    _expect_same_phea(engine)
    table = _native.CampaignTable(os.fspath(out))
    try:
        with callable_of(progress, "campaign") as report:
            try:
                stored = table.stored(project._native, seed, runs)
            except _native.Refused as refused:
                raise translated(refused) from None
            chunks = [(first, min(first + chunk, runs)) for first in range(stored, runs, chunk)]
            arguments = [(project, seed, first, end) for first, end in chunks]
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


def _answer(project: Project, values: Mapping[str, Value], command: str, options: dict[str, Any]) -> Any:
    """Answer of a command on a project with other values, computed by a worker."""
    return getattr(project.set(values), command)(**options)


def sweep(
    project: Project,
    path: str,
    values: Sequence[Value],
    command: str,
    client: Any,
    **options: Any,
) -> list[Answer]:
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
    if command.startswith("_") or not callable(getattr(project, command, None)):
        raise ValueError(f"no command is called {command!r}")
    engine = _engine_of(client)
    _expect_same_phea(engine)
    arguments = [(project, {path: value}, command, options) for value in values]
    with closing(engine.results(_answer, arguments)) as results:
        found = dict(results)
    return [found[place] for place in range(len(arguments))]
