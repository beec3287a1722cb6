"""Bridge to python-control and SciPy: linear models and runs out, systems and responses in.

It needs ``pip install 'phea[control]'``.

>>> import phea, phea.control
>>> rig = phea.example("ybitu/hose")
>>> phea.control.plant(rig).input_labels
['command_v']
"""

from __future__ import annotations

from phea.control._in import with_controller, with_plant, with_prefilter
from phea.control._loops import complementary_sensitivity, loop, sensitivity, tracking
from phea.control._measured import measured_family
from phea.control._models import controller, load_position, plant, prefilter, sensor
from phea.control._responses import frequency_response, time_response
from phea.control._systems import FactoredStateSpace, FactoredTransferFunction

__all__ = [
    "FactoredStateSpace",
    "FactoredTransferFunction",
    "complementary_sensitivity",
    "controller",
    "frequency_response",
    "load_position",
    "loop",
    "measured_family",
    "plant",
    "prefilter",
    "sensitivity",
    "sensor",
    "time_response",
    "tracking",
    "with_controller",
    "with_plant",
    "with_prefilter",
]
