"""A project, and one method for each command."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from types import MappingProxyType

from phea import _native
from phea._request import answered, translated
from phea._shown import Shown
from phea._texts import held_files, setting, text_of, texts
from phea.errors import ProjectWarning

# `typing` takes longer to import than the package.
TYPE_CHECKING = False

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from typing import Any, Literal, TypeAlias, TypeVar

    from phea._native import Project as NativeProject
    from phea._record import Answer
    from phea._texts import PathLike, Value
    from phea.answers import (
        AlternativesAnswer,
        BenchAnswer,
        CampaignRunAnswer,
        CheckAnswer,
        LinearizeAnswer,
        ReportAnswer,
        SizeAnswer,
        VerifyAnswer,
    )

    from phea.bounds import Bounds, Templates
    from phea.linear import Family, Linear
    from phea.results import Campaign, Design, Simulation
    from phea.rig import Impedance, Stiffness
    from phea.shaping import Shaping

    AnyAnswer = TypeVar("AnyAnswer", bound=Answer)
    Progress: TypeAlias = bool | Callable[[str, float], object]


class Project(Shown):
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
        if found._native.warnings not in ("", self._native.warnings):
            warnings.warn(found._native.warnings, ProjectWarning, stacklevel=2)
        return found

    def with_laws_of(self, text: str | bytes) -> Project:
        """Project with the text of a shaped or designed one, which has its controller and prefilter.

        Settings of other tables stay; those of ``controller`` and ``prefilter`` are in the text.
        """
        kept = [one for one in self.settings if not one.startswith(("controller", "prefilter"))]
        files = held_files(self.path, text, {**self.files, self.path: text})
        return _held(self.path, files, kept, list(self.catalogues))

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

    def check(self) -> CheckAnswer:
        """Validates the project and derives every quantity: `phea check`."""
        from phea.answers import CheckAnswer

        return self._ask(CheckAnswer, "check", {}, False)

    def size(
        self, *, gain: str | float | None = None, length: str | float | None = None
    ) -> SizeAnswer:
        """Sizes the hose over the catalogue: `phea size`.

        Parameters
        ----------
        gain
            Proportional gain for which every hose is sized, V/N where no unit is given.
        length
            Length of each line for which the gain is found, m where no unit is given.
        """
        from phea.answers import SizeAnswer

        if gain is not None and length is not None:
            raise TypeError("size() takes a gain or a length, not both")
        return self._ask(SizeAnswer, "size", {"gain": text_of(gain), "length": text_of(length)}, False)

    def linearize(self, *, sweep: str | None = None, points: int | None = None) -> LinearizeAnswer:
        """Linear models, driving-point impedance and passivity: `phea linearize`.

        Parameters
        ----------
        sweep
            Number of the project that is varied, such as ``"line.length=0.5 m..3 m"``.
        points
            Number of values of the sweep, both ends included.
        """
        from phea.answers import LinearizeAnswer

        return self._ask(LinearizeAnswer, "linearize", {"sweep": sweep, "points": points}, False)

    def verify(
        self, *, prove: bool = False, on_machine: bool = False, progress: Progress = False
    ) -> VerifyAnswer:
        """Audits the controller for every plant and every frequency: `phea verify`.

        Parameters
        ----------
        prove
            Prove or refute the verdict by interval arithmetic; the certificate is among the files.
        on_machine
            Test the verdict in nonlinear simulation.
        progress
            ``True`` for a bar, or a callable that takes stage and fraction.

        Examples
        --------
        >>> import phea
        >>> audit = phea.example("ybitu/hose").verify()
        >>> audit.verdict, bool(audit), audit.specifications[0].kind
        ('violated', False, 'robust_stability')
        """
        from phea.answers import VerifyAnswer

        return self._ask(VerifyAnswer, "verify", {"prove": prove, "on_machine": on_machine}, progress)

    def design(
        self,
        *,
        seed: int | None = None,
        repair: bool = True,
        files: bool = False,
        progress: Progress = False,
    ) -> Design:
        """Finds a controller and a prefilter for the specifications: `phea design`.

        Parameters
        ----------
        seed
            Seed of the random starting points, instead of that of the project.
        repair
            Design again with a plant that contradicts the verdict in nonlinear simulation.
        files
            Every stage as a file, as with ``--out``.
        progress
            ``True`` for a bar, or a callable that takes stage and fraction.
        """
        from phea.results import Design

        options = {"seed": seed, "repair": repair, "files": files}
        return self._ask(Design, "design", options, progress, self)

    def simulate(
        self,
        *,
        format: Literal["csv", "parquet"] = "csv",
        figures: bool = True,
        check: bool = False,
        progress: Progress = False,
    ) -> Simulation:
        """Simulates the nonlinear machine in every scenario: `phea simulate`.

        Parameters
        ----------
        format
            Format of the tables over time.
        figures
            Figures among the files; they take most of the time of a short run.
        check
            Simulate each scenario a second time at a tenth of the tolerance.
        progress
            ``True`` for a bar, or a callable that takes stage and fraction.
        """
        from phea.results import Simulation

        options = {"format": format, "files": figures, "check": check}
        return self._ask(Simulation, "simulate", options, progress)

    def campaign(
        self,
        *,
        runs: int,
        seed: int = 1,
        out: PathLike | None = None,
        threads: int | None = None,
        files: bool = True,
        progress: Progress = False,
    ) -> Campaign:
        """Simulates the machine many times with random parameters: `phea campaign`.

        Parameters
        ----------
        runs
            Number of runs.
        seed
            Seed of all random numbers; with the index of a run it determines its parameters.
        out
            Table that grows row by row, and from which the same call continues.
        threads
            Number of threads; the rows do not depend on it.
        files
            The table for other programs and the figures among the files.
        progress
            ``True`` for a bar, or a callable that takes stage and fraction.
        """
        from phea.results import Campaign

        if isinstance(runs, int) and runs < 1:
            raise ValueError(f"runs is at least 1, not {runs}")
        table = None if out is None else os.fspath(out)
        options = {"runs": runs, "seed": seed, "threads": threads, "files": files, "table": table}
        return self._ask(Campaign, "campaign", options, progress, table)

    def campaign_run(self, run: int, *, seed: int = 1, progress: Progress = False) -> CampaignRunAnswer:
        """One run of a campaign in full, by its index: `phea campaign --run`."""
        from phea.answers import CampaignRunAnswer

        return self._ask(CampaignRunAnswer, "campaign", {"run": run, "seed": seed}, progress)

    def alternatives(
        self,
        *,
        front: str | None = None,
        sweep: str | None = None,
        points: int | None = None,
        frequencies: str | None = None,
        files: bool = True,
        progress: Progress = False,
    ) -> AlternativesAnswer:
        """Sizes, designs, audits and simulates each alternative: `phea alternatives`."""
        from phea.answers import AlternativesAnswer

        options = {"front": front, "sweep": sweep, "points": points}
        options |= {"frequencies": frequencies, "files": files}
        return self._ask(AlternativesAnswer, "alternatives", options, progress)

    def bench(self, *, progress: Progress = False) -> BenchAnswer:
        """Simulates static tests of the servovalve: `phea bench`."""
        from phea.answers import BenchAnswer

        return self._ask(BenchAnswer, "bench", {}, progress)

    def report(
        self, *, alternatives: bool = False, files: bool = False, progress: Progress = False
    ) -> ReportAnswer:
        """All results as one HTML page, ``report.files``: `phea report`."""
        from phea.answers import ReportAnswer

        options = {"alternatives": alternatives, "files": files}
        return self._ask(ReportAnswer, "report", options, progress)

    def shaping(self, *, prefilter: bool = False) -> Shaping:
        """Shapes the controller, or the prefilter, by hand: `phea shape`."""
        from phea.shaping import Shaping

        return Shaping(self, prefilter)

    def _ask(
        self,
        cls: type[AnyAnswer],
        name: str,
        options: dict[str, Any],
        progress: Progress,
        context: object = None,
    ) -> AnyAnswer:
        return answered(
            cls, name, lambda report: self._native.answer(name, options, report), progress, context
        )


def _warned(native: NativeProject) -> Project:
    if native.warnings:
        warnings.warn(native.warnings, ProjectWarning, stacklevel=3)
    return Project(native)


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
        return _warned(_native.Project.read(os.fspath(path), settings, texts(catalogues)))
    except _native.Refused as refused:
        raise translated(refused) from None


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
    return _warned(native)
