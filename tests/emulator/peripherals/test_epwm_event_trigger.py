"""Events of the ePWM: interrupt and conversions triggered."""

from __future__ import annotations

import pytest

from tests.emulator.peripherals.epwm_bench import (
    DOWN,
    UP,
    UP_DOWN,
    Bench,
)


@pytest.fixture
def bench() -> Bench:
    return Bench()


@pytest.mark.parametrize(
    ("mode", "select", "expected"),
    [
        (UP, 1, [10, 20, 30]),       # zero
        (UP, 2, [9, 19, 29]),        # period
        (UP, 3, [9, 10, 19, 20, 29, 30]),
        (UP, 4, [3, 13, 23, 33]),    # CMPA up
        (UP, 5, []),                 # no down count
        (UP_DOWN, 4, [3, 21]),       # period of 18: 3, 3 + 18
        (UP_DOWN, 5, [15, 33]),      # 18 - 3
        (UP_DOWN, 7, [13, 31]),      # CMPB down: 18 - 5
        (DOWN, 5, [7, 17, 27]),      # 0, then 9 at 1: CTR = 3 six later
    ],
)  # fmt: skip
def test_each_selection_triggers_at_its_events(bench: Bench, mode: int, select: int, expected: list[int]) -> None:
    bench.start(mode, 9, a=3, b=5)
    bench.regs.ETPS.bit.SOCAPRD = 1
    bench.regs.ETSEL.bit.SOCASEL = select
    bench.regs.ETSEL.bit.SOCAEN = 1
    bench.clock.advance_to(33)
    assert bench.soc_a == expected


def test_an_interrupt_waits_for_etclr_and_one_more_is_held(bench: Bench) -> None:
    bench.start(UP, 9)
    bench.regs.ETPS.bit.INTPRD = 1
    bench.regs.ETSEL.bit.INTSEL = 1
    bench.regs.ETSEL.bit.INTEN = 1
    bench.clock.advance_to(45)
    assert bench.interrupts == [10]
    bench.regs.ETCLR.bit.INT = 1  # the one that was held comes at once
    assert bench.interrupts == [10, 45]
    bench.regs.ETCLR.bit.INT = 1
    bench.clock.advance_to(50)
    assert bench.interrupts == [10, 45, 50]


@pytest.mark.parametrize(("wide", "every"), [(False, 3), (True, 5)])
def test_soc_comes_every_nth_event_whether_or_not_its_flag_is_cleared(bench: Bench, wide: bool, every: int) -> None:
    bench.start(UP, 9)
    if wide:
        bench.regs.ETPS.bit.SOCPSSEL = 1
        bench.regs.ETSOCPS.bit.SOCBPRD2 = every
    else:
        bench.regs.ETPS.bit.SOCBPRD = every
    bench.regs.ETSEL.bit.SOCBSEL = 1
    bench.regs.ETSEL.bit.SOCBEN = 1
    bench.clock.advance_to(10 * every * 2 + 10)
    assert bench.soc_b == [10 * every, 20 * every]
    assert bench.regs.ETFLG.bit.SOCB == 1
    count = bench.regs.ETSOCPS.bit.SOCBCNT2 if wide else bench.regs.ETPS.bit.SOCBCNT
    assert count == 1


def test_no_trigger_no_event(bench: Bench) -> None:
    bench.start(UP, 9)
    bench.regs.ETSEL.bit.INTSEL = 1
    bench.regs.ETSEL.bit.INTEN = 1  # INTPRD 0: disabled
    assert bench.clock.pending == 0


def test_forced_triggers_set_the_flag_and_pulse_only_if_enabled(bench: Bench) -> None:
    bench.regs.ETFRC.bit.SOCA = 1
    assert (bench.regs.ETFLG.bit.SOCA, bench.soc_a) == (1, [])
    bench.regs.ETSEL.all = 1 << 8 | 1 << 11
    bench.regs.ETFRC.bit.SOCA = 1
    assert len(bench.soc_a) == 1


def test_a_trigger_at_the_cycle_of_a_shadow_load_is_not_lost(bench: Bench) -> None:
    bench.start(UP, 9)
    bench.regs.TBCTL.bit.PRDLD = 0
    bench.regs.TBPRD = 19  # its load at 10 is scheduled before the trigger's event at 10
    bench.regs.ETPS.bit.SOCAPRD = 1
    bench.regs.ETSEL.all = 1 << 8 | 1 << 11
    bench.clock.advance_to(55)
    assert bench.soc_a == [10, 30, 50]
