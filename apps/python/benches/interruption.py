"""From the signal of Ctrl-C to the exception, in each long command.

A process computes; some time after its first progress it receives SIGINT, and prints when it has
caught the exception, by the clock that all processes share.
"""

from __future__ import annotations

import random
import signal
import subprocess
import sys
import time

ROUNDS = 5

REQUESTS = {
    "design": "phea.example('ybitu/hose').design(progress=report)",
    "verify": "[rig.verify(prove=True, on_machine=True, progress=report) for _ in range(100)]",
    "simulate": "[tight.simulate(check=True, progress=report) for _ in range(100)]",
    "campaign": "phea.example('benchmark/campaign').campaign(runs=10**6, progress=report)",
    "alternatives": "phea.example('ybitu/alternatives').alternatives(progress=report)",
    "report": "phea.example('ybitu/hose').report(progress=report)",
}

SCRIPT = """
import time, warnings
warnings.simplefilter("ignore")
import phea

rig = phea.example("ybitu/hose")
tight = rig.set({"simulation.tolerance": 1e-10})
running = False

def report(stage, fraction):
    global running
    if not running:
        running = True
        print("running", flush=True)

try:
    REQUEST
except KeyboardInterrupt:
    print(time.monotonic(), flush=True)
"""


def seconds_of(request: str, delay: float) -> float:
    """Time from the signal to the exception."""
    script = SCRIPT.replace("REQUEST", request)
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "running\n"
        time.sleep(delay)
        sent = time.monotonic()
        process.send_signal(signal.SIGINT)
        return float(process.stdout.readline()) - sent


def main() -> None:
    """Prints the longest and the median time of each command."""
    delays = random.Random(1)
    for name, request in REQUESTS.items():
        times = sorted(seconds_of(request, delays.uniform(0.1, 2.0)) for _ in range(ROUNDS))
        print(f"{name}: longest {times[-1]:.3f} s, median {times[len(times) // 2]:.3f} s", flush=True)


if __name__ == "__main__":
    main()
