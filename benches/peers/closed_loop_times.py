"""Times phea, CVODE and Runge-Kutta on the closed loop of closed_loop.h and prints work against precision.

phea runs the project files of examples/benchmark (crates/workbench/benches/simulation.rs) in turn with CVODE on one core;
the best of all its runs is compared with the best of all of CVODE's, at the tolerance stated in the file for phea and 1e-6
for CVODE, and at equal error, where CVODE's time is read off its own curve. Then the curves and CVODE's settings one by one.

Time of one thread, the best of many runs, largest error of the force at 1 ms against CVODE at 1e-12. With
stability-limit detection CVODE falls by chance into one of two regimes, a factor of two apart in steps: the tolerance is
varied by 20 % either way, and the fastest is reported beside the one asked for. Restarting at the load's motion or not
is tried as well. Whole commands are timed from the start of a process to its end, tables included. The machine should be
quiet. The curves of work against precision are left in
target/peers/work_precision.csv; benches/peers/work_precision.csv is one such, and what the figure of the book shows:
cargo run -p phea-workbench --example work_precision.

    python benches/peers/closed_loop_times.py              # needs SUNDIALS: libsundials-dev of Debian
    python benches/peers/closed_loop_times.py curves       # without CVODE's settings one by one
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import time

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent.parent / "comparisons"))

from closed_loop import BUILT, FORCE, ROOT, SUNDIALS, cvode, program, runge_kutta  # noqa: E402

NEAR = (0.8, 0.85, 0.9, 0.95, 1.0, 1.05, 1.1, 1.15, 1.2)
REPEATS = 20
TURNS = 10
CASES = {"continuous": ("closed_loop", ()), "sampled": ("closed_loop_sampled", ("sample_time=1e-3", "repeats=4"))}
METHODS = {"continuous": ("bdf_stability", "bdf", "adams"), "sampled": ("bdf", "adams", "adams_functional")}


def run(name, *arguments):
    """What a program reports about a run: milliseconds, the work as a dictionary, and the rows."""
    output = BUILT / "times.csv"
    told = [f"repeats={REPEATS}", f"output={output}"]
    words = [BUILT / name, *map(str, arguments[:2]), *told, *map(str, arguments[2:])]
    report = subprocess.run(words, check=True, capture_output=True, text=True).stdout.split()
    work = dict(zip(report[2::2], map(float, report[3::2])))
    return work["best_ms"], work, np.loadtxt(output, delimiter=",", skiprows=1)


def error(rows, reference):
    return np.abs(rows[:, FORCE] - reference[:, FORCE]).max()


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


def compile_phea():
    """phea's bench as a program beside the others."""
    words = ["cargo", "bench", "-p", "phea-workbench", "--bench", "simulation", "--no-run", "--message-format=json"]
    report = subprocess.run(words, check=True, capture_output=True, text=True, cwd=ROOT).stdout
    found = [json.loads(text).get("executable") for text in report.splitlines()]
    shutil.copy2([name for name in found if name][-1], BUILT / "phea_closed_loop")


def in_turn(*commands):
    """Each command several times in turn: of each the run with the least milliseconds."""
    best = [run(*command) for command in commands]
    for _ in range(TURNS - 1):
        best = [min(old, run(*command), key=lambda result: result[0]) for old, command in zip(best, commands)]
    return best


def at_equal_error(points, force_error):
    """Milliseconds of the fastest method at an error, on straight lines between its points on logarithmic axes."""
    times = []
    for method in {point[1] for point in points}:
        curve = [(float(error), time) for _, name, _, time, error in points if name == method]
        for (worse, fewer), (better, more) in zip(curve, curve[1:]):
            if better <= force_error < worse:
                part = np.log(worse / force_error) / np.log(worse / better)
                times.append((fewer * (more / fewer) ** part, method))
    return min(times, default=(np.nan, "none"))


def beside_phea(controller, reference, points):
    """phea at the tolerance of its project file, and CVODE's settings, run in turn."""
    case, changes = CASES[controller]
    settings = [("bdf_stability", "1e-6"), ("adams", "1e-6"), ("bdf", "1e-6")]
    commands = [("phea_closed_loop", case, "file")]
    commands += [("cvode_closed_loop", *setting, *changes) for setting in settings]
    (ours, work, rows), *theirs = in_turn(*commands)
    ours_error = error(rows, reference)
    line("phea at the tolerance of its file", ours, work, ours_error)
    for setting, (milliseconds, work, rows) in zip(settings, theirs):
        line(" ".join(("CVODE", *setting)), milliseconds, work, error(rows, reference))
        print(f"    ratio {milliseconds / ours:.1f}")
    milliseconds, method = at_equal_error(points, ours_error)
    print(f"  CVODE at {ours_error:.2e} N: {milliseconds:.2f} ms ({method}), ratio {milliseconds / ours:.1f}")


