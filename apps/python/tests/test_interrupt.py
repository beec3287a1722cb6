"""Ctrl-C during a long command is a KeyboardInterrupt, keeps what is done, and the call continues."""

from __future__ import annotations

import signal
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

import phea

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="a signal of POSIX")

# Each request runs with a progress callable that reports the first call on standard output.
REQUESTS = {
    "design": "phea.example('ybitu/hose').design(progress=report)",
    "verify": "phea.example('ybitu/hose').verify(prove=True, on_machine=True, progress=report)",
    "campaign": "phea.example('benchmark/campaign').campaign(runs=10**6, threads=1, progress=report)",
    "alternatives": "phea.example('ybitu/alternatives').alternatives(progress=report)",
}

SCRIPT = """
import sys, warnings
warnings.simplefilter("ignore")
import phea

told = False

def report(stage, fraction):
    global told
    if not told:
        told = True
        print("running", flush=True)

try:
    {request}
except KeyboardInterrupt as stopped:
    print(type(stopped).__name__, isinstance(stopped, phea.Stopped), flush=True)
    sys.exit(0)
sys.exit(3)
"""


def interrupted(request: str) -> str:
    """What a process prints that receives SIGINT once its request runs."""
    script = textwrap.dedent(SCRIPT).replace("{request}", request)
    with subprocess.Popen(
        [sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None and process.stderr is not None
        assert process.stdout.readline() == "running\n", process.stderr.read()
        process.send_signal(signal.SIGINT)
        printed = process.stdout.read()
        assert process.wait() == 0, process.stderr.read()
    return printed


@pytest.mark.parametrize("name", REQUESTS)
def test_sigint_is_a_keyboard_interrupt(name: str) -> None:
    assert interrupted(REQUESTS[name]).split() in (["Interrupted", "True"], ["KeyboardInterrupt", "False"])


def test_an_interrupted_campaign_continues_to_the_same_bytes(tmp_path: Path) -> None:
    table = tmp_path / "runs.csv"
    request = f"phea.example('benchmark/campaign').campaign(runs=3000, threads=1, out={str(table)!r}, files=False, progress=report)"
    assert interrupted(request).startswith("Interrupted")
    rows = table.read_bytes()
    assert rows.endswith(b"\n") and rows.count(b"\n") < 3000
    project = phea.example("benchmark/campaign")
    project.campaign(runs=3000, out=table, files=False)
    assert table.read_bytes() == project.campaign(runs=3000, files=False).files["runs.csv"]
