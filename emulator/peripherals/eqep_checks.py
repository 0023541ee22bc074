"""Finds mistakes of eQEP drivers: reads of counters that cannot count yet, flags that are never cleared.

Part of `eqep.py`.  Nothing here changes the value of a register.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from emulator.cpu import Cpu
from emulator.registers.eqep import QDECCTL, QEPCTL, QFLG, EQepRegs
from emulator.signals import QuadratureWire

_INT: Final = QFLG.INT.mask
_UTO: Final = QFLG.UTO.mask
_UNIT_RUNS: Final = QEPCTL.UTE.mask | QEPCTL.QPEN.mask


class EQepChecks:
    """The findings of one module."""

    __slots__ = ("_cpu", "_on_blocked", "_quadrature", "_regs", "_seen", "_stale", "_unserved")

    def __init__(
        self, cpu: Cpu, regs: EQepRegs, quadrature: QuadratureWire, on_blocked: Callable[[], bool] = lambda: False
    ) -> None:
        self._cpu, self._regs, self._quadrature, self._on_blocked = cpu, regs, quadrature, on_blocked
        self.cleared(_INT | _UTO)

    def cleared(self, flags: int) -> None:
        """QCLR was written with `flags`."""
        if flags & _UTO:
            #: Whether UTO was read as 1 since it was set; whether another unit has ended after that without a clear.
            self._seen = self._stale = False
        if flags & _INT:
            #: Enabled events since the last clear of QFLG.INT.
            self._unserved = 0

    # Counters

    @property
    def missing(self) -> str:
        """Why the counter does not get the lines that it needs: QSRC 2 and 3 have a fixed direction (TRM)."""
        decoder = self._regs.QDECCTL.value
        a, b = self._quadrature.missing_a, self._quadrature.missing_b
        if decoder >> QDECCTL.QSRC.lo & 3 < 2:
            return a or b
        return b if decoder & QDECCTL.SWAP.mask else a

    def position_read(self) -> None:
        """QPOSCNT was read.  Report it if the counter cannot have counted right."""
        name = self._regs.name
        if not self._regs.QEPCTL.value & QEPCTL.QPEN.mask:
            self._report(f"{name}.QEPCTL.QPEN", "QPOSCNT", "= 0: the module is held in reset and counts nothing")
        elif not self._regs.registers["QPOSMAX"].value:
            self._report(f"{name}.QPOSMAX", "QPOSCNT", "= 0: every edge wraps the counter to 0")
        else:
            self._report(self._quadrature.name, "QPOSCNT", f"has no pins: {self.missing}")

    def latch_read(self) -> None:
        """QPOSLAT was read.  Only a unit time-out writes it, with the value of QPOSCNT."""
        name = self._regs.name
        if not self._regs.QEPCTL.value & QEPCTL.QPEN.mask:
            self._report(f"{name}.QEPCTL.QPEN", "QPOSLAT", "= 0: the module is held in reset and latches nothing")
        elif not self._regs.QEPCTL.value & QEPCTL.UTE.mask:
            self._report(f"{name}.QEPCTL.UTE", "QPOSLAT", "= 0: the unit timer that latches it does not run")
        elif not self._regs.registers["QUPRD"].value:
            self._report(f"{name}.QUPRD", "QPOSLAT", "= 0: the unit timer that latches it never ends")
        elif not self._regs.registers["QPOSMAX"].value:
            self._report(f"{name}.QPOSMAX", "QPOSLAT", "= 0: every edge wraps the counter to 0")
        elif self.missing:
            self._report(self._quadrature.name, "QPOSLAT", f"has no pins: {self.missing}")

    def _report(self, what: str, register: str, why: str) -> None:
        self._cpu.findings.report(
            "not-configured", f"{self._regs.name}.{register} was read while {what} {why}", object=what
        )

    # Flags

    def unit_timeout(self, flags: int) -> None:
        """A unit has ended; QFLG is still as it was."""
        self._stale = self._stale or bool(flags & _UTO and self._seen)

    def flags_read(self, flags: int) -> None:
        """QFLG was read."""
        if not flags & _UTO:
            if self._regs.QEPCTL.value & _UNIT_RUNS == _UNIT_RUNS and not self._regs.registers["QUPRD"].value:
                self._report(f"{self._regs.name}.QUPRD", "QFLG", "= 0: the unit timer never ends, and UTO is never set")
            return
        if self._stale:
            path = f"{self._regs.name}.QFLG.UTO"
            self._cpu.findings.report(
                "flag-not-cleared",
                f"{path} was read as 1, another unit ended, and it was read as 1 again without QCLR.UTO between: a "
                "wait for it passes at once",
                object=path,
            )  # fmt: skip
        self._seen = True

    def event(self, flags: int) -> None:
        """Events of `flags`, enabled in QEINT, occurred while QFLG.INT was set.

        The second in a row is reported, unless `on_blocked()` has reported the routine that left the flag.
        """
        self._unserved += 1
        if self._unserved > 1 and not self._on_blocked():
            path = f"{self._regs.name}.QFLG.INT"
            self._cpu.findings.report(
                "flag-not-cleared",
                f"{path} is still set from the last interrupt: none is given any more until QCLR.INT is written",
                object=path, value=self._unserved,
            )  # fmt: skip
