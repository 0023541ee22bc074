"""The life of a fault on a board: it begins, fires, is accessed by the firmware, and ends.

It *fires* whenever something differs from a run without it: a code, a level, a character, a count.  Its *first access*
is the first read of the register that brings such a value into the firmware (or, in RAM, of the object), with its
statement and its task.  A fault whose values do not enter the firmware has none.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from enum import Enum
from random import Random
from typing import TYPE_CHECKING, Any, Final, Protocol, cast

from emulator.clock import SYSCLK_HZ, Clock, ClockEvent, seconds
from emulator.pin_functions import PIN_FUNCTIONS
from emulator.registers.cell import Cell
from hil.faults.kinds import Fault
from hil.faults.when import wait_for
from hil.longest import LONGEST_S
from hil.machine import Machine
from hil.reports.excerpt import relative_path

if TYPE_CHECKING:
    from emulator.c28x.findings import Findings
    from emulator.image import Firmware
    from emulator.signal import Signal
    from hil.board import Board

#: Times that a report names; the others are only counted.
TIMES_KEPT: Final = 10


class Phase(Enum):
    """The state of a fault."""

    WAITS = "waits"
    AT_WORK = "at work"
    OVER = "over"
    REMOVED = "removed"


@dataclass(frozen=True, slots=True)
class FirstAccess:
    """The first access that met a fault: `place` as file:line, with its function, the task and the time."""

    place: str
    function: str
    task: str
    time_s: float


@dataclass(frozen=True, slots=True)
class FaultOutcome:
    """The outcome of a fault.  Times are seconds after start-up, as those of orders."""

    fault: Fault
    times_s: tuple[float, ...]
    count: int
    met: FirstAccess | None

    def __str__(self) -> str:
        if not self.count:
            return f"{self.fault}: it never fired"
        often = "once" if self.count == 1 else f"{self.count} times"
        met = self.met
        by = f"first access by {met.task} at {met.place} at {met.time_s:.6f} s" if met else "no access of the firmware"
        return f"{self.fault}: fired {often}, first at {self.times_s[0]:.6f} s; {by}"

    def and_then(self, later: FaultOutcome) -> FaultOutcome:
        """Combine the outcomes of one fault on two machines, one after the other.

        Times and first access are those of the first outcome that has them.
        """
        return FaultOutcome(self.fault, self.times_s or later.times_s, self.count + later.count, self.met or later.met)

    def as_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        met = self.met
        return {
            "fault": str(self.fault), "kind": self.fault.kind.name, "count": self.count, "times_s": list(self.times_s),
            "met": None if met is None else
            {"place": met.place, "function": met.function, "task": met.task, "time_s": met.time_s},
        }  # fmt: skip


class FaultTarget(Protocol):
    """A machine that can have faults, such as `hil.running.RunningBoard`."""

    board: Board
    clock: Clock
    findings: Findings
    uart_sent: Signal[int, int]
    #: How long start-up takes.
    start_up_cycles: int

    @property
    def firmware(self) -> Firmware:
        """The linked image."""


class Effect(ABC):
    """The effect of a kind of fault, created when the fault is mounted.

    Raises ValueError for a board without the parts that it needs.
    """

    def __init__(self, mounted: MountedFault) -> None:
        self.check_machine(mounted.machine)
        self.mounted = mounted
        self.machine = mounted.machine
        self.board: Board = mounted.machine.board
        self.clock = mounted.machine.clock
        self.rng: Random = mounted.rng
        self._ends: list[Callable[[], None]] = []

    @classmethod  # noqa: B027
    def check_machine(cls, machine: FaultTarget) -> None:
        """Raise ValueError for a machine without the parts that this kind needs, whatever the parameters are."""

    @abstractmethod
    def begin(self) -> None:
        """Begin the fault."""

    def end(self) -> None:
        """End the fault: restore everything that can be restored."""
        while self._ends:
            self._ends.pop()()

    def on_end(self, mend: Callable[[], None]) -> None:
        """Call `mend` when the fault ends; the last one is called first."""
        self._ends.append(mend)

    def fired(self, *cells: Cell) -> None:
        """Report that something differs from a run without the fault.  The next read of one of `cells` is its first
        access."""
        self.mounted.fired(cells)

    # Parameters

    def number(self, name: str) -> float:
        """The value of a parameter."""
        return float(self.mounted.fault.values[name])

    def whole(self, name: str) -> int:
        """The value of a parameter that is a whole number."""
        return int(self.mounted.fault.values[name])

    def text(self, name: str) -> str:
        """The value of a parameter that is a text."""
        return str(self.mounted.fault.values[name])

    def chosen_by_rate(self) -> bool:
        """Draw whether it happens this time; `rate` is the probability."""
        rate = self.number("rate")
        return rate >= 1.0 or self.rng.random() < rate

    # Time

    def repeat(self, rate_hz: float, action: Callable[[], None]) -> None:
        """Call `action` at random times, `rate_hz` a second, until the end."""
        RandomTimes(self, rate_hz, action).plan()

    # Registers through which something comes into the firmware

    def results(self, adc: str, channel: int) -> list[Cell]:
        """The result registers of the SOCs that convert an input."""
        control = self.board.blocks[f"Adc{adc.lower()}Regs"].registers
        results = self.board.blocks[f"Adc{adc.lower()}ResultRegs"].registers
        cells = []
        for soc in range(16):
            register = control[f"ADCSOC{soc}CTL"]
            field = register.fields["CHSEL"]
            if (register.value & field.mask) >> field.lo == channel:
                cells.append(results[f"ADCRESULT{soc}"])
        return cells

    def module_at(self, gpio: int, signals: Sequence[str]) -> str | None:
        """The first of `signals` that a pin can carry."""
        return next((name for name in signals if gpio in PIN_FUNCTIONS.get(name, {})), None)


class RandomTimes:
    """Calls an action at random times; the intervals are drawn with `expovariate`."""

    def __init__(self, effect: Effect, rate_hz: float, action: Callable[[], None]) -> None:
        self._effect, self._rate_hz, self._action = effect, rate_hz, action
        self._event: ClockEvent | None = None
        effect.on_end(self._stop)

    def plan(self) -> None:
        """Schedule the next call."""
        cycles = max(1, round(self._effect.rng.expovariate(self._rate_hz) * SYSCLK_HZ))
        self._event = self._effect.clock.after(cycles, self._fire)

    def _fire(self) -> None:
        self._action()
        self.plan()

    def _stop(self) -> None:
        self._effect.clock.cancel(self._event)


class MountedFault:
    """A fault that is mounted on a board, until it is removed."""

    def __init__(self, fault: Fault, machine: FaultTarget, start_cycles: int) -> None:
        self.fault = fault
        self.machine = machine
        # A stream of its own: whatever else is drawn stays what it is.
        self.rng = Random(f"{machine.board.seed}:fault:{fault.values['seed']}:{fault}")
        self.count = 0
        self.phase = Phase.WAITS
        self._start = start_cycles
        self._times: list[float] = []
        self._first_access: FirstAccess | None = None
        self._tapped: set[Cell] = set()
        self._watching: Callable[[], None] | None = None
        self._effect: Effect = fault.kind.effect(self)
        at = self._start + round(float(fault.values["at"]) * SYSCLK_HZ)
        self._event: ClockEvent | None = machine.clock.schedule(max(at, machine.clock.now), self._due)

    def report(self) -> FaultOutcome:
        """When it fired, how often, and its first access."""
        return FaultOutcome(self.fault, tuple(self._times), self.count, self._first_access)

    def remove(self) -> None:
        """End the fault and stop watching.  Its report stays."""
        if self.phase is Phase.REMOVED:
            return
        if self._watching is not None:
            self._watching()
        self.machine.clock.cancel(self._event)
        self._end()
        self.phase = Phase.REMOVED
        self._untap()

    # Its life

    def _due(self) -> None:
        when = str(self.fault.values["when"])
        if when:
            self._watching = wait_for(when, self.machine, self._begin)
        else:
            self._begin()

    def _begin(self) -> None:
        self.phase = Phase.AT_WORK
        if self.fault.lasts_s <= LONGEST_S:
            self._event = self.machine.clock.after(round(self.fault.lasts_s * SYSCLK_HZ), self._end)
        self._effect.begin()

    def _end(self) -> None:
        if self.phase is Phase.AT_WORK:
            self.phase = Phase.OVER
            self._effect.end()

    # What it does, and to whom

    def _since_start_s(self) -> float:
        return seconds(self.machine.clock.now - self._start)

    def fired(self, cells: Iterable[Cell]) -> None:
        """Note that the fault has fired; the next read of one of `cells` is its first access."""
        self.count += 1
        if len(self._times) < TIMES_KEPT:
            self._times.append(self._since_start_s())
        self.watch(cells)

    def watch(self, cells: Iterable[Cell]) -> None:
        """Note the next read of one of `cells` as the first access."""
        if self._first_access is None and self.phase is not Phase.REMOVED:
            for cell in cells:
                if cell not in self._tapped:
                    self._tapped.add(cell)
                    cell.tap(self._accessed, reads=True)

    def _accessed(self, _cell: Cell, access: str, _word: int, _mask: int) -> None:
        if access == "read" and self._first_access is None:
            self.note_access()

    def note_access(self) -> None:
        """Note the statement that executes now as the first access."""
        if self._first_access is None:
            places = self.machine.findings.here(1)
            place, function = "", ""
            if places:
                place, function = f"{relative_path(places[0].file)}:{places[0].numbers}", places[0].function
            self._first_access = FirstAccess(place, function, self.machine.findings.context(), self._since_start_s())
            # Not now: who is told of an access is not changed while it is told.
            self.machine.clock.after(0, self._untap)

    def _untap(self) -> None:
        for cell in self._tapped:
            cell.untap(self._accessed)
        self._tapped.clear()

    @property
    def met(self) -> bool:
        """Whether the firmware has accessed its effect."""
        return self._first_access is not None


def mount(fault: Fault, machine: Machine | FaultTarget, *, from_now: bool = False) -> MountedFault:
    """Put a fault on a machine, before or after its start-up.  Raises ValueError for a board that cannot have it.

    Times count from the end of start-up, or `from_now`.
    """
    if not hasattr(machine, "board"):
        raise ValueError(f"{fault.kind.name}: only an emulated board can have faults")
    carrier = cast("FaultTarget", machine)
    try:
        return MountedFault(fault, carrier, carrier.clock.now if from_now else carrier.start_up_cycles)
    except ValueError as error:
        raise ValueError(f"{fault.kind.name}: {error}") from None
