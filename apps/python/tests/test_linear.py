"""Linear models as plain values: factors, families, and their agreement with each other."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import phea
from phea.linear import Factors, Family, Linear

pytestmark = pytest.mark.filterwarnings("ignore::phea.ProjectWarning")

FREQUENCIES = np.geomspace(1e-4, 1e4, 400)


def test_values_of_factors_are_their_closed_form() -> None:
    lag = Factors(3.0, [], [-3.0], dead_time_s=0.5)
    expected = np.exp(-0.5j * FREQUENCIES) / (1 + 1j * FREQUENCIES / 3)
    assert np.allclose(lag.response(FREQUENCIES), expected, rtol=1e-14, atol=0)
    sampled = Factors(0.5, [-1.0], [1.0], sample_time_s=0.2)  # the trapezoidal rule, cot(wT/2)/(2j)
    assert np.allclose(sampled.response([1.0, 3.0]), 0.5 / (1j * np.tan([0.1, 0.3])), rtol=1e-14)
    delayed = Factors(1.0, [], [], dead_time_s=0.4, sample_time_s=0.2)
    assert np.allclose(delayed.response([1.0]), np.exp(-0.4j), rtol=1e-15)


def test_factors_are_values() -> None:
    one = Factors(2.0, [-1.0], [-2 + 1j, -2 - 1j], 0.1)
    same = pickle.loads(pickle.dumps(one))
    assert same == one and hash(same) == hash(one) and copy.deepcopy(one) == one
    assert one != Factors(2.0, [-1.0], [-2 + 1j, -2 - 1j]) and one != "factors"
    assert "\n" not in repr(one) and "dead_time_s=0.1" in repr(one)
    with pytest.raises(AttributeError, match="gain"):
        one.gain = 3.0
    with pytest.raises(ValueError, match="read-only"):
        one.poles[0] = 0.0


def test_the_linear_models_of_a_rig() -> None:
    rig = phea.example("ybitu/hose")
    linear = Linear(rig)
    names = ["plant", "load_position", "controller", "prefilter", "sensor"]
    assert [name for name in linear.as_dict() if "deployed" not in name] == names
    assert linear.controller is not None and linear.controller.gain == 0.001
    assert linear.plant is not None and linear.load_position is not None
    # the force follows from the load's position by the poles of the plant but the valve's
    assert set(linear.load_position.poles.tolist()) <= set(linear.plant.poles.tolist())
    assert pickle.loads(pickle.dumps(linear)) == linear and hash(linear) == hash(Linear(rig))
    assert "\n" not in repr(linear)
    assert linear != Linear(rig.set({"controller.numerator": "0.002"}))


def test_a_project_without_a_rig_has_no_plant_of_one() -> None:
    linear = Linear(phea.example("qft/by_hand"))
    assert linear.plant is None and linear.controller is None and linear.sensor == Factors(1.0)


def test_members_by_index_and_by_parameters() -> None:
    family = Family(phea.example("qft/servo"))
    assert len(family) == 49 and set(family.parameters) == {"k", "a"}
    for index in (0, 7, -1):
        named = dict(zip(family.parameters, family.values[index].tolist(), strict=True))
        plant = family.member(index)
        assert plant is not None and plant == family.member(named)
        # k a/(s (s + a))
        assert np.isclose(plant.gain, named["k"] * named["a"], rtol=1e-15)
        assert sorted(plant.poles.real) == pytest.approx([-named["a"], 0.0], rel=1e-15)
    assert family.member({"k": 3.0}) == family.member({"k": 3.0, "a": 1.0})
    assert pickle.loads(pickle.dumps(family)) == family and "49 members" in repr(family)


@pytest.mark.parametrize(
    ("member", "error"),
    [
        (49, IndexError),
        (-50, IndexError),
        ({"q": 1.0}, ValueError),
        ("0", TypeError),
        (True, TypeError),
    ],
)
def test_absent_members(member: object, error: type[Exception]) -> None:
    with pytest.raises(error):
        Family(phea.example("qft/servo")).member(member)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "tolerance"),
    [
        ("qft/load_frame", 1e-12),
        ("leg/knee", 1e-12),
        ("rotary/vane", 1e-12),
        ("ybitu/transmission", 2e-10),  # 21 poles, whose polynomial loses digits near the last wave
    ],
)
def test_responses_are_those_of_the_factors(name: str, tolerance: float) -> None:
    family = Family(phea.example(name))
    for index in (0, len(family) // 2, len(family) - 1):
        plant = family.member(index)
        assert plant is not None
        found = family.response(FREQUENCIES, index)
        assert np.allclose(found, plant.response(FREQUENCIES), rtol=tolerance, atol=0)
        assert not found.flags.writeable


def test_lines_with_waves_have_responses_alone() -> None:
    waves = Family(phea.example("ybitu/hose").set({"line.model": "transmission_line"}))
    lumped = Family(phea.example("ybitu/hose").set({"line.model": "lumped"}))
    assert waves.member() is None and lumped.member() is not None
    slow = [1e-3, 1e-2]  # far below the first wave
    assert np.allclose(waves.response(slow), lumped.response(slow), rtol=1e-3)


def test_measured_plants_are_those_of_their_files() -> None:
    project = phea.example("qft/measured")
    family = Family(project)
    assert len(family) == 5 and family.member() is None
    for plant in family.measured:
        text = next(data for path, data in project.files.items() if path.endswith(plant.name))
        frequency, decibels, degrees = np.loadtxt(
            text.decode().splitlines(), delimiter=",", skiprows=1
        ).T
        assert np.array_equal(plant.frequencies_rad_per_s, frequency)
        expected = 10 ** (decibels / 20) * np.exp(1j * np.radians(degrees))
        assert np.allclose(plant.responses, expected, rtol=1e-12, atol=0)
    with pytest.raises(ValueError, match="own frequencies"):
        family.response([1.0])


def test_a_project_without_a_law_reports_so() -> None:
    with pytest.raises(phea.ProjectError):
        Family(
            phea.loads("schema = 1\ntitle = 't'\n[plant]\nnumerator = 's'\ndenominator = '1/0'\n")
        )
