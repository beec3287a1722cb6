"""Requests on several projects, on recordings, and on a certificate."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

from phea import _native
from phea._commands import MOST_SEED
from phea._project import Project
from phea._request import answered
from phea._texts import whole

if TYPE_CHECKING:
    from phea._native import Project as NativeProject
    from phea._project import Progress
    from phea._texts import PathLike
    from phea.answers import (
        CheckCertificateAnswer,
        CompareAnswer,
        IdentifiedFrictionAnswer,
        IdentifiedLineAnswer,
        IdentifiedResponsesAnswer,
        IdentifiedValveAnswer,
    )

    IdentifiedAnswer = (
        IdentifiedFrictionAnswer
        | IdentifiedLineAnswer
        | IdentifiedResponsesAnswer
        | IdentifiedValveAnswer
    )


_MOST_STARTS = 2**16 - 1
# Fewest and most repetitions of a bootstrap, as of the command.
_REPETITIONS = (50, 1_000_000)


def compare(*projects: Project, progress: Progress = False) -> CompareAnswer:
    """Simulates the scenarios of several projects and compares the results: `phea compare`.

    Parameters
    ----------
    projects
        The projects, each with its own path.
    progress
        ``True`` for a bar, or a callable that takes stage and fraction.

    Examples
    --------
    >>> import phea
    >>> hose, pipe = phea.example("ybitu/hose"), phea.example("ybitu/pipe")
    >>> len(compare(hose, pipe).json["projects"])
    2
    """
    from phea.answers import CompareAnswer

    if not projects or not all(isinstance(project, Project) for project in projects):
        raise TypeError("compare() takes one project or more")
    natives = [project._native for project in projects]
    return answered(
        CompareAnswer, "compare", lambda report: _native.compare(natives, report), progress
    )


def identify(
    files: Sequence[PathLike] = (),
    *,
    of: Literal["valve", "response", "line", "friction"] = "valve",
    project: Project | None = None,
    starts: int | None = None,
    seed: int | None = None,
    bootstrap: int | None = None,
    leakage_model: Literal["each_edge", "one_curve"] | None = None,
    period: str | float | None = None,
    settling: str | float | None = None,
    segment: str | float | None = None,
    coherence: float | None = None,
    side: Literal["A", "B"] | None = None,
    progress: Progress = False,
) -> IdentifiedAnswer:
    """Identifies coefficients from recorded tests: `phea identify`.

    Parameters
    ----------
    files
        Tables of recorded tests; none if the project names them.
    of
        Part to identify.
    project
        Project of the rig, with what the files lack.
    starts, seed, bootstrap, leakage_model
        Of a valve: starting points of the search, seed, repetitions of a bootstrap, model of the
        leakage.
    period, settling, segment, coherence
        Of a response or a line: period of the input, time to discard, length of a segment (s where
        no unit is given), least squared coherence.
    side
        Chamber to which an identified line leads.
    progress
        ``True`` for a bar, or a callable that takes stage and fraction.
    """
    from phea import answers

    classes: dict[str, type[IdentifiedAnswer]] = {
        "valve": answers.IdentifiedValveAnswer,
        "response": answers.IdentifiedResponsesAnswer,
        "line": answers.IdentifiedLineAnswer,
        "friction": answers.IdentifiedFrictionAnswer,
    }
    if of not in classes:
        raise ValueError(f"of is one of {', '.join(classes)}, not {of!r}")
    if period is not None and segment is not None:
        raise TypeError("identify() takes a period or a segment, not both")
    whole("starts", starts, 1, _MOST_STARTS)
    whole("seed", seed, 0, MOST_SEED)
    whole("bootstrap", bootstrap, *_REPETITIONS)
    options: dict[str, Any] = {
        "starts": starts,
        "seed": seed,
        "bootstrap": bootstrap,
        "leakage_model": leakage_model,
        "period": _text(period),
        "settling": _text(settling),
        "segment": _text(segment),
        "coherence": coherence,
        "side": side,
    }
    paths = [os.fspath(path) for path in files]
    for path in paths:
        with open(path, "rb"):  # a missing or unreadable file is an OSError
            pass
    native = _native_of(project)
    return answered(
        classes[of],
        "identify",
        lambda report: _native.identify(of, paths, native, options, report),
        progress,
    )


def check_certificate(
    certificate: str | bytes, project: Project | None = None
) -> CheckCertificateAnswer:
    """Checks every claim of a certificate: `phea check-certificate`.

    Parameters
    ----------
    certificate
        Text of the certificate that `Project.verify` with ``prove=True`` has among its files.
    project
        Project whose plant, box, laws and specifications must be those of the certificate.
    """
    from phea.answers import CheckCertificateAnswer

    text = certificate.decode() if isinstance(certificate, bytes) else certificate
    native = _native_of(project)
    return answered(
        CheckCertificateAnswer,
        "check-certificate",
        lambda _: _native.check_certificate(text, native),
        False,
    )


def _text(value: str | float | None) -> str | None:
    return value if value is None or isinstance(value, str) else f"{float(value)!r} s"


def _native_of(project: Project | None) -> NativeProject | None:
    if project is None:
        return None
    if not isinstance(project, Project):
        raise TypeError(f"project is a phea.Project, not {project!r}")
    return project._native
