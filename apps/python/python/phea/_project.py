"""A project with its files: a value that is read, changed and compared."""

from __future__ import annotations

import os
from collections.abc import Mapping
from types import MappingProxyType

from phea import _native
from phea._commands import Commands
from phea._request import translated
from phea._shown import Shown
from phea._texts import held_files, setting, texts
from phea._warnings import warn_of

# `typing` takes longer to import than the package.
TYPE_CHECKING = False

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

    from phea._commands import Progress as Progress
    from phea._native import Project as NativeProject
    from phea._texts import PathLike, Value
    from phea.bounds import Bounds, Templates
    from phea.linear import Family, Linear
    from phea.rig import Impedance, Stiffness
    from phea.shaping import Shaping


class Project(Commands, Shown):
    """Rig, controller and specifications of a project file, with all files that it names.

    A project is a value: `set` returns another one. It compares by its files and settings, and
    pickles with the bytes of its files, so that another computer needs no shared disk.
    """

    __slots__ = ("_native",)

    _native: NativeProject

    def __init__(self, native: NativeProject) -> None:
        object.__setattr__(self, "_native", native)

    @property
    def path(self) -> str:
        """Path of the project file, as given."""
        return self._native.path

    @property
    def title(self) -> str:
        """Title of the project."""
        return self._native.title

    @property
    def text(self) -> str:
        """Text of the project file, with its comments, before `settings`."""
        return self._native.text

    @property
    def sha256(self) -> str:
        """SHA-256 of the project file, in hexadecimal."""
        return self._native.sha256

    @property
    def settings(self) -> tuple[str, ...]:
        """Settings that replace values of the file, each ``path=value``, in order."""
        return tuple(self._native.settings)

    @property
    def catalogues(self) -> tuple[str, ...]:
        """Catalogue files and folders that are searched before the built-in catalogue."""
        return tuple(self._native.catalogues)

    @property
    def files(self) -> Mapping[str, bytes]:
        """All files of the project by their paths."""
        return MappingProxyType(self._native.files())

    def set(self, values: Mapping[str, Value]) -> Project:
        """Project with other values.

        Parameters
        ----------
        values
            Values by the paths of their keys: texts with units, or numbers in SI.

        Returns
        -------
        Project
            The new project; this one stays as it is.

        Raises
        ------
        ProjectError
            If there is no such key, or its value is not accepted.

        Examples
        --------
        >>> import phea
        >>> rig = phea.example("ybitu/hose")
        >>> rig.set({"line.length": "2 m"}) == rig.set({"line.length": "2 m"})
        True
        """
        if not isinstance(values, Mapping):
            raise TypeError(f"values is a mapping from paths of keys to values, not {values!r}")
        more = [setting(path, value) for path, value in values.items()]
        found = _held(self.path, self.files, [*self.settings, *more], list(self.catalogues))
        warn_of(found._native, self._native)
        return found

    def with_laws_of(self, text: str | bytes) -> Project:
        """Project with the text of a shaped or designed one, which has its controller and prefilter.

        Settings of other tables stay; those of ``controller`` and ``prefilter`` are in the text.
        """
        kept = [one for one in self.settings if not one.startswith(("controller", "prefilter"))]
        files = held_files(self.path, text, {**self.files, self.path: text})
        found = _held(self.path, files, kept, list(self.catalogues))
        warn_of(found._native, self._native)
        return found

    @property
    def linear(self) -> Linear:
        """Transfer functions of the project, as arrays of zeros and poles."""
        from phea.linear import Linear

        return Linear(self)

    @property
    def family(self) -> Family:
        """Family of plants: parameters, members, responses."""
        from phea.linear import Family

        return Family(self)

    @property
    def templates(self) -> Templates:
        """Responses of the plants at the design frequencies; computed anew at each use."""
        from phea.bounds import Templates

        return Templates.of(self)

    @property
    def bounds(self) -> Bounds:
        """Bounds of the nominal loop at the design frequencies; computed anew at each use."""
        from phea.bounds import Bounds

        return Bounds.of(self)

    @property
    def stiffness(self) -> Stiffness | None:
        """Hydraulic stiffness over the stroke; ``None`` without a rig."""
        from phea.rig import Stiffness

        return Stiffness.of(self)

    @property
    def impedance(self) -> Impedance | None:
        """Driving-point impedance of the rig; ``None`` without a rig."""
        from phea.rig import Impedance

        return Impedance.of(self)

    def shaping(self, *, prefilter: bool = False) -> Shaping:
        """Shapes the controller, or the prefilter, by hand: `phea shape`."""
        from phea.shaping import Shaping

        return Shaping(self, prefilter)

    def _state(self) -> tuple[Any, ...]:
        return (self.path, tuple(sorted(self.files.items())), self.settings, self.catalogues)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Project):
            return NotImplemented
        return self._state() == other._state()

    def __hash__(self) -> int:
        return hash((self.path, self.sha256, self.settings))

    def __reduce__(self) -> tuple[Any, ...]:
        return (_held, (self.path, dict(self.files), list(self.settings), list(self.catalogues)))

    def __copy__(self) -> Project:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Project:
        return self

    def __repr__(self) -> str:
        changed = f", settings={list(self.settings)}" if self.settings else ""
        return f"Project({self.path!r}, title={self.title!r}{changed})"

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a project cannot be changed: use set() for another one, not {name} = ...")


def _held(
    path: str, files: Mapping[str, bytes], settings: list[str], catalogues: list[str]
) -> Project:
    try:
        return Project(_native.Project.held(path, list(files.items()), settings, catalogues))
    except _native.Refused as refused:
        raise translated(refused) from None


def read(
    path: PathLike,
    *,
    set: Mapping[str, Value] | None = None,
    catalogues: Sequence[PathLike] = (),
) -> Project:
    """Reads a project file, and every file that it names.

    Parameters
    ----------
    path
        Project file.
    set
        Values that replace those of the file, by the paths of their keys.
    catalogues
        Catalogue files and folders that are searched before the built-in catalogue.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ProjectError
        If the project contains errors: all of them, with line and column.
    """
    with open(path, "rb"):  # a missing or unreadable file is an OSError
        settings = [setting(key, value) for key, value in (set or {}).items()]
    try:
        native = _native.Project.read(os.fspath(path), settings, texts(catalogues))
    except _native.Refused as refused:
        raise translated(refused) from None
    warn_of(native)
    return Project(native)


def loads(
    text: str | bytes,
    *,
    files: Mapping[str, str | bytes] | None = None,
    path: str = "project.toml",
    set: Mapping[str, Value] | None = None,
    catalogues: Sequence[PathLike] = (),
) -> Project:
    """Reads a project from a text; it touches no disk.

    Parameters
    ----------
    text
        Text of the project file.
    files
        Files that it names, by their paths relative to that of the project.
    path
        Path of the project, for messages.
    set
        Values that replace those of the file, by the paths of their keys.
    catalogues
        Catalogue files and folders among `files`.

    Raises
    ------
    ProjectError
        If the project contains errors: all of them, with line and column.
    """
    held = held_files(path, text, files or {})
    settings = [setting(key, value) for key, value in (set or {}).items()]
    try:
        native = _native.Project.held(path, list(held.items()), settings, texts(catalogues))
    except _native.Refused as refused:
        raise translated(refused) from None
    warn_of(native)
    return Project(native)
