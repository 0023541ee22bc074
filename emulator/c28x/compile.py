"""The way from source to code: read, build, check, write; what comes out knows no board.

    program = Program(modules)            # readers and builder: typed trees
    compiled = compile_program(program, options, looked_at)
    link(compiled, ...)                   # link.py: bound to one board
"""

from __future__ import annotations

import fnmatch
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from types import CodeType
from typing import Any, Final

from emulator.c28x.emit.names import FunctionNames, of_file
from emulator.c28x.emit.python import EmittedFunction, PythonWriter
from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION, float_division
from emulator.c28x.passes import frame
from emulator.c28x.passes.checks import check
from emulator.c28x.passes.costs import Costs
from emulator.c28x.passes.flow import Flow
from emulator.c28x.passes.guards import Guards
from emulator.c28x.passes.intervals import leave_bounds
from emulator.c28x.passes.report import StaticFinding
from emulator.c28x.passes.stamps import Stamps
from emulator.c28x.passes.taken import leave_taken
from emulator.c28x.program import Program
from emulator.c28x.readers.reading import reading
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Function, Variable, Where
from emulator.c28x.tree_queries import compared, limited


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


@reading(0)
def compile_program(program: Program, options: CompileOptions, looked_at: Callable[[str, str], bool]) -> Compiled:
    """Translate every function of `program`.

    `looked_at`: whether reading a register (block, name) is nothing but looking at its stored word.  Raises SourceError
    for source outside the language, LinkError for an entry that means nothing.
    """
    modules = program.translate()
    for module in modules:
        for function in module.functions:
            if not function.where.file:
                function.where = Where(module.unit(function.name).file, function.line)
            leave_bounds(function.body)
            Flow(function).run()
    objects = [(variable, variable.initial) for module in modules for variable in module.variables]
    entries = _entries(modules, options)
    stamps = Stamps(modules, entries)
    suspicions = stamps.suspicions()
    findings = check(modules, dict(objects), stamps, entries) if options.static else []
    names_compared = compared(f for module in modules for f in module.functions)
    names_limited = limited(f for module in modules for f in module.functions)
    costs = Costs(float_division(options.float_division))
    owners: set[str] = set()
    functions = []
    for module in modules:
        for function in module.functions:
            owner = of_file(function.path.replace(".", "_"))
            while owner in owners:
                owner += "_"
            owners.add(owner)
            factors = options.calibration
            factor = factors.get(f"{module.name}.{function.name}", factors.get(module.name, 1.0))
            frame.lay_out(function, options.room, residue=options.residue)
            Guards(
                function, watch=options.watch, ieee=options.ieee, room=options.room, compared=names_compared,
                limited=names_limited, stamps=suspicions,
            ).run()  # fmt: skip
            costs.leave(function)
            leave_taken(function)
            writer = PythonWriter(
                function, FunctionNames(owner, looked_at), costs=costs, factor=factor, watch=options.watch,
                residue=options.residue, keep_locals=options.keep_locals, coverage=options.coverage,
                steps=options.steps,
            )  # fmt: skip
            functions.append(CompiledFunction(function, function.where.file, writer.write()))
    return Compiled(program, options, functions, objects, findings)


def _entries(modules: Iterable[Module], options: CompileOptions) -> frozenset[str]:
    """The functions that `CompileOptions.entries` means.  Raises LinkError for an entry that means none."""
    paths = [function.path for module in modules for function in module.functions]
    meant: set[str] = set()
    for entry in options.entries:
        found = fnmatch.filter(paths, entry)
        if not found and not set(entry) & set("*?["):
            raise LinkError(f"no function {entry} that could be an entry: write module.function")
        meant.update(found)
    return frozenset(meant)


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
