"""Requests to the extension, and its exceptions as those of the package."""

from __future__ import annotations

from phea import _native
from phea._texts import whole
from phea.errors import Interrupted, NoAnswer, ProjectError, Stopped

# `typing` takes longer to import than the package.
TYPE_CHECKING = False

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any, TypeVar

    from phea._project import Progress
    from phea._record import Answer

    AnyAnswer = TypeVar("AnyAnswer", bound=Answer)

# Greatest number of points of a sweep.
MOST_POINTS = 2**16 - 1


def alternatives_options(
    front: str | None, sweep: str | None, points: int | None, frequencies: str | None, files: bool
) -> dict[str, Any]:
    """Options of a request on alternatives, for the extension."""
    if (front is None) != (sweep is None):
        raise TypeError("alternatives() takes front and sweep together")
    if points is not None and sweep is None:
        raise TypeError("alternatives() takes points with a sweep")
    whole("points", points, 1, MOST_POINTS)
    options: dict[str, Any] = {"front": front, "sweep": sweep, "points": points}
    return options | {"frequencies": frequencies, "files": files}


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
