"""Answers with more than the keys of their JSON: a designed project, runs, rows of a campaign."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from phea.answers import CampaignAnswer, DesignCommandAnswer, ScenarioAnswer, SimulateAnswer

if TYPE_CHECKING:
    from collections.abc import Iterator

    import pandas as pd
    import pyarrow as pa

    from phea._project import Project
    from phea.table import Table

__all__ = ["Campaign", "Design", "Run", "Simulation"]


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
        return f"Run({self.metrics.name!r}, {self.table!r})"

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
