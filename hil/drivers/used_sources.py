"""What a program uses of what can be cut off: serial lines, the I2C, the CAN; found in its source."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any

from emulator.c28x.ctypes import PointerType
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Call,
    CopyStruct,
    Declare,
    Evaluate,
    Expr,
    Function,
    If,
    Load,
    LValue,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Switch,
    Variable,
)
from emulator.c28x.tree_queries import blocks, parts, roots, variables
from emulator.can_bus import CanPart
from emulator.peripherals.gpio import DRIVER
from emulator.pin_functions import PIN_FUNCTIONS
from emulator.register_writes import RegisterWrites
from hil.board import Board
from hil.drivers.outputs import LEVEL, PIN
from hil.drivers.roles import Roles
from hil.drivers.sources import INPUT
from hil.image import Build


def silent_sources(build: Build, roles: Roles) -> tuple[str, ...]:
    """Those that can fall silent: the serial lines that an output follows, the I2C, the CAN."""
    registers = RegisterWrites(build.modules, build.register_blocks)
    inputs = _InputsOfOutputs(roles.functions, registers).inputs()
    lines = {match[1].upper() for name in inputs if (match := re.match(r"(Sci\w)Regs", name))}
    return (*sorted(lines), *(f"the {kind.upper()}" for kind in _buses(registers)))


def buses(build: Build) -> list[str]:
    """The kinds of buses that a program uses, of which parts can be cut off: "I2c", "Can"."""
    return _buses(RegisterWrites(build.modules, build.register_blocks))


def receives_characters(build: Build) -> bool:
    """Whether a program reads characters of a serial line."""
    reads = RegisterWrites(build.modules, build.register_blocks).reads
    return any(register == "SCIRXBUF" for _, register in reads)


def _buses(registers: RegisterWrites) -> list[str]:
    used = {block[:3] for block, _ in registers.writes}
    return [kind for kind in ("I2c", "Can") if kind in used]


def cut_off(board: Board) -> None:
    """From now on no part on an I2C answers, and no node of a CAN but the chip's own."""
    for bus in board.i2c_bus.values():
        bus.connected, bus.missing = False, "nothing answers any more"
    for can in board.can_bus.values():
        for node in can.nodes:
            if isinstance(node, CanPart):
                can.detach(node)


def hold_pins(board: Board) -> None:
    """From now on no part makes an edge at a pin: shafts stand, echoes and signals that data is ready do not come."""
    for wire in board.pins:
        if wire.drivers() and not any(driver == DRIVER or driver in PIN_FUNCTIONS for driver in wire.drivers()):
            wire.held = True


class _InputsOfOutputs:
    """The objects and input registers that the values of a program's outputs mention, directly or not.

    An object is its path, a result the function's with `()`, what a pointer points to has a `*`, a register a `=`.
    """

    def __init__(self, functions: Iterable[Function], registers: RegisterWrites) -> None:
        self._mentions: dict[str, set[str]] = {}
        self._used: set[str] = set()
        #: (file, line) -> what a library reads there, and whether it drives an output.
        self._read: dict[tuple[str, int], set[str]] = {}
        for (block, register), places in registers.reads.items():
            if INPUT.match(f"{block}.{register}"):
                for place in places:
                    self._read.setdefault((place.file, place.line), set()).add(f"={block}.{register}")
        self._driven = {
            (write.place.file, write.place.line)
            for (block, register), writes in registers.writes.items()
            if LEVEL.match(f"{block}.{register}") or PIN.match(f"{block}.{register}")
            for write in writes
        }
        for function in functions:
            for s, tests in _with_tests(function.body, ()):
                self._add(function, s, tests)

    def inputs(self) -> set[str]:
        """The input registers, as `block.register`."""
        used, waiting = set(self._used), list(self._used)
        while waiting:
            for path in self._mentions.get(waiting.pop(), ()):
                if path not in used:
                    used.add(path)
                    waiting.append(path)
        return {path[1:] for path in used if path.startswith("=")}

    def _mention(self, path: str, mentioned: Iterable[str]) -> None:
        self._mentions.setdefault(path, set()).update(mentioned)

    def _add(self, function: Function, s: Stmt, tests: tuple[Expr, ...]) -> None:
        at = (s.where.file, s.line)
        read = self._read.get(at, set())
        nodes = [p for root in roots(s) for p in parts(root)]
        match s:
            case Assign(target=LValue(root=Variable() as root), value=value) | Declare(
                variable=root, value=Expr() as value
            ):  # fmt: skip
                self._mention(root.declaration.path, _mentioned(value) | read)
            case Assign(target=LValue(root=Expr() as pointer), value=value):
                for v in variables(parts(pointer)):
                    self._mention(f"*{v.declaration.path}", _mentioned(value) | read)
            case CopyStruct(target=LValue(root=Variable() as root), source=LValue(root=Variable() as source)):
                self._mention(root.declaration.path, {source.declaration.path})
            case Return(value=Expr() as value):
                self._mention(f"{function.path}()", _mentioned(value) | read)
        for call in (p for p in nodes if isinstance(p, Call)):
            for argument, parameter in zip(call.arguments, call.function.parameters, strict=False):
                self._mention(parameter.declaration.path, _mentioned(argument))
                if isinstance(parameter.ctype, PointerType):
                    for given in _pointed(argument):
                        self._mention(given, {f"*{parameter.declaration.path}", *read})
        if at in self._driven or _drives(s):
            self._used |= set().union(*(_mentioned(e) for e in (*roots(s), *tests)))


def _drives(s: Stmt) -> bool:
    match s:
        case Assign(target=RegisterRef(block=block, register=register)):
            return bool(LEVEL.match(f"{block}.{register}") or PIN.match(f"{block}.{register}"))
        case Evaluate(value=Call(function=Function(extern=True, name="GPIO_WritePin"))):
            return True
    return False


def _pointed(argument: Expr) -> Iterator[str]:
    """The objects that an argument points to; for a pointer that is passed on, `*` and its path."""
    for p in parts(argument):
        match p:
            case AddressOf(lvalue=LValue(root=Variable() as root)):
                yield root.declaration.path
            case Load(lvalue=LValue(root=Variable() as root)) if isinstance(root.ctype, PointerType):
                yield f"*{root.declaration.path}"


def _mentioned(e: Any) -> set[str]:
    """The objects, results and (behind `=`) input registers that an expression mentions."""
    found: set[str] = set()
    for p in parts(e):
        match p:
            case LValue(root=Variable() as root):
                found.add(root.declaration.path)
            case RegisterLoad(register=RegisterRef(block=block, register=register)):
                found |= {f"={block}.{register}"} if INPUT.match(f"{block}.{register}") else set()
            case Call(function=function):
                found.add(f"{function.path}()")
    return found


def _with_tests(body: Iterable[Stmt], tests: tuple[Expr, ...]) -> Iterator[tuple[Stmt, tuple[Expr, ...]]]:
    """Every statement with the tests of `if` and `switch` around it."""
    for s in body:
        yield s, tests
        match s:
            case If(test=test):
                inner: tuple[Expr, ...] = (*tests, test)
            case Switch(subject=subject):
                inner = (*tests, subject)
            case _:
                inner = tests
        for block in blocks(s):
            yield from _with_tests(block, inner)
