"""A compiled program: the functions as code, and what their text refers to.

`compile.py` makes it, `cache.py` keeps it, `link.py` binds it to one board.  Who only links what is kept needs nothing
of what made it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from types import CodeType
from typing import TYPE_CHECKING, Any, Final

from emulator.c28x.emit.written import EmittedFunction
from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION
from emulator.c28x.program import Program
from emulator.c28x.tree import Function, Variable

if TYPE_CHECKING:
    from emulator.c28x.passes.report import StaticFinding


class LinkError(ValueError):
    """A name that nothing defines, or a construct outside the language."""


@dataclass
class CompileOptions:
    """How to generate."""

    #: Spill locals to the stack memory at return (fill policy `stack`).
    residue: bool = False
    #: Keep a function's locals for tests.
    keep_locals: bool = False
    #: Call `Runtime.touch` at every load and store of an object that others can reach.
    watch: bool = False
    #: Count how often each statement is begun (`coverage.py`).
    coverage: bool = False
    #: Tell `Position.hold`, if there is one, of each statement before it runs.
    steps: bool = False
    #: Report what the typed tree shows without running it.
    static: bool = False
    #: Functions (`module.name`, or a pattern of them) that somebody outside of the image calls: what `static` says of
    #: functions never called and of parameters not used is not for them.
    entries: frozenset[str] = frozenset()
    #: What a division of floats gives is what IEEE says; `float_division` says how long it takes.
    ieee: bool = True
    #: The build that decides how long it takes: a name of `FLOAT_DIVISIONS`.
    float_division: str = DEFAULT_FLOAT_DIVISION
    #: Arrays (`module.function.name`) that have more elements than the source says.
    room: dict[str, int] = field(default_factory=dict)
    #: Full name of a module, or of a function in it -> factor on its cycles.
    calibration: dict[str, float] = field(default_factory=dict)


@dataclass
class CompiledFunction:
    """A function as Python, and the source file that its lines count in."""

    function: Function
    file: str
    written: EmittedFunction
    _code: CodeType | None = field(default=None, repr=False)

    @property
    def path(self) -> str:
        """`module.name`."""
        return self.function.path

    def code(self) -> CodeType:
        """The code of the function's definition; places are numbered from `FIRST_NUMBER`."""
        if self._code is None:
            self._code = _code(self.written.text, self.file, self.written.lines)
        return self._code

    def take_code(self, code: CodeType) -> None:
        """The code, made before of the same text."""
        self._code = code

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_code": None}  # code objects cannot be pickled


@dataclass(frozen=True)
class Compiled:
    """A program, ready to be linked."""

    program: Program
    options: CompileOptions
    functions: list[CompiledFunction]
    #: Every file-scope object with the values that it starts from (None: it has no initialiser).
    objects: list[tuple[Variable, list[Any] | None]]
    #: What the trees show without running.
    findings: list[StaticFinding]


@lru_cache(maxsize=4096)
def _code(text: str, file: str, lines: tuple[int, ...]) -> CodeType:
    """The text of a function, each line under its number in `file`.  Most images of a process share most functions."""
    return _renumbered(compile(text, file, "exec", dont_inherit=True), lines)


def _renumbered(code: CodeType, lines: Sequence[int]) -> CodeType:
    """Code whose line n is line `lines[n - 1]` of the source; columns mean nothing there.

    Changing the lines of the syntax tree would take three times as long.  The table (CPython, Objects/locations.md) has
    an entry for each run of at most 8 units of code: its length, and how many lines further it is.
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
    """A number of the table: six bits a byte, the lowest first, the sign in the lowest of all."""
    rest = -value << 1 | 1 if value < 0 else value << 1
    digits = bytearray()
    while rest > 0x3F:
        digits.append(0x40 | rest & 0x3F)
        rest >>= 6
    return bytes((*digits, rest))


#: How an entry begins for so many units: a line without columns, or no line.
_NO_COLUMNS: Final = (b"", *(bytes([0x80 | 13 << 3 | units - 1]) for units in range(1, 9)))
_NO_LINE: Final = (b"", *(bytes([0x80 | 15 << 3 | units - 1]) for units in range(1, 9)))
