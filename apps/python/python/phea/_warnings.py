"""Warnings about a project, at the line of the user's code that asked for it."""

from __future__ import annotations

import os
import sys
import warnings

from phea.errors import ProjectWarning

# `typing` takes longer to import than the package.
TYPE_CHECKING = False

if TYPE_CHECKING:
    from phea._native import Project as NativeProject

_PACKAGE = os.path.dirname(__file__) + os.sep


def warn_of(project: NativeProject, parent: NativeProject | None = None) -> None:
    """Warns of each doubtful value, but not again of those of the project that it comes from."""
    known = set() if parent is None else {_without_place(one) for one in _each(parent.warnings)}
    for one in _each(project.warnings):
        if _without_place(one) not in known:
            from phea._words import python_words

            text = python_words(one.removeprefix("warning: "))
            warnings.warn(text, ProjectWarning, stacklevel=_level_of_the_user())


def _level_of_the_user() -> int:
    """Number of frames from the caller to the first one outside the package."""
    frame, level = sys._getframe(1), 1
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        frame, level = frame.f_back, level + 1
    return level


def _each(text: str) -> list[str]:
    """The warnings of a text, which are separated by an empty line."""
    first, *others = text.split("\n\nwarning: ")
    return [first, *("warning: " + one for one in others)] if text else []


def _without_place(warning: str) -> tuple[str, ...]:
    """A warning without the numbers of its lines, which a changed text moves."""
    message, *lines = warning.split("\n")
    places = (line.split(":")[0] for line in lines if "-->" in line)
    return (message, *places, *(line.partition("|")[2] for line in lines if "|" in line))
