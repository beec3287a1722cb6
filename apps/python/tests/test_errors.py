"""Errors are the documented exceptions, with every finding at once."""

from __future__ import annotations

from pathlib import Path

import pytest

import phea


def test_every_error_at_once() -> None:
    text = phea.example("ybitu/hose").text
    wrong = text.replace('stroke = "500 mm"', 'stroke = "500 kg"').replace("[valve]", "[vavle]")
    assert wrong != text
    with pytest.raises(phea.ProjectError) as caught:
        phea.loads(wrong)
    found = caught.value.diagnostics
    assert len([one for one in found if one.severity == "error"]) >= 2
    stroke = next(one for one in found if "stroke" in str(one.message) or one.line)
    assert stroke.file == "project.toml" and stroke.line is not None and stroke.column is not None
    assert "--> project.toml:" in str(caught.value)
    assert isinstance(caught.value, ValueError)


def test_unknown_paths_name_the_nearest_spelling() -> None:
    with pytest.raises(phea.ProjectError, match="length"):
        phea.example("ybitu/hose").set({"line.lenght": "2 m"})
    with pytest.raises(ValueError, match="did you mean 'ybitu/hose'"):
        phea.example("ybitu/hoes")


def test_a_missing_file(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        phea.read(tmp_path / "absent.toml")
    with pytest.raises(IsADirectoryError):
        phea.read(tmp_path)


def test_a_project_that_lacks_what_is_asked() -> None:
    servo = phea.example("qft/servo")
    with pytest.raises(phea.NoAnswer) as caught:
        servo.campaign(runs=3)
    assert caught.value.diagnostics
    with pytest.raises(phea.ProjectError) as wrong:
        phea.example("ybitu/hose").size(gain="3 m")
    assert not isinstance(wrong.value, phea.NoAnswer)


def test_numbers_out_of_range_are_value_errors() -> None:
    with pytest.raises(ValueError, match="at least 1, not -1"):
        phea.example("benchmark/campaign").campaign(runs=-1)


@pytest.mark.parametrize(
    "call",
    [
        lambda rig: rig.set([("line.length", 2)]),
        lambda rig: rig.set({3: "2 m"}),
        lambda rig: rig.set({"line.length": object()}),
        lambda rig: rig.size(gain=1.0, length=2.0),
        lambda rig: rig.verify(progress=3),
        lambda rig: rig.verify(proof=True),
        lambda rig: rig.design(seed="one"),
        lambda rig: phea.loads(3),  # type: ignore[arg-type]
        lambda rig: phea.read("x.toml", catalogues="hoses"),
    ],
)
def test_wrong_types_are_type_errors(call: object) -> None:
    rig = phea.example("ybitu/hose")
    with pytest.raises((TypeError, FileNotFoundError)):
        call(rig)  # type: ignore[operator]
