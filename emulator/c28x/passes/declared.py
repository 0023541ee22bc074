"""The text of declarations, for what types do not keep: words of names, a storage class, a remark."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from emulator.c28x.tree import Declaration, Expr, Load, LValue, Variable, Where
from emulator.c28x.tree_queries import bare

_WORD: Final = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")
_NAME: Final = re.compile(r"[A-Za-z_]\w*")


def words_of(name: str) -> list[str]:
    """The words of a name, in small letters: `last` and `state` of `lastState`, `LAST_STATE` and `last_state2`."""
    return [word.lower() for word in _WORD.findall(name)]


def line_of(declaration: Declaration) -> str:
    """The line on which an object is declared; empty: its text is in no file."""
    return _line(declaration.file, declaration.line)


def name_at(where: Where) -> str:
    """The name that is written at a place, of a macro for example; empty: there is none, or its text is in no file."""
    found = _NAME.match(_line(where.file, where.line)[max(where.column - 1, 0):])
    return found.group() if found is not None and where.column else ""


def _line(file: str, line: int) -> str:
    return next((text for _, text in lines_from(file, line)), "")


def lines_from(file: str, first: int) -> Iterator[tuple[int, str]]:
    """The numbers and lines of a file from a line on; none: its text is in no file."""
    try:
        lines = Path(file).read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return
    if first > 0:
        yield from enumerate(lines[first - 1 :], first)


def may_be_volatile(pointer: Expr) -> bool:
    """Whether a pointer is, or may be, declared as one to a volatile object."""
    match bare(pointer):
        case Load(lvalue=LValue(root=Variable(declaration=declaration))):
            line = line_of(declaration)
            return "volatile" in line or not line
    return True
