"""Linear models as python-control computes them by itself, and phea's numbers beside them."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from collections.abc import Iterator
from typing import Any

import control
import matplotlib
import numpy as np
import pytest
from matplotlib import pyplot

import phea
import phea.control as bridge
from phea.control._accepted import of_matrices
from phea.control._models import pade_factors
from phea.linear import Factors, Family, Linear

matplotlib.use("Agg")
pytestmark = pytest.mark.filterwarnings("ignore::phea.ProjectWarning")

FREQUENCIES = np.geomspace(1e-4, 1e4, 400)
EXAMPLES = phea.examples()


def models(name: str) -> Iterator[Factors]:
    """Every linear model of an example in s, without its dead time; three of its family."""
    project = phea.example(name)
    found = list(Linear(project).as_dict().values())
    family = Family(project)
    if not family.measured:
        chosen = (family.member(index) for index in (0, len(family) // 2, len(family) - 1))
        found += [plant for plant in chosen if plant is not None]
    for one in found:
        if one.sample_time_s is None:
            yield Factors(one.gain, one.zeros, one.poles)


def systems(model: Factors) -> tuple[Any, Any]:
    """The model as both kinds of system; a state space only where one exists."""
    proper = len(model.zeros) <= len(model.poles)
    return bridge.FactoredTransferFunction(model), bridge.FactoredStateSpace(
        model
    ) if proper else None


def apart(found: Any, expected: Any) -> float:
    """Largest relative distance of roots from those nearest to them."""
    found, expected = list(found), list(expected)
    assert len(found) == len(expected)
    worst = 0.0
    for root in expected:
        nearest = min(found, key=lambda one: abs(one - root))
        found.remove(nearest)
        worst = max(worst, abs(nearest - root) / (abs(root) or 1.0))
    return worst


@pytest.mark.parametrize("name", EXAMPLES)
def test_poles_zeros_and_gain(name: str) -> None:
    for model in models(name):
        transfer, states = systems(model)
        assert apart(transfer.poles(), model.poles) == 0.0 == apart(transfer.zeros(), model.zeros)
        assert transfer.num[0][0][0] == model.gain
        if states is None:
            continue
        # python-control's own eigenvalues, and zeros and gain from the matrices alone
        assert apart(control.StateSpace.poles(states), model.poles) < 1e-9
        again = of_matrices(states.A, states.B, states.C, states.D)
        assert apart(again.zeros, model.zeros) < 1e-9
        assert again.gain == pytest.approx(model.gain, rel=1e-9)


@pytest.mark.parametrize("name", EXAMPLES)
def test_frequency_responses(name: str) -> None:
    for model in models(name):
        transfer, states = systems(model)
        expected = model.response(FREQUENCIES)
        found = control.frequency_response(transfer, FREQUENCIES)
        assert np.allclose(found.frdata[0, 0], expected, rtol=1e-10, atol=0)
        if states is None:
            continue
        # the matrices alone, as any other state space
        plain = control.StateSpace(states.A, states.B, states.C, states.D)
        found = control.frequency_response(plain, FREQUENCIES).frdata[0, 0]
        assert np.all(np.abs(found - expected) <= 1e-10 * np.abs(expected).max())


def step(model: Factors, times: Any) -> Any:
    """Step response by partial fractions; at most one integrator, other poles simple."""
    poles = [pole for pole in model.poles.tolist() if pole != 0.0]
    integrates = len(poles) < len(model.poles)
    rest = Factors(model.gain, model.zeros, poles)
    value = np.full(times.shape, rest(0.0), dtype=np.complex128)
    if integrates:
        # f(0) t + f'(0) for f = P s
        slope = sum(-1.0 / zero for zero in model.zeros) - sum(-1.0 / pole for pole in poles)
        value = rest(0.0) * (times + slope)
    for index, pole in enumerate(poles):
        others = poles[:index] + poles[index + 1 :]
        residue = Factors(model.gain, model.zeros, others)(pole) / pole ** (2 if integrates else 1)
        value = value + residue * np.exp(pole * times)
    return value.real


@pytest.mark.parametrize("name", EXAMPLES)
def test_step_responses(name: str) -> None:
    compared = 0
    for model in models(name):
        states = systems(model)[1]
        others = [pole for pole in model.poles.tolist() if pole != 0.0]
        simple = len(others) >= len(model.poles) - 1 and len(set(others)) == len(others)
        if states is None or not others or not simple or 0.0 in model.zeros:
            continue
        for slowest in (min(others, key=abs), max(others, key=abs)):
            times = np.linspace(0.0, 5.0 / abs(slowest), 101)
            expected = step(model, times)
            found = control.step_response(states, times).outputs
            largest = np.abs(expected).max()
            assert np.all(np.abs(found - expected) <= 1e-8 * largest)
            compared += 1
    without = ("qft/measured", "qft/acc_benchmark", "qft/mistakes/wide_tracking")
    assert compared or name in without


def test_a_double_integrator_steps_as_its_closed_form() -> None:
    project = phea.example("qft/acc_benchmark")  # k/(s^2 (s^2 + 2 k))
    times = np.linspace(0.0, 10.0, 201)
    found = control.step_response(bridge.plant(project, {"k": 1.0}, form="ss"), times).outputs
    expected = times**2 / 4 - (1 - np.cos(np.sqrt(2) * times)) / 4
    assert np.abs(found - expected).max() <= 1e-8 * np.abs(expected).max()


def declared(text: str, **values: float) -> Any:
    """A formula of a project file in python-control's own arithmetic."""
    return eval(text.replace("^", "**"), {"__builtins__": {}}, {"s": control.tf("s"), **values})


