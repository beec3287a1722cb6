"""Errors are the documented exceptions, with every finding at once."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from pathlib import Path

import pytest

import phea
import phea.distributed
from conftest import Command

pytestmark = pytest.mark.filterwarnings("ignore::phea.ProjectWarning")


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
    with pytest.raises(FileNotFoundError):
        phea.identify([tmp_path / "absent.csv"])


def test_a_project_that_lacks_what_is_asked() -> None:
    servo = phea.example("qft/servo")
    with pytest.raises(phea.NoAnswer) as caught:
        servo.campaign(runs=3)
    assert caught.value.diagnostics
    with pytest.raises(phea.ProjectError) as wrong:
        phea.example("ybitu/hose").size(gain="3 m")
    assert not isinstance(wrong.value, phea.NoAnswer)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda rig: rig.campaign(runs=-1), "runs is at least 1, not -1"),
        (lambda rig: rig.campaign(runs=2**64), "runs is at most 18446744073709551615"),
        (lambda rig: rig.campaign(runs=1, seed=-1), "seed is at least 0, not -1"),
        (lambda rig: rig.campaign(runs=1, threads=0), "threads is at least 1, not 0"),
        (lambda rig: rig.campaign_run(-1), "run is at least 0, not -1"),
        (lambda rig: rig.design(seed=2**32), "seed is at most 4294967295, not 4294967296"),
        (lambda rig: rig.linearize(sweep="line.length=1 m..2 m", points=-3), "points is at least"),
        (lambda rig: phea.identify([], bootstrap=3), "bootstrap is at least 50, not 3"),
    ],
)
def test_numbers_out_of_range_are_value_errors(
    call: Callable[[phea.Project], object], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        call(phea.example("benchmark/campaign"))


@pytest.mark.usefixtures("in_examples")
@pytest.mark.parametrize(
    ("words", "call", "beginning"),
    [
        (
            ["size", "ybitu/hose.toml", "--gain", "3 m"],
            lambda rig: rig.size(gain="3 m"),
            "gain 3 m: expected a gain in V/N",
        ),
        (
            ["linearize", "ybitu/hose.toml", "--sweep", "line.length"],
            lambda rig: rig.linearize(sweep="line.length"),
            "sweep line.length: a sweep has the form",
        ),
        (
            ["check", "ybitu/hose.toml", "--set", "line.lenght=2 m"],
            lambda rig: rig.set({"line.lenght": "2 m"}),
            "error: unknown key `lenght` in [line]\n --> set({'line.lenght': '2 m'}):1:6\n",
        ),
        (
            ["shape", "ybitu/hose.toml", "--remove", "9"],
            lambda rig: rig.shaping().remove(9),
            "error: there is no element `9`\n --> remove 9:1:1\n",
        ),
    ],
    ids=lambda value: value[0] if isinstance(value, list) else "",
)
def test_messages_name_the_arguments_of_python(
    run: Command, words: list[str], call: Callable[[phea.Project], object], beginning: str
) -> None:
    rig = phea.read("ybitu/hose.toml")
    with pytest.raises(phea.ProjectError) as caught:
        call(rig)
    # the JSON is the command's, with its options
    assert caught.value.json_text == run.json(*words) and "--" in caught.value.json_text
    assert str(caught.value).startswith(beginning)
    texts = [f"{one.file} {one.message} {one.help}" for one in caught.value.diagnostics]
    assert texts and not any("--" in text for text in texts)
    assert not any(line.lstrip().startswith(("--s", "--> --")) for line in str(caught.value).split("\n"))


def test_exceptions_pickle() -> None:
    with pytest.raises(phea.ProjectError) as caught:
        phea.loads("")
    stopped = phea.Stopped("design was stopped", phea.example("qft/servo").check())
    mismatch = phea.distributed.WorkerMismatch("1", {"a": "2"})
    for error in (caught.value, stopped, mismatch):
        again = pickle.loads(pickle.dumps(error))
        assert type(again) is type(error) and str(again) == str(error)
        assert vars(again) == vars(error)


@pytest.mark.parametrize(
    "call",
    [
        lambda rig: rig.set([("line.length", 2)]),
        lambda rig: rig.set({3: "2 m"}),
        lambda rig: rig.set({"line.length": object()}),
        lambda rig: rig.size(gain=1.0, length=2.0),
        lambda rig: rig.linearize(points=3),
        lambda rig: rig.alternatives(front="disturbance_peak_n,swept"),
        lambda rig: rig.simulate(amplitude="0.1 V"),
        lambda rig: rig.simulate(frequency_response=True, check=True),
        lambda rig: rig.campaign(runs=2.5),
        lambda rig: phea.identify([], period=1, segment=2),
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
