"""Recomputes the effect of a hose and of a pipe on the force under a reference step and under steps of the load.

Independent of phea: the closed loop in C of benches/peers, by Runge-Kutta in fixed steps of 10 us. `uniform` stiffness:
2.609e8 Pa with 1.9e-4 m3 for the hose, 1.45e9 Pa with 3.03e-5 m3 for the pipe; controllers G1, F1 and G2, F2 of
Ledezma (2019). The load moves 5 mm at 3 s, as a first-order lag.

    python comparisons/recompute_simulation.py
"""

import numpy as np

from closed_loop import COMMAND, FORCE, SPOOL, TIME, runge_kutta

STEP = 1e-5
REFERENCE, BAND = 4e3, 0.01


def line(modulus, volume):
    return {
        "chamber_modulus": modulus, "line_modulus_a": modulus, "line_modulus_b": modulus,
        "line_volume_a": volume, "line_volume_b": volume,
    }  # fmt: skip


HOSE = line(2.609e8, 1.9e-4)
PIPE = {
    **line(1.45e9, 3.03e-5), "proportional_gain": 0.0005, "integral_gain": 0.002,
    "prefilter_stiffness": 484.0, "prefilter_damping": 44.0,
}  # fmt: skip


def run(rig, output_step=1e-4, **changes):
    return runge_kutta(round(output_step / STEP), output_step=output_step, **rig, **changes)


def between(rows, start, end):
    return rows[(rows[:, TIME] >= start - 1e-9) & (rows[:, TIME] <= end + 1e-9)]


def overshoot_and_settling(rows):
    """Percent of the reference, and the time after which the force stays within 1 % of it."""
    window = between(rows, 2.0, 3.0)
    outside = window[np.abs(window[:, FORCE] - REFERENCE) > BAND * REFERENCE]
    return 100 * (window[:, FORCE].max() / REFERENCE - 1), outside[-1, TIME] - 2.0


def swing(values):
    """Sum of all ups and downs."""
    return np.abs(np.diff(values)).sum()


def effort(window):
    """Root mean square of command and spool about their values at rest."""
    return [np.sqrt(np.mean((window[:, column] - window[-1, column]) ** 2)) for column in (COMMAND, SPOOL)]


def reference_step():
    for name, rig, known in (("hose", HOSE, (0.36, 0.287)), ("pipe", PIPE, (0.15, 0.292))):
        overshoot, settling = overshoot_and_settling(run(rig))
        print(f"{name}: overshoot {overshoot:.3f} %, settling time (1 %) {settling:.4f} s")
        assert abs(overshoot - known[0]) < 0.005 and abs(settling - known[1]) < 0.0006


def load_step(time_constant):
    """Peak deviation from 4 kN at four sampling intervals, for hose and pipe."""
    peaks = {}
    for name, rig in (("hose", HOSE), ("pipe", PIPE)):
        motion = {"motion_time_constant": time_constant}
        fine = between(run(rig, output_step=STEP, **motion), 3.0, 5.0)
        deviation = np.abs(fine[:, FORCE] - REFERENCE)
        sampled = [deviation[:: round(interval / STEP)].max() for interval in (STEP, 1e-4, 1e-3, 1e-2)]
        # What rings: the peak without what a running mean over one period of the load cell's resonance takes away.
        period = round(2 * np.pi / 1250 / STEP)
        smooth = np.convolve(fine[:, FORCE] - REFERENCE, np.ones(period) / period, mode="valid")
        peaks[name] = sampled[0]
        print(
            f"load step {time_constant} s, {name}: peak",
            *(f"{value:.1f}" for value in sampled),
            f"N each 10 us, 0.1, 1, 10 ms; without its ringing {np.abs(smooth).max():.1f} N at "
            f"{1e3 * STEP * deviation.argmax():.2f} ms; command rms {effort(fine)[0]:.3f} V, "
            f"spool rms {effort(fine)[1]:.3f} V, command up and down {swing(fine[:, COMMAND]):.1f} V, "
            f"force up and down {swing(fine[:, FORCE]):.0f} N",
        )
    ratio = peaks["pipe"] / peaks["hose"]
    print(f"load step {time_constant} s: pipe to hose {ratio:.3f}")
    return peaks["hose"], peaks["pipe"]


def main():
    reference_step()
    for time_constant, hose, pipe in ((0.02, 5812.6, 8901.0), (0.05, 2802.9, 4527.0), (0.1, 1603.9, 2545.9)):
        peaks = load_step(time_constant)
        assert np.allclose(peaks, (hose, pipe), rtol=1e-3)


if __name__ == "__main__":
    main()
