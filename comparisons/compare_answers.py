"""Compares the answers of commands with the schema of answers, by a validator that is not phea's.

    python comparisons/compare_answers.py

The schema must itself be one of draft 7, accept what the commands print with `--json` for every project of `examples/`
or for some of them, and what they print for a project that they refuse; and it must reject each
answer with a key removed or added.
"""

import json
import os
import pathlib
import subprocess
import sys

import jsonschema

ROOT = pathlib.Path(__file__).resolve().parent.parent
PHEA = os.environ.get("PHEA")
# Each command with a part of the path of the projects that it is run for.
COMMANDS = [("check", ""), ("verify", "qft/"), ("verify", "rotary/"), ("verify", "ybitu/hose"), ("verify", "errors/")]


def phea(*arguments):
    """What phea prints, with whatever exit status."""
    command = [PHEA] if PHEA else ["cargo", "run", "--quiet", "-p", "phea-cli", "--"]
    return subprocess.run([*command, *arguments], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False, text=True).stdout


def main():
    schema = json.loads(phea("schema", "--answers"))
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    wrong, count = [], 0
    for command, part in COMMANDS:
        for project in sorted(path for path in (ROOT / "examples").rglob("*.toml") if part in str(path)):
            answer, count = json.loads(phea(command, str(project), "--json")), count + 1
            fault = jsonschema.exceptions.best_match(validator.iter_errors(answer))
            if fault:
                wrong.append(f"{command} {project.name}: {list(fault.absolute_path)} {fault.message[:200]}")
            more = {**answer, "made_up": 1}
            less = {key: value for key, value in answer.items() if key != "version"}
            wrong.extend(f"{command} {project.name}: a changed answer is accepted" for changed in (more, less) if validator.is_valid(changed))
    print("\n".join(wrong))
    print(f"{count} answers, {len(schema['definitions'])} definitions")
    return 1 if wrong or count < 40 else 0


if __name__ == "__main__":
    sys.exit(main())
