"""Counts how many 95 % intervals of a valve's coefficients hold the truth, on recordings of the virtual bench.

    python comparisons/recompute_valve_intervals.py [--seeds N] [--set KEY=VALUE ...] [PHEA]

Each seed is one recording of `examples/ybitu/bench.toml`, whose oil warms by 0.4 degC, with the settings that are given:
`--set 'bench.command_noise="2 mV"'`, `--set bench.converter_bits=12`. Printed is the table row of theory/valve_tests.md and, for each coefficient,
how many intervals hold, the mean error over its standard deviation, and half the width of the interval.
"""

import argparse
import json
import os
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROJECT = str(ROOT / "examples/ybitu/bench.toml")
# Table 5.1 of Ledezma (2019), values obtained via optimization, and section 5.2.1, as in the project
TRUTH = {
    "flow_coefficients.supply_to_a": 3.2e-7,
    "flow_coefficients.a_to_tank": 2.5e-7,
    "flow_coefficients.supply_to_b": 2.0e-7,
    "flow_coefficients.b_to_tank": 3.85e-7,
    "leakage_coefficients.supply_to_a": 2.35e-9,
    "leakage_coefficients.a_to_tank": 2.2e-9,
    "leakage_coefficients.supply_to_b": 1.7e-9,
    "leakage_coefficients.b_to_tank": 2.35e-9,
    "leakage_shape": 100,
    "tare_flow_m3_per_s": 7.55e-6,
    "null_bias_v": 0.014,
    "hysteresis_v": 0.128,
}


def asked(phea, *words):
    done = subprocess.run([phea, *words], capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stderr
    return done.stdout


def estimates(phea, seed, settings):
    """Each coefficient of one recording: value, and the ends of its interval."""
    given = [word for setting in settings for word in ("--set", setting)]
    with tempfile.TemporaryDirectory() as folder:
        asked(phea, "bench", PROJECT, "--out", folder, "--set", f"bench.seed={seed}", *given)
        files = sorted(str(one) for one in pathlib.Path(folder).glob("*.csv") if one.stem != "reversals")
        found = json.loads(asked(phea, "identify", *files, "--project", PROJECT, "--json"))
    for path in TRUTH:
        one = found
        for key in path.split("."):
            one = one[key]
        yield one["value"], *one["confidence_95"]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=24)
    parser.add_argument("--set", action="append", default=[], dest="settings")
    parser.add_argument("phea", nargs="?", default=os.environ.get("PHEA", str(ROOT / "target/release/phea")))
    given = parser.parse_args()
    rows = [list(estimates(given.phea, seed, given.settings)) for seed in range(1, given.seeds + 1)]
    columns = list(zip(TRUTH.items(), zip(*rows)))
    holds = {path: sum(low <= truth <= high for _, low, high in found) for (path, truth), found in columns}
    print(f"{sum(holds.values())} of {len(TRUTH) * given.seeds} intervals hold")
    for (path, truth), found in columns:
        deviations = [(high - low) / 3.92 for _, low, high in found]
        error = sum((value - truth) / one for (value, _, _), one in zip(found, deviations)) / given.seeds
        width = 196 * sum(deviations) / given.seeds / truth
        print(f"  {path:34s} {holds[path]:3d}  mean error {error:+.2f} deviations  half width {width:.3f} %")


if __name__ == "__main__":
    main()
