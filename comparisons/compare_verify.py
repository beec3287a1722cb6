"""Compares `phea verify` with an independent search over the same project files.

    python comparisons/compare_verify.py [--alone] [PHEA]        # or the variable PHEA; without either, what cargo builds

Each loop of the examples is evaluated from the text of its project file (loop_model.py), its worst margins are sought by
dense grids and SciPy's searches (worst_case.py), its stability and delay margin by poles, by the growth of the argument
where there is dead time, and by the states of the sampled loop (loop_stability.py). Three things are then demanded of
phea: what it reports for a plant and a frequency is true there; it found nothing milder than the search did; and its
verdicts, exit status and frequencies agree. `--alone` leaves phea out and compares the search with published numbers only.
"""

import concurrent.futures
import contextlib
import io
import json
import os
import pathlib
import subprocess
import sys
import time
import warnings

import numpy as np

import measured_plants
from loop_model import Project
from loop_stability import delay_margin, stability
from worst_case import Search, sides, worst_at, worst_margin

ROOT = pathlib.Path(__file__).resolve().parent.parent
EXAMPLES = ROOT / "examples"
MARGIN_TOLERANCE_DB = 0.01
VERDICT_TOLERANCE_DB = 0.001
FREQUENCY_TOLERANCE = 0.01
DELAY_TOLERANCE = 0.01
CONTROLLER_B = {"controller.numerator": "379*(s/42 + 1)", "controller.denominator": "s/165 + 1"}

# What is known of each loop from the literature or by closed forms: the worst margin of each specification in dB, in the
# order of the file, to half its last digit (None: nothing is known); whether it is stable.
LOOPS = [
    # file, settings, stable, worst margins, at design frequencies too
    ("qft/edge_plants.toml", {}, True, ["0.335", "0.014", "11.62"], True),
    ("qft/edge_plants.toml", CONTROLLER_B, True, ["-0.254", None, None], True),
    ("qft/servo.toml", {}, True, ["0.126", "-0.00004"], True),
    ("qft/servo_shaped.toml", {}, True, ["-0.024", None], True),
    ("qft/acc_benchmark.toml", {}, True, ["2.86"], True),
    ("qft/damped_resonance.toml", {}, True, ["-0.333"], True),
    ("qft/unstable_plant.toml", {}, False, [None], False),
    # |T| at rest is 3/(3 - 2.5) with 30 and 5/(5 - 2.5) with 50
    ("qft/unstable_plant.toml", {"controller.numerator": "30"}, True, ["-9.119"], False),
    ("qft/unstable_plant.toml", {"controller.numerator": "50"}, True, ["0.424"], True),
    ("qft/dead_time.toml", {}, True, [None, None, None], True),
    ("qft/dead_time.toml", {"controller.sample_time": "0.05 s", "controller.delay": "0.02 s"}, True, [None] * 3, True),
    ("qft/dead_time.toml", {"controller.sample_time": "0.2 s", "controller.delay": "0.2 s"}, True, [None] * 3, True),
    ("qft/load_frame.toml", {}, True, [None] * 3, True),
    ("qft/measured.toml", {}, True, [None] * 3, True),
    # the audit of Ledezma (2019): |T| = 11.887 and, with delay, 1.42, 1.13 and 1.52 against 1.3
    ("ybitu/hose.toml", {}, True, ["-19.222", "-8.2", "-6.08"], True),
    ("ybitu/hose.toml", {"controller.delay": "0.5 ms"}, True, ["-0.78", None, None], False),
    ("ybitu/hose.toml", {"controller.delay": "1 ms"}, True, ["1.19", None, None], False),
    ("ybitu/hose.toml", {"controller.delay": "1.5 ms"}, True, ["-1.36", None, None], False),
    ("ybitu/hose.toml", {"controller.sample_time": "1 ms", "controller.delay": "0.5 ms"}, True, [None] * 3, False),
    ("ybitu/pipe.toml", {}, True, [None] * 3, False),
]


class Findings:
    """What was found wrong, printed as it is found."""

    def __init__(self):
        self.wrong = []

    def demand(self, holds, message):
        if not holds:
            print("  WRONG:", message)
            self.wrong.append(message)


