"""Projects of tests, with alternatives that take a second or less each."""

from __future__ import annotations

import phea

_REQUIRED = """
[[specification]]
kind = "robust_stability"
limit = 1.5
frequencies = [1, 10, 100]
band = [0, inf]

[[specification]]
kind = "sensitivity"
limit = { numerator = "s", denominator = "s + 5" }
frequencies = [1, 5]

[[scenario]]
name = "step and motion"
duration = "0.3 s"
reference = [{ at = "0.05 s", force = "1 kN" }]
load_motion = { kind = "smooth_step", start = "0.2 s", duration = "0.05 s", distance = "1 mm" }

[[alternative]]
name = "pipe"
set = { "line" = { pipe = { bore = "10.5 mm" }, length = "0.35 m", compliance = "uniform" } }

[[alternative]]
name = "sized"
size = true
set = { "sizing.minimum_gain" = "1 V/N" }
"""

_LAG = """
schema = 1
title = "A lag"
[plant]
numerator = "k"
denominator = "s + 1"
[uncertainty]
k = { nominal = 1, minimum = 1, maximum = 2 }
[[specification]]
kind = "sensitivity"
limit = 2
frequencies = [1]
band = [0, inf]
[[alternative]]
name = "faster"
set = { "plant.denominator" = "s + 3" }
[[load_case]]
name = "slow"
set = { "plant.denominator" = "s + 0.5" }
"""


def lag_with_load_case() -> phea.Project:
    """Plant of first order with an alternative, under a load case too."""
    return phea.loads(_LAG)


def rig_with_alternatives() -> phea.Project:
    """Rig of one plant, with a pipe in place of its hose, and with a hose that cannot be sized."""
    text = phea.example("ybitu/hose").text.split("[uncertainty]")[0]
    return phea.loads(text + _REQUIRED)
