"""The interrupt half of an ADC module: which ADCINT the end of a conversion raises, and what clears it.

Part of `adc.py`, whose docstring says what is modelled.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final, Literal

from emulator.c28x.sites import Place
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.registers.adc import AdcRegs
from emulator.registers.core import ALL

Collision = Literal["cleared", "erratum", "overflow"]

#: INT1E and INT1SEL of ADCINTSEL1N2; INT2 lies 8 bits higher.
ENABLE: Final = 0x20
SELECT: Final = 0x0F
CONTINUOUS: Final = 0x40


class AdcInterrupts:
    """ADCINT1..4: flags, overflows, pulses.  `request(socs)` is what ADCINTSOCSEL triggers."""

    __slots__ = (
        "_clock", "_collision", "_cpu", "_flag_at", "_flags_then", "_left_by", "_overflows_then", "_path", "_pulses",
        "_request", "flags", "notes_collisions", "overflows", "sel12", "sel34", "socsel1", "socsel2",
    )  # fmt: skip

    def __init__(self, clock: Clock, cpu: Cpu, regs: AdcRegs, pulses: Sequence[Callable[[], None]],
                 collision: Collision, request: Callable[[int], None],
                 left_by: Callable[[int], Place | None]) -> None:  # fmt: skip
        """`left_by(n)`: the routine of ADCINT(n+1) that has run since its last pulse.  Raises ValueError for a wrong
        number of pulses.
        """
        if len(pulses) != 4:
            raise ValueError(f"{regs.name}: {len(pulses)} interrupts: want the 4 pulses ADCINT1..4")
        self._clock, self._cpu, self._path = clock, cpu, regs.name
        self._pulses = list(pulses)
        self._collision, self.notes_collisions = collision, collision != "cleared"
        self._request, self._left_by = request, left_by
        registers = regs.registers
        self.flags, self.overflows = registers["ADCINTFLG"], registers["ADCINTOVF"]
        self.sel12, self.sel34 = registers["ADCINTSEL1N2"], registers["ADCINTSEL3N4"]
        self.socsel1, self.socsel2 = registers["ADCINTSOCSEL1"], registers["ADCINTSOCSEL2"]
        regs.bind("ADCINTFLGCLR", write=self._write_ADCINTFLGCLR if self.notes_collisions else self._clearing())
        regs.bind("ADCINTOVFCLR", write=self._write_ADCINTOVFCLR)
        self.reset()

    def reset(self) -> None:
        """The owner has reset the registers."""
        self._flag_at = self._flags_then = self._overflows_then = -1

    def connect(self, n: int, pulse: Callable[[], None]) -> None:
        """ADCINT(n+1) goes to `pulse` from now on."""
        self._pulses[n] = pulse

    @property
    def plain(self) -> bool:
        """Whether an EOC does nothing beyond ADCINT1 and ADCINT2."""
        return not (self.sel34.value or self.socsel1.value or self.socsel2.value or self.notes_collisions)

    def raised_by(self, soc: int) -> str:
        """The name of a flag of ADCINTFLG that is set and that the EOC of `soc` drives, or nothing."""
        for n in range(4):
            sel = (self.sel34 if n > 1 else self.sel12).value >> 8 * (n & 1)
            if sel & (ENABLE | SELECT) == ENABLE | soc and self.flags.value >> n & 1:
                return f"ADCINT{n + 1}"
        return ""

    def eoc(self, soc: int, sel_then: int) -> None:
        """The ADCINTs that the EOC of `soc` drives; ADCINTSEL1N2 was `sel_then` when the conversion began."""
        sel = self.sel12.value
        if sel != sel_then:
            self._changed(soc, sel_then, sel)
        if sel & 0x2F == 0x20 | soc:
            self._raise(0, sel & 0x40)
        if sel & 0x2F00 == 0x2000 | soc << 8:
            self._raise(1, sel & 0x4000)
        sel = self.sel34.value
        if sel:
            if sel & 0x2F == 0x20 | soc:
                self._raise(2, sel & 0x40)
            if sel & 0x2F00 == 0x2000 | soc << 8:
                self._raise(3, sel & 0x4000)

    def _changed(self, soc: int, then: int, now: int) -> None:
        """Report an ADCINT that this EOC drove when the conversion began, and that drives another SOC now."""
        for n in range(2):
            was, is_now = then >> 8 * n & (ENABLE | SELECT), now >> 8 * n & (ENABLE | SELECT)
            if was == ENABLE | soc and is_now != was:
                name = f"{self._path}.ADCINTSEL1N2.INT{n + 1}SEL"
                self._cpu.findings.report(
                    "adc-flag-shared",
                    f"{name} was changed from {soc} to {is_now & SELECT} while SOC{soc} was converting: its end does "
                    f"not set ADCINT{n + 1}, and who waits for that flag gets another conversion or none",
                    object=name, value=is_now & SELECT,
                )  # fmt: skip

    def _raise(self, n: int, cont: int) -> None:
        """The EOC of ADCINT(n+1): flag or overflow, and the pulse."""
        bit = 1 << n
        if self.notes_collisions:
            self._note(bit)
        if self.flags.value & bit:
            self.overflows.value |= bit
            if not cont:
                self._not_cleared(n)
                return
        else:
            self.flags.value |= bit
        self._pulses[n]()
        if n < 2 and (self.socsel1.value or self.socsel2.value):
            select = self.socsel1.value | self.socsel2.value << 16
            socs = sum(1 << k for k in range(16) if select >> 2 * k & 3 == n + 1)
            if socs:
                self._request(socs)

    def _not_cleared(self, n: int) -> None:
        path = f"{self._path}.ADCINTFLG.ADCINT{n + 1}"
        message = f"{path} was still set when the next conversion ended: no interrupt is given for it, and "
        message += "ADCINTOVF is set"
        routine = self._left_by(n)
        if routine is None:
            self._cpu.findings.report("flag-not-cleared", message, object=path)
        else:
            self._cpu.findings.report_at(
                routine, "flag-not-cleared", message, how="dynamic", object=path, task=f"Isr:{routine.function}"
            )  # fmt: skip

    def _note(self, bit: int) -> None:
        """Remember what this cycle sets, for a clear in the same cycle."""
        if self._flag_at != self._clock.now:
            self._flag_at = self._clock.now
            self._flags_then = self._overflows_then = 0
        if self.flags.value & bit:
            self._overflows_then |= bit
        else:
            self._flags_then |= bit

    def _clearing(self) -> Callable[[int, int], None]:
        flags = self.flags

        def clear_flags(word: int, lanes: int = ALL) -> None:
            flags.value &= ~word

        return clear_flags

    def _write_ADCINTFLGCLR(self, word: int, lanes: int = ALL) -> None:
        if self._clock.now == self._flag_at:
            if self._collision == "erratum":
                word &= ~self._flags_then
            else:
                self.overflows.value |= self._flags_then & word
        self.flags.value &= ~word

    def _write_ADCINTOVFCLR(self, word: int, lanes: int = ALL) -> None:
        if self._clock.now == self._flag_at:  # TRM: hardware wins
            word &= ~self._overflows_then
        self.overflows.value &= ~word
