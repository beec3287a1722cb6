"""The extension of the package."""

from typing import Any, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

VERSION: str

class Refused(Exception): ...

@final
class Answer:
    @property
    def json(self) -> str: ...
    @property
    def text(self) -> str: ...
    @property
    def affirmative(self) -> bool: ...
    @property
    def stopped(self) -> BaseException | bool | None: ...
    def html(self) -> str: ...
    def figures(self) -> dict[str, bytes]: ...
    def files(self) -> dict[str, bytes]: ...

@final
class Project:
    @staticmethod
    def read(path: str, settings: list[str], catalogues: list[str]) -> Project: ...
    @staticmethod
    def held(
        path: str, files: list[tuple[str, bytes]], settings: list[str], catalogues: list[str]
    ) -> Project: ...
    @property
    def path(self) -> str: ...
    @property
    def text(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def sha256(self) -> str: ...
    @property
    def settings(self) -> list[str]: ...
    @property
    def catalogues(self) -> list[str]: ...
    @property
    def warnings(self) -> str: ...
    def files(self) -> dict[str, bytes]: ...
    def answer(self, name: str, options: dict[str, Any], callable: object = None) -> Answer: ...

_Factors: TypeAlias = tuple[
    float, NDArray[np.complex128], NDArray[np.complex128], float, float | None
]
_Gains: TypeAlias = tuple[
    NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]
]
_Curve: TypeAlias = tuple[str, NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]
_Port: TypeAlias = tuple[_Factors, NDArray[np.complex128]]

def unit_of(name: str) -> str: ...
def picture_of(svg: bytes, scale: float = 2.0) -> bytes: ...
def stiffness(
    project: Project,
) -> (
    tuple[bool, NDArray[np.float64], _Curve, _Curve, list[float], list[float], float] | None
): ...
def impedance(
    project: Project,
) -> tuple[bool, NDArray[np.float64], _Port, _Port | None] | None: ...
def templates_and_bounds(
    project: Project, callable: object = None
) -> tuple[
    list[str],
    int,
    list[
        tuple[
            float,
            NDArray[np.float64],
            NDArray[np.complex128],
            complex | None,
            list[tuple[int | None, str, _Gains]],
            _Gains,
        ]
    ],
]: ...
def examples() -> dict[str, bytes]: ...
def columns(text: bytes) -> dict[str, NDArray[np.float64] | list[str]]: ...
def compare(projects: list[Project], callable: object = None) -> Answer: ...
def identify(
    of: str,
    files: list[str],
    project: Project | None,
    options: dict[str, Any],
    callable: object = None,
) -> Answer: ...
def check_certificate(text: str, project: Project | None = None) -> Answer: ...
def transfer_functions(
    project: Project,
) -> dict[
    str, tuple[float, NDArray[np.complex128], NDArray[np.complex128], float, float | None]
]: ...

@final
class Family:
    def __new__(cls, project: Project) -> Family: ...
    @property
    def parameters(self) -> list[str]: ...
    @property
    def members(self) -> NDArray[np.float64]: ...
    def member(
        self, values: list[float]
    ) -> (
        tuple[float, NDArray[np.complex128], NDArray[np.complex128], float, float | None] | None
    ): ...
    def loop(
        self, values: list[float]
    ) -> (
        dict[
            str,
            tuple[float, NDArray[np.complex128], NDArray[np.complex128], float, float | None],
        ]
        | None
    ): ...
    def response(
        self, values: list[float], frequencies: list[float]
    ) -> NDArray[np.complex128]: ...
    def measured(
        self,
    ) -> list[tuple[str, NDArray[np.float64], NDArray[np.complex128]]]: ...

def run_command(words: list[str]) -> int: ...
def campaign_lines(
    project: Project,
    seed: int,
    first: int,
    end: int,
    threads: int | None = None,
    callable: object = None,
) -> str: ...

@final
class CampaignTable:
    def __new__(cls, path: str) -> CampaignTable: ...
    def stored(self, project: Project, seed: int, runs: int) -> int: ...
    def append(self, lines: str) -> None: ...
    def close(self) -> None: ...
