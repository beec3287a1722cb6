"""Compares `phea identify` with scipy.optimize.least_squares on recordings of random valves.

    python comparisons/compare_identify.py [--sets N] [PHEA]     # or the variable PHEA; without either, what cargo builds

Each set is a valve drawn around Table 5.1 of Ledezma (2019), tested by `phea bench`: both models of the leakage, noise, a supply that sags,
hysteresis or none, meters that stand still or reach their range, converters, one port recorded or both, all tests or some. `phea identify` fits
each with its own method. SciPy fits it with `valve_model.py`, which shares no code with phea, with the same loss, scales, variables and bounds, from
phea's first guess, and again from phea's optimum.

At phea's coefficients both models must have the same cost to 1e-8, and no fit of SciPy's may have a cost lower by more than 1e-6.
"""

import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from scipy.optimize import least_squares

import valve_model

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROJECT = str(ROOT / "examples/ybitu/hose.toml")
SETS = 8
SAME_MODEL, LOWER = 1e-8, 1e-6
EDGES = ["supply_to_a", "a_to_tank", "supply_to_b", "b_to_tank"]
PATHS = [f"{group}_coefficients.{edge}" for group in ("flow", "leakage") for edge in EDGES]
PATHS += ["leakage_shape", "tare_flow", "null_bias", "hysteresis"]
# Table 5.1, values obtained via optimization
FLOW, LEAK = [3.2e-7, 2.5e-7, 2.0e-7, 3.85e-7], [2.35e-9, 2.2e-9, 1.7e-9, 2.35e-9]
BAR, LITRE_PER_MINUTE = 1e5, 1 / 60000
BEYOND = 1.345          # where the loss becomes linear
NOMINAL = 10.0
POSITIVE, BIAS = [0, 1, 2, 3, 8], 10


def draw(number):
    """Settings of the bench, of the files that are kept, and of their columns."""
    random = np.random.default_rng([5, number])
    spread = lambda low, high: float(low * (high / low) ** random.random())
    chance = lambda share: bool(random.random() < share)
    set_ = {f"valve.flow_coefficients.{edge}": one * spread(0.6, 1.6) for edge, one in zip(EDGES, FLOW)}
    set_ |= {f"valve.leakage_coefficients.{edge}": one * spread(0.4, 2.5) for edge, one in zip(EDGES, LEAK)}
    set_ |= {
        "valve.leakage_shape": spread(40, 250),
        "valve.leakage_model": ["each_edge", "one_curve"][number % 2],
        "valve.tare_flow": f"{0 if chance(0.1) else spread(2e-6, 2e-5)} m3/s",
        "valve.null_leakage": "10 L/min",
        "valve.null_leakage_maximum": "10 L/min",
        "valve.null_bias": f"{random.uniform(-150, 150)} mV",
        "valve.hysteresis": f"{1e-6 if chance(0.15) else spread(10, 300)} mV",
        "valve.transition_pressure": f"{spread(1, 1e4)} Pa",
        "supply.pressure": f"{spread(40, 90)} bar",
        "supply.tank_pressure": f"{random.choice([0, 3])} bar",
        "bench.waveform": str(random.choice(["sine", "triangle"])),
        "bench.cycles": int(random.integers(1, 3)),
        "bench.amplitude": spread(0.15, 0.5),
        "bench.sample_time": f"{random.uniform(0.5, 1.2)} s",
        "bench.converter_bits": int(random.choice([0, 10, 12, 16])),
        "bench.pressure_noise": f"{spread(0.005, 0.5)} bar",
        "bench.leak_meter.noise": f"{spread(5e-4, 5e-2)} L/min",
        "bench.leak_meter.range": f"{spread(0.7, 5)} L/min",
        "bench.leak_meter.minimum": f"{0 if chance(0.5) else spread(0.02, 0.4)} L/min",
        "bench.leak_meter.signed": chance(0.3),
        "bench.flow_meter.noise": f"{spread(5e-3, 0.2)} L/min",
        "bench.flow_meter.range": f"{spread(4, 60)} L/min",
        "bench.flow_meter.minimum": f"{0 if chance(0.3) else spread(0.05, 3)} L/min",
        "bench.flow_meter.signed": chance(0.4),
        "bench.flow_meter.pressure_drop": f"{0 if chance(0.3) else spread(0.3, 8)} bar",
        "bench.seed": number + 1,
    }
    spool = np.random.default_rng([6, number])
    set_ |= {"valve.natural_frequency": f"{spool.uniform(100, 1000)} rad/s", "valve.damping_ratio": spool.uniform(0.5, 1.2)}
    if chance(0.5):
        set_["bench.pump_flow"] = f"{spread(3, 12)} L/min"
    if chance(0.3):
        set_["bench.low_flow_meter.minimum"] = f"{spread(0.02, 0.3)} L/min"
    files = ["leakage", "metering", "pressure_gain"] + ["metering_low_flow"] * ("bench.low_flow_meter.minimum" in set_)
    if chance(0.25):
        files.remove(str(random.choice(["leakage", "metering", "pressure_gain"])))
    return set_, files, random.choice([None, "pressure_a_bar", "pressure_b_bar"], p=[0.6, 0.2, 0.2])


