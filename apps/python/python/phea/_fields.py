"""Attributes of a record from the JSON of an answer, by the types that its class states."""

from __future__ import annotations

import math
import types
import typing
from collections.abc import Callable, Mapping
from typing import Any

from phea._record import Interval, Record, Values

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
    texts = generated(cls).__annotations__
    return {name: _evaluated(text) for name, text in texts.items()}


def generated(cls: type[Record]) -> type[Record]:
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
