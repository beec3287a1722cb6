"""Systems of python-control, SciPy and others go into projects and come back as they were."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import control
import numpy as np
import pytest
import scipy.signal
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import phea
import phea.control as bridge
from phea.linear import Factors, Family, Linear

pytestmark = pytest.mark.filterwarnings("ignore::phea.ProjectWarning")

SAMPLE_TIME_S = 0.01

# The same systems on every computer, and no clock.
SAME = settings(
    derandomize=True, database=None, deadline=None, suppress_health_check=list(HealthCheck)
)


@st.composite
def factors(draw: st.DrawFn, sampled: bool | None = None) -> Factors:
    """Random proper system of order 0 to 8 whose roots are apart from each other."""
    in_z = draw(st.booleans()) if sampled is None else sampled
    order = draw(st.integers(0, 8))
    seed = draw(st.integers(0, 2**32 - 1))
    random = np.random.default_rng(seed)
    gain = draw(st.sampled_from([-1, 1])) * 10 ** draw(st.floats(-3, 3))

    def roots(count: int) -> list[complex]:
        found: list[complex] = []
        while len(found) < count:
            angle = random.uniform(0.55 * np.pi, np.pi)
            size = random.uniform(0.1, 1.0) if in_z else 10 ** random.uniform(-1, 2)
            root = size * complex(np.cos(angle), np.sin(angle))
            group = (
                [root, root.conjugate()]
                if count - len(found) > 1 and random.random() < 0.5
                else [-size]
            )
            if all(abs(one - other) > 0.05 * abs(one) for one in group[:1] for other in found):
                found += group
        return found

    zeros, poles = roots(draw(st.integers(0, order))), roots(order)
    return Factors(gain, zeros, poles, 0.0, SAMPLE_TIME_S if in_z else None)


KINDS = ["factors", "tf", "ss", "own_tf", "own_ss", "lti", "num_den", "zpk", "matrices"]


def as_kind(model: Factors, kind: str) -> Any:
    """The system as an object of this kind."""
    dt = model.sample_time_s
    numerator, denominator = model.gain * np.poly(model.zeros).real, np.poly(model.poles).real
    numerator, denominator = np.atleast_1d(numerator), np.atleast_1d(denominator)
    states = bridge.FactoredStateSpace(model)
    mixed = np.linalg.qr(np.random.default_rng(1).normal(size=states.A.shape))[0]
    matrices = dict(
        A=mixed.T @ states.A @ mixed, B=mixed.T @ states.B, C=states.C @ mixed, D=states.D
    )
    zpk = dict(zeros=model.zeros, poles=model.poles, gain=model.gain)
    made: dict[str, Callable[[], Any]] = {
        "factors": lambda: model,
        "own_tf": lambda: bridge.FactoredTransferFunction(model),
        "own_ss": lambda: states,
        "tf": lambda: control.TransferFunction(numerator, denominator, dt or 0),
        "ss": lambda: control.StateSpace(*matrices.values(), dt or 0),
        "lti": lambda: (
            scipy.signal.dlti(*zpk.values(), dt=dt) if dt else scipy.signal.lti(*zpk.values())
        ),
        "num_den": lambda: SimpleNamespace(num=numerator, den=denominator, dt=dt),
        "zpk": lambda: SimpleNamespace(**zpk, dt=dt),
        "matrices": lambda: SimpleNamespace(**matrices, dt=dt),
    }
    return made[kind]()


def points(model: Factors) -> Any:
    """Frequencies, rad/s, over the roots, and up to half the sampling frequency."""
    return np.geomspace(
        1e-2, 1e3 if model.sample_time_s is None else 0.99 * np.pi / SAMPLE_TIME_S, 40
    )


def check_same(found: Factors | None, model: Factors, kind: str) -> None:
    """The same orders, gain and response.

    A full matrix holds a response only to rounding of its largest value, and so no gain far above
    its poles; a polynomial holds its roots only as precisely as they depend on its coefficients.
    """
    assert found is not None
    assert len(found.poles) == len(model.poles) and len(found.zeros) == len(model.zeros)
    full = kind in ("ss", "matrices")
    assert full or found.gain == pytest.approx(model.gain, rel=1e-12)
    assert found.sample_time_s == model.sample_time_s or not len(model.poles)
    frequencies = points(model)
    expected = model.response(frequencies)
    allowed = 1e-6 * np.abs(expected).max() if full else 1e-8 * np.abs(expected)
    assert np.all(np.abs(found.response(frequencies) - expected) <= allowed)


# Kinds whose roots are numbers; the others hold them only as precisely as their coefficients do.
EXACT = ("factors", "own_tf", "own_ss", "lti", "zpk")


@settings(SAME, max_examples=300)
@given(model=factors(), kind=st.sampled_from(KINDS))
def test_random_systems_come_back_as_controllers(model: Factors, kind: str) -> None:
    project = bridge.with_controller(phea.example("qft/by_hand"), as_kind(model, kind))
    found = Linear(phea.loads(project.text)).controller
    check_same(found, model, kind)
    assert found is not None
    if kind in EXACT:
        assert set(found.poles.tolist()) == set(model.poles.tolist())
        assert set(found.zeros.tolist()) == set(model.zeros.tolist())
    if len(model.poles):
        assert bridge.controller(project).dt == (model.sample_time_s or 0.0)


@settings(SAME, max_examples=100)
@given(
    model=factors(sampled=False),
    kind=st.sampled_from(KINDS),
    dead=st.sampled_from([None, 0.0, 0.25]),
)
def test_random_systems_come_back_as_plants(model: Factors, kind: str, dead: float | None) -> None:
    project = bridge.with_plant(None, as_kind(model, kind), dead_time_s=dead)
    found = Family(phea.loads(project.text)).member()
    assert found is not None and found.dead_time_s == (dead or 0.0)
    check_same(Factors(found.gain, found.zeros, found.poles), model, kind)


@settings(SAME, max_examples=50)
@given(model=factors(sampled=False), kind=st.sampled_from(KINDS))
def test_random_systems_come_back_as_prefilters(model: Factors, kind: str) -> None:
    project = bridge.with_prefilter(phea.example("qft/servo"), as_kind(model, kind))
    check_same(Linear(phea.loads(project.text)).prefilter, model, kind)


@settings(SAME, max_examples=100)
@given(seed=st.integers(0, 2**32 - 1), plants=st.integers(1, 4), count=st.integers(2, 40))
def test_random_responses_come_back_as_measured_plants(seed: int, plants: int, count: int) -> None:
    random = np.random.default_rng(seed)
    given = []
    for _ in range(plants):
        frequencies = np.cumsum(random.uniform(0.1, 10.0, count))
        given.append((frequencies, random.normal(size=count) + 1j * random.normal(size=count)))
    data = [control.FrequencyResponseData(responses, points) for points, responses in given]
    project = bridge.measured_family(None, data)
    found = Family(phea.loads(project.text, files=dict(project.files))).measured
    assert len(found) == plants
    for plant, (points, responses) in zip(found, given, strict=True):
        assert np.array_equal(plant.frequencies_rad_per_s, points)
        assert np.allclose(plant.responses, responses, rtol=1e-12, atol=0)


def test_a_measured_family_of_systems() -> None:
    frequencies = np.geomspace(0.1, 100.0, 30)
    lags = {f"lag {corner}": scipy.signal.lti([], [-corner], corner) for corner in (1.0, 2.0)}
    project = bridge.measured_family(phea.example("qft/servo"), lags, frequencies, integrators=0)
    for plant, corner in zip(Family(project).measured, (1.0, 2.0), strict=True):
        assert np.allclose(plant.responses, corner / (1j * frequencies + corner), rtol=1e-12)
    tables = tomllib.loads(project.text)
    assert "plant" not in tables and "uncertainty" not in tables
    assert tables["specification"] == tomllib.loads(phea.example("qft/servo").text)["specification"]
    back = bridge.with_plant(project, lags["lag 1.0"])
    assert "family" not in tomllib.loads(back.text) and Family(back).member() is not None


def test_comments_and_other_tables_stay() -> None:
    servo = phea.example("qft/servo")
    new = bridge.with_controller(servo, control.tf([2, 3], [1, 0]))
    old, found = servo.text.splitlines(), new.text.splitlines()
    assert [line for line in old if line not in found] == [
        'numerator = "3.0787e6*s^2 + 3.5365e8*s + 3.8529e8"',
        'denominator = "s^3 + 1528.8*s^2 + 1.0636e6*s + 4.281e7"',
    ]
    assert [line for line in found if line not in old] == [
        'numerator = "2.0*s + 3.0"',
        'denominator = "1.0*s"',
    ]
    assert bridge.with_plant(servo, 2.0).text.count("#") == servo.text.count("#")


def test_settings_of_what_is_replaced_are_dropped() -> None:
    servo = phea.example("qft/servo").set({"controller.numerator": "1", "controller.delay": 0.01})
    new = bridge.with_controller(servo, 2.0)
    assert new.settings == ("controller.delay=0.01",)
    assert Linear(new).controller == Factors(2.0)
    whole = phea.example("qft/servo").set({"controller": {"numerator": "1", "denominator": "s"}})
    with pytest.raises(ValueError, match="setting of the whole table"):
        bridge.with_controller(whole, 2.0)


SAMPLED = bridge.with_controller(
    phea.example("qft/by_hand"), control.tf([1], [1, -0.5], SAMPLE_TIME_S)
)


def test_a_sample_time_that_is_not_stated_is_that_of_the_project() -> None:
    new = bridge.with_controller(SAMPLED, scipy.signal.dlti([2.0], [1.0, -0.25]))
    assert Linear(new).controller == Factors(2.0, [], [0.25], 0.0, SAMPLE_TIME_S)
    filtered = bridge.with_prefilter(SAMPLED, control.tf([0.8], [1, -0.2], SAMPLE_TIME_S))
    assert Linear(filtered).prefilter == Factors(0.8, [], [0.2], 0.0, SAMPLE_TIME_S)
    alone = bridge.with_prefilter(phea.example("qft/by_hand"), control.tf([0.8], [1, -0.2], 0.02))
    assert tomllib.loads(alone.text)["controller"] == {"sample_time": 0.02}
    timed = phea.example("qft/servo").set({"controller.sample_time": "10 ms"})
    assert (
        bridge.controller(bridge.with_controller(timed, control.tf([1], [1, 0], 0.01))).dt == 0.01
    )
    milli = phea.loads(SAMPLED.text.replace("sample_time = 0.01", 'sample_time = "10 ms"'))
    assert (
        bridge.controller(bridge.with_controller(milli, control.tf([1], [1, 0], 0.01))).dt == 0.01
    )


SERVO = phea.example("qft/servo")
TWO_BY_TWO = control.ss(-np.eye(2), np.eye(2), np.eye(2), np.zeros((2, 2)))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: bridge.with_controller(SERVO, TWO_BY_TWO), "2 inputs and 2 outputs"),
        (lambda: bridge.with_plant(SERVO, control.tf(TWO_BY_TWO)), "one input and one output"),
        (lambda: bridge.with_plant(SERVO, scipy.signal.lti([[0.0]], [[1, 1]], [[1]], [[0, 0]])),
         "2 inputs and 1 outputs"),
        (lambda: bridge.with_plant(SERVO, SimpleNamespace(A=np.eye(2), B=np.eye(2), C=[1, 0], D=0)),
         "2 inputs"),
        (lambda: bridge.with_plant(SERVO, SimpleNamespace(num=[[1], [2]], den=[1, 1])), "2 rows"),
        (lambda: bridge.measured_family(None, [control.frd(TWO_BY_TWO, [1.0, 2.0])]), "2 inputs"),
        (lambda: bridge.with_controller(SAMPLED, control.tf([1], [1, 0], 0.02)),
         "expected dt = 0.01, the sample time of the project; found 0.02"),
        (lambda: bridge.with_controller(SAMPLED, control.tf([3], [1], 0.02)), "expected dt = 0.01"),
        (lambda: bridge.with_prefilter(SAMPLED, control.tf([1], [1, 0], 0.02)),
         "expected dt = 0.01, the sample time of the project; found 0.02"),
        (lambda: bridge.with_controller(SERVO, control.tf([1], [1, 0], 0.02)), "controller in s"),
        (lambda: bridge.with_prefilter(SERVO, control.tf([1], [1, 0], 0.02)), "prefilter in s"),
        (lambda: bridge.with_controller(phea.example("qft/by_hand"), control.tf([1], [1, 0], True)),
         "expected a sample time"),
        (lambda: bridge.with_plant(SERVO, control.tf([1], [1, 0], 0.02)), "expected a plant in s"),
        (lambda: bridge.measured_family(None, [control.frd([1, 1], [1, 2], 0.1)]), "plant in s"),
        (lambda: bridge.with_controller(SERVO, Factors(1.0, [], [-1.0], 0.1)), "controller.delay"),
        (lambda: bridge.with_plant(SERVO, SimpleNamespace(num=[1], den=[1, 1], delay=0.1)),
         "found delay = 0.1"),
        (lambda: bridge.with_plant(SERVO, 1.0, dead_time_s=-1.0), "at least 0 s"),
        (lambda: bridge.with_plant(phea.example("ybitu/hose"), 1.0), r"found \[cylinder\]"),
        (lambda: bridge.with_controller(SERVO, 0.0), "other than zero"),
        (lambda: bridge.with_controller(SERVO, control.tf([0], [1, 1])), "not zero"),
        (lambda: bridge.with_controller(SERVO, control.ss(-1, 0, 1, 0)), "depends on its input"),
        (lambda: bridge.with_plant(SERVO, SimpleNamespace(num=[1j], den=[1, 1])), "real finite"),
        (lambda: bridge.with_plant(SERVO, SimpleNamespace(num=[np.nan], den=[1])), "real finite"),
        (lambda: bridge.with_plant(SERVO, SimpleNamespace(zeros=[1j], poles=[], gain=1)), "pairs"),
        (lambda: bridge.measured_family(None, []), "at least one"),
        (lambda: bridge.measured_family(None, [([2.0, 1.0], [1, 1])]), "increasing"),
        (lambda: bridge.measured_family(None, [([1.0, 2.0], [1])]), "as many responses"),
        (lambda: bridge.measured_family(None, [([1.0, 2.0], [1, np.inf])]), "finite"),
        (lambda: bridge.measured_family(None, [control.tf(1, [1, 1])]), "frequencies_rad_per_s"),
        (lambda: bridge.measured_family(None, {"a/b": ([1.0], [1])}), "name that can be"),
    ],
)  # fmt: skip
def test_refusals_name_what_was_expected_and_found(call: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message) as caught:
        call()
    assert "expected" in str(caught.value) and "found" in str(caught.value)


@pytest.mark.parametrize("system", ["s", None, control.frd([1, 1], [1.0, 2.0]), object()])
def test_other_objects_are_type_errors(system: object) -> None:
    with pytest.raises(TypeError, match="expected a TransferFunction"):
        bridge.with_controller(SERVO, system)
