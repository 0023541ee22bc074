"""SCI (UART): frames on two lines, one clock event for each frame sent.

Modelled: baud rate and frame length to the cycle; 1 to 8 data bits, parity, stop bits; TXRDY and TXEMPTY; 16-deep FIFOs
with levels and FFTXDLY; receive errors (FE, PE, OE, BRKDT), which stay until SWRESET; a receiver that takes nothing
after a break; overflow; all interrupt sources; loopback; SWRESET, SCIRST and FIFO resets; baud and format mismatch as
the samples see them (`sci_sampling.py`).
Not modelled: auto-baud; SLEEP and TXWAKE and the address-bit mode (setting one is reported); emulation halt (there is
no debugger); the part of a frame that a peer sees if SWRESET cuts the frame; two separate low pulses within one
character time; a character that clock gating freezes half-way.
Time: a frame starts with the write that finds the shifter idle, and reaches the line at the end of its last stop bit.
A received frame reaches SCIRXBUF at the end of its stop bit, as it was sent.
Sources: TRM SCI chapter; HDR F2837xS_sci.h.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final

from emulator.c28x.findings import Cause
from emulator.clock import Clock, ClockEvent
from emulator.cpu import Cpu
from emulator.peripherals.fifo import CHANNELS_RUN, DEPTH, ENHANCED, Fifo
from emulator.peripherals.sci_receiver import SciReceiver
from emulator.peripherals.sci_sampling import SAMPLES_PER_BIT, Format
from emulator.registers.cell import Cell
from emulator.registers.sci import SciRegs
from emulator.signals import SerialFrame, SerialLine

# SCICCR
STOPBITS: Final = 0x80
PARITY_EVEN: Final = 0x40
PARITYENA: Final = 0x20
LOOPBKENA: Final = 0x10
SCICHAR: Final = 0x07
# SCICTL1
SWRESET: Final = 0x20
TXENA: Final = 0x02
# SCICTL2
TXRDY: Final = 0x80
TXEMPTY: Final = 0x40
TXINTENA: Final = 0x01

#: BRR = 0 divides LSPCLK by 16 (TRM SCIHBAUD, SCILBAUD).
BIT_LSPCLK_AT_ZERO: Final = 16


class Sci:
    """One SCI module between its registers and the lines `tx` and `rx`.

    `rx_interrupt` and `tx_interrupt` are pulses into the PIE, `lspclk_divider()` is SYSCLK cycles a LSPCLK cycle.
    `break_bits`: how long the line stays low after a missing stop bit before BRKDT (CHOICE: 10; later manuals of the
    family say 9.625).  `on_blocked()` is that of the receive FIFO (`Fifo`).
    """

    def __init__(
        self,
        clock: Clock,
        cpu: Cpu,
        regs: SciRegs,
        tx: SerialLine,
        rx: SerialLine,
        rx_interrupt: Callable[[], None],
        tx_interrupt: Callable[[], None],
        *,
        lspclk_divider: Callable[[], int] = lambda: 4,
        break_bits: float = 10.0,
        on_blocked: Callable[[], object] | None = None,
    ) -> None:
        self._clock = clock
        self._cpu = cpu
        self._regs = regs
        self._tx = tx
        self._tx_interrupt = tx_interrupt
        self._lspclk_divider = lspclk_divider
        register = regs.registers
        self._ccr = register["SCICCR"]
        self._ctl1 = register["SCICTL1"]
        self._ctl2 = register["SCICTL2"]
        self._hbaud = register["SCIHBAUD"]
        self._lbaud = register["SCILBAUD"]
        self._txbuf = register["SCITXBUF"]
        self._fftx = register["SCIFFTX"]
        self._ffct = register["SCIFFCT"]
        self._fifo = Fifo(self._fftx, tx_interrupt, receive=False)
        #: The last result of `format`, kept for speed, and the register values that it was made from.
        self._format_key: tuple[int, int, int] | None = None
        self._format: Format
        self.receiver = SciReceiver(clock, cpu, regs, rx, rx_interrupt, self.format, break_bits, on_blocked)
        #: The statement that wrote the latest character.  Findings about its frame are reported there.
        self._cause: Cause | None = None
        #: Without FIFO: whether SCITXBUF holds a character that waits for the shifter.
        self._waiting = False
        #: The event at the end of the frame that is being shifted, and this frame.
        self._shift: ClockEvent | None = None
        self._data = 0
        self._start = 0
        self._sent_format = self.format()

        for baud in (self._hbaud, self._lbaud):
            regs.bind(baud.name, write=partial(self._write_baud, baud))
        regs.bind("SCICCR", write=self._write_SCICCR)
        regs.bind("SCICTL1", write=self._write_SCICTL1)
        regs.bind("SCICTL2", read=self._read_SCICTL2, steady=True)
        regs.bind("SCITXBUF", write=self._write_SCITXBUF)
        regs.bind("SCIFFTX", write=self._write_SCIFFTX)

    def reset(self) -> None:
        """Module reset: registers to their reset values, a frame under way is abandoned."""
        self._stop()
        self._regs.reset()
        self._fifo.reset()
        self.receiver.reset()

    def format(self) -> Format:
        """The character format and bit length (SYSCLK cycles) that the registers ask for."""
        ccr = self._ccr.value
        brr = self._hbaud.value << 8 | self._lbaud.value
        divider = self._lspclk_divider()
        key = (ccr, brr, divider)
        if key == self._format_key:
            return self._format
        bit_lspclk = SAMPLES_PER_BIT * (brr + 1) if brr else BIT_LSPCLK_AT_ZERO
        parity = None
        if ccr & PARITYENA:
            parity = "even" if ccr & PARITY_EVEN else "odd"
        self._format_key = key
        self._format = Format((ccr & SCICHAR) + 1, parity, 2 if ccr & STOPBITS else 1, bit_lspclk * divider)
        return self._format

    def character_cycles(self) -> int:
        """SYSCLK cycles that a character takes on the line."""
        own = self.format()
        return own.frame_bits * int(own.bit_cycles)

    # --- registers -------------------------------------------------------------------------------------------------

    def _write_baud(self, register: Cell, word: int, lanes: int) -> None:
        register.store(word, lanes)
        self.receiver.rate_set_by = self._cpu.findings.mark()

    def _write_SCICCR(self, word: int, lanes: int) -> None:
        self._ccr.store(word, lanes)
        self.receiver.loopback = bool(self._ccr.value & LOOPBKENA)

    def _write_SCICTL1(self, word: int, lanes: int) -> None:
        before = self._ctl1.value
        self._ctl1.store(word, lanes)
        after = self._ctl1.value
        if before & SWRESET and not after & SWRESET:
            self._stop()
            self.receiver.hold()
        elif after & SWRESET and not before & SWRESET:
            self.receiver.run()
        self._next()

    def _read_SCICTL2(self) -> int:
        if self._fifo.enabled:
            # CHOICE: with the FIFO on, TXRDY means "room in the FIFO" (unconfirmed).
            ready, empty = len(self._fifo.words) < DEPTH, not self._fifo.words
        else:
            ready = empty = not self._waiting
        status = (TXRDY if ready else 0) | (TXEMPTY if empty and self._shift is None else 0)
        return self._ctl2.value & ~(TXRDY | TXEMPTY) | status

    def _write_SCITXBUF(self, word: int, lanes: int) -> None:
        self._txbuf.store(word, lanes)
        self._cause = self._cpu.findings.mark()
        if self._tx.missing and not self._ccr.value & LOOPBKENA:
            self._not_configured(f"{self._tx.missing}: the character does not reach a pin", self._tx.name)
        if self._ctl1.value & (SWRESET | TXENA) == SWRESET:
            name = f"{self._ctl1.path}.TXENA"
            self._not_configured(f"{name} = 0: the character is not sent", name)
        if self._fifo.enabled:
            if not self._fifo.push(self._txbuf.value):
                self._lost("the transmit FIFO is full or held in reset: the character is lost")
        elif not self._ctl1.value & SWRESET:
            # CHOICE: TXRDY is held at 1 during reset, so no character waits for its end.
            name = f"{self._ctl1.path}.SWRESET"
            self._not_configured(f"{name} = 0: the module is held in reset, and the character is lost", name)
        else:
            if self._waiting:
                self._lost("TXRDY was 0: the character that waited is lost")
            self._waiting = True
        self._next()

    def _write_SCIFFTX(self, word: int, lanes: int) -> None:
        receiver = self.receiver
        enabled = bool(word & ENHANCED)
        # CHOICE: SCIRST holds the channels in FIFO mode only.
        on_blocked = enabled and not word & CHANNELS_RUN
        self._fifo.enabled = receiver.fifo.enabled = enabled
        self._fifo.write(word, lanes)
        receiver.channel_held = on_blocked
        if on_blocked:
            self._stop()
            self._fifo.clear()
            receiver.clear_channel()
        else:
            receiver.fifo.refresh()
            self._next()

    # --- a frame ---------------------------------------------------------------------------------------------------

    def _next(self, delay_bits: int = 0) -> None:
        """Move the next character to the shifter, if it is idle and may send."""
        if self._shift is not None or self._ctl1.value & (SWRESET | TXENA) != SWRESET | TXENA:
            return
        if self._fifo.enabled:
            if not self._fifo.words or not self._fftx.value & CHANNELS_RUN:
                return
            self._begin(self._fifo.words[0], delay_bits)
            self._fifo.pop()
        elif self._waiting:
            self._waiting = False
            self._begin(self._txbuf.value, 0)
            # CHOICE: the interrupt comes from TXRDY *becoming* 1; enabling it later does not raise it.
            if self._ctl2.value & TXINTENA:
                self._tx_interrupt()

    def _begin(self, data: int, delay_bits: int) -> None:
        own = self._sent_format = self.format()
        if not self._hbaud.value and not self._lbaud.value:
            name = self._lbaud.path
            self._not_configured(f"{self._hbaud.name} and {name} are 0: the baud rate was never set", name)
        self._data = data & ((1 << own.data_bits) - 1)
        bit_cycles = int(own.bit_cycles)
        self._start = self._clock.now + delay_bits * bit_cycles
        self._shift = self._clock.schedule(self._start + own.frame_bits * bit_cycles, self._sent)

    def _sent(self) -> None:
        """The last stop bit has ended."""
        self._shift = None
        own = self._sent_format
        frame = SerialFrame(
            self._data, self._start, self._clock.now, own.bit_cycles, own.data_bits, own.parity, own.stop_bits,
            rate_set_by=self.receiver.rate_set_by,
        )
        if self._ccr.value & LOOPBKENA:
            # CHOICE: in loopback the TX pin stays idle.
            self.receiver.accept(frame)
        else:
            findings = self._cpu.findings
            findings.cause = self._cause
            try:
                self._tx.send(frame)
            finally:
                findings.cause = None
        self._next(self._ffct.value & 0xFF)

    def _stop(self) -> None:
        self._clock.cancel(self._shift)
        self._shift = None
        self._waiting = False

    def _not_configured(self, why: str, name: str) -> None:
        self._cpu.findings.report(
            "not-configured", f"{self._regs.name} was given a character to send, but {why}", object=name
        )

    def _lost(self, what: str) -> None:
        path = self._txbuf.path
        self._cpu.findings.report("data-lost", f"{path}: {what}", object=path)
