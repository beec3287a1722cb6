"""Example D by differential evolution, as a careful user of NumPy would design it: the peer that phea's search is timed against.

    OMP_NUM_THREADS=1 python benches/peers/design.py real|complex [SEED]

P = k a/(s (s + a)) with k and a from 1 to 10; |L/(1 + L)| <= 1.2 at every frequency and upper/lower of the tracking spread up to 15 rad/s;
G = g (s + z)/((s + p1)(s + p2)) or g (s + z)/(s^2 + 2 d w s + w^2) of the least g. Constraints on 81 plants, 60 frequencies for the
spread and 120 for |T|; every plant stable by Routh's table. Prints the processor time in seconds, the least gain in dB, and the numbers of
the controller.
"""

import sys
import time

import numpy as np

POPULATION, GENERATIONS, PENALTY_DB = 60, 300, 50.0
K, A = (axis.ravel()[:, None] for axis in np.meshgrid(np.geomspace(1, 10, 9), np.geomspace(1, 10, 9)))
SLOW = np.geomspace(0.1, 15, 60)
FAST = np.geomspace(0.5, 2e4, 120)


def plants(w):
    return K * A / (1j * w * (1j * w + A))


def allowed_spread(w):
    s = 1j * w
    upper = 0.6584 * (s + 30) / (s**2 + 4 * s + 19.752)
    lower = 120 / (s**3 + 17 * s**2 + 82 * s + 120)
    return 20 * np.log10(np.abs(upper / lower))


P_SLOW, P_FAST, ALLOWED_DB = plants(SLOW), plants(FAST), allowed_spread(SLOW)
LIMIT_DB = 20 * np.log10(1.2)


def numbers(x, kind):
    """Gain, zero, and s^2 + b s + c of the poles from the logarithms of the search."""
    gain, zero, first, second = np.exp(x)
    return (gain, zero, first + second, first * second) if kind == "real" else (gain, zero, 2 * second * first, first**2)


def stable(gain, zero, b, c):
    """Routh's table of s^4 + (a + b) s^3 + (a b + c) s^2 + (a c + g k a) s + g k a z for every plant."""
    third, second, first, last = A + b, A * b + c, A * c + gain * K * A, gain * K * A * zero
    left = third * second - first
    return np.all(left > 0) and np.all(left * first > third**2 * last)


def violation_db(gain, zero, b, c):
    """By how much the worst constraint is violated."""

    def complementary_db(plant, w):
        s = 1j * w
        loop = plant * (gain * (s + zero) / (s**2 + b * s + c))
        return 20 * np.log10(np.abs(loop / (1 + loop)))

    slow = complementary_db(P_SLOW, SLOW)
    spread = slow.max(axis=0) - slow.min(axis=0) - ALLOWED_DB
    return max(spread.max(), complementary_db(P_FAST, FAST).max() - LIMIT_DB, slow.max() - LIMIT_DB)


def cost(x, kind):
    found = numbers(x, kind)
    gain_db = 20 * np.log10(found[0])
    if not stable(*found):
        return gain_db + 1e4
    return gain_db + PENALTY_DB * max(0.0, violation_db(*found))


def evolve(kind, seed):
    """rand/1/bin with a dithered weight; a bound that is passed is met halfway."""
    rng = np.random.default_rng(seed)
    last = (200.0, 4000.0) if kind == "real" else (0.3, 2.0)
    low, high = np.log([(1e5, 1e9), (0.5, 50.0), (200.0, 4000.0), last]).T
    population = rng.uniform(low, high, (POPULATION, 4))
    costs = np.array([cost(x, kind) for x in population])
    for _ in range(GENERATIONS):
        for index in range(POPULATION):
            a, b, c = population[rng.choice(POPULATION, 3, replace=False)]
            mutant = a + rng.uniform(0.5, 0.9) * (b - c)
            mutant = np.where(mutant < low, (a + low) / 2, np.where(mutant > high, (a + high) / 2, mutant))
            taken = rng.random(4) < 0.9
            taken[rng.integers(4)] = True
            trial = np.where(taken, mutant, population[index])
            value = cost(trial, kind)
            if value <= costs[index]:
                population[index], costs[index] = trial, value
        if np.ptp(costs) < 1e-3:
            break
    best = population[costs.argmin()]
    return numbers(best, kind)


def main():
    kind, seed = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 1
    start = time.process_time()
    gain, zero, b, c = evolve(kind, seed)
    print(time.process_time() - start)
    print(repr(float(20 * np.log10(gain))))
    print(*(repr(float(value)) for value in (gain, zero, b, c)))
    print(f"worst violation {violation_db(gain, zero, b, c):.2e} dB", file=sys.stderr)


if __name__ == "__main__":
    main()
