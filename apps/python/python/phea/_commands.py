"""The commands on a project: one method for each."""

from __future__ import annotations

import os

from phea._request import MOST_POINTS, alternatives_options, answered
from phea._texts import text_of, whole

# `typing` takes longer to import than the package.
TYPE_CHECKING = False

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any, Literal, TypeAlias, TypeVar

    from phea import answers
    from phea._native import Project as NativeProject
    from phea._record import Answer
    from phea._texts import PathLike
    from phea.results import Campaign, Check, Design, Simulation

    AnyAnswer = TypeVar("AnyAnswer", bound=Answer)
    ExportKind: TypeAlias = Literal["c", "st", "ros2", "matlab", "python"]
    Progress: TypeAlias = bool | Callable[[str, float], object]

# Greatest seed, number of runs, and number of threads.
MOST_SEED, MOST_RUNS, _MOST_THREADS = 2**32 - 1, 2**64 - 1, 2**16 - 1


class Commands:
    """What a project answers."""

    __slots__ = ()

    _native: NativeProject

    def check(self) -> Check:
        """Validates the project and derives every quantity: `phea check`."""
        from phea.results import Check

        return self._ask(Check, "check", {}, False)

    def size(
        self, *, gain: str | float | None = None, length: str | float | None = None
    ) -> answers.SizeAnswer:
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

    def linearize(
        self, *, sweep: str | None = None, points: int | None = None
    ) -> answers.LinearizeAnswer:
        """Linear models, driving-point impedance and passivity: `phea linearize`.

        Parameters
        ----------
        sweep
            Number of the project that is varied, such as ``"line.length=0.5 m..3 m"``.
        points
            Number of values of the sweep, both ends included.
        """
        from phea.answers import LinearizeAnswer

        if points is not None and sweep is None:
            raise TypeError("linearize() takes points with a sweep")
        whole("points", points, 1, MOST_POINTS)
        return self._ask(LinearizeAnswer, "linearize", {"sweep": sweep, "points": points}, False)

    def verify(
        self, *, prove: bool = False, on_machine: bool = False, progress: Progress = False
    ) -> answers.VerifyAnswer:
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

        whole("seed", seed, 0, MOST_SEED)
        options = {"seed": seed, "repair": repair, "files": files}
        return self._ask(Design, "design", options, progress, self)

    def simulate(
        self,
        *,
        format: Literal["csv", "parquet"] = "csv",
        figures: bool = True,
        check: bool = False,
        frequency_response: bool = False,
        frequencies: str | None = None,
        amplitude: str | float | None = None,
        reference_amplitude: str | float | None = None,
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
        frequency_response
            Simulate the response to sines around the operating point instead of the scenarios.
        frequencies
            Their frequencies, such as ``"1, 10, 100 rad/s"``.
        amplitude, reference_amplitude
            Amplitudes of the command of the open loop, V, and of the reference of the closed one, N.
        progress
            ``True`` for a bar, or a callable that takes stage and fraction.
        """
        from phea.results import Simulation

        of_sines = {"frequencies": frequencies, "amplitude": text_of(amplitude)}
        of_sines |= {"reference_amplitude": text_of(reference_amplitude)}
        if not frequency_response and any(value is not None for value in of_sines.values()):
            raise TypeError(f"simulate() takes {', '.join(of_sines)} with frequency_response=True")
        if frequency_response and check:
            raise TypeError("simulate() takes check or frequency_response, not both")
        options: dict[str, Any] = {"format": format, "files": figures, "check": check}
        options |= {"frequency_response": frequency_response, **of_sines}
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

        whole("runs", runs, 1, MOST_RUNS)
        whole("seed", seed, 0, MOST_SEED)
        whole("threads", threads, 1, _MOST_THREADS)
        table = None if out is None else os.fspath(out)
        options = {"runs": runs, "seed": seed, "threads": threads, "files": files, "table": table}
        return self._ask(Campaign, "campaign", options, progress, table)

    def campaign_run(
        self, run: int, *, seed: int = 1, progress: Progress = False
    ) -> answers.CampaignRunAnswer:
        """One run of a campaign in full, by its index: `phea campaign --run`.

        Parameters
        ----------
        run
            Index of the run.
        seed
            Seed of the campaign.
        progress
            ``True`` for a bar, or a callable that takes stage and fraction.
        """
        from phea.answers import CampaignRunAnswer

        whole("run", run, 0, MOST_RUNS)
        whole("seed", seed, 0, MOST_SEED)
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
    ) -> answers.AlternativesAnswer:
        """Sizes, designs, audits and simulates each alternative: `phea alternatives`.

        Parameters
        ----------
        front
            Columns of a Pareto front, such as ``"disturbance_peak_n,swept"``.
        sweep
            Number of the project that is varied for the front.
        points
            Number of values of the sweep, both ends included.
        frequencies
            Frequencies at which the impedance at the load is stated, ``"1, 10, 100 rad/s"``.
        files
            The table, the designed projects and the figures among the files.
        progress
            ``True`` for a bar, or a callable that takes stage and fraction.
        """
        from phea.answers import AlternativesAnswer

        options = alternatives_options(front, sweep, points, frequencies, files)
        return self._ask(AlternativesAnswer, "alternatives", options, progress)

    def bench(self, *, progress: Progress = False) -> answers.BenchAnswer:
        """Simulates static tests of the servovalve, with `progress` as `verify`: `phea bench`."""
        from phea.answers import BenchAnswer

        return self._ask(BenchAnswer, "bench", {}, progress)

    def export(self, kind: ExportKind, *, progress: Progress = False) -> answers.ExportAnswer:
        """The controller, as it was verified, as source in ``export.files``: `phea export`.

        Parameters
        ----------
        kind
            Language: ``"c"``, ``"st"``, ``"ros2"``, ``"matlab"`` or ``"python"``.
        progress
            ``True`` for a bar, or a callable that takes stage and fraction.
        """
        from phea.answers import ExportAnswer

        return self._ask(ExportAnswer, "export", {"kind": kind}, progress)

    def report(
        self, *, alternatives: bool = False, files: bool = False, progress: Progress = False
    ) -> answers.ReportAnswer:
        """All results as one HTML page, ``report.files``: `phea report`.

        Parameters
        ----------
        alternatives
            A chapter on the alternatives; a controller is designed for each.
        files
            The tables and figures of the page among the files.
        progress
            ``True`` for a bar, or a callable that takes stage and fraction.
        """
        from phea.answers import ReportAnswer

        options = {"alternatives": alternatives, "files": files}
        return self._ask(ReportAnswer, "report", options, progress)

    def _ask(
        self, cls: type[AnyAnswer], name: str, options: dict[str, Any], progress: Progress, *context: Any
    ) -> AnyAnswer:
        return answered(
            cls, name, lambda report: self._native.answer(name, options, report), progress, *context
        )
