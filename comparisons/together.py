"""Runs scripts one after the other, each in a process of its own that finds NumPy and SciPy imported.

    python comparisons/together.py SCRIPT ...

To import them takes longer than what many of the scripts compute. The last line names the scripts that failed.
"""

import os
import pathlib
import runpy
import sys
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


def run(script):
    """Whether a script ended well."""
    print(f"$ python {script}", flush=True)
    child = os.fork()
    if child == 0:
        status = status_of(script)
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def main(scripts):
    # what goes wrong is printed where it does
    os.dup2(sys.stdout.fileno(), sys.stderr.fileno())
    failed = [script for script in scripts if not run(script)]
    print("failed:", ", ".join(failed) or "none")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
