"""Recomputes the numbers with which the tests of the specifications compare phea, and states them.

Independent of phea: responses by the matrix exponential (SciPy) of a companion form, exact limits by a root finder on overshoot and
settling time together, margins by brute force on the circle itself. Fails where a stated number differs from the result.

    python comparisons/recompute_specifications.py
"""

import sys

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq, minimize_scalar

FAILURES = []


def expect(what, value, stated, tolerance):
    fine = abs(value - stated) <= tolerance
    print(f"{'ok  ' if fine else 'FAIL'} {what}: {value:.12g} (stated {stated:.12g})")
    if not fine:
        FAILURES.append(what)


class Step:
    """Unit step response of a strictly proper function."""

    def __init__(self, numerator, denominator):
        denominator = np.asarray(denominator, float)
        order = len(denominator) - 1
        numerator = np.concatenate([np.zeros(order - len(numerator)), numerator]) / denominator[0]
        companion = np.zeros((order + 1, order + 1))
        companion[:order, :order] = np.vstack([-denominator[1:] / denominator[0], np.eye(order - 1, order)])
        companion[0, order] = 1.0
        # balance: state k is an integral k times, so it is worth corner^k
        corner = abs(np.prod(np.roots(denominator))) ** (1 / order)
        weights = np.append(corner ** -np.arange(order - 1, -1, -1.0)[::-1], 1.0)
        self.matrix = companion * weights[None, :] / weights[:, None]
        self.output = np.append(numerator, 0.0) * weights

    def __call__(self, time):
        return float(self.output @ expm(self.matrix * time)[:, -1])

    def metrics(self, band, end, points=4000):
        """Overshoot in percent and settling time, refined on the response itself."""
        step = end / points
        once = expm(self.matrix * step)
        state, values = np.eye(len(once))[:, -1], []
        for _ in range(points + 1):
            values.append(self.output @ state)
            state = once @ state
        values, times = np.array(values), step * np.arange(points + 1)
        peak = int(np.argmax(values))
        overshoot = 0.0
        if 0 < peak < points and values[peak] > 1:
            bounds = (times[peak - 1], times[peak + 1])
            found = minimize_scalar(lambda t: -self(t), bounds=bounds, method="bounded", options={"xatol": 1e-8})
            overshoot = 100 * max(0.0, -found.fun - 1)
        outside = np.nonzero(np.abs(values - 1) > band * (1 + 1e-7))[0][-1]
        side = 1 + band * np.sign(values[outside] - 1)
        settling = brentq(lambda t: self(t) - side, times[outside], times[outside + 1], xtol=1e-14, rtol=1e-14)
        return overshoot, settling


def upper(natural, damping, zero):
    numerator = [natural**2] if zero is None else [natural**2 / zero, natural**2]
    return Step(numerator, [1, 2 * damping * natural, natural**2])


def lower(natural, pole):
    denominator = [1, 2 * natural, natural**2]
    return Step([natural**2], denominator) if pole is None else Step(
        [natural**2 * pole], np.polymul(denominator, [1, pole])
    )


def exact_upper(overshoot, settling, band, zero_of):
    """Damping ratio and natural frequency by nested root finding on the simulated response."""

    def damping_at(natural):
        def excess(damping):
            return upper(natural, damping, zero_of(natural)).metrics(band, 20 / natural, 500)[0] - overshoot

        return brentq(excess, 0.6, 0.99, xtol=1e-11)

    def late(natural):
        response = upper(natural, damping_at(natural), zero_of(natural))
        return response.metrics(band, 20 / natural, 500)[1] - settling

    natural = brentq(late, 25, 60, xtol=1e-8)
    return damping_at(natural), natural


def printed_limits():
    overshoot, settling = upper(46, 0.8, 75).metrics(0.01, 1)
    expect("6.28 overshoot, percent", overshoot, 2.194563521, 5e-9)
    expect("6.28 settling time, s", settling, 0.126368769, 5e-9)
    overshoot, settling = upper(46, 0.8, None).metrics(0.01, 1)
    expect("6.28 without its zero, overshoot", overshoot, 1.516461986, 5e-9)
    expect("6.28 without its zero, settling time", settling, 0.138114725, 5e-9)
    overshoot, settling = lower(20, 50).metrics(0.01, 2)
    expect("6.29 overshoot, percent", overshoot, 0, 1e-9)
    expect("6.29 settling time, s", settling, 0.356268974, 5e-9)
    expect("6.29 without its pole, settling time", lower(20, None).metrics(0.01, 2)[1], 0.331917603, 5e-9)


