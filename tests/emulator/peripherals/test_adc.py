"""ADC in register language: times of a conversion, power, clock, reset.  Times are SYSCLK cycles of the data sheet."""

from __future__ import annotations

import pytest

from emulator.clock import NEVER
from tests.emulator.peripherals.adc_bench import EOC, LAT, SYNC, WINDOW, Bench


def test_the_late_flag_rises_at_tEOC_and_the_result_latches_at_tLAT() -> None:
    bench = Bench()
    bench.interrupt_1_on(0)
    bench.volts[0] = 1.5
    bench.regs.ADCSOCFRC1.all = 0x0001
    bench.at(EOC - 1)
    assert bench.regs.ADCINTFLG.all == 0
    bench.at(EOC)
    assert bench.regs.ADCINTFLG.bit.ADCINT1 == 1
    bench.at(LAT - 1)
    assert bench.result(0) == 0, "the result file holds the previous value until tLAT"
    bench.at(LAT)
    assert bench.result(0) == 2048  # 4096 * 1.5 V / 3.0 V
    assert bench.pulses == [(1, bench.start + EOC)]


@pytest.mark.parametrize(
    ("prescale", "resolution", "t_eoc", "t_lat"),
    # Data sheet rows, 12-bit and 16-bit.
    [(6, 0, 41, 44), (7, 0, 46, 49), (15, 0, 86, 91), (2, 0, 21, 23), (6, 1, 119, 120), (12, 1, 208, 209)],
)
def test_conversion_times_follow_the_data_sheet(prescale: int, resolution: int, t_eoc: int, t_lat: int) -> None:
    bench = Bench()
    bench.adc.force_codes([7])
    bench.regs.ADCCTL2.all = resolution << 7 | resolution << 6 | prescale
    bench.soc(0).bit.ACQPS = 99
    bench.interrupt_1_on(0)
    bench.regs.ADCSOCFRC1.all = 1
    bench.at(SYNC + 100 + t_eoc - 1)
    assert bench.regs.ADCINTFLG.all == 0
    bench.at(SYNC + 100 + t_eoc)
    assert bench.regs.ADCINTFLG.all == 1
    bench.at(SYNC + 100 + t_lat)
    assert bench.result(0) == 7


def test_the_early_flag_rises_one_cycle_after_the_window() -> None:
    bench = Bench()
    bench.regs.ADCCTL1.bit.INTPULSEPOS = 0
    bench.interrupt_1_on(0)
    bench.volts[0] = 3.0
    bench.regs.ADCSOCFRC1.all = 0x0003
    bench.at(SYNC + WINDOW)
    assert bench.regs.ADCINTFLG.all == 0
    bench.at(SYNC + WINDOW + 1)
    assert bench.regs.ADCINTFLG.all == 1
    bench.at(LAT - 1)
    assert bench.result(0) == 0
    bench.at(LAT)
    assert bench.result(0) == 4095
    # The second begins at the first one's tEOC.
    bench.at(EOC + WINDOW + 41)
    assert bench.adc.conversions == 2


def test_the_pending_flag_falls_when_sampling_starts() -> None:
    bench = Bench()
    bench.regs.ADCSOCFRC1.all = 0x0003
    assert bench.regs.ADCSOCFLG1.all == 0x0003
    bench.at(SYNC)
    assert bench.regs.ADCSOCFLG1.all == 0x0002, "SOC0 samples, SOC1 waits"
    bench.at(EOC - 1)
    assert bench.regs.ADCSOCFLG1.all == 0x0002
    bench.at(EOC)
    assert bench.regs.ADCSOCFLG1.all == 0


def test_busy_lasts_from_the_window_until_4_ADCCLK_after_it() -> None:
    bench = Bench()
    bench.regs.ADCSOCFRC1.all = 1 << 5
    assert bench.regs.ADCCTL1.bit.ADCBSY == 0
    bench.at(SYNC)
    assert (bench.regs.ADCCTL1.bit.ADCBSY, bench.regs.ADCCTL1.bit.ADCBSYCHN) == (1, 5)
    # 4 ADCCLK of 4 SYSCLK each.
    bench.at(SYNC + WINDOW + 15)
    assert bench.regs.ADCCTL1.bit.ADCBSY == 1
    bench.at(SYNC + WINDOW + 16)
    assert (bench.regs.ADCCTL1.bit.ADCBSY, bench.regs.ADCCTL1.bit.ADCBSYCHN) == (0, 5)


def test_back_to_back_conversions_take_window_and_tEOC_each() -> None:
    bench = Bench()
    bench.soc(0).bit.ACQPS = 14
    bench.regs.ADCINTSOCSEL1.bit.SOC0 = 1
    bench.interrupt_1_on(0, cont=1)
    bench.regs.ADCSOCFRC1.all = 1
    # 15 + 41 = 56 SYSCLK a conversion, 3.57 MSPS (data sheet example).
    bench.at(SYNC + 56 * 10)
    assert bench.adc.conversions == 10
    assert [time - bench.start for _, time in bench.pulses] == [SYNC + 56 * k for k in range(1, 11)]


