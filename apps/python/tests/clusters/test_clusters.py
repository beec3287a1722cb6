"""Campaigns and alternatives on the engines themselves: Dask and Ray, with a worker that dies."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import phea
from phea import distributed
from rigs import rig_with_alternatives

RUNS = 2000


@pytest.fixture(scope="module")
def project() -> phea.Project:
    return phea.example("benchmark/campaign")


@pytest.fixture(scope="module")
def rows(project: phea.Project) -> bytes:
    return project.campaign(runs=RUNS, files=False).files["runs.csv"]


@pytest.fixture(scope="module")
def dask() -> Iterator[Any]:
    engine = pytest.importorskip("distributed")
    with engine.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with engine.Client(cluster) as client:
            yield client


@pytest.fixture(scope="module")
def ray() -> Iterator[Any]:
    engine = pytest.importorskip("ray")
    engine.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    yield engine
    engine.shutdown()


@pytest.mark.parametrize("chunk", [7, 100, 1000])
def test_dask_has_the_bytes_of_one_machine(
    project: phea.Project, rows: bytes, dask: Any, tmp_path: Path, chunk: int
) -> None:
    table = tmp_path / "runs.csv"
    answer = distributed.campaign(project, runs=RUNS, out=table, client=dask, chunk=chunk)
    assert table.read_bytes() == rows and answer.complete


def test_a_worker_that_dies_costs_its_chunk_alone(
    project: phea.Project, rows: bytes, dask: Any, tmp_path: Path
) -> None:
    table = tmp_path / "runs.csv"
    killed = threading.Event()

    def kill_one(stage: str, fraction: float) -> None:
        if not killed.is_set() and fraction > 0.2:
            killed.set()
            victim = next(iter(dask.run(os.getpid).values()))
            os.kill(victim, signal.SIGKILL)

    distributed.campaign(project, runs=RUNS, out=table, client=dask, chunk=50, progress=kill_one)
    assert killed.is_set() and table.read_bytes() == rows


def test_ray_has_the_bytes_of_one_machine(
    project: phea.Project, rows: bytes, ray: Any, tmp_path: Path
) -> None:
    table = tmp_path / "runs.csv"
    answer = distributed.campaign(project, runs=RUNS, out=table, client=ray, chunk=100)
    assert table.read_bytes() == rows and answer.complete


def check_alternatives(client: Any) -> None:
    project = rig_with_alternatives()
    found, whole = distributed.alternatives(project, client), project.alternatives()
    assert found.json_text == whole.json_text and found.text == whole.text
    assert dict(found.files) == dict(whole.files)


def test_dask_judges_alternatives(dask: Any) -> None:
    check_alternatives(dask)


def test_ray_judges_alternatives(ray: Any) -> None:
    check_alternatives(ray)
