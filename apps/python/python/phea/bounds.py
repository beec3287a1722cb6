"""Templates of the plants, and bounds of the nominal loop, at the design frequencies."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from phea import _native
from phea._arrays import ArrayValue

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from phea._project import Project

    Reals: TypeAlias = NDArray[np.float64]
    Complexes: TypeAlias = NDArray[np.complex128]

__all__ = ["Bound", "Bounds", "FrequencyBounds", "Template", "Templates"]


class Template(ArrayValue):
    """Template at one design frequency: the rows of ``templates.csv`` at this frequency.

    Attributes
    ----------
    frequency_rad_per_s
        Frequency, rad/s.
    values
        Parameters of each plant, SI, plants x parameters: the members of the family, then the
        plants that were found on the outline of the template.
    responses
        Response P H of each plant, with the delay and the hold of the loop.
    """

    __slots__ = ("frequency_rad_per_s", "values", "responses")

    frequency_rad_per_s: float
    values: Reals
    responses: Complexes

    def __len__(self) -> int:
        return len(self.responses)

    def __repr__(self) -> str:
        return f"Template({self.frequency_rad_per_s:.6g} rad/s; {len(self)} plants)"


class Templates(ArrayValue):
    """Responses of the uncertain plant at the design frequencies.

    Attributes
    ----------
    parameters
        Names of the parameters; empty for measured plants.
    frequencies_rad_per_s
        Design frequencies, rad/s, increasing.
    values
        Parameters of the members, SI, members x parameters; the nominal plant is the first.
    responses
        Response P H of each member, with the delay and the hold of the loop, members x
        frequencies.
    nominal_loop
        Nominal loop L0 at each frequency; ``None`` without a controller.
    templates
        Every plant of each template, members and outline.

    Examples
    --------
    >>> import phea
    >>> templates = phea.example("qft/servo").templates
    >>> templates.responses.shape == (49, len(templates.frequencies_rad_per_s))
    True
    """

    __slots__ = (
        "parameters",
        "frequencies_rad_per_s",
        "values",
        "responses",
        "nominal_loop",
        "templates",
    )

    parameters: tuple[str, ...]
    frequencies_rad_per_s: Reals
    values: Reals
    responses: Complexes
    nominal_loop: Complexes | None
    templates: tuple[Template, ...]

    @staticmethod
    def of(project: Project) -> Templates:
        """Templates of a project."""
        parameters, members, found = _found(project)
        templates = tuple(Template(*one[:3]) for one in found)
        responses = [template.responses[:members] for template in templates]
        loops = [one[3] for one in found]
        return Templates(
            tuple(parameters),
            np.array([one.frequency_rad_per_s for one in templates], dtype=np.float64),
            templates[0].values[:members].copy() if templates else np.zeros((members, 0)),
            np.array(responses, dtype=np.complex128).reshape(len(templates), members).T.copy(),
            None if None in loops else np.array(loops, dtype=np.complex128),
            templates,
        )

    def __len__(self) -> int:
        return len(self.templates)

    def __iter__(self) -> Iterator[Template]:
        return iter(self.templates)

    def __getitem__(self, index: int) -> Template:
        return self.templates[index]

    def __repr__(self) -> str:
        members, frequencies = self.responses.shape
        return f"Templates({members} members, {frequencies} frequencies)"


class Bound(ArrayValue):
    """Forbidden gains of the nominal loop over its phase, at one frequency.

    Each row is an interval of gains at a phase, as in ``bounds.csv``; a phase at which several
    intervals are forbidden has several rows, one at which every gain is allowed has none.

    Attributes
    ----------
    specification
        Number of the specification in the project, from 1; ``None`` for a limit that is not
        declared there, and for all specifications together.
    kind
        Kind of the specification, such as ``"tracking"``; ``None`` for all of them together.
    phases_deg
        Phases at which the bound is known, degrees, increasing from -360 to 0.
    phase_deg
        Phase of each row, degrees.
    forbidden_from_gain
        Lower end of each interval, as |L0|; 0 if every smaller gain is forbidden.
    forbidden_to_gain
        Upper end of each interval, as |L0|; infinite if every larger gain is forbidden.
    """

    __slots__ = (
        "specification",
        "kind",
        "phases_deg",
        "phase_deg",
        "forbidden_from_gain",
        "forbidden_to_gain",
    )

    specification: int | None
    kind: str | None
    phases_deg: Reals
    phase_deg: Reals
    forbidden_from_gain: Reals
    forbidden_to_gain: Reals

    @property
    def forbidden_from_db(self) -> Reals:
        """Lower end of each interval, dB; minus infinity if every smaller gain is forbidden."""
        return _decibels(self.forbidden_from_gain)

    @property
    def forbidden_to_db(self) -> Reals:
        """Upper end of each interval, dB; infinite if every larger gain is forbidden."""
        return _decibels(self.forbidden_to_gain)

    def __len__(self) -> int:
        return len(self.phase_deg)

    def __repr__(self) -> str:
        kind = "" if self.kind is None else f"{self.specification or ''} {self.kind}; ".lstrip()
        return f"Bound({kind}{len(self)} intervals at {len(self.phases_deg)} phases)"


class FrequencyBounds(ArrayValue):
    """Bounds at one design frequency.

    Attributes
    ----------
    frequency_rad_per_s
        Frequency, rad/s.
    specifications
        Bound of each specification that has one at this frequency.
    together
        Gains that any specification forbids.
    """

    __slots__ = ("frequency_rad_per_s", "specifications", "together")

    frequency_rad_per_s: float
    specifications: tuple[Bound, ...]
    together: Bound

    def __repr__(self) -> str:
        count = len(self.specifications)
        return f"FrequencyBounds({self.frequency_rad_per_s:.6g} rad/s; {count} specifications)"


class Bounds(ArrayValue):
    """Bounds of the nominal loop in the Nichols plane, by design frequency.

    Attributes
    ----------
    frequencies_rad_per_s
        Design frequencies, rad/s, increasing.
    bounds
        Bounds at each of them.

    Examples
    --------
    >>> import phea
    >>> bounds = phea.example("qft/servo").bounds
    >>> first = bounds[0].specifications[0]
    >>> first.specification, bool((first.forbidden_from_gain < first.forbidden_to_gain).all())
    (1, True)
    """

    __slots__ = ("frequencies_rad_per_s", "bounds")

    frequencies_rad_per_s: Reals
    bounds: tuple[FrequencyBounds, ...]

    @staticmethod
    def of(project: Project) -> Bounds:
        """Bounds of a project."""
        _, _, found = _found(project)
        bounds = tuple(
            FrequencyBounds(
                one[0],
                tuple(Bound(number, kind, *gains) for number, kind, gains in one[4]),
                Bound(None, None, *one[5]),
            )
            for one in found
        )
        return Bounds(np.array([one[0] for one in found], dtype=np.float64), bounds)

    def __len__(self) -> int:
        return len(self.bounds)

    def __iter__(self) -> Iterator[FrequencyBounds]:
        return iter(self.bounds)

    def __getitem__(self, index: int) -> FrequencyBounds:
        return self.bounds[index]

    def __repr__(self) -> str:
        return f"Bounds({len(self)} frequencies)"


def _found(project: Project) -> tuple[list[str], int, list[Any]]:
    """Parameters, number of members, and values at each design frequency."""
    try:
        return _native.templates_and_bounds(project._native)
    except _native.Refused as refused:
        from phea._request import translated

        raise translated(refused) from None


def _decibels(gains: Reals) -> Reals:
    with np.errstate(divide="ignore"):
        decibels: Reals = 20.0 * np.log10(gains)
    decibels.setflags(write=False)
    return decibels