def test_a_sample_is_what_stood_at_the_pin_when_the_window_closed() -> None:
    bench = Bench()
    seen: list[int] = []
    bench.adc._converter.pins[2].follow("test", lambda cycles: seen.append(cycles) or 0.75)  # type: ignore[func-returns-value]
    bench.regs.ADCSOCFRC1.all = 1 << 2
    bench.at(LAT)
    assert seen == [bench.start + SYNC + WINDOW]
    assert bench.result(2) == 1024


def test_a_dead_converter_never_ends_and_a_mended_one_goes_on() -> None:
    bench = Bench()
    bench.interrupt_1_on(0)
    bench.adc.stopped_by_fault = True
    bench.regs.ADCSOCFRC1.all = 1
    bench.at(100_000)
    assert (bench.adc.conversions, bench.regs.ADCSOCFLG1.all, bench.clock.poll(6)) == (0, 1, NEVER)
    bench.adc.stopped_by_fault = False
    bench.clock.charge(EOC)
    assert (bench.adc.conversions, bench.regs.ADCINTFLG.all) == (1, 1)


def test_what_several_keep_from_converting_goes_on_when_the_last_is_over() -> None:
    bench = Bench()
    first, second = bench.adc.stop_converting(), bench.adc.stop_converting()
    bench.regs.ADCSOCFRC1.all = 1
    first()
    bench.at(100_000)
    assert bench.adc.stopped_by_fault
    assert not bench.adc.conversions
    second()
    bench.clock.charge(EOC)
    assert bench.adc.conversions == 1


def test_stopping_the_clock_freezes_a_conversion() -> None:
    bench = Bench()
    bench.interrupt_1_on(0)
    bench.regs.ADCSOCFRC1.all = 1
    bench.at(30)
    before = bench.regs.ADCCOUNTER.bit.FREECOUNT
    bench.adc.set_clock(False)
    bench.at(10_030)
    assert bench.regs.ADCINTFLG.all == 0
    bench.adc.set_clock(True)
    after = bench.regs.ADCCOUNTER.bit.FREECOUNT
    assert after == before
    bench.at(10_000 + EOC - 1)
    assert bench.regs.ADCINTFLG.all == 0
    bench.at(10_000 + EOC)
    assert bench.regs.ADCINTFLG.all == 1


def test_a_stopped_clock_holds_back_the_latch_of_a_result() -> None:
    bench = Bench()
    bench.volts[0] = 1.5
    bench.regs.ADCSOCFRC1.all = 1
    bench.at(EOC + 1)
    bench.adc.set_clock(False)
    bench.at(1001 + EOC)
    bench.adc.set_clock(True)
    bench.at(1000 + LAT - 1)
    assert bench.result(0) == 0
    bench.at(1000 + LAT)
    assert bench.result(0) == 2048


@pytest.mark.parametrize("before", [False, True], ids=["first", "again"])
def test_a_conversion_forced_behind_the_eoc_leaves_the_latch_of_the_one_before(before: bool) -> None:
    # TRM: an ADCRESULT latches at tLAT, whatever the S/H does from tEOC on.
    bench = Bench()
    bench.adc.force_codes([10] * before + [11, 22, 33])
    if before:
        bench.regs.ADCSOCFRC1.all = 1 << 2  # SOC2 has begun once: forced alone, it needs no arbiter
    bench.at(1000)
    bench.regs.ADCSOCFRC1.all = 1 << 1
    bench.at(2000)
    bench.regs.ADCSOCFRC1.all = 1 << 1
    bench.at(2000 + EOC)
    bench.regs.ADCSOCFRC1.all = 1 << 2
    bench.at(2000 + LAT - 1)
    assert bench.result(1) == 11
    bench.at(2000 + LAT)
    assert bench.result(1) == 22


def test_configuration_needs_EALLOW_and_forcing_does_not() -> None:
    bench = Bench()
    bench.cpu.eallow = False
    bench.soc(0).bit.CHSEL = 7
    bench.regs.ADCSOCFRC1.all = 1
    assert bench.soc(0).bit.CHSEL == 0
    assert bench.regs.ADCSOCFLG1.all == 1
    assert [f.rule for f in bench.findings] == ["eallow"]


def test_a_misspelt_field_is_an_error() -> None:
    bench = Bench()
    with pytest.raises(AttributeError):
        bench.regs.ADCCTL2.bit.PRESCLE = 6  # type: ignore[attr-defined]


def test_what_nothing_computes_is_reported() -> None:
    bench = Bench()
    bench.regs.ADCEVTSEL.bit.PPB1TRIPHI = 1
    assert bench.regs.ADCREV.all == 0
    assert [f.object for f in bench.findings.of("unmodelled")] == ["AdcaRegs.ADCEVTSEL.PPB1TRIPHI", "AdcaRegs.ADCREV"]


def test_one_clock_event_a_conversion() -> None:
    bench = Bench()
    bench.interrupt_1_on(0)
    before = bench.clock.events_run
    for _ in range(10):
        bench.regs.ADCSOCFRC1.all = 1
        bench.clock.charge(LAT)
        assert bench.result(0) == 0
    assert bench.clock.events_run - before == 10


def test_impossible_construction_is_refused() -> None:
    with pytest.raises(ValueError, match="must lie above"):
        Bench(vrefhi_v=1.0, vreflo_v=1.0)
    with pytest.raises(ValueError, match="expected 0 or more, and a random"):
        Bench(noise_lsb=1.0)
