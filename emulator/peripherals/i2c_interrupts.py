"""Interrupts of an I2C module: flags of I2CSTR, their enables in I2CIER, and the arbiter behind I2CISRC.

Modelled: ARBL, NACK, ARDY, RRDY, XRDY and SCD; their priority; I2CISRC, which a read clears, and the flags that this
read clears too (ARBL, NACK, SCD); after each read, the next request.
Not modelled: AAS, which only a target has.
Time: none of its own.
Sources: TRM I2C, interrupt requests, I2CISRC.
CHOICE: a request is made by the event that sets a flag, or by the enable of a flag that is set.  A flag that is cleared
withdraws its request.  The code in I2CISRC stays until it is read, and until then there is no further interrupt.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from emulator.registers.core import ALL
from emulator.registers.i2c import I2cRegs

# I2CSTR, and I2CIER likewise
ARBL: Final = 0x01
NACK: Final = 0x02
ARDY: Final = 0x04
RRDY: Final = 0x08
XRDY: Final = 0x10
SCD: Final = 0x20
#: All of these.
REQUESTS: Final = 0x3F
#: Flags that the read of their code clears.
CLEARED_BY_READ: Final = ARBL | NACK | SCD
INTCODE: Final = 0x07


class I2cInterrupts:
    """The requests of one module; `interrupt` is a pulse into the PIE."""

    __slots__ = ("_ier", "_interrupt", "_isrc", "_pending", "_str")

    def __init__(self, regs: I2cRegs, interrupt: Callable[[], None]) -> None:
        self._interrupt = interrupt
        registers = regs.registers
        self._ier, self._str, self._isrc = registers["I2CIER"], registers["I2CSTR"], registers["I2CISRC"]
        #: Requests that wait for I2CISRC to be read.
        self._pending = 0
        regs.bind("I2CIER", write=self._write_I2CIER)
        regs.bind("I2CSTR", write=self._write_I2CSTR)
        regs.bind("I2CISRC", read=self._read_I2CISRC)

    def reset(self) -> None:
        """No request, flags as after a reset of the module (IRS = 0)."""
        self._pending = 0
        self._str.value = self._str.reset_value
        self._isrc.value &= ~INTCODE

    def set(self, flags: int) -> None:
        """Set flags of I2CSTR, and request their interrupts."""
        self._str.value |= flags
        self._pending |= flags & self._ier.value & REQUESTS
        self._offer()

    def clear(self, flags: int) -> None:
        """Clear flags of I2CSTR, and take back their requests."""
        self._str.value &= ~flags
        self._withdraw(flags)

    def _offer(self) -> None:
        """Give the request of the highest priority (the lowest flag) as soon as I2CISRC is free."""
        pending = self._pending
        if pending and not self._isrc.value & INTCODE:
            first = pending & -pending
            self._pending = pending & ~first
            self._isrc.value |= first.bit_length()
            self._interrupt()

    def _withdraw(self, flags: int) -> None:
        self._pending &= ~flags
        code = self._isrc.value & INTCODE
        if code and flags & 1 << (code - 1):
            self._isrc.value &= ~INTCODE
            self._offer()

    def _write_I2CIER(self, word: int, lanes: int = ALL) -> None:
        before = self._ier.value
        self._ier.store(word, lanes)
        enabled = self._ier.value
        self._pending = (self._pending | enabled & ~before & self._str.value & REQUESTS) & enabled
        self._offer()

    def _write_I2CSTR(self, word: int, lanes: int = ALL) -> None:
        before = self._str.value
        self._str.store(word, lanes)
        self._withdraw(before & ~self._str.value)

    def _read_I2CISRC(self) -> int:
        word = self._isrc.value
        code = word & INTCODE
        if code:
            self._isrc.value = word & ~INTCODE
            self._str.value &= ~(1 << (code - 1) & CLEARED_BY_READ)
            self._offer()
        return word
