"""Holds a simulation with accumulators at the chambers against SciPy's LSODA on equations written in Python.

    python comparisons/compare_accumulator.py [PHEA]        # or the variable PHEA; without either, what cargo builds

The closed loop of examples/benchmark, with gas that stays in use, with gas that one chamber shuts off under load, with gas behind
a neck at each chamber, and with gas that exchanges heat with its wall.
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
# gas volume in m3, precharge in Pa gauge, polytropic exponent; largest difference of the force in N; diameter and length of the
# neck in m, and its loss coefficient; thermal time constant in s in place of the exponent
CASES = {
    "in use": (5e-6, 10e5, 1.4, 1e-3, None, None),
    "slow gas": (2e-5, 8e5, 1.0, 1e-3, None, None),
    "shut off under load": (5e-6, 20e5, 1.4, 1e-3, None, None),
    "behind a neck": (5e-6, 10e5, 1.4, 1e-3, (5e-3, 0.05, 1.5), None),
    "behind a long neck": (2e-5, 8e5, 1.0, 1e-3, (4e-3, 0.3, 3.0), None),
    "with heat": (5e-6, 10e5, None, 1e-3, None, 0.5),
    "with heat behind a neck": (2e-5, 8e5, None, 1e-3, (4e-3, 0.3, 3.0), 0.05),
}
# kg/m3, m2/s and Pa
OIL = {"density": 870.0, "viscosity": 46e-6, "fluid_modulus": 1.45e9}


def simulated(gas_volume, precharge, index, neck, time_constant):
    gas = f'gas_volume = "{gas_volume} m3", precharge_pressure = "{precharge} Pa"'
    gas += f", polytropic_exponent = {index}" if time_constant is None else f", thermal_time_constant = {time_constant}"
    if neck is not None:
        gas += ", neck_diameter = {}, neck_length = {}, neck_loss_coefficient = {}".format(*neck)
    gas = f"{{ {gas} }}"
    with tempfile.TemporaryDirectory() as folder:
        command = [PHEA, "simulate", str(PROJECT), "--set", f"line.accumulator={gas}"]
        command += ["--set", "simulation.tolerance=1e-9", "--out", folder]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode in (0, 1), done.stderr
        (path,) = pathlib.Path(folder).glob("*.csv")
        with path.open() as rows:
            return np.array([float(row["force_n"]) for row in csv.DictReader(rows)]), done.stdout


def main():
    bare = closed_loop_scipy.force(1e-10)
    for name, (gas_volume, precharge, index, largest, neck, time_constant) in CASES.items():
        own, told = simulated(gas_volume, precharge, index, neck, time_constant)
        gas = {"gas_volume": gas_volume, "precharge": precharge, "polytropic_exponent": index}
        gas |= {} if time_constant is None else {"time_constant": time_constant}
        gas |= {} if neck is None else {"neck": neck, **OIL}
        other = closed_loop_scipy.force(1e-10, **gas)
        apart, effect = np.abs(own - other).max(), np.abs(other - bare).max()
        print(f"{name:20s} largest difference {apart:.2e} N; the gas itself changes the force by {effect:.3g} N")
        assert effect > 1e3 * largest, name
        assert apart < largest, name
        assert ("shut off" in told) == (name == "shut off under load"), told


if __name__ == "__main__":
    main()
