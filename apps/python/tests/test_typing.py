"""Types find the mistakes of a user, and describe the extension as it is."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

from conftest import EXAMPLES

WRONG_CALLS = Path(__file__).parent / "typing/wrong_calls.py"
# Names of the extension that its description may lack.
UNDESCRIBED = "phea._native.__all__\n"


def errors(checked: Path, folder: Path) -> list[tuple[int, str]]:
    """Lines and codes of the errors that the strict type checker finds."""
    options = ["--config-file", str(EXAMPLES.parent / "pyproject.toml"), "--strict", "--output", "json"]
    options += ["--cache-dir", str(folder / "cache")]
    run = subprocess.run(
        [sys.executable, "-m", "mypy", *options, str(checked)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode in (0, 1), run.stdout + run.stderr
    rows = [json.loads(line) for line in run.stdout.split("\n") if line]
    return [(row["line"], row["code"]) for row in rows if row["severity"] == "error"]


def test_each_of_forty_wrong_calls_is_an_error(tmp_path: Path) -> None:
    first, *lines = WRONG_CALLS.read_text(encoding="utf-8").splitlines(keepends=True)
    assert first == "# mypy: ignore-errors\n"
    marked = enumerate((re.search(r"# E: ([a-z-]+)$", line) for line in lines), 1)
    expected = [(place, found[1]) for place, found in marked if found]
    assert len(expected) == 40
    checked = tmp_path / "wrong_calls.py"
    checked.write_text("".join(lines), encoding="utf-8")
    assert errors(checked, tmp_path) == expected
    assert errors(EXAMPLES / "python", tmp_path) == []


def test_the_extension_is_described_as_it_is(tmp_path: Path) -> None:
    allowed = tmp_path / "allowed.txt"
    allowed.write_text(UNDESCRIBED, encoding="utf-8")
    options = ["--allowlist", str(allowed), "--ignore-unused-allowlist"]
    run = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "phea._native", *options],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stdout + run.stderr
