"""Holds a simulation with relief and check valves at the chambers against SciPy's LSODA on equations written in Python.

    python comparisons/compare_port_valves.py [PHEA]        # or the variable PHEA; without either, what cargo builds

The closed loop of examples/benchmark, whose load moves against the shut valve: with relief valves that open in the run, with
valves that are open at rest, and with check valves that let oil into a chamber.
"""

import csv
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import closed_loop_scipy

ROOT = pathlib.Path(__file__).resolve().parent.parent
PHEA = sys.argv[1] if len(sys.argv) > 1 else os.environ.get("PHEA", str(ROOT / "target/debug/phea"))
PROJECT = ROOT / "examples" / "benchmark" / "closed_loop.toml"
LARGEST = 1e-3  # difference of the force, N
# cracking pressure, conductance, both of the check valve, and half width of the transition, in Pa and m3/(s Pa); pressure of the
# tank in Pa; whether phea names openings of the relief and of the check valves
CASES = {
    "relief opens": ((42e5, 2e-10, 1e5, 2e-10, 1e4), 0.0, (True, False)),
    "within transition": ((42e5, 2e-10, 1e5, 2e-10, 2e6), 0.0, (False, False)),
    "open at rest": ((20e5, 1e-12, 1e5, 1e-12, 1e4), 0.0, (True, False)),
    "check valve opens": ((60e5, 2e-10, 1e5, 5e-11, 5e4), 40e5, (False, True)),
}


def simulated(cracking, relief, check_pressure, check, width, tank):
    valves = f'cracking_pressure = "{cracking} Pa", override = "1 bar", flow = "{relief * 1e5} m3/s"'
    valves += f', check_valve_pressure = "{check_pressure} Pa", check_valve_override = "1 bar"'
    valves += f', check_valve_flow = "{check * 1e5} m3/s", transition_pressure = "{width} Pa"'
    with tempfile.TemporaryDirectory() as folder:
        command = [PHEA, "simulate", str(PROJECT), "--set", f"port_valves={{ {valves} }}"]
        command += ["--set", f"supply.tank_pressure={tank} Pa", "--set", "simulation.tolerance=1e-9", "--out", folder]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode in (0, 1), done.stderr
        (path,) = pathlib.Path(folder).glob("*.csv")
        with path.open() as rows:
            return np.array([float(row["force_n"]) for row in csv.DictReader(rows)]), done.stdout


def main():
    for name, (valves, tank, opens) in CASES.items():
        bare = closed_loop_scipy.force(1e-10, tank_pressure=tank)
        own, told = simulated(*valves, tank)
        other = closed_loop_scipy.force(1e-10, port_valves=valves, tank_pressure=tank)
        apart, effect = np.abs(own - other).max(), np.abs(other - bare).max()
        print(f"{name:20s} largest difference {apart:.2e} N; the valves change the force by {effect:.3g} N")
        assert effect > 1e3 * LARGEST, name
        assert apart < LARGEST, name
        assert tuple(f"{valve} valve of chamber" in told for valve in ("relief", "check")) == opens, told


if __name__ == "__main__":
    main()
