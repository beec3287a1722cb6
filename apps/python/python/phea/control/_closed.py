"""Roots of a closed loop from the factors of its open one, without polynomials."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from phea._factors import Factors
from phea.control._realization import realized

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Complexes: TypeAlias = NDArray[np.complex128]

_STEPS = 60


def paired(roots: Complexes) -> Complexes:
    """Roots of a real polynomial as exact conjugate pairs and exact reals.

    Roots whose imaginary part is rounding are real; every other root is the mean of itself and of
    the conjugate of its nearest partner.
    """
    for tolerance in (0.0, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6):
        found = _paired(roots, tolerance)
        if found is not None:
            return found
    raise ValueError("expected roots in conjugate pairs; found " + ", ".join(map(str, roots)))


def _paired(roots: Complexes, tolerance: float) -> Complexes | None:
    real = np.abs(roots.imag) <= tolerance * np.abs(roots)
    upper, lower = (
        roots[~real & (roots.imag > 0)].tolist(),
        roots[~real & (roots.imag < 0)].tolist(),
    )
    found = [complex(root.real) for root in roots[real].tolist()]
    for root in upper:
        partner = min(lower, key=lambda one: abs(one.conjugate() - root), default=0.0)
        if abs(partner.conjugate() - root) > max(tolerance, 1e-12) * abs(root):
            return None
        lower.remove(partner)
        mean = (root + partner.conjugate()) / 2
        found += [mean, mean.conjugate()]
    return None if lower else np.array(sorted(found, key=abs), dtype=np.complex128)


def closed_loop(loop: Factors) -> tuple[float, Complexes]:
    """Leading coefficient and roots of prod(x - p) + k prod(x - z), of 1 + L."""
    common, zeros, poles = _without_common(loop)
    more_zeros, equal = len(zeros) > len(poles), len(zeros) == len(poles)
    leading = loop.gain if more_zeros else 1.0 + loop.gain * equal
    if loop.gain == 0.0:
        return 1.0, loop.poles
    if leading == 0.0:
        raise ValueError("expected a loop that is not -1 at infinite frequency")
    # 1 + 1/L has the same roots, and a state space where L has none
    first = (
        Factors(1.0 / loop.gain, poles, zeros) if more_zeros else Factors(loop.gain, zeros, poles)
    )
    a, b, c, d = realized(first)
    roots = np.linalg.eigvals(a - b @ c / (1.0 + d)).astype(np.complex128)
    roots = _refined(roots, Factors(loop.gain, zeros, poles))
    return leading, np.concatenate([paired(roots), np.array(common, dtype=np.complex128)])


def _without_common(loop: Factors) -> tuple[list[complex], list[complex], list[complex]]:
    common, zeros, poles = [], [], loop.poles.tolist()
    for zero in loop.zeros.tolist():
        if zero in poles:
            poles.remove(zero)
            common.append(zero)
        else:
            zeros.append(zero)
    return common, zeros, poles


def _refined(roots: Complexes, loop: Factors) -> Complexes:
    """Roots of 1 + L after steps of Aberth and Ehrlich, each kept if it reduces abs(1 + L)."""
    roots = roots.copy()
    with np.errstate(all="ignore"):
        residual = np.abs(1.0 + loop.at(roots))
        for _ in range(_STEPS):
            value = loop.at(roots)
            slope = _sums(roots, loop.poles) + value * _sums(roots, loop.zeros)
            newton = (1.0 + value) / slope
            apart = roots[:, None] - roots[None, :]
            np.fill_diagonal(apart, np.inf)
            moved = roots - newton / (1.0 - newton * np.sum(1.0 / apart, axis=1))
            found = np.abs(1.0 + loop.at(moved))
            better = np.isfinite(moved) & (found < residual)
            if not better.any():
                break
            roots[better], residual[better] = moved[better], found[better]
    return roots


def _sums(points: Complexes, roots: Complexes) -> Complexes:
    found: Complexes = np.sum(1.0 / (points[:, None] - roots[None, :]), axis=1)
    return found
