"""Frequency responses and simulated runs of a project as data of python-control."""

from __future__ import annotations

from pathlib import PurePath
from typing import TYPE_CHECKING, Any

import numpy as np

from phea.control._models import signals
from phea.control._systems import control
from phea.linear import Family, MemberChoice

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from phea._project import Project
    from phea._record import Answer


def frequency_response(
    project: Project,
    frequencies_rad_per_s: ArrayLike | None = None,
    member: MemberChoice | None = None,
) -> Any:
    """Response of a plant of the family, dead time and lines with waves included.

    Parameters
    ----------
    project
        Project with a family.
    frequencies_rad_per_s
        Frequencies, rad/s; absent: those of a measured plant, which is not known at others.
    member
        As for `plant`; the index of a measured plant.

    Returns
    -------
    control.FrequencyResponseData
        One input and one output.

    Examples
    --------
    >>> import phea
    >>> lag = frequency_response(phea.example("qft/dead_time"), [1.0, 10.0])
    >>> from phea.control import plant
    >>> bool(abs(lag(10j) - plant(phea.example("qft/dead_time"), pade=9)(10j)) < 1e-9)
    True
    """
    family = Family(project)
    name = "plant"
    if family.measured:
        if frequencies_rad_per_s is not None:
            raise ValueError(
                "expected no frequencies, because measured plants have theirs; found some"
            )
        path, frequencies, found = family.measured[_index(member)]
        name = PurePath(path).stem.replace(".", "_")
    elif frequencies_rad_per_s is None:
        raise ValueError("expected frequencies of a plant that is not measured; found none")
    else:
        frequencies = np.sort(np.atleast_1d(np.asarray(frequencies_rad_per_s, dtype=np.float64)))
        found = family.response(frequencies, 0 if member is None else member)
    inputs, outputs = signals(project)["plant"]
    named = {"inputs": inputs, "outputs": outputs, "name": name}
    return control.FrequencyResponseData(found, frequencies, 0.0, **named)


def time_response(
    answer: Answer,
    scenario: str | None = None,
    *,
    inputs: tuple[str, ...] | None = None,
    outputs: tuple[str, ...] | None = None,
) -> Any:
    """A simulated scenario as `TimeResponseData`, from which ``.plot()`` works.

    Parameters
    ----------
    answer
        Answer of `Project.simulate`.
    scenario
        Name of its table; absent if there is only one.
    inputs, outputs
        Names of columns; absent: the reference as input, force and command as outputs.

    Returns
    -------
    control.TimeResponseData
        Signals with the names of the columns.

    Examples
    --------
    >>> import phea
    >>> run = phea.example("simulation/benchmark").simulate(figures=False)
    >>> time_response(run, list(run.tables)[0]).output_labels
    ['force_n', 'command_v']
    """
    tables = {name: table for name, table in answer.tables.items() if "time_s" in table}
    if scenario is None and len(tables) == 1:
        scenario = next(iter(tables))
    if scenario not in tables:
        raise ValueError(f"expected a table of {', '.join(map(repr, tables))}; found {scenario!r}")
    table = tables[scenario]
    kinds = ("force_n", "torque_n_m"), ("reference_n", "reference_n_m")
    force, reference = ([name for name in kind if name in table] for kind in kinds)
    outputs = outputs or (*force, *(name for name in ("command_v",) if name in table))
    inputs = tuple(reference) if inputs is None else inputs
    for name in (*inputs, *outputs):
        if name not in table:
            raise ValueError(f"expected columns of {', '.join(table)}; found {name!r}")
    return control.TimeResponseData(
        table["time_s"],
        np.array([table[name] for name in outputs]),
        inputs=np.array([table[name] for name in inputs]) if inputs else None,
        output_labels=list(outputs),
        input_labels=list(inputs) if inputs else None,
        issiso=False,
        title=scenario,
        sysname=scenario,
        plot_inputs=False,
    )


def _index(member: MemberChoice | None) -> int:
    if member is None:
        return 0
    if not isinstance(member, int):
        raise ValueError(f"expected the index of a measured plant; found {member!r}")
    return member
