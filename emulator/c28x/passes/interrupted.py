"""What the loop of `main` and the interrupt routines of a whole program without a kernel share: objects, tests, masks.

The masks are read from the text: `DINT`, `..._disableInterrupt`, an enable bit, also in the callers of a function.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final, NamedTuple

from emulator.c28x.ctypes import IntType, PointerType, StructType
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    Declare,
    Expr,
    Function,
    If,
    Load,
    LValue,
    RegisterAt,
    RegisterRef,
    Stmt,
    Switch,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    bare,
    below,
    blocks,
    last_loop,
    leaves,
    own_nodes,
    parts,
    register_text,
    statements,
)

#: An object: the variable or the structure that holds it, and the offset in words.
Place = tuple[Variable | StructType, int]

#: What a function enters or leaves that keeps others off; it may also be a state.
_SECTION: Final = r"(?:crit|sect|gate|atomic|guard|lock|irq|hwi|swi|task)"
#: Names of functions that switch interrupts off, or on; and of registers that do either.
_OFF: Final = re.compile(
    rf"DINT|disable|mask|(?<![bcf])lock|{_SECTION}\w*enter|enter\w*{_SECTION}", re.IGNORECASE
)  # fmt: skip
_ON: Final = re.compile(
    rf"EINT|enable|unmask|unlock|restore|{_SECTION}\w*leave|leave\w*{_SECTION}", re.IGNORECASE
)  # fmt: skip
_ENABLES: Final = re.compile(r"IER|INTENA|FIENA|INTM|ENA\b|TIE\b")
#: Registers and functions of what gives an interrupt only when `main` or a partner has begun something.
_SERVED: Final = re.compile(r"(Sci|Spi|I2c|Can|ECap|EQep|XInt|Dma|Mcb|Usb)[a-z0-9]*(Regs|_)", re.IGNORECASE)
#: Names of functions that the application calls before it lets interrupts in.
_SETS_UP: Final = re.compile(r"init|setup|config|open|begin|start", re.IGNORECASE)
#: Lines of a comment, or between a comment and its function.
_COMMENT: Final = re.compile(r"\s*(?:#|//|/?\*|.*\*/\s*$|@|\w[\w \*]*$)")
#: What a name or a comment says of a function that only a routine, or a caller with a mask, may call.
_ASKS: Final = re.compile(
    r"interrupt|\birqs?\b|isrs?\b|(?<![a-z])isr|mask|atomic|critical|lock|\bDINT\b|nested|unsafe", re.IGNORECASE
)  # fmt: skip


def place_of(lvalue: LValue) -> Place | None:
    """The object at file scope, or the member of a structure, that an lvalue names; of an element, its array."""
    root = lvalue.root
    if isinstance(root, Variable):
        if isinstance(root.ctype, StructType):
            return root.ctype, lvalue.words
        return (root, lvalue.words) if root.kind == "global" else None
    if isinstance(root.ctype, PointerType) and isinstance(root.ctype.target, StructType):
        return root.ctype.target, lvalue.words
    return None


def scalar_of(e: Expr) -> Place | None:
    """The integer of which an expression is just the value."""
    match bare(e):
        case Load(ctype=IntType(), lvalue=LValue(indices=[]) as lvalue):
            return place_of(lvalue)
    return None


def mentions(e: Any, place: Place) -> bool:
    """Whether an expression or an lvalue has a scalar in it."""
    return any(isinstance(p, LValue) and not p.indices and place_of(p) == place for p in parts(e))


def written(s: Stmt) -> Place | None:
    """The scalar that a statement writes; None for a bit field, which shares its word with others."""
    match s:
        case Assign(target=LValue(indices=[], bits=None) as target):
            return place_of(target)
    return None


def reads(s: Stmt, place: Place) -> bool:
    """Whether a statement itself reads a scalar."""
    target = s.target if isinstance(s, Assign) else None
    return any(
        isinstance(p, LValue) and p is not target and not p.indices and place_of(p) == place for p in own_nodes(s)
    )


def test_of(s: Stmt) -> Expr | None:
    """The expression that decides which block of a statement is executed."""
    match s:
        case If(test=test) | While(test=test) | Switch(subject=test):
            return test
    return None


def switched(s: Stmt, off: bool) -> bool:
    """Whether interrupts are off behind what a statement itself does."""
    for p in own_nodes(s):
        if isinstance(p, Call):
            off = (off or _OFF.search(p.function.name) is not None) and not _ON.search(p.function.name)
    if isinstance(s, Assign) and isinstance(s.target, RegisterRef) and _ENABLES.search(register_text(s.target)):
        value = bare(s.value)
        off = constant_of(value) == 0 or (isinstance(value, Binary) and value.op == "&")
    return off


def off_at(body: list[Stmt], places: set[int]) -> bool:
    """Whether the last switch of interrupts in the text before a statement, one of some identities, is off."""
    off = False
    for s in statements(body):
        if off and id(s) in places:
            return True
        off = switched(s, off)
    return False


class OnTheWay(NamedTuple):
    """A test on the way to a statement, and whether the statement is reached when it holds."""

    test: Expr
    holds: bool


class RoutineWrite(NamedTuple):
    """A statement of an interrupt routine that writes an object, and the tests on the way to it."""

    function: Function
    statement: Assign
    conditions: tuple[OnTheWay, ...]


@dataclass
class Sides:
    """The functions of a program: those that the loop of `main` runs, and those that its routines run."""

    owners: dict[Function, StaticReport] = field(repr=False)
    own: dict[str, Function] = field(repr=False)
    #: What the loop of `main` runs: each function with its statements; `main` itself with those of the loop.
    bodies: dict[Function, list[Stmt]] = field(repr=False)
    #: Each routine: itself, and all that it calls.
    routines: list[list[Function]] = field(repr=False)
    _named: dict[Function, set[Place]] = field(default_factory=dict, repr=False)

    @cached_property
    def inside(self) -> set[str]:
        """The paths of the functions that a routine runs."""
        return {function.path for routine in self.routines for function in routine}

    @cached_property
    def routine_writes(self) -> list[RoutineWrite]:
        """What the routines write."""
        found: list[RoutineWrite] = []
        for routine in self.routines:
            self._writes(routine[0], routine[0].body, (), frozenset({routine[0].path}), found)
        return found

    @cached_property
    def main_writes(self) -> dict[Place, list[Assign]]:
        """The scalars that functions outside of the routines write, each with the statements."""
        found: dict[Place, list[Assign]] = {}
        for function in self.owners:
            for s in statements(function.body) if function.path not in self.inside else ():
                if isinstance(s, Assign) and (place := written(s)) is not None:
                    found.setdefault(place, []).append(s)
        return found

    def mask_of_caller(self, function: Function, seen: frozenset[str] = frozenset()) -> bool:
        """Whether a caller of a function, or a caller of that, has switched interrupts off."""
        if function.path in seen:
            return False
        for caller, calling in self.calls_of(function):
            masked = off_at(self.bodies[caller], calling)
            if masked or self.mask_of_caller(caller, seen | {function.path}):
                return True
        return False

    def calls_of(self, function: Function) -> Iterator[tuple[Function, set[int]]]:
        """The functions that call a function, each with the identities of the statements that do."""
        for caller, body in self.bodies.items():
            calling = {
                id(s) for s in statements(body)
                for p in own_nodes(s) if isinstance(p, Call) and p.function.path == function.path
            }  # fmt: skip
            if calling:
                yield caller, calling

    def below(self, s: Stmt) -> list[Function]:
        """The own functions that a statement itself calls, directly or not."""
        return below([p.function.path for p in own_nodes(s) if isinstance(p, Call)], self.own)

    def named(self, function: Function) -> set[Place]:
        """The objects that a function has to do with, itself or in what it calls."""
        found = self._named.get(function)
        if found is None:
            nodes = [p for f in below([function.path], self.own) for s in statements(f.body) for p in own_nodes(s)]
            found = {place for p in nodes if isinstance(p, LValue) and (place := place_of(p)) is not None}
            self._named[function] = found
        return found

    def asked(self, function: Function, e: Expr) -> set[Place]:
        """The scalars on which the value of an expression depends: itself, through its locals, in what it calls."""
        local = {p.root for p in parts(e) if isinstance(p, LValue) and isinstance(p.root, Variable)}
        values = [e]
        for s in statements(function.body):
            match s:
                case (
                    Declare(variable=copy, value=Expr() as value)
                    | Assign(target=LValue(root=Variable() as copy, indices=[]), value=value)
                ) if copy in local and copy.kind != "global":  # fmt: skip
                    values.append(value)
        nodes = [p for value in values for p in parts(value)]
        found = {place for p in nodes if isinstance(p, LValue) and (place := place_of(p)) is not None}
        called = [self.own.get(p.function.path) for p in nodes if isinstance(p, Call)]
        return found.union(*(self.named(f) for f in called if f is not None))

    def _writes(
        self, function: Function, body: list[Stmt], conditions: tuple[OnTheWay, ...], seen: frozenset[str],
        found: list[RoutineWrite],
    ) -> None:  # fmt: skip
        """Add the writes of a block of a routine, and of what it calls."""
        for s in body:
            if isinstance(s, Assign) and isinstance(s.target, LValue):
                found.append(RoutineWrite(function, s, conditions))
            for p in own_nodes(s):
                if isinstance(p, Call) and p.function.path in self.own and p.function.path not in seen:
                    callee = self.own[p.function.path]
                    self._writes(callee, callee.body, conditions, seen | {callee.path}, found)
            test = test_of(s)
            for number, block in enumerate(blocks(s)):
                inner = conditions
                if test is not None:
                    inner += (OnTheWay(test, not (isinstance(s, If) and number == 1)),)
                self._writes(function, block, inner, seen, found)
            if isinstance(s, If) and leaves(s.then) != leaves(s.otherwise):
                conditions += (OnTheWay(s.test, leaves(s.otherwise)),)


def sides_of(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> Sides | None:
    """The two sides of a whole program; None if it has no `main` with an endless loop, or no routine."""
    owners = {function: reports[module] for module in modules for function in module.functions}
    own = {function.path: function for function in owners}
    main = next((function for function in owners if function.name == "main" and function.body), None)
    loop = last_loop(main) if main is not None else None
    routines = [below([f.path], own) for f in owners if f.interrupt]
    if main is None or loop is None or not routines:
        return None
    inside = {function.path for routine in routines for function in routine}
    called = below([p.function.path for s in statements(loop.body) for p in own_nodes(s) if isinstance(p, Call)], own)
    bodies = {main: loop.body, **{function: function.body for function in called if function.path not in inside}}
    return Sides(owners, own, bodies, routines)


def driver_sides(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> Sides | None:
    """The two sides of a driver: what the application calls from its loop, and the routines; None with a `main`.

    The application calls what sets the driver up before it lets interrupts in.  And a function that asks for
    interrupts that are off, in its name or in the comment above it, has a caller that switches them off.
    """
    owners = {function: reports[module] for module in modules for function in module.functions}
    own = {function.path: function for function in owners}
    routines = [below([f.path], own) for f in owners if f.interrupt]
    if not routines or any(function.name == "main" for function in owners):
        return None
    inside = {function.path for routine in routines for function in routine}
    asking = [
        function.path
        for module in modules for lines in [module.text.splitlines()] for function in module.functions
        if _SETS_UP.search(function.name) or _sets_up(function) or _asks_for_a_mask(function, lines)
    ]  # fmt: skip
    left_out = inside | {function.path for function in below(asking, own)}
    bodies = {function: function.body for function in owners if function.path not in left_out}
    return Sides(owners, own, bodies, routines)


def _sets_up(function: Function) -> bool:
    """Whether a function sets registers up that are protected, or lets an interrupt in for the first time."""
    for s in statements(function.body):
        if any(isinstance(p, Call) and p.function.name in ("EALLOW", "__eallow") for p in own_nodes(s)):
            return True
        if isinstance(s, Assign) and isinstance(s.target, RegisterRef) and register_text(s.target).startswith("IER"):
            return True
    return False


def _asks_for_a_mask(function: Function, lines: list[str]) -> bool:
    """Whether the name of a function, or the comment above it, has to do with interrupts."""
    number = function.where.line - 2
    comment: list[str] = []
    while 0 <= number < len(lines) and _COMMENT.match(lines[number]):
        comment.append(lines[number])
        number -= 1
    return any(_ASKS.search(each) for each in [function.name, *comment])


def runs_always(sides: Sides, routine: list[Function]) -> bool:
    """Whether a routine counts a clock in each run, and serves nothing that `main` or a partner has to start."""
    clocks = {
        place for s in routine[0].body
        if (place := written(s)) is not None and isinstance(s, Assign) and place in sides.asked(routine[0], s.value)
        and all(constant_of(each.value) is not None for each in sides.main_writes.get(place, ()))
    }  # fmt: skip
    nodes = [p for function in routine for s in statements(function.body) for p in own_nodes(s)]
    served = [register_text(p) for p in nodes if isinstance(p, RegisterRef | RegisterAt)]
    served += [p.function.name for p in nodes if isinstance(p, Call)]
    return bool(clocks) and not any(_SERVED.match(name) for name in served)
