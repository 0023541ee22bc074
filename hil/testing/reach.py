"""Computes what can change while a loop waits: by interrupt routines, and by events of peripherals.

The answers are conservative: an unknown effect may change anything.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Set
from functools import cached_property
from typing import Any, Final

from emulator.c28x.ctypes import PointerType
from emulator.c28x.passes.waiting import WriterAnalysis
from emulator.c28x.rts_functions import Rts
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Call,
    CallPointer,
    Const,
    Convert,
    CopyStruct,
    LValue,
    RegisterAddress,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Variable,
)
from emulator.c28x.tree_queries import addressed, parts, statements, within
from emulator.peripherals.adc import Adc
from emulator.peripherals.cpu_timer import CpuTimer
from emulator.peripherals.dma import RUNSTS
from emulator.peripherals.epwm_event_trigger import EventTrigger
from emulator.registers.pie_vectors import PieVectTable, Vector
from hil.board import Board

#: Functions outside the firmware that change nothing for which a loop could wait.
DELAYS: Final = ("DelayUs", "DELAY_US", "F28x_usDelay")
QUIET: Final = (*DELAYS, "ServiceDog", "KickDog", "EALLOW", "EDIS")
#: Registers with which an interrupt routine acknowledges its interrupt.  A write changes nothing in another block.
_ANSWERS: Final = ("PIEACK", "TCR", "ETCLR", "ADCINTFLGCLR", "ADCINTOVFCLR")
#: The first vector numbers of the PIE: for lines 1 to 8 of its groups, and for lines 9 to 16 (HDR hw_ints.h).
_GROUPED: Final = 0x20
_GROUPED_HIGH: Final = 0x80
#: Blocks that change only by their own events, pins and accesses.
_APART: Final = ("Spi", "Sci", "I2c", "Can")
#: The values of TRIGSEL for the CPU timers (TRM, ADC).  Higher values are pins and ePWMs.
_TIMER_TRIGGERS: Final = (1, 2, 3)


class Reach:
    """Computes from the firmware's source and the state of the chip what can change objects and registers."""

    def __init__(self, board: Board, modules: list[Module], replaced: Set[str]) -> None:
        self._board, self._modules, self.replaced = board, modules, replaced
        self._bodies: dict[str, _Routine] = {}

    @cached_property
    def threads(self) -> WriterAnalysis:
        """Which functions call each other, and which write an object, in these modules."""
        return WriterAnalysis(self._modules, set())

    def calls_outside(self, part: Any) -> bool:
        """Whether a part of a function calls a function outside of the firmware."""
        if not isinstance(part, Call):
            return False
        known = part.function.path in self.threads.functions or part.function.name in QUIET
        return not known or part.function.name in self.replaced

    # --- interrupt routines ------------------------------------------------------------------------------------------

    def vectors(self) -> Iterator[tuple[str, int, str]]:
        """The routines of the vector table: the entry's name and number, and the function."""
        for name, entry in PieVectTable.layout.items():
            if isinstance(entry, Vector):
                routine = self._board.register("PieVectTable", name).read()
                if routine:
                    yield name, entry.id, getattr(routine, "__qualname__", "")

    def closed(self, number: int, *, running: tuple[str, ...] | None) -> str:
        """The enable bit that blocks an interrupt; empty if no bit does.

        `running`: the routines that run now and have interrupted the loop.  During them, INTM and the cleared bit of
        IER say nothing about the loop.
        """
        board, line = self._board, _line(number)
        if number >= _GROUPED:
            n = (number - _GROUPED) % 8 + (1 if number < _GROUPED_HIGH else 9)
            if not board.register("PieCtrlRegs", "PIECTRL").value & 1:
                return "PieCtrlRegs.PIECTRL.bit.ENPIE is 0"
            if not board.register("PieCtrlRegs", f"PIEIER{line}").value >> n - 1 & 1:
                return f"PieCtrlRegs.PIEIER{line}.bit.INTx{n} is 0"
        serving = None if running is None else {_line(other) for _, other, path in self.vectors() if path in running}
        if not board.cpu.ier >> line - 1 & 1 and serving != set() and line not in (serving or ()):
            return f"IER has no M_INT{line}"
        return "INTM is set: no interrupt is taken before EINT" if board.cpu.intm and running is None else ""

    def routines(self, running: tuple[str, ...] | None) -> list[_Routine] | None:
        """The routines that may run, and those that run; None if others may run, or an effect is not known."""
        kernel = self._board.kernel
        if kernel.tasks.all or not all(self.closed(number, running=running) for number in kernel.hwis.table):
            return None
        enabled = [path for _, number, path in self.vectors() if not self.closed(number, running=running)]
        found = []
        for path in dict.fromkeys((*enabled, *(running or ()))):
            if path not in self.threads.functions:
                return None
            routine = self._bodies.get(path) or self._bodies.setdefault(path, _Routine(self, path))
            if routine.unknown or (routine.moves and self._listened_to()):
                return None
            found.append(routine)
        return found

    def _listened_to(self) -> bool:
        """Whether pins have a listener that is neither the chip nor a part of it; its effect is not known."""
        return any(_outside(f) for wire in self._board.pins for f in wire.changed.listeners)

    @cached_property
    def pointed_at(self) -> set[Variable]:
        """The objects whose address is taken.  Any code with the address may write them."""
        found = {v for function in self.threads.functions.values() for v in addressed(within(function.body))}
        return found | addressed(self._initial())

    @cached_property
    def registers_pointed_at(self) -> bool:
        """Whether a pointer of the firmware may lead to a register."""
        bodies = (part for function in self.threads.functions.values() for part in within(function.body))
        return any(_to_register(part) for nodes in (bodies, self._initial()) for part in nodes)

    def _initial(self) -> Iterator[Any]:
        for module in self._modules:
            for variable in module.variables:
                for value in variable.initial or ():
                    yield from parts(value)

    # --- what they change --------------------------------------------------------------------------------------------

    def may_write(self, routines: list[_Routine], variable: Variable) -> bool:
        """Whether one of the routines, or the DMA, may change an object."""
        if variable in self.pointed_at and (any(r.by_pointer for r in routines) or self._dma_listens()):
            return True
        writers = self.threads.writing(variable)
        return any(not routine.paths.isdisjoint(writers) for routine in routines)

    def may_change(self, routines: list[_Routine], register: RegisterRef) -> bool:
        """Whether one of the routines, or an event of the chip, may change the value of a register."""
        for routine in routines:
            pointers = routine.uses_pointers and self.registers_pointed_at
            if routine.moves or pointers or register.block in routine.written | self._read_with_effect(routine):
                return True
        return self.event_may_change(register.block)

    def _read_with_effect(self, routine: _Routine) -> set[str]:
        """The blocks of the registers that the routine reads with a side effect."""
        return {b for b, name in routine.read if not self._board.register(b, name).looked_at}

    def event_may_change(self, block: str) -> bool:
        """Whether an event is scheduled that may change a register of a block."""
        if self._dma_listens():
            return True
        owners = {owner for owner in map(_owner, self.waiting()) if owner is not None}
        if not owners:
            return False
        if block == "PieCtrlRegs" or not owners <= {CpuTimer, EventTrigger, Adc}:
            return True
        if block.startswith("Adc"):
            return Adc in owners or self._triggered(block, timers=CpuTimer in owners, others=EventTrigger in owners)
        if owners == {CpuTimer}:
            return block.startswith("CpuTimer")
        return not block.startswith(_APART)

    def _triggered(self, block: str, *, timers: bool, others: bool) -> bool:
        """Whether a CPU timer (`timers`), or another trigger (`others`), starts conversions of an ADC."""
        regs = f"{block[:4]}Regs"
        words = [self._board.register(regs, f"ADCSOC{n}CTL").value >> 20 & 0x1F for n in range(16)]
        words.append(self._board.register(regs, "ADCBURSTCTL").value & 0x3F)
        return any(timers if word in _TIMER_TRIGGERS else others for word in words if word)

    def _dma_listens(self) -> bool:
        """Whether a channel of the DMA waits for a trigger, or runs."""
        names = [name for name in self._board.blocks["DmaRegs"].registers if name.endswith(".CONTROL")]
        return any(self._board.register("DmaRegs", name).value & RUNSTS for name in names)

    # --- events ------------------------------------------------------------------------------------------------------

    def waiting(self) -> Iterator[Callable[..., Any]]:
        """The callbacks of scheduled events, except those that end calls."""
        for callback in self._board.clock.waiting():
            function = getattr(callback, "func", callback)
            if _module(function) != "hil.testing.guard":
                yield function

    def has_foreign_event(self) -> bool:
        """Whether an event is scheduled that does not belong to the chip; it may do anything."""
        return any(not _module(callback).startswith("emulator.") for callback in self.waiting())


