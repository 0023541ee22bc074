"""SOCs of the ADC: their order, triggers, bursts and overflows."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.emulator.peripherals.adc_bench import SYNC, WINDOW, Bench


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
    with pytest.raises(ValueError, match=r"hardware trigger 0: expected 1\.\.28"):
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


def test_reset_forgets_pointer_pending_and_results() -> None:
    bench = Bench()
    order(bench, 1 << 3)
    bench.regs.ADCSOCFRC1.all = 0x00FF
    bench.adc.reset()
    assert (bench.regs.ADCSOCFLG1.all, bench.result(3), bench.regs.ADCSOCPRICTL.all) == (0, 0, 0x0200)
    done = bench.adc.conversions
    bench.clock.charge(10_000)
    assert bench.adc.conversions == done
