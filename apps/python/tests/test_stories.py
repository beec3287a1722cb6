"""The stories under `examples/python` run, and what they assert holds."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

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
def test_story(name: str, tmp_path: Path) -> None:
    # a campaign writes one table, the others a folder
    out = tmp_path / "runs.csv" if STORIES[name] == ["runs.csv"] else tmp_path
    runpy.run_path(str(FOLDER / name))["main"](out)
    assert sorted(path.name for path in tmp_path.iterdir()) == STORIES[name]
