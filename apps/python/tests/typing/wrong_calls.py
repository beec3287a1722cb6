# mypy: ignore-errors
"""Forty mistakes of users, each an error of the type checker; `test_typing.py` removes line 1."""

from __future__ import annotations

import phea
import phea.control
import phea.distributed
from phea.linear import Factors, Family
from phea.table import unit_of

rig, servo = phea.example("ybitu/hose"), phea.example("qft/servo")
audit, models, runs = rig.verify(), rig.linearize(), rig.simulate()
loop = servo.shaping()

# Projects.
phea.raed("hose.toml")  # E: attr-defined
phea.read("hose.toml", {"line.length": "2 m"})  # E: call-arg
phea.read("hose.toml", catalogues=["hoses"], sets={})  # E: call-arg
phea.loads("", files=["hoses/soft.toml"])  # E: arg-type
phea.example()  # E: call-arg
rig.set("line.length=2 m")  # E: arg-type
rig.set({"line.length": None})  # E: dict-item
rig.text = "schema = 1"  # E: misc
rig.files["hose.toml"] = b""  # E: index

# Commands.
rig.size(gain="1 mV/N", lenght="2 m")  # E: call-arg
rig.size(length=("2", "m"))  # E: arg-type
rig.linearize(sweep="line.length=1 m..2 m", points="5")  # E: arg-type
rig.verify(True)  # E: call-arg
servo.design(seed="one")  # E: arg-type
rig.simulate(format="xlsx")  # E: arg-type
rig.campaign(runs="100")  # E: arg-type
rig.campaign_run(run=3, seed=None)  # E: arg-type
rig.alternatives(front=["disturbance_peak_n", "swept"])  # E: arg-type
rig.bench(progress="bar")  # E: arg-type
rig.report().to_pdf()  # E: attr-defined
phea.compare([rig, servo])  # E: arg-type
phea.identify(["flow.csv"], of="hose")  # E: arg-type
phea.check_certificate({"claims": []})  # E: arg-type

# Answers: misspelt, with another unit, or absent.
audit.verdit  # E: attr-defined
audit.delay_margin_ms  # E: attr-defined
audit.delay_margin_s > 0.0  # E: operator
audit.verdict == "passed"  # E: comparison-overlap
models.stiffness.by_volume * 2.0  # E: operator
rig.check().derived["line.volume"] + "m3"  # E: operator
runs[0]  # E: index
phea.Stopped("stopped").answer.text  # E: union-attr
unit_of(3)  # E: arg-type

# Values of the road.
loop.add("lead 5 50")  # E: arg-type
loop.through("lead", at=20, db="-6 dB")  # E: arg-type
phea.Lead(5)  # E: call-arg
servo.linear.plant.poles  # E: union-attr
phea.control.plant(rig, form="zpk")  # E: arg-type
phea.distributed.sweep(rig, "line.length", ["1 m"], "size", None)[0].poles  # E: attr-defined
Factors("1", [], [-3.0])  # E: arg-type
Family(servo).member("k=2")  # E: arg-type
