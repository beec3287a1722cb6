"""Time of `import phea` beyond that of Python itself.

Processes that import nothing and processes that import phea take turns; the differences of their
best and of their median times are printed, and that of their processor time, which says more on a
machine that does other work too.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterable

ROUNDS = 25
KINDS: dict[str, Callable[[Iterable[float]], float]] = {"best": min, "median": statistics.median}


def seconds_of(script: str) -> tuple[float, float]:
    """Time and processor time of a process that runs a script."""
    start, before = time.perf_counter(), os.times()
    subprocess.run([sys.executable, "-c", script], check=True)
    end, after = time.perf_counter(), os.times()
    user = after.children_user - before.children_user
    return end - start, user + after.children_system - before.children_system


def main() -> None:
    """Prints both times and their difference."""
    scripts = {"python": "pass", "import phea": "import phea"}
    times: dict[str, list[tuple[float, float]]] = {name: [] for name in scripts}
    for _ in range(ROUNDS):
        for name, script in scripts.items():
            times[name].append(seconds_of(script))
    for place, kind in enumerate(("time", "processor time")):
        for word, of in KINDS.items():
            plain, with_phea = (1e3 * of(one[place] for one in times[name]) for name in scripts)
            more = f"{with_phea - plain:.1f} ms more"
            print(f"{word} {kind}: python {plain:.1f} ms, with phea {with_phea:.1f} ms: {more}")
    imported = "import phea, sys; print(sorted({'numpy', 'pandas', 're', 'json'} & set(sys.modules)))"
    print("imported with it:", end=" ", flush=True)
    subprocess.run([sys.executable, "-c", imported], check=True)


if __name__ == "__main__":
    main()
