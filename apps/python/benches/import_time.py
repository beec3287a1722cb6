"""Time of `import phea` beyond that of Python itself.

Processes that import nothing and processes that import phea take turns; the differences of their
best and of their median times are printed.
"""

from __future__ import annotations

import subprocess
import sys
import time

ROUNDS = 25


def seconds_of(script: str) -> float:
    """Time of a process that runs a script."""
    start = time.perf_counter()
    subprocess.run([sys.executable, "-c", script], check=True)
    return time.perf_counter() - start


def main() -> None:
    """Prints both times and their difference."""
    scripts = {"python": "pass", "import phea": "import phea"}
    times: dict[str, list[float]] = {name: [] for name in scripts}
    for _ in range(ROUNDS):
        for name, script in scripts.items():
            times[name].append(seconds_of(script))
    for word, place in {"best": 0, "median": ROUNDS // 2}.items():
        plain, with_phea = (1e3 * sorted(times[name])[place] for name in scripts)
        more = with_phea - plain
        print(f"{word}: python {plain:.1f} ms, with phea {with_phea:.1f} ms: {more:.1f} ms more")
    imported = "import phea, sys; print(sorted({'numpy', 'pandas', 're', 'json'} & set(sys.modules)))"
    print("imported with it:", end=" ", flush=True)
    subprocess.run([sys.executable, "-c", imported], check=True)


if __name__ == "__main__":
    main()
