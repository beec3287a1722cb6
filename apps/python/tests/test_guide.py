"""The blocks of the chapter on Python run, one after the other."""

from __future__ import annotations

import re
from pathlib import Path

import control
import pytest

import phea
from conftest import EXAMPLES

CHAPTER = EXAMPLES.parent / "book/src/guide/python.md"
# What stands for a file of the reader, and for a cluster: this process.
INSTEAD = {
    '"scheduler:8786"': "processes=False, n_workers=1, dashboard_address=None",
    "runs=100_000": "runs=20",
    "campaign(project,": 'campaign(phea.example("benchmark/campaign"),',
}


@pytest.mark.filterwarnings("ignore")
def test_every_block_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = CHAPTER.read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    monkeypatch.chdir(tmp_path)
    Path("hose.toml").write_bytes((EXAMPLES / "ybitu/hose.toml").read_bytes())
    names: dict[str, object] = {"control": control}
    for block in blocks:
        for written, instead in INSTEAD.items():
            block = block.replace(written, instead)
        code = compile(block, str(CHAPTER), "exec")
        if "dask_jobqueue" not in block:  # needs Slurm
            exec(code, names)
    assert isinstance(names["shaped"], phea.Project) and "cluster" not in names
    assert Path("runs.csv").read_bytes().count(b"\n") == 21