def work_and_precision(controller, reference):
    """Lines of the curves: controller, method, tolerance or step in s, milliseconds, largest error of the force in N."""
    case, changes = CASES[controller]
    points = []

    def take(method, setting, label, *command):
        milliseconds, work, rows = run(*command)
        line(label, milliseconds, work, error(rows, reference))
        points.append((controller, method, setting, milliseconds, f"{error(rows, reference):.4e}"))

    for exponent in np.arange(-4, -10.25, -0.5):
        tolerance = f"{10**exponent:.3e}"
        take("phea", tolerance, f"phea 1e{exponent:g}", "phea_closed_loop", case, tolerance)
        for method in METHODS[controller]:
            take(method, tolerance, f"CVODE {method} 1e{exponent:g}", "cvode_closed_loop", method, tolerance, *changes)
    for steps in (5, 10, 20, 50):
        take("runge_kutta", 1e-3 / steps, f"Runge-Kutta in {1e3 / steps:g} us", "runge_kutta_closed_loop", steps, *changes)
    return points


def whole_commands():
    """A process each, from its start to its end, tables written: phea's with all its columns, the peer's with its five."""
    words = ["cargo", "build", "--release", "-p", "phea-cli", "--message-format=json"]
    report = subprocess.run(words, check=True, capture_output=True, text=True, cwd=ROOT).stdout
    phea = [json.loads(text).get("executable") for text in report.splitlines()]
    phea = [name for name in phea if name][-1]
    answers = BUILT / "answers"
    project = ROOT / "examples" / "benchmark" / "closed_loop.toml"
    told = [phea, "simulate", project, "--out", answers]
    commands = {"phea simulate --no-figures --out": [*told, "--no-figures"], "phea simulate --out": told}
    for method in ("bdf_stability", "bdf", "adams"):
        commands[f"CVODE {method} 1e-6"] = [BUILT / "cvode_closed_loop", method, "1e-6", "repeats=1", f"output={BUILT / 'five.csv'}"]
    best = dict.fromkeys(commands, np.inf)
    for _ in range(REPEATS):
        for name, command in commands.items():
            shutil.rmtree(answers, ignore_errors=True)
            begun = time.perf_counter()
            subprocess.run(list(map(str, command)), check=True, capture_output=True)
            best[name] = min(best[name], time.perf_counter() - begun)
            if name.startswith("phea"):
                tables = sorted(answers.glob("*.csv"))
                columns = [len(table.open().readline().split(",")) for table in tables]
    print(f"  phea's columns: {columns}")
    ours = next(iter(best.values()))
    for name, seconds in best.items():
        print(f"  {name:46s}{1e3 * seconds:9.1f} ms, ratio {seconds / ours:.2f}")


def main():
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    program("cvode_closed_loop", *SUNDIALS)
    program("runge_kutta_closed_loop")
    compile_phea()
    references = {"continuous": cvode("bdf", 1e-12), "sampled": cvode("bdf", 1e-12, sample_time=1e-3)}
    apart = error(runge_kutta(200), references["continuous"])
    print(f"5 s; the continuous reference is {apart:.1e} N from Runge-Kutta in 5 us")
    points = []
    for controller, reference in references.items():
        print(f"work against precision, {controller}")
        curves = work_and_precision(controller, reference)
        print(f"in turn on one core, {controller}")
        beside_phea(controller, reference, [point for point in curves if point[1] in METHODS[controller]])
        points += curves
    header = "controller,method,tolerance_or_step_s,processor_ms,force_error_n"
    text = "\n".join([header, *(",".join(map(str, point)) for point in points)])
    (BUILT / "work_precision.csv").write_text(text + "\n")
    print("whole commands in turn on one core")
    whole_commands()
    if "curves" not in sys.argv[1:]:
        print("CVODE's settings one by one, continuous")
        baseline(references["continuous"])


if __name__ == "__main__":
    main()
