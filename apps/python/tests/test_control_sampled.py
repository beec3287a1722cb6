"""Sampled laws and loops beside python-control's own discretisations."""

from __future__ import annotations

from typing import Any

import control
import numpy as np
import pytest

import phea
import phea.control as bridge
from phea.linear import Factors

pytestmark = pytest.mark.filterwarnings("ignore::phea.ProjectWarning")

T = 0.01
LAWS = {
    "lag": Factors(5.0, [], [-5.0]),
    "lead": Factors(8.0, [-3.0], [-40.0]),
    "pi": Factors(2.0, [-3.0], [0.0]),
    "notch": Factors(1.0, [-1 + 20j, -1 - 20j], [-10 + 17j, -10 - 17j]),
    "third order": Factors(7e4, [-1.2, -30.0], [-60.0, -40 + 60j, -40 - 60j]),
    "far roll-off": Factors(1e6, [-5.0], [0.0, -100.0, -70 + 70j, -70 - 70j]),
}
METHODS = {"tustin": "bilinear", "zero_order_hold": "zoh", "matched": "matched"}


def points(sample_time_s: float) -> Any:
    """400 points on the circle, below half the sampling frequency."""
    return np.exp(1j * np.geomspace(1e-4, 0.99 * np.pi / sample_time_s, 400) * sample_time_s)


def sampled(law: Factors, values: dict[str, Any]) -> Any:
    """The deployed law in a project with this timing."""
    project = bridge.with_controller(phea.example("qft/by_hand"), law)
    return bridge.controller(project.set({"controller.sample_time": T, **values}), deployed=True)


# python-control matches neither integrators nor several zeros at infinity.
PAIRS = [(name, method) for name in LAWS for method in METHODS if method != "matched"]
PAIRS += [(name, "matched") for name in ("lag", "lead", "notch", "third order")]


@pytest.mark.parametrize(("name", "method"), PAIRS)
def test_discretisations(name: str, method: str) -> None:
    law = LAWS[name]
    found = sampled(law, {"controller.discretization": method})
    model = (
        bridge.FactoredTransferFunction(law)
        if method == "matched"
        else bridge.FactoredStateSpace(law)
    )
    expected = control.sample_system(model, T, METHODS[method])
    z = points(T)
    assert found.dt == T
    assert np.allclose(found(z), expected(z), rtol=1e-10, atol=1e-10 * np.abs(expected(z)).max())


def test_prewarping() -> None:
    found = sampled(LAWS["notch"], {"controller.discretization_frequency": 20.0})
    states = bridge.FactoredStateSpace(LAWS["notch"])
    expected = control.sample_system(states, T, "bilinear", prewarp_frequency=20.0)
    assert np.allclose(found(points(T)), expected(points(T)), rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("qft/servo", {"controller.sample_time": 1e-3}),
        ("qft/servo", {"controller.sample_time": 1e-3, "controller.delay": 2e-3}),
        ("benchmark/closed_loop_sampled", {}),
    ],
)
def test_sampled_loops(name: str, values: dict[str, float]) -> None:
    project = phea.example(name).set(values)
    loop, law = bridge.loop(project), bridge.controller(project, deployed=True)
    states = bridge.plant(project, form="ss") * bridge.sensor(project, form="ss")
    delay = control.tf(
        [1.0], [1.0, *[0.0] * round(values.get("controller.delay", 0.0) / 1e-3)], 1e-3
    )
    z = points(1e-3)
    expected = law(z) * control.sample_system(states, 1e-3, "zoh")(z) * delay(z)
    assert loop.dt == 1e-3
    assert np.allclose(loop(z), expected, rtol=1e-8, atol=0)
    assert np.allclose(bridge.sensitivity(project)(z), 1 / (1 + expected), rtol=1e-7, atol=0)


def test_a_fraction_of_a_sample() -> None:
    # 1/(s + a) behind a hold and a delay of 0.4 T: part of each command acts a sample later
    a, fraction = 3.0, 0.4
    project = bridge.with_plant(
        bridge.with_controller(phea.example("qft/by_hand"), 1.0), Factors(1.0, [], [-a])
    )
    loop = bridge.loop(project.set({"controller.sample_time": T, "controller.delay": fraction * T}))
    first, whole = np.exp(-a * T * (1 - fraction)), np.exp(-a * T)
    z = points(T)
    expected = ((1 - first) + (first - whole) / z) / (a * (z - whole))
    assert np.allclose(loop(z), expected, rtol=1e-10, atol=0)


def test_overshoot_of_a_sampled_loop() -> None:
    rig = phea.example("ybitu/hose").set(
        {"controller.sample_time": "1 ms", "controller.delay": "1 ms"}
    )
    found = rig.verify().json["specifications"][2]["in_time"]
    times = 1e-3 * np.arange(5001)
    worst = bridge.tracking(rig, found["overshoot_plant"], form="ss")
    outputs = control.step_response(worst, times).outputs
    info = control.step_info(outputs, times, yfinal=1.0)
    assert info["Overshoot"] == pytest.approx(found["worst_overshoot_percent"], abs=1e-3)
