"""What a loop waits for: the chip itself, or something that only the outside, an interrupt or another function does."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Final

from emulator.c28x.findings import Finding
from emulator.c28x.sites import Place
from emulator.c28x.tree import (
    Assign,
    Break,
    Call,
    CallPointer,
    Compare,
    Const,
    CopyStruct,
    Function,
    FunctionRef,
    Jump,
    LValue,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Variable,
    While,
)
from emulator.c28x.tree_queries import (
    addressed,
    assigned_variables,
    last_loop,
    parts,
    polls,
    statements,
    within,
    without_end,
)
from hil.drivers.roles import Roles, called, reached

#: Rules about loops without an end.
WAITING: Final = ("endless-poll", "endless-loop")
#: Registers, as `block.register`, that data from outside of the chip changes.
_OUTSIDE: Final = re.compile(
    r"(?i)^(gpio\w*\.gp\w*dat|sci\w*\.(scirx\w*|sciffrx)|eqep\w*\.|ecap\w*\.|can\w*\.|i2c\w*\.|mcbsp\w*\.|xint\w*\.|"
    r"adc\w*\.adcevt\w*|epwm\w*\.tz\w*)"
)
#: Fields of I2CSTR that a missing acknowledge sets.
_OF_REFUSAL: Final = ("NACK", "ARDY")
#: Registers and fields of a CAN that a frame changes only when it is acknowledged.
_OF_SENT: Final = re.compile(r"CAN_TXRQ\w*|CAN_ES\.TxOk|CAN_IF\dMCTL\.TxRqst")


@dataclass(frozen=True, slots=True)
class EndedParties:
    """The parties that can end no wait any more, in a run that is over, and those outside that can."""

    #: Names of interrupt routines that never run again.
    silent: Collection[str] = ()
    #: Register blocks of I2C modules whose part did not acknowledge, which wait for the program, and of CAN controllers
    #: whose frames nobody acknowledges.
    refused: Collection[str] = ()
    #: Register blocks of SPI modules that are slaves, which wait for a master outside of the chip.
    slaves: Collection[str] = ()


NONE_ENDED: Final = EndedParties()


def waits_for_others(finding: Finding, roles: Roles, ended: EndedParties = NONE_ENDED) -> bool:
    """Whether a finding is about an endless loop that something outside of its function can end.

    A loop that is written without an end, as `for (;;)`, in a function that never returns is endless on purpose.
    """
    if finding.rule not in WAITING or finding.place is None:
        return False
    if is_intended(finding, roles):
        return True
    return loop_waits(finding.place, roles, main=finding.task == "main", ended=ended)


def is_intended(finding: Finding, roles: Roles) -> bool:
    """Whether a finding is about an endless loop that is written without an end."""
    place = finding.place
    if finding.rule not in WAITING or place is None:
        return False
    loops = [loop for function in roles.functions for loop in _loops_at(function, place)]
    return any(without_end(loop) for loop in loops)


def loop_waits(place: Place, roles: Roles, *, main: bool = False, ended: EndedParties = NONE_ENDED) -> bool:
    """Whether a place lies in a loop that something outside of its function can end.

    While `main` waits, only functions run that the chip or the kernel enters.
    """
    by_path = {function.path: function for function in roles.functions}
    meanwhile = set(_entered(roles, by_path, ended.silent)) if main else set(roles.functions)
    for function in roles.functions:
        for loop in _loops_at(function, place):
            looked_at = list(_read_by_loop(loop, by_path))
            if any(_outside(node, ended.refused, ended.slaves) for node in looked_at):
                return True
            variables = {v for v in looked_at if isinstance(v, Variable) and v.kind == "global"}
            if any(variables & roles.writes[other.path] for other in meanwhile if main or other is not function):
                return True
            if main and any(variables & addressed(within(other.body)) for other in roles.functions):
                return True
    return False


def retries(frames: Sequence[Place], functions: Iterable[Function]) -> set[tuple[str, int]]:
    """The loops around `frames` that repeat something without limit until it succeeds: file, and line of the loop."""
    functions = list(functions)
    return {
        (place.file, loop.line)
        for place in frames for function in functions for loop in _loops_at(function, place)
        if not isinstance(loop.test, Const) and not polls(loop)
        and not any(isinstance(part, Compare) and part.op not in ("==", "!=") for part in parts(loop.test))
        and not any(isinstance(s, Break | Return | Jump) for s in statements(loop.body))
    }  # fmt: skip


def retried(loops: Collection[tuple[str, int]], block: str, roles: Roles) -> tuple[Function, While] | None:
    """A loop of `loops` (from `retries`) that uses a register block, and its function; None if there is none."""
    by_path = {function.path: function for function in roles.functions}
    for function in roles.functions:
        for loop in statements(function.body):
            if isinstance(loop, While) and (loop.where.file, loop.line) in loops:
                nodes = list(within([loop]))
                for other in {f.path: f for first in called([loop]) for f in reached(first, by_path)}.values():
                    nodes += within(other.body)
                if any(isinstance(node, RegisterRef) and node.block == block for node in _registers(nodes)):
                    return function, loop
    return None


def loop_without_end(frames: Sequence[Place], roles: Roles, ended: EndedParties) -> tuple[Place, str] | None:
    """A loop of `main` that only interrupt routines could end, while none of them runs any more.

    Returns where the loop begins, and an object that it tests; None if `main` is in no such loop.
    """
    by_path = {function.path: function for function in roles.functions}
    for place in frames if ended.silent else ():
        for loop in (loop for function in roles.functions for loop in _loops_at(function, place)):
            tested = parts(loop.test)
            objects = [part.root for part in tested if isinstance(part, LValue) and isinstance(part.root, Variable)]
            if not objects or any(isinstance(part, RegisterLoad | Call | CallPointer) for part in tested):
                continue
            start = place._replace(line=loop.line, column=loop.where.column)
            own = _written_within(loop, roles, by_path)
            if own is None or own & set(objects) or any(variable.kind != "global" for variable in objects):
                continue
            if not loop_waits(start, roles, main=True, ended=ended):
                return start, objects[0].name
    return None


def _written_within(loop: While, roles: Roles, by_path: dict[str, Function]) -> set[Variable] | None:
    """The objects that a loop and the functions that it calls write; None if it can be left, or this is not known."""
    if any(isinstance(s, Break | Return | Jump) for s in statements(loop.body)):
        return None
    functions = {other.path: other for first in called([loop]) for other in reached(first, by_path)}
    bodies: list[list[Stmt]] = [[loop], *(f.body for f in functions.values())]
    for body in bodies:
        if any(isinstance(part, CallPointer) for part in within(body)):
            return None
        for s in statements(body):
            target = s.target if isinstance(s, Assign | CopyStruct) else None
            if isinstance(target, LValue) and not isinstance(target.root, Variable):
                return None
    written = assigned_variables([loop])
    return written.union(*(roles.writes.get(path, set()) for path in functions))


def waits_for_tasks(finding: Finding, roles: Roles) -> bool:
    """Whether a Swi or an interrupt routine polls objects that only tasks change.  These wait for its end."""
    place = finding.place
    if place is None or not finding.task.startswith(("Swi:", "Hwi:", "Isr:", "Clock:")):
        return False
    by_path = {function.path: function for function in roles.functions}
    tasks = {function.path for function in (*roles.tasks, roles.main) if function is not None}
    entered = [by_path[path] for path in roles.entries if path in by_path and path not in tasks]
    others = [f for entry in entered for f in reached(entry, by_path)]
    for function in roles.functions:
        for loop in _loops_at(function, place):
            if not polls(loop):
                continue
            looked_at = list(_read_by_loop(loop, by_path))
            variables = {v for v in looked_at if isinstance(v, Variable) and v.kind == "global"}
            outside = any(isinstance(node, RegisterRef | RegisterAt) for node in looked_at)
            by_others = any(
                variables & roles.writes[f.path] for f in others if f.path in roles.writes and f is not function
            )
            if variables and not outside and not by_others:
                return True
    return False


def in_last_loop(frames: Sequence[Place], main: Function) -> bool:
    """Whether `main`, the last of `frames`, is in its last loop."""
    loop = last_loop(main)
    if loop is None or not frames or frames[-1].function != main.name or frames[-1].file != main.where.file:
        return False
    return loop.line <= frames[-1].line <= _last_line(loop)


def _entered(roles: Roles, by_path: dict[str, Function], silent: Collection[str]) -> Iterable[Function]:
    """Functions that run without a call by `main`: entries, functions whose address is taken, and those they call."""
    taken = {node.function.path for f in roles.functions for node in within(f.body) if isinstance(node, FunctionRef)}
    for path in taken | set(roles.entries):
        if path in by_path and by_path[path] is not roles.main and by_path[path].name not in silent:
            yield from (function for function in reached(by_path[path], by_path) if function.path in by_path)


def blocks_of_loop(place: Place, functions: Iterable[Function]) -> set[str]:
    """The register blocks that the test of the loop at `place` reads; without such a loop, those of all loops."""
    functions = list(functions)
    loops = [loop for function in functions for loop in _loops_at(function, place)]
    loops = loops or [s for function in functions for s in statements(function.body) if isinstance(s, While)]
    registers = (register for loop in loops for register in _registers(parts(loop.test)))
    return {register.block for register in registers if isinstance(register, RegisterRef)}


def reads_outside(function: Function, by_path: dict[str, Function]) -> bool:
    """Whether a function, or one that it calls, reads data from outside of the chip."""
    return any(_outside(node) for other in reached(function, by_path) for node in _registers(within(other.body)))


def _outside(node: Any, refused: Collection[str] = (), slaves: Collection[str] = ()) -> bool:
    if isinstance(node, RegisterRef) and node.block in slaves:
        return True
    if not isinstance(node, RegisterRef | RegisterAt) or _OUTSIDE.match(_name(node)) is None:
        return False
    if not isinstance(node, RegisterRef) or node.block not in refused:
        return True
    field = node.field.name if node.field is not None else ""
    if node.block.startswith("Can"):
        return not _OF_SENT.fullmatch(f"{node.register}.{field}" if field else node.register)
    return not field or field in _OF_REFUSAL


def _loops_at(function: Function, place: Place) -> list[While]:
    """The loops of a function that begin at a place, or else those that contain it."""
    if function.name != place.function:
        return []
    loops = [s for s in statements(function.body) if isinstance(s, While) and s.where.file == place.file]
    exact = [loop for loop in loops if loop.line == place.line]
    return exact or [loop for loop in loops if loop.line <= place.line <= _last_line(loop)]


def _last_line(loop: While) -> int:
    return max((s.line for s in statements([loop])), default=loop.line)


def _read_by_loop(loop: Stmt, by_path: dict[str, Function]) -> Iterable[Any]:
    """The registers and variables that a loop reads, also those in functions that it calls."""
    below = list(within([loop]))
    functions = {other.path: other for first in called([loop]) for other in reached(first, by_path)}
    for function in functions.values():
        below += within(function.body)
    yield from _registers(below)
    for part in below:
        if isinstance(part, LValue) and isinstance(part.root, Variable):
            yield part.root


def _registers(nodes: Iterable[Any]) -> Iterable[RegisterRef | RegisterAt]:
    for node in nodes:
        if isinstance(node, RegisterLoad):
            yield node.register


def _name(register: RegisterRef | RegisterAt) -> str:
    if isinstance(register, RegisterRef):
        return f"{register.block}.{register.register}"
    target = getattr(register.block.ctype, "target", register.block.ctype)
    return f"{target}.{register.name}".removeprefix("struct ").replace("_REGS", "")
