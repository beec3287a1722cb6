"""Systems of python-control that keep their factors."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self, TypeAlias

import numpy as np

from phea._extras import imported
from phea._factors import Factors
from phea.control._closed import closed_loop
from phea.control._realization import realized

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Complexes: TypeAlias = NDArray[np.complex128]

control: Any = imported("control", "control")


def timebase(factors: Factors) -> float:
    """``dt`` of python-control: 0 for a system in s."""
    return factors.sample_time_s or 0.0


class FactoredTransferFunction(control.TransferFunction):  # type: ignore[misc]
    """Transfer function of python-control whose values are those of its factors.

    ``poles()``, ``zeros()``, ``dcgain()``, responses, products, quotients, powers and ``feedback``
    use the factors; a sum has none. ``num`` and ``den`` are there because python-control's other
    functions read them. Its time responses do: `to_ss` gives the state space that avoids them.

    Attributes
    ----------
    factors
        Gain, zeros and poles.

    Examples
    --------
    >>> from phea.linear import Factors
    >>> lag = FactoredTransferFunction(Factors(2.0, [], [-2.0]))
    >>> (lag * lag).poles().tolist(), lag.feedback(1).poles().tolist()
    ([(-2+0j), (-2+0j)], [(-4+0j)])
    """

    factors: Factors

    def __init__(self, factors: Factors, **names: Any) -> None:
        self.factors = factors
        numerator = factors.gain * np.atleast_1d(np.poly(factors.zeros)).real
        denominator = np.atleast_1d(np.poly(factors.poles)).real
        super().__init__(numerator, denominator, timebase(factors), **names)

    def to_ss(self) -> FactoredStateSpace:
        """The state space of the same factors, with the same names."""
        return FactoredStateSpace(self.factors, **_names(self))

    def horner(self, x: Any, warn_infinite: bool = True) -> Complexes:
        """Values at points s or z from the factors, with the shape (1, 1, points)."""
        return _values(self.factors, x)

    def poles(self) -> Complexes:
        """Poles, 1/s."""
        return self.factors.poles.copy()

    def zeros(self) -> Complexes:
        """Zeros, 1/s."""
        return self.factors.zeros.copy()

    def __neg__(self) -> Self:
        return type(self)(_scaled(self.factors, -1.0), **_names(self))

    def __mul__(self, other: Any) -> Any:
        if (number := _number(other)) is not None:
            return type(self)(_scaled(self.factors, number), **_names(self))
        if not isinstance(other, FactoredTransferFunction) or not _same_time(self, other):
            return super().__mul__(other)
        names = {"inputs": other.input_labels, "outputs": self.output_labels}
        return type(self)(product(self.factors, other.factors), **names)

    def __rmul__(self, other: Any) -> Any:
        return self * other if _number(other) is not None else super().__rmul__(other)

    def __truediv__(self, other: Any) -> Any:
        if (number := _number(other)) is not None:
            return type(self)(_scaled(self.factors, 1.0 / number), **_names(self))
        if not isinstance(other, FactoredTransferFunction) or not _same_time(self, other):
            return super().__truediv__(other)
        return type(self)(product(self.factors, inverse(other.factors)))

    def __rtruediv__(self, other: Any) -> Any:
        if (number := _number(other)) is None:
            return super().__rtruediv__(other)
        return type(self)(_scaled(inverse(self.factors), number))

    def __pow__(self, other: Any) -> Any:
        if type(other) is not int:
            return super().__pow__(other)
        once = self.factors if other > 0 else inverse(self.factors) if other < 0 else Factors(1.0)
        whole = Factors(1.0, (), (), 0.0, self.factors.sample_time_s)
        for _ in range(abs(other)):
            whole = product(whole, once)
        return type(self)(whole)

    def feedback(self, other: Any = 1, sign: float = -1) -> Any:
        """Closed loop ``self/(1 - sign self other)``; its poles are found from the factors."""
        if (number := _number(other)) is not None:
            back = Factors(number, (), (), 0.0, self.factors.sample_time_s)
        elif isinstance(other, FactoredTransferFunction) and _same_time(self, other):
            back = other.factors
        else:
            return super().feedback(other, sign)
        loop = _scaled(product(self.factors, back), -float(sign))
        zeros = np.concatenate([self.factors.zeros, back.poles])
        return type(self)(closed(loop, zeros, self.factors.gain), **_names(self))


class FactoredStateSpace(control.StateSpace):  # type: ignore[misc]
    """State space of python-control of sections in series, which keeps its factors.

    ``poles()``, ``zeros()``, ``dcgain()`` and frequency responses are those of the factors, time
    responses those of the sections; no polynomial is expanded. Connections are ordinary state
    spaces.

    Attributes
    ----------
    factors
        Gain, zeros and poles.

    Examples
    --------
    >>> import control, numpy
    >>> from phea.linear import Factors
    >>> lag = FactoredStateSpace(Factors(2.0, [], [-2.0]))
    >>> step = control.step_response(lag, [0.0, 0.5])
    >>> bool(abs(step.outputs[1] - (1 - numpy.exp(-1))) < 1e-15)
    True
    """

    factors: Factors

    def __init__(self, factors: Factors, **names: Any) -> None:
        self.factors = factors
        a, b, c, d = realized(factors)
        super().__init__(a, b, c, [[d]], timebase(factors), remove_useless_states=False, **names)

    def horner(self, x: Any, warn_infinite: bool = True) -> Complexes:
        """Values at points s or z from the factors, with the shape (1, 1, points)."""
        return _values(self.factors, x)

    def poles(self) -> Complexes:
        """Poles, 1/s."""
        return self.factors.poles.copy()

    def zeros(self) -> Complexes:
        """Zeros, 1/s."""
        return self.factors.zeros.copy()


def product(*systems: Factors) -> Factors:
    """Systems in series; dead times add, and a gain belongs to s and to z."""
    gain, dead_time_s = 1.0, 0.0
    sample_time_s = next((one.sample_time_s for one in systems if one.sample_time_s), None)
    for system in systems:
        gain, dead_time_s = gain * system.gain, dead_time_s + system.dead_time_s
    zeros = np.concatenate([system.zeros for system in systems])
    poles = np.concatenate([system.poles for system in systems])
    return Factors(gain, zeros, poles, dead_time_s, sample_time_s)


def inverse(system: Factors) -> Factors:
    """1/G of a system without dead time."""
    return Factors(1.0 / system.gain, system.poles, system.zeros, 0.0, system.sample_time_s)


def closed(loop: Factors, zeros: Complexes, gain: float) -> Factors:
    """gain prod(x - zeros) over the numerator of 1 + L."""
    leading, poles = closed_loop(loop)
    return Factors(gain / leading, zeros, poles, 0.0, loop.sample_time_s)


def _scaled(factors: Factors, by: float) -> Factors:
    roots = factors.zeros, factors.poles
    return Factors(factors.gain * by, *roots, factors.dead_time_s, factors.sample_time_s)


def _number(value: Any) -> float | None:
    if isinstance(value, int | float | np.integer | np.floating):
        return float(value)
    return None


def _same_time(one: FactoredTransferFunction, other: FactoredTransferFunction) -> bool:
    return bool(one.dt == other.dt)


def _names(system: Any) -> dict[str, Any]:
    return {"inputs": system.input_labels, "outputs": system.output_labels, "name": system.name}


def _values(factors: Factors, x: Any) -> Complexes:
    points = np.atleast_1d(np.asarray(x, dtype=np.complex128))
    if points.ndim > 1:
        raise ValueError("input list must be 1D")
    return factors.at(points).reshape(1, 1, -1)
