"""Every kind of answer has the bytes and the yes or no of the command, and is a value."""

from __future__ import annotations

import copy
import os
import pickle
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

from conftest import EXAMPLES, Command
from kinds import KINDS, classes, write_files
from phea import Answer
from phea._fields import generated

pytestmark = pytest.mark.filterwarnings("ignore::phea.ProjectWarning")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Folder of the files that the requests read; the working folder is that of the examples."""
    found = tmp_path_factory.mktemp("kinds")
    before = Path.cwd()
    os.chdir(EXAMPLES)
    write_files(found)
    yield found
    os.chdir(before)


@pytest.fixture(scope="module")
def found(folder: Path) -> dict[str, Answer]:
    return {name: call(folder) for name, (_, call) in KINDS.items()}


def test_every_kind_is_there(found: dict[str, Answer]) -> None:
    assert {generated(type(answer)).__name__ for answer in found.values()} == classes()


@pytest.mark.parametrize("name", KINDS)
def test_bytes_and_yes_or_no_of_the_command(
    name: str, found: dict[str, Answer], folder: Path, run: Command
) -> None:
    words = [word.replace("{0}", str(folder)) for word in KINDS[name][0]]
    json, status = run.answer(*words)
    assert found[name].json_text == json
    assert bool(found[name]) is (status == 0) and status in (0, 1)


def test_both_yes_and_no(found: dict[str, Answer]) -> None:
    assert {bool(answer) for answer in found.values()} == {True, False}


@pytest.mark.parametrize("name", KINDS)
def test_a_value(name: str, found: dict[str, Answer]) -> None:
    answer = found[name]
    for again in (pickle.loads(pickle.dumps(answer)), copy.copy(answer), copy.deepcopy(answer)):
        assert again == answer and hash(again) == hash(answer) and bool(again) is bool(answer)
        assert again.json_text == answer.json_text and again.files == answer.files
        assert again.text == answer.text and repr(again) == repr(answer)
    assert "\n" not in repr(answer) and repr(answer).startswith(type(answer).__name__ + "(")
    others = [one for key, one in found.items() if key != name]
    assert all(answer != one for one in others) and len({answer, *others}) == len(found)


@pytest.mark.parametrize("name", KINDS)
def test_every_part_is_a_value(name: str, found: dict[str, Answer]) -> None:
    """Records, tuples and mappings inside an answer, to the last one."""
    waiting: list[Mapping[str, Any]] = [found[name]._fields()]
    seen = 0
    while waiting:
        for value in waiting.pop().values():
            parts = value if isinstance(value, tuple) else (value,)
            for part in parts:
                again = pickle.loads(pickle.dumps(part))
                assert again == part or part != part
                assert hash(again) == hash(part) or part != part
                assert "\n" not in repr(part)
                seen += 1
                if hasattr(part, "__dict__"):
                    waiting.append(vars(part))
    assert seen > 10
