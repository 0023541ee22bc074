"""The data registers of an I2C module: I2CDXR and I2CDRR with their shift registers, or the FIFOs in front of them.

Modelled: XRDY and RRDY, underflow (XSMT) and overrun (RSFULL), the 16-deep FIFOs with levels and interrupts.
Not modelled: nothing that a controller has.
Time: none of its own.
Sources: TRM I2C, I2CSTR, I2CFFTX, I2CFFRX.
CHOICE: in FIFO mode XRDY and RRDY stay as after reset (the manual says not to use them).  A full receive FIFO keeps the
next byte in the shift register, as I2CDRR does.  An empty one gives its last byte again.  Each direction gives its own
interrupt pulse, also while the request of the other one is active.  A flag that was set before its enable gives no
pulse unless the level still holds (otherwise TI's example by FIFO interrupts would lose bytes).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from emulator.c28x.findings import Findings
from emulator.peripherals.fifo import DEPTH, ENHANCED, Fifo
from emulator.peripherals.i2c_interrupts import RRDY, XRDY, I2cInterrupts
from emulator.registers.i2c import I2cRegs

# I2CSTR, besides the flags of interrupts
RSFULL: Final = 0x0800
XSMT: Final = 0x0400


class I2cData:
    """Bytes to send and bytes received.  `written()` and `read()` are called when the program accesses a register."""

    __slots__ = (
        "_drr", "_dxr", "_fftx", "_findings", "_interrupts", "_premature", "_read", "_received", "_refused", "_rsr",
        "_running", "_rx_fifo", "_str", "_tx_fifo", "_unread", "_written",
    )  # fmt: skip

    def __init__(
        self, regs: I2cRegs, findings: Findings, interrupts: I2cInterrupts, fifo_interrupt: Callable[[], None], *,
        written: Callable[[], None], read: Callable[[], None],
    ) -> None:  # fmt: skip
        self._findings, self._interrupts = findings, interrupts
        self._written, self._read = written, read
        registers = regs.registers
        self._str, self._drr, self._dxr = registers["I2CSTR"], registers["I2CDRR"], registers["I2CDXR"]
        self._fftx = registers["I2CFFTX"]
        self._tx_fifo = Fifo(self._fftx, fifo_interrupt, receive=False, fresh=True)
        self._rx_fifo = Fifo(registers["I2CFFRX"], fifo_interrupt, receive=True, fresh=True)
        #: Whether the module is out of reset (IRS).
        self._running = False
        #: The receive shift register: the byte for which I2CDRR had no room.
        self._rsr = 0
        #: Whether the bytes to send are left over from a message that was not acknowledged.
        self._refused = False
        #: Whether I2CDRR holds an unread byte; bytes since reset, and reads before the first of them.
        self._unread = False
        self._received = self._premature = 0
        regs.bind("I2CDRR", read=self._read_I2CDRR)
        regs.bind("I2CDXR", write=self._write_I2CDXR)
        regs.bind("I2CFFTX", write=self._write_I2CFFTX)
        regs.bind("I2CFFRX", write=self._rx_fifo.write)

    def reset(self) -> None:
        """Reset of the module; its owner resets the registers."""
        self._running = self._unread = self._refused = False
        self._tx_fifo.reset()
        self._rx_fifo.reset()
        self._received = self._premature = 0

    def run(self, on: bool) -> None:
        """IRS.  CHOICE: while it is 0 the FIFOs keep their bytes; bits of their own reset them."""
        self._running = on
        if not on:
            self._unread = False
            self._refused = self._refused and bool(self._tx_fifo.words)
        self._follow()

    @property
    def overrun(self) -> bool:
        """Whether a byte waits in the shift register for I2CDRR to be read."""
        return bool(self._str.value & RSFULL)

    def refused(self) -> None:
        """A message was not acknowledged.  Waiting bytes stay, and a driver that tries again overwrites them.

        No document says whether they do stay.  So a byte that is lost because of them is not reported.
        """
        self._refused = True

    def load(self) -> int:
        """The next byte for the transmit shift register; -1, an underflow, if there is none."""
        if self._fftx.value & ENHANCED:
            if self._tx_fifo.words:
                byte = self._tx_fifo.pop()
                if not self._tx_fifo.words:
                    self._refused = False
                return byte
        elif not self._str.value & XRDY:
            self._interrupts.set(XRDY)
            self._refused = False
            return self._dxr.value
        self._str.value &= ~XSMT
        return -1

    def arrive(self, byte: int) -> None:
        """The receive shift register is full: pass the byte on, if there is room."""
        self._received += 1
        if self._fftx.value & ENHANCED:
            fifo = self._rx_fifo
            if not fifo.running:
                self._lost(self._drr.path, "the receive FIFO is held in reset: the byte is lost")
            elif len(fifo.words) < DEPTH:
                fifo.push(byte)
            else:
                self._overrun(byte)
        elif self._unread:
            self._overrun(byte)
        else:
            self._drr.value = byte
            self._unread = True
            self._interrupts.set(RRDY)

    def _overrun(self, byte: int) -> None:
        if self._str.value & RSFULL:
            # The bus is not held in loopback or after a STOP.
            self._lost(self._drr.path, "two bytes came before the last one was read: the first of them is lost")
        self._rsr = byte
        self._str.value |= RSFULL

    def _write_I2CDXR(self, word: int, lanes: int) -> None:
        self._dxr.store(word, lanes)
        if self._fftx.value & ENHANCED:
            if not self._tx_fifo.push(self._dxr.value):
                if not self._refused:
                    self._lost(self._dxr.path, "the transmit FIFO is full or held in reset: the byte is lost")
                return
        else:
            if not self._str.value & XRDY and not self._refused:
                self._lost(self._dxr.path, "the byte before was not sent yet: it is lost")
            self._interrupts.clear(XRDY)
        self._str.value |= XSMT
        self._written()

    def _read_I2CDRR(self) -> int:
        if self._fftx.value & ENHANCED:
            if self._rx_fifo.words:
                self._drr.value = self._rx_fifo.pop()
            else:
                self._not_received()
        elif self._unread:
            self._unread = False
            self._interrupts.clear(RRDY)
        else:
            self._not_received()
        byte = self._drr.value
        if self._str.value & RSFULL:
            self._str.value &= ~RSFULL
            self.arrive(self._rsr)
            self._read()
        return byte

    def _not_received(self) -> None:
        """A read of I2CDRR without a byte.  One read before the first byte, to empty the register, is usual."""
        if not self._received:
            self._premature += 1
            if self._premature == 1:
                return
        path, byte = self._drr.path, self._drr.value
        self._findings.report(
            "result-not-ready",
            f"{path} was read again without a new byte: it holds the old {byte:#04x}",
            object=path, value=byte,
        )  # fmt: skip

    def _write_I2CFFTX(self, word: int, lanes: int) -> None:
        if word & ~self._fftx.value & ENHANCED:
            self._unread = False
            self._str.value = self._str.value & ~RSFULL | XRDY
            self._interrupts.clear(RRDY)
        self._tx_fifo.enabled = self._running and bool(word & ENHANCED)
        self._tx_fifo.write(word, lanes)
        if not self._tx_fifo.words:
            self._refused = False
        self._follow()

    def _follow(self) -> None:
        """Update the FIFO interrupts: in FIFO mode and out of reset, the levels give interrupts."""
        self._tx_fifo.enabled = self._rx_fifo.enabled = self._running and bool(self._fftx.value & ENHANCED)
        self._tx_fifo.refresh()
        self._rx_fifo.refresh()

    def _lost(self, path: str, what: str) -> None:
        self._findings.report("data-lost", f"{path}: {what}", object=path)
