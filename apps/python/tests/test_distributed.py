"""Campaigns in chunks have the bytes of one machine, whatever the engine does."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from pathlib import Path
from typing import Any

import pytest

import phea
from engine import Engine
from phea import distributed


@pytest.fixture(scope="module")
def project() -> phea.Project:
    return phea.example("benchmark/campaign")


@pytest.fixture(scope="module")
def whole(project: phea.Project) -> phea.Answer:
    return project.campaign(runs=60)


@pytest.mark.parametrize("chunk", [1, 7, 1000])
@pytest.mark.parametrize("reverse", [False, True])
def test_chunks_have_the_bytes_of_one_machine(
    project: phea.Project, whole: phea.Answer, tmp_path: Path, chunk: int, reverse: bool
) -> None:
    table = tmp_path / "runs.csv"
    engine = Engine(reverse=reverse)
    answer = distributed.campaign(project, runs=60, out=table, client=engine, chunk=chunk)
    assert table.read_bytes() == whole.files["runs.csv"]
    assert answer.json_text == whole.json_text
    assert engine.computed == -(-60 // chunk)


def test_a_campaign_continues_after_a_fault(
    project: phea.Project, whole: phea.Answer, tmp_path: Path
) -> None:
    table = tmp_path / "runs.csv"
    with pytest.raises(RuntimeError, match="gone"):
        distributed.campaign(project, runs=60, out=table, client=Engine(fails_at=3), chunk=10)
    assert table.read_bytes().count(b"\n") == 31
    engine = Engine()
    distributed.campaign(project, runs=60, out=table, client=engine, chunk=10)
    assert engine.computed == 3 and table.read_bytes() == whole.files["runs.csv"]


def test_a_worker_with_another_phea_is_refused_by_name(project: phea.Project, tmp_path: Path) -> None:
    engine = Engine(version="0.0.1 (0123456789abcdef)")
    with pytest.raises(distributed.WorkerMismatch, match=r"here has 0\.0\.1") as caught:
        distributed.campaign(project, runs=60, out=tmp_path / "runs.csv", client=engine)
    assert engine.computed == 0 and not (tmp_path / "runs.csv").exists()
    assert caught.value.workers == {"here": "0.0.1 (0123456789abcdef)"}


def test_a_worker_that_joins_later_is_refused_too(
    project: phea.Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Grows(Engine):
        def results(
            self, work: Callable[..., Any], arguments: Sequence[tuple[Any, ...]]
        ) -> Generator[tuple[int, Any], None, None]:
            yield 0, work(*arguments[0])
            monkeypatch.setattr("phea._workers.identity", lambda: "0.0.1 (0123456789abcdef)")
            yield 1, work(*arguments[1])

    table = tmp_path / "runs.csv"
    with pytest.raises(distributed.WorkerMismatch, match=r"has 0\.0\.1"):
        distributed.campaign(project, runs=60, out=table, client=Grows(), chunk=10)
    assert table.read_bytes().count(b"\n") == 11
    with pytest.raises(ValueError, match="did you mean 'verify'"):
        distributed.sweep(project, "line.length", ["1 m"], "verfy", Engine())


def test_false_stops_and_keeps_the_rows(project: phea.Project, tmp_path: Path) -> None:
    table = tmp_path / "runs.csv"
    engine = Engine()
    with pytest.raises(phea.Stopped) as caught:
        distributed.campaign(
            project, runs=60, out=table, client=engine, chunk=10, progress=lambda _, done: done < 0.3
        )
    assert engine.cancelled == 4 and caught.value.answer is None
    assert table.read_bytes().count(b"\n") == 21


def test_a_sweep_answers_in_order(project: phea.Project) -> None:
    hose = phea.example("ybitu/hose")
    lengths = ["1 m", "2 m"]
    answers = distributed.sweep(hose, "line.length", lengths, "size", Engine(reverse=True))
    assert [answer.settings for answer in answers] == [(f"line.length={one}",) for one in lengths]
    with pytest.raises(ValueError, match="no command"):
        distributed.sweep(hose, "line.length", lengths, "_ask", Engine())
    with pytest.raises(TypeError, match=r"distributed\.Client"):
        distributed.campaign(project, runs=2, out="runs.csv", client=3)
