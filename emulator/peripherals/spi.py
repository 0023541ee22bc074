"""SPI master: words on a bus, one clock event each.

Modelled: master transfers of 1 to 16 bits from SPITXBUF or SPIDAT; justification, with old upper bits; double
buffering, BUFFULL, INT_FLAG (only a read of SPIRXBUF clears it), OVERRUN; baud rate, clock schemes, TALK, loopback,
SPISWRESET; 16-deep FIFOs with levels, overflow and TXDLY; both interrupt lines, both levels for the DMA; SPISTE as
chip select of a master.
Not modelled: slave mode (a transfer in it is reported), 3-wire mode, the inversion of SPISTE, emulation halt (there is
no debugger), a word that clock gating freezes half-way.
Time: a word takes SPICHAR+1 bit times from the write that starts it.  The bus sees it when it is complete.
CHOICE: SPISTE falls with the first bit of a word and rises after the last one, unless the next word follows at once.
Sources: TRM SPI chapter; HDR F2837xS_spi.h.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from emulator.c28x.findings import Cause
from emulator.clock import CYCLES_PER_US, SYSCLK_HZ, Clock, ClockEvent
from emulator.cpu import Cpu
from emulator.peripherals.fifo import CHANNELS_RUN, ENHANCED, SHORT, Fifo
from emulator.registers.spi import SPIFFRX, SpiRegs
from emulator.signal import Signal
from emulator.signals import SpiBus, Wire

# SPICCR
SPISWRESET: Final = 0x80
CLKPOLARITY: Final = 0x40
SPILBK: Final = 0x10
SPICHAR: Final = 0x0F
# SPICTL
OVERRUNINTENA: Final = 0x10
CLK_PHASE: Final = 0x08
MASTER: Final = 0x04
TALK: Final = 0x02
SPIINTENA: Final = 0x01
# SPISTS
OVERRUN_FLAG: Final = 0x80
INT_FLAG: Final = 0x40
BUFFULL_FLAG: Final = 0x20

#: Below this BRR the divider stays at 4 (TRM SPIBRR).
SLOWEST_FAST_BRR: Final = 3


class Spi:
    """One SPI module as bus master.

    `rx_interrupt` and `tx_interrupt` are pulses into the PIE; without FIFO all interrupts use the RX line.
    `select(level)` drives SPISTE.
    `lspclk_divider()` is SYSCLK cycles a LSPCLK cycle; code that changes it calls `clock_changed`.
    `on_blocked()` is that of the receive FIFO (`Fifo`).
    """

    def __init__(
        self,
        clock: Clock,
        cpu: Cpu,
        regs: SpiRegs,
        bus: SpiBus,
        rx_interrupt: Callable[[], None],
        tx_interrupt: Callable[[], None],
        *,
        select: Callable[[int], None] = lambda _level: None,
        lspclk_divider: Callable[[], int] = lambda: 4,
        on_blocked: Callable[[], object] | None = None,
    ) -> None:
        self._clock = clock
        self._cpu = cpu
        self._regs = regs
        self._bus = bus
        self._rx_interrupt = rx_interrupt
        self._select = select
        self._lspclk_divider = lspclk_divider
        register = regs.registers
        self._ccr = register["SPICCR"]
        self._ctl = register["SPICTL"]
        self._sts = register["SPISTS"]
        self._brr = register["SPIBRR"]
        self._rxbuf = register["SPIRXBUF"]
        self._txbuf = register["SPITXBUF"]
        self._dat = register["SPIDAT"]
        self._fftx = register["SPIFFTX"]
        self._ffct = register["SPIFFCT"]
        self._tx_fifo = Fifo(self._fftx, tx_interrupt, receive=False)
        self._rx_fifo = Fifo(register["SPIFFRX"], rx_interrupt, receive=True, on_blocked=on_blocked)
        self._at_end = ClockEvent(self._complete)
        #: The event at the end of the word that is being shifted.
        self._shift: ClockEvent | None = None
        self._length = 16
        #: Words completed since reset, and reads of SPIRXBUF before the first of them.
        self._received = self._premature = 0
        #: Whether reads of SPISTS are watched: INT_FLAG is still set by a word before the one that is shifting.
        self._old_flag = False
        #: Whether SPIRXBUF was ever read; the first loss before that, with its statement.
        self._reads = False
        self._untold: tuple[str, Cause | None] | None = None
        #: Whether a chip select rose while the present word was shifting.
        self._cut = False
        #: The statements that wrote the word that is being sent and the words that wait.
        self._cause: Cause | None = None
        self._causes: list[Cause | None] = []
        #: Of the transaction: the bits that were sent, its first word (-1: none yet), whether another one differs, and
        #: the first word that sent nothing of what it holds, with its statement.
        self._sent, self._first, self._differ = 0, -1, False
        self._unsent: tuple[int, Cause | None] | None = None
        #: The statements that set SPIBRR, and the clock's polarity or phase.
        self._rate_by: Cause | None = None
        self._mode_by: Cause | None = None
        bus.deselected.connect(self._deselected)
        self._configure()

        regs.bind("SPICCR", write=self._write_SPICCR)
        regs.bind("SPICTL", write=self._write_SPICTL)
        regs.bind("SPIBRR", write=self._write_SPIBRR)
        regs.bind("SPIRXEMU", read=self._read_SPIRXEMU)
        regs.bind("SPIRXBUF", read=self._read_SPIRXBUF)
        regs.bind("SPITXBUF", write=self._write_SPITXBUF)
        regs.bind("SPIDAT", write=self._write_SPIDAT)
        regs.bind("SPIFFTX", write=self._write_SPIFFTX)
        regs.bind("SPIFFRX", write=self._rx_fifo.write)

    def reset(self) -> None:
        """Module reset: registers to their reset values, a word under way is abandoned."""
        self._stop()
        self._regs.reset()
        self._tx_fifo.reset()
        self._rx_fifo.reset()
        self._received = self._premature = 0
        self._watch_flag(False)
        self._configure()

    def clock_changed(self) -> None:
        """LSPCLK has another rate.  The next word uses it."""
        self._configure()

    def requested(self, *, receive: bool) -> Signal[[]]:
        """(): the FIFO has changed while SPIRXDMA or SPITXDMA is active."""
        return (self._rx_fifo if receive else self._tx_fifo).requested

    def at_level(self, *, receive: bool) -> bool:
        """Whether SPIRXDMA or SPITXDMA is active."""
        return (self._rx_fifo if receive else self._tx_fifo).at_level

    @property
    def busy(self) -> bool:
        """Whether a word is being shifted."""
        return self._shift is not None

    def bit_cycles(self) -> int:
        """SYSCLK cycles a bit at the present settings."""
        brr = self._brr.value
        return self._lspclk_divider() * (brr + 1 if brr >= SLOWEST_FAST_BRR else 4)

    @property
    def word_bits(self) -> int:
        """Bits of a word at the present settings."""
        return self._char_bits

    @property
    def word_cycles(self) -> int:
        """SYSCLK cycles a word at the present settings."""
        return self._word_cycles

    @property
    def clock_scheme(self) -> tuple[int, int]:
        """The level at which CLK rests (CPOL), and whether bits are taken at the second edge (CPHA)."""
        return self._cpol, self._cpha

    def _configure(self) -> None:
        """Follow SPICCR, SPICTL, SPIBRR and LSPCLK.  Their effect on a word is computed here, not for each word."""
        ccr, ctl = self._ccr.value, self._ctl.value
        #: Whether a word can start: out of reset and master.
        self._ready = bool(ccr & SPISWRESET and ctl & MASTER)
        #: Bits and cycles of the next word.
        self._char_bits = (ccr & SPICHAR) + 1
        self._word_cycles = self._char_bits * self.bit_cycles()
        self._clock_hz = SYSCLK_HZ / self.bit_cycles()
        #: Clock scheme of the bus, as mode = 2 cpol + cpha.
        self._cpol = 1 if ccr & CLKPOLARITY else 0
        self._cpha = 0 if ctl & CLK_PHASE else 1
        self._mode = 2 * self._cpol + self._cpha

    # --- registers -------------------------------------------------------------------------------------------------

    def _write_SPICCR(self, word: int, lanes: int) -> None:
        mode = self._mode
        self._ccr.store(word, lanes)
        self._configure()
        if self._mode != mode:
            self._mode_by = self._cpu.findings.mark()
        if not self._ccr.value & SPISWRESET:
            # The FIFOs keep their words: start-up code sets the FIFOs up before it pulses this bit.
            self._stop()
            self._sts.value = 0
            self._received = self._premature = 0
            self._watch_flag(False)
        elif self._tx_fifo.words:
            self._load_from_fifo()

    def _write_SPIBRR(self, word: int, lanes: int) -> None:
        self._brr.store(word, lanes)
        self._configure()
        self._rate_by = self._cpu.findings.mark()

    def _write_SPICTL(self, word: int, lanes: int) -> None:
        mode = self._mode
        self._ctl.store(word, lanes)
        self._configure()
        # The first write counts, too: what it did not change was meant so.  Each write of a field is one of all fields.
        if self._mode != mode or self._mode_by is None:
            self._mode_by = self._cpu.findings.mark()
        if self._tx_fifo.words:
            self._load_from_fifo()

    def _write_SPITXBUF(self, word: int, lanes: int) -> None:
        self._caused()
        self._check_use(word & 0xFFFF)
        self._txbuf.value = word = word & 0xFFFF
        if self._tx_fifo.enabled:
            if not self._tx_fifo.push(word):
                del self._causes[-1:]
                self._lost("SPITXBUF", "the transmit FIFO is full or held in reset: the word is lost")
            self._load_from_fifo()
        elif self._shift is None:
            if self._sts.value & INT_FLAG:
                self._watch_flag(True)
            self._start(word)
        else:
            if self._sts.value & BUFFULL_FLAG:
                self._lost("SPITXBUF", "the buffer was full: the word that waited in it is lost")
                del self._causes[:-1]
            self._sts.value |= BUFFULL_FLAG

    def _check_use(self, word: int) -> None:
        """Check a word whose lower bits are not sent, when those of the word before were not sent either.

        A driver that sends a word in parts writes the rest next, shifted up.  A driver that only wants an answer writes
        the same word again.
        """
        before, kept = self._txbuf.value, self._char_bits
        unsent = (1 << 16 - kept) - 1
        lost, lost_before = word & unsent, before & unsent
        if lost and lost_before and lost != lost_before and word != before << kept & 0xFFFF:
            self._report_width(word, self._causes[-1])
        self._sent |= word & ~unsent
        if lost and not self._sent and self._unsent is None:
            self._unsent = word, self._causes[-1]
        if self._first < 0:
            self._first = word
        elif word != self._first:
            self._differ = True

    def _report_width(self, word: int, cause: Cause | None) -> None:
        kept = self._char_bits
        lost = word & (1 << 16 - kept) - 1
        self._cpu.findings.report(
            "spi-width",
            f"{self._txbuf.path} = {word:#06x} is sent from bit 15 down, {kept} bits: {lost:#x} is not sent",
            object=f"{self._ccr.path}.SPICHAR", value=word, cause=cause,
        )  # fmt: skip

    def _write_SPIDAT(self, word: int, lanes: int) -> None:
        if self._shift is None:
            self._caused()
            self._start(word & 0xFFFF)
        else:
            self._cpu.findings.report(
                "unmodelled", f"{self._dat.path} was written while it shifts: the write is ignored here",
                object=self._dat.path, value=word,
            )  # fmt: skip

    def _read_SPIRXEMU(self) -> int:
        fifo = self._rx_fifo
        return fifo.words[0] if fifo.enabled and fifo.words else self._rxbuf.value

    def _read_SPIRXBUF(self) -> int:
        if not self._reads:
            self._first_read()
        if self._rx_fifo.enabled:
            if self._rx_fifo.words:
                self._rxbuf.value = self._rx_fifo.pop()
                if self._rx_fifo.short >= SHORT:
                    self._cpu.findings.report("fifo-level", self._rx_fifo.left_behind(), object=self._rx_fifo.path)
            else:
                # CHOICE: an empty FIFO gives the last word again (unconfirmed).
                self._not_received()
        elif self._sts.value & INT_FLAG:
            self._sts.value &= ~INT_FLAG
            if self._old_flag:
                self._watch_flag(False)
        else:
            self._not_received()
        return self._rxbuf.value

    def _not_received(self) -> None:
        """A read of SPIRXBUF without a word.  One read before the first word, to empty the buffer, is usual."""
        if not self._received and self._shift is None:
            self._premature += 1
            if self._premature == 1:
                return
        why = "no word was received since it was last read"
        if self._shift is not None:
            why = f"the word under way ends in {(self._shift.time - self._clock.now) / CYCLES_PER_US:.1f} us"
        path = self._rxbuf.path
        self._cpu.findings.report(
            "result-not-ready", f"{path} was read though {why}: it holds {self._rxbuf.value:#06x} from before",
            object=path, value=self._rxbuf.value,
        )  # fmt: skip

    def _watch_flag(self, on: bool) -> None:
        """Watch reads of SPISTS while INT_FLAG is still set by an earlier word."""
        if on != self._old_flag:
            self._old_flag = on
            self._regs.bind("SPISTS", read=self._read_old_flag if on else None)

    def _read_old_flag(self) -> int:
        path = f"{self._sts.path}.INT_FLAG"
        self._cpu.findings.report(
            "flag-not-cleared",
            f"{path} is still set from an earlier word, because SPIRXBUF was not read: a wait for it passes at once, "
            "while a word is shifting",
            object=path,
        )  # fmt: skip
        return self._sts.value

    def _write_SPIFFTX(self, word: int, lanes: int) -> None:
        enabled = bool(word & ENHANCED)
        self._tx_fifo.enabled = self._rx_fifo.enabled = enabled
        self._tx_fifo.write(word, lanes)
        if enabled and not self._fftx.value & CHANNELS_RUN:
            # CHOICE: SPIRST holds the channels in FIFO mode only.
            self._stop()
            self._tx_fifo.clear()
            self._rx_fifo.clear()
        else:
            self._rx_fifo.refresh()
            if self._tx_fifo.words:
                self._load_from_fifo()

    # --- a word ----------------------------------------------------------------------------------------------------

    def _load_from_fifo(self) -> None:
        if (
            self._shift is None
            and self._tx_fifo.words
            and self._tx_fifo.enabled
            and self._fftx.value & CHANNELS_RUN
            and self._may_start()
        ):
            self._start(self._tx_fifo.pop())

    def _may_start(self) -> bool:
        if not self._ready and self._ccr.value & SPISWRESET:
            self._cpu.findings.report(
                "unmodelled", f"{self._regs.name} has a word to send but MASTER_SLAVE=0: slave mode is not modelled",
                object=f"{self._regs.name}.SPICTL.MASTER_SLAVE",
            )  # fmt: skip
        return self._ready

    def _start(self, word: int, delay_cycles: int = 0) -> None:
        # CHOICE: without FIFO, a word written during SPISWRESET=0 stays in SPIDAT and is not sent afterwards.
        self._dat.value = word
        if self._causes:
            self._cause = self._causes.pop(0)
        if self._bus.missing and not self._ccr.value & SPILBK:
            self._not_configured(f"{self._bus.missing}: the word does not reach the bus", self._bus.name)
        if self._ready or self._may_start():
            self._length = self._char_bits
            clock = self._clock
            self._shift = self._at_end
            clock.start(self._at_end, clock.now + delay_cycles + self._word_cycles)
            if not self._ccr.value & SPILBK:
                self._select(0)
            if not self._ctl.value & TALK:
                name = f"{self._ctl.path}.TALK"
                self._not_configured(f"{name} = 0: SIMO stays in high impedance, and no device receives the word", name)
        elif not self._ccr.value & SPISWRESET:
            name = f"{self._ccr.path}.SPISWRESET"
            self._not_configured(f"{name} = 0: the module is held in reset, and the word is not sent", name)

    def _not_configured(self, why: str, name: str) -> None:
        self._cpu.findings.report(
            "not-configured", f"{self._regs.name} was given a word to send, but {why}", object=name
        )

    def _deselected(self, chip_select: Wire) -> None:
        """A device was deselected.  A word that is being shifted does not reach it any more.

        Words that differ and all sent zeros were not meant so: a driver that only wants an answer repeats one word.
        """
        if self._unsent is not None and not self._sent and self._differ:
            self._report_width(*self._unsent)
        self._sent, self._first, self._differ, self._unsent = 0, -1, False, None
        shift = self._shift
        if shift is not None and not self._cut:
            self._cut = True
            left_us = (shift.time - self._clock.now) / CYCLES_PER_US
            self._cpu.findings.report(
                "spi-transaction-cut",
                f"chip select {chip_select.name} rose {left_us:.1f} us before the word on {self._bus.name} had ended",
                object=chip_select.name,
            )  # fmt: skip

    def _complete(self) -> None:
        """The last bit has been sampled; the next word may follow."""
        self._receive()
        if self._shift is None:
            self._select(1)

    def _receive(self) -> None:
        """Move SPIDAT to the receive buffer, and the next word to send into SPIDAT."""
        self._shift = None
        self._received += 1
        if self._old_flag:
            self._watch_flag(False)
        ctl, length, sent = self._ctl.value, self._length, self._dat.value
        out_bits = sent >> (16 - length)
        if self._ccr.value & SPILBK:
            # CHOICE: in loopback the pins stay quiet.
            in_bits = out_bits
        else:
            self._cpu.findings.cause = self._cause
            try:
                # CHOICE: with TALK=0 a slave reads the floating SIMO as zeros.
                in_bits = self._bus.exchange(out_bits if ctl & TALK else 0, length, self._cpol, self._cpha)
                if self._bus.lost:
                    self._not_configured(self._bus.lost, self._bus.name)
                if not self._bus.addressed and self._bus.connected and not self._cut:
                    self._check_selected()
                elif self._clock_hz > self._bus.greatest_clock_hz:
                    self._too_fast()
                elif self._bus.refused >> self._mode & 1:
                    self._check_mode()
            finally:
                self._cpu.findings.cause = None
            self._cut = False
        received = (sent << length | in_bits) & 0xFFFF
        self._dat.value = received
        if self._tx_fifo.enabled:
            if not self._rx_fifo.push(received):
                wanted = bool(self._regs.registers["SPIFFRX"].value & SPIFFRX.RXFFIENA.mask)
                self._not_taken("the receive FIFO was full or held in reset: a word is lost", wanted)
            if self._tx_fifo.words and self._may_start():
                self._start(self._tx_fifo.pop(), self._ffct.value * self.bit_cycles())
            return
        status = self._sts.value
        self._rxbuf.value = received
        self._sts.value = status | INT_FLAG
        if status & INT_FLAG:
            self._overrun(status)
        elif ctl & SPIINTENA:
            self._rx_interrupt()
        if status & BUFFULL_FLAG:
            self._sts.value &= ~BUFFULL_FLAG
            self._start(self._txbuf.value)

    def _check_selected(self) -> None:
        name = self._bus.name
        self._cpu.findings.report(
            "spi-no-device", f"a word was sent on {name} while no chip select was low: no device took it", object=name
        )

    def _too_fast(self) -> None:
        for slave in self._bus.too_fast(self._clock_hz):
            name, most = type(slave).__name__, getattr(slave, "greatest_clock_hz", 0.0)
            self._cpu.findings.report(
                "device-clock",
                f"{name} is clocked with {self._clock_hz / 1e6:.3g} MHz on {self._bus.name}: it takes {most / 1e6:.3g} "
                f"MHz at most (LSPCLK {SYSCLK_HZ / self._lspclk_divider() / 1e6:.4g} MHz, SPIBRR {self._brr.value})",
                object=name, cause=self._rate_by,
            )  # fmt: skip

    def _check_mode(self) -> None:
        for slave in self._bus.refusing(self._mode):
            modes = " and ".join(map(str, sorted(getattr(slave, "clock_modes", ()))))
            name, phase = type(slave).__name__, int(not self._cpha)
            self._cpu.findings.report(
                "spi-mode",
                f"{name} takes mode {modes}, and {self._bus.name} has mode {self._mode}: CLKPOLARITY = {self._cpol}, "
                f"CLK_PHASE = {phase}",
                object=name, cause=self._mode_by,
            )  # fmt: skip

    def _overrun(self, status: int) -> None:
        """The word before this one was not read; `status` is SPISTS as it was."""
        # CHOICE: an INT_FLAG that is still set gives no new edge to the PIE; the overrun has its own enable.
        self._sts.value |= OVERRUN_FLAG
        wanted = bool(self._ctl.value & SPIINTENA)
        self._not_taken("a word came before the last one was read: the last one is lost", wanted)
        if self._ctl.value & OVERRUNINTENA and not status & OVERRUN_FLAG:
            self._rx_interrupt()

    def _caused(self) -> None:
        """Remember the statement that writes a word."""
        self._causes.append(self._cpu.findings.mark())

    def _stop(self) -> None:
        self._causes.clear()
        self._clock.cancel(self._shift)
        self._shift = None
        self._select(1)

    def _not_taken(self, what: str, wanted: bool) -> None:
        """A received word is lost.  A driver that only sends reads none of them: it is told with the first read."""
        if wanted or self._reads:
            self._lost("SPIRXBUF", what)
        elif self._untold is None:
            self._untold = what, self._cpu.findings.mark()

    def _first_read(self) -> None:
        self._reads = True
        if self._untold is not None:
            what, cause = self._untold
            self._untold = None
            self._lost("SPIRXBUF", what, cause)

    def _lost(self, register: str, what: str, cause: Cause | None = None) -> None:
        path = f"{self._regs.name}.{register}"
        self._cpu.findings.report("data-lost", f"{path}: {what}", object=path, cause=cause)
