"""Loops of a project as systems of python-control."""

from __future__ import annotations

import tomllib
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from phea._factors import Factors
from phea.control._models import Form, plant_factors, rational, signals, system_of
from phea.control._systems import closed, product
from phea.errors import NoAnswer
from phea.linear import Family, Linear, MemberChoice

if TYPE_CHECKING:
    from phea._project import Project
    from phea.control._models import System


def loop(
    project: Project,
    member: MemberChoice | None = None,
    *,
    form: Form = "tf",
    pade: int | None = None,
) -> System:
    """Open loop L = P G H around a member of the family, as `Project.verify` judges it.

    It includes ``controller.delay``. The loop of a sampled controller is in z, from sample to
    sample: the deployed law, and plant and sensor behind a hold, which carry any dead time.

    Parameters
    ----------
    project
        Project with a controller and with a rig or a ``[plant]``.
    member, form, pade
        As for `plant`; a dead time of the plant and one of the sensor are quotients of this order
        each.

    Returns
    -------
    control.TransferFunction or control.StateSpace
        From the error to the measured output.

    Raises
    ------
    NoAnswer
        If the project has no controller.
    ValueError
        For dead time in a continuous loop without `pade`, or a plant without polynomials.

    Examples
    --------
    >>> import phea
    >>> from phea.control import controller, plant
    >>> servo = phea.example("qft/servo")
    >>> bool(abs(loop(servo)(3j) - plant(servo)(3j) * controller(servo)(3j)) < 1e-12)
    True
    """
    parts, names = _parts(project, member, pade), signals(project)
    ends = names["controller"][0], names["sensor"][1]
    return system_of(parts.loop, ends, "loop", form, None)


def sensitivity(
    project: Project,
    member: MemberChoice | None = None,
    *,
    form: Form = "tf",
    pade: int | None = None,
) -> System:
    """Sensitivity S = 1/(1 + L), from the filtered reference to the error; as for `loop`.

    Examples
    --------
    >>> import phea
    >>> servo = phea.example("qft/servo")
    >>> s, t = sensitivity(servo), complementary_sensitivity(servo)
    >>> bool(abs(s(2j) + t(2j) - 1) < 1e-12)
    True
    """
    whole, names = _parts(project, member, pade).loop, signals(project)
    ends = names["prefilter"][1], names["controller"][0]
    return system_of(closed(whole, whole.poles, 1.0), ends, "sensitivity", form, None)


def complementary_sensitivity(
    project: Project,
    member: MemberChoice | None = None,
    *,
    form: Form = "tf",
    pade: int | None = None,
) -> System:
    """Complementary sensitivity T = L/(1 + L), to the measured output; as for `loop`.

    Examples
    --------
    >>> import phea
    >>> float(abs(complementary_sensitivity(phea.example("qft/servo")).dcgain()).round(9))
    1.0
    """
    whole, names = _parts(project, member, pade).loop, signals(project)
    ends = names["prefilter"][1], names["sensor"][1]
    found = closed(whole, whole.zeros, whole.gain)
    return system_of(found, ends, "complementary_sensitivity", form, None)


def tracking(
    project: Project,
    member: MemberChoice | None = None,
    *,
    form: Form = "tf",
    pade: int | None = None,
) -> System:
    """F P G/(1 + L) from the reference to the controlled output; as for `loop`.

    Examples
    --------
    >>> import phea
    >>> float(abs(tracking(phea.example("qft/servo")).dcgain()).round(9))
    1.0
    """
    parts, names = _parts(project, member, pade), signals(project)
    whole, forward = parts.loop, product(parts.controller, parts.plant)
    # the poles of P G cancel; those of the sensor stay as zeros
    left = whole.poles.tolist()
    for pole in forward.poles.tolist():
        left.remove(min(left, key=lambda one: abs(one - pole)))
    zeros = np.concatenate([forward.zeros, np.array(left, dtype=np.complex128)])
    found = product(closed(whole, zeros, forward.gain), parts.prefilter)
    ends = names["prefilter"][0], names["plant"][1]
    return system_of(found, ends, "tracking", form, None)


class _Parts(NamedTuple):
    """Parts of a loop as they act in it, without dead time; the plant has that of the loop."""

    controller: Factors
    prefilter: Factors
    plant: Factors
    plant_and_sensor: Factors

    @property
    def loop(self) -> Factors:
        return product(self.controller, self.plant_and_sensor)


def _parts(project: Project, member: MemberChoice | None, pade: int | None) -> _Parts:
    linear = Linear(project)
    if linear.controller is None:
        raise NoAnswer("the project has no controller", "{}")
    _refuse_further_paths(project)
    plant_factors(project, member)  # refuses plants without polynomials
    family = Family(project)
    found = family._native.loop(family.values_of(0 if member is None else member))
    if found is None:
        raise ValueError("expected a loop of transfer functions; found one that has none")
    parts = {name: Factors(*factors) for name, factors in found.items()}
    controller, prefilter, plant = parts["controller"], parts["prefilter"], parts["plant"]
    if controller.sample_time_s is not None:
        both = rational(parts["plant_and_sensor"], "", None)
        return _Parts(controller, prefilter, rational(plant, "", None), both)
    plant = rational(plant, "plant", pade)
    both = product(plant, rational(linear.sensor, "sensor", pade))
    return _Parts(controller, rational(prefilter, "prefilter", pade), plant, both)


# Keys of [controller] with which the loop is more than controller, plant and sensor.
_FURTHER_PATHS = ("load_velocity_feed_forward", "impedance", "pressure_feedback")


def _refuse_further_paths(project: Project) -> None:
    stated = tomllib.loads(project.text).get("controller", {})
    paths = [setting.strip().removeprefix("controller.") for setting in project.settings]
    for key in _FURTHER_PATHS:
        if key in stated or any(path.startswith(key) for path in paths):
            raise ValueError(f"expected a controller without {key}; found controller.{key}")
