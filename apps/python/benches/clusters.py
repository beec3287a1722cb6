"""Campaigns on Dask: two processes relative to one, and what chunks cost beyond their runs.

Two threads without an engine show what two cores of the machine give at that time.
"""

from __future__ import annotations

import statistics
import tempfile
import time
import warnings
from pathlib import Path
from typing import Any

import distributed

import phea
import phea.distributed
from phea import _native

RUNS = 8000
CHUNK = 1000
ROUNDS = 3


def seconds_here(project: phea.Project, threads: int) -> float:
    """Time of all runs in this process, without an engine."""
    start = time.perf_counter()
    for first in range(0, RUNS, CHUNK):
        _native.campaign_lines(project._native, 1, first, first + CHUNK, threads)
    return time.perf_counter() - start


def seconds_on(client: Any, project: phea.Project, folder: Path) -> tuple[float, float]:
    """Time of all rows on the workers of a client, and that of the whole call with its answer."""
    rows = 0.0
    start = time.perf_counter()

    def report(stage: str, fraction: float) -> None:
        nonlocal rows
        rows = time.perf_counter() - start

    table = folder / f"{time.monotonic_ns()}.csv"
    phea.distributed.campaign(
        project, runs=RUNS, out=table, client=client, chunk=CHUNK, progress=report
    )
    return rows, time.perf_counter() - start


def main() -> None:
    """Prints the times and their quotients."""
    warnings.simplefilter("ignore")
    dask: Any = distributed
    project = phea.example("benchmark/campaign")
    here, on_two = (
        statistics.median(seconds_here(project, threads) for _ in range(ROUNDS))
        for threads in (1, 2)
    )
    print(f"{RUNS} runs in this process: {here:.2f} s, with two threads {on_two:.2f} s", flush=True)
    found: dict[int, float] = {}
    for workers in (1, 2):
        with (
            tempfile.TemporaryDirectory() as folder,
            dask.LocalCluster(
                n_workers=workers, threads_per_worker=1, dashboard_address=None
            ) as cluster,
            dask.Client(cluster) as client,
        ):
            client.run(phea.distributed.identity)  # the workers import phea
            times = [seconds_on(client, project, Path(folder)) for _ in range(ROUNDS)]
            rows, whole = (statistics.median(each) for each in zip(*times, strict=True))
            found[workers] = rows
            more = 100 * (rows / here - 1)
            print(f"{workers} processes of Dask: rows in {rows:.2f} s ({more:+.1f} %)", end=", ")
            print(f"with the answer {whole:.2f} s", flush=True)
    print(f"two processes are {found[1] / found[2]:.2f} times as fast as one", end=", ")
    print(f"two threads without an engine {here / on_two:.2f} times as fast as one")


if __name__ == "__main__":
    main()
