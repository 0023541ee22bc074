"""The line of a key in a TOML file.

tomllib does not give it.  It is the last line that names the key, and before which the file does not have the key yet.
"""

from __future__ import annotations

import re
import tomllib
from typing import Any

from hil.scenarios.keys import Path, Problem, written

#: So much of a line is looked at for a key.
_LONGEST = 200


def line_of(content: str, path: Path) -> int:
    """The line of the key at `path`, counted from 1; for a missing key, the line of the table that lacks it."""
    lines = content.splitlines(keepends=True)
    for length in range(len(path), 0, -1):
        found = _statement(lines, path[:length])
        if found is not None:
            return found + 1
    return 1


def _statement(lines: list[str], path: Path) -> int | None:
    """The index of the line in which the value of `path` begins; None if no line names it."""
    named = [part for part in path if isinstance(part, str)]
    key = rf"(?<![\w-]){re.escape(named[-1])}(?![\w-])"
    names_it = re.compile(rf"\s*(\[.*{key}.*\]|[\s\w.\"'-]*{key}[\s\w.\"'-]*=)")
    begins = [index for index, line in enumerate(lines) if names_it.match(line[:_LONGEST])]
    # A file has a key from some line on: the last line before which it has not is found by halving.
    low, high = 0, len(begins)
    found = None
    while low < high:
        middle = (low + high) // 2
        before = _table("".join(lines[: begins[middle]]))
        if before is None:  # inside of a value of several lines
            del begins[middle]
            high -= 1
        elif _has(before, path):
            high = middle
        else:
            found, low = begins[middle], middle + 1
    whole = _table("".join(lines))
    return found if whole is not None and _has(whole, path) else None


def _table(content: str) -> dict[str, Any] | None:
    try:
        return tomllib.loads(content)
    except tomllib.TOMLDecodeError:
        return None


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
