"""Alternatives of a cluster have the bytes of one computer, whatever the engine does."""

from __future__ import annotations

import pytest

import phea
from engine import Engine
from phea import _native, distributed
from rigs import lag_with_load_case, rig_with_alternatives

FRONT, SWEEP = "high_frequency_gain_db,swept:more", "plant.delay=1 ms..20 ms"


@pytest.fixture(scope="module")
def project() -> phea.Project:
    return rig_with_alternatives()


@pytest.fixture(scope="module")
def whole(project: phea.Project) -> phea.Answer:
    return project.alternatives()


def check_same(found: phea.Answer, expected: phea.Answer) -> None:
    assert found.json_text == expected.json_text
    assert found.text == expected.text and bool(found) == bool(expected)
    assert dict(found.files) == dict(expected.files)


@pytest.mark.parametrize("reverse", [False, True])
def test_alternatives_have_the_bytes_of_one_computer(
    project: phea.Project, whole: phea.Answer, reverse: bool
) -> None:
    engine = Engine(reverse=reverse)
    check_same(distributed.alternatives(project, engine), whole)
    assert engine.computed == 3
    # one that cannot be judged, with figures of the others
    assert not whole and "sized: not judged: no hose" in whole.text
    assert {"alternatives.svg", "alternatives-impedance.svg", "pipe.toml"} <= set(whole.files)
    assert "sized.toml" not in whole.files


def test_load_cases_and_a_front_are_joined_in_any_order() -> None:
    project, engine = lag_with_load_case(), Engine(reverse=True)
    found = distributed.alternatives(
        project, engine, front=FRONT, sweep=SWEEP, points=3, frequencies="2, 30 Hz"
    )
    check_same(
        found, project.alternatives(front=FRONT, sweep=SWEEP, points=3, frequencies="2, 30 Hz")
    )
    assert engine.computed == 2 + 2 + 6
    assert {"load_cases.csv", "front.csv", "faster, slow.toml"} <= set(found.files)


def test_no_files_are_made_if_none_are_requested(project: phea.Project, whole: phea.Answer) -> None:
    found = distributed.alternatives(project, Engine(), files=False)
    assert not found.files and found.json_text == whole.json_text


def test_false_cancels_what_is_queued(project: phea.Project) -> None:
    engine = Engine()
    reported: list[float] = []

    def report(stage: str, fraction: float) -> bool:
        reported.append(fraction)
        return stage != "judging"

    with pytest.raises(phea.Stopped, match="alternatives was stopped"):
        distributed.alternatives(project, engine, progress=report)
    assert engine.cancelled == 2 and reported == [1 / 3]


def test_what_the_project_lacks_is_found_before_any_work(project: phea.Project) -> None:
    engine = Engine()
    with pytest.raises(phea.NoAnswer, match=r"no \[\[alternative\]\]"):
        distributed.alternatives(phea.example("ybitu/hose"), engine)
    with pytest.raises(phea.ProjectError, match="disturbance_peak_n"):
        distributed.alternatives(project, engine, front="disturbance_peak,swept", sweep="line.length=1..2")
    with pytest.raises(TypeError, match="front and sweep"):
        distributed.alternatives(project, engine, front="swept,order")
    with pytest.raises(distributed.WorkerMismatch):
        distributed.alternatives(project, Engine(version="0.0.1"))
    assert engine.computed == 0


def test_a_worker_reports_and_stops(project: phea.Project) -> None:
    options = {"files": True}
    seen: list[float] = []
    result = _native.alternative_judged(
        project._native, options, 0, lambda _, done: seen.append(done)
    )
    assert len(result) > 1000 and 0.0 <= min(seen) <= max(seen) <= 1.0
    with pytest.raises(_native.Refused) as stopped:
        _native.alternative_judged(project._native, options, 0, lambda *_: False)
    assert stopped.value.args[0] == "stopped"


def refusal(found: pytest.ExceptionInfo[_native.Refused]) -> str:
    return str(found.value.args[2])


def test_bytes_that_are_no_results_are_refused(project: phea.Project) -> None:
    options = {"files": True}
    one = _native.alternative_judged(project._native, options, 2)
    for results, reason in [
        ([], "task 0 is missing"),
        ([one], "task 0 is missing"),
        ([b"no result"], "no result of an alternative"),
        ([one[: len(one) // 2]], "no result of an alternative"),
    ]:
        with pytest.raises(_native.Refused) as refused:
            _native.alternatives_joined(project._native, options, results)
        assert reason in refusal(refused)
    with pytest.raises(_native.Refused) as refused:
        _native.alternative_judged(project._native, options, 3)
    assert "no task 3" in refusal(refused)
    other = phea.loads(project.text.replace('name = "sized"', 'name = "other"'))
    with pytest.raises(_native.Refused) as refused:
        _native.alternatives_joined(other._native, options, [one])
    assert "other alternatives" in refusal(refused)
