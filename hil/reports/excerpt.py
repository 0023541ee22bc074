"""The source that a finding points to: its statement, the lines around it, a path that means the same everywhere."""

from __future__ import annotations

import ast
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Final

from emulator.c28x.sites import FILE_SCOPE, Place

#: Lines shown before and after the one that is meant.
AROUND: Final = 3


@dataclass(frozen=True, slots=True)
class SourceLine:
    """A line of source; `marked` is the one that a finding names."""

    number: int
    text: str
    marked: bool = False


def relative_path(file: str) -> str:
    """`file` from the current directory, else from the folder that holds its package, with forward slashes.

    A file of no package that lies outside keeps its way: `../drivers/us.c`.
    """
    path = Path(file)
    if path.is_relative_to(Path.cwd()) or not path.is_absolute():
        return path.relative_to(Path.cwd()).as_posix() if path.is_absolute() else path.as_posix()
    root = path.parent
    while (root / "__init__.py").is_file():
        root = root.parent
    if root != path.parent:
        return path.relative_to(root).as_posix()
    try:
        return Path(os.path.relpath(path)).as_posix()
    except ValueError:  # another drive of Windows
        return path.as_posix()


def from_here(text: str) -> str:
    """A text in which paths below the current directory are relative to it; as it is, where that directory is gone."""
    try:
        here = re.escape(f"{Path.cwd()}{os.sep}")
    except OSError:
        return text
    return re.sub(rf"(?<![^\s=:'\"(\[]){here}", "", text)


def _lines(file: str) -> tuple[str, ...]:
    """The lines of a file as it is now; none if it cannot be read."""
    try:
        now = Path(file).stat()
        return _lines_of(file, (now.st_mtime_ns, now.st_size, now.st_ino))
    except OSError:
        return ()


@lru_cache(maxsize=256)
def _lines_of(file: str, version: tuple[int, ...]) -> tuple[str, ...]:
    return tuple(Path(file).read_text(encoding="utf-8", errors="replace").splitlines())


@lru_cache(maxsize=256)
def _parsed(lines: tuple[str, ...]) -> ast.Module:
    """Python's lines as a tree; an empty one if they are none."""
    try:
        return ast.parse("\n".join(lines))
    except SyntaxError:
        return ast.Module([], [])


def _statements_at(node: ast.AST, number: int) -> Iterator[ast.stmt]:
    """The statements below a node that line `number` belongs to, outer ones before inner ones."""
    for inner in ast.iter_child_nodes(node):
        if isinstance(inner, ast.stmt):
            if inner.lineno <= number <= (inner.end_lineno or inner.lineno):
                yield inner
                yield from _statements_at(inner, number)
        elif isinstance(inner, ast.excepthandler | ast.match_case):
            yield from _statements_at(inner, number)


def source_line(file: str, number: int) -> str:
    """One line of a file without its indentation; empty if there is none."""
    lines = _lines(file)
    return lines[number - 1].strip() if 0 < number <= len(lines) else ""


def excerpt(file: str, number: int, around: int = AROUND) -> tuple[SourceLine, ...]:
    """The lines around line `number` of a file; none if the file cannot be read."""
    lines = _lines(file)
    if not 0 < number <= len(lines):
        return ()
    shown = range(max(1, number - around), min(len(lines), number + around) + 1)
    return tuple(SourceLine(i, lines[i - 1], i == number) for i in shown)


def statement(file: str, number: int) -> str:
    """The statement at a line as the parser sees it, without layout and comments; of a loop or an `if`, its head.

    Of a C file the line, its comments left out and every gap one space.
    """
    if not file.endswith(".py"):
        return " ".join(_COMMENT.sub(" ", source_line(file, number)).split())
    innermost = max(_statements_at(_parsed(_lines(file)), number), key=lambda node: node.lineno, default=None)
    return source_line(file, number) if innermost is None else ast.unparse(innermost).partition("\n")[0]


#: A comment of C that ends on its line, or goes on behind it; a literal before it is left alone.
_COMMENT: Final = re.compile(r"(?<![\"'])/\*.*?(?:\*/|$)|//.*$")
#: A `Place` as its text, within a sentence.
_PLACE: Final = re.compile(
    rf"(?P<function>{FILE_SCOPE}|\w+) \((?P<file>[^()\n]+\.[A-Za-z]\w*):(?P<line>\d+)(?::(?P<column>\d+))?\)"
)


def location(place: Place) -> str:
    """`drivers/us.py:139`, `us.c:94:12`: the file in which the line counts, the line, the column if it is known."""
    return f"{relative_path(place.file)}:{place.numbers}"


def shown(place: Place) -> str:
    """A place as every command shows it: the function, and in brackets where the statement stands."""
    return f"{function_of(place)} ({location(place)})"


def function_of(place: Place) -> str:
    """The C function of a place, or that it is in none."""
    return place.function or FILE_SCOPE


def places_in(sentence: str) -> list[Place]:
    """The places that a sentence names; the C file that a Python file mirrors is not among what it says."""
    return list(map(_place, _PLACE.finditer(sentence)))


def readable(sentence: str) -> str:
    """A sentence with its places as `shown` has them."""
    return _PLACE.sub(lambda match: shown(_place(match)), sentence)


def _place(match: re.Match[str]) -> Place:
    function = match["function"] if match["function"] != FILE_SCOPE else ""
    return Place(match["file"], int(match["line"]), function, "", int(match["column"] or 0))
