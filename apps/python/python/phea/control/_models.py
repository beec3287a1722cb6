"""Linear models of a project as systems of python-control."""

from __future__ import annotations

import math
import tomllib
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from phea._factors import Factors
from phea.control._systems import FactoredStateSpace, FactoredTransferFunction, product
from phea.errors import NoAnswer
from phea.linear import Family, Linear, MemberChoice

if TYPE_CHECKING:
    from phea._project import Project

    System: TypeAlias = FactoredTransferFunction | FactoredStateSpace

Form: TypeAlias = Literal["tf", "ss"]


def plant(
    project: Project,
    member: MemberChoice | None = None,
    *,
    form: Form = "tf",
    pade: int | None = None,
) -> System:
    """Plant from the command to the force, or to the output of a ``[plant]``.

    Parameters
    ----------
    project
        Project with a rig or a ``[plant]``.
    member
        Member of the family by its index, or by values of its parameters (those that are not named
        are nominal); absent: the nominal plant, or the plant of the rig if there is no family.
    form
        ``"tf"`` for a `TransferFunction`, ``"ss"`` for a `StateSpace`; both keep the factors. Time
        responses of python-control avoid polynomials with ``"ss"`` only.
    pade
        Order of the quotient that replaces a dead time; without it, a dead time is refused.

    Returns
    -------
    control.TransferFunction or control.StateSpace
        With signal names such as ``command_v`` and ``force_n``.

    Raises
    ------
    ValueError
        For dead time without `pade`, or a plant without polynomials.

    Examples
    --------
    >>> import phea
    >>> rig = plant(phea.example("ybitu/hose"))
    >>> rig.input_labels, rig.output_labels, len(rig.poles())
    (['command_v'], ['force_n'], 5)
    """
    found = plant_factors(project, member)
    return system_of(found, signals(project)["plant"], "plant", form, pade)


def load_position(project: Project, *, form: Form = "tf", pade: int | None = None) -> System:
    """Path of a rig from the position of the load to the force; parameters as for `plant`.

    Examples
    --------
    >>> import phea
    >>> load_position(phea.example("ybitu/hose")).input_labels
    ['load_position_m']
    """
    return _of(project, "load_position", form, pade)


def controller(
    project: Project, *, deployed: bool = False, form: Form = "tf", pade: int | None = None
) -> System:
    """Controller from the error to the command.

    Parameters
    ----------
    project
        Project with a controller.
    deployed
        The law that the computer of a sampled controller runs, in z, instead of the declared one.
    form, pade
        As for `plant`.

    Returns
    -------
    control.TransferFunction or control.StateSpace
        In z, with its ``dt``, if the controller is written in z.

    Raises
    ------
    NoAnswer
        If the project has no controller.

    Examples
    --------
    >>> import phea
    >>> controller(phea.example("qft/dead_time")).zeros().tolist()
    [(-1+0j)]
    """
    return _of(project, "deployed_controller" if deployed else "controller", form, pade)


def prefilter(
    project: Project, *, deployed: bool = False, form: Form = "tf", pade: int | None = None
) -> System:
    """Prefilter from the reference to the filtered reference; parameters as for `controller`.

    Examples
    --------
    >>> import phea
    >>> float(prefilter(phea.example("qft/servo")).dcgain().round(9))
    1.0
    """
    return _of(project, "deployed_prefilter" if deployed else "prefilter", form, pade)


def sensor(project: Project, *, form: Form = "tf", pade: int | None = None) -> System:
    """Sensor from the controlled output to the controller; parameters as for `plant`.

    Examples
    --------
    >>> import phea
    >>> sensor(phea.example("qft/load_frame"), pade=2).output_labels
    ['measured_output']
    """
    return _of(project, "sensor", form, pade)


def pade_factors(dead_time_s: float, order: int) -> Factors:
    """Diagonal Pade quotient of ``e^(-s T)``, by its roots.

    Examples
    --------
    >>> quotient = pade_factors(0.2, 5)
    >>> bool(abs(quotient(1j) - complex(math.cos(0.2), -math.sin(0.2))) < 1e-13)
    True
    """
    if isinstance(order, bool) or not isinstance(order, int) or order < 1:
        raise ValueError(f"expected a whole number of at least 1 for pade; found {order!r}")
    n = order
    size = [
        math.factorial(2 * n - k) // math.factorial(n - k) // math.factorial(k)
        for k in range(n + 1)
    ]
    roots = np.roots([float(value) for value in reversed(size)]) / dead_time_s
    return Factors((-1.0) ** n, -roots, roots)


def plant_factors(project: Project, member: MemberChoice | None) -> Factors:
    """Plant of the family; that of the rig where there is no family."""
    try:
        family = Family(project)
    except NoAnswer:
        rig = Linear(project).plant
        if member is not None or rig is None:
            raise
        return rig
    if family.measured:
        raise ValueError("expected a plant with polynomials; found measured responses")
    found = family.member(0 if member is None else member)
    if found is None:
        raise ValueError(
            "expected a plant with polynomials; found one that has only responses, such as lines "
            "with waves: frequency_response() has them"
        )
    return found


def _of(project: Project, name: str, form: Form, pade: int | None) -> System:
    found = Linear(project).as_dict().get(name)
    if found is None:
        raise NoAnswer(f"the project has no {name.replace('_', ' ')}", "{}")
    short = name.removeprefix("deployed_")
    return system_of(found, signals(project)[short], short, form, pade)


def rational(found: Factors, name: str, pade: int | None) -> Factors:
    """System without dead time: by a quotient, or by poles at z = 0 where it is sampled."""
    if not found.dead_time_s:
        return found
    if found.sample_time_s is not None:
        samples = round(found.dead_time_s / found.sample_time_s)
        poles = np.concatenate([found.poles, np.zeros(samples)])
        return Factors(found.gain, found.zeros, poles, 0.0, found.sample_time_s)
    if pade is None:
        raise ValueError(
            f"expected pade=n, the order of a quotient, because python-control carries no dead "
            f"time; found {found.dead_time_s:g} s in the {name}"
        )
    without = Factors(found.gain, found.zeros, found.poles)
    return product(without, pade_factors(found.dead_time_s, pade))


def system_of(
    found: Factors, signals: tuple[str, str], name: str, form: Form, pade: int | None
) -> System:
    """System of python-control in the form that is requested."""
    if form not in ("tf", "ss"):
        raise ValueError(f"expected form 'tf' or 'ss'; found {form!r}")
    kind = FactoredTransferFunction if form == "tf" else FactoredStateSpace
    return kind(rational(found, name, pade), inputs=[signals[0]], outputs=[signals[1]], name=name)


def signals(project: Project) -> dict[str, tuple[str, str]]:
    """Input and output of each transfer function, with the units of a rig."""
    tables = tomllib.loads(project.text)
    if "motor" in tables:
        volt, force, position = "_v", "torque_n_m", "load_angle_rad"
    elif "cylinder" in tables:
        volt, force, position = "_v", "force_n", "load_position_m"
    else:
        volt, force, position = "", "output", "load_motion"
    unit = {"torque_n_m": "_n_m", "force_n": "_n"}.get(force, "")
    return {
        "plant": (f"command{volt}", force),
        "load_position": (position, force),
        "controller": (f"error{unit}", f"command{volt}"),
        "prefilter": (f"reference{unit}", f"filtered_reference{unit}"),
        "sensor": (force, f"measured_{force}"),
    }
