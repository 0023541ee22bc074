"""ADC in register language.  Times are SYSCLK cycles of the data sheet: PRESCALE 6, 12 bits: tEOC 41, tLAT 44."""

from __future__ import annotations

from random import Random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

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
        pins = [AnalogWire(f"ADCIN{n}", lambda _cycles, n=n: self.volts[n]) for n in range(16)]
        pulses = [lambda n=n: self.pulses.append((n + 1, self.clock.now)) for n in range(4)]
        self.adc = Adc(self.clock, self.cpu, self.regs, self.results, pins, pulses, **options)
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
    bench.adc._converter.pins[2].source = lambda cycles: seen.append(cycles) or 0.75  # type: ignore[func-returns-value]
    bench.regs.ADCSOCFRC1.all = 1 << 2
    bench.at(LAT)
    assert seen == [bench.start + SYNC + WINDOW]
    assert bench.result(2) == 1024


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


@pytest.mark.parametrize(
    ("collision", "flag", "overflow"), [("cleared", 0, 0), ("erratum", 1, 0), ("overflow", 0, 1)]
)
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


def order(bench: Bench, socs: int) -> list[int]:
    """The order in which `socs`, forced together, are converted."""
    done: list[int] = []
    bench.adc.force_codes(lambda soc: done.append(soc) or soc)  # type: ignore[func-returns-value]
    bench.regs.ADCSOCFRC1.all = socs
    bench.clock.charge(16 * (WINDOW + 41) + SYNC + 10)
    return done


def test_SOC0_comes_first_after_reset_and_the_order_turns_after_a_lone_SOC0() -> None:
    bench = Bench()
    assert bench.regs.ADCSOCPRICTL.bit.RRPOINTER == 16
    assert order(bench, 0x0003) == [0, 1]
    assert bench.regs.ADCSOCPRICTL.bit.RRPOINTER == 1
    assert order(bench, 0x0003) == [0, 1]
    assert order(bench, 0x0001) == [0]
    assert order(bench, 0x0003) == [1, 0], "highest priority is RRPOINTER + 1"
    assert order(bench, 0x0003) == [1, 0], "and it stays reversed"


def test_high_priority_goes_first_and_leaves_the_pointer() -> None:
    bench = Bench()
    bench.regs.ADCSOCPRICTL.bit.SOCPRIORITY = 2
    assert order(bench, 1 << 6) == [6]
    assert order(bench, 0x00C3) == [0, 1, 7, 6]
    assert bench.regs.ADCSOCPRICTL.bit.RRPOINTER == 6


def test_the_reset_word_returns_the_pointer() -> None:
    bench = Bench()
    order(bench, 1 << 6)
    bench.regs.ADCSOCPRICTL.all = 0x0000
    assert bench.regs.ADCSOCPRICTL.bit.RRPOINTER == 6
    bench.regs.ADCSOCPRICTL.all = 0x0200
    assert bench.regs.ADCSOCPRICTL.bit.RRPOINTER == 16


@given(st.lists(st.integers(1, 0xFFFF), min_size=1, max_size=8), st.integers(0, 16))
def test_arbiter_against_a_plain_model(batches: list[int], priority: int) -> None:
    """High priority: lowest number first.  Others: upwards from the last one converted, wrapping at 15."""
    bench = Bench()
    bench.regs.ADCSOCPRICTL.bit.SOCPRIORITY = priority
    last = 15
    for socs in batches:
        expected = [n for n in range(priority) if socs >> n & 1]
        ring = [n for n in [(last + 1 + k) % 16 for k in range(16)] if n >= priority and socs >> n & 1]
        assert order(bench, socs) == expected + ring
        last = ring[-1] if ring else last


