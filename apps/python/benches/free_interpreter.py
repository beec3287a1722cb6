"""Rate of a loop in Python next to a campaign, relative to one next to a sleeping thread.

The campaign leaves one core to the loop. Both rates are measured in turns.
"""

from __future__ import annotations

import os
import statistics
import threading
import time
import warnings
from collections.abc import Callable

import phea

ROUNDS = 5
SECONDS = 2.0


def rate() -> float:
    """Rounds of a loop per second."""
    rounds, end = 0, time.perf_counter() + SECONDS
    while time.perf_counter() < end:
        for _ in range(1000):
            rounds += 1
    return rounds / SECONDS


def beside(work: Callable[[threading.Event], object]) -> float:
    """The rate while a thread works, which ends with the measurement."""
    done = threading.Event()
    thread = threading.Thread(target=work, args=(done,))
    thread.start()
    time.sleep(0.2)
    found = rate()
    done.set()
    thread.join()
    return found


def campaign(done: threading.Event) -> None:
    """A campaign on all cores but one."""
    threads = max(1, len(os.sched_getaffinity(0)) - 1)
    project = phea.example("benchmark/campaign")
    try:
        project.campaign(runs=10**6, threads=threads, progress=lambda *_: not done.is_set())
    except phea.Stopped:
        pass


def main() -> None:
    """Prints both rates and their quotient."""
    warnings.simplefilter("ignore")
    sleeping, working = [], []
    for _ in range(ROUNDS):
        sleeping.append(beside(lambda done: done.wait()))
        working.append(beside(campaign))
    alone, shared = statistics.median(sleeping), statistics.median(working)
    print(f"next to a sleeping thread {alone / 1e6:.2f}, next to a campaign {shared / 1e6:.2f}", end=" ")
    print(f"million rounds a second: {100 * shared / alone:.1f} %")


if __name__ == "__main__":
    main()
