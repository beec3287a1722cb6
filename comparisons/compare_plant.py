"""Compares the linear plant of `phea linearize` with the equations of Ledezma (2019), chapter 4, differentiated here.

    python comparisons/compare_plant.py [PHEA]        # or the variable PHEA; without either, what cargo builds

Forty random rigs: four different edges, unequal areas, lines and dead volumes, entrained air, leakage across the piston, every load. The
equilibrium is found by SciPy, the derivatives by complex steps of 1e-30, and force per command and per motion of the load's ground must agree to
1e-6 at forty frequencies. At null, where other edges open on either side, a small motion sees the mean of both.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import scipy.optimize

ROOT = pathlib.Path(__file__).resolve().parent.parent
RIGS, TOLERANCE, ATMOSPHERE = 40, 1e-6, 101325.0
FREQUENCIES = np.geomspace(1e-3, 2e4, 40)
EDGES = ["supply_to_a", "a_to_tank", "supply_to_b", "b_to_tank"]


def draw(number):
    """A rig in SI units."""
    random = np.random.default_rng([7, number])
    spread = lambda low, high: float(low * (high / low) ** random.random())
    load = ["prescribed", "spring_mass_damper", "wall"][number % 3]
    return {
        "bulk_modulus": spread(1e9, 1.8e9),
        "air": spread(1e-3, 3e-2) if number % 4 == 1 else 0.0,
        "index": spread(1.0, 1.4),
        "supply": spread(40e5, 210e5),
        "flow": [spread(1.5e-7, 4e-7) for _ in EDGES],
        "leak": [spread(1e-9, 5e-9) for _ in EDGES],
        "shape": spread(60, 150),
        "frequency": spread(300, 2000),
        "damping": spread(0.5, 1.2),
        "areas": [spread(5e-4, 3e-3), spread(5e-4, 3e-3)],
        "dead": [spread(1e-6, 1e-4), spread(1e-6, 1e-4)],
        "stroke": 0.5,
        "position": spread(0.05, 0.45),
        "mass": spread(2, 80),
        "friction": spread(50, 2e4),
        "internal": spread(1e-14, 1e-10) if number % 5 else None,
        "volumes": [spread(5e-5, 5e-4), spread(5e-5, 5e-4)],
        "moduli": [spread(1e8, 1.2e9), spread(1e8, 1.2e9)],
        "uniform": number % 2 == 0,
        "sensor": spread(1e6, 1e8),
        "load": load,
        "load_mass": spread(1, 500),
        "load_stiffness": spread(1e4, 1e8),
        "load_damping": spread(10, 1e4),
        "touch": spread(0.01, 1.0),
    }


def project(rig):
    edges = lambda values: "\n".join(f"{name} = {value!r}" for name, value in zip(EDGES, values))
    internal = "" if rig["internal"] is None else f"internal_leakage = {rig['internal']!r}\n"
    more = f"relative_damping = {rig['touch']!r}\ngap = 0\n" if rig["load"] == "wall" else ""
    load = f"mass = {rig['load_mass']!r}\nstiffness = {rig['load_stiffness']!r}\ndamping = {rig['load_damping']!r}\n"
    lines = "".join(
        f"[line.{side}]\nvolume = {volume!r}\neffective_bulk_modulus = {modulus!r}\n"
        for side, volume, modulus in zip("ab", rig["volumes"], rig["moduli"])
    )
    return f"""schema = 1
