"""Runs scripts, each in a process of its own that finds NumPy and SciPy imported; two at once.

    python comparisons/together.py SCRIPT ...

To import them takes longer than what many of the scripts compute. The last line names the scripts that failed.
"""

import os
import pathlib
import runpy
import sys
import tempfile
import traceback

import control  # noqa: F401
import numpy  # noqa: F401
import scipy.integrate  # noqa: F401
import scipy.linalg  # noqa: F401
import scipy.optimize  # noqa: F401
import scipy.signal  # noqa: F401
import scipy.special  # noqa: F401


def status_of(script):
    """The status with which a script ends, as a process of its own would."""
    sys.argv, sys.path[0] = [script], str(pathlib.Path(script).resolve().parent)
    try:
        runpy.run_path(script, run_name="__main__")
    except SystemExit as end:
        if end.code is None or isinstance(end.code, int):
            return end.code or 0
        print(end.code, file=sys.stderr)
        return 1
    except BaseException:
        traceback.print_exc()
        return 1
    return 0


# as many at once as there are processors on the machine that the test command is made for
AT_ONCE = 2


def begun(script):
    """The process that runs a script, and the file with what it prints."""
    printed = tempfile.TemporaryFile()
    child = os.fork()
    if child == 0:
        os.dup2(printed.fileno(), sys.stdout.fileno())
        os.dup2(printed.fileno(), sys.stderr.fileno())
        status = status_of(script)
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
    return child, printed


def main(scripts):
    waiting, running, failed = list(scripts), {}, []
    while waiting or running:
        while waiting and len(running) < AT_ONCE:
            script = waiting.pop(0)
            child, printed = begun(script)
            running[child] = script, printed
        child, status = os.wait()
        script, printed = running.pop(child)
        printed.seek(0)
        print(f"$ python {script}", printed.read().decode(errors="replace"), sep="\n", end="", flush=True)
        if status != 0:
            failed.append(script)
    print("failed:", ", ".join(failed) or "none")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
