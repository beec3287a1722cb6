"""Warnings about a project arise at the user's own line, each once."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path

import control
import pytest

import phea
import phea.control
from conftest import EXAMPLES

Made = Callable[[phea.Project], phea.Project]

# Ways to another project from one that was warned of.
DERIVED: dict[str, Made] = {
    "set": lambda rig: rig.set({"line.length": "2 m"}),
    "shaping": lambda rig: rig.shaping().add(phea.Gain(1.5)).save(),
    "with_controller": lambda rig: phea.control.with_controller(rig, control.tf([1], [1, 1])),
    "with_laws_of": lambda rig: rig.with_laws_of(rig.text),
}


def warned(make: Callable[[], object]) -> list[warnings.WarningMessage]:
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        make()
    return [one for one in found if issubclass(one.category, phea.ProjectWarning)]


@pytest.mark.parametrize(
    "make",
    [
        lambda: phea.example("ybitu/hose"),
        lambda: phea.read(EXAMPLES / "ybitu/hose.toml"),
        lambda: phea.loads((EXAMPLES / "ybitu/hose.toml").read_bytes()),
    ],
    ids=["example", "read", "loads"],
)
def test_a_warning_is_at_the_line_of_the_user(make: Callable[[], object]) -> None:
    (one,) = warned(make)
    assert Path(one.filename) == Path(__file__)
    assert str(one.message).startswith("this LuGre friction can give out energy")
    assert "hose.toml:56:11" in str(one.message) or "project.toml:56:11" in str(one.message)


@pytest.mark.filterwarnings("ignore::phea.ProjectWarning")
@pytest.mark.parametrize("name", DERIVED)
def test_a_derived_project_does_not_warn_again(name: str) -> None:
    rig = phea.example("ybitu/hose")
    assert warned(lambda: DERIVED[name](rig)) == []
    doubtful = rig.set({"cylinder.piston_diameter": 63})
    derived = DERIVED[name](doubtful)
    assert warned(lambda: DERIVED[name](doubtful)) == [] and derived.settings
    assert warned(lambda: derived.check()) == []


@pytest.mark.filterwarnings("ignore::phea.ProjectWarning")
def test_a_new_doubt_is_warned_of_alone() -> None:
    rig = phea.example("ybitu/hose")
    (one,) = warned(lambda: rig.set({"cylinder.piston_diameter": 63}))
    assert Path(one.filename) == Path(__file__)
    assert str(one.message).startswith("`piston_diameter` is 63 m")
    assert "--> set({'cylinder.piston_diameter': 63}):1:26" in str(one.message)
