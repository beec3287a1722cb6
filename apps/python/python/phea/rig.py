"""Hydraulic stiffness over the stroke, and driving-point impedance, of a rig."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias, TypeVar

import numpy as np

from phea import _native
from phea._arrays import ArrayValue
from phea._factors import Factors

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from phea._project import Project

    Reals: TypeAlias = NDArray[np.float64]
    Complexes: TypeAlias = NDArray[np.complex128]
    Found = TypeVar("Found")

__all__ = ["Impedance", "Port", "Stiffness"]


class Stiffness(ArrayValue):
    """Hydraulic stiffness over the stroke; each attribute exists in the unit of the motion alone.

    Attributes
    ----------
    model
        Model of the stiffness: ``"by_volume"`` or ``"uniform"``.
    other
        The curves by the other model than the declared one; ``None`` in these.

    Examples
    --------
    >>> import phea
    >>> stiffness = phea.example("ybitu/hose").stiffness
    >>> stiffness.positions_m.shape, stiffness.nominal_n_per_m.shape, stiffness.nominal_n_m_per_rad
    ((121,), (121,), None)
    >>> bool((stiffness.nominal_n_per_m >= stiffness.least_n_per_m).all())
    True
    """

    __slots__ = (
        "model",
        "_turns",
        "_positions",
        "_nominal",
        "_minimum",
        "_maximum",
        "_least",
        "_greatest",
        "_operating_position",
        "other",
    )

    model: str
    other: Stiffness | None
    _turns: bool
    _positions: Reals
    _nominal: Reals
    _minimum: Reals
    _maximum: Reals
    _least: tuple[float, float] | None
    _greatest: tuple[float, float] | None
    _operating_position: float

    @staticmethod
    def of(project: Project) -> Stiffness | None:
        """Stiffness of the rig of a project; ``None`` without a rig."""
        found = _found(_native.stiffness, project)
        if found is None:
            return None
        turns, positions, declared, other, least, greatest, operating = found
        model, *curves = other
        by_other = Stiffness(model, turns, positions, *curves, None, None, operating, None)
        model, *curves = declared
        ends = (tuple(least), tuple(greatest))
        return Stiffness(model, turns, positions, *curves, *ends, operating, by_other)

    def _linear(self, value: Found) -> Found | None:
        return None if self._turns else value

    def _rotary(self, value: Found) -> Found | None:
        return value if self._turns else None

    @property
    def positions_m(self) -> Reals | None:
        """Positions of the piston over the stroke, m."""
        return self._linear(self._positions)

    @property
    def positions_rad(self) -> Reals | None:
        """Angles of the shaft over its range, rad; one for a motor that turns without end."""
        return self._rotary(self._positions)

    @property
    def nominal_n_per_m(self) -> Reals | None:
        """Stiffness at each position with the nominal dynamic stiffening of the lines, N/m."""
        return self._linear(self._nominal)

    @property
    def nominal_n_m_per_rad(self) -> Reals | None:
        """Stiffness at each angle with the nominal dynamic stiffening of the lines, N m/rad."""
        return self._rotary(self._nominal)

    @property
    def minimum_n_per_m(self) -> Reals | None:
        """Stiffness at each position with the least dynamic stiffening, N/m."""
        return self._linear(self._minimum)

    @property
    def minimum_n_m_per_rad(self) -> Reals | None:
        """Stiffness at each angle with the least dynamic stiffening, N m/rad."""
        return self._rotary(self._minimum)

    @property
    def maximum_n_per_m(self) -> Reals | None:
        """Stiffness at each position with the greatest dynamic stiffening, N/m."""
        return self._linear(self._maximum)

    @property
    def maximum_n_m_per_rad(self) -> Reals | None:
        """Stiffness at each angle with the greatest dynamic stiffening, N m/rad."""
        return self._rotary(self._maximum)

    @property
    def least_n_per_m(self) -> float | None:
        """Least nominal stiffness over the stroke, N/m; ``None`` by the other model."""
        return self._linear(self._least and self._least[0])

    @property
    def least_n_m_per_rad(self) -> float | None:
        """Least nominal stiffness, N m/rad; ``None`` by the other model."""
        return self._rotary(self._least and self._least[0])

    @property
    def least_at_m(self) -> float | None:
        """Position of the least stiffness, m."""
        return self._linear(self._least and self._least[1])

    @property
    def greatest_n_per_m(self) -> float | None:
        """Greatest nominal stiffness over the stroke, N/m; ``None`` by the other model."""
        return self._linear(self._greatest and self._greatest[0])

    @property
    def greatest_n_m_per_rad(self) -> float | None:
        """Greatest nominal stiffness, N m/rad; ``None`` by the other model."""
        return self._rotary(self._greatest and self._greatest[0])

    @property
    def greatest_at_m(self) -> float | None:
        """Position of the greatest stiffness, m."""
        return self._linear(self._greatest and self._greatest[1])

    @property
    def operating_position_m(self) -> float | None:
        """Position of the operating point, m."""
        return self._linear(self._operating_position)

    @property
    def operating_position_rad(self) -> float | None:
        """Angle of the operating point, rad."""
        return self._rotary(self._operating_position)

    def __repr__(self) -> str:
        return f"Stiffness({self.model}; {len(self._positions)} positions)"


class Port(ArrayValue):
    """Driving-point impedance of one loop, Z = -F/(s X).

    Attributes
    ----------
    factors
        The impedance as a transfer function.
    """

    __slots__ = ("factors", "_turns", "_response")

    factors: Factors
    _turns: bool
    _response: Complexes

    @property
    def response_n_s_per_m(self) -> Complexes | None:
        """Impedance at each frequency, N s/m; ``None`` for a rig with a motor."""
        return None if self._turns else self._response

    @property
    def response_n_m_s_per_rad(self) -> Complexes | None:
        """Impedance at each frequency, N m s/rad; ``None`` for a rig with a cylinder."""
        return self._response if self._turns else None

    def __repr__(self) -> str:
        return f"Port({len(self._response)} frequencies)"


class Impedance(ArrayValue):
    """Driving-point impedance of a rig over frequency.

    Attributes
    ----------
    frequencies_rad_per_s
        Frequencies of the responses, rad/s, which resolve each resonance.
    open_loop
        Impedance with the command at rest.
    closed_loop
        Impedance with the controller of the project; ``None`` without one, and without a closed
        form.

    Examples
    --------
    >>> import phea
    >>> impedance = phea.example("ybitu/hose").impedance
    >>> impedance.open_loop.response_n_s_per_m.shape == impedance.frequencies_rad_per_s.shape
    True
    """

    __slots__ = ("frequencies_rad_per_s", "open_loop", "closed_loop")

    frequencies_rad_per_s: Reals
    open_loop: Port
    closed_loop: Port | None

    @staticmethod
    def of(project: Project) -> Impedance | None:
        """Impedance of the rig of a project; ``None`` without a rig."""
        found = _found(_native.impedance, project)
        if found is None:
            return None
        turns, frequencies, open_loop, closed_loop = found
        ports = [
            None if one is None else Port(Factors(*one[0]), turns, one[1])
            for one in (open_loop, closed_loop)
        ]
        return Impedance(frequencies, *ports)

    def __repr__(self) -> str:
        loops = "open loop" if self.closed_loop is None else "open and closed loop"
        return f"Impedance({len(self.frequencies_rad_per_s)} frequencies; {loops})"


def _found(values: Callable[[_native.Project], Found], project: Project) -> Found:
    try:
        return values(project._native)
    except _native.Refused as refused:
        from phea._request import translated

        raise translated(refused) from None
