"""ePWM in register language: time base, duty, shadow, force and trip."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.emulator.peripherals.epwm_bench import (
    CLEAR,
    DOWN,
    SET,
    STOPPED,
    TOGGLE,
    UP,
    UP_DOWN,
    Bench,
    actions,
)


@pytest.fixture
def bench() -> Bench:
    return Bench()


# -- clock and counter -------------------------------------------------------------------------------------------


def test_reset_prescaler_gives_50_mhz() -> None:
    # EPWMCLK = SYSCLK/2, HSPCLKDIV resets to /2, CLKDIV to /1: a TBCLK is 4 cycles of 5 ns.
    bench = Bench(divider=2)
    bench.epwm.reset()
    bench.regs.TBCTL.bit.PRDLD = 1
    bench.regs.TBPRD = 99
    bench.regs.TBCTL.bit.CTRMODE = UP
    bench.clock.advance_to(4 * 30 + 3)
    assert bench.regs.TBCTR == 30


@pytest.mark.parametrize(("high_speed", "clkdiv", "tick"), [(0, 0, 1), (1, 0, 2), (3, 0, 6), (7, 7, 14 * 128)])
def test_prescalers_multiply(bench: Bench, high_speed: int, clkdiv: int, tick: int) -> None:
    bench.start(UP, 1000)
    bench.regs.TBCTL.bit.HSPCLKDIV = high_speed
    bench.regs.TBCTL.bit.CLKDIV = clkdiv
    bench.clock.advance_to(5 * tick - 1)
    assert bench.regs.TBCTR == 4
    bench.clock.advance_to(5 * tick)
    assert bench.regs.TBCTR == 5


def test_the_servo_period_of_the_manual() -> None:
    # 100 MHz, CLKDIV 5 (/32): 3.125 MHz; TBPRD 62499 is 20 ms; CMPA 4687 is 1.5 ms to within a TBCLK of 320 ns.
    bench = Bench(divider=2)
    bench.regs.TBCTL.bit.CLKDIV = 5
    bench.start(UP, 62_499, a=4_687, control_a=actions(ZRO=SET, CAU=CLEAR))
    assert bench.a.period_cycles == 4_000_000
    assert bench.a.duty == 4_687 / 62_500


def test_tbclksync_off_stops_the_counter_and_registers_still_answer() -> None:
    bench = Bench(tbclksync=False)
    bench.start(UP, 99)
    bench.clock.advance_to(1_000)
    assert (bench.regs.TBCTR, bench.regs.TBPRD) == (0, 99)
    bench.epwm.set_tbclksync(True)
    bench.clock.advance_to(1_042)
    assert bench.regs.TBCTR == 42
    bench.epwm.set_tbclksync(False)
    bench.clock.advance_to(2_000)
    assert bench.regs.TBCTR == 42


def test_ctrmode_resets_to_stopped_and_stopping_holds_counter_and_output(bench: Bench) -> None:
    assert bench.regs.TBCTL.bit.CTRMODE == STOPPED
    bench.start(UP, 9, a=5, control_a=actions(ZRO=SET, CAU=CLEAR))
    assert (bench.a.duty, bench.a.period_cycles) == (0.5, 10)
    bench.clock.advance_to(13)  # count 3, high since 10
    bench.regs.TBCTL.bit.CTRMODE = STOPPED
    assert (bench.a.duty, bench.a.period_cycles) == (1.0, 0)
    bench.clock.advance_to(500)
    assert bench.regs.TBCTR == 3
    bench.regs.TBCTL.bit.CTRMODE = UP
    bench.clock.advance_to(501)
    assert bench.regs.TBCTR == 4


def test_a_written_counter_goes_on_from_there(bench: Bench) -> None:
    bench.start(UP, 99)
    bench.clock.advance_to(10)
    bench.regs.TBCTR = 90
    bench.clock.advance_to(20)
    assert bench.regs.TBCTR == 0  # 90 -> 99 in 9 TBCLK, 0 in the tenth


def test_an_up_counter_beyond_its_period_runs_through_ffff_and_sets_ctrmax(bench: Bench) -> None:
    bench.start(UP, 99)
    bench.regs.TBCTR = 0xFFF0
    bench.clock.advance_to(15)
    assert (bench.regs.TBCTR, bench.regs.TBSTS.bit.CTRMAX) == (0xFFFF, 1)
    bench.regs.TBSTS.bit.CTRMAX = 1
    bench.clock.advance_to(16 + 100 + 7)
    assert (bench.regs.TBCTR, bench.regs.TBSTS.bit.CTRMAX) == (7, 0)


def test_a_down_counter_beyond_its_period_comes_down_to_it(bench: Bench) -> None:
    bench.start(DOWN, 9)
    bench.regs.TBCTR = 20
    bench.clock.advance_to(11)
    assert bench.regs.TBCTR == 9
    bench.clock.advance_to(21)
    assert bench.regs.TBCTR == 9  # 9 -> 0 in 9, TBPRD in the tenth


def test_software_sync_loads_the_phase_only_with_phsen(bench: Bench) -> None:
    bench.start(UP_DOWN, 50)
    bench.regs.TBPHS.bit.TBPHS = 20
    bench.clock.advance_to(5)
    bench.regs.TBCTL.bit.SWFSYNC = 1
    assert (bench.regs.TBCTR, bench.regs.TBSTS.bit.SYNCI) == (5, 1)
    bench.regs.TBCTL.bit.PHSEN = 1
    bench.regs.TBCTL.bit.SWFSYNC = 1  # PHSDIR 0: downwards
    assert (bench.regs.TBCTR, bench.regs.TBCTL.bit.SWFSYNC, bench.regs.TBSTS.bit.CTRDIR) == (20, 0, 0)
    bench.clock.advance_to(15)
    assert bench.regs.TBCTR == 10


# -- duty, shadow ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("compare", "duty"), [(0, 0.0), (1, 0.01), (50, 0.5), (99, 0.99), (100, 1.0), (0xFFFF, 1.0)])
def test_up_mode_set_at_zero_clear_at_cmpa(bench: Bench, compare: int, duty: float) -> None:
    bench.start(UP, 99, a=compare, control_a=actions(ZRO=SET, CAU=CLEAR))
    assert bench.a.duty == duty
    assert bench.a.period_cycles == (0 if duty in (0.0, 1.0) else 100)


@pytest.mark.parametrize(("compare", "duty"), [(0, 1.0), (25, 0.75), (99, 0.01), (100, 0.0), (130, 0.0)])
def test_up_down_mode_set_going_up_clear_going_down(bench: Bench, compare: int, duty: float) -> None:
    bench.start(UP_DOWN, 100, a=compare, control_a=actions(CAU=SET, CAD=CLEAR))
    assert bench.a.duty == duty


def test_up_down_mode_has_no_down_event_at_zero(bench: Bench) -> None:
    # At CTR = 0 the counter already counts up, so CMPA = 0 gives CAU but no CAD.
    bench.start(UP_DOWN, 10, a=0, b=0, control_a=actions(PRD=CLEAR, CAD=SET), control_b=actions(PRD=CLEAR, CBU=SET))
    assert (bench.a.duty, bench.b.duty) == (0.0, 0.5)


def test_a_single_toggle_a_period_halves_the_frequency(bench: Bench) -> None:
    bench.start(UP, 99, control_b=actions(ZRO=TOGGLE))
    assert (bench.b.duty, bench.b.period_cycles) == (0.5, 200)


def test_cmpa_is_the_high_word_and_waits_for_zero(bench: Bench) -> None:
    bench.start(UP, 99, a=30, control_a=actions(ZRO=SET, CAU=CLEAR))
    bench.regs.CMPCTL.bit.SHDWAMODE = 0
    changes: list[int] = []
    bench.a.duty_changing.connect(lambda: changes.append(bench.clock.now))
    bench.clock.advance_to(140)
    bench.regs.CMPA.bit.CMPA = 70
    assert bench.regs.CMPA.all == 70 << 16
    assert (bench.a.duty, bench.regs.CMPCTL.bit.SHDWAFULL) == (0.3, 1)
    bench.clock.advance_to(199)
    assert bench.a.duty == 0.3
    bench.clock.advance_to(200)
    assert (bench.a.duty, bench.regs.CMPCTL.bit.SHDWAFULL) == (0.7, 0)
    assert changes == [200]


def test_a_pwm_that_nobody_changes_costs_no_events(bench: Bench) -> None:
    bench.start(UP, 99, a=30, control_a=actions(ZRO=SET, CAU=CLEAR))
    bench.regs.TBCTL.bit.PRDLD = 0
    bench.regs.CMPCTL.all = 0
    bench.regs.CMPA.bit.CMPA = 40
    bench.clock.advance_to(100_000)
    assert (bench.clock.events_run, bench.clock.pending) == (1, 0)


@pytest.mark.parametrize("tbclksync", [False, True])
def test_a_counter_that_stands_at_0_loads_with_the_next_tbclk(tbclksync: bool) -> None:
    bench = Bench(tbclksync=tbclksync)
    bench.regs.CMPA.bit.CMPA = 50
    bench.clock.advance_to(1_000)
    assert bench.regs.CMPCTL.bit.SHDWAFULL == (not tbclksync)
    bench.epwm.set_tbclksync(True)
    bench.clock.advance_to(1_001)
    assert bench.regs.CMPCTL.bit.SHDWAFULL == 0


def test_a_counter_that_stands_elsewhere_loads_nothing(bench: Bench) -> None:
    bench.regs.TBCTR = 7
    bench.regs.CMPA.bit.CMPA = 50
    bench.clock.advance_to(1_000)
    assert bench.regs.CMPCTL.bit.SHDWAFULL == 1


@pytest.mark.parametrize(("stopped_loads", "first"), [(True, 0x800), (False, 0x801)])
def test_the_first_soc_of_tis_example_comes_at_its_compare_value(stopped_loads: bool, first: int) -> None:
    # adc_soc_epwm: SOCA at CTR = CMPA going up, CMPA and TBPRD written while the counter is frozen, then it counts up.
    # What is not loaded while the counter stands is loaded at its first TBCLK, which is a CTR = 0 since TBPRD is 0: the
    # count begins one TBCLK later.
    bench = Bench(stopped_loads=stopped_loads)
    bench.regs.ETSEL.bit.SOCASEL = 4
    bench.regs.ETPS.bit.SOCAPRD = 1
    bench.regs.CMPA.bit.CMPA = 0x800
    bench.regs.TBPRD = 0x1000
    bench.clock.advance_to(100)
    bench.regs.ETSEL.bit.SOCAEN = 1
    bench.regs.TBCTL.bit.CTRMODE = UP
    bench.clock.advance_to(100 + 0x1000)
    assert bench.soc_a[0] == 100 + first


@pytest.mark.parametrize("mode", [UP, UP_DOWN])
def test_a_counter_without_a_period_triggers_nothing(bench: Bench, mode: int) -> None:
    # eqep_pos_speed: an interrupt at CTR = TBPRD, and TBCTL is written before TBPRD.
    bench.regs.TBCTL.bit.PRDLD = 1
    bench.regs.ETSEL.all = 0x000A  # INTEN, INTSEL: CTR = TBPRD
    bench.regs.ETPS.bit.INTPRD = 1
    bench.regs.TBCTL.bit.CTRMODE = mode
    bench.clock.advance_to(100)
    assert bench.interrupts == []
    bench.regs.TBPRD = 50
    bench.clock.advance_to(200)
    assert len(bench.interrupts) == 1  # at the first CTR = 50; ETFLG.INT is not cleared


def test_a_stopped_counter_loads_nothing() -> None:
    bench = Bench(stopped_loads=False)
    bench.regs.TBPRD = 99
    bench.regs.CMPA.bit.CMPA = 50
    bench.regs.AQCTLA.all = actions(ZRO=SET, CAU=CLEAR)
    bench.clock.advance_to(1_000)
    assert bench.regs.CMPCTL.bit.SHDWAFULL == 1
    bench.regs.TBCTL.bit.CTRMODE = UP
    bench.clock.advance_to(1_001)  # TBPRD is still 0: the next TBCLK is a CTR = 0
    assert (bench.regs.CMPCTL.bit.SHDWAFULL, bench.a.duty, bench.a.period_cycles) == (0, 0.5, 100)


def test_loadamode_3_never_loads(bench: Bench) -> None:
    bench.start(UP, 9, a=3, control_a=actions(ZRO=SET, CAU=CLEAR))
    bench.regs.CMPCTL.all = 3
    bench.regs.CMPA.bit.CMPA = 7
    bench.clock.advance_to(10_000)
    assert (bench.a.duty, bench.regs.CMPCTL.bit.SHDWAFULL) == (0.3, 1)


def test_going_immediate_with_a_waiting_value_loses_it_and_says_so(bench: Bench) -> None:
    bench.regs.TBPRD = 500
    bench.regs.TBCTL.bit.PRDLD = 1
    assert bench.regs.TBPRD == 0
    assert [f.object for f in bench.findings.of("epwm-shadow-lost")] == ["EPwm2Regs.TBPRD"]


def test_high_resolution_bits_are_reported_and_do_not_disturb(bench: Bench) -> None:
    bench.start(UP, 99, a=30, control_a=actions(ZRO=SET, CAU=CLEAR))
    bench.regs.CMPA.bit.CMPAHR = 0x8000
    assert bench.a.duty == 0.3
    assert [f.object for f in bench.findings.of("unmodelled")] == ["EPwm2Regs.CMPA.CMPAHR"]


# -- force and trip ----------------------------------------------------------------------------------------------


def test_continuous_force_waits_for_zero_unless_rldcsf_is_3(bench: Bench) -> None:
    bench.start(UP, 99, a=30, control_a=actions(ZRO=SET, CAU=CLEAR))
    bench.regs.AQCSFRC.bit.CSFA = 2
    bench.clock.advance_to(99)
    assert bench.a.duty == 0.3
    bench.clock.advance_to(100)
    assert (bench.a.duty, bench.a.period_cycles) == (1.0, 0)
    bench.regs.AQSFRC.bit.RLDCSF = 3
    bench.regs.AQCSFRC.bit.CSFA = 1
    assert bench.a.duty == 0.0
    bench.regs.AQCSFRC.bit.CSFA = 0
    assert bench.a.duty == 0.3


def test_one_shot_force_lasts_until_the_next_event(bench: Bench) -> None:
    bench.start(UP, 99, a=30, control_a=actions(CAU=CLEAR))
    bench.regs.AQSFRC.bit.ACTSFA = SET
    bench.clock.advance_to(10)
    bench.regs.AQSFRC.bit.OTSFA = 1
    assert bench.regs.AQSFRC.bit.OTSFA == 0
    assert bench.epwm.levels() == (1, 0)
    bench.clock.advance_to(29)
    assert bench.epwm.levels() == (1, 0)
    bench.clock.advance_to(30)
    assert bench.epwm.levels() == (0, 0)
    assert bench.a.duty == 0.0


def test_one_shot_trip_holds_the_outputs_until_cleared(bench: Bench) -> None:
    drive = actions(ZRO=SET, CAU=CLEAR)
    bench.start(UP, 99, a=30, b=30, control_a=drive, control_b=drive)
    bench.regs.TZCTL.bit.TZA = 2
    assert bench.regs.TZCTL.all == 0  # protected
    bench.protected()
    bench.regs.TZCTL.all = 1 << 2 | 2  # A low, B high
    bench.regs.TZEINT.bit.OST = 1
    bench.regs.TZFRC.bit.OST = 1
    assert (bench.a.duty, bench.b.duty, bench.a.period_cycles) == (0.0, 1.0, 0)
    assert (bench.regs.TZFLG.all, len(bench.trips)) == (0b101, 1)
    bench.regs.TZCLR.bit.OST = 1
    assert (bench.a.duty, bench.b.duty, bench.regs.TZFLG.all) == (0.3, 0.3, 0b001)
    bench.regs.TZCLR.bit.INT = 1
    assert (bench.regs.TZFLG.all, len(bench.trips)) == (0, 1)
    assert not bench.findings.of("unmodelled")


def test_a_trip_to_high_impedance_releases_the_output(bench: Bench) -> None:
    bench.start(UP, 99, control_a=actions(ZRO=SET))
    bench.clock.advance_to(100)
    assert (bench.a.level, bench.a.released) == (1, False)
    bench.protected()
    bench.regs.TZFRC.bit.OST = 1
    assert (bench.a.level, bench.a.released, bench.a.duty) == (None, True, 0.0)
    bench.regs.TZCLR.bit.OST = 1
    assert (bench.a.level, bench.a.released, bench.a.duty) == (1, False, 1.0)
    assert not bench.findings.of("unmodelled")


def test_tzctl_3_leaves_the_output_alone(bench: Bench) -> None:
    bench.start(UP, 99, a=30, control_a=actions(ZRO=SET, CAU=CLEAR))
    bench.protected()
    bench.regs.TZCTL.all = 0b1111
    bench.regs.TZFRC.bit.OST = 1
    assert bench.a.duty == 0.3


# -- clock gate, reset, unmodelled -------------------------------------------------------------------------------


def test_a_gated_module_freezes_and_goes_on(bench: Bench) -> None:
    bench.start(UP, 99, a=30, control_a=actions(ZRO=SET, CAU=CLEAR))
    bench.clock.advance_to(110)
    bench.epwm.set_clock(False)
    assert (bench.a.duty, bench.a.period_cycles) == (1.0, 0)
    bench.clock.advance_to(1_000)
    bench.epwm.set_clock(True)
    assert (bench.regs.TBCTR, bench.a.duty) == (10, 0.3)
    bench.clock.advance_to(1_005)
    assert bench.regs.TBCTR == 15


def test_a_new_epwmclk_divider_takes_effect_when_told() -> None:
    bench = Bench(divider=2)
    bench.start(UP, 99, a=30, control_a=actions(ZRO=SET, CAU=CLEAR))
    assert bench.a.period_cycles == 200
    bench.divider = 1
    bench.epwm.clock_changed()
    assert bench.a.period_cycles == 100


def test_reset_restores_registers_and_drops_the_outputs(bench: Bench) -> None:
    bench.start(UP, 99, a=30, control_a=actions(ZRO=SET, CAU=CLEAR))
    bench.epwm.reset()
    assert (bench.a.duty, bench.a.period_cycles) == (0.0, 0)
    # TBCTL 0x0083: stopped, HSPCLKDIV /2.  TBSTS 1: direction up.
    assert (bench.regs.TBCTL.all, bench.regs.TBSTS.all, bench.regs.TBPRD) == (0x0083, 0x0001, 0)


def test_what_is_left_out_of_dead_band_and_trip_zone_is_reported(bench: Bench) -> None:
    bench.protected()
    bench.regs.DBCTL.bit.HALFCYCLE = 1
    bench.regs.DCFCTL.bit.EDGEFILTSEL = 1
    bench.regs.TZCTL2.bit.ETZE = 1
    assert [f.object for f in bench.findings.of("unmodelled")] == [
        "EPwm2Regs.DBCTL.HALFCYCLE", "EPwm2Regs.DCFCTL.EDGEFILTSEL", "EPwm2Regs.TZCTL2.ETZE",
    ]  # fmt: skip


def test_sync_output_is_reported_only_where_a_pulse_would_be_missed(bench: Bench) -> None:
    bench.regs.TBCTL.bit.SYNCOSEL = 3
    assert not bench.findings.of("unmodelled")
    bench.regs.TBCTL.bit.SYNCOSEL = 1
    assert [f.object for f in bench.findings.of("unmodelled")] == ["EPwm2Regs.TBCTL.SYNCOSEL"]


@given(
    mode=st.sampled_from([UP, DOWN, UP_DOWN]),
    period=st.integers(1, 12),
    compare=st.tuples(st.integers(0, 13), st.integers(0, 13)),
    control=st.tuples(st.integers(0, 0xFFF), st.integers(0, 0xFFF)),
    writes=st.lists(st.integers(1, 40), max_size=6),
)
def test_loading_the_value_that_is_active_already_changes_nothing(
    mode: int, period: int, compare: tuple[int, int], control: tuple[int, int], writes: list[int]
) -> None:
    """Two modules, one of which is written its own compare values through the shadow registers."""
    one, other = Bench(), Bench()
    for bench in (one, other):
        bench.start(mode, period, *compare, *control)
        bench.regs.CMPCTL.all = 0
    for i, gap in enumerate(writes):
        if i & 1:
            one.regs.CMPA.bit.CMPA = compare[0]
        one.regs.CMPB.bit.CMPB = compare[1]
        for _ in range(gap):
            for bench in (one, other):
                bench.clock.advance_to(bench.clock.now + 1)
            assert (one.regs.TBCTR, one.regs.TBSTS.all) == (other.regs.TBCTR, other.regs.TBSTS.all)
    assert (one.a.duty, one.b.duty) == (other.a.duty, other.b.duty)
    assert (one.a.period_cycles, one.b.period_cycles) == (other.a.period_cycles, other.b.period_cycles)
    assert one.epwm.levels() == other.epwm.levels()
