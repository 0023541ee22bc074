"""Unit timer, capture and watchdog of the eQEP: expected values follow from the manual's rules."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.emulator.peripherals.eqep_bench import Bench


@pytest.fixture
def bench() -> Bench:
    return Bench()


# -- unit timer and capture --------------------------------------------------------------------------------------


def test_unit_timer_latches_the_position_every_quprd_cycles(bench: Bench) -> None:
    bench.regs.QUPRD = 2_000
    bench.regs.QEPCTL.bit.UTE = 1
    bench.turn(7)
    bench.clock.advance_to(1_999)
    assert (bench.regs.QUTMR, bench.regs.QPOSLAT, bench.regs.QFLG.bit.UTO) == (1_999, 0, 0)
    bench.clock.advance_to(2_000)
    assert (bench.regs.QUTMR, bench.regs.QPOSLAT, bench.regs.QFLG.bit.UTO) == (0, 7, 1)
    bench.turn(-3)
    bench.clock.advance_to(4_100)
    assert (bench.regs.QUTMR, bench.regs.QPOSLAT) == (100, 4)


def test_unit_period_extra_lengthens_the_unit() -> None:
    bench = Bench(unit_period_extra=1)
    bench.regs.QUPRD = 2_000
    bench.regs.QEPCTL.bit.UTE = 1
    bench.clock.advance_to(2_000)
    assert bench.regs.QFLG.bit.UTO == 0
    bench.clock.advance_to(2_001)
    assert bench.regs.QFLG.bit.UTO == 1


def test_without_ute_and_wde_no_event_waits(bench: Bench) -> None:
    bench.regs.QUPRD = 100
    bench.regs.QWDPRD = 100
    bench.turn(50)
    assert bench.clock.pending == 0
    bench.clock.advance_to(10_000)
    assert bench.regs.QUTMR == 0


def test_unit_timer_stops_and_keeps_its_count(bench: Bench) -> None:
    bench.regs.QUPRD = 1_000
    bench.regs.QEPCTL.bit.UTE = 1
    bench.clock.advance_to(300)
    bench.regs.QEPCTL.bit.UTE = 0
    bench.clock.advance_to(5_000)
    assert bench.regs.QUTMR == 300
    bench.regs.QEPCTL.bit.UTE = 1
    bench.clock.advance_to(5_699)
    assert bench.regs.QFLG.bit.UTO == 0
    bench.clock.advance_to(5_700)  # the missing 700
    assert bench.regs.QFLG.bit.UTO == 1


@pytest.mark.parametrize(("source", "expected"), [(0, 0), (3, 99)])
def test_pcrm_3_starts_the_count_again_at_each_unit(source: int, expected: int) -> None:
    bench = Bench(maximum=99)
    bench.regs.QDECCTL.bit.QSRC = source
    bench.regs.QEPCTL.bit.PCRM = 3
    bench.regs.QUPRD = 1_000
    bench.regs.QEPCTL.bit.UTE = 1
    bench.turn(8)
    position = bench.regs.QPOSCNT
    bench.clock.advance_to(1_000)
    assert (bench.regs.QPOSLAT, bench.regs.QPOSCNT) == (position, expected)


def test_capture_measures_the_time_of_2_to_the_upps_edges(bench: Bench) -> None:
    bench.regs.QCAPCTL.all = 3 << 4 | 2  # SYSCLK/8, every 4 edges
    bench.regs.QCAPCTL.bit.CEN = 1
    bench.clock.advance_to(8_000)
    bench.turn(8, 0, 8_000)  # an edge each 1000 cycles: 4 edges are 4000 cycles, 500 counts
    assert bench.regs.QCPRD == 500
    assert bench.regs.QEPSTS.bit.UPEVNT == 1
    bench.clock.advance_to(8_080)
    assert bench.regs.QCTMR == 10  # 80 cycles after the event at 8000
    bench.regs.QEPSTS.all = 0x88  # as TI's example: UPEVNT and COEF are cleared by writing 1
    assert bench.regs.QEPSTS.bit.UPEVNT == 0


@given(
    upps=st.integers(0, 4),
    ccps=st.integers(0, 7),
    batches=st.lists(st.tuples(st.integers(1, 40), st.integers(0, 90_000)), min_size=1, max_size=6),
)
def test_capture_of_batches_equals_a_timer_looked_at_at_each_edge(
    upps: int, ccps: int, batches: list[tuple[int, int]]
) -> None:
    bench = Bench()
    bench.regs.QCAPCTL.all = ccps << 4 | upps
    bench.regs.QCAPCTL.bit.CEN = 1
    times = []
    for edges, length in batches:
        start = bench.clock.now
        bench.clock.advance_to(start + length)
        bench.turn(edges, start, start + length)
        times += [start + length * i // edges for i in range(1, edges + 1)]
    events = [0, *[t >> ccps for i, t in enumerate(times, 1) if i % (1 << upps) == 0]]
    periods = [b - a for a, b in pairwise(events)]
    assert bench.regs.QCPRD == (periods[-1] & 0xFFFF if periods else 0)
    assert bench.regs.QEPSTS.bit.UPEVNT == bool(periods)
    waiting = (bench.clock.now >> ccps) - events[-1]
    assert bench.regs.QEPSTS.bit.COEF == any(period > 0xFFFF for period in [*periods, waiting])


def test_reading_qposcnt_latches_the_capture_registers_when_qclm_is_0(bench: Bench) -> None:
    bench.regs.QCAPCTL.bit.CEN = 1
    bench.clock.advance_to(100)
    bench.turn(1, 100)
    bench.clock.advance_to(130)
    assert (bench.regs.QCTMRLAT, bench.regs.QCPRDLAT) == (0, 0)
    assert bench.regs.QPOSCNT == 1
    # The first edge, forward, changed QDF from its reset value: the period is marked invalid.
    assert (bench.regs.QCTMRLAT, bench.regs.QCPRDLAT) == (30, 0xFFFF)
    bench.regs.QEPSTS.bit.CDEF = 1
    assert bench.regs.QPOSCNT == 1
    assert (bench.regs.QCTMRLAT, bench.regs.QCPRDLAT) == (30, 100)


@pytest.mark.parametrize(
    ("sticky", "expected"), [(False, [0xFFFF, 0xFFFF, 400]), (True, [0xFFFF, 0xFFFF, 0xFFFF])]
)
def test_a_change_of_direction_spoils_the_period_in_which_it_comes(sticky: bool, expected: list[int]) -> None:
    bench = Bench(sticky_direction_error=sticky)
    bench.regs.QCAPCTL.all = 1  # SYSCLK, every 2 edges
    bench.regs.QCAPCTL.bit.CEN = 1
    latched = []
    # The first forward edge changes QDF. It comes in the first period, which ends at 400; the next one ends at 800.
    for _ in range(2):
        start = bench.clock.now
        bench.clock.advance_to(start + 200)
        bench.turn(1, start, start + 200)
        latched.append((bench.regs.QPOSCNT, bench.regs.QCPRDLAT)[1])
    bench.clock.advance_to(800)
    bench.turn(2, 400, 800)
    latched.append((bench.regs.QPOSCNT, bench.regs.QCPRDLAT)[1])
    assert latched == expected
    assert bench.regs.QEPSTS.bit.CDEF == 1


@pytest.mark.parametrize("forward", [True, False])
def test_the_way_of_tis_example_to_measure_low_speed_reads_300_rpm_both_ways(forward: bool) -> None:
    # eqep_pos_speed: 300 rpm of a wheel with 4000 counts a turn are 20,000 counts a second, one in 10,000 cycles; 32 of
    # them are 320,000 cycles, 5,000 counts of SYSCLK / 64. The example latches at each unit time-out, and clears UPEVNT
    # and COEF, but never CDEF.
    bench = Bench()
    bench.regs.QUPRD = 2_000_000
    bench.regs.QEPCTL.all = bench.regs.QEPCTL.all | 1 << 2 | 1 << 1  # QCLM, UTE
    bench.regs.QCAPCTL.all = 6 << 4 | 5
    bench.regs.QCAPCTL.bit.CEN = 1
    for _ in range(3):
        start = bench.clock.now
        bench.clock.advance_to(start + 2_000_000 - 1)
        bench.turn(200 if forward else -200, start, start + 2_000_000 - 1)
        bench.clock.advance_to(start + 2_000_000)
        bench.regs.QEPSTS.all = 0x88
    assert bench.regs.QCPRDLAT in (4_999, 5_000)


def test_qclm_1_latches_at_the_unit_time_out_only(bench: Bench) -> None:
    bench.turn(1)
    bench.regs.QCAPCTL.bit.CEN = 1
    bench.regs.QEPCTL.bit.QCLM = 1
    bench.regs.QUPRD = 1_000
    bench.regs.QEPCTL.bit.UTE = 1
    bench.clock.advance_to(400)
    bench.turn(1, 400)
    assert bench.regs.QPOSCNT == 2
    assert bench.regs.QCPRDLAT == 0
    bench.clock.advance_to(1_000)
    assert (bench.regs.QCPRDLAT, bench.regs.QCTMRLAT) == (400, 600)


def test_an_overflowed_capture_timer_sets_coef_and_latches_ffff(bench: Bench) -> None:
    bench.regs.QCAPCTL.bit.CEN = 1
    bench.clock.advance_to(0xFFFF)
    assert bench.regs.QEPSTS.bit.COEF == 0
    bench.clock.advance_to(0x1_0000)
    assert bench.regs.QEPSTS.bit.COEF == 1
    assert bench.regs.QPOSCNT == 0
    assert bench.regs.QCPRDLAT == 0xFFFF


def test_changing_a_prescaler_while_capturing_is_a_finding(bench: Bench) -> None:
    bench.regs.QCAPCTL.bit.UPPS = 5
    bench.regs.QCAPCTL.bit.CEN = 1
    assert not bench.findings.of("eqep-prescaler")
    bench.regs.QCAPCTL.bit.UPPS = 6
    assert len(bench.findings.of("eqep-prescaler")) == 1


# -- watchdog ----------------------------------------------------------------------------------------------------


def test_watchdog_times_out_qwdprd_times_64_cycles_after_the_last_edge(bench: Bench) -> None:
    bench.regs.QWDPRD = 10
    bench.regs.QEPCTL.bit.WDE = 1
    bench.clock.advance_to(600)
    assert bench.regs.QWDTMR == 9  # 600 // 64
    bench.turn(1, 600)
    assert bench.regs.QWDTMR == 0
    bench.clock.advance_to(600 + 639)
    assert bench.regs.QFLG.bit.WTO == 0
    bench.clock.advance_to(600 + 640)
    assert bench.regs.QFLG.bit.WTO == 1
