"""A firmware image: the modules of this package linked to one board.

    fw = link(board)
    fw.us.Read_Distance(fw.us.US_SENSOR.LEFT)      # a function of us.c, in cm
    fw.gyro.Z_dc_offset                            # a file-scope object of GYRO.c

Everything belongs to the image: several of them live side by side in one process.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final, Protocol

from emulator.c28x.cache import compiled
from emulator.c28x.compile import Options
from emulator.c28x.coverage import Coverage
from emulator.c28x.ctypes import BASIC, ArrayType, CType, StructType, specified
from emulator.c28x.findings import Findings
from emulator.c28x.link import Linked
from emulator.c28x.memory import Memory, Pointer
from emulator.c28x.program import type_named
from emulator.c28x.rts_functions import Rts
from emulator.c28x.runtime import Runtime
from emulator.c28x.symbols import EnumType, Module
from emulator.c28x.tree import Function, Variable
from emulator.clock import Clock
from emulator.cpu import Cpu
from firmware_model import c_files
from firmware_model.calibration import CALIBRATION
from firmware_model.corrections import ALL, overlays, resolve
from firmware_model.objects import (
    Array,
    Enumeration,
    Structure,
    characters,
    given,
    make,
    meant_for,
    read,
    seen,
    text,
    write,
)

#: The C files of the robot, in link order.
MODULES: Final = (
    "firmware_model.robot_types", "firmware_model.us", "firmware_model.gyro", "firmware_model.odometry",
    "firmware_model.protocol", "firmware_model.servidores", "firmware_model.main_robot",
)  # fmt: skip
#: What else a correction may touch.
_CORRECTABLE: Final = (*MODULES, *(f"firmware_model.board_support.{n}" for n in ("xbee", "servos", "spi", "encoder")))


class Target(Protocol):
    """What a board offers to a linked image."""

    clock: Clock
    cpu: Cpu
    findings: Findings
    memory: Memory

    def register(self, block: str, name: str) -> Any:
        """The register that C calls `block.name`."""

    def register_at(self, address: int) -> Any:
        """The register at a word address; None if there is none."""

    def externs(self, runtime: Runtime) -> Mapping[str, Callable[..., Any]]:
        """What implements the externs of the board's headers."""

    def watch(self, linked: Linked) -> Any:
        """Watch what only shows between the tasks of an image linked with `watch`."""


class LinkedFunction:
    """A function of the firmware: called from Python with plain numbers."""

    __slots__ = ("_call", "_function", "_linked")

    def __init__(self, linked: Linked, function: Function, call: Callable[..., Any]) -> None:
        self._linked = linked
        self._function = function
        self._call = call

    def __call__(self, *arguments: Any) -> Any:
        function, wanted = self._function, self._function.parameters
        if len(arguments) != len(wanted):
            names = ", ".join(f"{v.declaration.ctype} {v.name}" for v in wanted) or "void"
            raise TypeError(f"{function.name}({names}) takes {len(wanted)} arguments, {len(arguments)} given")
        runtime = self._linked.runtime
        passed = []
        for argument, parameter, ctype in zip(arguments, wanted, function.ctype.parameters, strict=True):
            with meant_for(f"{function.name}({parameter.name})"):
                passed.append(given(argument, ctype, runtime.memory))
        sp, position = runtime.cpu.sp, runtime.findings.position
        at, calls = position.at, position.calls
        try:
            return seen(self._call(*passed), self._function.ctype.result, runtime.memory)
        except RecursionError:
            runtime.unwind(sp)
            position.at, position.calls = at, calls
            message = f"{self._function.path}: calls within calls without an end, deeper than any stack"
            raise RecursionError(message) from None
        except BaseException:  # a trap, an endless poll
            runtime.unwind(sp)
            position.at, position.calls = at, calls
            raise

    @property
    def __name__(self) -> str:
        return self._function.name

    @property
    def translated(self) -> Callable[..., Any]:
        """The translated function itself, as the kernel calls it."""
        return self._call

    @property
    def text(self) -> str:
        """The Python that the translator made of it."""
        return self._linked.sources[self._function.path]


