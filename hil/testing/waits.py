"""Finds what an endless polling loop waits for, and what could end it: a flag, an interrupt routine, its enable bits.

`PollingLoop` examines the conditions that end a loop, and the objects from which they are computed.  A loop is
`hopeless` if nothing can change them: neither the loop, nor a routine that may run, nor an event of the chip
(`reach.py`).  If this is not certain (because of a pointer, a counter of the chip, a task, or an event that the test
has scheduled), the loop is not hopeless.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, Final

from emulator.c28x.link import Linked
from emulator.c28x.sites import Place
from emulator.c28x.tree import (
    Assign,
    Call,
    CallPointer,
    Const,
    CopyStruct,
    Evaluate,
    Expr,
    For,
    Function,
    If,
    LValue,
    RegisterLoad,
    RegisterRef,
    Stmt,
    Switch,
    Variable,
    While,
)
from emulator.c28x.tree_queries import assigned, blocks, parts, register_text, roots, statements, within
from hil.board import Board
from hil.testing.reach import DELAYS, Reach

#: The registers that show the levels of pins.  They are read again, and change only with events.
_PINS: Final = "GpioDataRegs"
#: The longest time of an expression of a turn, in cycles.  A turn that may take longer than `_LONG` is not examined.
_EXPRESSION_CYCLES: Final = 100
_LONG: Final = 100_000


class PollingLoops:
    """The loops of an image.  Each is examined at its first use."""

    def __init__(self, board: Board, linked: Linked) -> None:
        self.board = board
        self.reach = Reach(board, list(linked.program.modules.values()), linked.replaced.keys())
        self._known: dict[Place, PollingLoop | None] = {}

    def at(self, place: Place) -> PollingLoop | None:
        """The innermost loop around a place; None if there is none."""
        if place not in self._known:
            found = self._around(place)
            self._known[place] = found and PollingLoop(self, *found)
        return self._known[place]

    def _around(self, place: Place) -> tuple[Function, While] | None:
        for function in self.reach.threads.functions.values():
            if function.name == place.function and function.where.file == place.file:
                loops = [s for s in statements(function.body) if isinstance(s, While)]
                exact = [loop for loop in loops if (loop.line, loop.where.column) == (place.line, place.column)]
                for loop in exact or [loop for loop in loops if _holds(loop, place)][::-1]:
                    return function, loop
        return None


class PollingLoop:
    """A loop of a function, and the conditions for which it waits."""

    def __init__(self, waits: PollingLoops, function: Function, loop: While) -> None:
        self.function, self.loop = function, loop
        self._board, self._reach = waits.board, waits.reach
        self._threads, self._functions = self._reach.threads, self._reach.threads.functions
        self._inside = [self.function, *self._below([self.loop])]
        self._body = [self.loop, *(s for function in self._inside[1:] for s in function.body)]
        #: For each variable that the loop assigns and its end depends on: the variables from which it is computed.
        self._sources: dict[Variable, set[Variable]] = {}
        #: The interrupt routines that have interrupted the loop and run now, and the functions that they have called.
        #: None: no routine runs.
        self.running: tuple[str, ...] | None = None
        #: The longest time of a turn without delays and interrupts.  A turn with inner loops may take longer.
        self.turn_cycles = _turn_cycles([*loop.body, *loop.step], self._functions) + _turn_cycles(
            [Evaluate(loop.where, loop.test)], self._functions
        )
        self.delays = any(isinstance(part, Call) and part.function.name in DELAYS for part in within(self._body))
        self._exits = list(self._dependencies())
        self._unclear = self._is_unclear()

    @property
    def place(self) -> Place:
        """The place of the loop, and its condition."""
        where, function = self.loop.where, self.function
        return Place(where.file, where.line, function.name, function.c_file, where.column)

    @property
    def rule(self) -> str:
        """The rule of the finding: `endless-loop` if the loop polls nothing, else `endless-poll`."""
        guard = self.loop.endless
        return "endless-loop" if guard is not None and guard.kind == "endless" else "endless-poll"

    @property
    def hopeless(self) -> bool:
        """Whether nothing can end the loop any more."""
        if not self._exits or self._unclear or self._reach.has_foreign_event():
            return False
        routines = self._reach.routines(self.running)
        if routines is None:
            return False
        return not any(
            self._reach.may_change(routines, part)
            if isinstance(part, RegisterRef)
            else self._reach.may_write(routines, part)
            for part in self._exits
        )

    def sentences(self) -> Iterator[str]:
        """Sentences about what could have ended the loop."""
        registers = {register_text(part): part for part in self._exits if isinstance(part, RegisterRef)}
        for text, register in registers.items():
            event_may_change = self._reach.event_may_change(register.block)
            quiet = "" if event_may_change else ", and nothing is under way on the chip that could change it"
            yield f"it waits for {text}, which is {self._value(register)}{quiet}"
        for variable in dict.fromkeys(part for part in self._exits if isinstance(part, Variable)):
            yield from self._about(variable)

    # --- the loop ----------------------------------------------------------------------------------------------------

    def _below(self, body: list[Stmt]) -> list[Function]:
        """The functions of the firmware that statements call, directly or not."""
        first = {part.function.path for part in within(body) if isinstance(part, Call)}
        paths = {path for start in first if start in self._functions for path in self._threads.below(start)}
        return [self._functions[path] for path in sorted(paths & self._functions.keys())]  # not `DINT` and the like

    def _conditions(self) -> Iterator[Expr | LValue]:
        """The conditions that decide whether the loop ends: its test, and those of exits and assignments in it."""
        if not isinstance(self.loop.test, Const):
            yield self.loop.test
        yield from _decisions(self.loop.body)
        yield from _decisions(self.loop.step)

    def _dependencies(self) -> Iterator[Any]:
        """The registers and objects on which the conditions depend, directly or through other objects."""
        waiting: list[Any] = list(self._conditions())
        called = [s for function in self._inside[1:] for s in statements(function.body)]
        through: set[Variable | None] = {assigned(s) for s in called}
        while waiting:
            for leaf in self._leaves(waiting.pop()):
                yield leaf
                if isinstance(leaf, Variable) and leaf not in self._sources:
                    if leaf in through:  # which of them it is given may depend on any condition there
                        waiting += _decisions(called)
                        through.clear()
                    values = [e for s in statements(self._body) if assigned(s) is leaf for e in roots(s)]
                    values = [e for e in values if not (isinstance(e, LValue) and e.root is leaf)]
                    if values:
                        below = [inner for value in values for inner in self._leaves(value)]
                        self._sources[leaf] = {inner for inner in below if isinstance(inner, Variable)}
                        waiting += values

    def _leaves(self, e: Any) -> Iterator[Any]:
        """The registers and objects of an expression, also of the functions that it calls."""
        nodes = parts(e)
        called = {part.function.path for part in nodes if isinstance(part, Call)} & self._functions.keys()
        for path in sorted({below for first in called for below in self._threads.below(first)}):
            if path in self._functions:
                nodes += within(self._functions[path].body)
        for part in nodes:
            if isinstance(part, RegisterLoad):
                yield part.register
            elif isinstance(part, LValue):
                yield part.root
            elif isinstance(part, CallPointer):
                yield part

    def _makes_progress(self, variable: Variable) -> bool:
        """Whether the loop computes an object's next value from its present value.  Such a loop makes progress."""
        if variable.kind != "global" and variable not in {*self.function.locals, *self.function.parameters}:
            return False  # a called function begins anew each time
        reached: set[Variable] = set()
        waiting = [variable]
        while waiting:
            new = self._sources.get(waiting.pop(), set()) - reached
            reached |= new
            waiting += new
        return variable in reached

    def _is_unclear(self) -> bool:
        """Whether the loop may change its own conditions, or whether this is not known."""
        for part in self._exits:
            if isinstance(part, RegisterRef):
                if part.block != _PINS and not self._board.register(part.block, part.register).looked_at:
                    return True
            elif not isinstance(part, Variable) or self._makes_progress(part):
                return True
        if self.turn_cycles > _LONG:
            return True
        for s in statements(self._body):
            if isinstance(s, CopyStruct):
                return True
            if isinstance(s, Assign) and not (isinstance(s.target, LValue) and isinstance(s.target.root, Variable)):
                return True
        return any(isinstance(part, CallPointer) or self._reach.calls_outside(part) for part in within(self._body))

    # --- in words ----------------------------------------------------------------------------------------------------

    def _about(self, variable: Variable) -> Iterator[str]:
        if variable.kind != "global" or variable in self._sources:
            return
        name = variable.declaration.path
        inside = {function.path for function in self._inside}
        writers = [path for path in self._threads.writing(variable) if path not in inside]
        if not writers:
            yield f"it waits for {name}, which nothing in the firmware writes"
        for path in writers:
            yield f"it waits for {name}, which {path} writes: {self._when(path)}"

    def _when(self, path: str) -> str:
        """When a function would run, and what prevents it from running."""
        for name, number, routine in self._reach.vectors():
            if routine in self._functions and path in self._threads.below(routine):
                called = "" if routine == path else f", called by {routine}"
                closed = self._reach.closed(number, running=self.running)
                return f"the routine of {name}{called}; {closed or 'which is enabled, but has not ended the loop'}"
        return "no entry of PieVectTable leads to it"

    def _value(self, register: RegisterRef) -> str:
        cell, field = self._board.register(register.block, register.register), register.field
        word = cell.read() if register.block == _PINS else cell.value
        return f"{word:#x}" if field is None else f"{(word & field.mask) >> field.lo}"


