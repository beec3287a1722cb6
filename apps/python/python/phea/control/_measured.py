"""Families of measured plants from frequency responses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from phea._texts import toml
from phea.control._accepted import accepted
from phea.control._projects import PLANTS, made, text_of_plant
from phea.control._systems import control
from phea.control._text import removed, replaced

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from phea._project import Project


def measured_family(
    project: Project | None,
    responses: Sequence[Any] | Mapping[str, Any],
    frequencies_rad_per_s: ArrayLike | None = None,
    *,
    unstable_poles: int = 0,
    integrators: int | None = None,
    title: str = "Measured plants",
) -> Project:
    """Project of these frequency responses, the first of which is the nominal plant.

    Parameters
    ----------
    project
        Project of a ``[plant]`` or of measured plants, whose specifications and controller remain;
        ``None`` for a new project.
    responses
        A `control.FrequencyResponseData` for each plant, a pair of frequencies (rad/s) and complex
        responses, or a system with `frequencies_rad_per_s`; a mapping gives their names.
    frequencies_rad_per_s
        Frequencies of systems, positive and increasing, rad/s.
    unstable_poles, integrators
        As in ``[family]``.
    title
        Title of a new project.

    Returns
    -------
    Project
        The new project; ``files`` has a table for each response.

    Examples
    --------
    >>> import numpy
    >>> from phea.linear import Family
    >>> frequencies = numpy.array([1.0, 2.0, 5.0])
    >>> lag = measured_family(None, {"lag": (frequencies, 1 / (1 + 1j * frequencies))})
    >>> Family(lag).measured[0].responses.round(3).tolist()
    [(0.5-0.5j), (0.2-0.4j), (0.038-0.192j)]
    """
    named = responses if isinstance(responses, Mapping) else _named(responses)
    if not named:
        raise ValueError("expected at least one response; found none")
    files = {}
    for name, response in named.items():
        if not name or any(one in name for one in '/\\\n"'):
            raise ValueError(f"expected a name that can be that of a file; found {name!r}")
        files[f"measured/{name}.csv"] = _table(name, *_points(response, frequencies_rad_per_s))
    lines = [("measured", toml(list(files)))]
    lines += [("unstable_poles", str(unstable_poles))] if unstable_poles else []
    lines += [] if integrators is None else [("integrators", str(integrators))]
    text = replaced(removed(text_of_plant(project, title), PLANTS), "family", [], lines)
    return made(project, text, PLANTS, files)


def _named(responses: Sequence[Any]) -> dict[str, Any]:
    width = len(str(len(responses)))
    return {f"plant_{number:0{width}}": one for number, one in enumerate(responses, 1)}


def _points(response: Any, frequencies: ArrayLike | None) -> tuple[Any, Any]:
    if isinstance(response, control.FrequencyResponseData):
        if response.frdata.shape[:2] != (1, 1):
            shape = response.frdata.shape
            raise ValueError(
                f"expected one input and one output; found {shape[1]} inputs and {shape[0]} outputs"
            )
        if response.dt not in (None, 0):
            raise ValueError(f"expected responses of a plant in s; found dt = {response.dt!r}")
        return response.omega, response.frdata[0, 0]
    if isinstance(response, tuple) and len(response) == 2:
        return response
    if frequencies is None:
        raise ValueError("expected frequencies_rad_per_s for the response of a system; found none")
    found = accepted(response)
    if found.dt:
        raise ValueError(f"expected a plant in s; found one in z, with dt = {found.dt!r}")
    points = np.atleast_1d(np.asarray(frequencies, dtype=np.float64))
    if found.factors is not None:
        return points, found.factors.response(points)
    upper, lower = (np.polyval(part, 1j * points) for part in found.polynomials or ([1.0], [1.0]))
    return points, upper / lower


def _table(name: str, frequencies: ArrayLike, responses: ArrayLike) -> bytes:
    points = np.atleast_1d(np.asarray(frequencies, dtype=np.float64))
    values = np.atleast_1d(np.asarray(responses, dtype=np.complex128))
    if points.shape != values.shape or points.ndim != 1:
        shapes = f"{points.shape} and {values.shape}"
        raise ValueError(f"expected as many responses as frequencies for {name!r}; found {shapes}")
    if not (np.all(np.diff(points) > 0.0) and np.all(points > 0.0) and np.all(np.isfinite(points))):
        raise ValueError(f"expected positive and increasing frequencies for {name!r}; found others")
    if not np.all(np.isfinite(values)):
        raise ValueError(f"expected finite responses for {name!r}; found others")
    rows = zip(points.tolist(), values.real.tolist(), values.imag.tolist(), strict=True)
    lines = [",".join(map(repr, row)) for row in rows]
    return ("\n".join(["frequency_rad_per_s,real,imaginary", *lines]) + "\n").encode()
