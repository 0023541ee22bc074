"""Finds mistakes of I2C drivers: wrong settings at a START, and commands at a wrong time.

The criteria are the manual's words: module clock of 7 to 12 MHz, I2CPSC written only while IRS = 0, clock dividers that
are not 0, a bus of 400 kHz at most, zeros above a 7-bit address, no new message while STP is 1, STT only for a
controller, not all of RM, STT and STP, no interrupts of XRDY and RRDY in FIFO mode.
Time: checked at each START and each command, never at other accesses.
Sources: TRM I2C: clock generation, I2CPSC, I2CCLKL, I2CSAR, I2CMDR, bus activity by RM, STT and STP.
"""

from __future__ import annotations

from typing import Final

from emulator.c28x.findings import Cause, Findings
from emulator.clock import SYSCLK_HZ, ms
from emulator.registers.i2c import I2CFFTX, I2CIER, I2CMDR, I2cRegs
from emulator.signals import I2cBus

#: The allowed range of the module's clock, in Hz.
SLOWEST_HZ: Final = 7_000_000
FASTEST_HZ: Final = 12_000_000
#: The least rate of SMBus, in Hz.  I2C itself has none.
SLOWEST_BUS_HZ: Final = 10_000
#: The limit of the bus's fast mode, with a margin for the rounding of the integer dividers.
FASTEST_BUS_HZ: Final = 400_000 * 1.005
#: Bits of I2CSAR that are a 7-bit address.
ADDRESS: Final = 0x7F
_XA: Final = I2CMDR.XA.mask
_DLB: Final = I2CMDR.DLB.mask
_DATA_INTERRUPTS: Final = I2CIER.XRDY.mask | I2CIER.RRDY.mask
_FIFO_MODE: Final = I2CFFTX.I2CFFEN.mask


