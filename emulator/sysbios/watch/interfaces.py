"""Message interfaces of a CAN that `main` and an interrupt routine use: `transaction-cut`, without the kernel.

A message takes several writes to an interface (IF1 or IF2): its identifier, its data, and the command that moves them.
If a routine uses the same interface between two of them, `main` sends what the routine has left there.  The source
shows which routines and functions use an interface, and whether a test keeps them apart; the run shows whether the
routine is held off.

A library reaches the registers by numbers (TI's driverlib).  Then the run shows which routines use an interface, and
the source of the user's functions, down to the call of the library, shows whether a test keeps them apart.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from functools import cached_property, partial
from typing import Any, Final, NamedTuple, Protocol

from emulator.c28x.ctypes import IntType
from emulator.c28x.findings import Findings
from emulator.c28x.symbols import Module, library_headers
from emulator.c28x.tree import Assign, Call, Expr, Function, LValue, RegisterLoad, RegisterRef, Stmt
from emulator.c28x.tree_queries import assigned, bare, below, own_nodes, statements, variables, within
from emulator.sysbios.watch.kept_off import Word, ring_indices
from emulator.sysbios.watch.statements import StatementLocator
from emulator.sysbios.watch.threads import Routine, ThreadWatch, excluded
from emulator.sysbios.watch.ways import Ways, interrupt_routines, reached_freely

#: The registers of an interface that a message is written to.
WRITTEN: Final = ("MSK", "ARB", "MCTL", "DATA", "DATB", "CMD")
#: File, line and column of a statement.
_At = tuple[str, int, int]
#: CAN_CTL.Init: the module takes no part in the bus.
INIT: Final = 1 << 0


class CanBlock(Protocol):
    """The registers of a CAN module (`emulator.registers.core.Block`)."""

    name: str
    registers: dict[str, Any]


class SharedInterface(NamedTuple):
    """An interface that a routine uses, and a line of `main` that uses it whatever this routine has done."""

    interface: str
    routine: str
    line: tuple[str, int]


class Interfaces:
    """Watches the interfaces of all CAN modules."""

    def __init__(
        self, threads: ThreadWatch, locator: StatementLocator, findings: Findings, modules: Collection[Module]
    ) -> None:  # fmt: skip
        self._threads, self._locator, self._findings, self._modules = threads, locator, findings, modules
        self._told: set[tuple[str, str]] = set()
        #: Interface -> the routines that have written to it.
        self._used: dict[str, set[str]] = {}
        #: Routine -> the places of the user's functions that are reached whatever it has done; of all functions, where
        #: registers are named.
        self._free: dict[str, set[_At]] = {}
        self._reached: dict[str, set[_At]] = {}

    def watch(self, regs: CanBlock) -> None:
        """Watch the two interfaces of a module."""
        for n in (1, 2):
            for part in WRITTEN:
                regs.registers[f"CAN_IF{n}{part}"].tap(partial(self._written, regs, f"{regs.name}.CAN_IF{n}"))

    def _written(self, regs: CanBlock, interface: str, *_access: object) -> None:
        threads = self._threads
        current = threads.current.what
        if isinstance(current, Routine):
            self._used.setdefault(interface, set()).add(current.name)
        if threads.current is not threads.main or not threads.routines or threads.kernel.active:
            return
        if regs.registers["CAN_CTL"].value & INIT or not regs.registers["CAN_GLB_INT_EN"].value:
            return
        place = self._locator.place(self._locator.here())
        assert place is not None
        for routine in threads.all:
            what = routine.what
            if not isinstance(what, Routine) or (interface, what.name) in self._told:
                continue
            by_name = SharedInterface(interface, what.name, place[:2]) in self._shared and self._comes_freely(what.name)
            if not by_name and not (what.name in self._used.get(interface, ()) and self._freely(what.name)):
                continue
            if not excluded(threads.main, threads.protection(), routine, routine.protection):
                self._told.add((interface, what.name))
                message = (
                    f"{interface} is used by main and by {routine}, and the interrupt is not masked: it can exchange "
                    "the registers between two writes of main"
                )
                self._findings.report("transaction-cut", message, object=interface)

    def _comes_freely(self, routine: str) -> bool:
        """Whether `main` has come here, by each of its calls, whatever a routine has done."""
        frames = {(place.file, place.line, place.column) for place in self._locator.frames()}
        return self._reached[routine].issuperset(frames)

    def _freely(self, routine: str) -> bool:
        """Whether `main` is in a function of a library, and is there whatever a routine has done."""
        frames = self._locator.frames()
        own = [(place.file, place.line, place.column) for place in frames if place.file not in self._libraries]
        if len(own) == len(frames):
            return False  # the names of the registers say it
        if routine not in self._free:
            self._free[routine] = self._undecided(routine)
        return self._free[routine].issuperset(own)

    @cached_property
    def _libraries(self) -> frozenset[str]:
        """The files of libraries: those that others brought, and their headers."""
        return library_headers(self._modules) | {module.file for module in self._modules if module.brought}

    def _undecided(self, name: str) -> set[_At]:
        """The statements and calls of the user's functions that run whatever a routine has done."""
        own = {function.path: function for module in self._modules for function in module.functions}
        routines = list(interrupt_routines(own))
        inside = {function.path for _, reached in routines for function in reached}
        mine = {f.path: f for f in own.values() if f.where.file not in self._libraries}
        others = [function for path, function in mine.items() if path not in inside]
        telling = {path for routine, reached in routines if routine.name == name for path in self._set(reached)}

        def told(part: Call | RegisterLoad) -> bool:
            return _tells(part, own, telling) or _by_number(part, own)

        return _places(reached_freely(others, telling, told))

    @cached_property
    def _shared(self) -> set[SharedInterface]:
        own = {function.path: function for module in self._modules for function in module.functions}
        routines = list(interrupt_routines(own))
        inside = {function.path for _, reached in routines for function in reached}
        others = [function for function in own.values() if function.path not in inside]
        found: set[SharedInterface] = set()
        for routine, reached in routines:
            theirs = (statement for function in reached for statement in statements(function.body))
            used = {interface for statement in theirs for interface in _interface(statement)}
            if not used:
                continue
            telling = set(self._set(reached))

            def told(part: Call | RegisterLoad, telling: set[str] = telling) -> bool:
                return _tells(part, own, telling)

            ways = reached_freely(others, telling, told)
            self._reached[routine.name] = _places(ways)
            for way in ways:
                for statement in way.undecided:
                    for interface in used.intersection(_interface(statement)):
                        found.add(SharedInterface(interface, routine.name, (way.function.where.file, statement.line)))
        return found

    def _set(self, functions: Iterable[Function]) -> Iterator[str]:
        """The shared objects that functions set, and that may hold them off.

        The index of a queue does not: it only says that there is something, and more can come.
        """
        for path in _set(functions):
            if (path, 0) not in self._indices:
                yield path

    @cached_property
    def _indices(self) -> dict[Word, bool]:
        return ring_indices(self._modules)


