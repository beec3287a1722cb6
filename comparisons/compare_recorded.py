"""Compares `phea identify --of friction` and `--of line` with the truth of recordings that are made here.

    python comparisons/compare_recorded.py [--seeds N] [PHEA]     # or the variable PHEA; without either, what cargo builds

The equations of the friction (LuGre, Canudas de Wit and others 1995) and of the blocked line (D'Souza and Oldenburger 1964; a mixture with free air)
are written here again and share no code with phea. All signals have noise, pressures a zero error, and some of them a gain error. Seven frictions: all
as the model has it; a zero error of 0.3 bar; fast runs with both breakaways; three speeds; a piston that sticks and slips; friction that is a third
greater on the way back; one whose static and viscous friction differ by direction, with breakaways. Lines: without air; with 2 % of it, of the
mixture at atmospheric pressure; with 2 % of the volume of the line; an exact wave; a compliance that jumps.

Where the model matches, 95 % intervals must hold the truth as often as a binomial distribution allows, by four standard deviations, and no misfit may
be reported; where it does not, the misfit or the run that is left out must be.
"""

import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROJECT = str(ROOT / "examples/ybitu/hose.toml")
SEEDS = 2
BAR = 1e5
AREA = math.pi / 4 * (0.05**2 - 0.022**2)
MASS = 13.1
TRUTH = {
    "coulomb_n": 80.0,
    "static_n": 120.0,
    "stribeck_velocity_m_per_s": 0.01,
    "stribeck_exponent": 2.0,
    "viscous_n_s_per_m": 100.0,
    "bristle_stiffness_n_per_m": 1e7,
}
COULOMB, STATIC, STRIBECK, EXPONENT, VISCOUS, STIFFNESS = TRUTH.values()
DAMPING = 2e3
NOISE_BAR, NOISE_M = 0.05, 1e-6


# levels of the way back: Coulomb, static and viscous friction
SAME = (COULOMB, STATIC, VISCOUS)
OTHER = (85.0, 150.0, 160.0)


def levels(velocity, back):
    return back if velocity < 0 else SAME


def level(velocity, back=SAME):
    """g(v) in N."""
    coulomb, static, _ = levels(velocity, back)
    return coulomb + (static - coulomb) * math.exp(-abs(velocity / STRIBECK) ** EXPONENT)


def sliding(speeds, back=SAME, run=0.5, step=1e-3):
    """Positions and forces at constant velocities both ways, with ramps of 50 ms between them. The bristles are solved exactly for the velocity of
    each of ten parts of a row."""
    targets = [way * speed for speed in speeds for way in (1, -1)]
    velocities = [0.0] * 50
    for target in targets:
        velocities += list(np.linspace(velocities[-1], target, 50)) + [target] * round(run / step)
    position, deflection = 0.0, 0.0
    positions, forces = [], []
    for index, velocity in enumerate(velocities):
        last = velocities[index - 1] if index else 0.0
        carried, viscous = level(velocity, back), levels(velocity, back)[2]
        rate = velocity - STIFFNESS * abs(velocity) * deflection / carried
        positions.append(position)
        forces.append(STIFFNESS * deflection + DAMPING * rate + viscous * velocity + MASS * (velocity - last) / step)
        for _ in range(10):
            part = step / 10
            settled = math.copysign(carried, velocity) / STIFFNESS
            deflection = settled + (deflection - settled) * math.exp(-STIFFNESS * abs(velocity) * part / carried)
            position += velocity * part
    return step, positions, forces


def breakaway(way, back=SAME, rise=3.0, step=1e-3):
    """From rest, a force that rises slowly until the piston breaks away: the mass on its bristles by small steps, implicit in the velocity."""
    velocity = position = deflection = 0.0
    positions, forces = [], []
    row = 0
    _, static, viscous = levels(way, back)
    while abs(position) < 5e-4:
        time = row * step
        positions.append(way * position)
        forces.append(way * max(0.0, (time - 0.05) / rise * 1.3 * static))
        parts = 200
        for part in range(parts):
            now = time + part * step / parts
            force = max(0.0, (now - 0.05) / rise * 1.3 * static)
            slip = STIFFNESS * deflection / level(way * velocity, back)
            # dz/dt = v (1 - slip): stiffness, damping and mass together
            open_ = 1.0 - slip
            by = step / parts
            denominator = MASS + by * (DAMPING * open_ + viscous) + by * by * STIFFNESS * open_
            velocity = (MASS * velocity + by * (force - STIFFNESS * deflection)) / denominator
            deflection += by * velocity * open_
            position += by * velocity
        row += 1
    return step, positions, forces


