"""Designed projects, runs and rows: what answers have besides the keys of their JSON."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest

import phea

pytestmark = pytest.mark.filterwarnings("ignore::phea.ProjectWarning")


def test_a_design_has_its_project() -> None:
    servo = phea.example("qft/servo")
    design = servo.design()
    comments = [line for line in servo.text.splitlines() if line.startswith("#")]
    assert comments and all(line in design.project.text.splitlines() for line in comments)
    assert design.project.verify().verdict == "met" and bool(design)
    assert pickle.loads(pickle.dumps(design)).project == design.project


def test_settings_stay_in_a_designed_and_in_a_shaped_project() -> None:
    hose = phea.example("ybitu/hose")
    longer = hose.set({"line.length": "2 m", "controller.numerator": "0.002*s + 0.016"})
    shaped = longer.shaping().add(phea.Gain(1.5)).save()
    assert shaped.settings == ("line.length=2 m",)
    found, before = shaped.linear.controller, hose.linear.controller
    assert found is not None and before is not None
    assert found.gain == pytest.approx(2 * 1.5 * before.gain, rel=1e-12)
    assert shaped.linearize().stiffness == longer.linearize().stiffness


def test_runs_are_found_by_their_scenarios() -> None:
    runs = phea.example("ybitu/hose").simulate(figures=False)
    run = runs["force steps"]
    assert [len(runs), list(runs)] == [2, ["step and load motion", "force steps"]]
    assert run.time_s[0] == 0.0 and run.force_n.shape == run.time_s.shape
    assert run.events == run.metrics.events and run.status == "completed"
    first = run.events[0]
    peak = np.max(run.force_n[run.time_s >= first.time_s])
    assert peak > 0.0
    assert pickle.loads(pickle.dumps(run)) == run
    with pytest.raises(KeyError, match="did you mean 'force steps'"):
        runs["force step"]


def test_rows_of_a_campaign(tmp_path: Path) -> None:
    project = phea.example("benchmark/campaign")
    held = project.campaign(runs=5, files=False)
    kept = project.campaign(runs=5, out=tmp_path / "runs.csv", files=False)
    assert held.rows == kept.rows and len(held.to_pandas()) == 5
    assert held.to_arrow().num_rows == 5
    assert held.to_pandas()["supply.pressure"].min() > 1e6


def test_a_slip_of_units_is_warned_of() -> None:
    with pytest.warns(phea.ProjectWarning, match="63 mm"):
        phea.example("ybitu/hose").set({"cylinder.piston_diameter": 63})
