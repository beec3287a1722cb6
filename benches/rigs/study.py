"""Designs a controller for twelve rigs and holds 500 nonlinear runs of each against what was required.

    python benches/rigs/study.py PHEA [NAME ...]

The rigs are no one's: their numbers were chosen to be plausible, from 200 Hz to 5 kHz of sampling, symmetric cylinders and
others, motors, a knee, hoses and pipes, soft and stiff specimens. Each states a required step, an uncertainty box and the
same box for `phea campaign`. Printed is the table of the book: what the design is, what it takes, and how many of the runs
drawn over the box satisfy the requirement.
"""

import csv
import json
import pathlib
import resource
import shutil
import subprocess
import sys

RUNS = 500
METRICS = "overshoot_percent", "settling_time_s"
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

HEAD = """schema = 1
title = "{title}"

[fluid]
bulk_modulus = "1.4 GPa"
density = "870 kg/m3"
kinematic_viscosity = "46 cSt"

[supply]
model = "constant"
pressure = "{pressure} bar"
tank_pressure = "3 bar"
flow = "{flow} L/min"

[valve]
nominal_voltage = "10 V"
nominal_flow = "{valve_flow} L/min"
nominal_pressure_drop = "70 bar"
null_leakage = "{leakage} L/min"
null_leakage_pressure = "100 bar"
natural_frequency = "{valve_frequency} Hz"
damping_ratio = 0.8
leakage_shape = 60

[force_sensor]
stiffness = "{sensor}"
noise = "{noise}"
capacity = "{capacity}"

[line]
{line}

[load]
model = "spring_mass_damper"
mass = "{mass}"
stiffness = "{stiffness[1]} {stiffness_unit}"
damping = "{damping}"

[operating_point]
position = "{position}"
load_force = "{force[0]} {force_unit}"

[uncertainty]
"supply.pressure" = {{ nominal = "{pressure} bar", minimum = "{low} bar", maximum = "{high} bar", points = 2 }}
"load.stiffness" = {{ nominal = "{stiffness[1]} {stiffness_unit}", minimum = "{stiffness[0]} {stiffness_unit}", maximum = "{stiffness[2]} {stiffness_unit}", points = 3, spacing = "log" }}
"fluid.bulk_modulus" = {{ nominal = "1.4 GPa", minimum = "1.2 GPa", maximum = "1.6 GPa", points = 2 }}

[[specification]]
kind = "step"
overshoot_percent = {overshoot}
settling_time = "{settling} s"
settling_band_percent = 2
initial_force = "{force[0]} {force_unit}"
amplitude = "{step} {force_unit}"

[controller]
sample_time = "{sample_ms} ms"
delay = "{delay_ms} ms"
saturation = "10 V"
anti_windup = "clamping"

[[scenario]]
name = "step"
duration = "{duration} s"
reference = [{{ at = "0 s", force = "{force[0]} {force_unit}" }}, {{ at = "0.1 s", force = "{force[1]} {force_unit}" }}]
settling_band_percent = 2

[campaign]
distribution = "uniform"

[campaign.parameters]
"supply.pressure" = {{ minimum = "{low} bar", maximum = "{high} bar" }}
"load.stiffness" = {{ minimum = "{stiffness[0]} {stiffness_unit}", maximum = "{stiffness[2]} {stiffness_unit}", distribution = "log_uniform" }}
"fluid.bulk_modulus" = {{ minimum = "1.2 GPa", maximum = "1.6 GPa" }}
"""

CYLINDER = """
[cylinder]
piston_diameter = "{piston} mm"
rod_diameters = ["{rods[0]} mm", "{rods[1]} mm"]
stroke = "{stroke} mm"
moving_mass = "{moving} kg"
dead_volume = "{dead} mL"
internal_leakage = "2e-13 m3/(s.Pa)"

[cylinder.friction]
model = "lugre"
coulomb = "{friction} N"
static = "{static} N"
stribeck_velocity = "10 mm/s"
bristle_stiffness = "{bristle} MN/m"
bristle_damping = "{bristle} kN.s/m"
viscous = "{viscous} N.s/m"
"""

MOTOR = """
[motor]
displacement = "{displacement} cc/rev"
stroke = "270 deg"
inertia = "{inertia} kg.m2"
dead_volume = "{dead} mL"
internal_leakage = "2e-13 m3/(s.Pa)"
case_leakage = "1e-13 m3/(s.Pa)"

[motor.friction]
model = "lugre"
coulomb = "{friction} N.m"
static = "{static} N.m"
stribeck_velocity = "0.25 rad/s"
bristle_stiffness = "{bristle} kN.m/rad"
bristle_damping = "{bristle_damping} N.m.s/rad"
viscous = "{viscous} N.m.s/rad"
"""

LINKAGE = """
[linkage]
kind = "triangle"
cylinder_pivot = "300 mm"
rod_pivot = "50 mm"
retracted_length = "260 mm"
angle_offset = "30 deg"
"""