class _Routine:
    """The objects and registers that an interrupt routine, and all functions that it calls, read and write."""

    def __init__(self, reach: Reach, path: str) -> None:
        functions = reach.threads.functions
        self.paths = reach.threads.below(path) & functions.keys()
        body = [s for name in self.paths for s in functions[name].body]
        nodes = list(within(body))
        #: Whether it calls a function with an unknown effect, or enables interrupts.
        self.unknown = any(_anything(reach, part) for part in nodes)
        #: Whether it writes a register that may have an effect on pins or other blocks.
        self.moves = False
        #: The blocks of the registers that it writes; block and name of the registers that it reads.
        self.written: set[str] = set()
        self.read = {
            (part.register.block, part.register.register)
            for part in nodes
            if isinstance(part, RegisterLoad) and isinstance(part.register, RegisterRef)
        }
        #: Whether it may write through a pointer; whether it may read or write through one.
        self.by_pointer = any(_hands_over(part, functions.keys()) for part in nodes)
        self.uses_pointers = self.by_pointer or any(_by_pointer(part) for part in nodes)
        for s in statements(body):
            if isinstance(s, Assign) and isinstance(s.target, RegisterRef):
                self._writes(s.target)
            elif isinstance(s, Assign | CopyStruct) and _by_pointer(s.target):
                self.by_pointer = True
                self.moves |= isinstance(s.target, RegisterAt)
        if self.by_pointer and reach.registers_pointed_at:
            self.unknown = True

    def _writes(self, register: RegisterRef) -> None:
        self.written.add(register.block)
        if register.block in ("CPU", "PieVectTable") or (
            register.block == "PieCtrlRegs" and register.register != "PIEACK"
        ):
            self.unknown = True  # it may enable another one
        self.moves |= register.register not in _ANSWERS


