"""Whatever goes in, only documented exceptions come out, and nothing is left behind."""

from __future__ import annotations

import multiprocessing
import os
import random
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import phea

pytestmark = pytest.mark.filterwarnings("ignore::phea.ProjectWarning")

EXAMPLES = [phea.example(name).text for name in ("ybitu/hose", "qft/servo", "rotary/vane", "leg/knee")]


def read(text: str | bytes) -> None:
    """Reads a project that may be wrong."""
    try:
        phea.loads(text)
    except phea.ProjectError as error:
        assert error.diagnostics and str(error)


@settings(max_examples=1500, deadline=None, derandomize=True)
@given(st.one_of(st.text(), st.binary()))
def test_random_texts(text: str | bytes) -> None:
    try:
        read(text)
    except UnicodeEncodeError:
        assert isinstance(text, str)


def mutated(text: str, random_: random.Random) -> str:
    """A project with some of its text removed, repeated or replaced."""
    lines = text.splitlines()
    for _ in range(random_.randint(1, 3)):
        place = random_.randrange(len(lines))
        kind = random_.randrange(4)
        if kind == 0:
            del lines[place]
        elif kind == 1:
            lines.insert(place, random_.choice(lines))
        elif kind == 2:
            line = lines[place]
            cut = random_.randrange(len(line) + 1)
            lines[place] = line[:cut] + random_.choice(["-", "0", '"', "=", "[", "1e400", "nan"]) + line[cut:]
        else:
            lines[place] = lines[place].replace("m", "k")
    return "\n".join(lines)


@pytest.mark.parametrize("index", range(len(EXAMPLES)))
def test_mutated_examples(index: int) -> None:
    random_ = random.Random(index)
    for _ in range(700):
        read(mutated(EXAMPLES[index], random_))


WRONG: list[Any] = [None, 3, -1, 2.5, float("nan"), "x", b"x", [], {}, object(), "1e400 m", True]


@settings(max_examples=700, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
@given(
    st.sampled_from(
        [
            lambda rig, one, _: rig.set(one),
            lambda rig, one, other: rig.set({one: other}),
            lambda rig, one, _: rig.set({"line.length": one}),
            lambda rig, one, other: rig.size(gain=one, length=other),
            lambda rig, one, other: rig.linearize(sweep=one, points=other),
            lambda rig, one, _: rig.campaign(runs=one),
            lambda rig, one, _: rig.campaign_run(one),
            lambda rig, one, other: phea.loads(one, files=other),
            lambda rig, one, other: phea.loads("", path=one, catalogues=other),
            lambda rig, one, _: phea.example(one),
            lambda rig, one, other: phea.compare(one, other),
            lambda rig, one, other: phea.identify(one, project=other),
            lambda rig, one, other: phea.check_certificate(one, other),
            lambda rig, one, other: rig.shaping().through(one, at=other, db=other),
            lambda rig, one, other: rig.shaping().move(one, other),
        ]
    ),
    st.sampled_from(WRONG),
    st.sampled_from(WRONG),
)
def test_wrong_arguments(call: Callable[..., object], one: object, other: object) -> None:
    rig = phea.example("ybitu/hose")
    try:
        call(rig, one, other)
    except (TypeError, ValueError, OSError, OverflowError):
        pass  # ProjectError and NoAnswer are ValueErrors


def resident_bytes() -> int:
    """Resident memory of this process."""
    with open("/proc/self/statm", encoding="ascii") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="needs the memory of Linux")
def test_repeated_reading_keeps_no_memory() -> None:
    text = EXAMPLES[1]
    for _ in range(300):
        phea.loads(text).check()
    before = resident_bytes()
    for _ in range(1000):
        phea.loads(text).check()
    assert resident_bytes() - before < 5_000_000


def verdict(_: int) -> str:
    return phea.example("qft/servo").check().title


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_other_processes_work_after_import(method: str) -> None:
    context = multiprocessing.get_context(method)
    with context.Pool(1) as pool:
        assert pool.map(verdict, [0]) == [verdict(0)]
