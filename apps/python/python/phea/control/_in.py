"""Laws and plants of a project from systems of python-control, SciPy and others."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from phea._factors import Factors
from phea._texts import toml
from phea.control._accepted import Accepted, accepted
from phea.control._projects import PLANTS, made, text_of_plant
from phea.control._text import removed, replaced
from phea.errors import ProjectError
from phea.linear import Linear

if TYPE_CHECKING:
    from phea._project import Project

_LAW = ["numerator", "denominator", "gain", "zeros", "poles", "domain", "elements"]
_PLANT = ["numerator", "denominator", "gain", "zeros", "poles", "delay"]


def with_controller(project: Project, system: Any) -> Project:
    """Project with this system as its ``[controller]``.

    Other keys of the table, such as ``sample_time``, ``delay`` and ``saturation``, remain, and so
    do all other tables and comments; polynomials are written as polynomials, zeros and poles as
    such, a state space by its poles, zeros and gain.

    Parameters
    ----------
    project
        Any project.
    system
        `control.TransferFunction` or `StateSpace`, SciPy's ``lti`` or ``dlti``, `Factors`, a
        number, or an object with ``poles``, ``zeros`` and ``gain``, with ``num`` and ``den``, or
        with ``A`` to ``D``. In z, its ``dt`` must be ``controller.sample_time``, which it becomes
        in a project without a controller; ``dt=True`` means the time of the project.

    Returns
    -------
    Project
        The new project; its ``text`` can be saved.

    Raises
    ------
    ValueError
        For several inputs or outputs, another sample time, or dead time.

    Examples
    --------
    >>> import control, phea
    >>> from phea.linear import Linear
    >>> servo = with_controller(phea.example("qft/servo"), control.tf([2, 3], [1, 0]))
    >>> 'numerator = "2.0*s + 3.0"' in servo.text, Linear(servo).controller
    (True, Factors(2.0, zeros=[-1.5], poles=[0]))
    """
    return _with_law(project, "controller", _LAW, accepted(system))


def with_prefilter(project: Project, system: Any) -> Project:
    """Project with this system as its ``[prefilter]``; as for `with_controller`.

    Examples
    --------
    >>> import phea
    >>> from phea.linear import Factors, Linear
    >>> Linear(with_prefilter(phea.example("qft/servo"), Factors(2.0, [], [-2.0]))).prefilter
    Factors(2.0, zeros=[], poles=[-2])
    """
    return _with_law(project, "prefilter", [*_LAW, "sample_time"], accepted(system))


def with_plant(
    project: Project | None,
    system: Any,
    *,
    dead_time_s: float | None = None,
    title: str = "Plant from a linear system",
) -> Project:
    """Project with this system as its ``[plant]``, instead of its plant and its family.

    Parameters
    ----------
    project
        Project of a ``[plant]`` or of measured plants, whose specifications and controller remain;
        ``None`` for a new project.
    system
        As for `with_controller`, in s.
    dead_time_s
        Dead time, s; absent: that of `Factors`, otherwise none.
    title
        Title of a new project.

    Returns
    -------
    Project
        The new project; its ``text`` can be saved.

    Raises
    ------
    ValueError
        For a sampled system, several inputs or outputs, or the project of a rig.

    Examples
    --------
    >>> import scipy.signal
    >>> from phea.linear import Family
    >>> Family(with_plant(None, scipy.signal.lti([], [-1, -2], 3.0), dead_time_s=0.1)).member()
    Factors(3.0, zeros=[], poles=[-1, -2], dead_time_s=0.1)
    """
    found = accepted(system)
    if found.dt:
        raise ValueError(f"expected a plant in s; found one in z, with dt = {found.dt!r}")
    seconds = found.dead_time_s if dead_time_s is None else float(dead_time_s)
    if not (np.isfinite(seconds) and seconds >= 0.0):
        raise ValueError(f"expected a dead time of at least 0 s; found {dead_time_s!r}")
    lines = [*_law_lines(found), *([("delay", repr(seconds))] if seconds else [])]
    text = text_of_plant(project, title)
    text = replaced(
        removed(text, [name for name in PLANTS if name != "plant"]), "plant", _PLANT, lines
    )
    return made(project, text, PLANTS, {})


def _with_law(project: Project, table: str, keys: list[str], found: Accepted) -> Project:
    if found.dead_time_s:
        raise ValueError(
            f"expected a {table} without dead time; found {found.dead_time_s:g} s: the dead time "
            "of the loop is controller.delay"
        )
    lines, text = _law_lines(found), project.text
    if found.dt:
        seconds = _checked_sample_time(project, table, found.dt)
        own = [("sample_time", repr(seconds))]
        if table == "prefilter":
            lines += own
        if not _states_a_controller(project):
            text = replaced(text, "controller", [], own)
    replaced_paths = [f"{table}.{key}" for key in keys]
    return made(project, replaced(text, table, keys, lines), replaced_paths, {})


def _checked_sample_time(project: Project, table: str, dt: float | bool) -> float:
    """Sample time of the project, which must be that of the system, s."""
    if not _states_a_controller(project):
        if dt is True:
            raise ValueError(
                "expected a sample time, because the project has none; found dt = True"
            )
        return float(dt)
    # a law in z has the sample time of its project, whatever the unit and the place of that
    probe = [("gain", "1.0"), ("poles", "[0.5]"), ("domain", '"z"')]
    paths = [f"controller.{key}" for key in _LAW]
    try:
        text = replaced(project.text, "controller", _LAW, probe)
        sampled = Linear(made(project, text, paths, {})).controller
    except ProjectError as error:
        if "sample_time" not in str(error):
            raise
        sampled = None
    seconds = None if sampled is None else sampled.sample_time_s
    if seconds is None:
        raise ValueError(
            f"expected a {table} in s, because the controller of the project is continuous; "
            f"found one in z, with dt = {dt!r}"
        )
    if dt is not True and abs(seconds - dt) > 1e-12 * seconds:
        raise ValueError(f"expected dt = {seconds!r}, the sample time of the project; found {dt!r}")
    return seconds


def _states_a_controller(project: Project) -> bool:
    stated = any(one.lstrip().startswith("controller") for one in project.settings)
    return stated or "controller" in tomllib.loads(project.text)


def _law_lines(found: Accepted) -> list[tuple[str, str]]:
    factors = found.factors or Factors(1.0)
    if found.polynomials is not None:
        upper, lower = found.polynomials
        if len(upper) > 1 or len(lower) > 1:
            texts = (_polynomial(part, "z" if found.dt else "s") for part in found.polynomials)
            return list(zip(("numerator", "denominator"), map(toml, texts), strict=True))
        # a ratio of numbers names neither s nor z
        factors = Factors(upper[0] / lower[0])
    lines = [("gain", repr(factors.gain)), ("zeros", _roots(factors.zeros.tolist()))]
    lines.append(("poles", _roots(factors.poles.tolist())))
    return [*lines, ("domain", '"z"')] if found.dt else lines


def _polynomial(coefficients: Sequence[float], variable: str) -> str:
    degree, text = len(coefficients) - 1, ""
    for index, value in enumerate(coefficients):
        if value == 0.0:
            continue
        power = degree - index
        factor = f"*{variable}^{power}" if power > 1 else f"*{variable}" if power else ""
        sign = ("-" if value < 0.0 else "") if not text else (" - " if value < 0.0 else " + ")
        text += f"{sign}{abs(value)!r}{factor}"
    return text


def _roots(roots: Sequence[complex]) -> str:
    one = [
        repr(root.real) if not root.imag else f"[{root.real!r}, {root.imag!r}]" for root in roots
    ]
    return f"[{', '.join(one)}]"
