"""Writes the classes of the answers, `python/phea/answers.py`, from the schema of the command.

    python apps/python/generate_answers.py [--check]

Each object of `book/src/phea.answers.schema.json` becomes a class whose attributes are the keys of
the JSON, with their types; its docstring has the descriptions. With `--check`, nothing is written,
and a file that differs is an error.
"""

import json
import keyword
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCHEMA = ROOT / "book/src/phea.answers.schema.json"
MODULE = ROOT / "apps/python/python/phea/answers.py"

HEAD = '''"""Answers of the commands: one class for each object of their JSON.

Written by `apps/python/generate_answers.py` from the schema that `phea schema --answers` prints; a
change here is lost. An attribute is the key of the JSON, its unit the end of its name; infinity is
`math.inf`, and a value that does not exist is `None`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, TypeAlias

from phea._record import Answer, Interval, Record


'''

# Definitions of the schema that are values of Python.
VALUES = {"Number": "float", "Complex": "complex", "Interval": "Interval"}


def reference(schema):
    return schema["$ref"].rsplit("/", 1)[1]


def annotation(schema):
    """Type of a value in Python."""
    if "$ref" in schema:
        name = reference(schema)
        return VALUES.get(name, name)
    if "anyOf" in schema:
        parts = [annotation(part) for part in schema["anyOf"]]
        return " | ".join(dict.fromkeys(parts))
    if "const" in schema:
        return f"Literal[{json.dumps(schema['const'])}]"
    if "enum" in schema:
        return "Literal[" + ", ".join(json.dumps(word) for word in schema["enum"]) + "]"
    kind = schema["type"]
    if kind == "array":
        item = annotation(schema["items"])
        count = schema.get("minItems")
        if count is not None and count == schema.get("maxItems"):
            return "tuple[" + ", ".join([item] * count) + "]"
        return f"tuple[{item}, ...]"
    if kind == "object":
        return f"Mapping[str, {annotation(schema['additionalProperties'])}]"
    return {"string": "str", "integer": "int", "number": "float", "boolean": "bool", "null": "None"}[kind]


# Attributes that every answer of a command has besides the keys of its JSON.
OWN = {"figures", "files", "json", "json_text", "tables", "text"}


def attribute(key, base):
    """Name of the attribute of a key; one that is taken ends in an underscore."""
    name = key.replace(".", "_")
    taken = keyword.iskeyword(name) or (base == "Answer" and name in OWN)
    return name + "_" if taken else name


def wrapped(text, indent):
    lines = textwrap.wrap(text, 96 - indent, break_long_words=False, break_on_hyphens=False)
    return "\n".join(" " * indent + line for line in lines)


def escaped(text):
    return text.replace("\\", "\\\\").replace('"""', '\\"\\"\\"')


def class_of(name, schema, answers):
    base = "Answer" if name in answers else "Record"
    lines = [f"class {name}({base}):"]
    fields, documented = [], []
    for key, value in schema["properties"].items():
        kind = annotation(value)
        if key not in schema["required"] and "None" not in kind.split(" | "):
            kind += " | None"
        fields.append(f"    {attribute(key, base)}: {kind}")
        documented.append(f"    {attribute(key, base)}")
        documented.append(wrapped(escaped(value.get("description", "")), 8))
    lines.append(f'    """{escaped(schema["description"])}')
    if documented:
        lines += ["", "    Attributes", "    ----------", *documented]
    lines += ['    """', "", *(fields or ["    pass"])]
    return "\n".join(lines)


def module(schema):
    """Text of the module."""
    answers = {reference(part): part for part in schema["anyOf"]}
    definitions = schema["definitions"]
    texts = []
    for name, definition in definitions.items():
        if name in VALUES:
            continue
        if "properties" in definition:
            texts.append(class_of(name, definition, answers))
        else:
            kind = annotation(definition)
            quoted = json.dumps(kind) if "Answer" in kind else kind
            alias = f"{name}: TypeAlias = {quoted}"
            texts.append(f'{alias}\n"""{escaped(definition["description"])}"""')
    return HEAD + "\n\n\n".join(texts) + "\n"


def main():
    text = module(json.loads(SCHEMA.read_text(encoding="utf-8")))
    if sys.argv[1:] == ["--check"]:
        if MODULE.read_text(encoding="utf-8") != text:
            sys.exit(f"{MODULE.relative_to(ROOT)} differs from the schema: run generate_answers.py")
        return
    MODULE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
