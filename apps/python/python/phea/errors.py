"""Exceptions of the package."""

from __future__ import annotations

# `typing` takes longer to import than the package.
TYPE_CHECKING = False

if TYPE_CHECKING:
    from typing import Any

    from phea._record import Answer
    from phea.answers import DiagnosticAnswer

__all__ = ["Interrupted", "NoAnswer", "ProjectError", "ProjectWarning", "Stopped"]


class ProjectWarning(UserWarning):
    """Doubtful value of a project, which is used nevertheless."""


class ProjectError(ValueError):
    """Errors in the files of a project, or in the values of a request, all at once.

    Attributes
    ----------
    diagnostics
        Errors, and warnings found with them: file, line, column, message, expected, help.
    json
        The JSON object that the command prints.
    """

    def __init__(self, text: str, json_text: str) -> None:
        super().__init__(text, json_text)
        self._json = json_text

    def __str__(self) -> str:
        return str(self.args[0])

    @property
    def json(self) -> dict[str, Any]:
        """The JSON object that the command prints."""
        import json

        found: dict[str, Any] = json.loads(self._json)
        return found

    @property
    def json_text(self) -> str:
        """The text of that object, byte for byte."""
        return self._json

    @property
    def diagnostics(self) -> tuple[DiagnosticAnswer, ...]:
        """Errors, and warnings found with them; options of the command as arguments of Python."""
        from phea._fields import fields_of
        from phea._words import python_words
        from phea.answers import DiagnosticAnswer

        rows = self.json["errors"]
        for row in rows:
            for name in ("message", "file", "expected", "help"):
                row[name] = row[name] and python_words(row[name])
        return tuple(DiagnosticAnswer(fields_of(DiagnosticAnswer, row)) for row in rows)


class NoAnswer(ProjectError):
    """A valid project lacks something that is asked of it."""


class Stopped(Exception):
    """A progress callable returned ``False``.

    Attributes
    ----------
    answer
        The result so far; ``None`` if there is none yet.
    """

    answer: Answer | None

    def __init__(self, message: str, answer: Answer | None = None) -> None:
        super().__init__(message)
        self.answer = answer


class Interrupted(Stopped, KeyboardInterrupt):
    """Ctrl-C during a command; ``answer`` is the result so far."""
