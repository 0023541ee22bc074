"""A compiled program: its functions as code, and the names that their text refers to.

`compile.py` makes it, `cache.py` keeps it, `link.py` binds it to one board.  Linking a kept program does not need the
translator.
"""

from __future__ import annotations

import marshal
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from types import CodeType
from typing import TYPE_CHECKING, Any, Final

from emulator.c28x.emit.written import EmittedFunction
from emulator.c28x.options import CompileOptions
from emulator.c28x.program import Program
from emulator.c28x.tree import Function, Variable

if TYPE_CHECKING:
    from emulator.c28x.passes.report import StaticFinding


class LinkError(ValueError):
    """A name that nothing defines, or a construct outside the language."""


@dataclass(frozen=True)
class Depends:
    """What the code of a function depends on besides the function: a program in which it is equal has the same code."""

    #: The end of the names that belong to the function alone.
    owner: str
    #: `ImageFacts.about`.
    facts: list[Any]


@dataclass
class CompiledFunction:
    """A function as Python code."""

    function: Function
    written: EmittedFunction
    depends: Depends | None = field(default=None, repr=False)

    @property
    def path(self) -> str:
        """`module.name`."""
        return self.function.path

    @cached_property
    def code(self) -> CodeType:
        """The code that defines the function.  Its places are numbered from `FIRST_NUMBER`."""
        return _code(self.written.text, self.function.where.file, self.written.lines)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "code": marshal.dumps(self.code), "depends": None}  # code objects cannot be pickled

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state, code=marshal.loads(state["code"]))


@dataclass(frozen=True)
class Compiled:
    """A program, ready to be linked."""

    program: Program
    options: CompileOptions
    functions: list[CompiledFunction]
    #: Every file-scope object with the values that it starts from (None: it has no initialiser).
    objects: list[tuple[Variable, list[Any] | None]]
    #: The findings of the static checks.
    findings: list[StaticFinding]


@lru_cache(maxsize=4096)
def _code(text: str, file: str, lines: tuple[int, ...]) -> CodeType:
    """The code of a text, with line numbers of `file`.  It is cached: most images of a process share most functions."""
    return _renumbered(compile(text, file, "exec", dont_inherit=True), lines)


def _renumbered(code: CodeType, lines: Sequence[int]) -> CodeType:
    """Code whose line n gets the number `lines[n - 1]`; it has no columns.

    Changing the lines of the syntax tree would take three times as long.  The line table (CPython,
    Objects/locations.md) has an entry for each run of at most 8 code units: its length and its line offset.
    """
    runs: list[tuple[int | None, int]] = []
    for start, end, line in code.co_lines():
        number = None if line is None else lines[line - 1]
        if runs and runs[-1][0] == number:
            runs[-1] = (number, runs[-1][1] + end - start)
        else:
            runs.append((number, end - start))
    first = before = lines[code.co_firstlineno - 1]
    table = bytearray()
    for number, octets in runs:
        whole, rest = divmod(octets // 2, 8)
        if number is None:
            table += _NO_LINE[8] * whole + _NO_LINE[rest]
            continue
        further = _signed(number - before)
        for length in (*([8] * whole), rest):
            if length:
                table += _NO_COLUMNS[length] + further
                further = b"\0"
        before = number
    inner = tuple(_renumbered(c, lines) if isinstance(c, CodeType) else c for c in code.co_consts)
    return code.replace(co_linetable=bytes(table), co_firstlineno=first, co_consts=inner)


def _signed(value: int) -> bytes:
    """A signed number of the line table: six bits per byte, lowest bits first; the lowest bit is the sign."""
    rest = -value << 1 | 1 if value < 0 else value << 1
    digits = bytearray()
    while rest > 0x3F:
        digits.append(0x40 | rest & 0x3F)
        rest >>= 6
    return bytes((*digits, rest))


#: The first byte of an entry, by its number of units: for a line without columns, and for no line.
_NO_COLUMNS: Final = (b"", *(bytes([0x80 | 13 << 3 | units - 1]) for units in range(1, 9)))
_NO_LINE: Final = (b"", *(bytes([0x80 | 15 << 3 | units - 1]) for units in range(1, 9)))
