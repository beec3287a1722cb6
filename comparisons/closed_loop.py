"""Runs the closed loop of benches/peers/closed_loop.h from Python: compiles it into target/peers, calls it by ctypes.

Independent of phea. Results are arrays with the columns time, force, spool, pressure A, pressure B, command, position.
"""

import ctypes
import functools
import pathlib
import re
import subprocess

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCE, BUILT = ROOT / "benches" / "peers", ROOT / "target" / "peers"
COMPILER = ["cc", "-O3", "-march=native"]
SUNDIALS = ["-lsundials_cvode", "-lsundials_nvecserial"]
TIME, FORCE, SPOOL, PRESSURE_A, PRESSURE_B, COMMAND, POSITION = range(7)
METHODS = ("bdf", "bdf_stability", "adams", "adams_functional")
DEFAULTS = {
    name: float(value)
    for name, value in re.findall(r" X\((\w+), ([^)]+)\)", (SOURCE / "closed_loop.h").read_text())
}


@functools.cache
def program(name, *flags, library=False, suffix=""):
    """Path of a compiled program or library; raises CalledProcessError where it does not compile."""
    BUILT.mkdir(parents=True, exist_ok=True)
    target = BUILT / (name + suffix + (".so" if library else ""))
    shared = ["-shared", "-fPIC"] if library else []
    subprocess.run([*COMPILER, *shared, SOURCE / f"{name}.c", "-o", target, *flags, "-lm"], check=True)
    return target


def has_sundials():
    """Whether CVODE can be compiled against here (Debian: libsundials-dev)."""
    words = ["cc", "-fsyntax-only", "-include", "cvode/cvode.h", "-x", "c", "/dev/null"]
    return subprocess.run(words, capture_output=True).returncode == 0


class Options(ctypes.Structure):
    _fields_ = [("method", ctypes.c_int), ("tolerance", ctypes.c_double), ("restart_at_motion", ctypes.c_int)]


def rig_and_rows(changes):
    """The parameters as the C structure lies in memory, and an array for the rows."""
    unknown = set(changes) - set(DEFAULTS)
    if unknown:
        raise KeyError(f"no such parameters: {sorted(unknown)}")
    values = {**DEFAULTS, **changes}
    rows = np.zeros((round(values["duration"] / values["output_step"]) + 1, 7))
    return (ctypes.c_double * len(values))(*values.values()), rows


def cvode(method, tolerance, restart_at_motion=True, **changes):
    """A run on CVODE with some parameters changed."""
    library = ctypes.CDLL(str(program("cvode_closed_loop", *SUNDIALS, library=True)))
    rig, rows = rig_and_rows(changes)
    options, work = Options(METHODS.index(method), tolerance, restart_at_motion), (ctypes.c_long * 6)()
    status = library.cvode_closed_loop(rig, ctypes.byref(options), ctypes.c_void_p(rows.ctypes.data), work)
    if status < 0:
        raise ArithmeticError(f"CVODE fails with {status}")
    return rows


def runge_kutta(steps_per_output, extended=False, **changes):
    """A run in fixed steps; `extended` carries 64 bits of mantissa where the processor has them."""
    flags, suffix = (["-DREAL=long double"], "_extended") if extended else ([], "")
    library = ctypes.CDLL(str(program("runge_kutta_closed_loop", *flags, library=True, suffix=suffix)))
    rig, rows = rig_and_rows(changes)
    steps = ctypes.c_long(steps_per_output)
    if library.runge_kutta_closed_loop(rig, steps, ctypes.c_void_p(rows.ctypes.data)) < 0:
        raise ArithmeticError("the fixed step is too long for this rig")
    return rows
