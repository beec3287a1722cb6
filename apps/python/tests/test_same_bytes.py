"""Every answer has the bytes that the command prints and writes."""

from __future__ import annotations

import threading
from collections.abc import Callable

import pytest

import phea
from conftest import Command
from phea import Answer

PROJECTS = [f"{name}.toml" for name in phea.examples()]

Request = Callable[[phea.Project], Answer]

# Requests that are quick on every example, with the words of the command.
REQUESTS: dict[str, Request] = {
    "check": lambda project: project.check(),
    "size": lambda project: project.size(),
    "linearize": lambda project: project.linearize(),
    "bench": lambda project: project.bench(),
}


def answer_or_refusal(project: str, request: Request) -> tuple[str, bool, dict[str, bytes]]:
    """JSON, yes or no, and files; of a refusal its JSON."""
    try:
        answer = request(phea.read(project))
    except phea.ProjectError as error:
        return error.json_text, False, {}
    return answer.json_text, bool(answer), answer.files


@pytest.mark.filterwarnings("ignore::phea.ProjectWarning")
@pytest.mark.usefixtures("in_examples")
@pytest.mark.parametrize("name", REQUESTS)
@pytest.mark.parametrize("project", PROJECTS)
def test_json_of_every_example(run: Command, project: str, name: str) -> None:
    json, _, _ = answer_or_refusal(project, REQUESTS[name])
    assert json == run.json(name, project)


@pytest.mark.filterwarnings("ignore::phea.ProjectWarning")
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


@pytest.mark.filterwarnings("ignore::phea.ProjectWarning")
@pytest.mark.usefixtures("in_examples")
def test_two_threads_at_once_do_not_disturb_each_other() -> None:
    projects = [phea.read("ybitu/hose.toml"), phea.read("ybitu/pipe.toml")]
    alone = [project.simulate(figures=False) for project in projects]
    found: dict[int, Answer] = {}

    def simulate(index: int) -> None:
        found[index] = projects[index].simulate(figures=False)

    threads = [threading.Thread(target=simulate, args=(index,)) for index in (0, 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [found[0], found[1]] == alone
    assert found[0].files == alone[0].files


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
