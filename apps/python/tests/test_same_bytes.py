"""Every answer has the bytes that the command prints and writes, whatever the number of threads."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from typing import TypeVar

import pytest

import phea
from conftest import Command
from phea import Answer

pytestmark = pytest.mark.filterwarnings("ignore::phea.ProjectWarning")

PROJECTS = [f"{name}.toml" for name in phea.examples()]

Request = Callable[[phea.Project], Answer]
Found = TypeVar("Found")

# Requests that are quick on every example, with the words of the command.
REQUESTS: dict[str, Request] = {
    "check": lambda project: project.check(),
    "size": lambda project: project.size(),
    "linearize": lambda project: project.linearize(),
    "bench": lambda project: project.bench(),
    "simulate": lambda project: project.simulate(figures=False),
}

# Examples whose audit or design takes seconds, or minutes.
SLOW_AUDITS = {
    *("leg/knee", "structural/rig", "ybitu/identified", "ybitu/series", "ybitu/telescopic"),
    *("ybitu/transmission", "ybitu/accumulator", "ybitu/alternatives"),
}
QUICK_DESIGNS = [
    *("qft/by_hand", "qft/damped_resonance", "qft/dead_time", "qft/design/edge_plants"),
    *("qft/design/servo_least_gain", "qft/design/servo_prefilter", "qft/design/wheel"),
    *("qft/edge_plants", "qft/measured", "qft/servo", "qft/servo_shaped", "qft/unstable_plant"),
    "rotary/vane",
]

# Requests that compute on all cores: words of the command, request, and examples.
THREADED: dict[str, tuple[list[str], Request, list[str]]] = {
    "verify": (
        ["verify"],
        lambda project: project.verify(),
        [name for name in phea.examples() if name not in SLOW_AUDITS],
    ),
    "prove": (
        ["verify", "--prove"],
        lambda project: project.verify(prove=True),
        ["qft/servo", "qft/unstable_plant", "qft/damped_resonance"],
    ),
    "on the machine": (
        ["verify", "--on-machine"],
        lambda project: project.verify(on_machine=True),
        ["rotary/vane"],
    ),
    "design": (["design"], lambda project: project.design(), QUICK_DESIGNS),
    "campaign": (
        ["campaign", "--runs", "7"],
        lambda project: project.campaign(runs=7, files=False),
        ["benchmark/campaign", "rotary/vane"],
    ),
    "report": (
        ["report"],
        lambda project: project.report(),
        ["qft/unstable_plant", "benchmark/closed_loop", "benchmark/campaign"],
    ),
}
CASES = [(name, example) for name, (_, _, examples) in THREADED.items() for example in examples]


def answer_or_refusal(project: str, request: Request) -> tuple[str, bool, dict[str, bytes]]:
    """JSON, yes or no, and files; of a refusal its JSON."""
    try:
        answer = request(phea.read(project))
    except phea.ProjectError as error:
        return error.json_text, False, {}
    return answer.json_text, bool(answer), answer.files


def json_of(project: str, request: Request) -> str:
    """JSON of an answer or of a refusal."""
    try:
        return request(phea.read(project)).json_text
    except phea.ProjectError as error:
        return error.json_text


def side_by_side(*works: Callable[[], Found], cores: set[int] | None = None) -> list[Found]:
    """Results of works in threads of their own, at once; on these cores only."""
    found: dict[int, Found] = {}

    def work(index: int) -> None:
        if cores is not None:
            os.sched_setaffinity(0, cores)  # of this thread, and of those that it starts
        found[index] = works[index]()

    threads = [threading.Thread(target=work, args=(index,)) for index in range(len(works))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return [found[index] for index in range(len(works))]


@pytest.mark.usefixtures("in_examples")
@pytest.mark.parametrize("name", REQUESTS)
@pytest.mark.parametrize("project", PROJECTS)
def test_json_of_every_example(run: Command, project: str, name: str) -> None:
    assert json_of(project, REQUESTS[name]) == run.json(name, project)


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="needs the threads of Linux")
@pytest.mark.usefixtures("in_examples")
@pytest.mark.parametrize(("name", "example"), CASES)
def test_one_core_and_all_cores(run: Command, name: str, example: str) -> None:
    words, request, _ = THREADED[name]
    project = f"{example}.toml"
    core = {min(os.sched_getaffinity(0))}
    (on_one,) = side_by_side(lambda: json_of(project, request), cores=core)
    assert on_one == json_of(project, request) == run.json(words[0], project, *words[1:])


@pytest.mark.usefixtures("in_examples")
@pytest.mark.parametrize(
    ("words", "request_"),
    [
        (["check", "ybitu/hose.toml"], lambda project: project.check()),
        (["size", "ybitu/hose.toml"], lambda project: project.size()),
        (["linearize", "ybitu/hose.toml"], lambda project: project.linearize()),
        (["verify", "ybitu/hose.toml"], lambda project: project.verify()),
        (["verify", "ybitu/pipe.toml", "--prove"], lambda project: project.verify(prove=True)),
        (["simulate", "ybitu/hose.toml"], lambda project: project.simulate()),
        (["design", "qft/unstable_plant.toml"], lambda project: project.design(files=True)),
        (["bench", "ybitu/hose.toml"], lambda project: project.bench()),
        (["report", "qft/unstable_plant.toml"], lambda project: project.report(files=True)),
        (
            ["campaign", "benchmark/campaign.toml", "--runs", "12"],
            lambda project: project.campaign(runs=12),
        ),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_json_status_and_files(run: Command, words: list[str], request_: Request) -> None:
    json, affirmative, files = answer_or_refusal(words[1], request_)
    assert json == run.json(*words)
    assert affirmative == (run.status(*words) == 0)
    written = run.written(*words)
    assert sorted(files) == sorted(written)
    assert files == written


@pytest.mark.usefixtures("in_examples")
@pytest.mark.parametrize(
    ("request_", "projects"),
    [
        (
            lambda project: project.simulate(figures=False),
            ["ybitu/hose.toml", "ybitu/pipe.toml"],
        ),
        (lambda project: project.verify(), ["ybitu/hose.toml", "ybitu/pipe.toml"]),
        (lambda project: project.design(), ["qft/servo.toml", "qft/dead_time.toml"]),
        (
            lambda project: project.campaign(runs=30, seed=3, files=False),
            ["benchmark/campaign.toml", "rotary/vane.toml"],
        ),
    ],
    ids=["simulate", "verify", "design", "campaign"],
)
def test_two_threads_at_once_do_not_disturb_each_other(
    request_: Request, projects: list[str]
) -> None:
    first, second = (phea.read(path) for path in projects)
    alone = [request_(first), request_(second)]
    assert alone[0] != alone[1]
    # two projects at once, and the same one twice
    together = side_by_side(lambda: request_(first), lambda: request_(second), lambda: request_(first))
    assert together == [*alone, alone[0]]
    assert [one.files for one in together] == [one.files for one in (*alone, alone[0])]


@pytest.mark.usefixtures("in_examples")
def test_rows_of_a_campaign_do_not_depend_on_threads() -> None:
    project = phea.read("benchmark/campaign.toml")
    one, two = (project.campaign(runs=9, threads=threads, files=False) for threads in (1, 2))
    assert one.files["runs.csv"] == two.files["runs.csv"]


@pytest.mark.usefixtures("in_examples")
def test_a_project_of_bytes_answers_as_one_that_was_read() -> None:
    read = phea.read("ybitu/hose.toml")
    held = phea.loads(read.text, files=dict(read.files), path="ybitu/hose.toml")
    assert held == read
    assert held.check() == read.check()