def _places(ways: Iterable[Ways]) -> set[_At]:
    """Where statements of this kind, and the calls in them, stand."""
    free = [statement for way in ways for statement in way.undecided]
    calls = [part for s in free for part in own_nodes(s) if isinstance(part, Call)]
    places = [statement.where for statement in free] + [call.where for call in calls]
    return {(at.file, at.line, at.column) for at in places}


def _interface(statement: Stmt) -> Iterator[str]:
    """The interface that a statement writes."""
    match statement:
        case Assign(target=RegisterRef(block=block, register=register)) if register.startswith(("CAN_IF1", "CAN_IF2")):
            yield f"{block}.{register[:7]}"


def _by_number(part: Call | RegisterLoad, own: dict[str, Function]) -> bool:
    """Whether a call reads something at an address that is computed: it may be a register."""
    return isinstance(part, Call) and any(
        isinstance(inner, LValue) and isinstance(inner.root, Expr) and isinstance(bare(inner.root).ctype, IntType)
        for function in below([part.function.path], own) for inner in within(function.body)
    )  # fmt: skip


def _set(functions: Iterable[Function]) -> Iterator[str]:
    """The shared objects that functions set."""
    for function in functions:
        for statement in statements(function.body):
            root = assigned(statement)
            if root is not None and root.kind == "global":
                yield root.declaration.path


def _tells(part: Call | RegisterLoad, own: dict[str, Function], telling: set[str]) -> bool:
    """Whether a register or the result of a call may depend on what a routine has done.  Busy of an interface does not.
    """
    if isinstance(part, RegisterLoad):
        register = part.register
        return not (isinstance(register, RegisterRef) and register.register in ("CAN_IF1CMD", "CAN_IF2CMD"))
    for function in below([part.function.path], own):
        for inner in within(function.body):
            if isinstance(inner, RegisterLoad) and _tells(inner, own, telling):
                return True
        if any(variable.declaration.path in telling for variable in variables(within(function.body))):
            return True
    return False
