"""Transfer functions by their factors."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Complexes: TypeAlias = NDArray[np.complex128]


class Factors:
    """Transfer function by its factors, with dead time T.

    ::

        gain (x - z_1)(x - z_2).../((x - p_1)(x - p_2)...) e^(-s T)

    where x is s, or z where there is a sample time. The gain is the leading coefficient, not the
    gain at rest. Zeros and poles are never expanded into polynomials.

    Parameters
    ----------
    gain
        Leading coefficient.
    zeros, poles
        Roots, 1/s; complex ones with their conjugates.
    dead_time_s
        Dead time T, s.
    sample_time_s
        Sample time, s; ``None`` for a transfer function in s.

    Examples
    --------
    >>> lag = Factors(3.0, [], [-3.0])
    >>> lag(0.0), abs(lag.response([3.0])[0]).round(6)
    ((1+0j), np.float64(0.707107))
    """

    __slots__ = ("dead_time_s", "gain", "poles", "sample_time_s", "zeros")

    gain: float
    zeros: Complexes
    poles: Complexes
    dead_time_s: float
    sample_time_s: float | None

    def __init__(
        self,
        gain: float,
        zeros: ArrayLike | Iterable[complex] = (),
        poles: ArrayLike | Iterable[complex] = (),
        dead_time_s: float = 0.0,
        sample_time_s: float | None = None,
    ) -> None:
        values = {"gain": float(gain), "zeros": _roots(zeros), "poles": _roots(poles)}
        values |= {"dead_time_s": float(dead_time_s)}
        values |= {"sample_time_s": None if sample_time_s is None else float(sample_time_s)}
        for name, value in values.items():
            object.__setattr__(self, name, value)

    def __call__(self, x: complex) -> complex:
        """Value at a point s, or z where there is a sample time."""
        return complex(self.at(np.array([x], dtype=np.complex128))[0])

    def at(self, x: Complexes) -> Complexes:
        """Values at points s, or z where there is a sample time; infinite at a pole."""
        value = np.full(x.shape, self.gain, dtype=np.complex128)
        with np.errstate(divide="ignore", invalid="ignore"):
            for index in range(max(len(self.zeros), len(self.poles))):
                if index < len(self.zeros):
                    value = value * (x - self.zeros[index])
                if index < len(self.poles):
                    value = value / (x - self.poles[index])
            if self.dead_time_s and self.sample_time_s is None:
                value = value * np.exp(-x * self.dead_time_s)
            elif self.dead_time_s and self.sample_time_s is not None:
                value = value / x ** round(self.dead_time_s / self.sample_time_s)
        # conjugate factors leave rounding in the imaginary part on the real axis
        return np.where(x.imag == 0.0, value.real, value)

    def response(self, frequencies_rad_per_s: ArrayLike) -> Complexes:
        """Frequency response, dead time included.

        Parameters
        ----------
        frequencies_rad_per_s
            Frequencies, rad/s.

        Returns
        -------
        ndarray
            Complex responses, one for each frequency.
        """
        frequencies = np.atleast_1d(np.asarray(frequencies_rad_per_s, dtype=np.float64))
        points: Complexes = 1j * frequencies.astype(np.complex128)
        if self.sample_time_s is not None:
            points = np.exp(points * self.sample_time_s)
        found = self.at(points)
        found.setflags(write=False)
        return found

    def _state(self) -> tuple[Any, ...]:
        roots = tuple(self.zeros.tolist()), tuple(self.poles.tolist())
        return (self.gain, *roots, self.dead_time_s, self.sample_time_s)

    def __eq__(self, other: object) -> bool:
        return self._state() == other._state() if isinstance(other, Factors) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._state())

    def __reduce__(self) -> tuple[Any, ...]:
        return (Factors, self._state())

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a transfer function cannot be changed: {name}")

    def __repr__(self) -> str:
        roots = f"zeros={_shown(self.zeros)}, poles={_shown(self.poles)}"
        dead = f", dead_time_s={self.dead_time_s!r}" if self.dead_time_s else ""
        sampled = "" if self.sample_time_s is None else f", sample_time_s={self.sample_time_s!r}"
        return f"Factors({self.gain!r}, {roots}{dead}{sampled})"


def _roots(given: ArrayLike | Iterable[complex]) -> Complexes:
    values = given if isinstance(given, np.ndarray) else list(given)  # type: ignore[arg-type]
    roots = np.array(values, dtype=np.complex128).reshape(-1)
    roots.setflags(write=False)
    return roots


def _shown(roots: Complexes) -> str:
    return "[" + ", ".join(f"{root.real if not root.imag else root:.6g}" for root in roots) + "]"
