"""Holds `phea identify --of response` against scipy.signal on the same records.

    python comparisons/compare_response.py [PHEA]        # or the variable PHEA; without either, what cargo builds

A filtered noise with noise in its output, and a multisine that repeats. For the first, SciPy's csd, welch and coherence
give H1 and the coherence; for the second, NumPy's transform of the averaged periods gives the response. Then the discs of
95 % of records that do not repeat, in the open and in the closed loop, from its reference or by its controller, hold the
response of SciPy's discretisation as often as they state, and a closed loop without either, or with a controller of half
the gain, is refused. Two records of a linear plant at two amplitudes are reported to differ as often as stated, those of a
plant with a dead band nearly always; `response_coverage.py` has more of them.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from scipy import signal

import response_coverage
import response_records

ROOT = pathlib.Path(__file__).resolve().parent.parent
PHEA = sys.argv[1] if len(sys.argv) > 1 else os.environ.get("PHEA", str(ROOT / "target/debug/phea"))
STEP = 1e-3


def identified(columns, *options):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "record.csv"
        np.savetxt(path, np.column_stack(columns), "%.17g", ",", header="time_s,input,output", comments="")
        command = [PHEA, "identify", "--of", "response", str(path), "--json", *options]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
    (member,) = json.loads(done.stdout)["response"]["members"]
    rows = member["frequencies"]
    of = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    response = 10 ** (of["magnitude_db"] / 20) * np.exp(1j * np.radians(of["phase_deg"]))
    return member, of["frequency_rad_per_s"] / (2 * np.pi), response, of


def noise():
    random = np.random.default_rng(17)
    time = np.arange(30_000) * STEP
    given = random.normal(size=time.size)
    shown = signal.lfilter([0.2], [1, -0.8], given) + 0.1 * random.normal(size=time.size)
    member, frequency, response, of = identified((time, given, shown), "--segment", "1 s", "--coherence", "0.5")
    assert member["method"] == "segments" and member["blocks"] == 59, member
    # phea leaves out the mean of the whole record, SciPy none
    how = dict(fs=1 / STEP, window=signal.get_window("hann", 1000), nperseg=1000, noverlap=500, detrend=False)
    given, shown = given - given.mean(), shown - shown.mean()
    at, cross = signal.csd(given, shown, **how)
    _, power = signal.welch(given, **how)
    _, coherent = signal.coherence(given, shown, **how)
    index = np.rint(frequency / at[1]).astype(int)
    assert np.allclose(at[index], frequency, rtol=1e-9) and index.size > 300
    expected = cross[index] / power[index]
    error = np.abs(response / expected - 1).max()
    assert error < 1e-9, error
    assert np.abs(of["coherence"] - coherent[index]).max() < 1e-9
    return error


def multisine():
    random = np.random.default_rng(4)
    period, repeats, lines = 700, 9, [1, 2, 5, 11, 23, 47]
    turns = np.outer(np.arange(period), lines) % period / period
    one = np.sin(2 * np.pi * (turns + np.arange(len(lines)) ** 2 / 7)).sum(axis=1)
    given = np.tile(one, repeats)
    shown = signal.lfilter([0.1], [1, -0.9], given) + 0.05 * random.normal(size=given.size)
    time = np.arange(given.size) * STEP
    member, frequency, response, _ = identified((time, given, shown))
    assert member["method"] == "periods" and member["blocks"] == repeats - 1, member
    averaged = [values.reshape(repeats, period)[1:].mean(axis=0) for values in (given, shown)]
    spectra = [np.fft.rfft(values) for values in averaged]
    index = np.rint(frequency * period * STEP).astype(int)
    assert list(index) == lines, index
    error = np.abs(response / (spectra[1][index] / spectra[0][index]) - 1).max()
    assert error < 1e-9, error
    return error


def held(kind, case, count=20):
    (case,) = [one for one in response_coverage.CASES if one[0] == case]
    row = response_coverage.counted(PHEA, kind, case, count)
    assert row["refused"] == 0 and row["warned"] == 0, row
    # 99.8 % of a binomial distribution
    least = 95 - 310 * (0.0475 / row["discs"]) ** 0.5
    assert row["held"] > least, row
    return f"{kind}, {case[0]}: {row['held']:.1f} % of {row['discs']}"


def refused():
    (case,) = [one for one in response_coverage.CASES if one[0] == "closed, none"]
    for kind in ["noise", "logarithmic sweep", "stepped sine"]:
        row = response_coverage.counted(PHEA, kind, case, 5)
        assert row["refused"] == 5 and "-1/C" in row["why"], row
    (case,) = [one for one in response_coverage.CASES if one[0] == "closed, controller times 0.5"]
    row = response_coverage.counted(PHEA, "noise", case, 5)
    assert row["refused"] == 5 and "[controller] was not that of the test" in row["why"], row


def levels(case, count=8):
    """Records of every excitation at two amplitudes: at most 5 % of those of a linear plant are reported to differ, but for chance."""
    (case,) = [one for one in response_coverage.LEVELS if one[0] == case]
    told, compared = np.sum([response_coverage.reported(PHEA, kind, case, count) for kind in response_records.KINDS], axis=0)
    assert compared == count * len(response_records.KINDS), compared
    if case[2]:
        # noise, which mixes all amplitudes of a record, shows a dead band in five of six pairs, the others in all
        assert told >= 0.9 * compared, f"{case[0]}: {told} of {compared}"
    else:
        # 99.9 % of a binomial distribution
        assert told <= 0.05 * compared + 3.1 * (0.0475 * compared) ** 0.5, f"{case[0]}: {told} of {compared}"
    return f"{case[0]}: {told} of {compared}"


print(f"H1 and coherence of noise: {noise():.1e}; multisine: {multisine():.1e} (relative difference from SciPy and NumPy)")
for kind in response_records.KINDS[1:]:
    print("95 % discs that hold:", held(kind, "open"))
for kind in ["noise", "logarithmic sweep", "PRBS"]:
    for case in ["closed, reference", "closed, controller"]:
        print("95 % discs that hold:", held(kind, case))
refused()
for case in response_coverage.LEVELS:
    print("reported to differ:", levels(case[0]))
