"""Linking: a compiled program bound to one board.

The objects get their addresses.  Registers, externs and functions are bound by name.  Places get their numbers.  The
result is callable.
"""

from __future__ import annotations

import builtins
from collections.abc import Callable, Mapping, Sequence
from inspect import unwrap
from itertools import takewhile, zip_longest
from math import isinf
from numbers import Integral, Real
from types import CodeType
from types import FunctionType as PyFunction
from typing import Any, Final, cast

from emulator.c28x.arithmetic import f32
from emulator.c28x.compiled_program import Compiled, CompiledFunction, LinkError
from emulator.c28x.coverage import Coverage
from emulator.c28x.ctypes import (
    BOOL,
    CHAR,
    ArrayType,
    BlockType,
    CType,
    Double64,
    FloatType,
    FunctionType,
    HandleType,
    IntType,
    PointerType,
    pointed,
    scalars,
)  # fmt: skip
from emulator.c28x.emit.names import object_name
from emulator.c28x.emit.written import FIRST_NUMBER
from emulator.c28x.intrinsics import InterruptMask, intrinsics
from emulator.c28x.memory import NULL, RAM_WORDS, Object, Pointer
from emulator.c28x.rts_iqmath import IQmath
from emulator.c28x.runtime import Runtime, called_names
from emulator.c28x.sites import Place
from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import (
    AddressOf,
    Binary,
    Const,
    Convert,
    Declaration,
    Expr,
    Function,
    FunctionRef,
    LValue,
    Null,
    RegisterAddress,
    String,
    Variable,
    Where,
)  # fmt: skip
from emulator.c28x.typed_text import ProgramPart, attribute, methods, parts, register_name
from emulator.c28x.watcher import Watcher
from emulator.clock import NEVER

__all__ = ["LinkError", "Linked", "to_c"]


#: Words of RAM and flash on the chip (DS, memory maps): the limit for all objects of an image together.
MEMORY_WORDS: Final = RAM_WORDS + 0x80000


