"""Holds a simulation with pressure feedback against SciPy's LSODA on equations written in Python.

    python comparisons/compare_pressure_feedback.py [PHEA]  # or the variable PHEA; without either, what cargo builds

The closed loop of examples/benchmark, which begins with the filters of the feedback at zero, with a gentle and a strong gain,
each reading of the pressures, and a gain that saturates the command.
"""

import csv
import os
import pathlib
import subprocess
import sys
import tempfile
from math import pi

import numpy as np

import closed_loop_scipy

ROOT = pathlib.Path(__file__).resolve().parent.parent
PHEA = sys.argv[1] if len(sys.argv) > 1 else os.environ.get("PHEA", str(ROOT / "target/debug/phea"))
PROJECT = ROOT / "examples" / "benchmark" / "closed_loop.toml"
# gain in V/bar, area ratio, high pass and low pass in Hz; largest difference of the force in N
CASES = {
    "gentle": (0.02, 1.0, 2.0, 150.0, 1e-3),
    "strong": (0.3, 1.0, 1.0, 60.0, 1e-3),
    "other areas": (0.1, 0.7, 5.0, 200.0, 1e-3),
    "saturated": (2.0, 1.0, 20.0, 300.0, 1e-3),
}


def simulated(gain, ratio, high_pass, low_pass):
    declared = f'gain = "{gain} V/bar", area_ratio = {ratio}, high_pass = "{high_pass} Hz", low_pass = "{low_pass} Hz"'
    with tempfile.TemporaryDirectory() as folder:
        command = [PHEA, "simulate", str(PROJECT), "--set", f"controller.pressure_feedback={{ {declared} }}"]
        command += ["--set", "simulation.tolerance=1e-9", "--out", folder]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode in (0, 1), done.stderr
        (path,) = pathlib.Path(folder).glob("*.csv")
        with path.open() as rows:
            return np.array([float(row["force_n"]) for row in csv.DictReader(rows)])


def main():
    bare = closed_loop_scipy.force(1e-10)
    for name, (gain, ratio, high_pass, low_pass, largest) in CASES.items():
        own = simulated(gain, ratio, high_pass, low_pass)
        fed = (gain * 1e-5, ratio, 2 * pi * high_pass, 2 * pi * low_pass)
        other = closed_loop_scipy.force(1e-10, pressure_feedback=fed)
        apart, effect = np.abs(own - other).max(), np.abs(other - bare).max()
        print(f"{name:12s} largest difference {apart:.2e} N; the feedback itself changes the force by {effect:.3g} N")
        assert effect > 1e3 * largest, name
        assert apart < largest, name


if __name__ == "__main__":
    main()
