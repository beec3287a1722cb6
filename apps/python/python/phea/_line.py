"""The line that a record prints: its result, as far as a line has room."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

# Attributes of every answer that do not tell it from another one.
_UNSHOWN = {"schema", "version", "command", "project_sha256", "catalogue_files", "warnings"}
# Attributes of a part that name it, and those that are its result.
_NAMES = ("name", "kind", "title", "file")
_RESULTS = ("verdict", "status", "value")
# Number of values in the line.
_SHOWN = 8
# Longest text in the line, and most values of a list.
_LONGEST, _MOST = 40, 4


def line_of(name: str, fields: Mapping[str, Any]) -> str:
    """The line: numbers and texts first, then the parts, as far as there is room."""
    shown = [*_scalars(fields), *_lists(fields), *_nested(fields)]
    if len(shown) > _SHOWN:
        shown = [*shown[:_SHOWN], "..."]
    return f"{name}({', '.join(shown)})"


def _scalars(fields: Mapping[str, Any], within: str = "") -> Iterator[str]:
    for name, value in fields.items():
        if name in _UNSHOWN or name.endswith("_reason"):
            continue
        if _is_scalar(value):
            yield f"{within}{name}={_short(value)}"
        elif isinstance(value, tuple) and 0 < len(value) <= _MOST and all(map(_is_scalar, value)):
            yield f"{within}{name}=({', '.join(map(_short, value))})"


def _lists(fields: Mapping[str, Any]) -> Iterator[str]:
    """Parts by their names, with their results."""
    for name, value in fields.items():
        if name in _UNSHOWN or not isinstance(value, tuple) or not value:
            continue
        if all(map(_is_scalar, value)) and len(value) <= _MOST:
            continue
        parts = [_part(getattr(one, "__dict__", {})) for one in value]
        if len(parts) <= _MOST and all(parts):
            yield f"{name}=({', '.join(parts)})"
        else:
            yield f"{name}=({len(value)} value{'s' if len(value) > 1 else ''})"


def _part(fields: Mapping[str, Any]) -> str:
    named = next((fields[key] for key in _NAMES if isinstance(fields.get(key), str)), "")
    result = next((fields[key] for key in _RESULTS if _is_scalar(fields.get(key))), None)
    return named and (_short(named) if result is None else f"{_short(named)}: {_short(result)}")


def _nested(fields: Mapping[str, Any]) -> Iterator[str]:
    for name, value in fields.items():
        if hasattr(value, "__dict__"):
            yield from _scalars(vars(value), f"{name}.")


def _is_scalar(value: object) -> bool:
    return isinstance(value, str | float | int)


def _short(value: str | float | int) -> str:
    if isinstance(value, str) and len(value) > _LONGEST:
        return repr(value[: _LONGEST - 3] + "...")
    if isinstance(value, float):
        return f"{value:.6g}"
    return repr(value)
