"""An eQEP module alone, for tests in register language."""

from __future__ import annotations

from emulator.c28x.findings import Findings
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.peripherals.eqep import EQep
from emulator.registers.eqep import EQepRegs
from emulator.signals import QuadratureWire

TOP = 0xFFFF_FFFF


class Bench:
    def __init__(self, maximum: int = TOP, enable: bool = True, **options: int) -> None:
        self.clock = Clock()
        self.findings = Findings(self.clock)
        self.cpu = Cpu(self.clock, self.findings)
        self.wire = QuadratureWire("wheel")
        self.regs = EQepRegs("EQep1Regs", 0x5100, self.cpu)
        self.pulses: list[int] = []
        self.eqep = EQep(
            self.clock, self.cpu, self.regs, self.wire, lambda: self.pulses.append(self.clock.now), **options
        )
        self.regs.QPOSMAX = maximum
        if enable:
            self.regs.QEPCTL.bit.QPEN = 1

    def turn(self, edges: int, start: int | None = None, end: int | None = None) -> None:
        """Edges between two times; by default all at the present one."""
        start = self.clock.now if start is None else start
        self.wire.move(edges, start, start if end is None else end)