def exact_limits():
    for name, zero_of, damping, natural in [
        ("no zero", lambda natural: None, 0.826085055, 41.9161150),
        ("zero at 75", lambda natural: 75.0, 0.837470485, 36.1277855),
        ("zero at 1.5 w_n", lambda natural: 1.5 * natural, 0.852504940, 33.4499794),
    ]:
        found = exact_upper(1.0, 0.1, 0.01, zero_of)
        expect(f"upper, {name}: damping ratio", found[0], damping, 2e-9)
        expect(f"upper, {name}: natural frequency", found[1], natural, 1e-6)
    found = exact_upper(5.0, 0.1, 0.02, lambda natural: 75.0)
    expect("upper 5 %, 2 %: damping ratio", found[0], 0.739041262, 2e-9)
    expect("upper 5 %, 2 %: natural frequency", found[1], 52.2683398, 1e-6)
    for name, pole_of, natural in [
        ("no pole", lambda natural: None, 22.1278402),
        ("pole at 50", lambda natural: 50.0, 24.1901582),
        ("pole at 2.5 w_n", lambda natural: 2.5 * natural, 23.7512649),
    ]:
        found = brentq(lambda w: lower(w, pole_of(w))(0.3) - 0.99, 5, 200, xtol=1e-11)
        expect(f"lower, {name}: natural frequency", found, natural, 1e-6)


def decibels(limit, frequencies):
    numerator, denominator = limit
    s = 1j * np.asarray(frequencies)
    return 20 * np.log10(np.abs(np.polyval(numerator, s) / np.polyval(denominator, s)))


def spreads():
    """Upper over lower limit by scanning, the printed pair first."""
    zero, pole = [1 / 75, 1.0], [1 / 50, 1.0]
    high, low = ([2116.0], [1, 73.6, 2116.0]), ([400.0], [1, 40.0, 400.0])
    printed = (np.polymul(high[0], zero), high[1]), (low[0], np.polymul(low[1], pole))
    for frequency, stated in [(1.0, 0.02304629), (10.0, 2.06218249), (50.0, 16.9603930), (150.0, 31.3526350)]:
        found = decibels(printed[0], frequency) - decibels(printed[1], frequency)
        expect(f"6.28 over 6.29 at {frequency:g} rad/s, dB", found, stated, 1e-7)
    # a slow upper limit that rings against a lower one that is too fast
    slow, fast = ([100.0], [1, 8.0, 100.0]), ([900.0], [1, 60.0, 900.0])
    grid = np.linspace(5, 500, 100_001)
    spread = decibels(slow, grid) - decibels(fast, grid)
    crossing = brentq(lambda w: decibels(slow, w) - decibels(fast, w), 5, 40, xtol=1e-13)
    expect("slow over fast: meet at, rad/s", crossing, 12.65701387, 1e-8)
    expect("slow over fast: worst, dB", spread[-1], -19.05127463, 1e-8)
    expect("slow over fast: worst at, rad/s", grid[spread.argmin()], 500, 0)


def margins_of_one_point_three():
    """The circle |L/(1+L)| = 1.3 met on the negative axis and on the unit circle."""
    ratio = brentq(lambda x: x / (1 - x) - 1.3, 0.1, 0.9)
    expect("|T| <= 1.3: gain margin, dB", -20 * np.log10(ratio), 4.95568967, 1e-8)
    phase = brentq(lambda angle: abs(1 / (1 - np.exp(-1j * angle))) - 1.3, 0.1, 3)
    expect("|T| <= 1.3: phase margin, deg", np.degrees(phase), 45.2397299, 1e-7)


def main():
    printed_limits()
    exact_limits()
    spreads()
    margins_of_one_point_three()
    if FAILURES:
        sys.exit(f"{len(FAILURES)} stated numbers are not so: {', '.join(FAILURES)}")


if __name__ == "__main__":
    main()
