"""Linear models of a project as plain values: transfer functions by their factors, and families."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from phea import _native
from phea._factors import Factors

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from phea._project import Project

    Reals: TypeAlias = NDArray[np.float64]
    Complexes: TypeAlias = NDArray[np.complex128]

MemberChoice: TypeAlias = int | Mapping[str, float]

__all__ = ["Factors", "Family", "Linear", "Measured"]


class Linear:
    """Transfer functions of a project; ``None`` for one that it does not have.

    Attributes
    ----------
    plant
        From the command to the force of a rig with lumped lines, V to N.
    load_position
        From the position of the load to that force, m to N.
    controller, prefilter
        As declared: in s, or in z where they are written in z.
    sensor
        From the controlled output to the input of the controller.
    deployed_controller, deployed_prefilter
        As the computer of the controller runs them.

    Examples
    --------
    >>> import phea
    >>> linear = Linear(phea.example("ybitu/hose"))
    >>> len(linear.plant.poles), linear.controller.gain
    (5, 0.001)
    """

    __slots__ = ("_functions", "_project")

    def __init__(self, project: Project) -> None:
        self._project = project
        try:
            found = _native.transfer_functions(project._native)
        except _native.Refused as refused:
            from phea._request import translated

            raise translated(refused) from None
        self._functions = {name: Factors(*factors) for name, factors in found.items()}

    @property
    def plant(self) -> Factors | None:
        """From the command to the force of a rig, V to N."""
        return self._functions.get("plant")

    @property
    def load_position(self) -> Factors | None:
        """From the position of the load to the force of a rig, m to N."""
        return self._functions.get("load_position")

    @property
    def controller(self) -> Factors | None:
        """From the error to the command, as declared."""
        return self._functions.get("controller")

    @property
    def prefilter(self) -> Factors | None:
        """From the reference to the filtered reference, as declared."""
        return self._functions.get("prefilter")

    @property
    def sensor(self) -> Factors:
        """From the controlled output to the input of the controller; 1 where none is declared."""
        return self._functions.get("sensor", Factors(1.0))

    @property
    def deployed_controller(self) -> Factors | None:
        """The controller as its computer runs it: in z where it is sampled."""
        return self._functions.get("deployed_controller")

    @property
    def deployed_prefilter(self) -> Factors | None:
        """The prefilter as its computer runs it: in z where it is sampled."""
        return self._functions.get("deployed_prefilter")

    def as_dict(self) -> dict[str, Factors]:
        """The transfer functions that exist, by name."""
        return dict(self._functions)

    def __eq__(self, other: object) -> bool:
        return self._functions == other._functions if isinstance(other, Linear) else NotImplemented

    def __hash__(self) -> int:
        return hash(tuple(self._functions.items()))

    def __reduce__(self) -> tuple[Any, ...]:
        return (Linear, (self._project,))

    def __repr__(self) -> str:
        return f"Linear({', '.join(self._functions)})"


class Measured(NamedTuple):
    """Measured plant: its name, frequencies in rad/s, and its complex responses there."""

    name: str
    frequencies_rad_per_s: Complexes | Reals
    responses: Complexes


class Family:
    """Plants of a project: the nominal one first.

    A member is chosen by its index, or by its parameters; parameters that are not named have their
    nominal values.

    Examples
    --------
    >>> import phea
    >>> family = Family(phea.example("qft/servo"))
    >>> family.parameters, family.values.shape, family.member({"k": 2}).gain
    (('k', 'a'), (49, 2), 2.0)
    """

    __slots__ = ("_native", "_project", "parameters", "values")

    parameters: tuple[str, ...]
    values: Reals

    def __init__(self, project: Project) -> None:
        self._project = project
        try:
            self._native = _native.Family(project._native)
        except _native.Refused as refused:
            from phea._request import translated

            raise translated(refused) from None
        self.parameters = tuple(self._native.parameters)
        self.values = self._native.members
        self.values.setflags(write=False)

    def values_of(self, member: MemberChoice = 0) -> list[float]:
        """Values of the parameters of a member, SI, in the order of `parameters`."""
        if isinstance(member, Mapping):
            unknown = [name for name in member if name not in self.parameters]
            if unknown:
                raise ValueError(
                    f"the parameters of the family are {', '.join(self.parameters) or 'none'}, "
                    f"not {', '.join(map(repr, unknown))}"
                )
            nominal = dict(zip(self.parameters, self.values[0].tolist(), strict=True))
            return list((nominal | {name: float(value) for name, value in member.items()}).values())
        if isinstance(member, bool) or not hasattr(member, "__index__"):
            raise TypeError(f"a member is an index or a mapping of parameters, not {member!r}")
        count = len(self.values)
        if not -count <= member < count:
            raise IndexError(f"the family has {count} members, from 0 to {count - 1}, not {member}")
        row: list[float] = self.values[member].tolist()
        return row

    def member(self, member: MemberChoice = 0) -> Factors | None:
        """Plant by its factors; ``None`` for one without polynomials, such as lines with waves."""
        found = self._native.member(self.values_of(member))
        return None if found is None else Factors(*found)

    def response(self, frequencies_rad_per_s: ArrayLike, member: MemberChoice = 0) -> Complexes:
        """Frequency response of a member, dead time included; of lines with waves too.

        Parameters
        ----------
        frequencies_rad_per_s
            Frequencies, rad/s.
        member
            Index, or values by the names of parameters.

        Returns
        -------
        ndarray
            Complex responses, one for each frequency.
        """
        if self.measured:
            raise ValueError("measured plants are known at their own frequencies: see `measured`")
        frequencies = np.atleast_1d(np.asarray(frequencies_rad_per_s, dtype=np.float64))
        found: Complexes = self._native.response(self.values_of(member), frequencies.tolist())
        found.setflags(write=False)
        return found

    @property
    def measured(self) -> tuple[Measured, ...]:
        """The measured plants; empty for any other family."""
        plants = []
        for plant in map(Measured._make, self._native.measured()):
            plant.frequencies_rad_per_s.setflags(write=False)
            plant.responses.setflags(write=False)
            plants.append(plant)
        return tuple(plants)

    def __len__(self) -> int:
        return len(self.values)

    def __iter__(self) -> Iterator[Factors | None]:
        return (self.member(index) for index in range(len(self)))

    def __eq__(self, other: object) -> bool:
        return self._project == other._project if isinstance(other, Family) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._project)

    def __reduce__(self) -> tuple[Any, ...]:
        return (Family, (self._project,))

    def __repr__(self) -> str:
        return f"Family({', '.join(self.parameters) or 'measured'}; {len(self)} members)"
