"""Times CVODE and Runge-Kutta on the closed loop of closed_loop.h and prints work against precision.

Processor time of one thread, the best of many runs, largest error of the force at 1 ms against CVODE at 1e-12. With
stability-limit detection CVODE falls by chance into one of two regimes, a factor of two apart in steps: the tolerance is
varied by 20 % either way, and the fastest is reported beside the one asked for. Restarting at the load's motion or not
is tried as well. The machine should be quiet. The curves of work against precision are left in
target/peers/work_precision.csv.

    python benches/peers/closed_loop_times.py              # needs SUNDIALS: libsundials-dev of Debian
"""

import pathlib
import subprocess
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent.parent / "comparisons"))

from closed_loop import BUILT, FORCE, SUNDIALS, cvode, program, runge_kutta  # noqa: E402

NEAR = (0.8, 0.85, 0.9, 0.95, 1.0, 1.05, 1.1, 1.15, 1.2)
REPEATS = 20


def run(name, *arguments):
    """What a program reports about a run: milliseconds, the work as a dictionary, and the rows."""
    output = BUILT / "times.csv"
    words = [BUILT / name, *map(str, arguments), f"repeats={REPEATS}", f"output={output}"]
    report = subprocess.run(words, check=True, capture_output=True, text=True).stdout.split()
    work = dict(zip(report[2::2], map(float, report[3::2])))
    return work["best_ms"], work, np.loadtxt(output, delimiter=",", skiprows=1)


def error(rows, reference):
    return np.abs(rows - reference)[:, FORCE].max()


def line(name, milliseconds, work, force_error):
    evaluations = work.get("evaluations", 4 * work["steps"]) + work.get("jacobian_evaluations", 0)
    print(f"  {name:46s}{milliseconds:9.2f} ms {force_error:11.3e} N {work['steps']:9.0f} steps {evaluations:9.0f} evaluations")


def baseline(reference, *changes):
    """The settings that claims of speed name, at the tolerance asked for and the fastest near it."""
    for method, tolerance in (("bdf_stability", 1e-6), ("bdf", 1e-6), ("adams", 1e-6), ("adams", 1e-8), ("adams_functional", 1e-6)):
        for restart in (0, 1):
            trials = [
                (*run("cvode_closed_loop", method, f"{tolerance * factor:.6g}", f"restart_at_motion={restart}", *changes), factor)
                for factor in NEAR
            ]
            named = f"CVODE {method} {tolerance:g}" + (", restarts at motion" if restart else "")
            asked = next(trial for trial in trials if trial[3] == 1.0)
            fastest = min(trials, key=lambda trial: trial[0])
            slowest = max(trials, key=lambda trial: trial[0])
            line(named, asked[0], asked[1], error(asked[2], reference))
            line(f"   fastest within 20 %: {tolerance * fastest[3]:.3g}", fastest[0], fastest[1], error(fastest[2], reference))
            line(f"   slowest within 20 %: {tolerance * slowest[3]:.3g}", slowest[0], slowest[1], error(slowest[2], reference))


def work_and_precision(controller, reference, methods, *changes):
    """Lines of the curves: controller, method, tolerance or step in s, milliseconds, largest error of the force in N."""
    points = []
    for method in methods:
        for exponent in np.arange(-4, -10.5, -0.5):
            milliseconds, work, rows = run("cvode_closed_loop", method, f"{10**exponent:.3e}", *changes)
            line(f"CVODE {method} 1e{exponent:g}", milliseconds, work, error(rows, reference))
            points.append((controller, method, f"{10**exponent:.3e}", milliseconds, f"{error(rows, reference):.4e}"))
    for steps in (5, 10, 20, 50):
        milliseconds, work, rows = run("runge_kutta_closed_loop", steps, *changes)
        line(f"Runge-Kutta in {1e3 / steps:g} us", milliseconds, work, error(rows, reference))
        points.append((controller, "runge_kutta", 1e-3 / steps, milliseconds, f"{error(rows, reference):.4e}"))
    return points


def main():
    program("cvode_closed_loop", *SUNDIALS)
    program("runge_kutta_closed_loop")
    reference = cvode("bdf", 1e-12)
    print(f"continuous, 5 s; the reference is {error(runge_kutta(200), reference):.1e} N from Runge-Kutta in 5 us")
    baseline(reference)
    print("work against precision, continuous")
    points = work_and_precision("continuous", reference, ("bdf_stability", "bdf", "adams"))
    sampled = cvode("bdf", 1e-12, sample_time=1e-3)
    print("controller sampled at 1 kHz, CVODE started anew at each sample")
    points += work_and_precision("sampled", sampled, ("bdf", "adams", "adams_functional"), "sample_time=1e-3")
    header = "controller,method,tolerance_or_step_s,processor_ms,force_error_n"
    text = "\n".join([header, *(",".join(map(str, point)) for point in points)])
    (BUILT / "work_precision.csv").write_text(text + "\n")


if __name__ == "__main__":
    main()