class ModuleFace:
    """One C file: its functions, objects and types as attributes."""

    def __init__(self, linked: Linked, module: Module) -> None:
        object.__setattr__(self, "_linked", linked)
        object.__setattr__(self, "_module", module)

    def __getattr__(self, name: str) -> Any:
        symbol = self._module.symbols.get(name)
        match symbol:
            case Function() if symbol.path in self._linked.functions:
                return LinkedFunction(self._linked, symbol, self._linked.functions[symbol.path])
            case Variable():
                return read(self._pointer(symbol))
            case EnumType():
                return Enumeration(symbol)
        raise AttributeError(f"{self._module.c_file} declares no {name}")

    def enumeration(self, constant: str) -> Enumeration:
        """The enumeration that has a constant of this name: in C it may have no name of its own."""
        for symbol in self._module.symbols.values():
            if isinstance(symbol, EnumType) and constant in symbol.constants:
                return Enumeration(symbol)
        raise AttributeError(f"{self._module.c_file} declares no constant {constant}")

    def __setattr__(self, name: str, value: Any) -> None:
        symbol = self._module.symbols.get(name)
        if not isinstance(symbol, Variable):
            raise AttributeError(f"{self._module.c_file} declares no object {name}")
        with meant_for(f"{self._module.short}.{name}"):
            write(self._pointer(symbol), value)

    def _pointer(self, variable: Variable) -> Pointer:
        pointer: Pointer = self._linked.pointer(variable)
        return pointer

    def pointer(self, name: str) -> Pointer:
        """`&name`."""
        symbol = self._module.symbols.get(name)
        if not isinstance(symbol, Variable):
            raise AttributeError(f"{self._module.c_file} declares no object {name}")
        return self._pointer(symbol)

    def __dir__(self) -> list[str]:
        return sorted(filter(str.isidentifier, self._module.symbols))


class Firmware:
    """A linked image.  Modules are attributes: `fw.us`, `fw.gyro`, ..."""

    def __init__(self, linked: Linked) -> None:
        self.linked = linked
        self.runtime = linked.runtime
        self.memory = linked.runtime.memory
        self._faces = {m.short: ModuleFace(linked, m) for m in linked.program.modules.values()}

    def __getattr__(self, name: str) -> ModuleFace:
        face = self.__dict__.get("_faces", {}).get(name)
        if face is None:
            raise AttributeError(f"no module {name} in this image: it has {', '.join(self.__dict__.get('_faces', {}))}")
        return face  # type: ignore[no-any-return]

    def function(self, path: str) -> Callable[..., Any]:
        """The translated function `module.name` itself, as the kernel calls it.  Raises ValueError if there is none."""
        function = self.linked.functions.get(path)
        if function is None:
            raise ValueError(f"the firmware defines no function {path}")
        return function

    def array(self, ctype: str, values: Sequence[Any]) -> Array:
        """A new C array of these values; None is never written, a `str` gets its NUL, `bytes` are taken as they are."""
        element = self._type(ctype)
        if isinstance(values, int):
            raise ValueError(f"array({ctype!r}, {values}): give the values; [None] * {values} is never written")
        codes = characters(values) if isinstance(values, str) else values
        whole = ArrayType(f"{element}[{len(codes)}]", element, max(1, len(codes)))
        array = Array(make(self.memory, whole, "array"))
        for i, value in enumerate(codes):
            if value is not None:
                with meant_for(f"array({ctype!r})[{i}]"):
                    array[i] = value
        return array

    def new(self, ctype: str, value: Any = None, **members: Any) -> Any:
        """A new C object: `new("REFERENCE", V=0.1, W=0)` is a `Structure`, `new("float32", 1.5)` a pointer to it."""
        place = make(self.memory, self._type(ctype), ctype)
        if value is not None:
            with meant_for(f"new({ctype!r})"):
                write(place, value)
        if not isinstance(place.target, StructType):
            return place
        structure = Structure(place)
        for name, member in members.items():
            setattr(structure, name, member)
        return structure

    def text(self, characters: Array | Pointer) -> str:
        """The string that begins there, without its NUL."""
        return text(characters)

    def _type(self, name: str) -> CType:
        words = name.split()
        known = BASIC.get(name) or specified(words) or type_named(self.linked.program, " ".join(words))
        if known is None:
            raise ValueError(f"no C type {name}: {', '.join(BASIC)}, C's own names, or a type of the firmware")
        return known

    def initial(self, path: str, value: Any) -> None:
        """The value that a never-written object starts from, whatever the fill; None gives it back to the fill."""
        known = self.runtime.initials.setdefault(path, {})
        if value is None:
            known.pop("value", None)
        else:
            known["value"] = value

    def plant(self, path: str, index: int, value: Any) -> None:
        """What the cell holds that `path[index]`, outside the object, designates."""
        self.runtime.planted.setdefault(path, {})[index] = value

    def planted(self, path: str, index: int) -> Any:
        """What that cell holds now."""
        return self.runtime.planted[path][index]

    def last_locals(self, path: str) -> dict[str, Any]:
        """The locals of `module.function` at its last return.  Needs `link(..., keep_locals=True)`."""
        if not self.linked.options.keep_locals:
            raise ValueError("locals are kept only by an image linked with keep_locals=True")
        return self.linked.last_locals[path]


