"""Engines that compute tasks: Dask and Ray."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from typing import Any, Protocol, TypeVar

from phea._extras import imported

# Times that an engine may repeat a task whose worker has died.
_RETRIES = 3

Result = TypeVar("Result")


class Engine(Protocol):
    """What distributed work needs of an engine."""

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
        from phea._workers import identity

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

        from phea._workers import identity

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


def engine_of(client: Any) -> Engine:
    if getattr(client, "__name__", None) == "ray":
        return _Ray(client)
    if all(hasattr(client, name) for name in ("submit", "run", "cancel")):
        return _Dask(client)
    if callable(getattr(client, "results", None)):
        engine: Engine = client
        return engine
    raise TypeError(f"client is a distributed.Client or the module ray, not {client!r}")
