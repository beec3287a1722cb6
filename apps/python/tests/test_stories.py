"""The stories under `examples/python` run, and what they assert holds."""

from __future__ import annotations

import runpy
import sys
from pathlib import Path

import pytest

import phea

FOLDER = Path(__file__).parents[3] / "examples/python"
# Each story, and what it writes.
STORIES = {
    "01_rig_to_report.py": ["designed.toml", "report.html"],
    "02_plant_of_python_control.py": ["designed.toml", "measured"],
    "03_campaign.py": ["runs.csv"],
}


def test_every_story_is_run() -> None:
    assert sorted(path.name for path in FOLDER.glob("*.py")) == sorted(STORIES)


@pytest.mark.filterwarnings("ignore::phea.ProjectWarning")
@pytest.mark.parametrize("name", STORIES)
def test_story(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    # a campaign writes one table, the others a folder
    out = tmp_path / "runs.csv" if STORIES[name] == ["runs.csv"] else tmp_path
    runpy.run_path(str(FOLDER / name))["main"](out)
    assert sorted(path.name for path in tmp_path.iterdir()) == STORIES[name]
    assert name != "03_campaign.py" or "2 workers of Dask" in capsys.readouterr().out


def test_the_campaign_without_dask(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    story = runpy.run_path(str(FOLDER / "03_campaign.py"))
    with story["dask_client"]() as client:
        assert client is None
    project = phea.example("benchmark/campaign")
    computed = story["computed"](project, 3, tmp_path / "runs.csv", None)
    assert len(computed.rows["run"]) == 3
