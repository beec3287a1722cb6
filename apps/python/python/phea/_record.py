"""Values of answers: records, intervals, and the answer of a command with its text and files."""

from __future__ import annotations

import json
import math
import types
import typing
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

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
        shown = []
        for name, value in self._fields().items():
            if isinstance(value, str | float | int) and name not in _UNSHOWN:
                shown.append(f"{name}={_short(value)}")
        if len(shown) > _SHOWN:
            shown = [*shown[:_SHOWN], "..."]
        return f"{type(self).__name__}({', '.join(shown)})"

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *_generated(type(self)).__annotations__})


# Attributes of every answer that do not tell it from another one.
_UNSHOWN = {"schema", "version", "command", "project_sha256"}
# Number of attributes in the line that a record prints.
_SHOWN = 6
# Longest text in that line.
_LONGEST = 40


def _short(value: str | float | int) -> str:
    if isinstance(value, str) and len(value) > _LONGEST:
        return repr(value[: _LONGEST - 3] + "...")
    if isinstance(value, float):
        return f"{value:.6g}"
    return repr(value)


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

    def __getattr__(self, name: str) -> Any:
        # called only for what is not stored yet: the keys of the JSON, read when first used
        if name.startswith("__") or self.__dict__:
            raise AttributeError(self._without(name))
        self.__dict__.update(fields_of(type(self), self.json))
        try:
            return self.__dict__[name]
        except KeyError:
            raise AttributeError(self._without(name)) from None

    def _without(self, name: str) -> str:
        from difflib import get_close_matches

        near = get_close_matches(name, dir(self), 1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        return f"{type(self).__name__} has no attribute {name!r}{hint}"

    def _fields(self) -> dict[str, Any]:
        if not self.__dict__:
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

    def __repr__(self) -> str:
        self._fields()
        return super().__repr__()



Converter = Callable[[Any], Any]

_converters: dict[type, dict[str, tuple[str, Converter]]] = {}


def fields_of(cls: type[Record], data: Mapping[str, Any]) -> dict[str, Any]:
    """Attributes of a record from an object of the JSON; an absent key is ``None``."""
    known = _converters.get(cls)
    if known is None:
        hints = _hints(cls)
        known = {name.rstrip("_"): (name, _converter(hint)) for name, hint in hints.items()}
        _converters[cls] = known
    fields: dict[str, Any] = {name: None for name, _ in known.values()}
    for key, value in data.items():
        name, convert = known[key.replace(".", "_")]
        fields[name] = convert(value)
    return fields


def _hints(cls: type[Record]) -> dict[str, Any]:
    """Types of the attributes of a class, whose annotations are texts."""
    texts = _generated(cls).__annotations__
    return {name: _evaluated(text) for name, text in texts.items()}


def _generated(cls: type[Record]) -> type[Record]:
    """The class of the schema that a class is or extends."""
    return next(one for one in cls.__mro__ if one.__module__ == "phea.answers")


def _evaluated(text: Any) -> Any:
    from phea import answers

    # the texts are those of the generated module
    return eval(text, vars(answers)) if isinstance(text, str) else text


def _converter(hint: Any) -> Converter:
    """Function that makes a value of this type from JSON."""
    hint = _evaluated(hint)
    origin, parts = typing.get_origin(hint), typing.get_args(hint)
    if hint is float:
        return _number
    if hint is complex:
        return lambda value: complex(_number(value[0]), _number(value[1]))
    if hint is Interval:
        return lambda value: Interval(_number(value[0]), _number(value[1]))
    if isinstance(hint, type) and issubclass(hint, Record):
        return lambda value: hint(fields_of(hint, value))
    if origin is tuple:
        convert = _converter(parts[0])
        return lambda value: tuple(convert(part) for part in value)
    if origin is Mapping:
        convert = _converter(parts[1])
        return lambda value: Values({key: convert(part) for key, part in value.items()})
    if origin in (typing.Union, types.UnionType):
        return _either([part for part in parts if part is not type(None)])
    return lambda value: value


def _either(parts: list[Any]) -> Converter:
    """Converter of a value that exists or not, or of one of several types."""
    if len(parts) == 1:
        convert = _converter(parts[0])
        return lambda value: None if value is None else convert(value)
    records = [part for part in parts if isinstance(part, type) and issubclass(part, Record)]
    if not records:
        return lambda value: _number(value) if float in parts else value

    def convert_record(value: Any) -> Any:
        if value is None:
            return None
        fits = [record for record in records if _accepts(record, value)]
        return fits[0](fields_of(fits[0], value))

    return convert_record


def _accepts(record: type[Record], value: Mapping[str, Any]) -> bool:
    """True if a record has every key of an object, and the object every key that it needs."""
    own = {name.rstrip("_"): hint for name, hint in _hints(record).items()}
    needed = {name for name, hint in own.items() if type(None) not in typing.get_args(hint)}
    keys = {key.replace(".", "_") for key in value}
    return keys <= set(own) and needed <= keys


def _number(value: Any) -> Any:
    if value == "inf":
        return math.inf
    if value == "-inf":
        return -math.inf
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value
