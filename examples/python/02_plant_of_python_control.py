"""Plants of python-control get a controller, which python-control then tests by its own means.

A drive turns loads of five inertias, known as transfer functions: one controller must serve all of
them. python-control has no method for that; phea designs one from their frequency responses, and it
goes back as a transfer function. Needs ``pip install 'phea[control]'``. Run it with
``python 02_plant_of_python_control.py [folder]``; the folder receives the project.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import control
import numpy as np

import phea
import phea.control

# Largest |L/(1+L)| and |1/(1+L)| of any plant; slow disturbances are attenuated as s/(s + SLOW).
LARGEST_T, LARGEST_S, SLOW = 1.3, 2.0, 4.0
# A margin of -0.01 dB counts as met.
TOLERANCE = 10 ** (0.01 / 20)

SPECIFICATIONS = f"""\
schema = 1
title = "A drive with five loads"

[plant]
numerator = "1"
denominator = "s + 1"

[[specification]]
kind = "robust_stability"
limit = {LARGEST_T}
frequencies = [0.5, 1, 2, 5, 10, 20, 50, 100]
band = [0.5, 500]

[[specification]]
kind = "sensitivity"
limit = {LARGEST_S}
frequencies = [0.5, 1, 2, 5, 10, 20, 50, 100]
band = [0.5, 500]

[[specification]]
kind = "sensitivity"
limit = {{ numerator = "s", denominator = "s + {SLOW}" }}
frequencies = [0.5, 1, 2]
"""


def main(folder: Path) -> None:
    """Writes the project with its measured plants and its controller."""
    inertias = [0.5, 1, 1.5, 2, 3]
    lag = control.tf([1], [0.005, 1])
    loads = {f"inertia {J}": control.tf([1], [J, 1]) * lag for J in inertias}

    # Their responses, as they could have been measured, are the family of the project.
    frequencies = np.geomspace(0.1, 1000, 400)
    project = phea.control.measured_family(
        phea.loads(SPECIFICATIONS), loads, frequencies, integrators=0
    )
    design = project.design(seed=1)
    assert design, design.text
    print(design.text.partition("\n\n")[0])
    measured = {name: data for name, data in project.files.items() if name != project.path}
    designed = phea.loads(design.files["designed.toml"], files=measured, path="designed.toml")

    # The controller as an object of python-control, and the loops that it closes.
    controller = phea.control.controller(designed)
    for name, load in loads.items():
        s, t = control.feedback(1, controller * load), control.feedback(controller * load)
        largest_s, largest_t = (np.abs(one(1j * frequencies)).max() for one in (s, t))
        slow = np.array([0.5, 1.0, 2.0])
        attenuation = np.abs(s(1j * slow)) / np.abs(1j * slow / (1j * slow + SLOW))
        print(f"{name}: |S| {largest_s:.3f}, |T| {largest_t:.3f}, slow {attenuation.max():.3f}")
        assert np.all(t.poles().real < 0)
        assert max(largest_s / LARGEST_S, largest_t / LARGEST_T, attenuation.max()) <= TOLERANCE

    for name, data in designed.files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    assert phea.read(folder / "designed.toml").verify().verdict == "met"


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as temporary:
            main(Path(temporary))