def asked(phea, arguments, settings):
    words = [word for key, value in settings.items() for word in ("--set", f"{key}={json.dumps(value)}")]
    done = subprocess.run([phea, *arguments, *words], capture_output=True, text=True)
    assert done.returncode in (0, 1), f"{arguments[0]}: {done.stderr}"
    return done.stdout


def columns(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def leave_out(path, name):
    """The file without a column."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    with open(path, "w", newline="") as file:
        written = csv.DictWriter(file, [one for one in rows[0] if one != name], extrasaction="ignore", lineterminator="\n")
        written.writeheader()
        written.writerows(rows)


class Fit:
    """What is fitted: tests, signals with their scales, and the variables around the first guess."""

    def __init__(self, found, settings):
        value = lambda text: float(text.split()[0])
        tank = value(settings["supply.tank_pressure"]) * BAR
        delay = 2 * settings["valve.damping_ratio"] / value(settings["valve.natural_frequency"])
        self.valve = {
            "nominal_voltage": NOMINAL,
            "transition": value(settings["valve.transition_pressure"]),
            "tare_pressure": found["tare_pressure_pa"],
            "one_curve": found["leakage_model"] == "one_curve",
        }
        self.tests, self.signals = {}, []
        for signal in found["signals"]:
            path = signal["file"]
            table = columns(path)
            ports = [table.get(f"pressure_{port}_bar") for port in "ab"]
            both = all(port is not None for port in ports)
            self.tests[path] = {
                "command": table["command_v"],
                "corners": valve_model.corners(table["time_s"], table["command_v"]),
                "lag": delay * np.diff(table["command_v"], prepend=0) / np.diff(table["time_s"], prepend=-1),
                "supply": table["supply_pressure_bar"] * BAR,
                "tank": tank,
                "load": (ports[0] - ports[1]) * BAR if both else np.zeros_like(table["command_v"]),
                "joined": "flow_l_per_min" in table,
            }
            name = signal["signal"]
            if name == "mean_pressure":
                values = (ports[0] + ports[1]) / 2 * BAR
            elif name.startswith("pressure"):
                values = table[f"{name}_bar"] * BAR
            else:
                values = table[f"{name}_l_per_min"] * LITRE_PER_MINUTE
            read = np.ones(len(values), bool)
            if name.endswith("flow"):
                read = values != 0          # a meter that reads zero
            if name == "flow" and not np.any(values < 0):
                name = "magnitude"
            assert np.sum(read) == signal["rows"], f"{path} {name}: {np.sum(read)} rows, phea has {signal['rows']}"
            self.signals.append((path, name, values, read, signal["scale"]))
        self.first = np.array([found["first_guess"][path] for path in PATHS])

    def numbers(self, x):
        numbers = self.first * x
        numbers[POSITIVE] = self.first[POSITIVE] * np.exp(x[POSITIVE])
        numbers[BIAS] = self.first[BIAS] + x[BIAS] * 0.01 * NOMINAL
        return numbers

    def variables(self, numbers):
        x = numbers / self.first
        x[POSITIVE] = np.log(x[POSITIVE])
        x[BIAS] = (numbers[BIAS] - self.first[BIAS]) / (0.01 * NOMINAL)
        return x

    def start(self):
        x = np.ones(valve_model.COUNT)
        x[POSITIVE + [BIAS]] = 0
        return x

    def bounds(self):
        """As theory/valve_tests.md states them."""
        low, high = np.full(12, -4.6), np.full(12, 4.6)
        low[4:8], high[4:8] = 1e-6, 100
        low[8], high[8] = np.log(np.array([1, 5000]) / self.first[8])
        low[9], high[9] = 0, 1e-2 / self.first[9]
        low[10], high[10] = (np.array([-1, 1]) * 0.1 * NOMINAL - self.first[10]) / (0.01 * NOMINAL)
        low[11], high[11] = np.array([1e-7, 0.2]) * NOMINAL / self.first[11]
        return low, high

    def residuals(self, x):
        numbers = self.numbers(x)
        shown = {path: valve_model.shown(test, numbers, self.valve) for path, test in self.tests.items()}
        return np.concatenate([((shown[path][name] - values) / scale)[read] for path, name, values, read, scale in self.signals])

    def jacobian(self, x):
        numbers = self.numbers(x)
        moved = valve_model.with_derivatives(numbers)
        shown = {path: valve_model.shown(test, moved, self.valve) for path, test in self.tests.items()}
        slopes = self.first.copy()
        slopes[POSITIVE], slopes[BIAS] = numbers[POSITIVE], 0.01 * NOMINAL
        rows = [valve_model.derivative(shown[path][name], numbers)[:, read] / scale for path, name, _, read, scale in self.signals]
        return np.concatenate(rows, axis=1).T * slopes

    def cost(self, x):
        size = np.abs(self.residuals(x))
        return float(np.sum(np.where(size <= BEYOND, size**2 / 2, BEYOND * (size - BEYOND / 2))))

    def search(self, x):
        low, high = self.bounds()
        found = least_squares(self.residuals, np.clip(x, low, high), self.jacobian, (low, high), loss="huber", f_scale=BEYOND,
                              xtol=1e-15, ftol=1e-14, gtol=1e-14, max_nfev=400)
        return found.x, self.cost(found.x)


def identified(phea, number):
    """phea's answer to a set, and what SciPy fits."""
    settings, files, missing = draw(number)
    with tempfile.TemporaryDirectory() as folder:
        asked(phea, ["bench", PROJECT, "--out", folder], settings)
        paths = [f"{folder}/{name}.csv" for name in files]
        for path in paths:
            if missing:
                leave_out(path, missing)
        found = json.loads(asked(phea, ["identify", *paths, "--project", PROJECT, "--json"], settings))
        return found, Fit(found, settings)


def compare(phea, number):
    found, fit = identified(phea, number)
    groups = [found[f"{group}_coefficients"][edge] for group in ("flow", "leakage") for edge in EDGES]
    rest = [found[name] for name in ("leakage_shape", "tare_flow_m3_per_s", "null_bias_v", "hysteresis_v")]
    x = fit.variables(np.array([one["value"] for one in groups + rest]))
    cost = found["cost"]
    other = abs(fit.cost(x) / cost - 1)
    gains = [(cost - reached) / cost for _, reached in (fit.search(fit.start()), fit.search(x))]
    print(f"{number:3d}  {found['leakage_model']:9s}  {sum(one['rows'] for one in found['signals']):5d} residuals  cost {cost:.6e}"
          f"  models differ by {other:.1e}  SciPy lower by {gains[0]:+.1e} from the start, {gains[1]:+.1e} from the optimum", flush=True)
    return other, max(gains)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--sets", type=int, default=SETS)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("phea", nargs="?", default=os.environ.get("PHEA", str(ROOT / "target/debug/phea")))
    given = parser.parse_args()
    compared = [compare(given.phea, number) for number in range(given.first, given.first + given.sets)]
    other, gain = (max(column) for column in zip(*compared))
    print(f"{len(compared)} sets: models differ by at most {other:.1e} in the cost, SciPy's is lower by at most {gain:.1e}")
    assert other < SAME_MODEL, "the models differ"
    assert gain < LOWER, "phea does not find the minimum"


if __name__ == "__main__":
    sys.exit(main())
