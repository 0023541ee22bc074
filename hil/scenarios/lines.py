"""At which line of a TOML file a key stands.

tomllib does not say.  But a key stands where the file up to there first has it: the lines before it can be read without
it, those up to the end of its value with it.
"""

from __future__ import annotations

import re
import tomllib
from typing import Any

from hil.scenarios.keys import Path, Problem, written

_AT_LINE = re.compile(r" \(at line (\d+), column (\d+)\)")


def read(content: str, file: str) -> dict[str, Any]:
    """The table of a TOML text.  Raises ValueError naming file and line."""
    try:
        return tomllib.loads(content)
    except tomllib.TOMLDecodeError as error:
        text = str(error)
        found = _AT_LINE.search(text)
        line = int(found[1]) if found else len(content.splitlines()) or 1
        raise ValueError(f"{file}:{line}: {_AT_LINE.sub('', text)}") from None


def line_of(content: str, path: Path) -> int:
    """The line of the key at `path`, counted from 1; of a key that is not there, of the table that lacks it."""
    lines = content.splitlines(keepends=True)
    complete = 0
    for count in range(1, len(lines) + 1):
        try:
            table = tomllib.loads("".join(lines[:count]))
        except tomllib.TOMLDecodeError:
            continue
        if _has(table, path):
            return complete + 1
        complete = count
    return line_of(content, path[:-1]) if path else 1


def _has(table: Any, path: Path) -> bool:
    for part in path:
        if isinstance(part, int):
            if not isinstance(table, list) or part >= len(table):
                return False
        elif not isinstance(table, dict) or part not in table:
            return False
        table = table[part]
    return True


def located(problem: Problem, content: str, file: str) -> ValueError:
    """A problem with file, line and key."""
    key = f" {written(problem.path)}:" if problem.path else ""
    return ValueError(f"{file}:{line_of(content, problem.path)}:{key} {problem.reason}")
