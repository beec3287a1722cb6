"""Hydraulic force control through added compliance: size, design, verify, prove, simulate.

>>> import phea
>>> rig = phea.example("ybitu/hose")
>>> rig.verify().verdict
'violated'
>>> softer = rig.set({"line.length": "2 m"}).linearize().stiffness.by_volume
>>> softer.high < rig.linearize().stiffness.by_volume.low
True
"""

from __future__ import annotations

from phea import _native
from phea._project import Project, loads, read
from phea.errors import Interrupted, NoAnswer, ProjectError, ProjectWarning, Stopped

# `typing` takes longer to import than the package.
TYPE_CHECKING = False

if TYPE_CHECKING:
    from phea import answers, control, distributed, results, shaping, table
    from phea._examples import example, examples
    from phea._record import Answer, Interval, Record
    from phea._several import check_certificate, compare, identify
    from phea.shaping import (
        ComplexPoles,
        ComplexZeros,
        Differentiator,
        Element,
        Gain,
        Integrator,
        Lag,
        Lead,
        Notch,
        Pole,
        ProportionalIntegral,
        ProportionalIntegralDerivative,
        RollOff,
        Shaping,
        Zero,
    )
    from phea.table import Table

__version__: str = _native.VERSION

__all__ = [
    "Answer",
    "ComplexPoles",
    "ComplexZeros",
    "Differentiator",
    "Element",
    "Gain",
    "Integrator",
    "Interrupted",
    "Interval",
    "Lag",
    "Lead",
    "NoAnswer",
    "Notch",
    "Pole",
    "Project",
    "ProjectError",
    "ProjectWarning",
    "ProportionalIntegral",
    "ProportionalIntegralDerivative",
    "Record",
    "RollOff",
    "Shaping",
    "Stopped",
    "Table",
    "Zero",
    "check_certificate",
    "compare",
    "example",
    "examples",
    "identify",
    "loads",
    "read",
]

# Names that are imported when they are first used, by their modules.
_LATER = {
    "Answer": "_record",
    "Interval": "_record",
    "Record": "_record",
    "Table": "table",
    "ComplexPoles": "shaping",
    "ComplexZeros": "shaping",
    "Differentiator": "shaping",
    "Element": "shaping",
    "Gain": "shaping",
    "Integrator": "shaping",
    "Lag": "shaping",
    "Lead": "shaping",
    "Notch": "shaping",
    "Pole": "shaping",
    "ProportionalIntegral": "shaping",
    "ProportionalIntegralDerivative": "shaping",
    "RollOff": "shaping",
    "Shaping": "shaping",
    "Zero": "shaping",
    "answers": "",
    "bounds": "",
    "control": "",
    "distributed": "",
    "example": "_examples",
    "check_certificate": "_several",
    "compare": "_several",
    "examples": "_examples",
    "results": "",
    "rig": "",
    "identify": "_several",
    "shaping": "",
    "table": "",
}


if not TYPE_CHECKING:  # a type checker knows the names from above, and finds misspelt ones

    def __getattr__(name: str) -> object:
        if name not in _LATER:
            raise AttributeError(f"module 'phea' has no attribute {name!r}")
        import importlib

        module = _LATER[name]
        found = importlib.import_module(f"phea.{module or name}")
        return getattr(found, name) if module else found


def __dir__() -> list[str]:
    return sorted({*globals(), *_LATER})
