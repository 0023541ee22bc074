"""Registers of the core that C reaches by name: `extern cregister volatile unsigned int IER, IFR`.

They have no address.  Sources: CPU (status registers, IER and IFR); HDR F2837xS_Device.h.
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import RW, Block, Word


class CpuRegs(Block):
    """Interrupt registers of the core: bit 0 is INT1, bit 13 INT14.  The offsets only tell them apart."""
    IER = Word(0x00, RW, 0, text="enabled CPU interrupts")
    IFR = Word(0x01, RW, 0, text="latched CPU interrupts")
