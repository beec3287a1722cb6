"""Projects with another text, other files and the same settings."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import PurePath

from phea import _native
from phea._project import Project
from phea._request import translated
from phea._texts import toml
from phea._warnings import warn_of

# Tables of a declared plant; a rig has others.
PLANTS = ["plant", "family", "uncertainty", "uncertainty_direction"]
_EMPTY = "schema = 1\ntitle = {title}\n"


def text_of_plant(project: Project | None, title: str) -> str:
    """Text of the project, which must not be that of a rig."""
    if project is None:
        return _EMPTY.format(title=toml(title))
    rig = [name for name in ("cylinder", "motor") if name in tomllib.loads(project.text)]
    if rig:
        raise ValueError(f"expected a project of [plant] or of measured plants; found [{rig[0]}]")
    return project.text


def made(
    project: Project | None, text: str, replaced_paths: list[str], files: Mapping[str, bytes]
) -> Project:
    """Project of this text with the other files and settings of another one."""
    path, held, settings, catalogues = "project.toml", dict[str, bytes](), list[str](), list[str]()
    if project is not None:
        path, held = project.path, dict(project.files)
        catalogues = list(project.catalogues)
        for setting in project.settings:
            name = setting.partition("=")[0].strip()
            if any(one.startswith(name + ".") for one in replaced_paths):
                raise ValueError(f"expected no setting of the whole table; found {setting!r}")
            if not any(
                name == one or name.startswith((one + ".", one + "[")) for one in replaced_paths
            ):
                settings.append(setting)
    folder = PurePath(path).parent
    held |= {(folder / name).as_posix(): data for name, data in files.items()}
    held[path] = text.encode()
    try:
        native = _native.Project.held(path, list(held.items()), settings, catalogues)
    except _native.Refused as refused:
        raise translated(refused) from None
    warn_of(native, None if project is None else project._native)
    return Project(native)