def test_a_SOC_forced_while_pending_overflows_and_converts_once() -> None:
    bench = Bench()
    bench.regs.ADCSOCFRC1.all = 0x0003
    bench.at(1)
    bench.regs.ADCSOCFRC1.all = 0x0001
    assert bench.regs.ADCSOCOVF1.all == 0x0001, "its window has not opened yet"
    bench.at(SYNC + 1)
    bench.regs.ADCSOCFRC1.all = 0x0003
    assert bench.regs.ADCSOCOVF1.all == 0x0003, "SOC1 waits; SOC0 samples, so that its new request is no overflow"
    bench.at(2000)
    assert bench.adc.conversions == 3
    bench.regs.ADCSOCOVFCLR1.bit.SOC1 = 1
    assert bench.regs.ADCSOCOVF1.all == 0x0001


def test_a_high_priority_SOC_forced_before_the_window_opens_wins() -> None:
    bench = Bench()
    bench.regs.ADCSOCPRICTL.bit.SOCPRIORITY = 1
    done: list[int] = []
    bench.adc.force_codes(lambda soc: done.append(soc) or 0)  # type: ignore[func-returns-value]
    bench.regs.ADCSOCFRC1.all = 1 << 3
    bench.at(1)
    bench.regs.ADCSOCFRC1.all = 1
    bench.at(1000)
    assert done == [0, 3]
    assert bench.regs.ADCSOCPRICTL.bit.RRPOINTER == 3


def test_a_hardware_trigger_starts_the_SOCs_that_select_it() -> None:
    bench = Bench()
    bench.soc(4).bit.TRIGSEL = 7  # ePWM2 SOCA
    bench.soc(9).bit.TRIGSEL = 7
    bench.soc(10).bit.TRIGSEL = 8
    bench.adc.trigger(7)
    assert bench.regs.ADCSOCFLG1.all == 1 << 4 | 1 << 9
    with pytest.raises(ValueError, match=r"hardware trigger 0: want 1\.\.28"):
        bench.adc.trigger(0)


def test_a_burst_takes_round_robin_SOCs_after_the_pointer_and_ignores_their_TRIGSEL() -> None:
    bench = Bench()
    bench.regs.ADCSOCPRICTL.bit.SOCPRIORITY = 12
    for n in range(16):
        bench.soc(n).bit.TRIGSEL = 5
    bench.regs.ADCBURSTCTL.all = 0x8000 | 2 << 8 | 9
    done: list[int] = []
    bench.adc.force_codes(lambda soc: done.append(soc) or 0)  # type: ignore[func-returns-value]
    bench.adc.trigger(9)
    bench.clock.charge(2000)
    assert done == [12, 13, 14]
    bench.adc.trigger(9)
    bench.clock.charge(2000)
    assert done == [12, 13, 14, 15, 12, 13]
    bench.adc.trigger(5)
    bench.clock.charge(2000)
    assert done[6:] == list(range(12)), "high priority SOCs keep their TRIGSEL"


def test_a_stalled_flag_stops_a_loop_of_retriggers() -> None:
    bench = Bench()
    bench.regs.ADCINTSOCSEL1.bit.SOC0 = 1
    bench.interrupt_1_on(0, cont=0)
    bench.regs.ADCSOCFRC1.all = 1
    bench.at(5000)
    # The first EOC pulses and re-triggers; the second finds the flag set and does not.
    assert bench.adc.conversions == 2


@pytest.mark.parametrize(
    ("volts", "code"), [(0.0, 0), (-0.2, 0), (3.0 / 4096, 1), (2.9999, 4095), (3.0, 4095), (3.3, 4095)]
)
def test_code_is_the_floor_of_the_ratio_clamped(volts: float, code: int) -> None:
    bench = Bench()
    bench.volts[0] = volts
    bench.regs.ADCSOCFRC1.all = 1
    bench.at(LAT)
    assert bench.result(0) == code


def test_16_bits_differential_measures_between_the_pins_of_a_pair() -> None:
    bench = Bench()
    bench.regs.ADCCTL2.all = 0x00C6
    bench.soc(0).bit.ACQPS = 63
    bench.soc(0).bit.CHSEL = 2
    bench.volts[2], bench.volts[3] = 2.0, 1.25
    bench.regs.ADCSOCFRC1.all = 1
    bench.at(SYNC + 64 + 120)
    assert bench.result(0) == 40960  # 65536 * (0.75 + 3) / 6
    assert len(bench.findings) == 0


