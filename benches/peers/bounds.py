"""QFT bounds of P = k a/(s (s + a)), k and a in 1..10, as a careful user of NumPy would compute them.

    OMP_NUM_THREADS=1 python benches/peers/bounds.py margin SIDE PHASES     |L/(1 + L)| <= 1.2 at six frequencies
    OMP_NUM_THREADS=1 python benches/peers/bounds.py tracking SIDE PHASES   max|T|/min|T| <= upper/lower at four frequencies

SIDE values of k times SIDE of a, equally spaced; PHASES equally spaced from 0 to -360 degrees, both ends included. Prints the processor
time in seconds, then for every frequency and phase one line: the ends of the forbidden gains in dB (lowest and highest for the
margin, the highest for tracking; nan where nothing is forbidden).
"""

import sys
import time

import numpy as np

MARGIN_FREQUENCIES = [0.1, 0.5, 1, 2, 15, 100]
TRACKING_FREQUENCIES = [0.1, 0.5, 1, 2]


def plants(side, w):
    k, a = np.meshgrid(np.linspace(1, 10, side), np.linspace(1, 10, side))
    s = 1j * w
    return (k * a / (s * (s + a))).ravel()


def margin(responses, limit, directions):
    """The quadratic inequality of every plant at every phase, all at once."""
    q = responses[0] / responses
    square = limit**2
    along = square * (q.real[:, None] * directions.real + q.imag[:, None] * directions.imag)
    constant = square * (q.real**2 + q.imag**2)[:, None]
    discriminant = along**2 - (square - 1) * constant
    forbids = (discriminant > 0) & (along < 0)
    root = np.sqrt(discriminant, where=forbids, out=np.zeros_like(discriminant))
    low = np.where(forbids, (-along - root) / (square - 1), np.inf).min(axis=0)
    high = np.where(forbids, (-along + root) / (square - 1), -np.inf).max(axis=0)
    return np.where(low < high, low, np.nan), np.where(low < high, high, np.nan)


def margin_by_phase(responses, limit, directions):
    """The same phase by phase, so that everything stays in the processor's cache."""
    found = [margin(responses, limit, directions[index : index + 1]) for index in range(len(directions))]
    return np.concatenate([low for low, _ in found]), np.concatenate([high for _, high in found])


def tracking(responses, ratio, directions):
    """The highest forbidden gain: down from 80 dB in steps of 1 dB, then bisection, all phases at once."""
    x = responses / responses[0]

    def violated(gain_db, where):
        loop = (10 ** (gain_db / 20) * directions[where])[:, None] * x
        closed = np.abs(loop / (1 + loop))
        return closed.max(axis=1) > ratio * closed.min(axis=1)

    good, bad = np.full(len(directions), 80.0), np.full(len(directions), np.nan)
    open_phases = np.arange(len(directions))
    for gain_db in np.arange(79.0, -61.0, -1.0):
        hit = violated(np.full(len(open_phases), gain_db), open_phases)
        bad[open_phases[hit]] = gain_db
        open_phases = open_phases[~hit]
        good[open_phases] = gain_db
        if not len(open_phases):
            break
    found = np.flatnonzero(~np.isnan(bad))
    for _ in range(24):
        middle = (good[found] + bad[found]) / 2
        hit = violated(middle, found)
        bad[found] = np.where(hit, middle, bad[found])
        good[found] = np.where(hit, good[found], middle)
    return (good + bad) / 2


def limits(w):
    s = 1j * w
    upper = 0.6584 * (s + 30) / (s**2 + 4 * s + 19.752)
    lower = 120 / (s**3 + 17 * s**2 + 82 * s + 120)
    return abs(upper) / abs(lower)


def decibel(gain):
    return 20 * np.log10(gain)


def main():
    what, side, count = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    directions = np.exp(-1j * np.linspace(0, 2 * np.pi, count))
    start = time.process_time()
    if what == "tracking":
        columns = [[tracking(plants(side, w), limits(w), directions)] for w in TRACKING_FREQUENCIES]
    else:
        method = margin if what == "margin" else margin_by_phase
        columns = [map(decibel, method(plants(side, w), 1.2, directions)) for w in MARGIN_FREQUENCIES]
    seconds = time.process_time() - start
    print(seconds)
    for at_frequency in columns:
        for row in zip(*at_frequency):
            print(*(repr(float(value)) for value in row))


if __name__ == "__main__":
    main()
