"""Campaigns on Dask: two processes relative to one, and what chunks cost beyond their runs."""

from __future__ import annotations

import statistics
import tempfile
import time
import warnings
from pathlib import Path
from typing import Any

import distributed

import phea
from phea import _native
from phea.distributed import campaign

RUNS = 4000
CHUNK = 1000
ROUNDS = 3


def seconds_here(project: phea.Project) -> float:
    """Time of all runs in this process, with one thread and without an engine."""
    start = time.perf_counter()
    for first in range(0, RUNS, CHUNK):
        _native.campaign_lines(project._native, 1, first, first + CHUNK, 1)
    return time.perf_counter() - start


def seconds_on(client: Any, project: phea.Project, folder: Path, chunk: int) -> tuple[float, float]:
    """Time of all rows on the workers of a client, and that of the whole call with its answer."""
    rows = 0.0
    start = time.perf_counter()

    def report(stage: str, fraction: float) -> None:
        nonlocal rows
        rows = time.perf_counter() - start

    table = folder / f"{time.monotonic_ns()}.csv"
    campaign(project, runs=RUNS, out=table, client=client, chunk=chunk, progress=report)
    return rows, time.perf_counter() - start


def main() -> None:
    """Prints the times and their quotients."""
    warnings.simplefilter("ignore")
    dask: Any = distributed
    project = phea.example("benchmark/campaign")
    here = statistics.median(seconds_here(project) for _ in range(ROUNDS))
    print(f"{RUNS} runs in this process with one thread: {here:.2f} s", flush=True)
    found: dict[int, float] = {}
    for workers in (1, 2):
        with (
            tempfile.TemporaryDirectory() as folder,
            dask.LocalCluster(
                n_workers=workers, threads_per_worker=1, dashboard_address=None
            ) as cluster,
            dask.Client(cluster) as client,
        ):
            seconds_on(client, project, Path(folder), RUNS)  # the workers import phea
            for chunk in (CHUNK, 100):
                times = [seconds_on(client, project, Path(folder), chunk) for _ in range(ROUNDS)]
                rows, whole = (statistics.median(each) for each in zip(*times, strict=True))
                found.setdefault(workers, rows)
                more = 100 * (rows * workers / here - 1)
                print(
                    f"{workers} processes of Dask, chunks of {chunk}: rows in {rows:.2f} s "
                    f"({more:+.1f} % of core time), with the answer {whole:.2f} s",
                    flush=True,
                )
    print(f"two processes are {found[1] / found[2]:.2f} times as fast as one")


if __name__ == "__main__":
    main()
