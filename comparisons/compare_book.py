"""Compares what the theory pages draw and quote, `book/curves.py`, with phea's own answers for examples/ybitu/hose.toml.

    python comparisons/compare_book.py [PHEA]        # or the variable PHEA; without either, what cargo builds

Pressures and commands of the valve at shut ports and unloaded, stiffness over hose lengths in both models, poles over them, bands in which
the closed loop gives energy, springs that make it unstable, the machine behind such a spring, and what a reduction of unequal areas costs.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "book"))

import curves  # noqa: E402

RIG = ROOT / "examples" / "ybitu" / "hose.toml"
WRONG = []


def ask(command, *settings, project=RIG, more=(), accepted=(0,)):
    arguments = sys.argv[1:2]
    built = [os.environ["PHEA"]] if "PHEA" in os.environ else None
    program = arguments or built or ["cargo", "run", "-q", "-p", "phea-cli", "--"]
    words = [word for setting in settings for word in ("--set", setting)]
    run = subprocess.run([*program, command, str(project), "--json", *words, *more], capture_output=True, text=True, cwd=ROOT)
    if run.returncode not in accepted:
        raise RuntimeError(f"phea {command} ended with {run.returncode}: {run.stderr.strip()[-800:]}")
    return json.loads(run.stdout)


def derived(*settings):
    return {entry["name"]: entry["value"] for entry in ask("check", *settings)["derived"]}


def equal(what, found, wanted, tolerance=1e-6):
    fine = np.allclose(found, wanted, rtol=tolerance, atol=1e-300)
    print(f"{'ok  ' if fine else 'FAIL'} {what}: {found} and {wanted}")
    if not fine:
        WRONG.append(what)


def valve():
    for force in (-8000, -4000, 0, 3958.4, 8000):
        point = derived(f"operating_point.load_force={force}")
        pressures = [point[f"operating_point.pressure_{side}"] for side in "ab"]
        equal(f"pressures at shut ports, {force} N", curves.blocked(point["operating_point.command"]), pressures)
    null = derived()
    equal("null pressures", curves.blocked(0.0), [null[f"operating_point.pressure_{side}"] for side in "ab"])
    for velocity in (-0.1, -0.02, 0.02, 0.05, 0.1):
        point = derived(f"operating_point.velocity={velocity}", "operating_point.load_force=0")
        equal(f"unloaded at {velocity} m/s", curves.unloaded(point["operating_point.command"]), curves.AREA * velocity)


def hoses():
    for length in (0.5, 1.0, 1.5, 2.0, 3.0):
        told = derived(f"line.length={length}")
        for model in ("uniform", "by_volume"):
            found = [curves.stiffness(length, place, model) for place in (curves.STROKE / 2, 0.0)]
            equal(f"K_H, {model}, {length} m", found, [told[f"stiffness.{model}.{end}"] for end in ("minimum", "maximum")])
    equal("E at 35 bar", curves.expansion(35e5), derived()["line.operating_expansion"])
    leak = derived()["linear.flow_pressure_coefficient"]
    answer = ask("linearize", more=("--sweep", "line.length=0.5 m..3 m", "--points", "6"))
    for row in answer["sweep"]:
        slow, pair = curves.poles(curves.stiffness(row["value"], curves.STROKE / 2, "uniform"), leak)
        poles = [complex(*pole) for pole in row["poles"]["derived"]]
        real = max(pole.real for pole in poles if pole.imag == 0)
        fast = max(poles, key=lambda pole: pole.imag)
        equal(f"poles with {row['value']} m", [slow, pair.real, pair.imag], [real, fast.real, fast.imag])


def closed(*settings):
    return ask("linearize", *settings)["passivity"]["closed_loop"]


def passivity():
    band = curves.active_band(curves.STIFFNESS)
    for sensor in (curves.SENSOR, 98.1e6, 1e5):
        (told,) = closed(f"force_sensor.stiffness={sensor}")["bands"]
        equal(f"band with a sensor of {sensor:g} N/m", band, told)
    least = curves.friction_for_passivity(curves.STIFFNESS)
    for share in (0.99, 1.01):
        friction = share * least
        settings = [f"uncertainty.viscous_friction.{end}={friction}" for end in ("nominal", "minimum")]
        equal(f"passive with {friction:.1f} N s/m", closed(*settings)["passive"], share > 1)
    first, last = curves.unstable_springs(curves.STIFFNESS)
    for spring, unstable in ((0.999 * first, False), (1.001 * first, True), (0.999 * last, True), (1.001 * last, False)):
        told = bool(closed(f"force_sensor.stiffness={spring}")["right_half_plane_poles"])
        equal(f"unstable against {spring:.4g} N/m", told, unstable)
        equal("the same by its poles", curves.closed_loop(curves.STIFFNESS, spring).real.max() > 0, unstable)


def machine():
    """The step of 4 kN on the nonlinear machine behind 2 MN/m: with f_v = 100 N s/m alone it swings, with bristles it settles."""
    text = RIG.read_text()
    start, end = text.index("[cylinder.friction]"), text.index("[line]")
    viscous = text[:start] + '[cylinder.friction]\nmodel = "viscous"\nviscous = 100\n\n' + text[end:]
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "viscous.toml"
        path.write_text(viscous)
        for project, sensor, quoted, digit in ((path, 2e6, 175, 5), (path, 20e6, 0.35, 0.005), (RIG, 2e6, 2.03, 0.005)):
            # a machine that swings for ever has exit status 1
            run = ask("simulate", f"force_sensor.stiffness={sensor}", project=project, accepted=(0, 1))
            told = run["scenarios"][0]["events"][0]["metrics"]
            overshoot = told["overshoot_percent"]
            equal(f"overshoot {overshoot:.4g} %, {project.stem}, {sensor:g} N/m", abs(overshoot - quoted) <= digit, True)


def reduction():
    text = RIG.read_text()
    edges = ("supply_to_a", "a_to_tank", "supply_to_b", "b_to_tank")
    tables = "".join(
        f"[valve.{name}]\n" + "".join(f"{edge} = {value}\n" for edge in edges)
        for name, value in (("flow_coefficients", 2.97e-7), ("leakage_coefficients", 2.402e-9))
    )
    start, middle, end = (text.index(part) for part in ("[valve.flow_coefficients]", "[cylinder]", "[uncertainty]"))
    with tempfile.TemporaryDirectory() as folder:
        for rod, model, place in ((0.022, "uniform", 0.0), (0.022, "by_volume", 0.5), (0.036, "uniform", 0.5)):
            rig = text[:start] + tables + text[middle:end] + f"[operating_point]\nposition = {place}\n"
            rig = rig.replace('rod_diameter = "22 mm"', f"rod_diameters = [0, {rod}]")
            rig = rig.replace('compliance = "uniform"', f'compliance = "{model}"')
            path = pathlib.Path(folder) / "rod.toml"
            path.write_text(rig)
            told = ask("linearize", project=path)["reduction_error"]
            area = np.pi / 4 * (0.05**2 - rod**2)
            found = curves.reduction_cost(area, place, model)[:2]
            equal(f"reduction, rod of {rod} m, {model}, x = {place}", found, [told["magnitude_db"], told["phase_deg"]], 1e-3)


for check in (valve, hoses, passivity, machine, reduction):
    check()
if WRONG:
    raise SystemExit(f"{len(WRONG)} part from phea: " + "; ".join(WRONG))
