"""Projects and answers are values: they compare, hash, copy, pickle and print as one line."""

from __future__ import annotations

import copy
import json
import math
import pickle
from typing import Any

import numpy as np
import pytest

import phea
from phea import answers
from phea._fields import generated
from phea._record import Answer, Record


@pytest.fixture(scope="module")
def rig() -> phea.Project:
    return phea.example("ybitu/hose")


def test_a_project_is_a_value(rig: phea.Project) -> None:
    longer = rig.set({"line.length": "2 m"})
    assert longer != rig and longer == rig.set({"line.length": "2 m"})
    assert rig.settings == () and longer.settings == ("line.length=2 m",)
    assert pickle.loads(pickle.dumps(longer)) == longer
    assert copy.deepcopy(longer) == longer and hash(copy.copy(longer)) == hash(longer)
    assert "\n" not in repr(longer)
    with pytest.raises(AttributeError, match="set"):
        rig.text = ""  # type: ignore[misc]


def test_a_bare_number_is_si(rig: phea.Project) -> None:
    by_number = rig.set({"line.length": 2})
    assert by_number.check().derived == rig.set({"line.length": "2 m"}).check().derived


def walk(value: Any, found: Any, path: str) -> int:
    """Compares JSON with attributes; returns the number of compared leaves."""
    if isinstance(value, dict) and isinstance(found, Record):
        value = {key.replace(".", "_"): part for key, part in value.items()}
        own = {name.rstrip("_"): name for name in generated(type(found)).__annotations__ if name[0] != "_"}
        assert set(value) <= set(own), path
        missing = {name for key, name in own.items() if key not in value}
        assert all(getattr(found, name) is None for name in missing), path
        return sum(walk(part, getattr(found, own[key]), f"{path}.{key}") for key, part in value.items())
    if isinstance(value, dict):
        assert set(value) == set(found), path
        return sum(walk(part, found[key], f"{path}.{key}") for key, part in value.items())
    if isinstance(found, complex):
        assert value == [found.real, found.imag], path
        return 1
    if isinstance(value, list):
        assert len(value) == len(found), path
        return sum(walk(*pair, f"{path}[{i}]") for i, pair in enumerate(zip(value, found, strict=True)))
    expected = {"inf": math.inf, "-inf": -math.inf}.get(value, value) if isinstance(value, str) else value
    assert expected == found or value == found, path
    return 1


def every_answer() -> list[Answer]:
    hose, servo = phea.example("ybitu/hose"), phea.example("qft/servo")
    campaign = phea.example("benchmark/campaign")
    return [
        hose.check(),
        hose.size(),
        hose.linearize(),
        hose.linearize(sweep="line.length=0.5 m..2 m", points=3),
        hose.verify(),
        hose.simulate(figures=False),
        hose.bench(),
        servo.design(),
        campaign.campaign(runs=3, files=False),
        campaign.campaign_run(1),
        phea.example("rotary/vane").linearize(),
    ]


@pytest.mark.filterwarnings("ignore::phea.ProjectWarning")
def test_every_key_is_an_attribute() -> None:
    for answer in every_answer():
        assert walk(answer.json, answer, type(answer).__name__) > 10


def test_every_attribute_is_a_key_of_the_schema() -> None:
    classes = [cls for cls in vars(answers).values() if isinstance(cls, type) and issubclass(cls, Record)]
    assert len(classes) > 200
    assert all(cls.__doc__ for cls in classes)


@pytest.mark.filterwarnings("ignore::phea.ProjectWarning")
def test_answers_are_values(rig: phea.Project) -> None:
    audit = rig.verify()
    again = pickle.loads(pickle.dumps(audit))
    assert again == audit and hash(again) == hash(audit) and again.files == audit.files
    assert again.specifications[0] == audit.specifications[0]
    assert pickle.loads(pickle.dumps(audit.specifications[0])) == audit.specifications[0]
    assert "\n" not in repr(audit) and "verdict='violated'" in repr(audit)
    with pytest.raises(AttributeError):
        audit.verdict = "met"
    with pytest.raises(AttributeError, match="did you mean 'verdict'"):
        getattr(audit, "verdit")  # noqa: B009
    assert json.loads(audit.json_text) == audit.json


def test_derived_quantities_by_name(rig: phea.Project) -> None:
    derived = rig.check().derived
    area, rod, piston = (derived[name] for name in ("cylinder.area_a", "line.volume", "line.compliance"))
    assert area.unit == "m2" and area.value == pytest.approx(math.pi / 4 * (0.05**2 - 0.022**2))
    assert rod == next(one for one in derived if one.name == "line.volume")
    assert "line.volume" in derived and "line.volumes" not in derived and piston in derived
    assert derived.names[:2] == tuple(one.name for one in derived[:2])
    assert derived == rig.check().derived and pickle.loads(pickle.dumps(derived)) == derived
    with pytest.raises(KeyError, match="did you mean 'line.volume'"):
        derived["line.volumes"]


@pytest.mark.filterwarnings("ignore::phea.ProjectWarning")
def test_a_line_shows_the_result(rig: phea.Project) -> None:
    runs = rig.simulate(figures=False)
    assert "('step and load motion': 'completed', 'force steps': 'completed')" in repr(runs)
    run = runs["force steps"]
    assert "'completed'" in repr(run) and f"{len(run.time_s)} rows" in repr(run)
    event = run.events[0]
    assert event.metrics.overshoot_percent is not None
    assert f"metrics.overshoot_percent={event.metrics.overshoot_percent:.6g}" in repr(event)
    assert "reference_n=(0, 1000)" in repr(event) and "_reason" not in repr(event)
    margin = rig.verify().specifications[0]
    assert isinstance(margin, answers.SpecificationAnswer)
    assert f"worst_margin_db={margin.worst_margin_db:.6g}" in repr(margin)


@pytest.mark.filterwarnings("ignore::phea.ProjectWarning")
def test_columns_are_read_only_arrays(rig: phea.Project) -> None:
    run = rig.simulate(figures=False)
    table = next(iter(run.tables.values()))
    assert table.time_s.dtype == np.float64 and not table.time_s.flags.writeable
    assert np.all(np.diff(table["time_s"]) > 0)
    with pytest.raises(AttributeError, match="force_n"):
        table.force  # noqa: B018