def test_noise_is_seeded_and_centred() -> None:
    def codes(seed: int) -> list[int]:
        bench = Bench(noise_lsb=2.0, random=Random(seed))
        bench.volts[0] = 1.5
        taken = []
        for _ in range(200):
            bench.regs.ADCSOCFRC1.all = 1
            bench.clock.charge(LAT)
            taken.append(bench.result(0))
        return taken

    assert codes(1) == codes(1)
    assert codes(1) != codes(2)
    # Mean 2048 - 0.5 (floor), sigma 2/sqrt(200) = 0.14: five sigma.
    assert abs(sum(codes(1)) / 200 - 2047.5) < 0.7


def test_forced_codes_come_in_order_and_may_exceed_12_bits() -> None:
    bench = Bench()
    bench.volts[0] = 1.0
    bench.adc.force_codes([5, 40000])
    for expected in (5, 40000):
        bench.regs.ADCSOCFRC1.all = 1
        bench.clock.charge(LAT)
        assert bench.result(0) == expected
    bench.regs.ADCSOCFRC1.all = 1
    with pytest.raises(ValueError, match="no forced code is left for the conversion of SOC0"):
        bench.clock.charge(LAT)


@pytest.mark.parametrize("wait_us", [0, 499])
def test_a_conversion_before_500_us_of_power_is_garbage_and_a_finding(wait_us: int) -> None:
    bench = Bench(powered=False)
    bench.volts[0] = 1.5
    if wait_us:
        bench.regs.ADCCTL1.bit.ADCPWDNZ = 1
        bench.clock.charge(wait_us * CYCLES_PER_US)
    bench.regs.ADCSOCFRC1.all = 1
    bench.clock.charge(LAT)
    assert [f.rule for f in bench.findings] == ["adc-not-powered"]
    assert bench.result(0) == Random(0).randrange(4096)


def test_limits_that_no_chip_reports_are_findings() -> None:
    bench = Bench()
    bench.soc(0).bit.ACQPS = 13
    bench.regs.ADCCTL2.all = 0x0085
    bench.regs.ADCSOCFRC1.all = 1
    assert [f.rule for f in bench.findings] == ["adc-window", "adc-clock", "adc-mode"]


def test_a_dead_converter_never_ends_and_a_mended_one_goes_on() -> None:
    bench = Bench()
    bench.interrupt_1_on(0)
    bench.adc.dead = True
    bench.regs.ADCSOCFRC1.all = 1
    bench.at(100_000)
    assert (bench.adc.conversions, bench.regs.ADCSOCFLG1.all, bench.clock.poll(6)) == (0, 1, False)
    bench.adc.dead = False
    bench.clock.charge(EOC)
    assert (bench.adc.conversions, bench.regs.ADCINTFLG.all) == (1, 1)


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


def test_reset_forgets_pointer_pending_and_results() -> None:
    bench = Bench()
    order(bench, 1 << 3)
    bench.regs.ADCSOCFRC1.all = 0x00FF
    bench.adc.reset()
    assert (bench.regs.ADCSOCFLG1.all, bench.result(3), bench.regs.ADCSOCPRICTL.all) == (0, 0, 0x0200)
    done = bench.adc.conversions
    bench.clock.charge(10_000)
    assert bench.adc.conversions == done


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


def test_touching_a_post_processing_block_is_reported() -> None:
    bench = Bench()
    bench.regs.ADCPPB1CONFIG.bit.CONFIG = 3
    assert bench.results.ADCPPB1RESULT.all == 0
    assert [f.object for f in bench.findings.of("unmodelled")] == [
        "AdcaRegs.ADCPPB1CONFIG.CONFIG", "AdcaResultRegs.ADCPPB1RESULT",
    ]  # fmt: skip


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
    with pytest.raises(ValueError, match="want 0 or more, and a random"):
        Bench(noise_lsb=1.0)


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
