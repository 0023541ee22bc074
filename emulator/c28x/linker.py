"""Linking: typed trees to running code, bound to one board.

`Program` gives declarations and trees, `emit` the text; here the text is compiled under the names and
line numbers of the firmware source, its registers, externs and objects are bound, and the result is callable.
"""

from __future__ import annotations

import ast
import builtins
import fnmatch
from collections.abc import Callable, Iterable, Mapping, Set
from functools import lru_cache
from types import CodeType
from types import FunctionType as PyFunction
from typing import Any

from emulator.c28x.arithmetic import f32
from emulator.c28x.ctypes import (
    CHAR,
    ArrayType,
    CType,
    FunctionType,
    HandleType,
    IntType,
    PointerType,
    scalars,
)  # fmt: skip
from emulator.c28x.emit import FunctionEmitter
from emulator.c28x.emit_needs import Needs, Options
from emulator.c28x.memory import NULL, Object, Pointer, to_words
from emulator.c28x.program import Program
from emulator.c28x.runtime import Runtime, Site
from emulator.c28x.static_checks import check as check_statically
from emulator.c28x.symbols import Module, SourceError
from emulator.c28x.tree import (
    AddressOf,
    Const,
    Convert,
    Declaration,
    FunctionRef,
    LValue,
    Null,
    String,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import compared


class LinkError(ValueError):
    """A name that nothing defines, or a construct outside the language."""


class Linked:
    """A linked program: functions and objects by `module.name`."""

    def __init__(
        self, program: Program, runtime: Runtime, options: Options, *,
        registers: Callable[[str, str], Any], externs: Mapping[str, Callable[..., Any]],
        replaced: Mapping[str, Callable[..., Any]],
    ) -> None:  # fmt: skip
        self.program = program
        self.runtime = runtime
        self.options = options
        self.registers = registers
        self.externs = dict(externs)
        self.replaced = dict(replaced)
        self.needs = Needs(looked_at=lambda block, name: self.registers(block, name).looked_at)
        self.objects: dict[str, Object] = {}
        self.functions: dict[str, Callable[..., Any]] = {}
        self.sources: dict[str, str] = {}
        self.initials: dict[str, dict[str, Any]] = {}
        self.planted: dict[str, dict[int, Any]] = {}
        self.last_locals: dict[str, dict[str, Any]] = {}
        self.namespace: dict[str, Any] = {}
        self._link()

    def _link(self) -> None:
        firmware = self.program.translate()
        self.namespace.update(self._runtime_names())
        for module in firmware:
            for unit in (module, *module.units.values()):
                self.runtime.findings.sources[unit.file] = module.c_file
            for variable in module.variables:
                self._place(module, variable)
        if self.options.static:
            given = {variable: variable.initial or [] for module in firmware for variable in module.variables}
            check_statically(firmware, given, self.runtime.findings, self._entries(firmware))
        self.needs.compared = compared(f for module in firmware for f in module.functions)
        for module in firmware:
            self._compile(module)
        self._bind()
        for module in firmware:
            for variable in module.variables:
                self._initialise(module, variable, variable.initial)

    def _entries(self, firmware: Iterable[Module]) -> frozenset[str]:
        """The functions that `Options.entries` means.  Raises LinkError for an entry that means none."""
        paths = [function.path for module in firmware for function in module.functions]
        meant: set[str] = set()
        for entry in self.options.entries:
            found = fnmatch.filter(paths, entry)
            if not found and not set(entry) & set("*?["):
                raise LinkError(f"no function {entry} that could be an entry: write module.function")
            meant.update(found)
        return frozenset(meant)

    # Objects

    def _place(self, module: Module, variable: Variable) -> None:
        obj = self.runtime.memory.place(variable.declaration)
        self.objects[variable.declaration.path] = obj
        name = f"{variable.declaration.module}_{variable.name}"
        self.namespace[f"_g_{name}"] = obj.data
        self.namespace[f"_p_{name}"] = Pointer(self.runtime.memory, obj, 0, variable.ctype)

    def _initialise(self, module: Module, variable: Variable, values: list[Any] | None) -> None:
        """What `.cinit` does: objects with an initialiser get it; the others keep whatever RAM holds."""
        obj = self.objects[variable.declaration.path]
        if values is not None:
            obj.data[:] = [self._constant(value, module, variable) for value in values]
        elif not self.options.checked:
            runtime = self.runtime
            obj.data[:] = [
                runtime.fill_value(t, f"{variable.declaration.path}+{o}", obj.base + o)
                for o, t in scalars(variable.ctype)
            ]

    def _constant(self, e: Any, module: Module, variable: Variable) -> Any:
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
                return self.externs[function.name]
            case AddressOf(ctype=ctype, lvalue=LValue(root=Variable() as root, words=words, indices=[])):
                base = self.namespace[f"_p_{root.declaration.module}_{root.name}"]
                target = ctype.target if isinstance(ctype, PointerType) else base.target
                return self.runtime.address(base, words, target)
            case Convert(ctype=PointerType() as ctype, operand=operand):
                return self.runtime.cast(self._constant(operand, module, variable), ctype)
            case Convert(ctype=FunctionType() | HandleType(), operand=operand):
                return self._constant(operand, module, variable)
        where = variable.declaration
        raise SourceError(where.file, where.line, f"the initialiser of {variable.name} is not a constant")

    def _string(self, text: str) -> Pointer:
        ctype = ArrayType(f"char[{len(text) + 1}]", CHAR, len(text) + 1)
        declaration = Declaration(repr(text), ctype, "constant", "", 0)
        obj = self.runtime.memory.place(declaration, "econst", [*(ord(c) for c in text), 0])
        return Pointer(self.runtime.memory, obj, 0, CHAR)

    # Code

    def _runtime_names(self) -> dict[str, Any]:
        runtime = self.runtime

        def fill(site: Site) -> Any:
            return runtime.fill_value(site.ctype, f"{site.name}+0")

        watch = self.options.watch
        return {
            "_c_touch": runtime.touch, "_c_load": runtime.watched_load if watch else runtime.load,
            "_c_store": runtime.watched_store if watch else runtime.store,
            "_c_copy": runtime.watched_copy if watch else runtime.copy_struct,
            "_c_clock": runtime.clock, "_cpu": runtime.cpu, "_range": range, "_max": max, "_c_NULL": NULL, "_len": len,
            "_c_f32": f32, "_c_uninit": runtime.uninit, "_c_oob_load": runtime.oob_load,
            "_c_oob_store": runtime.oob_store,
            "_c_member_index": runtime.member_index,
            "_c_address": runtime.address, "_c_cast": runtime.cast, "_c_pointer_at": runtime.pointer_at,
            "_c_enter": runtime.enter, "_c_retire": runtime.retire, "_c_callable": runtime.callable,
            "_c_oob_deep_load": runtime.oob_deep_load, "_c_oob_deep_store": runtime.oob_deep_store,
            "_c_stale": runtime.stale, "_c_wrapped": runtime.wrapped, "_c_octet": runtime.octet,
            "_c_narrowed": runtime.narrowed, "_c_quotient": runtime.quotient,
            "_c_float_result": runtime.float_result, "_c_float_out": runtime.float_out,
            "_c_overflow": runtime.overflow, "_c_float_to_int": runtime.float_to_int,
            "_c_divide_floats": runtime.divide_floats, "_c_divide_ints": runtime.divide_ints,
            "_c_modulo_ints": runtime.modulo_ints, "_c_shift": runtime.shift,
            "_c_endless": runtime.endless, "_c_loop_limit": runtime.loop_limit,
            "_c_poll": runtime.poll, "_c_poll_limit": runtime.poll_limit,
            "_c_stack_check": runtime.stack_check, "_c_outward": _outward, "_c_inward": _inward,
            "_c_spill": self._spill, "_c_fill": fill, "_c_filled": runtime.filled, "__builtins__": builtins.__dict__,
        }  # fmt: skip

    def _compile(self, module: Module) -> None:
        for function in module.functions:
            file = module.unit(function.name).file
            self.needs.begin(function)
            emitter = FunctionEmitter(function, self.needs, self.options)
            factors = self.options.calibration
            emitter.factor = factors.get(f"{module.name}.{function.name}", factors.get(module.name, 1.0))
            emitter.initials, emitter.planted = self.initials, self.planted
            lines = emitter.function_text()
            text = "\n".join(line for line, _ in lines)
            self.sources[function.path] = text
            exec(_code(text, file, tuple(number for _, number in lines)), self.namespace)
            compiled: PyFunction = self.namespace.pop(function.name)
            compiled.__qualname__ = function.path
            self.functions[function.path] = compiled

    def _bind(self) -> None:
        space, needs = self.namespace, self.needs
        space.update(needs.names)
        for name, (block, register, access) in needs.registers.items():
            self.registers(block, register).follow(access, space, name)
        for name, text in needs.strings.items():
            space[name] = self._string(text)
        for name, function in needs.functions.items():
            if function.name in self.replaced:
                space[name] = self.replaced[function.name]
            elif function.extern:
                if function.name not in self.externs:
                    where = f"{function.name} is declared extern in {function.module}"
                    raise LinkError(f"{where} but nothing implements it")
                space[name] = self.externs[function.name]
            else:
                space[name] = self.functions[function.path]

    def replace(self, name: str, function: Callable[..., Any]) -> None:
        """Have every call of firmware function or extern `name` go to `function`."""
        for prefix in ("_f_", "_x_"):
            if prefix + name in self.namespace:
                self.namespace[prefix + name] = function

    def _spill(self, what: tuple[str, list[Variable]], fp: int | None, values: tuple[Any, ...]) -> None:
        """Leave a function's locals where they lie on the stack, and keep them for tests."""
        path, variables = what
        if self.options.residue and fp is not None:
            words = self.runtime.memory.words
            for variable, value in zip(variables, values, strict=True):
                leaves = value if variable.in_memory else [value]
                for leaf, (offset, ctype) in zip(leaves, scalars(variable.ctype), strict=True):
                    if leaf is not None:
                        for i, word in enumerate(to_words(leaf, ctype)):
                            words[fp + variable.frame_offset + offset + i] = word
        if self.options.keep_locals:
            self.last_locals[path] = {
                v.name: list(x) if isinstance(x, list) else x for v, x in zip(variables, values, strict=True)
            }


@lru_cache(maxsize=4096)
def _code(text: str, file: str, numbers: tuple[int, ...]) -> CodeType:
    """The text of a function, each line under its number in `file`.  Most images of a process share most functions."""
    tree = ast.parse(text, file)
    for node in ast.walk(tree):
        if hasattr(node, "lineno"):
            node.lineno = numbers[node.lineno - 1]
            node.end_lineno = node.lineno  # type: ignore[attr-defined]
    code: CodeType = compile(tree, file, "exec")
    return code


def _outward(value: Any) -> Any:
    """A pointer on its way to an extern: NULL is None there."""
    return None if isinstance(value, Pointer) and not value else value


def _inward(value: Any) -> Any:
    """What an extern returns as a pointer or handle."""
    return NULL if value is None else value


def to_c(value: Any, ctype: CType) -> Any:
    """A Python argument as a C value of `ctype`.  Raises ValueError where that loses something."""
    if isinstance(ctype, IntType):
        if isinstance(value, str) and len(value) == 1:
            value = ord(value)
        if not isinstance(value, int) or not ctype.low <= value <= ctype.high:
            raise ValueError(f"{value!r} is not a {ctype} ({ctype.low}..{ctype.high})")
        return int(value)
    if isinstance(ctype, PointerType | HandleType):
        return NULL if value is None else value
    return f32(float(value)) if isinstance(value, int | float) else value


def link(
    modules: Iterable[str], runtime: Runtime, options: Options, *, registers: Callable[[str, str], Any],
    externs: Mapping[str, Callable[..., Any]], replaced: Mapping[str, Callable[..., Any]] | None = None,
    overlays: Mapping[str, str] | None = None, fixes: Set[str] = frozenset(),
) -> Linked:  # fmt: skip
    """Translate and link `modules` (dotted names) with everything they import, corrections as `Program` says."""
    return Linked(
        Program(modules, overlays=overlays, fixes=fixes), runtime, options, registers=registers, externs=externs,
        replaced=replaced or {},
    )  # fmt: skip
