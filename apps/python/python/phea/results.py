"""Answers with more than the keys of their JSON: a designed project, runs, rows of a campaign."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING, Any, SupportsIndex, overload

from phea.answers import (
    CampaignAnswer,
    CheckAnswer,
    DerivedQuantityAnswer,
    DesignCommandAnswer,
    ScenarioAnswer,
    SimulateAnswer,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    import pandas as pd
    import pyarrow as pa

    from phea._project import Project
    from phea.table import Table

__all__ = ["Campaign", "Check", "Derived", "Design", "Run", "Simulation"]


class Derived(tuple[DerivedQuantityAnswer, ...]):
    """Derived quantities in the order of the command, which are also found by their names.

    Examples
    --------
    >>> import phea
    >>> derived = phea.example("ybitu/hose").check().derived
    >>> derived["line.volume"].unit, "line.volume" in derived, derived[0].name
    ('m3', True, 'cylinder.area_a')
    """

    __slots__ = ()

    @property
    def names(self) -> tuple[str, ...]:
        """The names, in order."""
        return tuple(one.name for one in self)

    @overload
    def __getitem__(self, key: str) -> DerivedQuantityAnswer: ...
    @overload
    def __getitem__(self, key: SupportsIndex) -> DerivedQuantityAnswer: ...
    @overload
    def __getitem__(self, key: slice) -> tuple[DerivedQuantityAnswer, ...]: ...
    def __getitem__(self, key: str | SupportsIndex | slice) -> Any:
        if not isinstance(key, str):
            return super().__getitem__(key)
        found = next((one for one in self if one.name == key), None)
        if found is None:
            near = get_close_matches(key, self.names, 1)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            raise KeyError(f"no derived quantity is called {key!r}{hint}")
        return found

    def __contains__(self, value: object) -> bool:
        return value in self.names if isinstance(value, str) else super().__contains__(value)


class Check(CheckAnswer):
    """Answer of `Project.check`, whose derived quantities are found by their names."""

    __slots__ = ()

    @property
    def derived(self) -> Derived:  # type: ignore[override]
        """Quantities that follow from the project."""
        return Derived(self._fields()["derived"])


class Design(DesignCommandAnswer):
    """Answer of `Project.design`, with the designed project."""

    __slots__ = ()

    @property
    def project(self) -> Project:
        """The project with the designed controller and prefilter; comments and settings stay."""
        found: Project = self._context
        return found.with_laws_of(self.files["designed.toml"])


class Run:
    """Run of a scenario: its columns over time, and what the answer says about it.

    A column is ``run["force_n"]`` or ``run.force_n``: a read-only array of float64. Everything else
    is an attribute of `metrics`, such as ``run.events``.
    """

    __slots__ = ("metrics", "table")

    metrics: ScenarioAnswer
    table: Table

    def __init__(self, metrics: ScenarioAnswer, table: Table) -> None:
        self.metrics = metrics
        self.table = table

    def __getitem__(self, name: str) -> Any:
        return self.table[name]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        if name in type(self.metrics).__annotations__:
            return getattr(self.metrics, name)
        return getattr(self.table, name)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Run) and (self.metrics, self.table) == (other.metrics, other.table)

    def __hash__(self) -> int:
        return hash((self.metrics, self.table))

    def __repr__(self) -> str:
        return f"Run({self.metrics.name!r}, status={self.metrics.status!r}, {self.table!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return (Run, (self.metrics, self.table))

    def to_pandas(self) -> pd.DataFrame:
        """The columns as a pandas frame with their units in ``attrs``."""
        return self.table.to_pandas()

    def to_arrow(self) -> pa.Table:
        """The columns as an Arrow table with their units in the metadata."""
        return self.table.to_arrow()


class Simulation(SimulateAnswer):
    """Answer of `Project.simulate`: a mapping from scenarios to their runs.

    Examples
    --------
    >>> import phea
    >>> runs = phea.example("ybitu/hose").simulate(figures=False)
    >>> list(runs)[0], runs["force steps"].time_s[0]
    ('step and load motion', np.float64(0.0))
    """

    __slots__ = ()

    def __iter__(self) -> Iterator[str]:
        return (scenario.name for scenario in self.scenarios)

    def __len__(self) -> int:
        return len(self.scenarios)

    def __getitem__(self, name: str) -> Run:
        found = {scenario.name: scenario for scenario in self.scenarios}
        if name not in found:
            near = get_close_matches(str(name), found, 1)
            hint = f"; did you mean {near[0]!r}?" if near else f"; there are {', '.join(found)}"
            raise KeyError(f"no scenario is called {name!r}{hint}")
        return Run(found[name], self.tables[name])


class Campaign(CampaignAnswer):
    """Answer of `Project.campaign`, with its rows."""

    __slots__ = ()

    @property
    def rows(self) -> Table:
        """The rows, one for each run; with ``out``, as the table has them now."""
        from phea.table import Table

        units = {one.path: one.unit for one in self.parameters}
        if self._context is None:
            return Table(self.files["runs.csv"], units)
        with open(self._context, "rb") as table:
            return Table(table.read(), units)

    def to_pandas(self) -> pd.DataFrame:
        """The rows as a pandas frame with their units in ``attrs``."""
        return self.rows.to_pandas()

    def to_arrow(self) -> pa.Table:
        """The rows as an Arrow table with their units in the metadata."""
        return self.rows.to_arrow()

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """The rows for any reader of Arrow's C stream interface."""
        return self.rows.__arrow_c_stream__(requested_schema)
