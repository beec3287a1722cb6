"""Frozen values that consist of arrays."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np


class ArrayValue:
    """Frozen value whose slots are arrays and other values.

    Arrays are read-only. Two values are equal if their classes are and every bit of them is; a
    value hashes, copies and pickles.
    """

    __slots__: ClassVar[tuple[str, ...]] = ()

    def __init__(self, *values: object) -> None:
        for name, value in zip(self.__slots__, values, strict=True):
            if isinstance(value, np.ndarray):
                value.setflags(write=False)
            object.__setattr__(self, name, value)

    def _values(self) -> tuple[Any, ...]:
        return tuple(getattr(self, name) for name in self.__slots__)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"{type(self).__name__} cannot be changed: {name}")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"{type(self).__name__} cannot be changed: {name}")

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other) or not isinstance(other, ArrayValue):
            return NotImplemented
        return bool(_comparable(self._values()) == _comparable(other._values()))

    def __hash__(self) -> int:
        return hash(_comparable(self._values()))

    def __copy__(self) -> ArrayValue:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> ArrayValue:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), self._values())


def _comparable(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return (value.dtype.str, value.shape, value.tobytes())
    if isinstance(value, tuple):
        return tuple(_comparable(part) for part in value)
    return value
