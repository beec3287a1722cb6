"""The example projects that the package contains."""

from __future__ import annotations

from difflib import get_close_matches
from pathlib import Path

from phea._project import Project, read

_FOLDER = Path(__file__).parent / "examples"


def examples() -> tuple[str, ...]:
    """Names of the example projects.

    Examples
    --------
    >>> "ybitu/hose" in examples()
    True
    """
    return tuple(sorted(path.relative_to(_FOLDER).with_suffix("").as_posix() for path in _projects()))


def example(name: str) -> Project:
    """Example project of this name.

    Examples
    --------
    >>> example("ybitu/hose").title
    'Ybitu test rig, load side, with high-expansion hoses'
    """
    path = _FOLDER / f"{name}.toml"
    if path not in set(_projects()):
        near = get_close_matches(name, examples(), 1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        raise ValueError(f"no example is called {name!r}{hint}")
    return read(path)


def _projects() -> list[Path]:
    # entries of a catalogue, and projects that are wrong on purpose, belong to the book
    others = {"errors", "hoses"}
    return [path for path in sorted(_FOLDER.rglob("*.toml")) if others.isdisjoint(path.parts)]
