"""ADCINT1 to 4: which end of a conversion raises them, what clears them, what is lost."""

from __future__ import annotations

import pytest

from tests.emulator.peripherals.adc_bench import EOC, LAT, WINDOW, Bench


def test_only_the_chosen_SOC_raises_the_interrupt() -> None:
    bench = Bench()
    bench.interrupt_1_on(1)
    bench.regs.ADCINTSEL3N4.bit.INT4SEL = 0
    bench.regs.ADCINTSEL3N4.bit.INT4E = 1
    bench.regs.ADCSOCFRC1.all = 0x0003
    bench.at(EOC)
    assert bench.regs.ADCINTFLG.all == 0b1000
    bench.at(EOC + WINDOW + 41)
    assert bench.regs.ADCINTFLG.all == 0b1001
    assert [n for n, _ in bench.pulses] == [4, 1]


@pytest.mark.parametrize(("cont", "pulses"), [(0, 1), (1, 3)])
def test_an_uncleared_flag_overflows_and_pulses_only_with_CONT(cont: int, pulses: int) -> None:
    bench = Bench()
    bench.interrupt_1_on(0, cont)
    for k in range(3):
        bench.regs.ADCSOCFRC1.all = 1
        bench.at(1000 * (k + 1))
    assert (bench.regs.ADCINTFLG.all, bench.regs.ADCINTOVF.all, len(bench.pulses)) == (1, 1, pulses)
    bench.regs.ADCINTFLGCLR.bit.ADCINT1 = 1
    bench.regs.ADCINTOVFCLR.bit.ADCINT1 = 1
    assert (bench.regs.ADCINTFLG.all, bench.regs.ADCINTOVF.all) == (0, 0)
    assert (bench.regs.ADCINTFLGCLR.all, bench.regs.ADCINTOVFCLR.all) == (0, 0)


def test_clearing_one_flag_leaves_the_others() -> None:
    bench = Bench()
    bench.regs.registers["ADCINTFLG"].value = 0b1111
    bench.regs.ADCINTFLGCLR.bit.ADCINT2 = 1
    assert bench.regs.ADCINTFLG.all == 0b1101


@pytest.mark.parametrize(("collision", "flag", "overflow"), [("cleared", 0, 0), ("erratum", 1, 0), ("overflow", 0, 1)])
def test_a_clear_in_the_cycle_of_the_EOC(collision: str, flag: int, overflow: int) -> None:
    bench = Bench(flag_collision=collision)
    bench.interrupt_1_on(0)
    bench.regs.ADCSOCFRC1.all = 1
    bench.at(EOC)
    bench.regs.ADCINTFLGCLR.bit.ADCINT1 = 1
    assert (bench.regs.ADCINTFLG.all, bench.regs.ADCINTOVF.all) == (flag, overflow)
    bench.at(EOC + 1)
    bench.regs.ADCINTFLGCLR.bit.ADCINT1 = 1
    assert bench.regs.ADCINTFLG.all == 0


def test_a_stalled_flag_stops_a_loop_of_retriggers() -> None:
    bench = Bench()
    bench.regs.ADCINTSOCSEL1.bit.SOC0 = 1
    bench.interrupt_1_on(0, cont=0)
    bench.regs.ADCSOCFRC1.all = 1
    bench.at(5000)
    # The first EOC pulses and re-triggers; the second finds the flag set and does not.
    assert bench.adc.conversions == 2


def test_a_flag_that_is_not_cleared_swallows_the_next_interrupt() -> None:
    bench = Bench()
    bench.interrupt_1_on(0)
    for _ in range(2):
        bench.regs.ADCSOCFRC1.all = 1
        bench.clock.charge(LAT)
    assert [finding.object for finding in bench.findings.of("flag-not-cleared")] == ["AdcaRegs.ADCINTFLG.ADCINT1"]
    assert len(bench.pulses) == 1
    continuous = Bench()
    continuous.interrupt_1_on(0, cont=1)
    for _ in range(2):
        continuous.regs.ADCSOCFRC1.all = 1
        continuous.clock.charge(LAT)
    assert not continuous.findings.of("flag-not-cleared")
    assert len(continuous.pulses) == 2