def _decisions(body: Iterable[Stmt]) -> Iterator[Expr | LValue]:
    """The conditions of statements."""
    for s in statements(body):
        match s:
            case If(test=test) | While(test=test) | Switch(subject=test):
                yield test
            case For(start=start, stop=stop):
                yield from (start, stop)


def _turn_cycles(body: list[Stmt], functions: dict[str, Function], above: tuple[str, ...] = ()) -> int:
    """The most cycles of one pass through statements, without delays.  More than `_LONG` means that it is not known."""
    cycles = 0
    for s in body:
        for part in (part for root in roots(s) for part in parts(root)):
            cycles += _EXPRESSION_CYCLES
            if isinstance(part, Call) and part.function.path in functions:
                path = part.function.path
                known = path not in above
                cycles += _turn_cycles(functions[path].body, functions, (*above, path)) if known else _LONG
        inner = sum(_turn_cycles(block, functions, above) for block in blocks(s))
        if isinstance(s, While) or (isinstance(s, For) and s.trips is None):
            cycles += _LONG
        cycles += inner * len(s.trips) if isinstance(s, For) and s.trips is not None else inner
        if cycles > _LONG:
            break
    return cycles


def _holds(loop: While, place: Place) -> bool:
    last = max((s.where[1:3] for s in statements([loop])), default=loop.where[1:3])
    return loop.where[1:3] <= (place.line, place.column or 1 << 16) and place.line <= last[0]
