"""Values, paths and contents as the texts and bytes that the extension takes."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence

# `typing` takes longer to import than the package.
TYPE_CHECKING = False

if TYPE_CHECKING:
    from typing import Any, TypeAlias

    Value: TypeAlias = str | float | int | bool | Sequence[Any] | Mapping[str, Any]
    PathLike: TypeAlias = str | os.PathLike[str]


def toml(value: object) -> str:
    """A value as it is written in a project file."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, int):
        return str(value)
    if isinstance(value, Mapping):
        inside = ", ".join(f'"{key}" = {toml(part)}' for key, part in value.items())
        return "{ " + inside + " }" if inside else "{}"
    if isinstance(value, Sequence):
        return "[" + ", ".join(toml(part) for part in value) + "]"
    if hasattr(value, "__float__"):
        return repr(float(value))
    raise TypeError(f"a value of a project is a number, a text, a list or a mapping, not {value!r}")


def setting(path: object, value: object) -> str:
    if not isinstance(path, str):
        raise TypeError(f"the path of a key is a text such as 'line.length', not {path!r}")
    return f"{path}={value if isinstance(value, str) else toml(value)}"


def texts(paths: Sequence[PathLike]) -> list[str]:
    if isinstance(paths, str | os.PathLike):
        raise TypeError(f"catalogues is a list of paths, not {paths!r}")
    return [os.fspath(path) for path in paths]


def whole(name: str, value: object, least: int, most: int) -> None:
    """An error unless the value is absent, or a whole number in this range."""
    if value is None:
        return
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        raise TypeError(f"{name} is a whole number, not {value!r}")
    number = value.__index__()
    if number < least:
        raise ValueError(f"{name} is at least {least}, not {number}")
    if number > most:
        raise ValueError(f"{name} is at most {most}, not {number}")


def text_of(value: str | float | None) -> str | None:
    return value if value is None or isinstance(value, str) else repr(float(value))


def held_files(
    path: str, text: str | bytes, files: Mapping[str, str | bytes]
) -> dict[str, bytes]:
    """Bytes of a project file and of the files that it names, by their paths."""
    if not isinstance(path, str):
        raise TypeError(f"path is a text, not {path!r}")
    if not isinstance(files, Mapping):
        raise TypeError(f"files is a mapping from paths to contents, not {files!r}")
    contents = {path: text} | dict(files)
    for name, data in contents.items():
        if not isinstance(name, str) or not isinstance(data, str | bytes):
            raise TypeError(f"a file is a text or bytes by its path, not {name!r}: {data!r}")
    return {
        name: data.encode() if isinstance(data, str) else data for name, data in contents.items()
    }