def half_a_digit(text):
    return 0.5 * 10.0 ** -len(text.partition(".")[2])


def plant_text(project, values):
    return ", ".join(f"{name} {value:.6g}" for name, value in zip(project.names * 2, values))


def recomputed(project, published, at_design, findings):
    """Stability, delay margin and worst cases, held to what is published."""
    search = Search(project)
    expected_stable, margins = published
    # measured plants of stable drives: a response does not show its poles, the loop is seen by its margins alone
    stable, slowest, plant = (True, None, None) if project.measured else stability(search)
    findings.demand(stable == expected_stable, f"stable: {stable}")
    delay = delay_margin(search)[0] if stable else None
    rate = "" if slowest is None else f", largest real part {slowest:.4g} 1/s at {plant_text(project, plant)}"
    print(f"  {'stable' if stable else 'unstable'}{rate}" + ("" if delay is None else f", delay margin {delay:.6g} s"))
    if not stable:
        return search, False, None, []
    found = []
    for specification, margin in zip(project.specifications, margins, strict=True):
        worst = worst_margin(search, specification)
        design = [(w, *worst_at(search, specification, w)) for w in specification["frequencies"]] if at_design else []
        print(f"  {specification['kind']:24s} {worst[0]:9.4f} dB at {worst[1]:.6g} rad/s, {plant_text(project, worst[2])}")
        if design:
            print("    " + "  ".join(f"{w:g}: {m:.3f}" for w, m, _, _ in design))
        if margin is not None:
            tolerance = half_a_digit(margin)
            findings.demand(abs(worst[0] - float(margin)) <= tolerance * 1.001, f"published {margin}, found {worst[0]:.6f} dB")
        found.append((worst, design))
    return search, True, delay, found


def phea_answer(program, path, settings):
    arguments = [f"--set={place}={json.dumps(value)}" for place, value in settings.items()]
    run = subprocess.run([*program, "verify", str(path), "--json", *arguments], capture_output=True, text=True, cwd=ROOT)
    if run.returncode not in (0, 1):
        raise RuntimeError(f"phea verify {path} ended with {run.returncode}: {run.stderr.strip()[-800:]}")
    return run.returncode, json.loads(run.stdout)


def plant_of(project, told):
    """The parameters that phea reports, as this script orders them."""
    if project.measured:
        names = [pathlib.Path(name).stem for name in project.table["family"]["measured"]]
        text = json.dumps(told)
        matches = [index for index, name in enumerate(names) if f"{name}.csv" in text or f'"{name}"' in text]
        return np.array([float(matches[0])])
    return np.array([told[name] for name in project.names], dtype=float)


def margin_there(project, specification, told, frequency):
    values = plant_of(project, told)
    spread = specification["kind"] == "tracking" and not project.has_prefilter
    if spread:
        return None
    w = np.array(max(frequency, 1e-12))
    return min(float(side.margin(values, w)) for side in sides(project, specification))


def is_interior(search, specification, frequency):
    low, high = search.band(specification)
    return low * 1.01 < frequency < high / 1.01


