"""The command of the package is the program of the other channels."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from conftest import EXAMPLES


def outcome(program: list[str], words: list[str]) -> tuple[int, bytes, bytes]:
    """Exit status, standard output and standard error of a command line."""
    ended = subprocess.run([*program, *words], cwd=EXAMPLES, capture_output=True, check=False)
    return ended.returncode, ended.stdout, ended.stderr


@pytest.mark.parametrize(
    "words",
    [
        [],
        ["--version"],
        ["man"],
        ["check", "ybitu/hose.toml"],
        ["check", "ybitu/hose.toml", "--set", "line.length=-1 m"],
        ["check", "absent.toml", "--json"],
        ["check", "--seed", "one", "--json"],
        ["verify", "ybitu/hose.toml", "--json"],
        ["campaign", "benchmark/campaign.toml", "--runs", "20"],
    ],
)
def test_same_output(command: str, words: list[str]) -> None:
    installed = shutil.which("phea", path=str(Path(sys.executable).parent))
    assert installed is not None
    expected = outcome([command], words)
    assert outcome([installed], words) == expected
    assert outcome([sys.executable, "-m", "phea"], words) == expected


@pytest.mark.skipif(sys.platform == "win32", reason="a signal of POSIX")
def test_ctrl_c_ends_the_command(tmp_path: Path) -> None:
    project = tmp_path / "project.toml"
    os.mkfifo(project)
    words = [sys.executable, "-m", "phea", "check", str(project)]
    with subprocess.Popen(words) as process, project.open("wb"):
        # the command has opened the project, and reads it
        process.send_signal(signal.SIGINT)
        assert process.wait() == -signal.SIGINT


@pytest.mark.skipif(sys.platform == "win32", reason="a signal of POSIX")
def test_ctrl_c_returns_the_result_so_far(tmp_path: Path) -> None:
    words = ["campaign", "benchmark/campaign.toml", "--runs", "1000000", "--out", str(tmp_path)]
    with subprocess.Popen(
        [sys.executable, "-m", "phea", *words],
        cwd=EXAMPLES,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    ) as process:
        assert process.stdout is not None
        # with the first rows the campaign has begun
        while not any(table.stat().st_size > 10_000 for table in tmp_path.glob("*.csv")):
            assert process.poll() is None
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        assert b"Stopped after" in process.stdout.read()
        assert process.wait() == 1