def stick_slip(speed=4e-3, spring=1e5, seconds=3.0, step=1e-3):
    """A spring whose end moves slowly pulls the mass: below the Stribeck velocity it sticks and slips."""
    velocity = position = deflection = 0.0
    positions, forces = [], []
    for row in range(round(seconds / step)):
        force = spring * (speed * row * step - position)
        positions.append(position)
        forces.append(force)
        for part in range(50):
            by = step / 50
            pull = spring * (speed * (row * step + part * by) - position)
            open_ = 1.0 - math.copysign(1.0, velocity) * STIFFNESS * deflection / level(velocity)
            denominator = MASS + by * (DAMPING * open_ + VISCOUS) + by * by * STIFFNESS * open_
            velocity = (MASS * velocity + by * (pull - STIFFNESS * deflection)) / denominator
            deflection += by * velocity * open_
            position += by * velocity
    return step, positions, forces


def table(run, random, zero=0.0, gain=1.0, harder=1.0):
    """Rows as instruments record them: the mean of both pressures stays at 30 bar."""
    step, positions, forces = run
    rows = ["time_s,position_mm,pressure_a_bar,pressure_b_bar"]
    for index, (position, force) in enumerate(zip(positions, forces)):
        force *= harder if force < 0 else 1.0
        half = force / AREA / BAR / 2
        a, b = 30 + half, 30 - half
        a = gain * a + zero + NOISE_BAR * random.standard_normal()
        b += NOISE_BAR * random.standard_normal()
        rows.append(f"{index * step:.4f},{1e3 * (position + NOISE_M * random.standard_normal()):.5f},{a:.5f},{b:.5f}")
    return "\n".join(rows) + "\n"


class Asked:
    """phea, and how often its intervals hold."""

    def __init__(self, phea):
        self.phea = phea
        self.held = {}
        self.wrong = []

    def identify(self, kind, files, settings=()):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                (pathlib.Path(folder) / name).write_text(text)
            command = [self.phea, "identify", "--of", kind, PROJECT, *files, "--json"]
            for setting in settings:
                command += ["--set", setting]
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode not in (0, 1):
            sys.exit(f"{command}: {done.stderr}")
        return json.loads(done.stdout)

    def count(self, case, number, truth):
        if number["confidence_95"] is None:
            return
        low, high = (float(end) for end in number["confidence_95"])
        held, all_ = self.held.get(case, (0, 0))
        self.held[case] = (held + (low <= truth <= high), all_ + 1)

    def require(self, case, condition, what):
        if not condition:
            self.wrong.append(f"{case}: {what}")


def frictions(asked, seed):
    slow = list(np.geomspace(2e-3, 0.2, 8))
    fast = list(np.geomspace(20e-3, 0.2, 6))
    both = {"out.csv": breakaway(1), "back.csv": breakaway(-1)}
    cases = {
        "matched": ({"sliding.csv": sliding(slow), **both}, {}),
        "zero of 0.3 bar, gain of 0.5 %": ({"sliding.csv": sliding(slow), **both}, {"zero": 0.3, "gain": 1.005}),
        "fast, breakaways": ({"sliding.csv": sliding(fast), **both}, {}),
        "three speeds": ({"sliding.csv": sliding([5e-3, 30e-3, 0.2])}, {}),
        "sticks and slips": ({"sliding.csv": sliding(slow), "slips.csv": stick_slip()}, {}),
        "a third greater back": ({"sliding.csv": sliding(slow)}, {"harder": 1.33}),
        "differs by direction": (
            {"sliding.csv": sliding(slow, OTHER), "out.csv": breakaway(1, OTHER), "back.csv": breakaway(-1, OTHER)},
            {},
        ),
    }
    backs = {"a third greater back": tuple(1.33 * one for one in SAME), "differs by direction": OTHER}
    for index, (case, (runs, errors)) in enumerate(cases.items()):
        random = np.random.default_rng([seed, index])
        found = asked.identify("friction", {name: table(run, random, **errors) for name, run in runs.items()})
        asked.require(case, not found["misfits"], f"seed {seed}: {found['misfits']}")
        varying = [one for recording in found["recordings"] for one in recording["varying_velocities"]]
        asked.require(case, bool(varying) == (case == "sticks and slips"), f"seed {seed}: varying velocities {varying}")
        for key, truth in TRUTH.items():
            if key != "bristle_stiffness_n_per_m" or "out.csv" in runs:
                asked.count(case, found["friction"][key], truth)
        retracting = found["friction"]["retracting"]
        asked.require(case, (retracting is not None) == (case in backs), f"seed {seed}: {found['direction_models_difference']}")
        if retracting is not None:
            for key, truth in zip(("coulomb_n", "static_n", "viscous_n_s_per_m"), backs.get(case, SAME)):
                asked.count(case, retracting[key], truth)


LENGTH, DENSITY, VISCOSITY, OIL, WITHOUT_AIR = 1.5, 870.0, 46e-6, 1.45e9, 2.49e8
ATMOSPHERE = 101325.0


def compliance(fraction, pressure):
    """1/Pa over the volume, bubbles at constant temperature."""
    absolute = pressure + ATMOSPHERE
    liquid, gas = (1 - fraction) * np.exp(-pressure / OIL), fraction * ATMOSPHERE / absolute
    return 1 / WITHOUT_AIR - 1 / OIL + (liquid / OIL + gas / absolute) / (liquid + gas)


