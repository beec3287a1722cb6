"""Text of a project file with other tables in it; all other statements and comments stay."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

Lines = Sequence[tuple[str, str]]


class _Statement(NamedTuple):
    """Statement with its line end; the path of a header or of a key, and the kind of it."""

    text: str
    kind: str
    path: tuple[str, ...]


def replaced(text: str, table: str, keys: Sequence[str], lines: Lines) -> str:
    """Text with these keys of a top-level table removed and these lines in their place.

    Comments on removed keys are removed too: they would describe what is replaced.

    Examples
    --------
    >>> old = "[controller]  # a lag\\nnumerator = \\"1\\"\\n# why\\ndelay = \\"1 ms\\"\\n"
    >>> print(replaced(old, "controller", ["numerator"], [("gain", "2")]), end="")
    [controller]
    gain = 2
    # why
    delay = "1 ms"
    """
    mark, text = ("\ufeff", text[1:]) if text.startswith("\ufeff") else ("", text)
    end = "\r\n" if "\r\n" in text else "\n"
    found = _edited(list(_statements(text)), table, keys, [f"{k} = {v}" for k, v in lines], end)
    expected = {name: value for name, value in tomllib.loads(text).items() if name != table}
    kept = tomllib.loads(text).get(table, {})
    own = {name: value for name, value in kept.items() if name not in keys}
    own |= tomllib.loads("\n".join(f"{key} = {value}" for key, value in lines))
    if tomllib.loads(found) != expected | (
        {table: own} if own or table in tomllib.loads(found) else {}
    ):
        raise ValueError(f"expected [{table}] in a form that can be rewritten; found another one")
    return mark + found


def removed(text: str, tables: Sequence[str]) -> str:
    """Text without these top-level tables and the comments on them.

    Examples
    --------
    >>> removed("a = 1\\n\\n# box\\n[uncertainty]\\nk = 2\\n\\n# rest\\n[b]\\n", ["uncertainty"])
    'a = 1\\n\\n# rest\\n[b]\\n'
    """
    mark, text = ("\ufeff", text[1:]) if text.startswith("\ufeff") else ("", text)
    out = _Kept(all_between=False)
    section: tuple[str, ...] = ()
    for statement in _statements(text):
        section = statement.path if statement.kind == "header" else section
        whole = section if statement.kind == "header" else section + statement.path
        out.take(statement, statement.kind == "nothing" or whole[0] not in tables)
    return mark + out.finished()


class _Kept:
    """Kept statements, with the comments that belong to them."""

    def __init__(self, all_between: bool) -> None:
        self.parts: list[str] = []
        self._all = all_between
        self._between: list[str] = []
        self._kept = True

    def take(self, statement: _Statement, keep: bool, instead: str | None = None) -> None:
        if statement.kind == "nothing":
            self._between.append(statement.text)
            return
        comments = len(self._between)
        while comments and self._between[comments - 1].strip().startswith("#"):
            comments -= 1
        if self._kept or self._all:
            self.parts += self._between[:comments]
        if keep:
            self.parts += self._between[comments:]
            self.parts.append(statement.text if instead is None else instead)
        self._between, self._kept = [], keep

    def finished(self) -> str:
        self.parts += self._between if self._kept or self._all else []
        return "".join(self.parts)


def _edited(
    statements: list[_Statement], table: str, keys: Sequence[str], lines: list[str], end: str
) -> str:
    def is_replaced(path: tuple[str, ...]) -> bool:
        return len(path) > 1 and path[0] == table and path[1] in keys

    sections: list[tuple[str, ...]] = []
    for statement in statements:
        last = sections[-1] if sections else ()
        sections.append(statement.path if statement.kind == "header" else last)
    wholes = [
        section if statement.kind == "header" else section + statement.path
        for statement, section in zip(statements, sections, strict=True)
    ]
    removes = any(is_replaced(whole) for whole in wholes)
    out, inserted = _Kept(all_between=True), False
    for statement, section, whole in zip(statements, sections, wholes, strict=True):
        if statement.kind == "nothing":
            out.take(statement, True)
        elif statement.kind == "header":
            own = whole == (table,)
            written = _without_comment(statement.text, end) if own and removes else statement.text
            if own and not inserted:
                written = _ended(written, end) + "".join(line + end for line in lines)
                inserted = True
            out.take(statement, not is_replaced(whole), written)
        elif whole == (table,):
            out.take(statement, True, _inline(statement.text, keys, lines, end))
            inserted = True
        elif not section and whole[0] == table and not inserted:
            dotted = "".join(f"{table}.{line}{end}" for line in lines)
            out.take(statement, True, dotted + ("" if is_replaced(whole) else statement.text))
            inserted = True
        else:
            out.take(statement, not is_replaced(whole))
    text = out.finished()
    if lines and not inserted:
        text = f"{_ended(text, end)}{end}[{table}]{end}" + "".join(line + end for line in lines)
    return text


def _inline(text: str, keys: Sequence[str], lines: list[str], end: str) -> str:
    """Statement ``table = { ... }`` with other entries."""
    start = text.index("{", text.index("="))
    inside = text[start + 1 : _end_of_value(text, start) - 1]
    kept = []
    while inside.strip():
        stop = _end_of_value(inside, 0, ",")
        entry, inside = inside[:stop].strip(), inside[stop + 1 :]
        if _path(entry)[0] not in keys:
            kept.append(entry)
    return f"{text[:start]}{{ {', '.join([*lines, *kept])} }}{end}"


def _statements(text: str) -> Iterator[_Statement]:
    start = 0
    while start < len(text):
        first = text[start:].lstrip(" \t")[:1]
        if first in ("", "\n", "\r", "#"):
            stop, kind = _line_end(text, start), "nothing"
        elif first == "[":
            stop, kind = _line_end(text, start), "header"
        else:
            stop = _line_end(text, _end_of_value(text, text.index("=", start) + 1, "\n#"))
            kind = "value"
        written = text[start:stop]
        path = {"header": _header, "value": _path}[kind](written) if kind != "nothing" else ()
        yield _Statement(written, kind, path)
        start = stop


def _line_end(text: str, start: int) -> int:
    found = text.find("\n", start)
    return len(text) if found < 0 else found + 1


def _end_of_value(text: str, start: int, stops: str = "") -> int:
    """Index of the first of these characters outside brackets and texts, or after the bracket."""
    depth, place = 0, start
    while place < len(text):
        one = text[place]
        if one in "\"'":
            quote = text[place : place + 3] if text[place : place + 3] == one * 3 else one
            place += len(quote)
            while text[place : place + len(quote)] != quote:
                place += 2 if text[place] == "\\" and one == '"' else 1
            place += len(quote)
            while len(quote) == 3 and text[place : place + 1] == one:  # a quote before the end
                place += 1
            continue
        if depth == 0 and one in stops:
            return place
        if one == "#":
            place = _line_end(text, place)
            continue
        depth += (one in "[{") - (one in "]}")
        place += 1
        if depth == 0 and not stops:
            return place
    return place


def _path(written: str) -> tuple[str, ...]:
    """Path of a key, or of the first key of an entry."""
    place = 0
    while written[place] != "=":
        place = _end_of_value(written, place, "=")
    return _followed(tomllib.loads(written[:place].strip() + " = 0"))


def _header(written: str) -> tuple[str, ...]:
    return _followed(tomllib.loads(written))


def _followed(tree: Mapping[str, Any]) -> tuple[str, ...]:
    path: list[str] = []
    value: Any = tree
    while isinstance(value, dict) and value:
        name, value = next(iter(value.items()))
        path.append(name)
    return tuple(path)


def _without_comment(line: str, end: str) -> str:
    # a header that contains "#" in quotes keeps its comment
    before, found, _ = line.partition("#")
    return before.rstrip() + end if found and before.rstrip().endswith("]") else line


def _ended(text: str, end: str) -> str:
    return text if not text or text.endswith("\n") else text + end