[fluid]
bulk_modulus = {rig["bulk_modulus"]!r}
density = 870
entrained_air = {rig["air"]!r}
polytropic_exponent = {rig["index"]!r}
[supply]
pressure = {rig["supply"]!r}
tank_pressure = 0
[valve]
nominal_voltage = 10
natural_frequency = {rig["frequency"]!r}
damping_ratio = {rig["damping"]!r}
leakage_shape = {rig["shape"]!r}
transition_pressure = 1000
[valve.flow_coefficients]
{edges(rig["flow"])}
[valve.leakage_coefficients]
{edges(rig["leak"])}
[cylinder]
piston_areas = {rig["areas"]!r}
rod_diameter = 0.01
dead_volumes = {rig["dead"]!r}
stroke = {rig["stroke"]!r}
moving_mass = {rig["mass"]!r}
{internal}[cylinder.friction]
model = "viscous"
viscous = {rig["friction"]!r}
[line]
compliance = "{"uniform" if rig["uniform"] else "by_volume"}"
{lines}[force_sensor]
stiffness = {rig["sensor"]!r}
[operating_point]
position = {rig["position"]!r}
[load]
model = "{rig["load"]}"
{load if rig["load"] != "prescribed" else ""}{more}"""


def root(drop):
    """Thesis, section 4.1: the square root of a drop, regular at zero."""
    return drop / (drop**2 + 1e6) ** 0.25


def flows(rig, spool, side, a, b):
    """Flows into both chambers, thesis (4.2) to (4.9); `side` tells which edges a spool at null opens."""
    share = spool / 10
    forward, backward = (share, 0 * share) if side > 0 else (0 * share, -share)
    leakage = 1 / np.cosh(rig["shape"] * share)
    openings = [forward, backward, backward, forward]
    supply_a, a_tank, supply_b, b_tank = (f * o + l * leakage for f, l, o in zip(rig["flow"], rig["leak"], openings))
    into_a = supply_a * root(rig["supply"] - a) - a_tank * root(a)
    into_b = supply_b * root(rig["supply"] - b) - b_tank * root(b)
    across = (rig["internal"] or 0.0) * (a - b)
    return into_a - across, into_b + across


def compliances(rig, x, a, b):
    """Of chambers and lines; liquid and polytropic air side by side, the volume fraction that at atmospheric pressure."""
    found = []
    travels = (x, rig["stroke"] - x)
    for area, dead, travel, volume, modulus, p in zip(rig["areas"], rig["dead"], travels, rig["volumes"], rig["moduli"], (a, b)):
        pressure = p + ATMOSPHERE
        liquid = (1 - rig["air"]) * np.exp((ATMOSPHERE - pressure) / rig["bulk_modulus"])
        gas = rig["air"] * (ATMOSPHERE / pressure) ** (1 / rig["index"])
        fluid = (liquid / rig["bulk_modulus"] + gas / (rig["index"] * pressure)) / (liquid + gas)
        chamber = 1 / modulus if rig["uniform"] else fluid
        found.append((dead + area * travel) * chamber + volume / modulus)
    return found


def rates(rig, y, command, ground, side):
    """Thesis (4.1), (4.25), (4.26) corrected, (4.29), (4.45), and the load between the cell and its ground."""
    spool, spool_rate, a, b, deflection, velocity, load, load_velocity = y
    position, ground_velocity = ground
    area_a, area_b = rig["areas"]
    yields = rig["load"] != "prescribed"
    load_position = position + load if yields else position
    carried = load_velocity if yields else ground_velocity
    into_a, into_b = flows(rig, spool, side, a, b)
    compliance_a, compliance_b = compliances(rig, load_position + deflection, a, b)
    force = rig["sensor"] * deflection
    held = rig["load_stiffness"] * load + rig["load_damping"] * (load_velocity - ground_velocity)
    if rig["load"] == "wall":
        held = held + rig["load_stiffness"] * load * rig["touch"] * (load_velocity - ground_velocity)
    return [
        spool_rate,
        rig["frequency"] ** 2 * (command - spool) - 2 * rig["damping"] * rig["frequency"] * spool_rate,
        (into_a - area_a * velocity) / compliance_a,
        (into_b + area_b * velocity) / compliance_b,
        velocity - carried,
        (area_a * a - area_b * b - rig["friction"] * velocity - force) / rig["mass"],
        load_velocity - ground_velocity if yields else 0 * load,
        (force - held) / rig["load_mass"] if yields else 0 * load,
    ]


def plant(rig):
    """F/U and F/X_0 at the frequencies; `None` where a wall would have to pull."""
    balance = lambda p: np.array(flows(rig, 0.0, 1, *(np.array(p) * rig["supply"]))) * 1e6
    a, b = scipy.optimize.fsolve(balance, [0.5, 0.5], xtol=1e-13) * rig["supply"]
    force = rig["areas"][0] * a - rig["areas"][1] * b
    if rig["load"] == "wall" and force <= 0:
        return None
    deflection = force / rig["sensor"]
    load = force / rig["load_stiffness"] if rig["load"] != "prescribed" else 0.0
    rest = np.array([0, 0, a, b, deflection, 0, load, 0], complex)
    ground = np.array([rig["position"] - deflection - load, 0], complex)
    kept = slice(0, 8) if rig["load"] != "prescribed" else slice(0, 6)

    def column(place, side):
        y, command, moved = rest.copy(), 0j, ground.copy()
        if place < 8:
            y[place] += 1e-30j
        elif place == 8:
            command += 1e-30j
        else:
            moved[place - 9] += 1e-30j
        return np.imag(rates(rig, y, command, moved, side)) / 1e-30

    jacobian = np.array([(column(place, 1) + column(place, -1)) / 2 for place in range(11)]).T[kept]
    matrix, command = jacobian[:, kept], jacobian[:, 8]
    answers = []
    for w in FREQUENCIES:
        drive = np.stack([command, jacobian[:, 9] + 1j * w * jacobian[:, 10]], axis=1)
        scale = np.array([1, 1e3, 1e6, 1e6, 1e-4, 1e-1, 1e-4, 1e-1])[kept]
        system = (1j * w * np.eye(len(matrix)) - matrix) * scale / scale[:, None]
        answers.append(np.linalg.solve(system, drive / scale[:, None])[4] * scale[4] * rig["sensor"])
    return np.array(answers)


def told(program, path):
    run = subprocess.run([*program, "linearize", str(path), "--json"], capture_output=True, text=True, cwd=ROOT)
    if run.returncode != 0:
        raise RuntimeError(f"phea linearize {path} ended with {run.returncode}: {run.stderr.strip()[-800:]}")
    plant, s = json.loads(run.stdout)["plant"], 1j * FREQUENCIES[:, None]
    roots = lambda pairs: np.array([complex(*pair) for pair in pairs])
    answer = lambda part: part["gain"] * np.prod(s - roots(part["zeros"]), axis=1) / np.prod(s - roots(part["poles"]), axis=1)
    return np.stack([answer(plant["command"]), answer(plant["load_position"])], axis=1)


def main(arguments):
    built = [os.environ["PHEA"]] if "PHEA" in os.environ else None
    program = arguments or built or ["cargo", "run", "-q", "-p", "phea-cli", "--"]
    wrong, worst, compared, number = [], 0.0, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        while compared < RIGS:
            rig = draw(number)
            number += 1
            expected = plant(rig)
            if expected is None:
                continue
            path = pathlib.Path(folder) / f"rig_{number}.toml"
            path.write_text(project(rig))
            error = np.abs(told(program, path) / expected - 1).max()
            worst, compared = max(worst, error), compared + 1
            if not error < TOLERANCE:
                wrong.append(number - 1)
                print(f"rig {number - 1} ({rig['load']}): {error:.3g}")
    print(f"{compared} rigs, largest difference {worst:.2g}, {len(wrong)} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
