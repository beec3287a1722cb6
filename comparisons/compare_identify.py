"""Compares `phea identify` with scipy.optimize.least_squares on the same recordings.

    python comparisons/compare_identify.py [PHEA]        # or the variable PHEA; without either, what cargo builds

`phea bench` records the tests of the example's valve with noise. Both fit them: phea with its own method, SciPy with a
model written independently here from theory/valve_tests.md (plain square roots, closed forms, derivatives by differences) and its
own Huber loss. Both must find the same coefficients, to a tenth of the width of phea's 95 % intervals.
"""

import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from scipy.optimize import least_squares

ROOT = pathlib.Path(__file__).resolve().parent.parent
PHEA = sys.argv[1] if len(sys.argv) > 1 else os.environ.get("PHEA", str(ROOT / "target/debug/phea"))
PROJECT = str(ROOT / "examples/ybitu/hose.toml")
# square roots without a laminar part, no drop across the meter
SETTINGS = [
    "valve.transition_pressure=0.1 Pa",
    "valve.null_bias=14 mV",
    "valve.hysteresis=128 mV",
    "bench.sample_time=500 ms",
    "bench.flow_meter.pressure_drop=0",
]
EDGES = ["supply_to_a", "a_to_tank", "supply_to_b", "b_to_tank"]
NOMINAL, BAR, LITRE_PER_MINUTE = 10.0, 1e5, 1 / 60000


def run(arguments):
    settings = [word for setting in SETTINGS for word in ("--set", setting)]
    done = subprocess.run([PHEA, *arguments, *settings], capture_output=True, text=True, check=True)
    return done.stdout


def read(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def openings(command, bias, width):
    """Position of the edges over the nominal voltage."""
    half, lag, found = width / 2, 0.0, []
    steps = np.diff(command, prepend=command[0])
    for step in steps:
        end = half * np.sign(step)
        lag = end + (lag - end) * np.exp(-abs(step) / width)
        found.append(lag)
    return (command - bias - np.array(found)) / NOMINAL


def shown(table, numbers, connected):
    flow, leak = numbers[:4], numbers[4:8]
    shape, tare, bias, width = numbers[8:]
    u = openings(table["command_v"], bias, width)
    supply = table["supply_pressure_bar"] * BAR
    forward, backward, rest = np.maximum(u, 0), np.maximum(-u, 0), 1 / np.cosh(shape * u)
    opened = [forward, backward, backward, forward]
    a, b, c, d = (k * o + l * rest for k, o, l in zip(flow, opened, leak))
    if connected:
        pressure = supply * (a + c) ** 2 / ((a + c) ** 2 + (b + d) ** 2)
        port = a * np.sqrt(np.maximum(supply - pressure, 0)) - b * np.sqrt(pressure)
        # phea takes the difference of the recorded pressures, noise with all, as the drop of the meter
        return {"mean_pressure": pressure, "flow": np.abs(port)}
    pressures = [supply * x**2 / (x**2 + y**2) for x, y in ((a, b), (c, d))]
    taken = (a * b / np.hypot(a, b) + c * d / np.hypot(c, d)) * np.sqrt(supply)
    return {"pressure_a": pressures[0], "pressure_b": pressures[1], "leak_flow": taken + tare * np.sqrt(supply / 70e5)}


def recorded(table, signal):
    if signal == "mean_pressure":
        return (table["pressure_a_bar"] + table["pressure_b_bar"]) / 2 * BAR
    unit = BAR if signal.startswith("pressure") else LITRE_PER_MINUTE
    return table[f"{signal}_{'bar' if unit == BAR else 'l_per_min'}"] * unit


def main():
    with tempfile.TemporaryDirectory() as folder:
        run(["bench", PROJECT, "--out", folder])
        paths = [f"{folder}/{name}.csv" for name in ("leakage", "metering", "pressure_gain")]
        found = json.loads(run(["identify", *paths, "--project", PROJECT, "--starts", "1", "--json"]))
        tables = {path: read(path) for path in paths}
    estimates = [found[group][edge] for group in ("flow_coefficients", "leakage_coefficients") for edge in EDGES]
    estimates += [found[name] for name in ("leakage_shape", "tare_flow_m3_per_s", "null_bias_v", "hysteresis_v")]
    first = np.array([3e-7, 2.3e-7, 2.3e-7, 3e-7] + [2.2e-9] * 4 + [85, 7.5e-6, 0.01, 0.12])

    def residuals(variables):
        rows = []
        models = {path: shown(table, first * variables, "flow_l_per_min" in table) for path, table in tables.items()}
        for signal in found["signals"]:
            values = recorded(tables[signal["file"]], signal["signal"])
            own = (models[signal["file"]][signal["signal"]] - values) / signal["scale"]
            rows.append(own[values != 0] if signal["signal"] == "flow" else own)
        return np.concatenate(rows)

    peer = least_squares(residuals, np.ones(12), loss="huber", f_scale=1.345, x_scale="jac", xtol=1e-12, ftol=1e-12)
    worst = 0.0
    for name, estimate, other in zip(range(12), estimates, first * peer.x):
        low, high = estimate["confidence_95"]
        away = abs(estimate["value"] - other) / (high - low)
        worst = max(worst, away)
        print(f"{name:2d}  phea {estimate['value']:.6e}  SciPy {other:.6e}  apart {away:.4f} of the interval")
    assert peer.success and worst < 0.1, f"phea and SciPy differ by {worst:.3f} of an interval"
    print(f"{len(peer.fun)} residuals: phea and SciPy agree to {worst:.4f} of a 95 % interval")


main()
