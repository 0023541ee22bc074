"""Clock gates, software resets, dividers, locks."""

from __future__ import annotations

import pytest

from emulator.c28x.findings import Findings
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.peripherals.sysctrl import SysCtrl
from emulator.registers.adc import AdcRegs, AdcResultRegs
from emulator.registers.cpu_timer import CpuTimerRegs
from emulator.registers.sysctrl import AnalogSubsysRegs, ClkCfgRegs, CpuSysRegs, DevCfgRegs


class Bench:
    def __init__(self) -> None:
        self.clock = Clock()
        self.findings = Findings(self.clock)
        self.cpu = Cpu(self.clock, self.findings)
        self.cpu.eallow = True
        self.cpusys = CpuSysRegs("CpuSysRegs", 0x5D300, self.cpu)
        self.clkcfg = ClkCfgRegs("ClkCfgRegs", 0x5D200, self.cpu)
        self.devcfg = DevCfgRegs("DevCfgRegs", 0x5D000, self.cpu)
        self.analog = AnalogSubsysRegs("AnalogSubsysRegs", 0x5D180, self.cpu)
        self.sysctrl = SysCtrl(self.cpu, self.cpusys, self.clkcfg, self.devcfg, self.analog)
        self.adc = AdcRegs("AdcaRegs", 0x7400, self.cpu)
        self.results = AdcResultRegs("AdcaResultRegs", 0x0B00, self.cpu)
        self.timer = CpuTimerRegs("CpuTimer0Regs", 0x0C00, self.cpu)
        self.clocks: list[bool] = []
        self.sysctrl.gate("PCLKCR13", "ADC_A", self.adc, self.results, on_clock=self.clocks.append)
        self.sysctrl.gate("PCLKCR0", "CPUTIMER0", self.timer)


def test_a_module_is_off_until_its_gate_opens() -> None:
    bench = Bench()
    bench.adc.ADCCTL2.bit.PRESCALE = 6
    assert bench.adc.ADCCTL2.all == 0
    assert {f.rule for f in bench.findings} == {"clock-gated"}
    bench.cpusys.PCLKCR13.bit.ADC_A = 1
    bench.adc.ADCCTL2.bit.PRESCALE = 6
    assert bench.adc.ADCCTL2.bit.PRESCALE == 6
    assert (bench.results.clocked, bench.clocks) == (True, [False, True])


def test_a_closed_gate_keeps_the_registers() -> None:
    bench = Bench()
    bench.cpusys.PCLKCR13.bit.ADC_A = 1
    bench.adc.ADCCTL2.bit.PRESCALE = 6
    bench.cpusys.PCLKCR13.bit.ADC_A = 0
    assert bench.adc.ADCCTL2.all == 0
    bench.cpusys.PCLKCR13.bit.ADC_A = 1
    assert bench.adc.ADCCTL2.all == 6


def test_timers_are_clocked_out_of_reset() -> None:
    bench = Bench()
    assert bench.cpusys.PCLKCR0.all == 0x38
    assert bench.timer.clocked


def test_another_gate_of_the_word_does_not_touch_a_module() -> None:
    bench = Bench()
    bench.cpusys.PCLKCR13.bit.ADC_B = 1
    assert bench.clocks == [False]


def test_gates_are_protected() -> None:
    bench = Bench()
    bench.cpu.eallow = False
    bench.cpusys.PCLKCR13.bit.ADC_A = 1
    assert not bench.adc.clocked
    assert [f.rule for f in bench.findings] == ["eallow"]


def test_a_locked_gate_register_drops_writes_until_reset() -> None:
    bench = Bench()
    bench.cpusys.CPUSYSLOCK1.bit.PCLKCR13 = 1
    bench.cpusys.CPUSYSLOCK1.bit.PCLKCR13 = 0
    assert bench.cpusys.CPUSYSLOCK1.bit.PCLKCR13 == 1, "set once"
    bench.cpusys.PCLKCR13.bit.ADC_A = 1
    assert not bench.adc.clocked
    assert [f.rule for f in bench.findings] == ["locked"]
    bench.sysctrl.reset()
    bench.cpusys.PCLKCR13.bit.ADC_A = 1
    assert bench.adc.clocked


