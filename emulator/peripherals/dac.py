"""A buffered 12-bit DAC: a code becomes the voltage of an analog pin.

Modelled: DACVALS, loaded into DACVALA; the two references; output enable; locks with their key; clock gate and software
reset.  An ADC can sample the pin, too.
Not modelled: loads by EPWMSYNCPER (touching LOADMODE or SYNCSEL is reported, and the code is loaded at once), the
offset trim, DACREV, the 10 us of power-up, the settling time of the buffer.
Time: none; a code takes effect at the write.
CHOICE: VDAC, which the LaunchPad leaves open, has the voltage that the board gives to VREFHI.
Sources: TRM buffered DAC; HDR F2837xS_dac.h.
"""

from __future__ import annotations

from functools import partial
from typing import Final

from emulator.cpu import Cpu
from emulator.registers.core import ALL
from emulator.registers.dac import DacRegs
from emulator.signals import AnalogWire

#: The key that DACLOCK needs in its upper four bits.
KEY: Final = 0xA
#: Register -> its bit of DACLOCK.
LOCKS: Final = {"DACCTL": 1 << 0, "DACVALS": 1 << 1, "DACOUTEN": 1 << 2}
CODES: Final = 4096


class Dac:
    """DAC behaviour over its registers; `pin` is its output, the references are in volts."""

    def __init__(self, cpu: Cpu, regs: DacRegs, pin: AnalogWire, *, vdac_v: float, vrefhi_v: float) -> None:
        self._findings, self._regs, self._pin = cpu.findings, regs, pin
        self._references_v = vdac_v, vrefhi_v
        for name in LOCKS:
            regs.bind(name, write=partial(self._write, name))
        regs.bind("DACLOCK", write=self._write_DACLOCK)

    def reset(self) -> None:
        """Reset of the module (power-on, SOFTPRES16): code 0, output off, nothing locked."""
        self._regs.reset()
        self._follow()

    @property
    def volts(self) -> float:
        """What the output buffer gives: DACVALA of 4096 parts of the reference."""
        registers = self._regs.registers
        return registers["DACVALA"].value * self._references_v[registers["DACCTL"].value & 1] / CODES

    def _follow(self) -> None:
        volts = self.volts
        on = self._regs.registers["DACOUTEN"].value & 1
        self._pin.drive((lambda _cycles: volts) if on else None, steady=True)

    def _write(self, name: str, word: int, lanes: int = ALL) -> None:
        registers = self._regs.registers
        register = registers[name]
        if registers["DACLOCK"].value & LOCKS[name]:
            message = f"{register.path} is locked by DACLOCK: the write was dropped"
            self._findings.report("locked", message, object=register.path, value=word)
            return
        if name == "DACVALS" and word >= CODES:
            message = f"{register.path} holds 0 to {CODES - 1}: {word} was written, and arrives as {word % CODES}"
            self._findings.report("register-value", message, object=register.path, value=word)
        register.store(word, lanes)
        registers["DACVALA"].value = registers["DACVALS"].value
        self._follow()

    def _write_DACLOCK(self, word: int, lanes: int = ALL) -> None:
        if word >> 12 & 0xF == KEY:
            self._regs.registers["DACLOCK"].store(word, lanes)
