"""CPU timer: period (PRD+1)*(TDDR+1) cycles, lazily computed counters, flag, interrupt."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.findings import Findings
from emulator.clock import NEVER, Clock
from emulator.cpu import Cpu
from emulator.peripherals.cpu_timer import CpuTimer
from emulator.registers.cpu_timer import CpuTimerRegs


class Bench:
    def __init__(self, **options: Any) -> None:
        self.clock = Clock()
        self.findings = Findings(self.clock)
        self.cpu = Cpu(self.clock, self.findings)
        self.regs = CpuTimerRegs("CpuTimer0Regs", 0x0C00, self.cpu)
        self.pulses: list[int] = []
        self.timer = CpuTimer(self.clock, self.cpu, self.regs, lambda: self.pulses.append(self.clock.now), **options)

    def start(self, prd: int, tddr: int = 0, tcr: int = 0x4000) -> None:
        """As ConfigCpuTimer and StartCpuTimer: stop, period, reload, then run (0x4000: TIE)."""
        self.regs.TCR.bit.TSS = 1
        self.regs.PRD.all = prd
        self.regs.TPR.all = tddr & 0xFF
        self.regs.TPRH.all = tddr >> 8
        self.regs.TCR.bit.TRB = 1
        self.regs.TCR.all = tcr


def test_the_interrupt_comes_every_PRD_plus_1_times_TDDR_plus_1_cycles() -> None:
    bench = Bench()
    bench.clock.charge(123)
    bench.start(prd=99, tddr=3)
    for _ in range(3):
        bench.clock.advance_to(bench.clock.now + 400)
    assert bench.pulses == [123 + 400, 123 + 800, 123 + 1200]


def test_a_timer_runs_right_out_of_reset_and_sets_only_its_flag() -> None:
    bench = Bench()
    assert bench.regs.TCR.bit.TSS == 0
    bench.clock.charge(0xFFFF)
    assert (bench.regs.TIM.all, bench.regs.TCR.bit.TIF) == (0, 0)
    bench.clock.charge(1)
    # With its flag set nothing changes any more, so nothing is scheduled.
    assert bench.clock.next == NEVER
    assert (bench.regs.TIM.all, bench.regs.TCR.bit.TIF, bench.pulses) == (0xFFFF, 1, [])
    # Who has seen the flag once goes on at the next underflow, behind which it is an old one.
    assert bench.clock.next == bench.clock.now + 65536
    bench.clock.charge(65536 + 5)
    assert bench.clock.next == NEVER
    assert bench.regs.TIM.all == 0xFFFF - 5


def test_the_flag_is_cleared_by_writing_1_and_rises_again_at_the_next_underflow() -> None:
    bench = Bench()
    bench.start(prd=9, tcr=0)
    bench.clock.charge(25)
    assert bench.regs.TCR.bit.TIF == 1
    bench.regs.TCR.bit.TIF = 1
    assert bench.regs.TCR.bit.TIF == 0
    bench.clock.charge(4)
    assert bench.regs.TCR.bit.TIF == 0
    bench.clock.charge(1)
    assert bench.regs.TCR.bit.TIF == 1


@pytest.mark.parametrize(("clears", "word"), [(True, None), (False, None), (False, 0x4000), (True, 0xC000)])
def test_a_flag_that_is_read_at_two_underflows_and_never_cleared_is_told(clears: bool, word: int | None) -> None:
    """A word without TIF, as of `TCR.all &= ~TIF`, clears nothing."""
    bench = Bench()
    bench.start(prd=9, tcr=0)
    for n in range(1, 4):
        bench.clock.advance_to(10 * n)
        assert bench.regs.TCR.bit.TIF == 1
        assert bench.regs.TCR.bit.TIF == 1  # twice for one underflow
        if word is not None:
            bench.regs.TCR.all = word
        elif clears:
            bench.regs.TCR.bit.TIF = 1
    told = bench.findings.of("flag-not-cleared")
    assert [finding.object for finding in told] == ([] if clears else ["CpuTimer0Regs.TCR.TIF"])


def test_a_read_modify_write_of_TCR_clears_a_pending_flag() -> None:
    bench = Bench()
    bench.start(prd=9, tcr=0)
    bench.clock.charge(10)
    bench.regs.TCR.bit.TIE = 1
    assert bench.regs.TCR.bit.TIF == 0


def test_stop_holds_the_counters_and_run_goes_on() -> None:
    bench = Bench()
    bench.start(prd=99, tddr=9)
    bench.clock.charge(123)
    bench.regs.TCR.bit.TSS = 1
    # 123 cycles: 12 prescaler underflows (from 9, each 10 cycles) and 3 more counts.
    assert (bench.regs.TIM.all, bench.regs.TPR.bit.PSC) == (99 - 12, 9 - 3)
    bench.clock.charge(5000)
    assert (bench.regs.TIM.all, bench.regs.TPR.bit.PSC) == (87, 6)
    bench.regs.TCR.bit.TSS = 0
    bench.clock.charge(1000 - 123 - 1)
    assert bench.pulses == []
    bench.clock.charge(1)
    assert bench.pulses == [6123 - 123]


def test_reload_restarts_the_period_and_reads_0() -> None:
    bench = Bench()
    bench.start(prd=99)
    bench.clock.charge(60)
    bench.regs.TCR.all = 0x4020
    assert (bench.regs.TIM.all, bench.regs.TCR.bit.TRB) == (99, 0)
    bench.clock.charge(99)
    assert bench.pulses == []
    bench.clock.charge(1)
    assert bench.pulses == [160]


def test_a_new_period_takes_effect_at_the_next_reload() -> None:
    bench = Bench()
    bench.start(prd=99)
    bench.clock.charge(10)
    bench.regs.PRD.all = 49
    bench.clock.advance_to(200)
    assert bench.pulses == [100, 150, 200]


def test_writing_half_of_TIM_keeps_the_other_half() -> None:
    bench = Bench()
    bench.regs.TCR.bit.TSS = 1
    bench.regs.TIM.all = 0x12345678
    bench.regs.TIM.bit.LSW = 0xAAAA
    assert bench.regs.TIM.all == 0x1234AAAA


def test_a_stopped_clock_freezes_the_counter() -> None:
    bench = Bench()
    bench.start(prd=99)
    bench.clock.charge(40)
    bench.timer.set_clock(False)
    bench.clock.charge(1000)
    bench.timer.set_clock(True)
    assert bench.regs.TIM.all == 59
    bench.clock.charge(60)
    assert bench.pulses == [1100]


@pytest.mark.parametrize(("needs_tie", "triggers"), [(True, []), (False, [10, 20, 30])])
def test_the_trigger_to_the_ADC_may_need_TIE(needs_tie: bool, triggers: list[int]) -> None:
    seen: list[int] = []
    bench = Bench(trigger=lambda: seen.append(bench.clock.now), trigger_needs_tie=needs_tie)
    bench.start(prd=9, tcr=0)
    bench.clock.advance_to(30)
    assert seen == triggers
    assert bench.pulses == []


@given(st.integers(0, 20), st.integers(0, 300), st.lists(st.integers(1, 700), min_size=1, max_size=20), st.booleans())
def test_lazy_counters_equal_counting_cycle_by_cycle(prd: int, tddr: int, steps: list[int], tie: bool) -> None:
    bench = Bench()
    bench.start(prd, tddr, 0x4000 if tie else 0)
    tim, psc, underflows = prd, tddr, []
    now = 0
    for step in steps:
        for _ in range(step):
            now += 1
            if psc:
                psc -= 1
                continue
            psc = tddr
            if tim:
                tim -= 1
            else:
                tim = prd
                underflows.append(now)
        bench.clock.charge(step)
        assert bench.regs.TIM.all == tim
        assert psc == bench.regs.TPRH.bit.PSCH << 8 | bench.regs.TPR.bit.PSC
        assert bool(underflows) == bench.regs.TCR.bit.TIF
    assert bench.pulses == (underflows if tie else [])


@given(
    tick=st.integers(1, 40), prd=st.integers(0, 200), tddr=st.integers(0, 20), after=st.integers(0, 20_000),
)  # fmt: skip
def test_a_slower_clock_stretches_every_count(tick: int, prd: int, tddr: int, after: int) -> None:
    slow, fast = Bench(), Bench()
    slow.timer.set_tick(tick)
    for bench in (slow, fast):
        bench.start(prd, tddr)
    began = slow.clock.now
    slow.clock.advance_to(began + after)
    # The other timer counts SYSCLK, so many cycles as whole periods of the slow clock have passed
    fast.clock.advance_to(fast.clock.now + after // tick)
    assert slow.regs.TIM.all == fast.regs.TIM.all
    assert slow.regs.TPR.all == fast.regs.TPR.all
    assert slow.regs.TPRH.all == fast.regs.TPRH.all
    assert len(slow.pulses) == len(fast.pulses)
    period = (prd + 1) * (tddr + 1) * tick
    assert slow.pulses == [began + n * period for n in range(1, after // period + 1)]


def test_a_timer_takes_another_clock_while_it_runs() -> None:
    bench = Bench()
    bench.start(prd=99)
    began = bench.clock.now
    bench.clock.advance_to(began + 40)
    bench.timer.set_tick(10)
    # 60 counts are left: 40 of the 100 have passed
    bench.clock.advance_to(began + 40 + 599)
    assert bench.pulses == []
    bench.clock.advance_to(began + 40 + 600)
    assert bench.pulses == [began + 640]
    bench.timer.set_tick(1)
    bench.clock.advance_to(began + 740)
    assert bench.pulses == [began + 640, began + 740]