@pytest.mark.parametrize("name", [one for one in EXAMPLES if one.startswith("qft/")])
def test_declared_formulas_in_the_arithmetic_of_python_control(name: str) -> None:
    project = phea.example(name)
    tables = tomllib.loads(project.text)
    cases = []
    if "plant" in tables:
        family = Family(project)
        for index in (0, len(family) - 1):
            values = dict(zip(family.parameters, family.values[index].tolist(), strict=True))
            cases.append((tables["plant"], values, bridge.plant(project, index, pade=1)))
    for table in ("controller", "prefilter"):
        if "numerator" in tables.get(table, {}):
            cases.append((tables[table], {}, getattr(bridge, table)(project)))
    for table, values, found in cases:
        upper, lower = (declared(table[one], **values) for one in ("numerator", "denominator"))
        expected = control.tf(1, 1) * upper / lower
        pade = int("delay" in table)
        assert apart(found.zeros()[: len(found.zeros()) - pade], expected.zeros()) < 1e-9
        assert len(found.poles()) == len(expected.poles()) + pade
        gain = expected.num[0][0][0] / expected.den[0][0][0]
        assert found.factors.gain * (-1) ** pade == pytest.approx(gain, rel=1e-9)
        if not pade:
            assert apart(found.poles(), expected.poles()) < 1e-7  # double poles in its polynomials
            assert np.allclose(
                found(1j * FREQUENCIES), expected(1j * FREQUENCIES), rtol=1e-10, atol=0
            )


def test_signal_names_and_time() -> None:
    names = {}
    for name in ("ybitu/hose", "rotary/vane", "qft/servo"):
        plant = bridge.plant(phea.example(name))
        names[name] = (*plant.input_labels, *plant.output_labels, plant.name, plant.dt)
    assert names["ybitu/hose"] == ("command_v", "force_n", "plant", 0)
    assert names["rotary/vane"] == ("command_v", "torque_n_m", "plant", 0)
    assert names["qft/servo"] == ("command", "output", "plant", 0)
    rig = phea.example("ybitu/hose")
    parts = [
        bridge.plant(rig, form="ss"),
        bridge.controller(rig, form="ss"),
        bridge.sensor(rig, form="ss"),
    ]
    junction = control.summing_junction(["filtered_reference_n", "-measured_force_n"], "error_n")
    whole = control.interconnect(
        [*parts, junction], inputs="filtered_reference_n", outputs="measured_force_n"
    )
    expected = bridge.complementary_sensitivity(rig)
    assert np.allclose(whole(1j * FREQUENCIES), expected(1j * FREQUENCIES), rtol=1e-9, atol=1e-15)