def hose(bore, expansion, length, stiffening=1.5):
    """Expansion in mL/m at 210 bar, length in m."""
    return (
        f'bore = "{bore} mm"\nvolumetric_expansion = "{expansion} mL/m"\nvolumetric_expansion_pressure = "210 bar"\n'
        f'dynamic_stiffening = {stiffening}\nworking_pressure = "350 bar"\nlength = "{length} m"'
    )


def pipe(bore, length):
    return f'pipe = {{ bore = "{bore} mm" }}\nlength = "{length} m"'


def cylinder(title, piston, rods, stiffness, load_mass, force, line, sample_ms, step, **other):
    """Stiffness in kN/mm: softest, nominal, stiffest; force in kN before and after the step; step in % and s."""
    area = 0.785e-6 * (piston**2 - max(rods) ** 2)
    values = {
        "title": title, "pressure": 210, "flow": 60, "valve_flow": 40, "leakage": 0.9, "valve_frequency": 100,
        "sensor": "500 MN/m", "stiffness": stiffness, "stiffness_unit": "kN/mm", "mass": f"{load_mass} kg",
        "damping": f"{round(0.04 * (stiffness[1] * 1e6 * load_mass) ** 0.5)} N.s/m", "position": "100 mm", "force": force,
        "force_unit": "kN", "overshoot": step[0], "settling": step[1], "sample_ms": sample_ms, "delay_ms": sample_ms,
        "duration": 0.1 + 6 * step[1], "line": line, "piston": piston, "rods": rods, "stroke": 200,
        "moving": round(max(1.0, 5e3 * area), 1), "dead": 40, "viscous": 1500, "friction": round(area * 1e5),
        "bristle": max(5, round(area * 1e4)),
    }  # fmt: skip
    values |= other
    values["step"] = round(force[1] - force[0], 6)
    values["capacity"] = f"{round(area * values['pressure'] * 1e2)} kN"
    values["noise"] = f"{max(1, round(area * values['pressure'] * 1e5 * 1e-4))} N"
    values["static"] = round(1.4 * values["friction"])
    values |= {"low": 0.9 * values["pressure"], "high": 1.1 * values["pressure"]}
    return (HEAD + CYLINDER).format(**values)


def motor(title, displacement, inertia, stiffness, mass, torque, line, sample_ms, step, **other):
    """Stiffness in N.m/rad, torque in N.m."""
    values = {
        "title": title, "pressure": 140, "flow": 40, "valve_flow": 20, "leakage": 0.5, "valve_frequency": 120,
        "sensor": "60 kN.m/rad", "noise": f"{round(1e-4 * displacement * 2.2, 3)} N.m",
        "capacity": f"{round(displacement * 2.5)} N.m", "stiffness": stiffness, "stiffness_unit": "N.m/rad",
        "mass": f"{mass} kg.m2", "damping": f"{round(0.06 * (stiffness[1] * mass) ** 0.5, 3)} N.m.s/rad",
        "position": "135 deg", "force": torque, "force_unit": "N.m", "overshoot": step[0], "settling": step[1],
        "sample_ms": sample_ms, "delay_ms": sample_ms, "duration": 0.1 + 6 * step[1], "line": line,
        "displacement": displacement, "inertia": inertia, "dead": 20, "friction": round(displacement * 0.01, 2),
        "bristle": round(displacement * 0.04, 2), "bristle_damping": round(displacement * 0.02, 2),
        "viscous": round(displacement * 0.008, 2), "low": 126, "high": 154,
    }  # fmt: skip
    values |= other
    values["static"] = round(1.4 * values["friction"], 2)
    values["step"] = round(torque[1] - torque[0], 6)
    return (HEAD + MOTOR).format(**values)


def knee(title, stiffness, inertia, torque_force, line, sample_ms, step):
    """Stiffness of the ground in N.m/rad; forces of the rod in kN."""
    text = cylinder(
        title, 16, (0, 10), stiffness, inertia, torque_force, line, sample_ms, step, pressure=160, flow=20, valve_flow=7.5,
        leakage=0.3, valve_frequency=200, sensor="5 MN/m", stiffness_unit="N.m/rad", mass=f"{inertia} kg.m2",
        damping=f"{round(0.1 * (stiffness[1] * inertia) ** 0.5, 2)} N.m.s/rad", position="40 mm", stroke=80, moving=0.4,
        dead=1.5, friction=3, bristle=2, viscous=150,
    )  # fmt: skip
    return text.replace('bristle_damping = "2 kN.s/m"', 'bristle_damping = "100 N.s/m"') + LINKAGE


