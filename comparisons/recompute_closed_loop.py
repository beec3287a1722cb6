"""Recomputes the trajectories of the closed loop that solvers are measured on, and checks the committed ones.

Independent of phea: CVODE's backward differentiation at tolerance 1e-12 and 1e-11, its Adams method, and Runge-Kutta in
fixed steps of 10 us in double and in extended precision, all in C (benches/peers); and SciPy's LSODA on the equations
written a second time, in Python. Prints how far they are apart, for the continuous controller and for the one sampled
at 1 kHz. Without SUNDIALS the rest is compared.

    python comparisons/recompute_closed_loop.py            # recompute and check
    python comparisons/recompute_closed_loop.py --write    # and write crates/workbench/tests/golden
"""

import sys

import numpy as np

import closed_loop_scipy
from closed_loop import FORCE, POSITION, ROOT, TIME, cvode, has_sundials, runge_kutta

GOLDEN = ROOT / "crates" / "workbench" / "tests" / "golden"
CASES = {"closed_loop": 0.0, "closed_loop_sampled": 1e-3}
COLUMNS = ["time_s", "force_n", "spool_v", "pressure_a_pa", "pressure_b_pa", "command_v", "position_m"]
STORED = range(5)
LARGEST_FORCE_ERROR = 1e-4
LARGEST_SCIPY_ERROR = 5e-4
ORIGIN = "recomputed by comparisons/recompute_closed_loop.py (CVODE 6.4.1, backward differentiation, tolerance 1e-12)"


def stored_rows(rows):
    """Each tenth millisecond, and each of the first 200 ms after the reference step, the load's start, and time 0."""
    milliseconds = np.round(1e3 * rows[:, TIME]).astype(int)
    dense = [(milliseconds >= start) & (milliseconds <= start + 200) for start in (2000, 3000)]
    return rows[(milliseconds % 10 == 0) | dense[0] | dense[1] | (milliseconds <= 20)]


def text(rows):
    lines = [f"# ORIGIN: {ORIGIN}", ",".join(COLUMNS[column] for column in STORED)]
    lines += [",".join(f"{row[column]:.13g}" for column in STORED) for row in stored_rows(rows)]
    return "\n".join(lines) + "\n"


def distance(name, first, second):
    """Prints the largest difference of each column, returns that of the force."""
    apart = np.abs(first - second).max(axis=0)
    named = ", ".join(f"{COLUMNS[column]} {apart[column]:.2e}" for column in range(FORCE, POSITION + 1))
    print(f"  {name:42s} {named}")
    return apart[FORCE]


def recompute(sample_time):
    """The best trajectory that can be had here, after comparing it with the others."""
    controller = f"sampled each {1e3 * sample_time:g} ms" if sample_time else "continuous"
    print(f"controller {controller}, largest differences over 5 s at 1 ms:")
    fixed = runge_kutta(100, sample_time=sample_time)
    distance("Runge-Kutta in 10 us against long double", fixed, runge_kutta(100, True, sample_time=sample_time))
    distance("Runge-Kutta in 10 us against 5 us", fixed, runge_kutta(200, sample_time=sample_time))
    if not sample_time:
        apart = np.abs(closed_loop_scipy.force(1e-10) - fixed[:, FORCE]).max()
        print(f"  {'Runge-Kutta in 10 us against LSODA 1e-10':42s} force_n {apart:.2e}")
        assert apart < LARGEST_SCIPY_ERROR
    if not has_sundials():
        print("  SKIPPED: no SUNDIALS here (Debian: libsundials-dev); the committed values meet the others alone")
        return fixed
    best = cvode("bdf", 1e-12, sample_time=sample_time)
    others = {
        "CVODE 1e-12 against 1e-11": cvode("bdf", 1e-11, sample_time=sample_time),
        "CVODE 1e-12 against Adams 1e-11": cvode("adams", 1e-11, sample_time=sample_time),
        "CVODE 1e-12 against Runge-Kutta in 10 us": fixed,
        "CVODE 1e-12 against Runge-Kutta in 5 us": runge_kutta(200, sample_time=sample_time),
    }
    for name, other in others.items():
        assert distance(name, best, other) < LARGEST_FORCE_ERROR, name
    return best


def main():
    for name, sample_time in CASES.items():
        best, path = recompute(sample_time), GOLDEN / f"{name}.csv"
        if "--write" in sys.argv:
            GOLDEN.mkdir(exist_ok=True)
            path.write_text(text(best))
        committed = np.loadtxt(path, delimiter=",", skiprows=2)
        recomputed = stored_rows(best)[:, list(STORED)]
        assert committed.shape == recomputed.shape
        apart = np.abs(committed - recomputed)[:, FORCE].max()
        print(f"  {path.relative_to(ROOT)}: {len(committed)} rows, force {apart:.2e} N from these")
        assert apart < LARGEST_FORCE_ERROR


if __name__ == "__main__":
    main()
