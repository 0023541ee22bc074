"""The role of each function of driver files: the chip or the kernel enters it, or other code calls it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, Final

from emulator.c28x import rts
from emulator.c28x.ctypes import ULONG, VOID, IntType, PointerType
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Call,
    Const,
    Convert,
    Expr,
    Function,
    FunctionRef,
    RegisterAddress,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Stmt,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import addressed, assigned_variables, parts, statements, variables, within

#: Kernel functions that need a running kernel with its objects.
KERNEL: Final = (
    "BIOS_", "Clock_", "Event_", "GateAll_", "GateHwi_", "GateMutexPri_", "GateMutex_", "GateSwi_", "GateTask_",
    "HeapBuf_", "HeapMem_", "Hwi_", "Mailbox_", "Memory_", "Queue_", "Semaphore_", "Swi_", "Task_",
)  # fmt: skip
#: Functions that access only their arguments.
_LIBRARY: Final = frozenset(vars(rts))
#: Kernel functions that can be called at any time.
_HARMLESS: Final = re.compile(r"(Hwi|Swi|Task)_(disable|enable|restore)$|Clock_getTicks$|\w+_Params_init$")
#: Kernel function that creates an object -> the role of the function passed to it, which the kernel calls.
_MAKERS: Final = {
    "Task_": "a task", "Hwi_": "an interrupt routine", "Swi_": "a Swi", "Clock_": "a clock function",
}  # fmt: skip


@dataclass
class Roles:
    """The functions of driver files by their roles, in the order of the files."""

    functions: list[Function]
    #: The function where a program begins; None: these files are no whole program.
    main: Function | None = None
    #: Bodies of tasks of SYS/BIOS.
    tasks: list[Function] = field(default_factory=list)
    #: Tasks that no statement creates; a configuration outside of these files does.
    unmade: list[Function] = field(default_factory=list)
    #: `module.name` -> why other code cannot call it.
    entries: dict[str, str] = field(default_factory=dict)
    #: `module.name` -> the kernel function that it calls, directly or not.
    kernel: dict[str, str] = field(default_factory=dict)
    #: `module.name` -> the objects that the function itself writes.
    writes: dict[str, set[Variable]] = field(default_factory=dict)
    #: `module.name` -> the registers, as (block, register), that the function itself writes.
    registers: dict[str, set[tuple[str, str]]] = field(default_factory=dict)

    #: `module.name` -> the same, without registers to which it writes only 0.
    set_up: dict[str, set[tuple[str, str]]] = field(default_factory=dict)
    #: `module.name` -> whether the function itself uses registers, or calls functions outside of the files.
    chip: dict[str, bool] = field(default_factory=dict)

    @property
    def written(self) -> set[Variable]:
        """The objects that some function writes."""
        return set().union(*self.writes.values())

    @property
    def begins_kernel(self) -> bool:
        """Whether `main` starts SYS/BIOS."""
        return self.main is not None and "BIOS_start" in _externs(self.main, {f.path: f for f in self.functions})


def roles(modules: Iterable[Module]) -> Roles:
    """The roles of the functions of `modules`."""
    modules = list(modules)
    functions = [function for module in modules for function in module.functions]
    by_path = {function.path: function for function in functions}
    found = Roles(functions)
    found.main = next((f for f in functions if f.name == "main"), None)
    made: set[str] = set()
    for expression in (part for function in functions for part in within(function.body)):
        if isinstance(expression, Call) and expression.function.extern:
            role = next((text for prefix, text in _MAKERS.items() if expression.function.name.startswith(prefix)), "")
            for argument in expression.arguments if role else ():
                for function in _named(argument):
                    found.entries[function.path] = role
                    made.add(function.path)
    for function in functions:
        found.writes[function.path] = assigned_variables(function.body) | addressed(within(function.body))
        found.chip[function.path] = any(map(_of_chip, within(function.body)))
        assigned = [
            (s.target, s.value)
            for s in statements(function.body) if isinstance(s, Assign) and isinstance(s.target, RegisterRef)
        ]  # fmt: skip
        found.registers[function.path] = {(target.block, target.register) for target, _ in assigned}
        found.set_up[function.path] = {
            (target.block, target.register)
            for target, value in assigned if not (isinstance(value, Const) and value.value == 0)
        }  # fmt: skip
        for s in statements(function.body):
            match s:
                case Assign(target=RegisterRef(block="PieVectTable"), value=value):
                    found.entries.update((f.path, "an interrupt routine") for f in _named(value))
        if function.interrupt:
            found.entries[function.path] = "an interrupt routine"
        used = sorted(name for name in _externs(function, by_path) if _needs_kernel(name))
        if used:
            found.kernel[function.path] = used[0]
            if function.path not in found.entries and _like_a_task(function):
                found.entries[function.path] = "a task"
                found.unmade.append(function)
    found.tasks = [f for f in functions if found.entries.get(f.path) == "a task"]
    if found.main is not None:
        found.entries[found.main.path] = "the program's entry point"
    return found


def _needs_kernel(name: str) -> bool:
    """Whether a kernel function needs tasks or objects of a running program."""
    return name.startswith(KERNEL) and not _HARMLESS.match(name)


def _like_a_task(function: Function) -> bool:
    """Whether it has the parameters of a task and never returns."""
    endless = any(
        isinstance(s, While) and isinstance(s.test, Const) and s.test.value for s in statements(function.body)
    )
    return function.ctype.parameters == (ULONG, ULONG) and function.ctype.result == VOID and endless


def _named(value: Any) -> Iterator[Function]:
    """The functions whose names an expression uses as values."""
    for part in parts(value):
        if isinstance(part, FunctionRef) and not part.function.extern:
            yield part.function


def called(body: Iterable[Stmt]) -> Iterator[Function]:
    """The functions that statements call or name."""
    for part in within(body):
        if isinstance(part, Call | FunctionRef):
            yield part.function


def reached(function: Function, by_path: dict[str, Function]) -> list[Function]:
    """A function, and all functions that it calls, directly or not."""
    seen = {function.path: function}
    waiting = [function]
    while waiting:
        for other in called(waiting.pop().body):
            if other.path not in seen:
                seen[other.path] = other
                if other.path in by_path:
                    waiting.append(other)
    return list(seen.values())


def _of_chip(part: Any) -> bool:
    """Whether an expression accesses the chip, by a register's name or by an address."""
    match part:
        case RegisterRef() | RegisterAt() | RegisterLoad() | RegisterAddress():
            return True
        case Convert(ctype=PointerType(), operand=Expr(ctype=IntType())):
            return True
        case Call(function=function):
            return function.extern and function.name not in _LIBRARY
    return False


def deciding(function: Function, roles: Roles, by_path: dict[str, Function]) -> set[str]:
    """Paths of the functions whose calls can change the behaviour of `function`.

    They write an object that it, or another of these functions, reads.  The chip counts as one object.
    """
    bodies = {path: reached(other, by_path) for path, other in by_path.items()}
    read = {path: {v for f in inner for v in globals_of(f)} for path, inner in bodies.items()}
    written = {path: {v for f in inner for v in roles.writes.get(f.path, ())} for path, inner in bodies.items()}
    chip = {path: any(roles.chip.get(f.path, False) for f in inner) for path, inner in bodies.items()}
    found: set[str] = set()
    state, on_chip = set(read[function.path]), chip[function.path]
    grows = True
    while grows:
        grows = False
        for path in by_path:
            if path not in found and (written[path] & state or (chip[path] and on_chip)):
                found.add(path)
                state |= read[path]
                on_chip |= chip[path]
                grows = True
    return found


def globals_of(function: Function) -> set[Variable]:
    """The objects at file scope that a function mentions."""
    return {variable for variable in variables(within(function.body)) if variable.kind == "global"}


def _externs(function: Function, by_path: dict[str, Function]) -> set[str]:
    return {other.name for other in reached(function, by_path) if other.extern}
