"""The result file of an ADC module: ADCRESULT0..15, what they read before a result latches, and reads that come too
early.

A result that is read while its SOC waits or converts is that of an earlier conversion.  After a hardware trigger this
is how the module is used (the latest result whenever somebody wants it); after a software force it is a defect.

Part of `adc.py`, whose docstring says what is modelled.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from emulator.clock import NEVER, Clock
from emulator.cpu import Cpu
from emulator.registers.adc import AdcRegs, AdcResultRegs
from emulator.registers.cell import Cell

#: ADCCTL1
ADCPWDNZ: Final = 0x0080


class ResultFile:
    """The results of one ADC.

    `under_way(soc)` says whether SOC `soc` "waits" or "is converting" (or ""), `flag(soc)` which flag that its end
    drives is set.
    """

    __slots__ = (
        "_clock", "_cpu", "_ctl1", "_flag", "_mark_begun", "_regs", "_under_way", "by_hardware", "latch", "latch_at",
        "latched", "registers", "unlatched",
    )  # fmt: skip

    def __init__(self, clock: Clock, cpu: Cpu, regs: AdcRegs, results: AdcResultRegs,
                 under_way: Callable[[int], str], flag: Callable[[int], str]) -> None:  # fmt: skip
        self._clock, self._cpu, self._regs = clock, cpu, results
        self._ctl1 = regs.registers["ADCCTL1"]
        self._under_way, self._flag = under_way, flag
        self.registers = tuple(results.registers[f"ADCRESULT{n}"] for n in range(16))
        #: For each result, what says whether its SOC has begun a conversion.
        self._mark_begun = tuple(map(self._bind, range(16)))
        self.reset()

    def reset(self) -> None:
        """No SOC has been converted.  CHOICE: results read 0 after reset, unconfirmed."""
        self._regs.reset()
        #: The register that the last conversion gave reads `unlatched` until `latch_at`; then another conversion may
        #: be under way, `latch_at` is NEVER and it reads so until `latched`.
        self.latch: Cell | None = None
        self.latch_at = self.latched = self.unlatched = 0
        #: SOCs that hardware or another conversion triggered.
        self.by_hardware = 0
        for mark_begun in self._mark_begun:
            mark_begun(False)

    def under_way(self) -> None:
        """A conversion begins, maybe before the last result has latched."""
        if self.latch_at != NEVER:
            self.latched = self.latch_at
            self.latch_at = NEVER

    def begun(self, n: int) -> None:
        """SOC `n` begins its first conversion since reset."""
        self._mark_begun[n](True)

    def _bind(self, n: int) -> Callable[[bool], None]:
        register = self.registers[n]
        clock = self._clock
        ever = False

        def read() -> int:
            if clock.now < self.latch_at or not ever:
                return self._early(n) if ever else self._never(n)
            return register.value

        def mark_begun(begun: bool) -> None:
            nonlocal ever
            ever = begun

        self._regs.bind(register.name, read=read)
        return mark_begun

    def _early(self, n: int) -> int:
        """A read while a conversion is under way or latches; nobody but the one who forced it is told."""
        register = self.registers[n]
        if register is self.latch and self._clock.now < (self.latched if self.latch_at == NEVER else self.latch_at):
            return self.unlatched
        state = self._under_way(n)
        if state and not self.by_hardware >> n & 1:
            flag = self._flag(n)
            if flag:
                name = f"{self._ctl1.block.name}.ADCINTFLG.{flag}"
                self._cpu.findings.report(
                    "flag-not-cleared",
                    f"{name} is still set from before, so that a wait for it passes at once: {register.path} was read "
                    f"while SOC{n} {state}, and holds the result of an earlier conversion",
                    object=name, value=register.value,
                )  # fmt: skip
            else:
                self._not_ready(n, f"while SOC{n} {state}: it holds the result of an earlier conversion")
        return register.value

    def _never(self, n: int) -> int:
        """A read before the first conversion."""
        register = self.registers[n]
        if self._ctl1.value & ADCPWDNZ:
            self._not_ready(n, f"before SOC{n} was ever converted: it reads {register.value}")
        else:
            name = f"{self._ctl1.path}.ADCPWDNZ"
            self._cpu.findings.report(
                "not-configured",
                f"{register.path} was read while {name} = 0: the converter has no power, and nothing was converted",
                object=name,
            )  # fmt: skip
        return register.value

    def _not_ready(self, n: int, why: str) -> None:
        register = self.registers[n]
        self._cpu.findings.report(
            "result-not-ready", f"{register.path} was read {why}", object=register.path, value=register.value
        )

    def freeze(self, cycles: int) -> None:
        """The module's clock stood still for `cycles`."""
        self.latched += cycles
        if self.latch_at != NEVER:
            self.latch_at += cycles