class Linked:
    """A linked program: functions and objects by `module.name`."""

    def __init__(
        self, compiled: Compiled, runtime: Runtime, *, registers: Callable[[str, str], Any],
        externs: Mapping[str, Callable[..., Any]], replaced: Mapping[str, Callable[..., Any]],
        coverage: Coverage | None = None, built: Callable[[str], Any] | None = None,
    ) -> None:  # fmt: skip
        """Bind `compiled` to what `runtime` belongs to.

        `built` gives the module of a part that was compiled (`typed_text.py`), by its identity, or None.
        """
        self.compiled = compiled
        self.program = compiled.program
        self.options = compiled.options
        self.runtime = runtime
        runtime.double = compiled.program.double
        self.registers = registers
        self.externs = intrinsics(cast(InterruptMask, runtime.cpu)) | dict(externs)
        self._iqmath = IQmath(runtime)
        self.replaced = dict(replaced)
        #: Whether calls of functions of the program go elsewhere.
        self._redirected = any(each.function.name in replaced for each in compiled.functions)
        #: The counters of an image that counts statements (`CompileOptions.coverage`).
        self.coverage = coverage or Coverage()
        self.objects: dict[str, Object] = {}
        self.functions: dict[str, Callable[..., Any]] = {}
        self._paths: dict[Callable[..., Any], str] = {}
        #: The generated Python text of each function.
        self.sources: dict[str, str] = {}
        self.last_locals: dict[str, dict[str, Any]] = {}
        self._bound: dict[str, Function] = {}
        self._words = 0
        self.namespace: dict[str, Any] = self._runtime_names()
        #: Its functions by source file, as they are compiled.
        self.parts = parts(compiled, len(runtime.findings.places))
        modules = self._modules(built) if built is not None and not self.replaced else []
        #: For each part the object whose methods its functions are; none: all functions are interpreted.
        self._owners = [
            module.ProgramPart(self.namespace, self._some_register(part))
            for module, part in zip(modules, self.parts, strict=False)
        ]  # fmt: skip
        for variable, _ in compiled.objects:
            self._place(variable)
        for finding in compiled.findings:
            runtime.findings.report_at(
                finding.place, finding.rule, finding.message, object=finding.object, declaration=finding.declaration,
                value=finding.value, how="static",
            )  # fmt: skip
        for part, owner in zip_longest(self.parts, self._owners):
            runtime.findings.places.skip_to(part.first)
            for function, name in zip(part.functions, methods(part.functions), strict=True):
                self._define(function, None if owner is None else getattr(owner, name))
        if self._owners:
            self.namespace = _Attributes(self.namespace, self._owners, [module.NAMES for module in modules])
        for function in compiled.functions:
            self._bind(function)
        if isinstance(self.namespace, _Attributes):
            self.namespace.closed = True
        for variable, values in compiled.objects:
            self._initialise(variable, values)

    @property
    def interpreted(self) -> bool:
        """Whether its functions run as Python; else they are methods of a compiled program."""
        return not self._owners

    def path_of(self, function: Callable[..., Any]) -> str:
        """The `module.name` of a function of the program, as the kernel keeps it; "" for another one."""
        return self._paths.get(unwrap(function), "")

    def watch_with(self, watcher: Watcher) -> None:
        """From now on, tell `watcher` of every access.  Needs an image linked with `watch`."""
        self.namespace["_c_touch"] = watcher.touch  # generated code calls it directly
        self.runtime.watcher = watcher

    def allow_loops(self, cycles: int) -> None:
        """Set how long a loop may compute without a call, in cycles."""
        self.runtime.loop_limit = self.namespace["_c_loop_limit"] = cycles

    def skip_turns(self) -> None:
        """From now on, time skips the turns of loops that change nothing.  Needs an image linked with `watch`.

        Not if functions of the program are replaced: what stands for them does not say whether it changes anything.
        """
        self.runtime.skips_turns = not self._redirected

    # Objects

    def _place(self, variable: Variable) -> None:
        self._words += variable.ctype.words
        if self._words > MEMORY_WORDS:
            where = Where(variable.declaration.file, variable.declaration.line)
            message = f"{variable.declaration.name} does not fit: the objects of the image have {self._words} words"
            raise SourceError.at(where, f"{message}, RAM and flash of the chip {MEMORY_WORDS}")
        memory, at = self.runtime.memory, variable.address
        obj = memory.place(variable.declaration) if at is None else memory.name_address(variable.declaration, at)
        # A constant is in flash.  CHOICE: its address is among those of the other objects, in the order of the source.
        obj.readonly = variable.constant and not variable.volatile and variable.initial is not None
        self.objects[variable.declaration.path] = obj
        name = object_name(variable)
        self.namespace[f"_o_{name}"] = obj
        self.namespace[f"_g_{name}"] = obj.data
        self.namespace[f"_p_{name}"] = Pointer(self.runtime.memory, obj, 0, pointed(variable.ctype))

    def _modules(self, built: Callable[[str], Any]) -> list[Any]:
        """The module of each part; none if one is not compiled."""
        modules = [*takewhile(bool, (built(part.identity) for part in self.parts))]
        return modules if len(modules) == len(self.parts) else []

    def _some_register(self, part: ProgramPart) -> Any:
        """Any register that the functions of a part use, or None if they use none."""
        used = (name for function in part.functions for name in function.written.names.registers.values())
        block, register, _ = next(used, ("", "", ""))
        return self.registers(block, register) if register else None

    def pointer(self, variable: Variable) -> Pointer:
        """A pointer to a whole file-scope object.  (Generated code points to the first element of an array instead.)"""
        return Pointer(self.runtime.memory, self.objects[variable.declaration.path], 0, variable.ctype)

    def _initialise(self, variable: Variable, values: list[Any] | None) -> None:
        """Do what `.cinit` does: set the objects that have an initialiser; the others keep what RAM holds."""
        if values is not None:
            self.objects[variable.declaration.path].data[:] = [
                value.value if type(value) is Const else self._constant(value, variable) for value in values
            ]

    def _constant(self, e: Any, variable: Variable) -> Any:
        declaration = variable.declaration
        match e:
            case Const(value=value):
                return value
            case Null():
                return NULL
            case String(text=text):
                return self._string(text)
            case FunctionRef(function=function) if not function.extern:
                return self.functions[function.path]
            case FunctionRef(function=function):
                return self._extern(function)
            case RegisterAddress(ctype=ctype, block=block, register=register):
                return self._register_address(block, register, ctype)
            case AddressOf(ctype=ctype, lvalue=LValue(root=Variable() as root, words=words, indices=indices)) if all(
                isinstance(index.expr, Const) for index in indices
            ):
                base = self.pointer(root)
                words += sum(int(index.expr.value) * index.words for index in indices if isinstance(index.expr, Const))
                target = ctype.target if isinstance(ctype, PointerType) else base.target
                return self.runtime.address(base, words, target)
            case Convert(ctype=PointerType() as ctype, operand=operand):
                return self.runtime.cast(self._constant(operand, variable), ctype)
            case Convert(ctype=FunctionType() | HandleType(), operand=operand):
                return self._constant(operand, variable)
            case Convert(ctype=IntType() as ctype, operand=operand):
                number = self._constant(operand, variable)
                return ctype.wrap(number if isinstance(number, int) else self.runtime.code(number))
            case Binary(op=">>", left=left, right=Const(value=int(by))):
                return self._constant(left, variable) >> by
        where = e.where if isinstance(e, Expr) and e.where.line else Where(declaration.file, declaration.line)
        raise SourceError.at(where, f"the initialiser of {declaration.name} is not a constant")

    def _string(self, text: str) -> Pointer:
        ctype = ArrayType(f"char[{len(text) + 1}]", CHAR, len(text) + 1)
        declaration = Declaration(repr(text), ctype, "constant", "", 0)
        obj = self.runtime.memory.place(declaration, "econst", [*(ord(c) for c in text), 0])
        return Pointer(self.runtime.memory, obj, 0, CHAR)

    def _register_address(self, block: str, register: str, ctype: CType) -> Pointer:
        target = ctype.target if isinstance(ctype, PointerType) else ctype
        offset = 0
        if not register and isinstance(target, BlockType):  # the block begins `offset` words before its first register
            register, entry = next(iter(target.layout.items()))
            offset = entry.offset
        return Pointer(self.runtime.memory, None, self.registers(block, register).address - offset, target)

    # Code

    def _runtime_names(self) -> dict[str, Any]:
        runtime = self.runtime
        called = {name: getattr(runtime, method) for name, method in called_names(watch=self.options.watch).items()}
        return called | {
            "_c_clock": runtime.clock, "_c_position": runtime.findings.position, "_cpu": runtime.cpu,
            "_c_runtime": runtime, "_range": range, "_max": max, "_len": len, "_c_NULL": NULL, "_c_NEVER": NEVER,
            "_c_f32": f32, "_c_register_address": self._register_address, "_c_loop_limit": runtime.loop_limit,
            "_c_poll_limit": runtime.poll_limit, "_c_unmodelled_wait": runtime.unmodelled_wait,
            "_c_outward": _to_extern, "_c_spill": self._spill, "__builtins__": builtins.__dict__,
        }  # fmt: skip

    def _define(self, compiled: CompiledFunction, method: Callable[..., Any] | None) -> None:
        """Create a function, or take its method, and number its places."""
        path = compiled.path
        self.sources[path] = compiled.written.text
        first = self.runtime.findings.places.add(compiled.written.places)
        if method is not None:
            defined = method
        else:
            (code,) = [c for c in compiled.code.co_consts if isinstance(c, CodeType)]
            defined = PyFunction(_numbered(code, first, compiled.function.name), self.namespace)
            defined.__qualname__ = path
        self.functions[path] = defined
        self._paths[defined] = path
        function, where = compiled.function, compiled.function.where
        self.runtime.signatures[defined] = function.ctype
        begins = Place(where.file, where.line, function.name, function.c_file, where.column)
        self.runtime.findings.beginnings[defined] = begins
        if function.interrupt is not None:
            self.runtime.findings.interrupts[begins] = function.interrupt
        self.runtime.findings.sources[where.file] = function.c_file

    def _bind(self, compiled: CompiledFunction) -> None:
        """Bind every name that the text of a function refers to."""
        space, names = self.namespace, compiled.written.names
        space.update(names.constants)
        if compiled.written.counted:
            function = compiled.function
            space[names.counters] = self.coverage.counters(function.where.file, function.name, compiled.written.counted)
        for name, (block, register, access) in names.registers.items():
            if name not in space:
                cell = self.registers(block, register)
                cell.follow(access, space, name)
                if self._owners:
                    space[register_name(name)] = cell
        for name, text in names.strings.items():
            space[name] = self._string(text)
        for name, function in names.functions.items():
            known = self._bound.setdefault(name, function)
            if known is not function and not (known.extern and function.extern):
                both = f"is defined in {known.module} and in {function.module}"
                raise ValueError(f"{function.name} {both}: a linker has one name for both")
            if function.name in self.replaced:
                space[name] = self.replaced[function.name]
            elif function.extern:
                space[name] = self._extern(function)
            else:
                space[name] = self.functions[function.path]

    def _extern(self, function: Function) -> Callable[..., Any]:
        """The implementation of an extern.  Raises LinkError if there is none."""
        name, where = function.name, function.where
        found = self.externs.get(name) or self._iqmath.named(name)
        if found is None:
            if where.line:
                unknown = f"{name} is declared, and no file defines it: name the one that does too"
                raise LinkError(f"{where}: {function.missing or unknown}")
            raise LinkError(f"{name} is declared extern in {function.module} but nothing implements it")
        return found

    def replace(self, name: str, function: Callable[..., Any]) -> None:
        """Redirect every call of the firmware function or extern `name` to `function`.

        Raises ValueError for a function of a compiled program, which calls it directly.
        """
        for prefix in ("_f_", "_x_"):
            if prefix + name in self.namespace:
                self.namespace[prefix + name] = function
                self._redirected |= prefix == "_f_"
        self.runtime.skips_turns &= not self._redirected

    def _spill(self, what: tuple[str, list[Variable]], fp: int | None, values: tuple[Any, ...]) -> None:
        """Write the locals of a returning function to the stack memory, and keep them for tests."""
        path, variables = what
        if self.options.residue and fp is not None:
            memory = self.runtime.memory
            for variable, value in zip(variables, values, strict=True):
                leaves = value if variable.in_memory else [value]
                for leaf, (offset, ctype) in zip(leaves, scalars(variable.ctype), strict=True):
                    if leaf is not None:
                        for i, word in enumerate(memory.words_of(leaf, ctype)):
                            memory.words[fp + variable.frame_offset + offset + i] = word
        if self.options.keep_locals:
            self.last_locals[path] = {
                v.name: list(x) if isinstance(x, list) else x for v, x in zip(variables, values, strict=True)
            }


