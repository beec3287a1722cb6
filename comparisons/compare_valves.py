"""Compares `phea identify` with the truth of servovalves whose recordings are made here, by equations that share no code with phea.

    python comparisons/compare_valves.py [--seeds N] [--verified N] [--only WORD] [--jobs N] [--kept FILE] [PHEA]

PHEA is also the variable PHEA, or without either what cargo builds. Nearly all of the time is phea's, so that `--jobs` processes share the processors.
`--kept` names a file to which the answer to each recording is added; a recording whose answer is in it is not made again, so that a long count can be
stopped and continued.

`valve_records.py` makes the recordings. Of valves that phea's model matches, 95 % of the 95 % intervals must hold the truth, and no misfit may be
reported; of the others it must be, and `phea verify` of a project that takes its valve from such recordings must not return "met". Cases that need
what phea lacks today are counted and printed, and nothing is required of them. The tables of theory/valve_tests.md are printed.
"""

import argparse
import collections
import concurrent.futures
import dataclasses
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

from valve_records import BAR, LITRE_PER_MINUTE, TARE_PRESSURE, Bench, Meter, Valve, recordings

ROOT = pathlib.Path(__file__).resolve().parent.parent
RIG = ROOT / "examples/ybitu/identified.toml"
SEEDS = 2
# Parts of the model that phea lacks; the cases of a part that is deleted here are required to match.
LACKING = set()

# Table 5.1 of Ledezma (2019), values obtained via optimization, and section 5.2.1
THESIS = Valve((3.2e-7, 2.5e-7, 2.0e-7, 3.85e-7), (2.35e-9, 2.2e-9, 1.7e-9, 2.35e-9), 100.0, 7.55e-6, 0.014, 0.128)
# 10 L/min at 70 bar, all edges alike, and 100 L/min
SMALL = Valve((8.9e-8,) * 4, (7e-10,) * 4, 70.0, 2.5e-6, -0.04, 0.2, one_curve=True)
LARGE = Valve((9.1e-7, 8.7e-7, 8.8e-7, 9.3e-7), (6.5e-9, 5.8e-9, 6.1e-9, 7.0e-9), 130.0, 1.2e-5, 0.03, 0.08)
# Table A.1; a gear meter shows the direction
CT60 = Meter(60 * LITRE_PER_MINUTE, 0.05 * LITRE_PER_MINUTE, 3 * LITRE_PER_MINUTE, True, 2 * BAR)
LT5 = Meter(5 * LITRE_PER_MINUTE, 0.005 * LITRE_PER_MINUTE, 0.1 * LITRE_PER_MINUTE, True, 5 * BAR)
BIG_GEAR = Meter(150 * LITRE_PER_MINUTE, 0.1 * LITRE_PER_MINUTE, drop=3 * BAR)
GEAR = Meter(30 * LITRE_PER_MINUTE, 0.02 * LITRE_PER_MINUTE, drop=1.5 * BAR)
ORDINARY = Bench(((GEAR, 0.3),), LT5)


@dataclasses.dataclass(frozen=True)
class Case:
    name: str
    valve: Valve
    bench: Bench
    part: str | None = None        # the part of the model that it needs, where phea did not always have it

    @property
    def is_required(self):
        return self.part not in LACKING


def thesis(name, valve=None, part=None, **bench):
    return Case(name, dataclasses.replace(THESIS, **(valve or {})), dataclasses.replace(ORDINARY, **bench), part)