def test_products_keep_their_factors() -> None:
    servo = phea.example("qft/servo")
    plant, controller = bridge.plant(servo), bridge.controller(servo)
    whole = -2 * plant * controller / plant**2
    assert isinstance(whole, bridge.FactoredTransferFunction)
    expected = -2 * controller(3j) / plant(3j)
    assert whole(3j) == pytest.approx(expected, rel=1e-14)
    added = plant + controller  # a sum has no factors, and is python-control's own
    assert type(added) is control.TransferFunction
    assert added(3j) == pytest.approx(plant(3j) + controller(3j), rel=1e-12)
    assert (plant * control.tf([1], [1, 1]))(3j) == pytest.approx(plant(3j) / (1 + 3j), rel=1e-12)
    inverse: Any = 1 / plant
    assert inverse.zeros().tolist() == plant.poles().tolist()
    twelfth = bridge.FactoredTransferFunction(Factors(1.0, [], [-1.0])) ** 12
    assert set(twelfth.poles()) == {-1.0}  # a polynomial would scatter them by a tenth


def test_dead_time_needs_an_order() -> None:
    heated = phea.example("qft/dead_time")
    for function in (bridge.plant, bridge.loop, bridge.sensitivity, bridge.tracking):
        with pytest.raises(ValueError, match=r"expected pade=n.*found 0.2 s"):
            function(heated)
        assert isinstance(function(heated, pade=3), bridge.FactoredTransferFunction)
    slow = np.linspace(0.1, 5.0, 50)  # w T up to 1
    found = bridge.plant(heated, pade=6)(1j * slow)
    assert np.allclose(found, Family(heated).response(slow), rtol=1e-12, atol=0)
    poles = np.roots(control.pade(0.2, 4)[1])
    assert apart(pade_factors(0.2, 4).poles, poles) < 1e-12
    wrong: list[Any] = [0, 2.5, True]
    for order in wrong:
        with pytest.raises(ValueError, match="whole number"):
            bridge.plant(heated, pade=order)


def test_models_that_do_not_exist() -> None:
    with pytest.raises(phea.NoAnswer, match="no controller"):
        bridge.controller(phea.example("qft/by_hand"))
    with pytest.raises(phea.NoAnswer, match="no prefilter"):
        bridge.prefilter(phea.example("qft/dead_time"))
    with pytest.raises(ValueError, match=r"polynomials.*measured"):
        bridge.plant(phea.example("qft/measured"))
    with pytest.raises(ValueError, match="waves"):
        bridge.plant(phea.example("ybitu/hose").set({"line.model": "transmission_line"}))
    with pytest.raises(ValueError, match="expected form"):
        bridge.plant(phea.example("qft/servo"), form="zpk")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="at most as many zeros"):
        bridge.controller(phea.example("qft/servo").set({"controller.denominator": "1"}), form="ss")


def test_frequency_responses_of_waves_and_of_measurements() -> None:
    waves = phea.example("ybitu/hose").set({"line.model": "transmission_line"})
    found = bridge.frequency_response(waves, FREQUENCIES)
    assert isinstance(found, control.FrequencyResponseData) and found.input_labels == ["command_v"]
    assert np.array_equal(found.frdata[0, 0], Family(waves).response(FREQUENCIES))
    measured = phea.example("qft/measured")
    second = bridge.frequency_response(measured, member=1)
    assert np.array_equal(second.omega, Family(measured).measured[1].frequencies_rad_per_s)
    assert second.name == "light"
    for project, frequencies in ((measured, [1.0]), (waves, None)):
        with pytest.raises(ValueError, match="expected"):
            bridge.frequency_response(project, frequencies)


def test_a_run_plots() -> None:
    run = phea.example("ybitu/hose").simulate(figures=False)
    table = run.tables["step and load motion"]
    response = bridge.time_response(run, "step and load motion")
    assert isinstance(response, control.TimeResponseData)
    assert response.output_labels == ["force_n", "command_v"] and response.input_labels == [
        "reference_n"
    ]
    assert np.array_equal(response.time, table.time_s)
    assert np.array_equal(response.outputs[0], table.force_n)
    plotted = response.plot()
    assert np.array_equal(plotted.lines[0, 0][0].get_ydata(), table.force_n)
    pyplot.close("all")
    with pytest.raises(ValueError, match="'force steps'"):
        bridge.time_response(run)
    with pytest.raises(ValueError, match="'force'"):
        bridge.time_response(run, "force steps", outputs=("force",))


def test_python_control_is_imported_when_it_is_needed() -> None:
    script = "import sys; sys.modules['control'] = None; import phea; phea.control"
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, check=False)
    assert run.returncode == 1
    assert (
        run.stderr.decode().rstrip().endswith("control is needed here: pip install 'phea[control]'")
    )