class _Attributes(dict[str, Any]):
    """The names of a program whose functions are methods: what these refer to is an attribute of their objects too."""

    def __init__(self, names: Mapping[str, Any], owners: Sequence[Any], bound: Sequence[frozenset[str]]) -> None:
        """`bound` are the names that the methods of each of `owners` refer to."""
        super().__init__()
        self._owners: dict[str, list[Any]] = {}
        for owner, referred in zip(owners, bound, strict=True):
            for name in referred:
                self._owners.setdefault(name, []).append(owner)
        #: Whether all is bound: from then on, functions stay, because methods call each other directly.
        self.closed = False
        self.update(names)

    def __setitem__(self, name: str, value: Any) -> None:
        if self.closed and name.startswith("_f_"):
            raise ValueError(f"{name[3:]} cannot be replaced in a compiled program: link it without `built`")
        super().__setitem__(name, value)
        for owner in self._owners.get(name, ()):
            setattr(owner, attribute(name), value)

    def update(self, names: Mapping[str, Any]) -> None:  # type: ignore[override]
        """Bind all of `names`."""
        for name, value in names.items():
            self[name] = value


def _numbered(code: CodeType, first: int, name: str) -> CodeType:
    """The code of a function under its C name, with its places numbered from `first`."""
    by = first - FIRST_NUMBER
    constants = tuple(c + by if type(c) is int and c >= FIRST_NUMBER else c for c in code.co_consts)
    return code.replace(co_consts=constants, co_name=name)


