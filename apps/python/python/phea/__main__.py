"""The command ``phea``, also as ``python -m phea``: the program of the other channels."""

from __future__ import annotations

import signal
import sys

from phea import _native


def main() -> int:
    """Runs the command line of this process and returns the exit status."""
    # Ctrl-C ends the program, or requests its result so far: Python's own handler would do neither.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _native.run_command(["phea", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
