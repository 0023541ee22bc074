"""The receiving half of an SCI: from frames and breaks on a line to SCIRXBUF, SCIRXST and the RX interrupt.

Part of `sci.py`, whose docstring says what is modelled.
"""

from __future__ import annotations

from collections.abc import Callable
from math import ceil
from typing import Final

from emulator.c28x.findings import Cause
from emulator.clock import CYCLES_PER_MS, Clock, ClockEvent
from emulator.cpu import Cpu
from emulator.peripherals.fifo import DEPTH, INT_ENABLE, LEVEL, OVERFLOW, RUN, SHORT, Fifo
from emulator.peripherals.sci_sampling import Character, Format, frame_waveform, low_pulse, matches, sample
from emulator.registers.sci import SciRegs
from emulator.signals import SerialFrame, SerialLine

# SCICTL1, SCICTL2
RXENA: Final = 0x01
RXERRINTENA: Final = 0x40
RXBKINTENA: Final = 0x02
# SCIRXST
RXERROR: Final = 0x80
RXRDY: Final = 0x40
BRKDT: Final = 0x20
FE: Final = 0x10
OE: Final = 0x08
PE: Final = 0x04
# SCIRXBUF
SCIFFFE: Final = 0x8000
SCIFFPE: Final = 0x4000
#: A message has ended when no character follows its last one for this time (CHOICE).
PAUSE_CYCLES: Final = 5 * CYCLES_PER_MS


def _errors(character: Character) -> int:
    return (PE if character.parity_error else 0) | (FE if character.framing_error else 0)