def _to_extern(value: Any) -> Any:
    """A value that is passed to an extern: NULL becomes None."""
    return None if isinstance(value, Pointer) and not value else value


def to_c(value: Any, ctype: CType) -> Any:
    """A Python argument as a C value of `ctype`.  A text of one character becomes its code; a `_Bool` becomes 0 or 1.

    Raises ValueError for a value that the type cannot hold.
    """
    if isinstance(ctype, IntType):
        if isinstance(value, str | bytes) and len(value) == 1:
            value = ord(value)
        if not isinstance(value, Integral) or not ctype.low <= int(value) <= ctype.high:
            raise ValueError(f"{value!r} is no {ctype} ({ctype.low}..{ctype.high})")
        return int(value) if ctype != BOOL else int(value != 0)
    if isinstance(ctype, FloatType):
        if not isinstance(value, Real):
            raise ValueError(f"{value!r} is no {ctype}")
        wide = isinstance(ctype, Double64)
        rounded = float(value) if wide else f32(float(value))
        if isinf(rounded) and not isinf(value):
            raise ValueError(f"{value!r} is no {ctype} (up to 3.4e38)")
        return rounded
    if isinstance(ctype, PointerType) and isinstance(value, str | bytes | int | float | Sequence):
        raise ValueError(f"{value!r} is not a {ctype}: make an object with firmware.array or firmware.new")
    if isinstance(ctype, PointerType | HandleType):
        return NULL if value is None else value
    return value
