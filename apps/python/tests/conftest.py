"""What the tests share: the command, and the example projects."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.fixture(scope="session")
def command() -> str:
    """Path of the command that the answers are compared with."""
    found = os.environ.get("PHEA_COMMAND") or shutil.which("phea")
    assert found is not None, "set PHEA_COMMAND to the path of the command"
    return found


class Command:
    """Runs the command as a user does."""

    def __init__(self, path: str, folder: Path) -> None:
        self._path = path
        self._folder = folder

    def answer(self, *words: str) -> tuple[str, int]:
        """The JSON object that the command prints, without its line end, and its exit status."""
        with tempfile.TemporaryDirectory() as folder:
            # without a folder, a report is written into the working folder
            out = ["--out", folder] if words[0] == "report" else []
            run = subprocess.run(
                [self._path, *words, *out, "--json"], cwd=EXAMPLES, capture_output=True, check=False
            )
        return run.stdout.decode().removesuffix("\n"), run.returncode

    def json(self, *words: str) -> str:
        """The JSON object that the command prints, without its line end."""
        return self.answer(*words)[0]

    def status(self, *words: str) -> int:
        """The exit status of the command."""
        return self.answer(*words)[1]

    def written(self, *words: str) -> dict[str, bytes]:
        """The files that the command writes into a new folder."""
        self._folder.mkdir(exist_ok=True)
        out = self._folder / str(len(list(self._folder.iterdir())))
        subprocess.run(
            [self._path, *words, "--json", "--out", str(out)],
            cwd=EXAMPLES,
            capture_output=True,
            check=False,
        )
        files = sorted(out.iterdir()) if out.exists() else []
        return {path.name: path.read_bytes() for path in files}


@pytest.fixture
def run(command: str, tmp_path: Path) -> Command:
    """The command, run in the folder of the examples."""
    return Command(command, tmp_path / "written")


@pytest.fixture
def in_examples(monkeypatch: pytest.MonkeyPatch) -> None:
    """The folder of the examples as the working folder, so that paths are those of the command."""
    monkeypatch.chdir(EXAMPLES)
