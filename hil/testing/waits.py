"""What a loop that does not end waits for, and what could have ended it: a flag, a routine and its enable bits.

`Wait` looks at the conditions on which a loop ends, and at what these are computed from.  It is `hopeless` if nothing
can change them: the loop does not, no event of the chip waits but the overflow of CPU timers, and no routine that
writes one of the objects is enabled.  Where this cannot be said for certain (a pointer, a counter of the chip, a task,
something that the test has put off), it is not.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any, Final

from emulator.c28x.link import Linked
from emulator.c28x.passes.waiting import Threads
from emulator.c28x.sites import Place
from emulator.c28x.tree import (
    Assign,
    Call,
    CallPointer,
    Const,
    CopyStruct,
    Expr,
    Function,
    If,
    LValue,
    RegisterLoad,
    RegisterRef,
    Stmt,
    Variable,
    While,
)
from emulator.c28x.tree_queries import addressed, assigned, parts, register_text, roots, statements, within
from emulator.peripherals.cpu_timer import CpuTimer
from emulator.registers.pie_vectors import PieVectTable, Vector
from hil.board import Board

#: Functions outside the firmware that change nothing a loop could wait for.
_QUIET: Final = ("DelayUs", "DELAY_US", "F28x_usDelay", "ServiceDog", "KickDog", "EALLOW", "EDIS")
#: Registers by which an interrupt routine says that it has seen its interrupt: nothing else of the chip changes.
_ANSWERS: Final = ("PIEACK", "TCR", "ETCLR", "ADCINTFLGCLR", "ADCINTOVFCLR", "ECCLR", "QCLR")
#: Registers that show what is outside the chip: they are read anew, and change with events only.
_PINS: Final = "GpioDataRegs"


class Waits:
    """The loops of an image, each looked at when it is asked for first."""

    def __init__(self, board: Board, linked: Linked) -> None:
        self.board = board
        self.replaced = linked.replaced.keys()
        self._modules = linked.program.modules.values()
        self._known: dict[Place, Wait | None] = {}

    @cached_property
    def threads(self) -> Threads:
        """Who calls and who writes what."""
        return Threads(list(self._modules), set())

    @cached_property
    def pointed_at(self) -> set[Variable]:
        """The objects whose address is taken: whoever has it may write there."""
        found = {v for function in self.threads.functions.values() for v in addressed(within(function.body))}
        values = (value for module in self._modules for v in module.variables for value in v.initial or ())
        return found | addressed(part for value in values for part in parts(value))

    def at(self, place: Place) -> Wait | None:
        """The innermost loop around a place; None if there is none."""
        if place not in self._known:
            found = self._around(place)
            self._known[place] = found and Wait(self, *found)
        return self._known[place]

    def _around(self, place: Place) -> tuple[Function, While] | None:
        for function in self.threads.functions.values():
            if function.name == place.function and function.where.file == place.file:
                loops = [s for s in statements(function.body) if isinstance(s, While)]
                exact = [loop for loop in loops if (loop.line, loop.where.column) == (place.line, place.column)]
                for loop in exact or [loop for loop in loops if _holds(loop, place)][::-1]:
                    return function, loop
        return None


class Wait:
    """A loop of a function, and what it waits for."""

    def __init__(self, waits: Waits, function: Function, loop: While) -> None:
        self.function, self.loop = function, loop
        self._board, self._replaced, self._waits = waits.board, waits.replaced, waits
        self._threads, self._functions = waits.threads, waits.threads.functions
        self._inside = [self.function, *self._below([self.loop])]
        self._body = [self.loop, *(s for function in self._inside[1:] for s in function.body)]
        #: What each variable is computed from that the loop assigns and its end depends on.
        self._sources: dict[Variable, set[Variable]] = {}
        #: An interrupt routine runs now over the loop: INTM and IER are those of the routine; of the loop it is known
        #: that interrupts are enabled.
        self.interrupted = False
        self._exits = list(self._looked_at())
        self._unclear = self._is_unclear()

    @property
    def place(self) -> Place:
        """Where the loop stands, and its condition."""
        where, function = self.loop.where, self.function
        return Place(where.file, where.line, function.name, function.c_file, where.column)

    @property
    def rule(self) -> str:
        """What such a loop breaks: one that asks nobody computes alone."""
        guard = self.loop.endless
        return "endless-loop" if guard is not None and guard.kind == "endless" else "endless-poll"

    @property
    def hopeless(self) -> bool:
        """Whether nothing is left that could end the loop."""
        if not self._exits or self._foreign() or self._board.kernel.tasks.all or self._unclear:
            return False
        registers = any(isinstance(part, RegisterRef) for part in self._exits)
        pointed_at = not self._waits.pointed_at.isdisjoint(p for p in self._exits if isinstance(p, Variable))
        answers = all(self._only_answers(routine) for _, _, routine in self._enabled())
        if (registers or pointed_at) and (self._under_way() or not answers):
            return False
        return not any(self._routine_may_write(part) for part in self._exits if isinstance(part, Variable))

    def sentences(self) -> Iterator[str]:
        """What could have ended it, a sentence each."""
        registers = {register_text(part): part for part in self._exits if isinstance(part, RegisterRef)}
        for text, register in registers.items():
            quiet = "" if self._under_way() else ", and nothing is under way on the chip that could change it"
            yield f"it waits for {text}, which is {self._value(register)}{quiet}"
        for variable in dict.fromkeys(part for part in self._exits if isinstance(part, Variable)):
            yield from self._about(variable)

    # --- the loop ----------------------------------------------------------------------------------------------------

    def _below(self, body: list[Stmt]) -> list[Function]:
        """The functions of the firmware that statements call, directly or not."""
        first = {part.function.path for part in within(body) if isinstance(part, Call)}
        paths = {path for start in first if start in self._functions for path in self._threads.below(start)}
        return [self._functions[path] for path in sorted(paths)]

    def _conditions(self) -> Iterator[Expr]:
        """What decides on the end: the test of the loop, and what stands in an `if`."""
        if not isinstance(self.loop.test, Const):
            yield self.loop.test
        for s in statements(self.loop.body):
            if isinstance(s, If):  # one with a way out, or one that decides on a value
                yield s.test

    def _looked_at(self) -> Iterator[Any]:
        """The registers and objects that the conditions, and all that these are computed from, come down to."""
        waiting: list[Any] = list(self._conditions())
        while waiting:
            for leaf in self._leaves(waiting.pop()):
                yield leaf
                if isinstance(leaf, Variable) and leaf not in self._sources:
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

    def _goes_on(self, variable: Variable) -> bool:
        """Whether the loop makes an object's next value from the one it has: such a loop gets somewhere."""
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
        """Whether the loop may change what it waits for, or it is not known what that is."""
        for part in self._exits:
            if isinstance(part, RegisterRef):
                if part.block != _PINS and not self._board.register(part.block, part.register).looked_at:
                    return True
            elif not isinstance(part, Variable) or self._goes_on(part):
                return True
        for s in statements(self._body):
            if isinstance(s, CopyStruct):
                return True
            if isinstance(s, Assign) and not (isinstance(s.target, LValue) and isinstance(s.target.root, Variable)):
                return True
        return any(isinstance(part, CallPointer) or self._goes_elsewhere(part) for part in within(self._body))

    def _goes_elsewhere(self, part: Any) -> bool:
        """Whether a part of the loop is a call of what is not the firmware's own."""
        if not isinstance(part, Call):
            return False
        known = part.function.path in self._functions or part.function.name in _QUIET
        return not known or part.function.name in self._replaced

    # --- the rest of the chip ----------------------------------------------------------------------------------------

    def _waiting(self) -> Iterator[Any]:
        """The callbacks of events that wait, but for those that end calls."""
        for callback in self._board.clock.waiting():
            function = getattr(callback, "func", callback)
            if getattr(function, "__module__", "") != "hil.testing.guard":
                yield function

    def _foreign(self) -> bool:
        """Whether something waits that does not belong to the chip: it may do anything."""
        return any(not str(getattr(c, "__module__", "")).startswith("emulator.") for c in self._waiting())

    def _under_way(self) -> bool:
        """Whether an event waits that is more than the overflow of a CPU timer."""
        return any(not isinstance(getattr(c, "__self__", None), CpuTimer) for c in self._waiting())

    def _vectors(self) -> Iterator[tuple[str, int, str]]:
        """The routines of the vector table: the entry's name and number, and the function."""
        for name, entry in PieVectTable.layout.items():
            if isinstance(entry, Vector):
                routine = self._board.register("PieVectTable", name).read()
                if routine:
                    yield name, entry.id, getattr(routine, "__qualname__", "")

    def _enabled(self) -> Iterator[tuple[str, int, str]]:
        for entry in self._vectors():
            if not self._closed(entry[1]):
                yield entry

    def _closed(self, number: int) -> str:
        """Which bit keeps an interrupt from being taken; empty if none does."""
        board = self._board
        if number < 0x20:
            line = number
        else:
            group, n = divmod(number - (0x20 if number < 0x80 else 0x80), 8)
            line, n = group + 1, n + (1 if number < 0x80 else 9)
            if not board.register("PieCtrlRegs", "PIECTRL").value & 1:
                return "PieCtrlRegs.PIECTRL.bit.ENPIE is 0"
            if not board.register("PieCtrlRegs", f"PIEIER{line}").value >> n - 1 & 1:
                return f"PieCtrlRegs.PIEIER{line}.bit.INTx{n} is 0"
        if self.interrupted:
            return ""
        if not board.cpu.ier >> line - 1 & 1:
            return f"IER has no M_INT{line}"
        return "INTM is set: no interrupt is taken before EINT" if board.cpu.intm else ""

    def _only_answers(self, routine: str) -> bool:
        """Whether a routine writes objects by their names alone, and no register but to say that it ran."""
        if routine not in self._functions:
            return False
        below = self._threads.below(routine) & self._functions.keys()
        body = [s for path in below for s in self._functions[path].body]
        for s in statements(body):
            if isinstance(s, CopyStruct):
                return False
            if isinstance(s, Assign) and not (
                s.target.register in _ANSWERS
                if isinstance(s.target, RegisterRef)
                else isinstance(s.target, LValue) and isinstance(s.target.root, Variable)
            ):
                return False
        return not any(isinstance(part, CallPointer) or self._goes_elsewhere(part) for part in within(body))

    def _routine_may_write(self, variable: Variable) -> bool:
        """Whether an enabled routine may change an object."""
        if variable.kind != "global":
            return False
        writers = self._threads.writers.get(variable, {}).keys()
        routines = (path for _, _, path in self._enabled() if path in self._functions)
        return any(self._threads.below(path) & writers for path in routines)

    # --- in words ----------------------------------------------------------------------------------------------------

    def _about(self, variable: Variable) -> Iterator[str]:
        if variable.kind != "global" or variable in self._sources:
            return
        name = variable.declaration.path
        inside = {function.path for function in self._inside}
        writers = [path for path in self._threads.writers.get(variable, {}) if path not in inside]
        if not writers:
            yield f"it waits for {name}, which nothing in the firmware writes"
        for path in writers:
            yield f"it waits for {name}, which {path} writes: {self._when(path)}"

    def _when(self, path: str) -> str:
        """When a function would run, and why it does not."""
        for name, number, routine in self._vectors():
            if routine in self._functions and path in self._threads.below(routine):
                called = "" if routine == path else f", called by {routine}"
                closed = self._closed(number) or "which is enabled, and has brought no end"
                return f"the routine of {name}{called}; {closed}"
        return "no entry of PieVectTable leads to it"

    def _value(self, register: RegisterRef) -> str:
        cell, field = self._board.register(register.block, register.register), register.field
        word = cell.read() if register.block == _PINS else cell.value
        return f"{word:#x}" if field is None else f"{(word & field.mask) >> field.lo}"


def _holds(loop: While, place: Place) -> bool:
    last = max((s.where[1:3] for s in statements([loop])), default=loop.where[1:3])
    return loop.where[1:3] <= (place.line, place.column or 1 << 16) and place.line <= last[0]
