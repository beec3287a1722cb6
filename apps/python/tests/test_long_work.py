"""Long work runs without the interpreter's lock, reports progress and stops when it is told to."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path

import pytest

import phea

Long = Callable[[phea.Project, Callable[[str, float], object]], object]

LONG: dict[str, tuple[str, Long]] = {
    "design": ("ybitu/hose", lambda project, report: project.design(progress=report)),
    "campaign": (
        "benchmark/campaign",
        lambda project, report: project.campaign(runs=10**6, threads=1, progress=report),
    ),
    "simulate": (
        "ybitu/hose",
        lambda project, report: project.set({"simulation.tolerance": 1e-10}).simulate(
            check=True, progress=report
        ),
    ),
}


@pytest.mark.filterwarnings("ignore::phea.ProjectWarning")
@pytest.mark.parametrize("name", ["design", "campaign"])
def test_another_thread_runs_meanwhile(name: str) -> None:
    example, request = LONG[name]
    asked, told = threading.Event(), threading.Event()

    def other() -> None:
        asked.wait()
        told.set()

    thread = threading.Thread(target=other)
    thread.start()

    def report(stage: str, fraction: float) -> bool:
        assert stage and 0.0 <= fraction <= 1.0
        asked.set()
        return not told.is_set()

    with pytest.raises(phea.Stopped):
        request(phea.example(example), report)
    thread.join()


@pytest.mark.filterwarnings("ignore::phea.ProjectWarning")
def test_a_stopped_campaign_continues(tmp_path: Path) -> None:
    project = phea.example("benchmark/campaign")
    table = tmp_path / "runs.csv"
    calls = 0

    def report(stage: str, fraction: float) -> bool:
        nonlocal calls
        calls += 1
        return fraction < 0.2

    with pytest.raises(phea.Stopped) as caught:
        project.campaign(runs=400, threads=1, out=table, files=False, progress=report)
    assert calls > 0 and caught.value.answer is not None
    assert table.read_bytes().count(b"\n") < 400
    project.campaign(runs=400, out=table, files=False)
    whole = project.campaign(runs=400, files=False)
    assert table.read_bytes() == whole.files["runs.csv"]


@pytest.mark.filterwarnings("ignore::phea.ProjectWarning")
@pytest.mark.parametrize("name", LONG)
def test_an_exception_of_the_callable_arrives_unchanged(name: str) -> None:
    class OwnError(Exception):
        pass

    error = OwnError("mine")

    def report(stage: str, fraction: float) -> None:
        raise error

    example, request = LONG[name]
    with pytest.raises(OwnError) as caught:
        request(phea.example(example), report)
    assert caught.value is error
