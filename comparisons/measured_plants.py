"""Writes the measured responses of examples/qft/measured: a known resonant plant, as an analyser would record it.

    python comparisons/measured_plants.py

P = k w^2/((s + 2) (s^2 + 2 d w s + w^2)), five plants, free of noise. compare_verify.py asserts that the files hold this.
"""

import csv
import io
import pathlib

import numpy as np

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "examples" / "qft" / "measured"
HEADER = ["frequency_rad_per_s", "magnitude_db", "phase_deg"]
# k, w, d: the same drive with five loads
PLANTS = {
    "no_load": (40.0, 80.0, 0.08),
    "light": (38.0, 74.0, 0.08),
    "medium": (36.0, 68.0, 0.09),
    "heavy": (33.0, 63.0, 0.10),
    "heaviest": (30.0, 58.0, 0.11),
}
FREQUENCIES = np.round(np.geomspace(0.5, 500.0, 181), 6)


def response(k, w, d, frequency):
    s = 1j * frequency
    return k * w**2 / ((s + 2) * (s**2 + 2 * d * w * s + w**2))


def text(name):
    value = response(*PLANTS[name], FREQUENCIES)
    magnitude, phase = 20 * np.log10(np.abs(value)), np.degrees(np.unwrap(np.angle(value)))
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(HEADER)
    rows = zip(FREQUENCIES, magnitude, phase)
    writer.writerows([f"{w:.6f}", f"{m:.6f}", f"{p:.6f}"] for w, m, p in rows)
    return file.getvalue()


if __name__ == "__main__":
    FOLDER.mkdir(parents=True, exist_ok=True)
    for plant in PLANTS:
        (FOLDER / f"{plant}.csv").write_text(text(plant), newline="")
