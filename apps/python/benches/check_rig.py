"""`check` of the Ybitu rig: in Rust, from Python, and from Python with every attribute read.

The time in Rust is that of the request of the extension, which returns text and JSON as they are.
"""

from __future__ import annotations

import statistics
import time
import warnings
from collections.abc import Callable

import phea

ROUNDS = 200


def milliseconds_of(call: Callable[[], object]) -> list[float]:
    """Times of a call."""
    times = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        call()
        times.append(1e3 * (time.perf_counter() - start))
    return times


def main() -> None:
    """Prints the times and their differences."""
    warnings.simplefilter("ignore")
    rig = phea.example("ybitu/hose")
    calls: dict[str, Callable[[], object]] = {
        "in Rust": lambda: rig._native.answer("check", {}, None),
        "in Rust, with its text": lambda: rig._native.answer("check", {}, None).text,
        "from Python": lambda: rig.check(),
        "from Python, attributes read": lambda: rig.check().derived["line.volume"].value,
    }
    for call in calls.values():
        call()
    medians = {name: statistics.median(milliseconds_of(call)) for name, call in calls.items()}
    rust = medians["in Rust, with its text"]
    for name, median in medians.items():
        print(f"{name}: {median:.2f} ms, {median - rust:+.2f} ms")


if __name__ == "__main__":
    main()
