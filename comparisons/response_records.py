"""Recordings of a known plant under six kinds of excitation, in the open and in the closed loop.

The plant is 40/(0.08 s + 1) times a resonance at 12 Hz with a damping of 0.15, its input held for 2 ms from row to row,
so that SciPy's discretisation is the true response from row to row. Nothing here is phea's.
"""

import numpy as np
from scipy import signal

STEP, ROWS = 2e-3, 4000
OPEN, CLOSED = "open", "closed"
KINDS = ["multisine", "noise", "linear sweep", "logarithmic sweep", "stepped sine", "step", "PRBS"]
RESONANCE = 2 * np.pi * 12
CONTINUOUS = (
    [40.0 * RESONANCE**2],
    np.polymul([0.08, 1.0], [1.0, 2 * 0.15 * RESONANCE, RESONANCE**2]),
)
NUMERATOR, DENOMINATOR, _ = signal.cont2discrete(CONTINUOUS, STEP, "zoh")
NUMERATOR = NUMERATOR.ravel()
# proportional and integral: stable with every delay of one row
PROPORTIONAL, INTEGRAL = 0.012, 0.12


def project(gain=1.0):
    """A project whose [controller] is this one, times a gain, and acts in every row."""
    return f"""schema = 1
[plant]
numerator = "40"
denominator = "0.08*s + 1"
[controller]
numerator = "{gain * PROPORTIONAL}*z - {gain * (PROPORTIONAL - INTEGRAL * STEP)}"
denominator = "z - 1"
sample_time = "{STEP} s"
[[identify.response]]
file = "record.csv"
loop = "closed"
controller = "declared"
"""


def project_of_levels(files):
    """A project whose records are those of one operating point."""
    plant = 'schema = 1\n[plant]\nnumerator = "40"\ndenominator = "0.08*s + 1"\n'
    return plant + "".join(f'[[identify.response]]\nfile = "{file}"\noperating_point = "middle"\n' for file in files)


def truth(frequencies):
    """Response of the held plant from row to row; rad/s."""
    return signal.freqz(NUMERATOR, DENOMINATOR, np.asarray(frequencies) * STEP)[1]


def excitation(kind, random):
    """A signal of about unit size, with what differs from recording to recording drawn anew."""
    time = np.arange(ROWS) * STEP
    span = ROWS * STEP
    if kind == "multisine":
        period = 500
        lines = np.arange(1, 41)
        phases = random.uniform(0, 2 * np.pi, lines.size)
        one = np.cos(2 * np.pi * np.outer(np.arange(period), lines) / period + phases).sum(axis=1)
        return np.tile(one / np.sqrt(lines.size / 2), ROWS // period)
    if kind == "noise":
        return 1.5 * signal.lfilter(*signal.butter(2, 40 * 2 * STEP), random.normal(size=ROWS)) / 0.4
    if kind == "linear sweep":
        return np.sin(2 * np.pi * (0.5 * time + (40 - 0.5) / (2 * span) * time**2))
    if kind == "logarithmic sweep":
        ratio = 40 / 0.5
        return np.sin(2 * np.pi * 0.5 * span / np.log(ratio) * (ratio ** (time / span) - 1))
    if kind == "stepped sine":
        steps = np.geomspace(1, 40, 10)
        which = np.minimum((time / span * steps.size).astype(int), steps.size - 1)
        return np.sin(np.cumsum(2 * np.pi * steps[which] * STEP))
    if kind == "step":
        return np.where(time < 0.3 * span, 0.0, 1.0)
    if kind == "PRBS":
        held = random.choice([-1.0, 1.0], size=ROWS // 5 + 1)
        return np.repeat(held, 5)[:ROWS]
    raise ValueError(kind)


def noise(random, size):
    """Coloured noise of an output."""
    return signal.lfilter([np.sqrt(1 - 0.9**2)], [1, -0.9], random.normal(size=ROWS + 500))[500:] * size


def at_amplitude(kind, seed, amplitude, dead_band=0.0, output_noise=0.5):
    """Columns time, input and output of the open loop, whose actuator lets nothing through within half of the dead band to either side of zero."""
    random = np.random.default_rng([KINDS.index(kind), seed, round(1e3 * amplitude)])
    given = amplitude * excitation(kind, random)
    passed = np.sign(given) * np.maximum(np.abs(given) - dead_band / 2, 0)
    return np.arange(ROWS) * STEP, given, signal.lfilter(NUMERATOR, DENOMINATOR, passed) + noise(random, output_noise)


def recording(kind, loop, seed, output_noise=0.5, input_noise=0.0):
    """Columns time, reference, input and output. In the closed loop the excitation is added to the reference."""
    random = np.random.default_rng([KINDS.index(kind), seed, loop == CLOSED])
    moved = excitation(kind, random)
    disturbed = noise(random, output_noise)
    if loop == OPEN:
        given, shown = moved, signal.lfilter(NUMERATOR, DENOMINATOR, moved) + disturbed
    else:
        # r -> y, r -> u and noise -> both, of the loop u = C (r - y), C = (Kp + Ki T/(z - 1))
        top = np.array([PROPORTIONAL, INTEGRAL * STEP - PROPORTIONAL])
        bottom = np.array([1.0, -1.0])
        # convolve, since polymul drops the leading zero that delays by a row
        around = np.convolve(bottom, DENOMINATOR) + np.convolve(top, NUMERATOR)
        assert np.abs(np.roots(around)).max() < 1
        moved = 20 * moved
        of_loop = np.convolve(top, DENOMINATOR)
        given = signal.lfilter(of_loop, around, moved - disturbed)
        shown = signal.lfilter(np.convolve(top, NUMERATOR), around, moved) + signal.lfilter(
            np.convolve(bottom, DENOMINATOR), around, disturbed
        )
    given = given + input_noise * given.std() * random.normal(size=ROWS)
    return np.arange(ROWS) * STEP, moved, given, shown
