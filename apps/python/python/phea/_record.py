"""Values of answers: records, intervals, and the answer of a command with its text and files."""

from __future__ import annotations

import json
import math
import typing
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from phea._line import line_of
from phea._shown import Shown

if TYPE_CHECKING:
    from typing import Self

    from phea._native import Answer as NativeAnswer
    from phea.table import Table


class Interval(NamedTuple):
    """Interval between two numbers, both included.

    Examples
    --------
    >>> 2.0 in Interval(1.0, 3.0), Interval(1.0, 3.0).width
    (True, 2.0)
    """

    low: float
    high: float

    @property
    def width(self) -> float:
        """Upper less lower end."""
        return self.high - self.low

    def __contains__(self, value: object) -> bool:
        return isinstance(value, int | float) and self.low <= value <= self.high


class Values(Mapping[str, Any]):
    """Frozen mapping of an answer: it compares, hashes, pickles and prints as one line."""

    __slots__ = ("_data",)

    def __init__(self, data: Mapping[str, Any]) -> None:
        self._data = dict(data)

    def __getitem__(self, name: str) -> Any:
        return self._data[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._data)

    def __len__(self) -> int:
        return len(self._data)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Mapping) and _comparable(self) == _comparable(dict(other))

    def __hash__(self) -> int:
        return hash(_comparable(self))

    def __reduce__(self) -> tuple[Any, ...]:
        return (Values, (self._data,))

    def __repr__(self) -> str:
        return repr(self._data)


class Record:
    """Object of an answer: a frozen value whose attributes are the keys of the JSON.

    Two records are equal if their classes and values are; a record hashes, copies and pickles, and
    prints as one line.
    """

    __slots__ = ("__dict__",)

    def __init__(self, fields: Mapping[str, Any]) -> None:
        self.__dict__.update(fields)

    def _fields(self) -> dict[str, Any]:
        return self.__dict__

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"an answer cannot be changed: {name}")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"an answer cannot be changed: {name}")

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other) or not isinstance(other, Record):
            return NotImplemented
        return bool(_comparable(self._fields()) == _comparable(other._fields()))

    def __hash__(self) -> int:
        return hash(_comparable(self._fields()))

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (dict(self._fields()),))

    def __repr__(self) -> str:
        return line_of(type(self).__name__, self._fields())

    def __dir__(self) -> list[str]:
        from phea._fields import generated

        return sorted({*super().__dir__(), *generated(type(self)).__annotations__})


def _comparable(value: Any) -> Any:
    """A value that compares and hashes: not a number equals itself."""
    if isinstance(value, Mapping):
        return tuple((name, _comparable(part)) for name, part in value.items())
    if isinstance(value, tuple):
        return tuple(_comparable(part) for part in value)
    if isinstance(value, float) and math.isnan(value):
        return "nan"
    return value


class Answer(Shown, Record):
    """Answer of a command: its values as attributes, its JSON, its text and its files.

    ``bool(answer)`` is the yes or no of the command, which ends with status 1 for a no.
    """

    __slots__ = ("_context", "_drawn", "_files", "_native", "_state")

    # What a class of `phea.results` needs besides: the project, or the path of a table.
    _context: Any
    _native: NativeAnswer | None
    _state: tuple[str, str, bool]
    _files: dict[str, bytes] | None
    # Drawings of the page that are not among the files, as SVG.
    _drawn: dict[str, bytes] | None

    def __init__(
        self,
        state: tuple[str, str, bool],
        files: dict[str, bytes] | None = None,
        native: NativeAnswer | None = None,
        context: Any = None,
        drawn: dict[str, bytes] | None = None,
    ) -> None:
        object.__setattr__(self, "_context", context)
        object.__setattr__(self, "_drawn", drawn)
        object.__setattr__(self, "_state", state)
        object.__setattr__(self, "_files", files)
        object.__setattr__(self, "_native", native)

    if not TYPE_CHECKING:  # a type checker knows the keys, and finds misspelt ones

        def __getattr__(self, name: str) -> Any:
            # called only for what is not stored yet: the keys of the JSON, read when first used
            if name.startswith("__") or self.__dict__:
                raise AttributeError(self._without(name))
            try:
                return self._fields()[name]
            except KeyError:
                raise AttributeError(self._without(name)) from None

    def _without(self, name: str) -> str:
        from difflib import get_close_matches

        near = get_close_matches(name, dir(self), 1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        return f"{type(self).__name__} has no attribute {name!r}{hint}"

    def _fields(self) -> dict[str, Any]:
        if not self.__dict__:
            from phea._fields import fields_of

            self.__dict__.update(fields_of(type(self), self.json))
        return self.__dict__

    @property
    def json(self) -> dict[str, Any]:
        """The JSON object that the command prints with ``--json``."""
        return typing.cast("dict[str, Any]", json.loads(self._state[0]))

    @property
    def json_text(self) -> str:
        """The text of that object, byte for byte."""
        return self._state[0]

    @property
    def text(self) -> str:
        """The text that the command prints."""
        return self._state[1]

    @property
    def files(self) -> dict[str, bytes]:
        """The files that the command writes with ``--out``, by name."""
        if self._files is None:
            object.__setattr__(self, "_files", self._native.files() if self._native else {})
        return dict(self._files or {})

    @property
    def figures(self) -> dict[str, bytes]:
        """The drawings, by name, SVG and PNG: those among the files, and those of a page."""
        from phea import _native

        figures = {name: one for name, one in self.files.items() if name.endswith((".svg", ".png"))}
        for name, drawing in self._drawings().items():
            figures[name] = drawing
            figures[name.removesuffix("svg") + "png"] = _native.picture_of(drawing)
        return figures

    def _drawings(self) -> dict[str, bytes]:
        if self._drawn is None:
            draw = getattr(self._native, "figures", dict)
            found: dict[str, bytes] = draw()
            others = {name: one for name, one in found.items() if name not in self.files}
            object.__setattr__(self, "_drawn", others)
        return self._drawn or {}

    @property
    def tables(self) -> dict[str, Table]:
        """The tables among the files, by name without ending."""
        from phea.table import Table

        named = self.files.items()
        return {name[:-4]: Table(data) for name, data in named if name.endswith(".csv")}

    def __bool__(self) -> bool:
        return self._state[2]

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other) or not isinstance(other, Answer):
            return NotImplemented
        return self._state == other._state and self.files == other.files

    def __hash__(self) -> int:
        return hash((type(self), self._state))

    def __reduce__(self) -> tuple[Any, ...]:
        state = (self._state, self.files, None, self._context, self._drawings())
        return (type(self), state)
