"""Counts how many discs of 95 % of `phea identify --of response` hold the true response.

    python comparisons/response_coverage.py PHEA [--recordings 200] [--only KIND] [--case LOOP]

For each excitation, in the open loop, with noise on the recorded input too, and in the closed loop with and without
the reference in the file, and without it where the project declares the controller, or one of another gain: recordings
that gave a response, were refused, or were warned of; discs; the percentage of them that hold the truth, over all
frequencies and at the worst of ten bands; the median radius over the response.

Then pairs of records of one operating point at two amplitudes: how many of them are reported to differ, of the linear plant
and of one with a dead band.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile

import numpy as np

import response_records as records

# knowledge of the loop: none, its reference, or its controller as a gain times that of the test
NOTHING, REFERENCE = None, "reference"
CASES = [
    ("open", records.OPEN, dict(), NOTHING),
    ("open, noise on both", records.OPEN, dict(input_noise=0.02), NOTHING),
    ("closed, reference", records.CLOSED, dict(output_noise=1.0), REFERENCE),
    ("closed, none", records.CLOSED, dict(output_noise=1.0), NOTHING),
    ("closed, controller", records.CLOSED, dict(output_noise=1.0), 1.0),
]
# what is declared as the controller, over that of the test
CASES += [(f"closed, controller times {gain}", *CASES[-1][1:3], gain) for gain in (0.5, 0.8, 0.95, 1.05, 1.25, 2.0)]


def identified(phea, columns, known, folder):
    """The member of JSON, or the text of a refusal."""
    path = pathlib.Path(folder) / "record.csv"
    time, reference, given, shown = columns
    table, names = ([time, reference, given, shown], "time_s,set_point,input,output")
    if known != REFERENCE:
        table, names = ([time, given, shown], "time_s,input,output")
    np.savetxt(path, np.column_stack(table), "%.10g", ",", header=names, comments="")
    named = [str(path)]
    if isinstance(known, float):
        declared = path.with_name("rig.toml")
        declared.write_text(records.project(known))
        named = [str(declared)]
    done = subprocess.run([phea, "identify", "--of", "response", *named, "--json"], capture_output=True, text=True)
    if done.returncode not in (0, 1):
        return None, done.stderr + done.stdout
    (member,) = json.loads(done.stdout)["response"]["members"]
    return member, None


def errors(member):
    """rad/s, |error|/radius and radius/|truth| of each row."""
    rows = member["frequencies"]
    of = {name: np.array([row[name] for row in rows], float) for name in rows[0]}
    response = 10 ** (of["magnitude_db"] / 20) * np.exp(1j * np.radians(of["phase_deg"]))
    true = records.truth(of["frequency_rad_per_s"])
    return of["frequency_rad_per_s"], np.abs(response - true) / of["confidence_95"], of["confidence_95"] / abs(true)


def counted(phea, kind, case, count):
    name, loop, how, known = case
    given, refused, warned, why = [], 0, 0, ""
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(count):
            columns = records.recording(kind, loop, seed, **how)
            member, text = identified(phea, columns, known, folder)
            if member is None or not member["frequencies"]:
                refused, why = refused + 1, text
                continue
            warned += bool(member.get("warnings"))
            given.append(errors(member))
    if not given:
        return dict(kind=kind, case=name, given=0, refused=refused, warned=0, why=why)
    at, off, radius = (np.concatenate(values) for values in zip(*given))
    held = off <= 1
    bands = np.array_split(np.argsort(at, kind="stable"), 10)
    return dict(
        kind=kind,
        case=name,
        given=len(given),
        refused=refused,
        warned=warned,
        discs=held.size,
        held=100 * held.mean(),
        lowest=min(100 * held[band].mean() for band in bands if band.size),
        worst=off.max(),
        radius=100 * np.median(radius),
        why=why,
    )


# the amplitudes of two records, and the dead band of the plant
LEVELS = [("linear, ten times the amplitude", (0.2, 2.0), 0.0), ("linear, twice the amplitude", (0.5, 1.0), 0.0)]
LEVELS += [("dead band of 0.2, three times the amplitude", (0.5, 1.5), 0.2)]


def differ(phea, kind, case, seed):
    """True where phea reports that the records of two amplitudes differ; None where it compares nothing."""
    _, amplitudes, dead_band = case
    with tempfile.TemporaryDirectory() as folder:
        names = [f"{index}.csv" for index in range(len(amplitudes))]
        for name, amplitude in zip(names, amplitudes):
            columns = np.column_stack(records.at_amplitude(kind, seed, amplitude, dead_band))
            np.savetxt(pathlib.Path(folder) / name, columns, "%.10g", ",", header="time_s,input,output", comments="")
        declared = pathlib.Path(folder) / "rig.toml"
        declared.write_text(records.project_of_levels(names))
        done = subprocess.run([phea, "identify", "--of", "response", str(declared), "--json"], capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stderr
    (comparison,) = json.loads(done.stdout)["response"]["comparisons"]
    assert comparison["false_alarm_probability"] == 0.05, comparison
    return comparison["differences"] > 0 if comparison["frequencies"] else None


def reported(phea, kind, case, count):
    """How many pairs are reported to differ, and how many are compared."""
    found = [one for one in (differ(phea, kind, case, seed) for seed in range(count)) if one is not None]
    return sum(found), len(found)


def main():
    reader = argparse.ArgumentParser()
    reader.add_argument("phea")
    reader.add_argument("--recordings", type=int, default=200)
    reader.add_argument("--only")
    reader.add_argument("--case")
    asked = reader.parse_args()
    print("| excitation | loop | estimated | refused | warned | discs | held (%) | worst band (%) | worst error (radii) | radius (%) |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for case in CASES:
        for kind in records.KINDS:
            if (asked.only and asked.only != kind) or (asked.case and asked.case != case[0]):
                continue
            row = counted(asked.phea, kind, case, asked.recordings)
            line = f"| {row['kind']} | {row['case']} | {row['given']} | {row['refused']} | {row['warned']} |"
            if row["given"]:
                line += f" {row['discs']} | {row['held']:.1f} | {row['lowest']:.1f} | {row['worst']:.1f} | {row['radius']:.1f} |"
            else:
                line += f" {row['why'][:160]!r}"
            print(line, flush=True)
    print("\n| two amplitudes | excitation | reported to differ |\n|---|---|---|")
    for case in LEVELS:
        for kind in records.KINDS:
            if (asked.only and asked.only != kind) or (asked.case and asked.case != case[0]):
                continue
            told, compared = reported(asked.phea, kind, case, asked.recordings)
            print(f"| {case[0]} | {kind} | {told} of {compared} |", flush=True)


if __name__ == "__main__":
    main()
