"""The example projects that the package contains."""

from __future__ import annotations

from difflib import get_close_matches

from phea import _native
from phea._project import Project, loads


def examples() -> tuple[str, ...]:
    """Names of the example projects.

    Examples
    --------
    >>> "ybitu/hose" in examples()
    True
    """
    # entries of a catalogue belong to the project that names them
    names = (name for name in _native.examples() if not name.startswith("hoses/"))
    return tuple(name.removesuffix(".toml") for name in names if name.endswith(".toml"))


def example(name: str) -> Project:
    """Example project of this name, with the files that it names.

    Examples
    --------
    >>> example("ybitu/hose").title
    'Ybitu rig, 1.5 m of HVE hose'
    """
    if name not in examples():
        near = get_close_matches(name, examples(), 1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        raise ValueError(f"no example is called {name!r}{hint}")
    files = _native.examples()
    path = f"{name}.toml"
    return loads(files[path], files=files, path=path)
