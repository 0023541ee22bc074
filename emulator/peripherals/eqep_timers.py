"""The three timers of an eQEP module: unit timer, watchdog, edge capture.

Each is a count of SYSCLK cycles since a stored cycle `zero`, computed on demand.  `run(on)` starts and stops it; while
it is stopped, its register holds the count.

Sources: TRM eQEP, unit timer, watchdog, edge capture unit.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from emulator.clock import Clock, ClockEvent
from emulator.registers.eqep import QCAPCTL, QEPSTS, EQepRegs

#: SYSCLK cycles of a count of QWDTMR, as a shift (TRM: SYSCLK/64).
_WATCHDOG_SHIFT: Final = 6
_WATCHDOG_SPAN: Final = 1 << (16 + _WATCHDOG_SHIFT)
_SPAN32: Final = 1 << 32
_COEF: Final = QEPSTS.COEF.mask
_CDEF: Final = QEPSTS.CDEF.mask


class UnitTimer:
    """QUTMR and QUPRD.  `timeout()` is called at each unit time-out, with the timer already back at 0.

    `extra` cycles are added to QUPRD.  CHOICE: QUPRD = 0 gives no time-out.
    """

    __slots__ = ("_clock", "_event", "_extra", "_period", "_running", "_timeout", "_timer", "_zero")

    def __init__(self, clock: Clock, regs: EQepRegs, timeout: Callable[[], None], extra: int) -> None:
        self._clock = clock
        self._timer = regs.registers["QUTMR"]
        self._period = regs.registers["QUPRD"]
        self._timeout = timeout
        self._extra = extra
        self._event: ClockEvent | None = None
        self._running = False
        self._zero = 0
        regs.bind("QUTMR", read=self.read, write=self._write_QUTMR)
        regs.bind("QUPRD", write=self._write_QUPRD)

    def run(self, on: bool) -> None:
        """Start from the stored count, or stop and store it."""
        if on != self._running:
            self._timer.value = self.read()
            self._running = on
            self._zero = self._clock.now - self._timer.value
            self._schedule()

    def read(self) -> int:
        """QUTMR now."""
        return (self._clock.now - self._zero) % _SPAN32 if self._running else self._timer.value

    def _write_QUTMR(self, word: int, lanes: int) -> None:
        self._timer.store(word, lanes)
        self._zero = self._clock.now - self._timer.value
        self._schedule()

    def _write_QUPRD(self, word: int, lanes: int) -> None:
        self._zero = self._clock.now - self.read()
        self._period.store(word, lanes)
        self._schedule()

    def _schedule(self) -> None:
        self._clock.cancel(self._event)
        self._event = None
        if self._running and self._period.value:
            due = self._zero + self._period.value + self._extra
            # A timer that is past its period meets it again only after 32 bits.
            while due <= self._clock.now:
                due += _SPAN32
            self._event = self._clock.schedule(due, self._due)

    def _due(self) -> None:
        self._zero = self._clock.now
        self._schedule()
        self._timeout()


class EqepWatchdog:
    """QWDTMR and QWDPRD.  Edges only move `zero`; the event that finds them moved waits for the rest.

    CHOICE: QWDPRD = 0 gives no time-out; after a time-out the timer starts again from 0.
    """

    __slots__ = ("_clock", "_event", "_period", "_running", "_sync", "_timeout", "_timer", "zero")

    def __init__(self, clock: Clock, regs: EQepRegs, sync: Callable[[], None], timeout: Callable[[], None]) -> None:
        self._clock = clock
        self._timer = regs.registers["QWDTMR"]
        self._period = regs.registers["QWDPRD"]
        self._sync = sync
        self._timeout = timeout
        self._event: ClockEvent | None = None
        self._running = False
        #: Cycle at which the timer was 0: that of the last edge.
        self.zero = 0
        regs.bind("QWDTMR", read=self._read_QWDTMR, write=self._write_QWDTMR)
        regs.bind("QWDPRD", write=self._write_QWDPRD)

    def run(self, on: bool) -> None:
        """Start from the stored count, or stop and store it."""
        if on != self._running:
            self._timer.value = self._count()
            self._running = on
            self._restart(self._timer.value)

    def _count(self) -> int:
        if not self._running:
            return self._timer.value
        return (self._clock.now - self.zero) >> _WATCHDOG_SHIFT & 0xFFFF

    def _restart(self, count: int) -> None:
        self.zero = self._clock.now - (count << _WATCHDOG_SHIFT)
        self._schedule()

    def _read_QWDTMR(self) -> int:
        self._sync()
        return self._count()

    def _write_QWDTMR(self, word: int, lanes: int) -> None:
        self._sync()
        self._timer.value = word
        self._restart(word)

    def _write_QWDPRD(self, word: int, lanes: int) -> None:
        self._sync()
        self._period.value = word
        self._schedule()

    def _schedule(self) -> None:
        self._clock.cancel(self._event)
        self._event = None
        if self._running and self._period.value:
            due = self.zero + (self._period.value << _WATCHDOG_SHIFT)
            while due <= self._clock.now:
                due += _WATCHDOG_SPAN
            self._event = self._clock.schedule(due, self._due)

    def _due(self) -> None:
        self._sync()
        late = self._clock.now - self.zero - (self._period.value << _WATCHDOG_SHIFT)
        expired = late % _WATCHDOG_SPAN == 0 and late >= 0
        if expired:
            self.zero = self._clock.now
        self._schedule()
        if expired:
            self._timeout()


class Capture:
    """QCTMR, QCPRD and their latches: the time between unit position events.

    CHOICE: the prescaler SYSCLK/2^CCPS starts with CEN; QCPRD keeps the low 16 bits of a period that overflowed
    (the latch shows 0xFFFF then, TRM).
    CHOICE: a change of direction spoils the period in which it came and no other, so that TI's example, which never
    clears CDEF, measures speed in both directions; `sticky`: all periods until CDEF is cleared.
    """

    __slots__ = (
        "_clock", "_edges", "_origin", "_regs", "_shift", "_spoilt", "_status", "_sticky", "_sync", "_turned", "_unit",
        "_zero", "running",
    )  # fmt: skip

    def __init__(self, clock: Clock, regs: EQepRegs, sync: Callable[[], None], *, sticky: bool = False) -> None:
        self._clock = clock
        self._regs = regs
        self._status = regs.registers["QEPSTS"]
        self._sync = sync
        self.running = False
        self._origin = self._zero = self._shift = self._edges = 0
        self._unit = 1
        self._sticky = sticky
        #: Whether the direction has changed in the period under way, and in the one that QCPRD holds.
        self._turned = self._spoilt = False
        regs.bind("QCTMR", read=self._read_QCTMR, write=self._write_QCTMR)
        regs.bind("QCPRD", read=self._read_QCPRD, write=self._write_QCPRD)

    def run(self, on: bool) -> None:
        """Start with the prescalers that QCAPCTL holds now, or stop and store the count."""
        if on == self.running:
            return
        timer = self._regs.registers["QCTMR"]
        timer.value = self.count()
        self.running = on
        control = self._regs.QCAPCTL.value
        self._shift = (control & QCAPCTL.CCPS.mask) >> QCAPCTL.CCPS.lo
        self._unit = 1 << (control & QCAPCTL.UPPS.mask)
        self._edges = 0
        self._origin, self._zero = self._clock.now, -timer.value

    def count(self) -> int:
        """QCTMR now.  An overflow since the last call sets QEPSTS.COEF."""
        if not self.running:
            return self._regs.registers["QCTMR"].value
        ticks = ((self._clock.now - self._origin) >> self._shift) - self._zero
        if ticks > 0xFFFF:
            self._status.value |= QEPSTS.COEF.mask
            self._zero += ticks & ~0xFFFF
        return ticks & 0xFFFF

    def edges(self, steps: int, start: int, end: int) -> None:
        """Unit position events of a batch: edge i of n lies at start + (end - start) * i / n."""
        unit, span = self._unit, end - start
        for i in range(unit - self._edges, steps + 1, unit):
            ticks = (start + span * i // steps - self._origin) >> self._shift
            period = ticks - self._zero
            self._status.value |= QEPSTS.UPEVNT.mask | (QEPSTS.COEF.mask if period > 0xFFFF else 0)
            self._regs.registers["QCPRD"].value = period & 0xFFFF
            self._spoilt, self._turned = self._turned, False
            self._zero = ticks
        self._edges = (self._edges + steps) % unit

    @property
    def captured_at(self) -> int:
        """When QCPRD was last loaded."""
        return self._origin + (self._zero << self._shift)

    def direction_changed(self) -> None:
        """QEPSTS.CDEF, if a period is being measured."""
        if self.running:
            self._turned = True
            self._status.value |= QEPSTS.CDEF.mask

    def latch(self) -> None:
        """Copy QCTMR and QCPRD to their latches.  An invalid period is latched as 0xFFFF."""
        registers = self._regs.registers
        registers["QCTMRLAT"].value = self.count()
        invalid = _COEF
        if self._sticky or self._turned or self._spoilt:
            invalid |= _CDEF
        registers["QCPRDLAT"].value = 0xFFFF if self._status.value & invalid else registers["QCPRD"].value

    def _read_QCTMR(self) -> int:
        self._sync()
        return self.count()

    def _write_QCTMR(self, word: int, lanes: int) -> None:
        self._read_QCTMR()
        self._regs.registers["QCTMR"].value = word
        self._zero = ((self._clock.now - self._origin) >> self._shift) - word

    def _read_QCPRD(self) -> int:
        self._sync()
        return self._regs.registers["QCPRD"].value

    def _write_QCPRD(self, word: int, lanes: int) -> None:
        self._sync()
        self._regs.registers["QCPRD"].value = word