def of_line(fraction, pressure):
    """The same of air that is a fraction of the volume of the line, whatever its pressure."""
    return 1 / WITHOUT_AIR + fraction * ATMOSPHERE / (pressure + ATMOSPHERE) ** 2


def rise(random, volume, fraction, jump=0.0, compliance=compliance):
    pressures = np.linspace(2e5, 60e5, 20001)
    middle = (pressures[1:] + pressures[:-1]) / 2
    slopes = volume * compliance(fraction, middle) + jump * (middle > 20e5)
    taken = np.concatenate([[0.0], np.cumsum(slopes * np.diff(pressures))])
    times = np.arange(0, 55, 0.05)
    part = np.interp(times, [0, 5, 25, 30, 50, 55], [0, 0, 1, 1, 0, 0])
    shown = np.interp(part * taken[-1], taken, pressures) + 5e3 * random.standard_normal(len(times))
    volumes = part * taken[-1] + 1e-8 * random.standard_normal(len(times))
    rows = [f"{t:.3f},{1e6 * v:.7f},{p / BAR:.6f}" for t, v, p in zip(times, volumes, shown)]
    return "time_s,volume_ml,pressure_bar\n" + "\n".join(rows) + "\n"


def wave(random, volume, speed):
    """Flow and pressure of the exact line in whole periods of 0.25 s. Under pressure the hose is wider than its catalogue says: its area follows
    from its volume."""
    times = np.arange(0, 1.25, 1e-3)
    flow, pressure = np.zeros_like(times), np.full_like(times, 35e5)
    area = volume / LENGTH
    for index, line in enumerate([1, 2, 4, 7, 11, 15, 19, 22, 27, 33, 40, 48]):
        s = 2j * math.pi * line / 0.25
        z = np.sqrt(s * area / math.pi / VISCOSITY)
        ratio = 0.0
        for order in range(200, 0, -1):
            ratio = 1 / (2 * order / z + ratio)
        root = np.sqrt(1 / (1 - 2 * ratio / z))
        impedance = DENSITY * speed / area * root / np.tanh(s * LENGTH / speed * root)
        turning = 4e-6 * np.exp(s * times + 1j * index**2)
        flow += turning.real
        pressure += (turning * impedance).real
    flow += 2e-8 * random.standard_normal(len(times))
    pressure += 5e3 * random.standard_normal(len(times))
    rows = [f"{t:.4f},{60e3 * q:.8f},{p / BAR:.6f}" for t, q, p in zip(times, flow, pressure)]
    return "time_s,flow_l/min,pressure_bar\n" + "\n".join(rows) + "\n"


def lines(asked, seed):
    random = np.random.default_rng([seed, 100])
    volume = asked.identify("line", {"rise.csv": rise(random, 1.9e-4, 0.0)})["line"]["volume_m3"]
    for case, fraction in [("no air", 0.0), ("2 % of air", 0.02)]:
        found = asked.identify("line", {"rise.csv": rise(random, volume, fraction)})["line"]
        asked.count(case, found["effective_bulk_modulus_pa"], 1 / compliance(fraction, 35e5))
        asked.require(case, not found["misfits"], f"seed {seed}: {found['misfits']}")
        asked.require(case, (found["entrained_air"]["value"] is None) == (fraction == 0), f"seed {seed}: {found['entrained_air']}")
        if fraction:
            asked.count(case, found["entrained_air"], fraction)
    found = asked.identify("line", {"rise.csv": rise(random, volume, 0.02, compliance=of_line)})["line"]
    asked.count("2 % of the line", found["effective_bulk_modulus_pa"], 1 / of_line(0.02, 35e5))
    # 2 % of the oil at its pressure is 2/102 of the mixture at the atmosphere's, less as the mixture shrinks
    asked.require("2 % of the line", 0.0195 < found["entrained_air"]["value"] < 0.0199, f"seed {seed}: {found['entrained_air']}")
    found = asked.identify("line", {"shaken.csv": wave(random, volume, 535.0)}, ["line.model=\"transmission_line\""])["line"]
    asked.count("exact wave", found["wave_speed_m_per_s"], 535.0)
    found = asked.identify("line", {"rise.csv": rise(random, volume, 0.0, 2e-13)})["line"]
    asked.require("jump", found["misfits"], f"seed {seed}: no misfit is reported")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=SEEDS)
    parser.add_argument("phea", nargs="?", default=os.environ.get("PHEA", str(ROOT / "target/debug/phea")))
    arguments = parser.parse_args()
    asked = Asked(arguments.phea)
    for seed in range(1, arguments.seeds + 1):
        frictions(asked, seed)
        lines(asked, seed)
    for case, (held, count) in asked.held.items():
        # four standard deviations of a binomial distribution, and one more
        least = 0.95 * count - 4 * math.sqrt(0.0475 * count) - 1
        print(f"{case}: {held} of {count} intervals hold")
        asked.require(case, held >= least, f"{held} of {count} intervals hold the truth, and chance allows {least:.1f}")
    if asked.wrong:
        sys.exit("\n".join(asked.wrong))


if __name__ == "__main__":
    main()
