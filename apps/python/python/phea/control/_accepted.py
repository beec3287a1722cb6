"""Systems of other packages as polynomials or factors."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from phea._extras import imported
from phea._factors import Factors
from phea.control._closed import paired

# Attributes in which other packages keep a dead time.
_DELAYS = (
    "dead_time",
    "delay",
    "input_delay",
    "output_delay",
    "InputDelay",
    "OutputDelay",
    "iodelay",
)


class Accepted(NamedTuple):
    """One input and one output: polynomials, highest power first, or factors.

    ``dt`` is 0 for a system in s, ``True`` for samples of an unstated time, otherwise that time, s.
    """

    polynomials: tuple[list[float], list[float]] | None
    factors: Factors | None
    dt: float | bool

    @property
    def dead_time_s(self) -> float:
        """Dead time, s."""
        return self.factors.dead_time_s if self.factors else 0.0


def accepted(system: Any) -> Accepted:
    """A transfer function, state space or zeros, poles and gain of any package.

    Raises
    ------
    TypeError
        For an object that is none of them.
    ValueError
        For several inputs or outputs, dead time, or numbers that are not real and finite.
    """
    system = getattr(system, "factors", system)
    if isinstance(system, Factors):
        _not_zero(system.gain)
        return Accepted(None, system, system.sample_time_s or 0.0)
    if isinstance(system, bool) or not isinstance(system, int | float | np.number):
        _one_channel(system)
    for name in _DELAYS:
        if np.any(_value(getattr(system, name, 0.0))):
            raise ValueError(
                f"expected a system without dead time; found {name} = {getattr(system, name)!r}: "
                "for a plant, state it as dead_time_s"
            )
    dt = getattr(system, "dt", None)
    if dt is not None and (not isinstance(dt, bool | int | float | np.number) or dt < 0):
        raise ValueError(f"expected a sample time in s, 0, True or None as dt; found {dt!r}")
    dt = dt if isinstance(dt, bool) else float(dt or 0.0)
    if isinstance(system, int | float | np.number) and not isinstance(system, bool):
        _not_zero(float(system))
        return Accepted(([float(system)], [1.0]), None, dt)
    if all(hasattr(system, name) for name in ("poles", "zeros", "gain")):
        zeros, poles = (paired(_numbers(system, name)) for name in ("zeros", "poles"))
        gain = float(_reals("gain", _numbers(system, "gain"))[0])
        _not_zero(gain)
        return Accepted(None, Factors(gain, zeros, poles), dt)
    if all(hasattr(system, name) for name in ("num", "den")):
        numerator, denominator = (_polynomial(system, name) for name in ("num", "den"))
        return Accepted((numerator, denominator), None, dt)
    if all(hasattr(system, name) for name in "ABCD"):
        return Accepted(None, of_matrices(*(_numbers_of(system, name) for name in "ABCD")), dt)
    raise TypeError(
        "expected a TransferFunction, a StateSpace, or an object with poles, zeros and gain, with "
        f"num and den, or with A, B, C and D; found {type(system).__name__}"
    )


def of_matrices(a: Any, b: Any, c: Any, d: Any) -> Factors:
    """Poles, zeros and gain of x' = A x + B u, y = C x + D u.

    The zeros are found in two ways, of which a full matrix favours one and a sparse one the other;
    those whose response is nearer to that of the matrices count.
    """
    a, b, c = np.atleast_2d(a), np.reshape(b, (-1, 1)), np.reshape(c, (1, -1))
    direct, order = float(np.reshape(d, -1)[0]), len(b)
    if not order:
        _not_zero(direct)
        return Factors(direct)
    a, b, c = _balanced(a, b, c)
    poles = paired(np.linalg.eigvals(a).astype(np.complex128))
    # off both axes, where no pole is likely
    points = np.exp(1.2j) * np.unique([size for size in np.abs(poles) if size > 0.0] or [1.0])
    shifted = (point * np.eye(order) - a for point in points)
    responses = np.array([(c @ np.linalg.solve(one, b)).item() + direct for one in shifted])
    best, least = Factors(1.0), np.inf
    for zeros in (_zeros_of_pencil(a, b, c, direct), _zeros_within(a, b, c, direct)):
        unscaled = Factors(1.0, zeros, poles).at(points)
        place = int(np.argmax(np.abs(responses)))
        gain = direct or float((responses[place] / unscaled[place]).real)
        misfit = float(np.sum(np.abs(gain * unscaled / responses - 1.0)))
        if misfit < least:
            best, least = Factors(gain, zeros, poles), misfit
    return best


def _zeros_of_pencil(a: Any, b: Any, c: Any, direct: float) -> Any:
    """Generalized eigenvalues of [A B; C D] - s [1 0; 0 0]; the largest ones are infinite."""
    count = len(b) - (0 if direct else len(_derivatives(a, b, c)))
    pencil = np.block([[a, b], [c, np.array([[direct]])]])
    shift = np.diag([1.0] * len(b) + [0.0])
    linalg = imported("scipy.linalg", "control")
    over, under = linalg.eigvals(pencil, shift, homogeneous_eigvals=True)
    chosen = np.argsort(-np.abs(under) / (np.abs(over) + np.abs(under)))[:count]
    return paired((over[chosen] / under[chosen]).astype(np.complex128))


def _zeros_within(a: Any, b: Any, c: Any, direct: float) -> Any:
    """Eigenvalues of A - B C A^r/m where y and its first r - 1 derivatives vanish."""
    if direct:
        return paired(np.linalg.eigvals(a - b @ c / direct).astype(np.complex128))
    rows = _derivatives(a, b, c)
    within = np.linalg.svd(np.vstack(rows))[2][len(rows) :].T
    last = rows[-1] / (rows[-1] @ b)
    zeros = np.linalg.eigvals(within.T @ (a - b @ (last @ a)) @ within)
    return paired(zeros.astype(np.complex128))


def _derivatives(a: Any, b: Any, c: Any) -> list[Any]:
    """C, C A, ... C A^(r-1) to the first m = C A^(r-1) B other than rounding, each scaled to 1."""
    rows, rounding = [], 8.0 * len(b) * np.finfo(np.float64).eps
    for _ in range(len(b)):
        rows.append(c / (np.linalg.norm(c) or 1.0))
        if abs((c @ b).item()) > rounding * (np.abs(c) @ np.abs(b)).item():
            return rows
        c = c @ a
    raise ValueError("expected a system whose output depends on its input; found zero")


def _balanced(a: Any, b: Any, c: Any) -> tuple[Any, Any, Any]:
    """The same system with states scaled by powers of 2, which is exact."""
    order = len(a)
    whole = np.block([[a, b], [c, np.zeros((1, 1))]])
    linalg = imported("scipy.linalg", "control")
    _, (scale, _) = linalg.matrix_balance(whole, permute=False, separate=True)
    scale = scale[:order] / scale[order]
    return a * scale[None, :] / scale[:, None], b / scale[:, None], c * scale[None, :]


def _one_channel(system: Any) -> None:
    counts = []
    for names in (("ninputs", "inputs"), ("noutputs", "outputs")):
        found = (getattr(system, name, None) for name in names)
        counts.append(next((one for one in found if isinstance(one, int)), 1))
    if counts != [1, 1]:
        raise ValueError(
            f"expected one input and one output; found {counts[0]} inputs and {counts[1]} outputs"
        )


def _value(member: Any) -> Any:
    return member() if callable(member) else member


def _numbers(system: Any, name: str) -> Any:
    return np.atleast_1d(np.asarray(_value(getattr(system, name)), dtype=np.complex128)).reshape(-1)


def _numbers_of(system: Any, name: str) -> Any:
    matrix = np.asarray(getattr(system, name))
    sides = {"B": (1, "inputs"), "C": (0, "outputs")}
    if name in sides and matrix.ndim == 2 and matrix.size:
        side, what = sides[name]
        if matrix.shape[side] != 1:
            raise ValueError(
                f"expected one input and one output; found {matrix.shape[side]} {what}"
            )
    return _reals(name, matrix)


def _polynomial(system: Any, name: str) -> list[float]:
    given = _value(getattr(system, name))
    while (
        isinstance(given, list | tuple)
        and given
        and isinstance(given[0], list | tuple | np.ndarray)
    ):
        if len(given) != 1:
            raise ValueError(
                f"expected one input and one output; found {len(given)} rows in {name}"
            )
        given = given[0]
    values = np.asarray(given)
    if values.ndim > 1 and values.size != max(values.shape):
        raise ValueError(f"expected one input and one output; found {name} of shape {values.shape}")
    coefficients: list[float] = np.trim_zeros(_reals(name, values.reshape(-1)), "f").tolist()
    if not coefficients:
        raise ValueError(f"expected a {name} that is not zero; found zero")
    return coefficients


def _reals(name: str, values: Any) -> Any:
    numbers = np.asarray(values, dtype=np.complex128)
    if not np.all(np.isfinite(numbers)) or np.any(numbers.imag):
        raise ValueError(f"expected real finite numbers in {name}; found {values!r}")
    return numbers.real.astype(np.float64)


def _not_zero(gain: float) -> None:
    if gain == 0.0 or not np.isfinite(gain):
        raise ValueError(f"expected a finite gain other than zero; found {gain!r}")