class SciReceiver:
    """Receiver of one SCI.  `own_format()` is what SCICCR and the baud registers say now."""

    def __init__(
        self,
        clock: Clock,
        cpu: Cpu,
        regs: SciRegs,
        line: SerialLine,
        interrupt: Callable[[], None],
        own_format: Callable[[], Format],
        break_bits: float,
        on_blocked: Callable[[], object] | None = None,
    ) -> None:
        self._clock = clock
        self._cpu = cpu
        self._regs = regs
        #: What arrives at the module.
        self.line = line
        self._interrupt = interrupt
        self._own_format = own_format
        self._break_bits = break_bits
        register = regs.registers
        self._ctl1 = register["SCICTL1"]
        self._ctl2 = register["SCICTL2"]
        self._ffrx = register["SCIFFRX"]
        self._rxst = register["SCIRXST"]
        self._rxbuf = register["SCIRXBUF"]
        self.fifo = Fifo(register["SCIFFRX"], interrupt, receive=True, on_blocked=on_blocked)
        #: Whether SWRESET is 1.
        self._running = False
        #: Whether a break was detected.  Then the receiver is deaf until SWRESET.
        self._blocked = False
        #: The cycle of the latest break that was detected, and the characters that came to the deaf receiver since.
        self.broken_at = self.unheard = 0
        #: Whether the pin is disconnected from the line.
        self.loopback = False
        #: The statement that set the baud registers.
        self.rate_set_by: Cause | None = None
        #: The statement that took the module out of reset.
        self._run_by: Cause | None = None
        #: Whether SCIRST holds the FIFO channel.
        self.channel_held = False
        #: The cycle until which a character that began earlier is being sampled.
        self._busy_until = 0.0
        self._low_since = 0
        #: How long the line was low, once it has risen again.
        self._low_width: int | None = None
        self._low_event: ClockEvent | None = None
        self._break_event: ClockEvent | None = None
        #: Whether the program has emptied the FIFO while RXFFOVF was set by this overflow.
        self._overflow_answered = False
        #: Characters that came since RXFIFORESET was cleared (None: it is not, or never was set), and the statement
        #: that cleared it.
        self._came_to_closed: int | None = None
        self._closed_by: Cause | None = None
        #: The statement that set the level of the FIFO's interrupt.
        self._level_by: Cause | None = None
        #: When the last character came, how many came without a pause, and how many of them waited in the FIFO then.
        self._last_came = 0
        self._in_a_row = self._waited = 0
        #: How many messages have ended in the FIFO, below its level, and waited there for the next one.
        self._ends_waited = 0
        #: Whether a character has come since reset, and the reads of SCIRXBUF before the first one.
        self.received = False
        self._premature = 0
        #: Whether SCIRXBUF has been read, and the loss in loopback before that.
        self._ever_read = False
        self._lost_unread = ""

        regs.bind("SCIRXBUF", read=self._read_SCIRXBUF)
        regs.bind("SCIRXEMU", read=self._read_SCIRXEMU)
        regs.bind("SCIFFRX", write=self._write_SCIFFRX)
        line.sent.connect(self._on_frame)
        line.missed.connect(self._on_missed)
        line.break_changed.connect(self._on_break)

    def hold(self) -> None:
        """SWRESET=0: state machine held, flags cleared; the FIFO keeps its characters."""
        self._running = self._blocked = False
        self.unheard = 0
        self._rxst.value = 0
        self._forget_low()

    def run(self) -> None:
        """SWRESET=1: hunt for a falling edge from now on; a line that is low already counts as one."""
        self._running = True
        self._run_by = self._cpu.findings.mark()
        self._busy_until = float(self._clock.now)
        self._update_ready()
        if self.line.broken:
            self._low_begins()

    def reset(self) -> None:
        """Module reset; the owner resets the registers."""
        self.hold()
        self.received = False
        self._premature = 0
        self._ever_read, self._lost_unread = False, ""
        self._overflow_answered = False
        self._came_to_closed = None
        self._in_a_row = self._waited = self._ends_waited = 0
        self.loopback = self.channel_held = False
        self.fifo.reset()

    def clear_channel(self) -> None:
        """SCIRST=0."""
        self.fifo.clear()
        self._update_ready()

    def accept(self, frame: SerialFrame) -> None:
        """A frame has ended at the receiver's input."""
        if not self._running or self._blocked or not self._regs.clocked:
            self.unheard += self._blocked
            return
        own = self._own_format()
        if frame.start >= self._busy_until and matches(frame, own):
            self._deliver(frame.data, 0)
            return
        if rates := frame.rates_differ(own.bit_cycles):
            name = self._regs.name
            self._cpu.findings.report(
                "serial-rate", f"{name}: {rates}", object=f"{name}.SCILBAUD", cause=self.rate_set_by
            )  # fmt: skip
        hunt = max(0.0, self._busy_until - frame.start)
        for character in sample(frame_waveform(frame), own, hunt):
            self._busy_until = frame.start + character.end
            self._deliver(character.data, _errors(character))

    # --- the line --------------------------------------------------------------------------------------------------

    def _on_frame(self, frame: SerialFrame) -> None:
        if not self.loopback and not self.line.broken:
            self.accept(frame)

    def _on_missed(self, pin: int) -> None:
        if self._running and not self.loopback and self._ctl1.value & RXENA and self._regs.clocked:
            self._cpu.findings.report(
                "not-configured",
                f"a character came to GPIO{pin}, and {self._regs.name} is waiting for one, but {self.line.missing}: "
                "it is lost",
                object=self.line.name, cause=self._run_by,
            )  # fmt: skip

    def _on_break(self, low: bool) -> None:
        if self.loopback or not self._running or self._blocked:
            return
        if low:
            self._low_begins()
        else:
            self._low_ends()

    def _low_begins(self) -> None:
        if self._low_event is None:
            own = self._own_format()
            self._low_since = self._clock.now
            self._low_width = None
            self._low_event = self._clock.after(ceil(own.frame_bits * own.bit_cycles), self._low_sampled)

    def _low_ends(self) -> None:
        self._clock.cancel(self._break_event)
        self._break_event = None
        if self._low_event is not None:
            self._low_width = self._clock.now - self._low_since

    def _low_sampled(self) -> None:
        """The character that began with the falling edge is over."""
        self._low_event = None
        own = self._own_format()
        for character in sample(low_pulse(self._low_width), own):
            self._busy_until = self._low_since + character.end
            self._deliver(character.data, _errors(character))
        if self._low_width is None:
            self._break_event = self._clock.after(ceil(self._break_bits * own.bit_cycles), self._break_detected)

    def _break_detected(self) -> None:
        self._break_event = None
        self._blocked = True
        self.broken_at, self.unheard = self._clock.now, 0
        # With the FIFO on, a break interrupts through RXERROR only (TRM, SCI interrupt flags).
        self._raise(BRKDT, also=not self.fifo.enabled and bool(self._ctl2.value & RXBKINTENA))

    def _forget_low(self) -> None:
        self._clock.cancel(self._low_event)
        self._clock.cancel(self._break_event)
        self._low_event = self._break_event = None

    # --- a character -----------------------------------------------------------------------------------------------

    def _deliver(self, data: int, errors: int) -> None:
        if not self._ctl1.value & RXENA:
            return
        self.received = True
        if self.fifo.enabled:
            self._deliver_to_fifo(data, errors)
            return
        status = self._rxst.value
        if status & RXRDY:
            errors |= OE
            self._lost("a character came before the last one was read: the last one is lost")
        self._rxbuf.value = data
        self._rxst.value = status | RXRDY
        # CHOICE: the interrupt comes from RXRDY *becoming* 1.
        self._raise(errors, also=not status & RXRDY and bool(self._ctl2.value & RXBKINTENA))

    def _deliver_to_fifo(self, data: int, errors: int) -> None:
        fifo = self.fifo
        if self.channel_held:
            return
        if not fifo.running:
            self._came_too_late()
            return
        if not self.loopback:
            self._check_pause()
        was_empty = not fifo.words
        word = data | (SCIFFFE if errors & FE else 0) | (SCIFFPE if errors & PE else 0)
        kept = fifo.push(word)
        self._rxst.value |= RXRDY
        raised = 0
        if not kept:
            self._lost("the receive FIFO was full: its oldest character is lost")
            self._overflow_answered = False
            raised = OE
        self._waited = len(fifo.words)
        # FE and PE show when their character reaches the head of the FIFO, OE at once.
        if was_empty or not kept:
            raised |= self._head_errors()
        self._raise(raised)

    def _check_pause(self) -> None:
        """A character has come.  Was the end of the message before it still in the FIFO, below the level?"""
        now, own, fifo = self._clock.now, self._own_format(), self.fifo
        since, self._last_came = now - self._last_came, now
        if int(since) < 2 * own.frame_bits * own.bit_cycles:
            self._in_a_row += 1
            return
        ended, self._in_a_row = self._in_a_row > 1, 1
        register, waiting = self._ffrx.value, len(fifo.words)
        below = register & INT_ENABLE and 0 < waiting < register & LEVEL
        if ended and since > PAUSE_CYCLES and below and waiting == self._waited:
            self._ends_waited += 1
            if self._ends_waited == SHORT:
                self._cpu.findings.report(
                    "fifo-level",
                    f"{fifo.path}.RXFFIL = {register & LEVEL}: {SHORT} messages have ended with fewer characters in "
                    "the FIFO, which then waited there for the next message",
                    object=fifo.path, cause=self._level_by,
                )  # fmt: skip

    def _head_errors(self) -> int:
        word = self.fifo.words[0]
        return (FE if word & SCIFFFE else 0) | (PE if word & SCIFFPE else 0)

    def _raise(self, errors: int, also: bool = False) -> None:
        """Set error flags.  Give one pulse if RXERROR rises with its interrupt enabled, or for a source `also`."""
        status = self._rxst.value
        if errors:
            self._rxst.value = status | errors | RXERROR
            also = also or bool(not status & RXERROR and self._ctl1.value & RXERRINTENA)
        if also:
            self._interrupt()

    def _update_ready(self) -> None:
        # CHOICE: with the FIFO on, RXRDY means "not empty" (unconfirmed).
        if self.fifo.enabled:
            ready = self._running and bool(self.fifo.words)
            self._rxst.value = self._rxst.value & ~RXRDY | (RXRDY if ready else 0)

    # --- registers -------------------------------------------------------------------------------------------------

    def _read_SCIRXBUF(self) -> int:
        fifo = self.fifo
        if not self._ever_read:
            self._ever_read = True
            if self._lost_unread:
                self._lost(self._lost_unread)
        if not fifo.enabled:
            if not self._rxst.value & RXRDY:
                self._not_received("RXRDY = 0")
            self._rxst.value &= ~RXRDY
            return self._rxbuf.value & 0xFF
        if not fifo.words:
            self._not_received("the receive FIFO is empty")
        else:
            self._rxbuf.value = fifo.pop()
            if fifo.short >= SHORT:
                self._cpu.findings.report("fifo-level", fifo.left_behind(), object=fifo.path)
            if fifo.words:
                self._raise(self._head_errors())
            else:
                self._update_ready()
        # CHOICE: an empty FIFO gives the last character again (unconfirmed).
        return self._rxbuf.value

    def _not_received(self, why: str) -> None:
        """A read of SCIRXBUF without a character.  One before the first character, to empty the buffer, is usual."""
        if not self.received:
            self._premature += 1
            if self._premature == 1:
                return
        path = self._rxbuf.path
        what = f"the character {self._rxbuf.value & 0xFF:#04x} from before" if self.received else "no character at all"
        self._cpu.findings.report(
            "result-not-ready", f"{path} was read while {why}: it holds {what}", object=path,
            value=self._rxbuf.value & 0xFF,
        )  # fmt: skip

    def _read_SCIRXEMU(self) -> int:
        fifo = self.fifo
        return (fifo.words[0] if fifo.enabled and fifo.words else self._rxbuf.value) & 0xFF

    def _write_SCIFFRX(self, word: int, lanes: int) -> None:
        before, unread = self._ffrx.value, len(self.fifo.words)
        self.fifo.write(word, lanes)
        self._update_ready()
        after = self._ffrx.value
        if (before ^ after) & LEVEL:
            self._level_by = self._cpu.findings.mark()
        if before & RUN and not after & RUN:
            self._closed(before, unread)
        elif after & RUN:
            self._came_to_closed = None
        if not after & OVERFLOW:
            self._overflow_answered = False

    def _closed(self, before: int, unread: int) -> None:
        """RXFIFORESET was cleared while the FIFO had `unread` characters.  Its register was `before`."""
        self._closed_by, self._came_to_closed = self._cpu.findings.mark(), 0
        if not before & OVERFLOW:
            return
        if self._overflow_answered and unread and self._cpu.in_interrupt:
            path = f"{self._ffrx.path}.RXFFOVF"
            self._cpu.findings.report(
                "flag-not-cleared",
                f"{path} is still set from an earlier overflow, for which the FIFO was already emptied: it is emptied "
                f"again, and {unread} newer characters are lost",
                object=path,
            )  # fmt: skip
        self._overflow_answered = True

    def _came_too_late(self) -> None:
        """A character arrived for a FIFO that is held in reset."""
        if self._came_to_closed is None:
            return
        self._came_to_closed += 1
        if self._came_to_closed != DEPTH:
            return
        path = self._ffrx.path
        self._cpu.findings.report(
            "data-lost",
            f"{path}: the FIFO is held in reset since RXFIFORESET was cleared: the {DEPTH} characters that came since "
            "then are lost", object=path, cause=self._closed_by,
        )  # fmt: skip

    def _lost(self, what: str) -> None:
        """Report a lost character.  In loopback, a loss does not count before the program begins to read."""
        if self.loopback and not self._ever_read:
            self._lost_unread = self._lost_unread or what
            return
        path = self._rxbuf.path
        self._cpu.findings.report("data-lost", f"{path}: {what}", object=path, otherwise=self.rate_set_by)
