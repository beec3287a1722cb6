"""State space of a transfer function as sections in series, without its polynomials."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from phea._factors import Factors

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Reals: TypeAlias = NDArray[np.float64]


class Matrices(NamedTuple):
    """x' = A x + B u, y = C x + D u."""

    a: Reals
    b: Reals
    c: Reals
    d: float


def realized(factors: Factors) -> Matrices:
    """Sections of first and second order in series, the last one first.

    A is then upper triangular by blocks whose eigenvalues are the poles, multiple ones included.
    Each section is scaled to a response of about 1 where it is largest.
    """
    if len(factors.zeros) > len(factors.poles):
        raise ValueError(
            "expected at most as many zeros as poles, because a state space has no derivative of "
            f"its input; found {len(factors.zeros)} zeros and {len(factors.poles)} poles"
        )
    groups = _pole_groups(factors)
    gain = factors.gain
    whole = Matrices(np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), 1.0)
    for poles, zeros in _with_zeros(groups, factors.zeros):
        scale = 1.0 if factors.sample_time_s is not None else _scale(poles, zeros)
        gain /= scale
        whole = _after(whole, _section(poles, zeros, scale))
    return Matrices(whole.a, whole.b, whole.c * gain, whole.d * gain)


def _scale(poles: list[complex], zeros: list[complex]) -> float:
    """Scale of a section whose response is about 1 where it is largest."""
    sizes = [abs(pole) or 1.0 for pole in poles]
    points = [0.0, *sizes, *([1e3 * max(sizes)] if len(zeros) == len(poles) else [])]
    values = [
        np.prod([point + abs(zero) for zero in zeros])
        / np.prod([max(point, size) for size in sizes])
        for point in points
    ]
    return float(1.0 / max(values))


def _after(first: Matrices, second: Matrices) -> Matrices:
    corner = np.zeros((len(first.a), len(second.a)))
    a = np.block([[second.a, second.b @ first.c], [corner, first.a]])
    b = np.vstack([second.b * first.d, first.b])
    return Matrices(a, b, np.hstack([second.c, second.d * first.c]), second.d * first.d)


def _section(poles: list[complex], zeros: list[complex], scale: float) -> Matrices:
    """scale prod(s - z)/prod(s - p) of one pole, or of two that are real or conjugates."""
    if len(poles) == 1:
        pole, size = poles[0].real, abs(poles[0].real) or 1.0
        residue = pole - zeros[0].real if zeros else 1.0
        a, b = np.array([[pole]]), np.array([[size]])
        return Matrices(a, b, np.array([[scale * residue / size]]), scale * float(bool(zeros)))
    # x = s - p_1 for real poles, x = s - Re p for conjugates; the denominator is x^2 + e_1 x + e_0
    conjugate = poles[0].imag != 0.0
    origin = poles[0].real
    size = max(abs(pole) for pole in poles) or 1.0
    ends = (0.0, poles[0].imag ** 2) if conjugate else (origin - poles[1].real, 0.0)
    numerator = [0.0, 0.0, 0.0]
    if len(zeros) == 2:
        total = sum(zeros).real
        product = ((origin - zeros[0]) * (origin - zeros[1])).real
        numerator = [product - ends[1], 2.0 * origin - total - ends[0], 1.0]
    elif len(zeros) == 1:
        numerator = [origin - zeros[0].real, 1.0, 0.0]
    else:
        numerator = [1.0, 0.0, 0.0]
    lower = -ends[1] / size if conjugate else 0.0
    a = np.array([[origin, size], [lower, origin if conjugate else poles[1].real]])
    b = np.array([[0.0], [size]])
    c = np.array([[scale * numerator[0] / size**2, scale * numerator[1] / size]])
    return Matrices(a, b, c, scale * numerator[2])


def _pole_groups(factors: Factors) -> list[list[complex]]:
    """Conjugate pairs, and real poles: as many in pairs as pairs of zeros need."""
    pairs = [[pole, pole.conjugate()] for pole in factors.poles.tolist() if pole.imag > 0.0]
    reals = sorted((pole for pole in factors.poles.tolist() if pole.imag == 0.0), key=abs)
    missing = sum(zero.imag > 0.0 for zero in factors.zeros.tolist()) - len(pairs)
    for _ in range(max(missing, 0)):
        pairs.append([reals.pop(0), reals.pop(0)])
    return sorted([*pairs, *([pole] for pole in reals)], key=lambda group: abs(group[0]))


def _with_zeros(
    groups: list[list[complex]], zeros: NDArray[np.complex128]
) -> list[tuple[list[complex], list[complex]]]:
    """Zeros in the sections whose poles are nearest to them; pairs choose first."""
    sections: list[tuple[list[complex], list[complex]]] = [(group, []) for group in groups]
    pairs = [[zero, zero.conjugate()] for zero in zeros.tolist() if zero.imag > 0.0]
    reals = [[zero] for zero in zeros.tolist() if zero.imag == 0.0]
    for chosen in [*pairs, *reals]:
        room = [one for one in sections if len(one[0]) - len(one[1]) >= len(chosen)]
        nearest = min(room, key=lambda one: min(abs(pole - chosen[0]) for pole in one[0]))
        nearest[1].extend(chosen)
    return sections
