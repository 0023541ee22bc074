"""The C28x core as far as a C program sees it: EALLOW, INTM, IER, IFR, SP and the interrupt sequence.

SPRU430: on interrupt entry ST1 is pushed, then INTM and DBGM are set and EALLOW is cleared; IRET restores
them.  An interrupt is taken between two charges of the CPU, runs as a nested call on the interrupted Python
stack, and is masked while INTM is set.

IDLE waits for an interrupt that IER lets through.  Not modelled: STANDBY, HALT and hibernation (LPMCR.LPM other than
0); the program goes on at once.

If interrupts follow each other for long, and the interrupted code does not get a single cycle, that is a storm.  It is
a finding and ends the run, because nothing else would run any more.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, NoReturn

from emulator.c28x.findings import Findings
from emulator.c28x.position import INTERRUPT
from emulator.c28x.sites import Place
from emulator.clock import CYCLES_PER_MS, NEVER, Clock, ms

#: Cycles from recognition to the first instruction of the handler (SPRU430: 14 words saved, 14 cycles at least).
INTERRUPT_ENTRY_CYCLES: Final = 14
#: IRET restores the same context.
INTERRUPT_EXIT_CYCLES: Final = 8
#: IDLE up to the stop of the clock (SPRU430, "IDLE": 5 cycles).
IDLE_CYCLES: Final = 5
#: Words pushed on the interrupted stack by the core itself.
INTERRUPT_CONTEXT_WORDS: Final = 14
#: CHOICE: a storm is this many interrupts in a row, over at least this many cycles, while nothing else was executed.
#: In that time a routine of 100 cycles that takes each sample of a buffer has taken 20,000 samples.
STORM_INTERRUPTS: Final = 1000
STORM_CYCLES: Final = 10 * CYCLES_PER_MS
#: CHOICE: so are this many of routines that take long, over at least this many cycles.  A routine may compute longer
#: than its period for a while, to calibrate; for three quarters of a second a user sees that nothing else happens.
LONG_STORM_INTERRUPTS: Final = 50
LONG_STORM_CYCLES: Final = 750 * CYCLES_PER_MS


#: The interrupt at a line of the CPU: its vector, its source, and where its routine begins.
Description = Callable[[], tuple[str, str, Place | None]]


def _never() -> bool:
    """A core without LPMCR."""
    return False


class InterruptStorm(Exception):
    """Interrupts follow each other at once, and nothing else runs any more."""


class Eallow:
    """What lets protected registers be written: the bit EALLOW of the core, or one that never changes."""

    __slots__ = ("eallow",)

    def __init__(self, eallow: bool) -> None:
        self.eallow = eallow


class Cpu(Eallow):
    """Core state of one board.  Lines 1..12 come from the PIE, 13 is CPU timer 1, 14 CPU timer 2.

    It has the CPU's time to itself until a kernel takes it over.
    """

    __slots__ = (
        "_began", "_described", "_forced", "_handlers", "_left", "_row", "asleep", "clock", "deeper",
        "dispatched", "edis_at", "findings", "ier", "ifr", "in_interrupt", "intm", "isr", "lines_taken", "position",
        "sp", "stack_limit", "taken",
    )  # fmt: skip

    def __init__(self, clock: Clock, findings: Findings) -> None:
        #: Power-on state (ST1 = 0x080B: INTM set, EALLOW clear).
        super().__init__(eallow=False)
        #: The statement that cleared EALLOW last, for findings: its number, 0 if an interrupt or the reset did.
        self.edis_at = 0
        self.intm = True
        self.clock = clock
        self.findings = findings
        #: The position of the firmware.
        self.position = findings.position
        self.ier = 0
        self.ifr = 0
        #: The lines that were ever taken, as in IFR.
        self.lines_taken = 0
        self.in_interrupt = 0
        #: How many interrupts were ever taken.
        self.taken = 0
        #: The core waits in IDLE.
        self.asleep = False
        #: Whether LPMCR selects a mode below IDLE.  Those are not modelled: the program goes on at once.
        self.deeper: Callable[[], bool] = _never
        #: The routine of the vector table that runs, `Isr:name`; empty outside of one.
        self.isr = ""
        #: Stack pointer in words, and the word that it must not pass in a function.
        self.sp = 0x0400
        self.stack_limit = 0x07F8
        #: Where the routines begin that a kernel's dispatcher calls.
        self.dispatched: set[Place] = set()
        self._handlers: dict[int, Callable[[], None]] = {}
        self._described: dict[int, Description] = {}
        #: Lines that firmware has latched itself.
        self._forced = 0
        #: At this level of nesting: when the last interrupt ended, how many came in a row, and since when (cycles).
        self._left = -1
        self._row = 0
        self._began = 0
        clock.serve_with(self.service)

    def connect(self, line: int, handler: Callable[[], None], described: Description | None = None) -> None:
        """Set the handler of interrupt `line` (1..14): the PIE's fetch, or a timer's ISR.

        `described` returns what waits at the line.  A later handler without one keeps it.
        """
        self._handlers[line] = handler
        if described is not None:
            self._described[line] = described

    def routine_at(self, begins: Place) -> str:
        """The thread of the routine that begins there: `Hwi:name` under a kernel's dispatcher, else `Isr:name`."""
        return f"{'Hwi' if begins in self.dispatched else 'Isr'}:{begins.function}"

    def edis(self, at: int = 0) -> None:
        """Protect the registers again; `at` is the number of the statement, if it is not the one that executes now."""
        self.eallow, self.edis_at = False, at or self.position.at

    def raise_line(self, line: int) -> None:
        """Latch interrupt `line` in IFR, and request the CPU's attention."""
        self.ifr |= 1 << (line - 1)
        if not self.intm and self.ifr & self.ier:
            self.clock.request_attention()

    def enable_interrupts(self) -> None:
        """EINT: clear INTM; latched and enabled lines are taken at the next charge."""
        self.intm = False
        if self.ifr & self.ier:
            self.clock.request_attention()

    def disable_interrupts(self) -> bool:
        """DINT: set INTM; returns whether it was set already."""
        was = self.intm
        self.intm = True
        return was

    def write_ier(self, mask: int) -> None:
        """Load IER."""
        self.ier = mask & 0xFFFF
        if not self.intm and self.ifr & self.ier:
            self.clock.request_attention()

    def write_ifr(self, mask: int) -> None:
        """Load IFR.  A bit that is set counts as an interrupt that has come."""
        self._forced |= mask & ~self.ifr
        self.ifr = mask & 0xFFFF
        if not self.intm and self.ifr & self.ier:
            self.clock.request_attention()

    def idle(self) -> bool:
        """IDLE: wait until an interrupt comes that IER lets through.  Returns whether one can come.

        With INTM = 0 its routine runs first; with INTM = 1 the program goes on without it (SPRU430, IDLE).
        """
        clock = self.clock
        clock.charge(IDLE_CYCLES)
        if self.deeper():
            return True
        taken = self.taken
        self.asleep = True
        try:
            while self.taken == taken and not self.ifr & self.ier:
                if clock.next >= NEVER:
                    return False
                clock.advance_to(clock.next)
        finally:
            self.asleep = False
        return True

    def service(self) -> None:
        """Take every enabled interrupt that is latched, highest priority (lowest line) first.

        Raises InterruptStorm, with a finding.
        """
        while not self.intm:
            active = self.ifr & self.ier
            if not active:
                return
            line = (active & -active).bit_length()
            if self.clock.now != self._left:
                self._row, self._began = 0, self.clock.now
            elif self._row >= LONG_STORM_INTERRUPTS:
                lasted = self.clock.now - self._began
                if lasted >= (STORM_CYCLES if self._row >= STORM_INTERRUPTS else LONG_STORM_CYCLES):
                    self._storm(line)
            self.ifr &= ~(1 << (line - 1))
            self._forced &= ~(1 << (line - 1))
            self._enter(line)

    def _storm(self, line: int) -> NoReturn:
        """Report a storm: only interrupts have run for long, and the next one waits at `line`."""
        described = self._described.get(line)
        unknown = f"interrupt {line} of the CPU", "its source", None
        vector, source, begins = unknown if described is None else described()
        if self._forced & 1 << (line - 1):
            source = f"the firmware itself, which sets INT{line} in IFR,"
        findings, position = self.findings, self.position
        starved = findings.context()
        message = (
            f"{vector} occurs again as soon as its routine returns: {source} requests it at once; {self._row} "
            f"interrupts in a row, {ms(self.clock.now - self._began):.3f} ms without a statement of {starved}"
        )  # fmt: skip
        details = tuple(f"{starved} is at {place}" for place in findings.path(position.at, position.calls)[:1])
        if begins is None:
            findings.report("interrupt-storm", message, object=vector, value=self._row, details=details)
        else:
            findings.report_at(
                begins, "interrupt-storm", message, how="dynamic", object=vector, value=self._row, details=details,
                task=self.routine_at(begins),
            )  # fmt: skip
        raise InterruptStorm(message)

    def _enter(self, line: int) -> None:
        self.lines_taken |= 1 << (line - 1)
        eallow, edis_at, ier, row, began = self.eallow, self.edis_at, self.ier, self._row, self._began
        position = self.position
        position.calls = interrupted = (position.at, position.calls, INTERRUPT)
        position.at = 0
        self.taken += 1
        self.intm = True
        self.eallow, self.edis_at = False, 0
        self.ier &= ~(1 << (line - 1))
        self.in_interrupt += 1
        self._left = -1
        self.sp += INTERRUPT_CONTEXT_WORDS
        self.clock.charge(INTERRUPT_ENTRY_CYCLES)
        handler = self._handlers.get(line)
        if handler is None:
            self.findings.report("interrupt-without-handler", f"CPU interrupt {line} was taken but has no handler")
        else:
            handler()
        self.clock.charge(INTERRUPT_EXIT_CYCLES)
        self.sp -= INTERRUPT_CONTEXT_WORDS
        self.in_interrupt -= 1
        position.at, position.calls, _ = interrupted
        self.eallow, self.edis_at = eallow, edis_at
        self.ier |= ier & (1 << (line - 1))
        self.intm = False
        self._left, self._row, self._began = self.clock.now, row + 1, began
