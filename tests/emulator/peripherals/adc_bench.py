"""An ADC module alone, for tests in register language.  PRESCALE 6, 12 bits: tEOC 41, tLAT 44 (data sheet)."""

from __future__ import annotations

from typing import Any

from emulator.c28x.findings import Findings
from emulator.clock import CYCLES_PER_US, Clock
from emulator.cpu import Cpu
from emulator.peripherals.adc import Adc
from emulator.registers.adc import AdcRegs, AdcResultRegs
from emulator.signals import AnalogWire

ACQPS = 19


WINDOW = ACQPS + 1


SYNC = 2  # CHOICE of the model, from trigger to window


EOC = SYNC + WINDOW + 41  # a software conversion from the store that forces it to its flag


LAT = SYNC + WINDOW + 44


class Bench:
    """An ADC, powered and set up as us.c sets it up; `volts[n]` stands at ADCINn."""

    def __init__(self, *, powered: bool = True, **options: Any) -> None:
        self.clock = Clock()
        self.findings = Findings(self.clock)
        self.cpu = Cpu(self.clock, self.findings)
        self.cpu.eallow = True
        self.regs = AdcRegs("AdcaRegs", 0x7400, self.cpu)
        self.results = AdcResultRegs("AdcaResultRegs", 0x0B00, self.cpu)
        self.volts: list[Any] = [0.0] * 16
        self.pulses: list[tuple[int, int]] = []
        pins = [AnalogWire(f"ADCIN{n}") for n in range(16)]
        for n, pin in enumerate(pins):
            pin.follow("test", lambda _cycles, n=n: self.volts[n])
        pulses = [lambda n=n: self.pulses.append((n + 1, self.clock.now)) for n in range(4)]
        #: When ADCAEVT pulsed.
        self.events: list[int] = []
        self.adc = Adc(
            self.clock, self.cpu, self.regs, self.results, pins, pulses,
            lambda: self.events.append(self.clock.now - self.start), **options,
        )  # fmt: skip
        self.regs.ADCCTL2.bit.PRESCALE = 6
        self.regs.ADCCTL1.bit.INTPULSEPOS = 1
        for n in range(16):
            self.soc(n).bit.ACQPS = ACQPS
            self.soc(n).bit.CHSEL = n
        if powered:
            self.regs.ADCCTL1.bit.ADCPWDNZ = 1
            self.clock.charge(500 * CYCLES_PER_US)
        self.start = self.clock.now

    def soc(self, n: int) -> Any:
        return self.regs.registers[f"ADCSOC{n}CTL"]

    def result(self, n: int) -> int:
        return self.results.registers[f"ADCRESULT{n}"].read()

    def at(self, cycles: int) -> None:
        """Let time pass until `cycles` after the bench was ready."""
        self.clock.charge(self.start + cycles - self.clock.now)

    def interrupt_1_on(self, soc: int, cont: int = 0) -> None:
        self.regs.ADCINTSEL1N2.bit.INT1SEL = soc
        self.regs.ADCINTSEL1N2.bit.INT1E = 1
        self.regs.ADCINTSEL1N2.bit.INT1CONT = cont