RIGS = {
    "fatigue": cylinder("Fatigue rig, symmetric, 1 kHz", 63, (45, 45), (4, 10, 20), 60, (5, 10), hose(9.5, 2.2, 1.5), 1, (2, 0.2)),
    "structure": cylinder("Structural rig, 1 kHz", 80, (0, 56), (5, 15, 30), 250, (30, 50), hose(12.7, 4, 3), 1, (2, 0.25)),
    "press": cylinder("Press of 300 kN, pipes, 500 Hz", 125, (0, 90), (20, 50, 100), 500, (80, 140), pipe(20, 3), 2, (3, 0.5),
                      pressure=280, valve_flow=100, valve_frequency=60, leakage=2.5, flow=150, dead=200),
    "soft": cylinder("Soft specimen, pipes, 2 kHz", 40, (25, 25), (0.2, 0.5, 1.0), 20, (1, 3), pipe(8, 1), 0.5, (3, 0.4),
                     valve_flow=20, leakage=0.4, valve_frequency=150),
    "stiff": cylinder("Stiff specimen, 5 kHz", 63, (45, 45), (50, 80, 150), 40, (5, 15), hose(9.5, 2.2, 2), 0.2, (2, 0.15)),
    "slow": cylinder("Slow computer, 200 Hz", 63, (0, 36), (2, 5, 10), 100, (5, 12), hose(9.5, 2.2, 2), 5, (5, 1.0)),
    "manifold": cylinder("Valve on the cylinder, 1 kHz", 100, (70, 70), (10, 20, 40), 300, (20, 60), pipe(16, 0.3), 1, (3, 0.3)),
    "long": cylinder("Hoses of 5 m, 1 kHz", 50, (0, 36), (1, 2.5, 5), 80, (3, 7), hose(9.5, 2.2, 5), 1, (3, 0.4)),
    "vane": motor("Vane between hoses, 1 kHz", 400, 0.02, (8000, 16000, 30000), 0.05, (100, 250), hose(9.5, 2.2, 1.5), 1, (3, 0.3)),
    "motor": motor("Motor between pipes, 500 Hz", 100, 0.008, (500, 1500, 4000), 0.2, (20, 60), pipe(8, 1), 2, (5, 0.6)),
    "knee": knee("Knee between hoses, 1 kHz", (500, 900, 2000), 0.6, (0.6, 1.0), hose(5, 0.8, 0.5), 1, (5, 0.3)),
    "ankle": knee("Knee on a stiff ground, 2 kHz", (2000, 4000, 8000), 0.3, (0.6, 1.2), hose(5, 0.8, 0.8), 0.5, (5, 0.25)),
}  # fmt: skip


def asked(phea, *words):
    """The answer of a command as JSON, and the seconds of processor it took."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    run = subprocess.run([phea, *words, "--json"], capture_output=True, text=True)
    took = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    if run.returncode not in (0, 1):
        raise RuntimeError(run.stderr)
    return json.loads(run.stdout), took


def studied(phea, name, folder):
    """A row of the table: title, status, time, order, trial on the nonlinear rig, satisfied runs, worst run."""
    path = folder / f"{name}.toml"
    path.write_text(RIGS[name])
    design, took = asked(phea, "design", path, "--out", folder / name)
    orders = " and ".join(str(len(design[part]["poles"])) for part in ("controller", "prefilter") if design.get(part))
    machine = design.get("machine") or {}
    words = [machine.get("verdict", "-"), machine.get("requirements", "-")]
    row = [RIGS[name].split('title = "')[1].split('"')[0], design["status"], orders, f"{took:.0f} s", *words]
    written = folder / name / "designed.toml"
    if design["status"] != "met" or not written.exists():
        return [*row, "-", "-"]
    runs = folder / f"{name}_runs"
    shutil.rmtree(runs, ignore_errors=True)
    campaign, _ = asked(phea, "campaign", written, "--runs", str(RUNS), "--seed", "1", "--out", runs)
    held = campaign["requirements"][0]
    required = "{overshoot_percent:g} %, {settling_time_s:g} s".format(**held["required"])
    with open(runs / "runs.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    completed = [[float(row[f"event1_{one}"]) for one in METRICS] for row in rows if row["status"] == "completed"]
    undetermined = len(rows) - len(completed)
    satisfied = f"{held['satisfied']} of {held['runs']}" + (f", {undetermined} undetermined" if undetermined else "")
    overshoot, settling = max(completed, key=lambda one: max(reached / held["required"][name] for name, reached in zip(METRICS, one)))
    return [*row, satisfied, f"{overshoot:.3g} %, {settling:.3g} s for {required}"]


def main(arguments):
    phea = pathlib.Path(arguments[0]).resolve()
    folder = ROOT / "target" / "rigs"
    folder.mkdir(parents=True, exist_ok=True)
    print("| rig | design | order | designed in | nonlinear | required | runs that satisfy | worst run |")
    print("|---|---|---|---|---|---|---|---|")
    for name in arguments[1:] or RIGS:
        print("|", " | ".join(studied(phea, name, folder)), "|", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
