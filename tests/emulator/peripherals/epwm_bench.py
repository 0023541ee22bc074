"""An ePWM module alone, for tests in register language."""

from __future__ import annotations

from collections.abc import Callable

from emulator.c28x.findings import Findings
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.peripherals.epwm import EPwm
from emulator.registers.epwm import EPwmRegs
from emulator.signals import PwmWire

UP, DOWN, UP_DOWN, STOPPED = range(4)


NONE, CLEAR, SET, TOGGLE = range(4)


#: Position of each event's action in AQCTLA and AQCTLB.
SHIFT = {"ZRO": 0, "PRD": 2, "CAU": 4, "CAD": 6, "CBU": 8, "CBD": 10}


def actions(**named: int) -> int:
    return sum(action << SHIFT[name] for name, action in named.items())


class Bench:
    """EPWM2 with a TBCLK of `divider` SYSCLK cycles, once HSPCLKDIV is 0."""

    def __init__(self, divider: int = 1, tbclksync: bool = True, **options: bool) -> None:
        self.clock = Clock()
        self.findings = Findings(self.clock)
        self.cpu = Cpu(self.clock, self.findings)
        self.regs = EPwmRegs("EPwm2Regs", 0x4100, self.cpu)
        self.a, self.b = PwmWire("EPWM2A"), PwmWire("EPWM2B")
        self.interrupts: list[int] = []
        self.soc_a: list[int] = []
        self.soc_b: list[int] = []
        self.trips: list[int] = []
        self.divider = divider
        self.listen: Callable[[int, bool], None] = lambda _n, _on: None
        #: Trip inputs of the digital compare: those that are listened to, and their levels.
        self.tripins: set[int] = set()
        self.tripin_levels: dict[int, int] = {}
        self.epwm = EPwm(
            self.clock, self.cpu, self.regs, self.a, self.b, number=2,
            interrupt=lambda: self.interrupts.append(self.clock.now),
            soc_a=lambda: self.soc_a.append(self.clock.now),
            soc_b=lambda: self.soc_b.append(self.clock.now),
            trip_interrupt=lambda: self.trips.append(self.clock.now),
            trip_listen=lambda n, on: self.listen(n, on), tripin_listen=self._listen_to_tripin,
            epwmclk_divider=lambda: self.divider, **options,
        )  # fmt: skip
        self.epwm.set_tbclksync(tbclksync)
        self.regs.TBCTL.bit.HSPCLKDIV = 0

    def _listen_to_tripin(self, n: int, on: bool) -> None:
        self.tripins ^= {n}
        assert (n in self.tripins) == on
        if on:
            self.epwm.tripin(n, self.tripin_levels.get(n, 0))

    def put_tripin(self, n: int, level: int) -> None:
        """TRIPINn has this level."""
        self.tripin_levels[n] = level
        if n in self.tripins:
            self.epwm.tripin(n, level)

    def start(self, mode: int, period: int, a: int = 0, b: int = 0, control_a: int = 0, control_b: int = 0) -> None:
        """Everything immediate and in force from the first TBCLK on."""
        regs = self.regs
        regs.TBCTL.bit.PRDLD = 1
        regs.CMPCTL.bit.SHDWAMODE = 1
        regs.CMPCTL.bit.SHDWBMODE = 1
        regs.TBPRD = period
        regs.CMPA.bit.CMPA = a
        regs.CMPB.bit.CMPB = b
        regs.AQCTLA.all = control_a
        regs.AQCTLB.all = control_b
        regs.TBCTL.bit.CTRMODE = mode

    def protected(self) -> None:
        self.cpu.eallow = True
