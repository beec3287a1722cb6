"""Closed loops beside python-control's own, and the audit's steps beside its step responses."""

from __future__ import annotations

from typing import Any

import control
import numpy as np
import pytest

import phea
import phea.control as bridge

pytestmark = pytest.mark.filterwarnings("ignore::phea.ProjectWarning")

FREQUENCIES = np.geomspace(1e-4, 1e4, 400)


def apart(found: Any, expected: Any) -> float:
    """Largest relative distance of roots from those nearest to them."""
    found = np.asarray(found)
    assert len(found) == len(expected)
    return max(float(np.abs(found - root).min() / (abs(root) or 1.0)) for root in expected)


LOOPS = [
    "qft/servo",
    "qft/unstable_plant",
    "qft/edge_plants",
    "ybitu/hose",
    "ybitu/pipe",
    "ybitu/series",
]


@pytest.mark.parametrize("name", LOOPS)
def test_closed_loops(name: str) -> None:
    project = phea.example(name)
    points = 1j * FREQUENCIES
    product = bridge.plant(project) * bridge.controller(project) * bridge.sensor(project)
    loop = bridge.loop(project)
    assert np.allclose(loop(points), product(points), rtol=1e-12, atol=0)
    sensitivity, complementary = (
        bridge.sensitivity(project),
        bridge.complementary_sensitivity(project),
    )
    assert np.allclose(sensitivity(points), 1 / (1 + loop(points)), rtol=1e-9, atol=0)
    assert np.allclose(complementary(points), loop(points) / (1 + loop(points)), rtol=1e-9, atol=0)
    # python-control's own feedback of the open loop's state space
    closed = control.feedback(control.ss(bridge.loop(project, form="ss")), 1)
    assert apart(complementary.poles(), control.StateSpace.poles(closed)) < 1e-6
    assert np.abs(1 + loop(complementary.poles())).max() < 1e-7


def test_an_unstable_loop_is_stable_where_its_polynomial_is() -> None:
    # s^2 + C k s + C k a - 2.5: stable if C k a > 2.5
    project = phea.example("qft/unstable_plant")
    for gain, stable in ((24.0, False), (26.0, True)):
        loop = project.set({"controller.numerator": str(gain)})
        poles = bridge.sensitivity(loop, {"k": 1.0, "a": 0.1}).poles()
        assert apart(poles, np.roots([1.0, gain, 0.1 * gain - 2.5])) < 1e-12
        assert bool(np.all(poles.real < 0)) is stable


def test_overshoot_and_settling_of_the_worst_plants() -> None:
    rig = phea.example("ybitu/hose")
    found = rig.verify().json["specifications"][2]["in_time"]
    band = found["required"]["settling_band_percent"] / 100
    times = np.linspace(0.0, 5.0, 200_001)
    worst = bridge.tracking(rig, found["overshoot_plant"], form="ss")
    info = control.step_info(control.step_response(worst, times).outputs, times, yfinal=1.0)
    assert info["Overshoot"] == pytest.approx(found["worst_overshoot_percent"], abs=1e-3)
    slowest = bridge.tracking(rig, found["settling_plant"], form="ss")
    outputs = control.step_response(slowest, times).outputs
    info = control.step_info(outputs, times, SettlingTimeThreshold=band, yfinal=1.0)
    assert info["SettlingTime"] == pytest.approx(found["worst_settling_time_s"], rel=1e-3)


@pytest.mark.parametrize("key", ["load_velocity_feed_forward", "pressure_feedback"])
def test_loops_with_further_paths_are_refused(key: str) -> None:
    fed = phea.example("ybitu/hose").set({f"controller.{key}.gain": 1e-9})
    with pytest.raises(ValueError, match=rf"expected .* without {key}; found controller.{key}"):
        bridge.loop(fed)