def _line(number: int) -> int:
    """The line of the CPU that a vector belongs to."""
    if number < _GROUPED:
        return number
    return (number - (_GROUPED if number < _GROUPED_HIGH else _GROUPED_HIGH)) // 8 + 1


def _anything(reach: Reach, part: Any) -> bool:
    """Whether a part of a routine is a call with an unknown effect.  The run-time library writes only by pointers."""
    if isinstance(part, Call) and reach.calls_outside(part):
        name = part.function.name
        return name in reach.replaced or part.function.path in reach.threads.functions or not hasattr(Rts, name)
    return isinstance(part, CallPointer)


def _hands_over(part: Any, own: Set[str]) -> bool:
    """Whether a part is a call of the run-time library with a pointer."""
    return isinstance(part, Call) and part.function.path not in own and any(
        isinstance(argument.ctype, PointerType) for argument in (*part.arguments, *part.extra)
    )  # fmt: skip


def _by_pointer(part: Any) -> bool:
    return isinstance(part, RegisterAt) or (isinstance(part, LValue) and not isinstance(part.root, Variable))


def _to_register(part: Any) -> bool:
    """Whether an expression may be the address of a register: by the operator &, or from a number."""
    if isinstance(part, Convert) and isinstance(part.ctype, PointerType):
        number = isinstance(part.operand, Const) and not part.operand.value
        return not isinstance(part.operand.ctype, PointerType) and not number
    return isinstance(part, RegisterAddress)


def _owner(callback: Callable[..., Any]) -> type[Any] | None:
    """The class to which the event of a callback belongs; None: the event changes no register."""
    if _module(callback) == "emulator.peripherals.pie":
        return None  # looks whether an acknowledge is missing
    return type(getattr(callback, "__self__", callback))


def _outside(listener: Any) -> bool:
    """Whether a listener belongs neither to the chip nor to the parts of this project."""
    return not _module(getattr(listener, "func", listener)).startswith(("emulator.", "hil."))


def _module(function: Callable[..., Any]) -> str:
    """The module of a function.  A compiled method does not know it, but its object's class does."""
    return str(getattr(function, "__module__", "") or type(getattr(function, "__self__", None)).__module__)
