"""Requests to the extension, and its exceptions as those of the package."""

from __future__ import annotations

from phea import _native
from phea.errors import Interrupted, NoAnswer, ProjectError, Stopped

# `typing` takes longer to import than the package.
TYPE_CHECKING = False

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TypeVar

    from phea._project import Progress
    from phea._record import Answer

    AnyAnswer = TypeVar("AnyAnswer", bound=Answer)


def answered(
    cls: type[AnyAnswer],
    name: str,
    request: Callable[[Callable[[str, float], object] | None], _native.Answer],
    progress: Progress,
    context: object = None,
) -> AnyAnswer:
    """The answer of a request to the extension, with its exceptions turned into the package's."""
    from phea._progress import callable_of

    with callable_of(progress, name) as report:
        try:
            native = request(report)
        except _native.Refused as refused:
            raise translated(refused) from None
    answer = cls((native.json, native.text, native.affirmative), None, native, context)
    _raise_if_stopped(native.stopped, name, answer)
    return answer


def _raise_if_stopped(reason: BaseException | bool | None, name: str, answer: Answer) -> None:
    if reason is None:
        return
    if isinstance(reason, KeyboardInterrupt):
        raise Interrupted(f"{name} was interrupted", answer)
    if isinstance(reason, BaseException):
        raise reason
    raise Stopped(f"{name} was stopped", answer)


def translated(refused: _native.Refused) -> Exception:
    """The exception of the package for one of the extension."""
    from phea._words import python_words

    kind, json_text, text = refused.args
    text = python_words(text)
    if kind == "project":
        return ProjectError(text, json_text)
    if kind == "no_answer":
        return NoAnswer(text, json_text)
    return Stopped(text) if kind == "stopped" else OSError(text)
