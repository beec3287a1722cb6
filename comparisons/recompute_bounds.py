"""Recomputes the QFT bounds with which the tests of qft compare phea, by scanning the gain of the nominal loop.

Independent of phea: closed loops of every plant on a dense grid of gains in dB, and bisection where the verdict changes. No quadratic, no
geometry. Two examples:

A  k/((s + a)(s + b)) on forty edge plants, |T|, |S| and |P S| limited;
B  k a/(s (s + a)), k and a from 1 to 10 in steps of 0.5, tracking judged by its spread.

    python comparisons/recompute_bounds.py
"""

import numpy as np

GAINS_DB = np.arange(-60.0, 90.0, 0.01) + 0.00137
PHASES_DEG = [0, -30, -60, -90, -120, -150, -180]


def family_a():
    a, k = np.linspace(1, 5, 10), np.linspace(1, 10, 10)
    plants = [(10, x, 20) for x in a] + [(1, x, 30) for x in a] + [(x, 5, 30) for x in k] + [(x, 1, 20) for x in k]
    return np.array([(1, 5, 30)] + plants, dtype=float)


def response_a(plants, w):
    k, a, b = plants.T
    return k / ((1j * w + a) * (1j * w + b))


def family_b(n=19):
    k, a = np.meshgrid(np.linspace(1, 10, n), np.linspace(1, 10, n))
    return np.array([k.ravel(), a.ravel()]).T


def response_b(plants, w):
    k, a = plants.T
    return k * a / (1j * w * (1j * w + a))


def excess_a(plants, nominal, w, loop0):
    """Worst of closed loop over limit, dB, for an array of nominal loops."""
    loop = loop0[:, None] * (plants / nominal)[None, :]
    s = 1j * w
    worst = np.abs(loop / (1 + loop)) / 1.2
    if w <= 10:
        limit = 0.02 * abs(s**3 + 64 * s**2 + 748 * s + 2400) / abs(s**2 + 14.4 * s + 169)
        worst = np.maximum(worst, np.abs(1 / (1 + loop)) / limit)
    if w <= 50:
        worst = np.maximum(worst, np.abs(plants[None, :] / (1 + loop)) / 0.01)
    return 20 * np.log10(worst.max(1))


def excess_spread(plants, nominal, w, loop0):
    loop = loop0[:, None] * (plants / nominal)[None, :]
    s = 1j * w
    upper = abs(0.6584 * (s + 30) / (s**2 + 4 * s + 19.752))
    lower = abs(120 / (s**3 + 17 * s**2 + 82 * s + 120))
    magnitude = np.abs(loop / (1 + loop))
    return 20 * np.log10(magnitude.max(1) / magnitude.min(1) / (upper / lower))


def forbidden(excess, plants, nominal, w, phase_deg):
    """Forbidden intervals of |L0| in dB; an end at the edge of the scan is reported as that edge."""
    turn = np.exp(1j * np.deg2rad(phase_deg))
    at = lambda gain_db: excess(plants, nominal, w, 10 ** (np.atleast_1d(gain_db) / 20) * turn)
    bad = np.concatenate([at(part) > 0 for part in np.array_split(GAINS_DB, 30)])
    ends = []
    for index in np.flatnonzero(bad[1:] != bad[:-1]):
        low, high = GAINS_DB[index], GAINS_DB[index + 1]
        for _ in range(30):
            middle = (low + high) / 2
            low, high = (middle, high) if (at(middle)[0] > 0) == bad[index] else (low, middle)
        ends.append((low + high) / 2)
    if bad[0]:
        ends.insert(0, -np.inf)
    if bad[-1]:
        ends.append(np.inf)
    return list(zip(ends[::2], ends[1::2]))


def show(name, w, phases_deg, intervals):
    print(f"{name} {w:>5} rad/s")
    for phase, found in zip(phases_deg, intervals):
        print(f"    {phase:>5}", "  ".join(f"({low:.4f}, {high:.4f})" for low, high in found) or "-")


def check(found, expected):
    assert abs(found - expected) < 0.006, (found, expected)


def example_a():
    family = family_a()
    allowed_above = {
        0.1: [8.03, 8.36, 9.28, 10.57, 11.85, 14.01, 15.56],
        5: [1.39, 1.94, 3.49, 5.71, 11.55, 14.01, 15.56],
        10: [-12.93, -12.22, -11.23, -2.53, 11.78, 14.50, 15.56],
    }
    closed = {-120: (-19.03, 8.90), -150: (-24.65, 14.52), -180: (-25.42, 15.56)}
    for w in [0.1, 5, 10, 100]:
        plants = response_a(family, w)
        found = [forbidden(excess_a, plants, plants[0], w, phase) for phase in PHASES_DEG]
        show("A", w, PHASES_DEG, found)
        for phase, intervals, index in zip(PHASES_DEG, found, range(7)):
            if w in allowed_above:
                check(intervals[-1][1], allowed_above[w][index])
            elif phase in closed:
                assert len(intervals) == 1
                check(intervals[0][0], closed[phase][0])
                check(intervals[0][1], closed[phase][1])
            else:
                assert not intervals


def example_b():
    phases = [-30, -60, -90, -120, -150, -180]
    allowed_above = {
        0.1: [56.47, 52.61, 37.82, 51.45, 56.14, 57.34],
        1: [16.13, 13.78, 11.72, 14.05, 17.38, 18.62],
        10: [-7.11, -8.17, -9.52, -9.60, -7.37, 3.38],
    }
    family = family_b()
    for w in [0.1, 1, 10]:
        plants = response_b(family, w)
        found = [forbidden(excess_spread, plants, plants[0], w, phase) for phase in phases]
        show("B tracking", w, phases, found)
        for intervals, expected in zip(found, allowed_above[w]):
            check(intervals[-1][1], expected)


if __name__ == "__main__":
    example_a()
    example_b()
