"""From the file of a rig to its report: size, audit, design, simulate, report.

The rig is the Ybitu test rig with high-expansion hoses. Its file states the measured parts, their
uncertainty and what the loop must do; the file also gives a first controller. Run it with
``python 01_rig_to_report.py [folder]``; the folder receives the designed project and the report.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import phea


def least_stiffness(project: phea.Project) -> float:
    """Least hydraulic stiffness over the stroke, N/m."""
    found = project.check().derived["stiffness.minimum"]
    assert found.value is not None and found.unit == "N/m"
    return found.value


def main(folder: Path) -> None:
    """Writes the designed project and its report."""
    rig = phea.example("ybitu/hose")  # phea.read("hose.toml") for a file of your own

    # Softer lines make force control easier: hoses of twice the length, all else unchanged.
    given, longer = least_stiffness(rig), least_stiffness(rig.set({"line.length": "3 m"}))
    print(f"least hydraulic stiffness: {given:.3g} N/m, with 3 m of hose {longer:.3g} N/m")
    assert longer < given

    # The given controller is stable for every plant of the family, and violates each limit.
    audit = rig.verify()
    print(audit.text)
    assert not audit and audit.verdict == "violated"

    # A controller for every plant; the same seed gives the same controller.
    design = rig.design(seed=1)
    assert design, design.text
    designed = phea.loads(design.files["designed.toml"], path="designed.toml")
    again = designed.verify()
    margins = again.tables["margins"].worst_margin_db
    print(f"designed: {again.verdict}, least margin {margins.min():.3f} dB")
    assert again and margins.min() > -0.01  # which still counts as met

    # The nonlinear machine with both controllers: force after the step, as arrays.
    for name, project in {"given": rig, "designed": designed}.items():
        run = project.simulate(figures=False).tables["step and load motion"]
        before_motion = run.time_s < 3.0
        final = run.force_n[before_motion][-1]
        print(f"{name}: {final:.1f} N before the load moves")
        assert abs(final - 4000.0) < 40.0

    # One page with everything, and the project to go on with.
    (folder / "designed.toml").write_bytes(design.files["designed.toml"])
    (folder / "report.html").write_bytes(designed.report().files["report.html"])
    print(f"wrote {folder / 'report.html'}")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as temporary:
            main(Path(temporary))