def link(
    board: Target, *, modules: Iterable[str] = MODULES, fill: str = "zero",
    divide: str = "ieee", float_to_int: str = "saturate", externs: Mapping[str, Callable[..., Any]] | None = None,
    room: Mapping[str, int] | None = None, keep_locals: bool = False, fixes: Iterable[str] = (),
    watch: bool = False, static: bool = False, entries: Iterable[str] = (),
    include: Sequence[str | Path] = (), defines: Sequence[str] = (), abi: str = "coff",
    firmware: Iterable[str | Path] = (), coverage: Coverage | None = None, steps: bool = False,
) -> Firmware:  # fmt: skip
    """Translate `modules` and bind them to `board`.

    `fill` says what never-written objects hold (`zero`, `ones`, `nan`,
    `random:SEED`, `stack`, `trap`); `divide` selects the float divider (`ieee`, `nr`), `float_to_int` what a conversion
    out of range gives (`saturate`, `low16`).  `externs` replaces externs or firmware functions by name; `room` gives
    arrays (`module.function.name`) more elements than the C does; `fixes` names corrections of the catalogue to link
    in, or `all`.  `watch` looks for what only shows between tasks (`emulator.sysbios.watch`); `static` reports
    what the typed tree shows without running; `entries` are functions that are called from outside of the image
    (`us.Read_Distance`, or a pattern: `us.*`), for what `static` says of functions never called.  `firmware` names the
    robot's own C files, or folders with them: each takes the place of the module that mirrors it.  `include`, `defines`
    and `abi` are for these and for modules that are C files (see `Program`).  `coverage` takes up how often each
    statement is begun.

    Raises ValueError for an unknown policy and for source outside the language, with file and line.
    """
    runtime = Runtime(
        board.clock, board.cpu, board.findings, board.memory, fill=fill, divide=divide, float_to_int=float_to_int
    )
    board.memory.fill_word = runtime.fill_word
    runtime.register_at = board.register_at
    options = Options(
        residue=runtime.fill == "stack", keep_locals=keep_locals, ieee=divide == "ieee",
        room=dict(room or {}), calibration=CALIBRATION, watch=watch, static=static,
        entries=frozenset(entries), coverage=coverage is not None, steps=steps,
    )  # fmt: skip
    implemented: dict[str, Callable[..., Any]] = {}
    rts = Rts(runtime)
    implemented.update({name: getattr(rts, name) for name in dir(rts) if not name.startswith("_")})
    implemented.update(board.externs(runtime))
    modules, own = tuple(modules), c_files.own(firmware)
    corrections, chosen = overlays(_CORRECTABLE), resolve(fixes)
    own.refuse_corrections(corrections, chosen)
    asked: dict[str, Any] = {
        "names": (*modules, *own.besides), "overlays": corrections, "fixes": chosen, "include": include,
        "defines": defines, "abi": abi,
    }  # fmt: skip
    if own.files or any(name.lower().endswith(".c") for name in modules):
        asked |= own.arguments()
    program = compiled(
        asked, options, lambda block, name: board.register(block, name).looked_at,
        keep=chosen in (frozenset(), resolve([ALL])),  # the audit alone makes a hundred others, each once
    )  # fmt: skip
    linked = Linked(
        program, runtime, registers=board.register, externs=implemented, replaced=externs or {}, coverage=coverage
    )
    if watch:
        board.findings.marking = True
        board.watch(linked)
    return Firmware(linked)