def test_dividers_after_reset_and_when_changed() -> None:
    bench = Bench()
    heard: list[int] = []
    bench.sysctrl.dividers_changed.connect(lambda: heard.append(bench.sysctrl.lspclk_divider))
    # LSPCLK 50 MHz, EPWMCLK 100 MHz out of reset.
    assert (bench.sysctrl.lspclk_divider, bench.sysctrl.lspclk_hz, bench.sysctrl.epwmclk_divider) == (4, 50e6, 2)
    for code, divider in ((0, 1), (1, 2), (3, 6), (7, 14)):
        bench.clkcfg.LOSPCP.bit.LSPCLKDIV = code
        assert bench.sysctrl.lspclk_divider == divider
    bench.clkcfg.PERCLKDIVSEL.bit.EPWMCLKDIV = 0
    assert bench.sysctrl.epwmclk_divider == 1
    assert heard == [1, 2, 6, 14, 14]


def test_TBCLKSYNC_is_told() -> None:
    bench = Bench()
    told: list[bool] = []
    bench.sysctrl.gate("PCLKCR0", "TBCLKSYNC", on_clock=told.append)
    bench.cpusys.PCLKCR0.bit.TBCLKSYNC = 1
    assert (told, bench.sysctrl.tbclksync) == ([False, True], True)


def test_a_soft_reset_acts_once_when_its_bit_rises() -> None:
    bench = Bench()
    resets: list[str] = []
    bench.sysctrl.soft_reset("SOFTPRES13", "ADC_A", lambda: resets.append("A"))
    bench.sysctrl.soft_reset("SOFTPRES13", "ADC_B", lambda: resets.append("B"))
    bench.devcfg.SOFTPRES13.bit.ADC_A = 1
    bench.devcfg.SOFTPRES13.bit.ADC_B = 1
    bench.devcfg.SOFTPRES13.bit.ADC_A = 0
    bench.devcfg.SOFTPRES13.bit.ADC_A = 1
    assert resets == ["A", "B", "A"]


def test_reset_closes_the_gates_and_adds_its_cause() -> None:
    bench = Bench()
    bench.cpusys.PCLKCR13.bit.ADC_A = 1
    bench.cpusys.RESC.all = 0x3
    assert bench.cpusys.RESC.all & 0x1FF == 0
    bench.sysctrl.reset("WDRSn")
    assert not bench.adc.clocked
    assert bench.cpusys.RESC.all & 0x1FF == 0b100
    bench.sysctrl.reset()
    assert bench.cpusys.RESC.all & 0x1FF == 0b011


def test_the_part_looks_calibrated_and_its_PLL_locked() -> None:
    bench = Bench()
    assert bench.analog.ANAREFTRIMA.all == 31709  # the word 0x5D1B6 that start-up code probes
    assert bench.clkcfg.SYSPLLSTS.bit.LOCKS == 1


@pytest.mark.parametrize(
    ("source", "multiplier", "divider", "enabled", "told"),
    [
        (0, 40, 1, 1, ""),  # 10 MHz * 40 / 2
        (2, 20, 0, 1, ""),
        (0, 30, 1, 1, "150 MHz"), (2, 20 | 2 << 8, 0, 1, "205 MHz"),
        (0, 40, 1, 0, "5 MHz"),  # without the PLL
        # Crystals from 10 to 20 MHz: which is there nobody knows.
        (1, 20, 1, 1, ""), (1, 40, 1, 1, ""), (1, 25, 1, 1, ""),
        (1, 18, 1, 1, "90 MHz with a crystal of 10 MHz"), (1, 30, 0, 1, "300 MHz with a crystal of 10 MHz"),
    ],
)  # fmt: skip
def test_a_SYSCLK_that_is_set_to_be_another_is_told(
    source: int, multiplier: int, divider: int, enabled: int, told: str
) -> None:
    bench = Bench()
    bench.clkcfg.CLKSRCCTL1.bit.OSCCLKSRCSEL = source
    bench.clkcfg.SYSPLLMULT.all = multiplier
    bench.clkcfg.SYSCLKDIVSEL.all = divider + 1  # slower for a while, as start-up code has it
    bench.clkcfg.SYSPLLCTL1.bit.PLLCLKEN = enabled
    bench.clock.advance_to(bench.clock.now + 100_000)
    bench.clkcfg.SYSCLKDIVSEL.all = divider
    bench.clock.advance_to(bench.clock.now + 199_999)
    assert list(bench.findings) == []
    bench.clock.advance_to(bench.clock.now + 1)
    message = f"SYSCLK is set to {told}, which is not modelled: it is 200 MHz here"
    assert [f.message for f in bench.findings] == ([message] if told else [])