def compare_specification(search, specification, told, ours, findings):
    project, (worst, design) = search.project, ours
    margin, frequency = told["worst_margin_db"], told["frequency_rad_per_s"]
    name = specification["kind"]
    findings.demand(told["kind"] == name, f"{told['kind']} instead of {name}")
    expected = "met" if worst[0] >= -VERDICT_TOLERANCE_DB else "violated"
    findings.demand(told["verdict"] == expected, f"{name}: {told['verdict']} instead of {expected} ({worst[0]:.4f} dB)")
    if margin is None or margin == "inf":
        return findings.demand(False, f"{name}: no margin, {told.get('reason')}")
    message = f"{name}: {margin:.5f} dB, found {worst[0]:.5f} at {worst[1]:.6g} rad/s, {worst[2]}"
    findings.demand(margin <= worst[0] + MARGIN_TOLERANCE_DB, message)
    if margin < worst[0] - MARGIN_TOLERANCE_DB:
        print(f"  note: {name}: phea found {margin:.5f} dB, the search only {worst[0]:.5f}")
    there = margin_there(project, specification, told["plant"], frequency)
    if there is not None:
        message = f"{name}: {margin:.6f} dB reported, {there:.6f} at that plant and {frequency:.6g} rad/s"
        findings.demand(abs(there - margin) < 1e-4, message)
    inside = told.get("interior")
    if inside and there is not None:
        true = margin_there(project, specification, inside["plant"], inside["frequency_rad_per_s"])
        message = f"{name}: interior {inside['margin_db']} dB reported, {true} at that plant"
        findings.demand(abs(true - inside["margin_db"]) < 1e-4, message)
    if is_interior(search, specification, worst[1]):
        near = abs(frequency / worst[1] - 1) <= FREQUENCY_TOLERANCE
        findings.demand(near, f"{name}: worst at {frequency:.6g}, found at {worst[1]:.6g} rad/s")
    for (w, value, _, at), entry in zip(design, told["at_design_frequencies"]):
        findings.demand(entry["frequency_rad_per_s"] == w, f"{name}: {entry['frequency_rad_per_s']} instead of {w} rad/s")
        close = abs(entry["margin_db"] - value) <= MARGIN_TOLERANCE_DB
        findings.demand(close, f"{name} at {w:g} rad/s: {entry['margin_db']:.5f} dB, found {value:.5f} at {at}")
    if design:
        findings.demand(len(told["at_design_frequencies"]) == len(design), f"{name}: not every design frequency")


def compare(program, search, mine, findings):
    project, (stable, delay, found) = search.project, mine
    status, answer = phea_answer(program, project.path, project.settings)
    margins = [worst[0] for worst, _ in found]
    met = stable and all(margin >= -VERDICT_TOLERANCE_DB for margin in margins)
    findings.demand(answer["stable"] == stable, f"phea: stable is {answer['stable']}")
    findings.demand(answer["verdict"] == ("met" if met else "violated"), f"phea: verdict {answer['verdict']}, met is {met}")
    findings.demand(status == (0 if met else 1), f"phea: exit status {status}")
    if not stable:
        return
    told = answer["delay_margin_s"]
    told = np.inf if told == "inf" else told
    fine = told is not None and (told == delay or abs(told / delay - 1) <= DELAY_TOLERANCE)
    findings.demand(fine, f"phea: delay margin {told}, found {delay}")
    for specification, entry, ours in zip(project.specifications, answer["specifications"], found, strict=True):
        compare_specification(search, specification, entry, ours, findings)


def judge_loop(loop, program):
    """One loop in a process of its own: what is to be printed, and what was found wrong."""
    path, settings, stable, margins, at_design = loop
    warnings.filterwarnings("ignore", category=RuntimeWarning)  # infinities at poles on the axis are discarded
    findings, told = Findings(), io.StringIO()
    with contextlib.redirect_stdout(told):
        began = time.process_time()
        print(path, *(f"{place}={value}" for place, value in settings.items()))
        search, *mine = recomputed(Project(EXAMPLES / path, settings), (stable, margins), at_design, findings)
        print(f"  {time.process_time() - began:.1f} s")
        if program is not None:
            compare(program, search, mine, findings)
    return told.getvalue(), findings.wrong


def main(arguments):
    alone = "--alone" in arguments
    named = [argument for argument in arguments if argument != "--alone"]
    built = [os.environ["PHEA"]] if "PHEA" in os.environ else None
    program = named or built or ["cargo", "run", "-q", "-p", "phea-cli", "--"]
    findings = Findings()
    for name in measured_plants.PLANTS:
        same = (measured_plants.FOLDER / f"{name}.csv").read_text() == measured_plants.text(name)
        findings.demand(same, f"{name}.csv is not what measured_plants.py writes")
    with concurrent.futures.ProcessPoolExecutor() as processes:
        judged = [processes.submit(judge_loop, loop, None if alone else program) for loop in LOOPS]
        for told, wrong in (each.result() for each in judged):
            print(told, end="", flush=True)
            findings.wrong.extend(wrong)
    print(f"{len(LOOPS)} loops, {len(findings.wrong)} wrong")
    return 1 if findings.wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
