"""A firmware image: modules or C files, linked to one system.

    fw = link(System(), ["filter.c"])
    fw.filter.smooth(3)                            # a function of filter.c
    fw.filter.level                                # a file-scope object of it

Everything belongs to the image: several of them live side by side in one process.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from emulator.c28x.cache import compiled
from emulator.c28x.compiled_program import Compiled
from emulator.c28x.coverage import Coverage
from emulator.c28x.ctypes import BASIC, ArrayType, CType, StructType, specified
from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION
from emulator.c28x.link import Linked
from emulator.c28x.memory import Pointer
from emulator.c28x.objects import (
    Array,
    Enumeration,
    Structure,
    c_value,
    characters,
    make,
    named_error,
    read,
    text,
    to_python,
    write,
)
from emulator.c28x.options import CHARGE_BY_CALL, CompileOptions
from emulator.c28x.program import type_named
from emulator.c28x.rts_functions import library
from emulator.c28x.runtime import Runtime
from emulator.c28x.symbols import EnumType, Module
from emulator.c28x.tree import Function, Variable
from emulator.system import System


class LinkedFunction:
    """A function of the firmware, which Python calls with plain numbers."""

    __slots__ = ("_call", "_function", "_linked")

    def __init__(self, linked: Linked, function: Function, call: Callable[..., Any]) -> None:
        self._linked = linked
        self._function = function
        self._call = call

    def __call__(self, *arguments: Any) -> Any:
        """Call it, as C would.  Raises TypeError for arguments that it does not take."""
        function, wanted = self._function, self._function.parameters
        if len(arguments) != len(wanted):
            names = ", ".join(f"{v.declaration.ctype} {v.name}" for v in wanted) or "void"
            raise TypeError(f"{function.name}({names}) takes {len(wanted)} arguments, {len(arguments)} given")
        runtime = self._linked.runtime
        passed = []
        for argument, parameter, ctype in zip(arguments, wanted, function.ctype.parameters, strict=True):
            with named_error(f"{function.name}({parameter.name})"):
                passed.append(c_value(argument, ctype, runtime.memory))
        sp, position = runtime.cpu.sp, runtime.findings.position
        at, calls = position.at, position.calls
        try:
            return to_python(self._call(*passed), self._function.ctype.result, runtime.memory)
        except RecursionError:
            runtime.unwind(sp)
            position.at, position.calls = at, calls
            message = f"{self._function.path}: unbounded recursion: the calls nest deeper than any stack"
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
        """The Python source that the translator made of it."""
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
        with named_error(f"{self._module.short}.{name}"):
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
                with named_error(f"array({ctype!r})[{i}]"):
                    array[i] = value
        return array

    def new(self, ctype: str, value: Any = None, **members: Any) -> Any:
        """A new C object: `new("REFERENCE", V=0.1, W=0)` is a `Structure`, `new("float32", 1.5)` a pointer to it."""
        place = make(self.memory, self._type(ctype), ctype)
        if value is not None:
            with named_error(f"new({ctype!r})"):
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
        """Set the initial value of a never-written object, in place of the fill.  None restores the fill."""
        known = self.runtime.initials.setdefault(path, {})
        if value is None:
            known.pop("value", None)
        else:
            known["value"] = value

    def plant(self, path: str, index: int, value: Any) -> None:
        """Set the value of the memory cell at `path[index]`, where the index lies outside of the object."""
        self.runtime.planted.setdefault(path, {})[index] = value

    def planted(self, path: str, index: int) -> Any:
        """The present value of such a cell."""
        return self.runtime.planted[path][index]

    def last_locals(self, path: str) -> dict[str, Any]:
        """The locals of `module.function` at its last return.  Needs `link(..., keep_locals=True)`."""
        if not self.linked.options.keep_locals:
            raise ValueError("locals are kept only by an image linked with keep_locals=True")
        return self.linked.last_locals[path]


def runtime_of(
    system: System, *, fill: str = "zero", divide: str = "ieee", float_to_int: str = "saturate",
    driven: Callable[[], bool] | None = None,
) -> Runtime:  # fmt: skip
    """The run-time of an image on `system`.

    `fill` says what never-written objects hold (`zero`, `ones`, `nan`, `random:SEED`, `stack`, `trap`); `divide`
    selects the float divider (`ieee`, `nr`), `float_to_int` what a conversion out of range gives (`saturate`,
    `low16`).  `driven()` says whether the host runs the firmware in slices of time (see `Runtime`): as a rule it does
    while its kernel runs.  Raises ValueError for an unknown policy.
    """
    return Runtime(
        system.clock, system.cpu, system.findings, system.memory, fill=fill, divide=divide, float_to_int=float_to_int,
        register_at=system.register_at, blames_unmodelled=system.blames_unmodelled,
        driven=driven or (lambda: system.kernel.active),
    )  # fmt: skip


def bind(
    system: System, program: Compiled, runtime: Runtime, *, externs: Mapping[str, Callable[..., Any]] | None = None,
    coverage: Coverage | None = None, built: Callable[[str], Any] | None = None,
) -> Linked:  # fmt: skip
    """Bind a compiled program to `system`.

    `externs` replaces externs or firmware functions by name.  A program that was compiled with `watch` is watched.
    `built` is that of `Linked`.
    """
    linked = Linked(
        program, runtime, registers=system.register, externs=library(runtime) | dict(system.externs()),
        replaced=externs or {}, coverage=coverage, built=built,
    )  # fmt: skip
    system.kernel.core.double = runtime.double
    if program.options.watch:
        system.watch(linked)
    return linked


def link(
    system: System, modules: Iterable[str], *, fill: str = "zero",
    divide: str = "ieee", float_division: str = DEFAULT_FLOAT_DIVISION, float_to_int: str = "saturate",
    externs: Mapping[str, Callable[..., Any]] | None = None,
    room: Mapping[str, int] | None = None, keep_locals: bool = False,
    watch: bool = False, static: bool = False, entries: Iterable[str] = (),
    include: Sequence[str | Path] = (), defines: Sequence[str] = (), abi: str = "coff",
    coverage: Coverage | None = None, steps: bool = False,
    calibration: Mapping[str, float] | None = None, asked: Mapping[str, Any] | None = None,
    charge_by_call: bool = CHARGE_BY_CALL, built: Callable[[str], Any] | None = None,
) -> Firmware:  # fmt: skip
    """Translate `modules` and bind them to `system`.

    `fill`, `divide` and `float_to_int` are those of `runtime_of`, `externs` that of `bind`.  `room` gives arrays
    (`module.function.name`) more elements than the C does.  `watch` looks for errors that show only between threads
    (`emulator.sysbios.watch`).  `static` reports errors that the typed tree shows without a run.  `entries` are
    functions that are called from outside of the image (`us.Read_Distance`, or a pattern: `us.*`): `static` does not
    report them as never called.  `include`, `defines` and `abi` are for modules that are C files.  `float_division`
    says how long a division takes (`calibrated`, `tmu`, `fast`, `standard`).  It, `calibration`,
    `charge_by_call`, `coverage`,
    `keep_locals` and `steps` are those of `CompileOptions`, `built` is that of `Linked`.
    `asked` holds further arguments for `Program`.

    Raises ValueError for an unknown policy and for source outside the language, with file and line.
    """
    runtime = runtime_of(system, fill=fill, divide=divide, float_to_int=float_to_int)
    options = CompileOptions(
        residue=runtime.fill == "stack", keep_locals=keep_locals, ieee=divide == "ieee",
        float_division=float_division, room=dict(room or {}), calibration=dict(calibration or {}), watch=watch,
        static=static, entries=frozenset(entries), coverage=coverage is not None, steps=steps,
        charge_by_call=charge_by_call,
    )  # fmt: skip
    program = compiled(
        {"names": tuple(modules), "include": include, "defines": defines, "abi": abi, **(asked or {})}, options,
        lambda block, name: system.register(block, name).looked_at,
    )  # fmt: skip
    return Firmware(bind(system, program, runtime, externs=externs, coverage=coverage, built=built))
