"""`check` of the Ybitu rig: in Rust, from Python, and from Python with every attribute read.

The time in Rust is that of the request of the extension, which returns text and JSON as they are.
The calls take turns; best and median times are printed, and processor time, which says more on a
machine that does other work too.
"""

from __future__ import annotations

import statistics
import time
import warnings
from collections.abc import Callable

import phea

ROUNDS = 100


def milliseconds_of(call: Callable[[], object]) -> tuple[float, float]:
    """Time and processor time of a call."""
    start, before = time.perf_counter(), time.process_time()
    call()
    return 1e3 * (time.perf_counter() - start), 1e3 * (time.process_time() - before)


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
    times: dict[str, list[tuple[float, float]]] = {name: [] for name in calls}
    for _ in range(ROUNDS):
        for name, call in calls.items():
            times[name].append(milliseconds_of(call))
    for name, found in times.items():
        walls, processors = zip(*found, strict=True)
        best, median = min(walls), statistics.median(walls)
        processor = statistics.median(processors)
        print(f"{name}: best {best:.2f} ms, median {median:.2f} ms, processor {processor:.2f} ms")


if __name__ == "__main__":
    main()
