"""Shaping by hand as values."""

from __future__ import annotations

import pytest

import phea
from conftest import Command


@pytest.fixture
def servo() -> phea.Project:
    return phea.example("qft/servo")


def test_changes_are_values_and_are_undone(servo: phea.Project) -> None:
    loop = servo.shaping()
    changed = loop.add(phea.Lead(5, "50 rad/s")).add(phea.Gain(2.0))
    assert len(changed.elements) == len(loop.elements) + 2
    assert changed.undo().undo() == loop and changed != loop
    with pytest.raises(IndexError):
        loop.undo()
    moved = changed.move(len(changed.elements), 1)
    assert moved.elements[0].kind == "gain"


def test_a_point_is_passed(servo: phea.Project) -> None:
    loop = servo.shaping().through("gain", db=-3, at=10)
    near = loop.through("lag", db=-9.0, deg=loop_phase(loop, 10.0) - 30.0, at=10)
    assert near.elements[-1].kind == "lag"
    assert loop_magnitude(near, 10.0) == pytest.approx(-9.0, abs=1e-6)


def loop_phase(loop: phea.Shaping, frequency: float) -> float:
    points = loop.answer.loop
    return next(point.phase_deg for point in points if point.frequency_rad_per_s == frequency)


def loop_magnitude(loop: phea.Shaping, frequency: float) -> float:
    points = loop.answer.loop
    return next(point.magnitude_db for point in points if point.frequency_rad_per_s == frequency)


def test_saving_changes_nothing_but_the_elements(servo: phea.Project) -> None:
    saved = servo.shaping().add(phea.Lead(5, 50)).save()
    old = [line for line in servo.text.splitlines() if line.startswith("#")]
    assert old and all(line in saved.text.splitlines() for line in old)
    assert len(saved.shaping().elements) == len(servo.shaping().elements) + 1


@pytest.mark.usefixtures("in_examples")
def test_the_answer_is_that_of_the_command(run: Command) -> None:
    loop = phea.read("qft/servo.toml").shaping().add(phea.Lead(5, 50))
    words = ["shape", "qft/servo.toml", "--add", phea.Lead(5, 50).toml()]
    assert loop.answer.json_text == run.json(*words)
    assert loop.answer.files == run.written(*words)


@pytest.mark.parametrize(
    "change",
    [
        lambda loop: loop.remove(99),
        lambda loop: loop.through("lead", db=-6, deg=-130, at=20),
        lambda loop: loop.add(phea.Notch(60, -1.0, 0.1)),
    ],
)
def test_impossible_changes_are_refused(servo: phea.Project, change: object) -> None:
    with pytest.raises(phea.ProjectError):
        change(servo.shaping())  # type: ignore[operator]


def test_a_wrong_element_is_a_type_error(servo: phea.Project) -> None:
    with pytest.raises(TypeError, match="Lead"):
        servo.shaping().add("lead")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="db"):
        servo.shaping().through("lead", at=20)