def test_a_multiplier_turns_the_PLL_on_which_locks_after_a_while() -> None:
    bench = Bench()
    bench.clkcfg.SYSPLLMULT.all = 20
    assert bench.clkcfg.SYSPLLCTL1.bit.PLLEN == 1
    assert bench.clkcfg.SYSPLLSTS.bit.LOCKS == 0
    bench.clock.advance_to(59_999)
    assert bench.clkcfg.SYSPLLSTS.bit.LOCKS == 0
    # 50 us and 2500 periods of 10 MHz: 300 us of 200 cycles
    bench.clock.advance_to(60_000)
    assert bench.clkcfg.SYSPLLSTS.bit.LOCKS == 1
    bench.clkcfg.SYSPLLMULT.all = 20
    bench.clock.advance_to(90_000)
    bench.clkcfg.SYSPLLMULT.all = 20
    bench.clock.advance_to(120_000)
    assert bench.clkcfg.SYSPLLSTS.bit.LOCKS == 0
    bench.clock.advance_to(150_000)
    assert bench.clkcfg.SYSPLLSTS.bit.LOCKS == 1


@pytest.mark.parametrize(
    ("control", "multiplier", "divider", "cycles"),
    [
        (0, 20, 1, 1),  # SYSCLK
        (0 | 3 << 3, 20, 1, 1),  # its prescaler is for the others
        (1, 0, 0, 20),  # the PLL is off: 200 MHz over 10 MHz
        (1, 20, 0, 20), (2, 20, 1, 10), (3, 20, 2, 5), (3, 40, 1, 20), (3, 1, 63, 1),
        (3, 20 | 2 << 8, 1, 10),  # 20.5 / 2 = 10.25
        (1 | 2 << 3, 20, 1, 40), (1 | 4 << 3, 20, 1, 160),
    ],
)  # fmt: skip
def test_an_oscillator_has_the_frequency_that_the_PLL_makes_SYSCLK_of(
    control: int, multiplier: int, divider: int, cycles: int
) -> None:
    bench = Bench()
    told: list[int] = []
    bench.sysctrl.timer2_changed.connect(told.append)
    bench.cpusys.TMR2CLKCTL.all = control
    bench.clkcfg.SYSPLLMULT.all = multiplier
    bench.clkcfg.SYSCLKDIVSEL.all = divider
    assert told[-1] == cycles
    bench.sysctrl.reset()
    assert told[-1] == 1


@pytest.mark.parametrize(
    ("multiplier", "divider", "on", "prescale", "cycles"),
    [
        # SYSCLK is 20 times the oscillator; the second PLL has a multiplier of its own.
        (0, 0, False, 0, 20), (0, 3, False, 0, 160), (12, 1, False, 0, 40), (12, 1, True, 0, 3), (10, 3, True, 2, 64),
        (12 | 2 << 8, 3, True, 0, 13), (127, 0, True, 0, 1),
    ],
)  # fmt: skip
def test_AUXPLLCLK_is_made_of_an_oscillator(
    multiplier: int, divider: int, on: bool, prescale: int, cycles: int
) -> None:
    bench = Bench()
    told: list[int] = []
    bench.sysctrl.timer2_changed.connect(told.append)
    bench.cpusys.TMR2CLKCTL.all = 6 | prescale << 3
    bench.clkcfg.SYSPLLMULT.all = 20
    bench.clkcfg.AUXCLKDIVSEL.all = divider
    bench.clkcfg.AUXPLLMULT.all = multiplier
    bench.clkcfg.AUXPLLCTL1.bit.PLLCLKEN = on
    assert told[-1] == cycles
    assert bench.findings.of("unmodelled") == []


@pytest.mark.parametrize("source", [4, 5, 7])
def test_a_reserved_clock_of_timer_2_is_told(source: int) -> None:
    bench = Bench()
    bench.cpusys.TMR2CLKCTL.bit.TMR2CLKSRCSEL = source
    assert [f.object for f in bench.findings.of("unmodelled")] == ["CpuSysRegs.TMR2CLKCTL.TMR2CLKSRCSEL"]
    assert bench.sysctrl.timer2_cycles == 1


def test_a_gate_that_does_not_exist_is_refused() -> None:
    bench = Bench()
    with pytest.raises(ValueError, match="ADC_E is no gate"):
        bench.sysctrl.gate("PCLKCR13", "ADC_E", bench.adc)
    with pytest.raises(ValueError, match="LOSPCP"):
        bench.sysctrl.gate("LOSPCP", "LSPCLKDIV", bench.adc)
    with pytest.raises(ValueError, match="reset cause FIRE"):
        bench.sysctrl.reset("FIRE")