class I2cChecks:
    """Findings of one module."""

    __slots__ = (
        "_bus", "_clkh", "_clkl", "_divided", "_fftx", "_findings", "_ier", "_mdr", "_name", "_prescaled", "_psc",
        "_sar", "_str",
    )  # fmt: skip

    def __init__(self, regs: I2cRegs, findings: Findings, bus: I2cBus) -> None:
        self._findings, self._bus, self._name = findings, bus, regs.name
        registers = regs.registers
        self._mdr, self._sar, self._psc = registers["I2CMDR"], registers["I2CSAR"], registers["I2CPSC"]
        self._str = registers["I2CSTR"]
        self._clkl, self._clkh = registers["I2CCLKL"], registers["I2CCLKH"]
        self._ier, self._fftx = registers["I2CIER"], registers["I2CFFTX"]
        #: The statement that wrote I2CPSC last.
        self._prescaled: Cause | None = None
        #: The statement that wrote I2CCLKL or I2CCLKH last.
        self._divided: Cause | None = None

    def start(self, module_cycles: int, bit_cycles: int) -> None:
        """A START, with `module_cycles` SYSCLK cycles a module clock, and `bit_cycles` a bit."""
        for divider in (self._clkl, self._clkh):
            if not divider.value:
                self._not_configured(f"{divider.path} = 0: the manual wants it not to be zero", divider.path)
        hertz = SYSCLK_HZ / module_cycles
        if not SLOWEST_HZ <= hertz <= FASTEST_HZ:
            self._findings.report(
                "i2c-clock",
                f"{self._name} runs at {hertz / 1e6:.2f} MHz, SYSCLK / {module_cycles}: the manual wants 7 to 12 MHz",
                object=self._psc.path, value=module_cycles - 1, cause=self._prescaled,
            )  # fmt: skip
        bus_hz = SYSCLK_HZ / bit_cycles
        if bus_hz < SLOWEST_BUS_HZ and hertz >= SLOWEST_HZ:
            self._findings.report(
                "i2c-slow",
                f"{self._bus.name} runs at {bus_hz:.4g} Hz, with {self._clkl.path} = {self._clkl.value} and "
                f"{self._clkh.path} = {self._clkh.value}: a byte takes {9000 / bus_hz:.3g} ms",
                object=self._clkl.path, value=self._clkl.value, cause=self._divided,
            )  # fmt: skip
        if bus_hz > FASTEST_BUS_HZ:
            self._findings.report(
                "i2c-clock",
                f"{self._bus.name} runs at {bus_hz / 1e3:.0f} kHz, with {self._clkl.path} = {self._clkl.value} and "
                f"{self._clkh.path} = {self._clkh.value}: the module and the bus have 400 kHz at most",
                object=self._clkl.path, value=self._clkl.value, cause=self._divided,
            )  # fmt: skip
        mode, target = self._mdr.value, self._sar.value
        if not mode & _XA and target & ~ADDRESS:
            self._findings.report(
                "reserved-field",
                f"{self._sar.path} is {target:#05x} with 7-bit addressing: bits 9 to 7 must be 0, and the address on "
                f"the bus is {target & ADDRESS:#04x} (R/W is no part of it)",
                object=self._sar.path, value=target,
            )  # fmt: skip
        if self._fftx.value & _FIFO_MODE and self._ier.value & _DATA_INTERRUPTS:
            self._findings.report(
                "i2c-fifo-interrupt",
                f"{self._ier.path} enables XRDY or RRDY in FIFO mode: the manual wants TXFFINT and RXFFINT instead",
                object=self._ier.path, value=self._ier.value,
            )  # fmt: skip
        if self._bus.missing and not mode & _DLB:
            self._not_configured(f"{self._bus.missing}: the transfer does not reach the bus", self._bus.name)

    def divider(self) -> None:
        """I2CCLKL or I2CCLKH was written."""
        self._divided = self._findings.mark()

    def prescaler(self, before: int, *, running: bool) -> None:
        """I2CPSC was written."""
        now = self._psc.value
        self._prescaled = self._findings.mark()
        if running and now != before:
            self._findings.report(
                "i2c-prescaler",
                f"{self._psc.path} was changed from {before} to {now} with IRS = 1: it has no effect until IRS is "
                "cleared and set again",
                object=self._psc.path, value=now,
            )  # fmt: skip

    def early(self) -> None:
        """Report that STT was set while the last message, or its STOP, is under way."""
        path = f"{self._mdr.path}.STT"
        self._findings.report(
            "i2c-stop-pending",
            f"{path} was set while STP was still 1: the previous message or its STOP is not done, and the manual "
            "requires to wait for it",
            object=path,
        )  # fmt: skip

    def old_refusal(self) -> None:
        """Report an STP that ends a message before its address had an answer, because an older NACK was still set."""
        path = f"{self._str.path}.NACK"
        self._findings.report(
            "flag-not-cleared",
            f"{path} is still set from an earlier message: this message is given up before its address is acknowledged",
            object=path,
        )  # fmt: skip

    def left_busy(self, cycles: int) -> None:
        """Report a refused message that holds the bus; the program has been able to see that for `cycles`."""
        self._findings.report(
            "i2c-left-busy",
            f"{self._bus.name}: a message got a NACK, and neither STT nor STP was set since then: BB stays 1 until the "
            f"program sets one of them; it has polled {self._str.path} for {ms(cycles):.0f} ms",
            object=self._bus.name,
        )  # fmt: skip

    def no_controller(self) -> None:
        """STT without MST."""
        path = self._mdr.path
        self._not_configured(f"{path}.STT was set with MST = 0: a target makes no START", f"{path}.MST")

    def reserved_command(self) -> None:
        """RM, STT and STP at once."""
        path = self._mdr.path
        self._not_configured(f"{path}.RM, STT and STP are all set: a reserved combination, nothing happens", path)

    def receiver_in_loopback(self) -> None:
        """DLB with TRX = 0."""
        path = f"{self._mdr.path}.DLB"
        message = f"{path} with TRX = 0: the loopback of a receiver is not modelled, it gets 0xff"
        self._findings.report("unmodelled", message, object=path)

    def _not_configured(self, why: str, name: str) -> None:
        self._findings.report("not-configured", why, object=name)
