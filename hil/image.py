"""Somebody's own driver files on a chip: translated once, linked as often as a fresh image is wanted.

    build = Build(["us.c"], include=["include"])
    image = build.image()
    image.call("us.Init_US", [])

Nothing here knows the robot's firmware: an image is the board (chip, parts, kernel) and the user's files.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from emulator.c28x.compile import compile_program
from emulator.c28x.compiled_program import Compiled
from emulator.c28x.coverage import Coverage
from emulator.c28x.ctypes import BlockType
from emulator.c28x.findings import Finding
from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION
from emulator.c28x.memory import Pointer
from emulator.c28x.options import CompileOptions
from emulator.c28x.program import Program
from emulator.c28x.symbols import Module, library_headers
from emulator.c28x.tree import Declaration, Function
from emulator.image import Firmware, bind, runtime_of
from hil.board import Board, made
from hil.collector import uncollected
from hil.faults import FaultOutcome, mount, parse
from hil.testing.faults import BoardTarget

#: Endings of files that are driver files.
SUFFIXES: Final = (".c", ".py")
ABIS: Final = ("coff", "eabi")


def program(
    names: Iterable[str], *, include: Sequence[str | Path] = (), defines: Sequence[str] = (), abi: str = "",
    header: Callable[[str], str | None] | None = None, library: Callable[[str], str | None] | None = None,
) -> Program:  # fmt: skip
    """The modules of `names`: files, or importable modules.

    What only C needs is handed on where it is given (see `Program`).  Raises SourceError, NoModule and ValueError.
    """
    given: dict[str, Any] = {
        "include": include, "defines": defines, "abi": abi, "header": header, "library": library,
    }  # fmt: skip
    return Program(names, **{key: value for key, value in given.items() if value})


def is_static(function: Function, file: str) -> bool:
    """Whether only its own file knows a function: `static` in C, a name with an underscore in C-shaped Python."""
    return function.static or (function.name.startswith("_") and file.endswith(".py"))


class Build:
    """Driver files, translated: the typed trees, and what they show without running.

    `names` are files or importable modules, or a program that was read elsewhere.  `header` and `library` are what a
    project adds to C (else that of the board): headers, and modules that define what the files only declare;
    `calibration` and `float_division` are those of `CompileOptions`;
    `coverage` takes up how often each statement is begun, in all images; `board` is what the chip is soldered to.
    `faults` break in each image, and `fired` is what came of them in all that were closed.
    A whole program begins at its `main`; of files without one any function that is not `static` can be called.  Raises
    SourceError for what is outside the language, with file and line.
    """

    def __init__(
        self, names: Iterable[str] | Program, *, include: Sequence[str | Path] = (), defines: Sequence[str] = (),
        abi: str = "", header: Callable[[str], str | None] | None = None,
        library: Callable[[str], str | None] | None = None, fill: str = "zero", seed: int = 1,
        calibration: Mapping[str, float] | None = None, coverage: Coverage | None = None,
        board: type[Board] = Board, float_division: str = DEFAULT_FLOAT_DIVISION, faults: Sequence[str] = (),
    ) -> None:  # fmt: skip
        if isinstance(names, Program):
            self.program = names
            own = [module.file for module in names.modules.values()]
        else:
            own = list(names)
            if board.project is not None:
                header, library = header or board.project.header, library or board.project.library
            self.program = program(own, include=include, defines=defines, abi=abi, header=header, library=library)
        #: The files that were named, without what they bring with them.
        self.files = frozenset(str(Path(name).resolve()) for name in own)
        self.fill = fill
        self.seed = seed
        self.coverage = coverage
        self.board = board
        self.fired = tuple(FaultOutcome(parse(text), (), 0, None) for text in faults)
        #: A board that nobody has used yet: the first image's.  A chip takes as long to make as a short run.
        self._unused: Board | None = made(board, seed=seed)
        chip = self._unused
        self.program.translate()
        functions = [(f, module.unit(f.name).file) for module in self.modules for f in module.functions]
        whole = any(function.name == "main" and file in self.files for function, file in functions)
        entries = frozenset() if whole else frozenset(f.path for f, file in functions if not is_static(f, file))
        options = CompileOptions(
            residue=fill == "stack", watch=True, static=True, entries=entries, calibration=dict(calibration or {}),
            coverage=coverage is not None, float_division=float_division,
        )  # fmt: skip
        #: The blocks with all registers of the chip.
        self.register_blocks = (*chip.blocks.values(), chip.vectors.registers)
        self._options = options
        self._looked_at = lambda block, name: chip.register(block, name).looked_at
        self.compiled = compile_program(self.program, options, self._looked_at)

    def followed(self) -> Compiled:
        """The same program, which reports each statement before it begins (`Position.follow`)."""
        options = replace(self._options, follow=True, static=False, coverage=False)
        return compile_program(self.program, options, self._looked_at)

    def counted(self) -> Compiled:
        """The same program, which counts how often each statement is begun (`Linked.coverage`)."""
        options = replace(self._options, static=False, coverage=True)
        return compile_program(self.program, options, self._looked_at)

    @property
    def others(self) -> frozenset[str]:
        """The files of the modules that the named ones bring with them, and the headers of libraries among these."""
        return (frozenset(module.file for module in self.modules) | library_headers(self.modules)) - self.files

    @property
    def modules(self) -> list[Module]:
        """The modules that define functions or objects."""
        return [module for module in self.program.modules.values() if module.functions or module.variables]

    def image(self, *, driven: Callable[[], bool] | None = None, compiled: Compiled | None = None) -> Image:
        """A fresh board with the files linked to it.  Raises LinkError for a name that nothing defines.

        `driven` is that of `runtime_of`; `compiled` replaces the program (`followed`, `counted`).
        """
        return Image(self, driven, compiled)

    def fresh_board(self) -> Board:
        """A board as it is at power-up."""
        board, self._unused = self._unused, None
        return self.board(seed=self.seed) if board is None else board


class Image:
    """One board with the files of a build: call its functions, run its kernel, look at its findings."""

    def __init__(
        self, build: Build, driven: Callable[[], bool] | None = None, compiled: Compiled | None = None
    ) -> None:  # fmt: skip
        with uncollected():
            self.board = board = build.fresh_board()
            runtime = runtime_of(board, fill=build.fill, driven=driven)
            coverage = build.coverage if compiled is None else None
            self.linked = bind(board, compiled or build.compiled, runtime, coverage=coverage)
        self._build = build
        machine = BoardTarget(board, lambda: Firmware(self.linked)) if build.fired else None
        self._faults = [mount(fired.fault, machine) for fired in build.fired] if machine is not None else []

    def allow_loops(self, cycles: int) -> None:
        """How long a loop may compute without calling anything, from now on."""
        self.linked.allow_loops(cycles)

    def skip_turns(self) -> None:
        """From now on, time skips the turns of loops that change nothing, up to the next event."""
        self.linked.skip_turns()

    @property
    def findings(self) -> list[Finding]:
        """What has been found so far, in order."""
        return list(self.board.findings)

    def place(self, declaration: Declaration, values: Sequence[Any]) -> Pointer:
        """A new object, with a value for each of its scalars; a pointer to it."""
        memory = self.board.memory
        obj = memory.place(declaration)
        obj.data[:] = values
        return Pointer(memory, obj, 0, declaration.ctype)

    def block(self, name: str, ctype: BlockType) -> Pointer:
        """A pointer to the register block that C calls `name`, of type `ctype`."""
        register, entry = next(iter(ctype.layout.items()))
        return Pointer(self.board.memory, None, self.board.register(name, register).address - entry.offset, ctype)

    def start(self) -> None:
        """What TI's `InitSysCtrl` does: every clock is on."""
        self.linked.externs["InitSysCtrl"]()

    def let_interrupts_in(self) -> None:
        """What an application does once its drivers have written their vectors: ENPIE = 1, EINT."""
        if self.board.pie.has_routines:
            self.board.pie.enable()
            self.board.cpu.enable_interrupts()

    def call(self, path: str, arguments: Sequence[Any]) -> Any:
        """Call the function `module.name` with C values; what it raises leaves the image as it was before the call."""
        runtime = self.linked.runtime
        position = runtime.findings.position
        sp, at, calls = runtime.cpu.sp, position.at, position.calls
        try:
            return self.linked.functions[path](*arguments)
        except BaseException:
            runtime.unwind(sp)
            position.at, position.calls = at, calls
            raise

    def close(self) -> None:
        """End its tasks, which shows what only the end of a run shows."""
        if self._faults:
            both = zip(self._build.fired, self._faults, strict=True)
            self._build.fired = tuple(fired.and_then(mounted.report()) for fired, mounted in both)
            self._faults.clear()
        self.board.kernel.shutdown()
