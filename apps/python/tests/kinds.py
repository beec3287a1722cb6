"""Every kind of answer, as Python gives it and as the command is asked for it."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from pathlib import Path

import phea
from phea import Answer, answers

# Files that the requests read, in a folder of their own; `{0}` is that folder in the words below.
ALTERNATIVE = '\n[[alternative]]\nname = "twice the gain"\nset = { "plant.numerator" = "2*k*(s + a)" }\n'
BENCH: dict[str, dict[str, str]] = {"bench.line": {}, "bench.friction": {}}
VALVE = ["leakage.csv", "metering.csv", "pressure_gain.csv"]
LINE = ["line_pressure_rise.csv", "line_frequency_response.csv"]
FRICTION = ["sliding.csv", "breakaway.csv"]
SET = ["--set", "bench.line={}", "--set", "bench.friction={}"]

Call = Callable[[Path], Answer]


def write_files(folder: Path) -> None:
    """Writes recordings, a project with an alternative, and a certificate."""
    for name, data in hose().bench().files.items():
        (folder / name).write_bytes(data)
    (folder / "response.csv").write_text(response_of_a_lag(), encoding="ascii")
    plant = phea.read("qft/unstable_plant.toml")
    (folder / "alternatives.toml").write_text(plant.text + ALTERNATIVE, encoding="utf-8")
    certificate = plant.set({"controller.numerator": "60"}).verify(prove=True)
    (folder / "certificate.json").write_bytes(certificate.files["certificate.json"])


def hose() -> phea.Project:
    return phea.read("ybitu/hose.toml").set(BENCH)


def response_of_a_lag() -> str:
    """Recording of a lag 100/(1 + s/5) that a random binary command moves."""
    random_, output, command = random.Random(1), 0.0, 0.0
    kept = math.exp(-5 * 0.01)
    lines = ["time_s,command_v,force_n"]
    for row in range(4000):
        command = random_.choice([-1.0, 1.0]) if row % 5 == 0 else command
        lines.append(f"{row * 0.01:.2f},{command},{output!r}")
        output = kept * output + (1 - kept) * command * 100
    return "\n".join(lines) + "\n"


def identified(of: str, names: list[str]) -> tuple[list[str], Call]:
    """Words and call of `identify` on recordings of the bench."""
    words = ["identify", "--of", of, *(f"{{0}}/{name}" for name in names)]
    words += ["--project", "ybitu/hose.toml", *SET]

    def call(folder: Path) -> Answer:
        files = [folder / name for name in names]
        return phea.identify(files, of=of, project=hose())  # type: ignore[arg-type]

    return words, call


def on(path: str, *words: str, call: Callable[[phea.Project], Answer]) -> tuple[list[str], Call]:
    """Words and call of a command on a project."""
    command, *options = words
    return [command, path, *options], lambda folder: call(phea.read(path.format(folder)))


SAMPLE_TIME = {"controller.sample_time": "1 ms"}
SAMPLED = ["--set", "controller.sample_time=1 ms"]
HOSE, PLANT, CAMPAIGN = "ybitu/hose.toml", "qft/unstable_plant.toml", "benchmark/campaign.toml"

KINDS: dict[str, tuple[list[str], Call]] = {
    "check": on(HOSE, "check", call=lambda rig: rig.check()),
    "size": on(HOSE, "size", call=lambda rig: rig.size()),
    "size by gain": on(HOSE, "size", "--gain", "0.0002", call=lambda rig: rig.size(gain=0.0002)),
    "linearize": on(HOSE, "linearize", call=lambda rig: rig.linearize()),
    "sweep": on(
        HOSE,
        *("linearize", "--sweep", "line.length=0.5 m..2 m", "--points", "3"),
        call=lambda rig: rig.linearize(sweep="line.length=0.5 m..2 m", points=3),
    ),
    "verify": on("qft/servo_shaped.toml", "verify", call=lambda loop: loop.verify()),
    "verify, violated": on(PLANT, "verify", "--prove", call=lambda loop: loop.verify(prove=True)),
    "shape": on(
        "qft/by_hand.toml",
        *("shape", "--add", '{ kind = "lead", zero_frequency = 5.0, pole_frequency = 50.0 }'),
        call=lambda loop: loop.shaping().add(phea.Lead(5, 50)).answer,
    ),
    "design": on(PLANT, "design", call=lambda plant: plant.design(files=True)),
    "design, infeasible": on(
        PLANT,
        *("design", "--set", "design.maximum_order=0", "--set", "plant.denominator=s^2 - 9"),
        call=lambda plant: plant.set(
            {"design.maximum_order": 0, "plant.denominator": "s^2 - 9"}
        ).design(files=True),
    ),
    "simulate": on(CAMPAIGN, "simulate", call=lambda rig: rig.simulate()),
    "frequency response": on(
        CAMPAIGN,
        *("simulate", "--frequency-response", "--frequencies", "1, 10 rad/s"),
        *("--amplitude", "0.1 V"),
        call=lambda rig: rig.simulate(
            frequency_response=True, frequencies="1, 10 rad/s", amplitude="0.1 V"
        ),
    ),
    "compare": (
        ["compare", CAMPAIGN, "benchmark/closed_loop.toml"],
        lambda _: phea.compare(phea.read(CAMPAIGN), phea.read("benchmark/closed_loop.toml")),
    ),
    "campaign": on(CAMPAIGN, "campaign", "--runs", "5", call=lambda rig: rig.campaign(runs=5)),
    "run of a campaign": on(
        CAMPAIGN, "campaign", "--run", "3", "--seed", "2", call=lambda rig: rig.campaign_run(3, seed=2)
    ),
    "alternatives": on(
        "{0}/alternatives.toml", "alternatives", call=lambda plant: plant.alternatives()
    ),
    "bench": on(HOSE, "bench", call=lambda rig: rig.bench()),
    "export": (
        ["export", "c", "qft/servo_shaped.toml", *SAMPLED, "--out", "{0}/c"],
        lambda _: phea.read("qft/servo_shaped.toml").set(SAMPLE_TIME).export("c"),
    ),
    "report": on(PLANT, "report", call=lambda plant: plant.report(files=True)),
    "valve": identified("valve", VALVE),
    "line": identified("line", LINE),
    "friction": identified("friction", FRICTION),
    "response": (
        ["identify", "--of", "response", "{0}/response.csv"],
        lambda folder: phea.identify([folder / "response.csv"], of="response"),
    ),
    "certificate": (
        ["check-certificate", "{0}/certificate.json"],
        lambda folder: phea.check_certificate((folder / "certificate.json").read_bytes()),
    ),
    "certificate of another": (
        ["check-certificate", "{0}/certificate.json", PLANT],
        lambda folder: phea.check_certificate(
            (folder / "certificate.json").read_text(encoding="utf-8"), phea.read(PLANT)
        ),
    ),
}


def classes() -> set[str]:
    """Names of the classes of answers; that of a refusal is an exception in Python."""
    found = (one for one in vars(answers).values() if isinstance(one, type))
    return {one.__name__ for one in found if issubclass(one, Answer)} - {"Answer", "RefusedAnswer"}
