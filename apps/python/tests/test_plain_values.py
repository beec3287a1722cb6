"""Templates, bounds, stiffness and impedance as arrays: the numbers of the command, and truths."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import control
import numpy as np
import pytest

import phea
from phea._arrays import ArrayValue
from phea.bounds import Bounds, Templates
from phea.rig import Impedance, Stiffness
from phea.table import Table

from conftest import Command

pytestmark = pytest.mark.filterwarnings("ignore::phea.ProjectWarning")


@pytest.fixture(scope="module")
def templates() -> Templates:
    return phea.example("qft/servo").templates


@pytest.fixture(scope="module")
def bounds() -> Bounds:
    return phea.example("qft/servo").bounds


def rows_of(table: Table, **where: float) -> Table:
    """Rows of a table at which columns have these values."""
    lines = table.csv.decode().splitlines()
    kept = np.all([table[name] == value for name, value in where.items()], axis=0)
    return Table("\n".join([lines[0], *np.array(lines[1:])[kept], ""]).encode())


def test_templates_and_bounds_are_the_tables_of_the_command(
    run: Command, templates: Templates, bounds: Bounds
) -> None:
    written = run.written("report", "qft/servo.toml")
    plants, gains = Table(written["templates.csv"]), Table(written["bounds.csv"])
    assert np.unique(plants["frequency_rad_per_s"]).tolist() == templates.frequencies_rad_per_s.tolist()
    for template in templates:
        rows = rows_of(plants, frequency_rad_per_s=template.frequency_rad_per_s)
        assert rows.real.tobytes() == np.ascontiguousarray(template.responses.real).tobytes()
        assert rows.imaginary.tobytes() == np.ascontiguousarray(template.responses.imag).tobytes()
    compared = 0
    for at in bounds:
        for bound in at.specifications:
            assert bound.specification is not None
            frequency, number = at.frequency_rad_per_s, bound.specification
            rows = rows_of(gains, frequency_rad_per_s=frequency, specification=number)
            compared += len(rows.csv.splitlines()) - 1
            assert set(rows.kind) <= {bound.kind}
            for name in ("phase_deg", "forbidden_from_gain", "forbidden_to_gain"):
                assert np.asarray(rows[name]).tobytes() == getattr(bound, name).tobytes()
    assert compared == len(gains["phase_deg"]) > 100


def test_templates_are_the_responses_of_the_plant_of_python_control(templates: Templates) -> None:
    assert templates.parameters == ("k", "a") and len(templates) == 7
    for (k, a), responses in zip(templates.values, templates.responses, strict=True):
        plant = control.tf([k * a], [1, a, 0])
        expected = plant(1j * templates.frequencies_rad_per_s)
        assert np.allclose(responses, expected, rtol=1e-12, atol=0)
    assert templates.nominal_loop is not None
    law = phea.example("qft/servo").linear.controller
    assert law is not None
    loop = law.response(templates.frequencies_rad_per_s) * templates.responses[0]
    assert np.allclose(templates.nominal_loop, loop, rtol=1e-12, atol=0)


def test_at_the_end_of_a_bound_the_worst_plant_is_at_its_limit(
    templates: Templates, bounds: Bounds
) -> None:
    """The closed loop of every plant is at most 1.2 where the bound of this limit ends."""
    compared = 0
    for at, template in zip(bounds, templates, strict=True):
        bound = at.specifications[0]
        assert (bound.specification, bound.kind) == (1, "robust_stability")
        ratios = template.responses / template.responses[0]
        for gains in (bound.forbidden_from_gain, bound.forbidden_to_gain):
            ends = (gains > 0) & np.isfinite(gains)
            nominal = gains[ends] * np.exp(1j * np.radians(bound.phase_deg[ends]))
            loops = nominal[:, None] * ratios
            worst = np.abs(loops / (1 + loops)).max(axis=1)
            # the plants between those of the template may be worse by its spacing
            assert (worst <= 1.2 * (1 + 1e-6)).all() and (worst > 1.1).all()
            compared += len(worst)
    assert compared > 100


def test_together_is_the_union(bounds: Bounds) -> None:
    at = bounds[0]
    assert [bound.specification for bound in at.specifications] == [1, 2]
    for bound in at.specifications:
        for phase, low, high in zip(
            bound.phase_deg, bound.forbidden_from_gain, bound.forbidden_to_gain, strict=True
        ):
            here = at.together.phase_deg == phase
            lows, highs = at.together.forbidden_from_gain[here], at.together.forbidden_to_gain[here]
            assert ((lows <= low) & (high <= highs)).any()
    decibels = at.together.forbidden_from_db
    gains = at.together.forbidden_from_gain
    assert np.allclose(10 ** (decibels / 20), gains) and np.isneginf(decibels[gains == 0]).all()


def test_a_project_without_specifications_has_no_bounds() -> None:
    text = "schema = 1\ntitle = \"Plant\"\n\n[plant]\nnumerator = \"1\"\ndenominator = \"s + 1\"\n"
    project = phea.loads(text)
    assert len(project.bounds.bounds) == len(project.templates.frequencies_rad_per_s) == 0


def test_stiffness_is_that_of_the_command() -> None:
    rig = phea.example("ybitu/hose")
    stiffness, printed = rig.stiffness, rig.linearize().stiffness
    assert stiffness is not None and stiffness.other is not None
    assert stiffness.model == "uniform" and stiffness.other.model == "by_volume"
    least, greatest = printed.minimum_n_per_m, printed.maximum_n_per_m
    assert (stiffness.least_n_per_m, stiffness.greatest_n_per_m) == (least, greatest)
    positions, nominal = stiffness.positions_m, stiffness.nominal_n_per_m
    assert positions is not None and nominal is not None and stiffness.positions_rad is None
    assert (positions[0], positions[-1]) == (0.0, 0.5) and nominal.max() <= greatest
    # both chambers, each A^2 over a compliance that is linear in x: K (x^2 + c x + d) = a x + b
    x, scaled = positions, nominal / nominal.max()
    columns = np.column_stack([x, np.ones_like(x), -scaled * x, -scaled])
    (a, b, c, d), *_ = np.linalg.lstsq(columns, scaled * x**2, rcond=None)
    assert np.allclose(scaled * (x**2 + c * x + d), a * x + b, rtol=0, atol=1e-10)
    ends = np.sort(np.roots([1.0, c, d]).real)  # the chambers without volume: beyond the stroke
    assert ends[0] < 0 and ends[1] > 0.5
    minimum, maximum = stiffness.minimum_n_per_m, stiffness.maximum_n_per_m
    assert minimum is not None and maximum is not None
    assert (minimum <= nominal).all() and (nominal <= maximum).all()


def test_stiffness_of_a_motor_is_in_its_units() -> None:
    stiffness = phea.example("rotary/vane").stiffness
    assert stiffness is not None and stiffness.nominal_n_per_m is None
    assert stiffness.nominal_n_m_per_rad is not None and stiffness.positions_rad is not None
    assert stiffness.nominal_n_m_per_rad.shape == stiffness.positions_rad.shape


def test_impedance_is_that_of_python_control() -> None:
    impedance = phea.example("ybitu/hose").impedance
    assert impedance is not None and impedance.closed_loop is not None
    frequencies = impedance.frequencies_rad_per_s
    assert (np.diff(frequencies) > 0).all() and frequencies[0] <= 0.01
    for port in (impedance.open_loop, impedance.closed_loop):
        response, factors = port.response_n_s_per_m, port.factors
        assert response is not None and port.response_n_m_s_per_rad is None
        system = control.zpk(factors.zeros, factors.poles, factors.gain)
        expected = np.array([
            factors.gain * np.prod(1j * w - factors.zeros) / np.prod(1j * w - factors.poles)
            for w in frequencies
        ])
        assert np.allclose(response, expected, rtol=1e-9, atol=0)
        assert np.allclose(response[300:], system(1j * frequencies[300:]), rtol=1e-6, atol=0)


def test_the_open_port_is_the_sensor_above_every_resonance() -> None:
    rig = phea.example("ybitu/hose")
    impedance = rig.impedance
    assert impedance is not None and impedance.open_loop.response_n_s_per_m is not None
    stiff = rig.set({"force_sensor.stiffness": "1e7 N/m"}).impedance
    assert stiff is not None and stiff.open_loop.response_n_s_per_m is not None
    highest = stiff.frequencies_rad_per_s[-1]
    assert abs(stiff.open_loop.response_n_s_per_m[-1]) * highest == pytest.approx(1e7, rel=1e-2)


def test_a_project_without_a_rig_has_neither() -> None:
    servo = phea.example("qft/servo")
    assert servo.stiffness is None and servo.impedance is None


def test_they_are_values(templates: Templates, bounds: Bounds) -> None:
    rig = phea.example("ybitu/hose")
    stiffness, impedance = rig.stiffness, rig.impedance
    assert isinstance(stiffness, Stiffness) and isinstance(impedance, Impedance)
    for value in (templates, templates[0], bounds, bounds[0], stiffness, impedance):
        assert isinstance(value, ArrayValue)
        same = pickle.loads(pickle.dumps(value))
        assert same == value and hash(same) == hash(value) and copy.deepcopy(value) is value
        assert "\n" not in repr(value) and value != "another"
        with pytest.raises(AttributeError, match="cannot be changed"):
            value.anything = 1
    held = pickle.loads(pickle.dumps(templates))
    for array in (templates.responses, held.responses, held.values, bounds[0].together.phase_deg):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    assert templates != phea.example("qft/servo").set({"uncertainty.k.maximum": 9}).templates


def test_units_of_drawn_parameters() -> None:
    pytest.importorskip("pandas")
    campaign = phea.example("benchmark/campaign").campaign(runs=2, files=False)
    units = campaign.to_pandas().attrs["units"]
    expected = {
        "supply.pressure": "Pa",
        "valve.flow_coefficients.supply_to_a": "m3/(s.Pa^0.5)",
        "cylinder.friction.coulomb": "N",
        "cylinder.friction.stribeck_velocity": "m/s",
        "line.volume": "m3",
        "force_sensor.stiffness": "N/m",
        "cylinder.moving_mass": "kg",
        "hydraulic_stiffness_n_per_m": "N/m",
        "run": "",
    }
    assert {name: units[name] for name in expected} == expected
    # without the answer, from the table of keys
    bare = {name: unit for name, unit in expected.items() if Table(b"x\n").unit_of(name) != unit}
    assert bare == {}


def test_variants_of_one_project_have_headings_of_their_own() -> None:
    rig = phea.example("benchmark/closed_loop")
    text = phea.compare(rig, rig.set({"supply.pressure": "6 MPa"})).text
    first, second = (line for line in text.splitlines() if line[:3] in ("A  ", "B  "))
    assert "without these settings" in first and "supply.pressure=6 MPa" in second


def test_the_end_of_an_error() -> None:
    text = phea.example("ybitu/hose").text
    wrong = text.replace('stroke = "500 mm"', 'stroke = "500 kg"')
    with pytest.raises(phea.ProjectError) as caught:
        phea.loads(wrong)
    found = next(found for found in caught.value.diagnostics if "length" in found.message)
    assert found.line is not None and found.column is not None and found.end is not None
    line = wrong.splitlines()[found.line - 1]
    assert found.end == (found.line, found.column + len("kg"))
    assert line[found.column - 1 : found.end[1] - 1] in ("kg", '"500 kg"', "500 kg")


def test_options_of_identify_are_those_of_the_command(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match='`side` has no effect on `of="valve"`'):
        phea.identify([], side="A")
    with pytest.raises(ValueError, match="at least 50, not 3"):
        phea.identify([], bootstrap=3)
    with pytest.raises(TypeError, match="a period or a segment, not both"):
        phea.identify([], of="response", period=1.0, segment=2.0)
    with pytest.raises(ValueError, match="not a positive time"):
        phea.identify([], of="response", period=-1.0)