MATCHED = [
    thesis("the thesis' valve, two turbines", metering=((CT60, 0.3), (LT5, 0.13))),
    Case("10 L/min, equal edges, one curve", SMALL,
         dataclasses.replace(ORDINARY, metering=((GEAR, 1.0),), leakage_amplitude=0.5, gain_amplitude=0.08)),
    Case("100 L/min at 140 bar", LARGE, Bench(((BIG_GEAR, 0.6),), LT5, supply=140 * BAR, wander=0.4 * BAR)),
    thesis("command recorded with noise of 2 mV", command_noise=2e-3),
    thesis("12-bit converters", bits=12),
    thesis("oil that warms by 2 degC", oil=(39.0, 41.0, 40.0)),
    thesis("jitter, gaps and 1 % of outliers", rough=True),
    thesis("flow meter, gain error within 0.5 %", gain_error=0.005),
    thesis("transducer, zero error within 0.3 bar", part="zero error", zero_error=0.3 * BAR),
    thesis("overlap of 0.3 %", {"lap": (0.003, 0.003)}, part="lap"),
    thesis("underlap of 0.5 %", {"lap": (-0.005, -0.005)}, part="lap"),
    thesis("flow that saturates, s = 0.5", {"saturation": 0.5}, part="saturation"),
    thesis("no row where the command turns", part="turn", sample=0.37),
    thesis("recorded after cycles", part="memory", cycled=True),
    thesis("slow spool of 30 Hz", part="spool", frequency=188.0),
    thesis("flow that saturates, s = 0.05", {"saturation": 0.05}, part="saturation"),
    thesis("1 % of the commands recorded wrong", part="commands", lost_commands=0.01),
]
MISMATCHED = [
    thesis("opening clipped at 60 % of the test", {"clip": 0.18}),
    thesis("supply that sags, not recorded", sag=0.5 * BAR / LITRE_PER_MINUTE),
    thesis("flow recorded late by 5 % of a period", delay=0.05),
    thesis("leak from port A to the tank", {"external": 5e-10}),
    thesis("hysteresis that grows with amplitude", {"growing": 3.0}),
    thesis("pressure at B reads 10 % high", gain_b=1.1),
    thesis("laps 0.3 % apart at both ports", {"uneven": 0.003}),
]


def truths(case, tare_pressure):
    """Each coefficient's path in the JSON, and its value; the tare flow goes with the root of the pressure."""
    valve = case.valve
    edges = ("supply_to_a", "a_to_tank", "supply_to_b", "b_to_tank")
    found = {f"flow_coefficients.{edge}": value for edge, value in zip(edges, valve.flow)}
    found |= {f"leakage_coefficients.{edge}": value for edge, value in zip(edges, valve.leakage)}
    found |= {"leakage_shape": valve.shape, "tare_flow_m3_per_s": valve.tare * math.sqrt(tare_pressure / TARE_PRESSURE),
               "null_bias_v": valve.bias, "hysteresis_v": valve.hysteresis}
    if case.part == "lap":
        found |= {"lap.positive": valve.lap[0], "lap.negative": valve.lap[1]}
    if case.part == "saturation":
        found["saturation"] = valve.saturation
    return found


def project(bench, files):
    """The rig's project with these recordings in place of its own, and what their instruments are wrong by."""
    text = RIG.read_text()
    accuracy = ""
    if bench.zero_error:
        accuracy = f'pressure_a = {{ accuracy = "{bench.zero_error / BAR} bar" }}\n'
    tables = []
    for name in files:
        own = f'flow = {{ accuracy = "{100 * bench.gain_error} %" }}\n' if bench.gain_error and name.startswith("metering") else ""
        tables.append(f'[[identify.recording]]\nfile = "{name}"\n{accuracy}{own}')
    oil = f'[identify.oil_temperature]\nreference = "{bench.oil[2]} degC"\n\n' if bench.oil else ""
    recorded = re.compile(r"\[\[identify\.recording\]\].*?(?=\[cylinder\])", re.DOTALL)
    text, count = recorded.subn(lambda _: oil + "\n".join(tables) + "\n", text, count=1)
    assert count == 1, "the rig's project names no recordings"
    return text


def interval(path, found):
    """Value and ends of a coefficient's interval; nothing where it has none."""
    one = found
    for key in path.split("."):
        one = one.get(key) if one else None
    return [] if one is None or one["confidence_95"] is None else [one["value"], *one["confidence_95"]]


