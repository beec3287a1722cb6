"""Tables of numbers: columns by name, as NumPy arrays, pandas frames or Arrow tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from phea import _native
from phea._extras import imported

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa


# Number of columns in the line that a table prints.
_SHOWN = 6


class Table(Mapping[str, Any]):
    """Table by its columns: read-only arrays of float64, and lists of texts.

    A column is ``table["force_n"]`` or ``table.force_n``; its unit is the end of its name. An empty
    cell of a column of numbers is not a number.

    Examples
    --------
    >>> table = Table(b"time_s,force_n\\n0,1.5\\n0.1,2\\n")
    >>> list(table), float(table.force_n.sum())
    (['time_s', 'force_n'], 3.5)
    """

    __slots__ = ("_columns", "_csv", "_units")

    def __init__(self, csv: bytes, units: Mapping[str, str] | None = None) -> None:
        self._csv = csv
        self._units = dict(units or {})
        self._columns: dict[str, Any] | None = None

    def _all(self) -> dict[str, Any]:
        if self._columns is None:
            columns = _native.columns(self._csv)
            for column in columns.values():
                if not isinstance(column, list):
                    column.setflags(write=False)
            self._columns = columns
        return self._columns

    @property
    def csv(self) -> bytes:
        """The table as the command writes it."""
        return self._csv

    def __getitem__(self, name: str) -> Any:
        columns = self._all()
        if name not in columns:
            from difflib import get_close_matches

            near = get_close_matches(name, columns, 1)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            raise KeyError(f"no column is called {name!r}{hint}")
        return columns[name]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._all())

    def __len__(self) -> int:
        return len(self._all())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Table) and self._csv == other._csv

    def __hash__(self) -> int:
        return hash(self._csv)

    def __reduce__(self) -> tuple[Any, ...]:
        return (Table, (self._csv, self._units))

    def __repr__(self) -> str:
        columns = self._all()
        rows = len(next(iter(columns.values()), ()))
        names = [*list(columns)[:_SHOWN], "..."] if len(columns) > _SHOWN else list(columns)
        return f"Table({rows} rows, {len(columns)} columns: {', '.join(names)})"

    def unit_of(self, name: str) -> str:
        """Unit of a column; empty for a number without a unit."""
        return self._units.get(name) or unit_of(name)

    def to_pandas(self) -> pd.DataFrame:
        """The table as a pandas frame; ``attrs["units"]`` has the unit of each column."""
        pandas = imported("pandas", "pandas")
        frame: pd.DataFrame = pandas.DataFrame(dict(self._all()))
        frame.attrs["units"] = {name: self.unit_of(name) for name in self}
        return frame

    def to_arrow(self) -> pa.Table:
        """The table as an Arrow table; each field has its unit in its metadata."""
        arrow = imported("pyarrow", "pandas")
        columns = {name: arrow.array(column) for name, column in self._all().items()}
        fields = [
            arrow.field(name, column.type, metadata={"unit": self.unit_of(name)})
            for name, column in columns.items()
        ]
        table: pa.Table = arrow.table(list(columns.values()), schema=arrow.schema(fields))
        return table

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """The table for any reader of Arrow's C stream interface, such as polars and DuckDB."""
        return self.to_arrow().__arrow_c_stream__(requested_schema)


def unit_of(name: str) -> str:
    """Unit of a column; empty for a number without a unit.

    The end of a name is its unit; a path of the project file has the unit of its key, in a rig with
    a cylinder.

    Examples
    --------
    >>> unit_of("pressure_a_pa"), unit_of("run"), unit_of("supply.pressure")
    ('Pa', '', 'Pa')
    """
    return _native.unit_of(name)