class Asked:
    """phea, and what it returned of each case: intervals, misfits, refusals and verdicts."""

    def __init__(self, phea):
        self.phea = phea
        self.found = collections.defaultdict(list)
        self.sets, self.misfits, self.refused = collections.Counter(), collections.Counter(), collections.Counter()
        self.verdicts = collections.defaultdict(collections.Counter)
        self.wrong = []

    def run(self, command, folder, bench):
        """JSON, or none where the command is refused with an error."""
        settings = {"valve.transition_pressure": '"1 Pa"', "supply.pressure": f'"{bench.supply / BAR} bar"',
                    "valve.natural_frequency": f'"{bench.frequency} rad/s"', "valve.damping_ratio": str(bench.damping)}
        words = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
        done = subprocess.run([self.phea, command, "rig.toml", "--json", *words], cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode not in (0, 1, 2) or (done.returncode == 2 and not re.search("^error:", done.stderr, re.MULTILINE)):
            sys.exit(f"{command} ended with {done.returncode}: {done.stderr}")
        return json.loads(done.stdout) if done.returncode < 2 else None

    def answer(self, case, index, seed, verified):
        """What phea says of one recording: misfit or refusal, the verdict, and of each coefficient the truth, value and interval."""
        files = recordings(case.valve, case.bench, np.random.default_rng([seed, index]))
        with tempfile.TemporaryDirectory() as folder:
            for file, text in {"rig.toml": project(case.bench, files), **files}.items():
                (pathlib.Path(folder) / file).write_text(text)
            found = self.run("identify", folder, case.bench)
            judged = self.run("verify", folder, case.bench) if verified else None
        verdict = (judged["verdict"] if judged else "refused") if verified else None
        given = {"case": case.name, "seed": seed, "refused": found is None, "verdict": verdict}
        if found is None:
            return given
        ends = {path: (truth, *interval(path, found)) for path, truth in truths(case, found["tare_pressure_pa"]).items()}
        return given | {"misfit": bool(found["misfits"]), "coefficients": ends}

    def count(self, given):
        """Of each interval: whether it holds, and the error over its deviation."""
        name = given["case"]
        self.sets[name] += 1
        if given["verdict"] is not None:
            self.verdicts[name][given["verdict"]] += 1
        if given["refused"]:
            self.refused[name] += 1
            return
        self.misfits[name] += given["misfit"]
        for path, (truth, *ends) in given["coefficients"].items():
            value, low, high = ends or (math.nan,) * 3
            self.found[name, path].append((low <= truth <= high, (value - truth) * 3.92 / (high - low)))

    def holding(self, cases, path=None):
        """How many intervals hold, and how many there are."""
        names = [case.name for case in cases]
        found = [held for (name, own), all_ in self.found.items() if name in names and path in (None, own) for held, _ in all_]
        return sum(found), len(found)

    def require(self, condition, what):
        if not condition:
            self.wrong.append(what)


def chance(probability, count):
    """Four standard deviations of a binomial distribution, and one more."""
    return 4 * math.sqrt(probability * (1 - probability) * count) + 1


def print_matched(asked, number, case):
    held, count = asked.holding([case])
    sets, lacking = asked.sets[case.name], "" if case.is_required else f" (lacking: {case.part})"
    print(f"| {number} {case.name}{lacking} | {held} of {count}, {100 * held / max(count, 1):.1f} % | {asked.misfits[case.name]} of {sets} "
          f"| {asked.refused[case.name]} of {sets} |", flush=True)


def print_mismatched(asked, case):
    reported, verdicts = asked.misfits[case.name] + asked.refused[case.name], asked.verdicts[case.name]
    print(f"| {case.name} | {reported} of {asked.sets[case.name]} | " + ", ".join(f"{count} {verdict}" for verdict, count in verdicts.items()) + " |",
          flush=True)


def print_coefficients(asked, cases):
    """Intervals that hold; errors over the deviations that the intervals state."""
    numbers = " | ".join(str(MATCHED.index(case) + 1) for case in cases)
    print(f"\n| coefficient | intervals that hold | mean error | root mean square | {numbers} |")
    print("|---" * (len(cases) + 4) + "|")
    required = [case for case in cases if case.is_required]
    for path in dict.fromkeys(path for _, path in asked.found):
        held, count = asked.holding(required, path)
        each = [asked.holding([case], path) for case in cases]
        errors = np.array([error for case in required for _, error in asked.found[case.name, path]])
        sizes = f"{errors.mean():+.2f} | {np.sqrt(np.mean(errors**2)):.2f}" if len(errors) else " | "
        print(f"| {path} | {held} of {count} | {sizes} | " + " | ".join(str(own) if all_ else "" for own, all_ in each) + " |")


def require_matched(asked, cases):
    held, count = asked.holding(cases)
    print(f"\nmatched: {held} of {count} intervals hold, {100 * held / max(count, 1):.1f} %")
    # intervals of one recording err together
    slack = 2 * chance(0.95, count)
    asked.require(0.93 * count - slack <= held <= 0.97 * count + slack, f"{held} of {count} intervals hold over all matched valves")
    sets, misfits = (sum(counted[case.name] for case in cases) for counted in (asked.sets, asked.misfits))
    asked.require(misfits <= 0.02 * sets + chance(0.02, sets), f"a misfit is reported of {misfits} of {sets} recordings that match")
    for case in cases:
        held, count = asked.holding([case])
        asked.require(held >= 0.9 * count - 2 * chance(0.95, count), f"{case.name}: {held} of {count} intervals hold")
        asked.require(not asked.refused[case.name], f"{case.name}: {asked.refused[case.name]} recordings are refused")
        # the rig's controller was designed for the first valve
        verdicts = asked.verdicts[case.name]
        asked.require(set(verdicts) <= {"met"}, f"{case.name}: `phea verify` returns {dict(verdicts)}")


def require_mismatched(asked, cases):
    for case in cases:
        verdicts = asked.verdicts[case.name]
        asked.require("met" not in verdicts, f"{case.name}: `phea verify` returns {dict(verdicts)}")
    sets = sum(asked.sets[case.name] for case in cases)
    reported = sum(asked.misfits[case.name] + asked.refused[case.name] for case in cases)
    asked.require(reported >= 0.95 * sets, f"a misfit is reported of {reported} of {sets} recordings that do not match")


def answers(asked, cases, given):
    """The answers to all recordings, seed by seed, those that were kept first."""
    wanted = [(case, index, seed, seed <= given.verified and (case in MISMATCHED or case is MATCHED[0]))
              for seed in range(1, given.seeds + 1) for index, case in cases]
    kept = pathlib.Path(given.kept) if given.kept else None
    known = [json.loads(line) for line in kept.read_text().splitlines()] if kept and kept.exists() else []
    known = {(one["case"], one["seed"]): one for one in known}
    missing = [one for one in wanted if (one[0].name, one[2]) not in known]
    yield from (known[case.name, seed] for case, _, seed, _ in wanted if (case.name, seed) in known)
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        for one in pool.map(lambda arguments: asked.answer(*arguments), missing):
            if kept:
                with kept.open("a") as file:
                    file.write(json.dumps(one) + "\n")
            yield one


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=SEEDS)
    parser.add_argument("--verified", type=int, default=1, help="seeds for which `phea verify` is run")
    parser.add_argument("--only", default="", help="a part of the names of the cases that are run")
    parser.add_argument("--jobs", type=int, default=1, help="recordings at once")
    parser.add_argument("--kept", help="file of the answers")
    parser.add_argument("phea", nargs="?", default=os.environ.get("PHEA", str(ROOT / "target/debug/phea")))
    given = parser.parse_args()
    asked = Asked(given.phea)
    # the number of a case seeds its noise
    cases = [(index, case) for index, case in [*enumerate(MATCHED), *enumerate(MISMATCHED, 100)] if given.only in case.name]
    for one in answers(asked, cases, given):
        asked.count(one)
    matched, mismatched = ([case for _, case in cases if case in group] for group in (MATCHED, MISMATCHED))
    print("| valve | intervals that hold | misfit reported | refused |\n|---|---|---|---|")
    for case in matched:
        print_matched(asked, MATCHED.index(case) + 1, case)
    if mismatched:
        print("\n| not matched | misfit reported or refused | verdicts |\n|---|---|---|")
    for case in mismatched:
        print_mismatched(asked, case)
    print_coefficients(asked, matched)
    require_matched(asked, [case for case in matched if case.is_required])
    require_mismatched(asked, mismatched)
    if asked.wrong:
        sys.exit("\n".join(asked.wrong))


if __name__ == "__main__":
    main()
