"""The digital compare of an ePWM: trip inputs, conditions, events, blanking, what events do (TRM, digital compare)."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.emulator.peripherals.epwm_bench import CLEAR, SET, UP, UP_DOWN, Bench, actions
from tests.emulator.peripherals.test_dma_programs import CChip

HIGH_IMPEDANCE, HIGH, LOW, UNTOUCHED = range(4)
INT, CBC, OST, DCAEVT1, DCAEVT2, DCBEVT1, DCBEVT2 = (1 << n for n in range(7))
#: TZCTL with every action "untouched".
NOTHING = 0xFFF
#: Conditions of TZDCSEL.
LOW_H, HIGH_H, LOW_L, HIGH_L, HIGH_L_LOW_H = range(1, 6)


@pytest.fixture
def bench() -> Bench:
    return new_bench()


def new_bench() -> Bench:
    """Both outputs high for the first 30 of 100 TBCLK; no event changes an output."""
    bench = Bench()
    drive = actions(ZRO=SET, CAU=CLEAR)
    bench.start(UP, 99, a=30, b=30, control_a=drive, control_b=drive)
    bench.protected()
    bench.regs.TZCTL.all = NOTHING
    return bench


def event_a1(bench: Bench, n: int = 4) -> None:
    """DCAEVT1 stands while TRIPINn is high."""
    bench.regs.DCTRIPSEL.all = n - 1
    bench.regs.TZDCSEL.bit.DCAEVT1 = HIGH_H


# Trip inputs and conditions


@pytest.mark.parametrize("n", range(1, 13))
def test_each_trip_input_can_be_chosen_alone(bench: Bench, n: int) -> None:
    assert bench.tripins == set()
    event_a1(bench, n)
    assert bench.tripins == {n}
    bench.put_tripin(n, 1)
    assert bench.regs.TZFLG.all == DCAEVT1
    bench.regs.TZDCSEL.all = 0
    assert bench.tripins == set()


@pytest.mark.parametrize(("choice", "n"), [(13, 14), (14, 15)])
def test_the_last_two_choices_are_trip_inputs_14_and_15(bench: Bench, choice: int, n: int) -> None:
    bench.regs.DCTRIPSEL.all = choice
    bench.regs.TZDCSEL.bit.DCAEVT1 = HIGH_H
    assert bench.tripins == {n}


def test_a_choice_that_there_is_not_is_told(bench: Bench) -> None:
    bench.regs.DCTRIPSEL.bit.DCBHCOMPSEL = 12
    [finding] = bench.findings
    assert (finding.rule, finding.object) == ("unmodelled", "EPwm2Regs.DCTRIPSEL.DCBHCOMPSEL")


@given(
    condition=st.integers(0, 7), event=st.integers(0, 3), choices=st.tuples(*[st.integers(1, 12)] * 2),
    combined=st.tuples(*[st.none() | st.integers(0, 0xFFF)] * 2), levels=st.integers(0, 0xFFF), before=st.booleans(),
)  # fmt: skip
def test_an_event_stands_while_its_condition_holds(
    condition: int, event: int, choices: tuple[int, int], combined: tuple[int | None, int | None], levels: int,
    before: bool,
) -> None:  # fmt: skip
    bench = new_bench()

    def put_levels() -> None:
        for n in range(1, 13):
            bench.put_tripin(n, levels >> n - 1 & 1)

    def configure() -> None:
        module = "DCA" if event < 2 else "DCB"
        word = 0
        for i, (n, mask) in enumerate(zip(choices, combined, strict=True)):
            word |= (n - 1 if mask is None else 15) << 4 * i
            if mask is not None:
                bench.regs.registers[f"{module}{'HL'[i]}TRIPSEL"].all = mask
        bench.regs.DCTRIPSEL.all = word if event < 2 else word << 8
        bench.regs.TZDCSEL.all = condition << 3 * event

    for step in (put_levels, configure) if before else (configure, put_levels):
        step()
    # TRM: a combination is the OR of the inputs that it selects.
    high, low = (
        bool(levels >> n - 1 & 1) if mask is None else bool(levels & mask)
        for n, mask in zip(choices, combined, strict=True)
    )
    holds = {LOW_H: not high, HIGH_H: high, LOW_L: not low, HIGH_L: low, HIGH_L_LOW_H: low and not high}
    # Flags remember what held on the way: clear them, and those of events that stand come again.
    bench.regs.TZCLR.all = 0x7F
    assert bench.regs.TZFLG.all == (DCAEVT1 << event if holds.get(condition) else 0)


def test_inputs_that_stand_already_make_no_event_on_the_way_to_a_condition(bench: Bench) -> None:
    # DCAL high and DCAH low: while the levels are asked for one by one, DCAL alone would be an event.
    bench.tripin_levels = {1: 1, 2: 1}
    bench.regs.DCTRIPSEL.all = 1 | 0 << 4
    bench.regs.TZDCSEL.bit.DCAEVT1 = HIGH_L_LOW_H
    assert bench.regs.TZFLG.all == 0


# What events do


def test_event_1_is_a_one_shot_trip_where_tzsel_says_so(bench: Bench) -> None:
    event_a1(bench)
    bench.regs.TZSEL.bit.DCAEVT1 = 1
    bench.regs.TZCTL.bit.TZA = HIGH
    bench.regs.TZEINT.bit.OST = 1
    bench.clock.advance_to(50)
    bench.put_tripin(4, 1)
    bench.put_tripin(4, 0)
    bench.clock.advance_to(1_050)
    assert (bench.a.level, bench.a.duty, bench.b.duty) == (1, 1.0, 0.3)
    assert (bench.regs.TZFLG.all, bench.regs.TZOSTFLG.all, bench.trips) == (INT | OST | DCAEVT1, 1 << 6, [50])
    bench.regs.TZCLR.all = INT | OST | DCAEVT1
    bench.regs.TZOSTCLR.all = 1 << 6
    assert (bench.a.duty, bench.regs.TZFLG.all, bench.regs.TZOSTFLG.all) == (0.3, 0, 0)


def test_a_one_shot_trip_whose_event_stands_trips_again(bench: Bench) -> None:
    event_a1(bench)
    bench.regs.TZSEL.bit.DCAEVT1 = 1
    bench.regs.TZCTL.bit.TZA = HIGH
    bench.put_tripin(4, 1)
    bench.regs.TZCLR.all = INT | OST | DCAEVT1
    assert (bench.a.duty, bench.regs.TZFLG.all) == (1.0, OST | DCAEVT1)


def test_event_2_is_a_cycle_by_cycle_trip(bench: Bench) -> None:
    bench.regs.DCTRIPSEL.bit.DCBHCOMPSEL = 4
    bench.regs.TZDCSEL.bit.DCBEVT2 = HIGH_H
    bench.regs.TZSEL.bit.DCBEVT2 = 1
    bench.regs.TZCTL.bit.TZB = HIGH
    heard: list[tuple[int, int | None]] = []
    bench.b.changed.connect(lambda level: heard.append((bench.clock.now, level)))
    bench.clock.advance_to(140)
    bench.put_tripin(5, 1)
    bench.clock.advance_to(250)
    bench.put_tripin(5, 0)
    bench.clock.advance_to(360)
    # High from 100 to 130; tripped high at 140, over the 0 at 200 as the event stands; the trip ends at 300.
    assert heard == [(100, 1), (130, 0), (140, 1), (330, 0)]
    assert (bench.regs.TZFLG.all, bench.regs.TZCBCFLG.all) == (CBC | DCBEVT2, 1 << 7)
    bench.regs.TZCLR.all = CBC | DCBEVT2
    bench.regs.TZCBCCLR.all = 1 << 7
    assert (bench.regs.TZFLG.all, bench.regs.TZCBCFLG.all) == (0, 0)


@pytest.mark.parametrize(("action", "level"), [(HIGH_IMPEDANCE, None), (HIGH, 1), (LOW, 0), (UNTOUCHED, 0)])
def test_an_event_acts_on_the_output_as_long_as_it_stands(bench: Bench, action: int, level: int | None) -> None:
    event_a1(bench)
    bench.regs.TZCTL.bit.DCAEVT1 = action
    bench.clock.advance_to(50)
    bench.put_tripin(4, 1)
    assert bench.a.level == level
    assert bench.b.level == 0
    bench.put_tripin(4, 0)
    assert (bench.a.level, bench.a.duty, bench.a.released) == (0, 0.3, False)
    # The flag outlasts it.
    assert bench.regs.TZFLG.all == DCAEVT1


def test_actions_have_an_order(bench: Bench) -> None:
    # TRM: TZA before DCAEVT1 before DCAEVT2.
    bench.regs.DCTRIPSEL.all = 3 | 4 << 4
    bench.regs.TZDCSEL.all = HIGH_H | HIGH_L << 3
    bench.regs.TZCTL.all = NOTHING & ~0xFF | LOW << 6 | HIGH << 4 | LOW
    bench.clock.advance_to(110)
    levels = [bench.a.level]
    bench.put_tripin(5, 1)
    levels.append(bench.a.level)
    bench.put_tripin(4, 1)
    levels.append(bench.a.level)
    bench.regs.TZFRC.bit.OST = 1
    levels.append(bench.a.level)
    # From the action qualifier high; event 2 low; event 1 high; the trip low.
    assert levels == [1, 0, 1, 0]


def test_events_interrupt(bench: Bench) -> None:
    event_a1(bench)
    bench.regs.TZEINT.bit.DCAEVT1 = 1
    bench.clock.advance_to(7)
    bench.put_tripin(4, 1)
    assert (bench.trips, bench.regs.TZFLG.all) == ([7], INT | DCAEVT1)
    bench.put_tripin(4, 0)
    bench.regs.TZCLR.all = INT | DCAEVT1
    assert (bench.trips, bench.regs.TZFLG.all) == ([7], 0)


def test_software_forces_an_event(bench: Bench) -> None:
    bench.regs.TZSEL.bit.DCBEVT1 = 1
    bench.regs.TZCTL.bit.TZB = HIGH
    bench.clock.advance_to(50)
    bench.regs.TZFRC.bit.DCBEVT1 = 1
    assert (bench.regs.TZFLG.all, bench.regs.TZOSTFLG.all, bench.b.level) == (OST | DCBEVT1, 1 << 7, 1)
    bench.regs.TZCLR.all = OST | DCBEVT1
    assert (bench.regs.TZFLG.all, bench.b.level) == (0, 0)


def test_event_1_starts_conversions(bench: Bench) -> None:
    event_a1(bench)
    bench.regs.DCACTL.bit.EVT1SOCE = 1
    bench.regs.ETSEL.bit.SOCASEL = 0
    bench.regs.ETPS.bit.SOCAPRD = 2
    bench.regs.ETSEL.bit.SOCAEN = 1
    for cycle in (10, 20, 30, 40):
        bench.clock.advance_to(cycle)
        bench.put_tripin(4, 1)
        bench.put_tripin(4, 0)
    # Every second event.
    assert (bench.soc_a, bench.soc_b) == ([20, 40], [])
    assert not list(bench.findings)


def test_event_1_of_b_starts_conversions_of_soc_b(bench: Bench) -> None:
    bench.regs.DCTRIPSEL.bit.DCBLCOMPSEL = 6
    bench.regs.TZDCSEL.bit.DCBEVT1 = HIGH_L
    bench.regs.DCBCTL.bit.EVT1SOCE = 1
    bench.regs.ETPS.bit.SOCBPRD = 1
    bench.regs.ETSEL.bit.SOCBEN = 1
    bench.put_tripin(7, 1)
    assert (bench.soc_a, bench.soc_b) == ([], [0])


def test_event_1_gives_sync(bench: Bench) -> None:
    event_a1(bench)
    bench.regs.DCACTL.bit.EVT1SYNCE = 1
    bench.regs.TBPHS.bit.TBPHS = 77
    bench.regs.TBCTL.bit.PHSEN = 1
    bench.clock.advance_to(10)
    bench.put_tripin(4, 1)
    assert bench.regs.TBCTR == 77
    assert bench.regs.TBSTS.bit.SYNCI == 1


# The filter


def filtered_a1(bench: Bench, pulse: int, offset: int, window: int, inverted: int = 0) -> None:
    event_a1(bench)
    bench.regs.DCFOFFSET = offset
    bench.regs.DCFWINDOW = window
    bench.regs.DCFCTL.all = pulse << 4 | inverted << 3 | 1 << 2
    bench.regs.DCACTL.bit.EVT1SRCSEL = 1
    bench.regs.TZCTL.bit.DCAEVT1 = HIGH
    bench.regs.AQCTLA.all = 0


def edges(bench: Bench) -> list[tuple[int, int | None]]:
    heard: list[tuple[int, int | None]] = []
    bench.a.changed.connect(lambda level: heard.append((bench.clock.now, level)))
    return heard


def test_events_in_the_blanking_window_are_masked(bench: Bench) -> None:
    bench.clock.advance_to(50)
    filtered_a1(bench, pulse=1, offset=10, window=20)
    heard = edges(bench)
    bench.clock.advance_to(90)
    bench.put_tripin(4, 1)
    bench.clock.advance_to(350)
    # The window is 10 to 30 TBCLK after each 0.
    assert heard[1:] == [(110, 0), (130, 1), (210, 0), (230, 1), (310, 0), (330, 1)]
    assert heard[0] == (90, 1)


def test_an_inverted_window_lets_events_through_only_in_it(bench: Bench) -> None:
    bench.clock.advance_to(50)
    filtered_a1(bench, pulse=0, offset=0, window=5, inverted=1)
    heard = edges(bench)
    bench.put_tripin(4, 1)
    bench.clock.advance_to(250)
    # TBPRD is one TBCLK before 0.
    assert heard == [(99, 1), (104, 0), (199, 1), (204, 0)]


def test_both_points_of_an_up_down_counter() -> None:
    bench = Bench()
    bench.start(UP_DOWN, 100)
    bench.protected()
    bench.regs.TZCTL.all = NOTHING
    filtered_a1(bench, pulse=2, offset=0, window=10, inverted=1)
    heard = edges(bench)
    bench.put_tripin(4, 1)
    bench.clock.advance_to(320)
    # TBPRD at 100 and 300, 0 at 200.
    assert heard == [(100, 1), (110, 0), (200, 1), (210, 0), (300, 1), (310, 0)]


def test_a_window_may_go_on_over_the_next_point(bench: Bench) -> None:
    bench.clock.advance_to(50)
    filtered_a1(bench, pulse=1, offset=90, window=30, inverted=1)
    heard = edges(bench)
    bench.put_tripin(4, 1)
    bench.clock.advance_to(350)
    assert heard == [(190, 1), (220, 0), (290, 1), (320, 0)]


def test_a_window_that_is_open_when_the_offset_ends_begins_anew(bench: Bench) -> None:
    bench.clock.advance_to(50)
    filtered_a1(bench, pulse=1, offset=0, window=130, inverted=1)
    heard = edges(bench)
    bench.put_tripin(4, 1)
    bench.clock.advance_to(450)
    assert heard == [(100, 1)]


def test_the_counters_of_offset_and_window_run_down(bench: Bench) -> None:
    bench.clock.advance_to(50)
    filtered_a1(bench, pulse=1, offset=10, window=20)
    counts = []
    for cycle in (99, 100, 103, 110, 111, 130):
        bench.clock.advance_to(cycle)
        counts.append((bench.regs.DCFOFFSETCNT, bench.regs.DCFWINDOWCNT))
    assert counts == [(0, 0), (10, 0), (7, 0), (0, 20), (0, 19), (0, 0)]


def test_an_offset_counts_in_tbclk() -> None:
    bench = Bench(divider=4)
    bench.start(UP, 99)
    bench.protected()
    bench.regs.TZCTL.all = NOTHING
    filtered_a1(bench, pulse=1, offset=3, window=2, inverted=1)
    heard = edges(bench)
    bench.put_tripin(4, 1)
    bench.clock.advance_to(500)
    assert heard == [(412, 1), (420, 0)]


def test_a_new_period_moves_the_window(bench: Bench) -> None:
    bench.clock.advance_to(50)
    filtered_a1(bench, pulse=0, offset=0, window=5, inverted=1)
    heard = edges(bench)
    bench.put_tripin(4, 1)
    bench.regs.TBPRD = 79
    bench.clock.advance_to(200)
    assert heard == [(79, 1), (84, 0), (159, 1), (164, 0)]


@given(
    up_down=st.booleans(), period=st.integers(1, 12), pulse=st.integers(0, 2), offset=st.integers(0, 30),
    window=st.integers(0, 30), inverted=st.integers(0, 1), waits=st.lists(st.integers(1, 25), max_size=8),
)  # fmt: skip
def test_the_filter_equals_counters_that_are_stepped(
    up_down: bool, period: int, pulse: int, offset: int, window: int, inverted: int, waits: list[int]
) -> None:
    """Against the two counters of the manual's figure, a TBCLK at a time."""
    bench = Bench()
    bench.protected()
    bench.start(UP_DOWN if up_down else UP, period)
    bench.regs.TZCTL.all = NOTHING
    filtered_a1(bench, pulse=pulse, offset=offset, window=window, inverted=inverted)
    heard = edges(bench)
    changes = {sum(waits[: n + 1]) for n in range(len(waits))}
    level, waiting, left, last = 0, None, 0, 0
    expected: list[tuple[int, int]] = []
    length = 2 * period if up_down else period + 1
    for cycle in range(1, sum(waits) + 61):
        phase = cycle % length
        count = phase if phase <= period else 2 * period - phase
        left = max(left - 1, 0)
        if waiting:
            waiting -= 1
        if (count == period and pulse in (0, 2)) or (count == 0 and pulse in (1, 2)):
            waiting = offset
        if waiting == 0:
            waiting = None
            left = window or left
        level ^= cycle in changes
        out = level if bool(left) == bool(inverted) else 0
        if out != last:
            last = out
            expected.append((cycle, out))
    level = 0
    for cycle in sorted(changes):
        bench.clock.advance_to(cycle)
        level ^= 1
        bench.put_tripin(4, level)
    bench.clock.advance_to(sum(waits) + 60)
    # What an edge of the window and one of the input make of each other within a cycle is none.
    net = dict(heard)
    was = 0
    for cycle, out in sorted(net.items()):
        if out == was:
            del net[cycle]
        else:
            was = out or 0
    assert sorted(net.items()) == expected


@pytest.mark.parametrize("disturbed", [False, True])
def test_a_window_that_ends_where_the_next_one_begins_has_no_gap(bench: Bench, disturbed: bool) -> None:
    bench.clock.advance_to(50)
    filtered_a1(bench, pulse=1, offset=0, window=100)
    bench.regs.TZSEL.bit.DCAEVT1 = 1
    bench.clock.advance_to(150)
    bench.put_tripin(4, 1)
    if disturbed:
        # What sets the counter's path anew must not change which of both comes first.
        bench.regs.CMPA.bit.CMPA = 31
    bench.clock.advance_to(1_000)
    assert bench.regs.TZFLG.all == 0


@pytest.mark.parametrize("source", range(4))
def test_srcsel_says_which_event_is_filtered(bench: Bench, source: int) -> None:
    # All four events have TRIPIN of their own; only the filtered one reaches DCAEVT2 by the filter.
    bench.regs.DCTRIPSEL.all = 0x7643
    bench.regs.TZDCSEL.all = HIGH_H | HIGH_L << 3 | HIGH_H << 6 | HIGH_L << 9
    bench.regs.DCFCTL.bit.SRCSEL = source
    bench.regs.DCACTL.bit.EVT2SRCSEL = 1
    for i, n in enumerate((4, 5, 7, 8)):
        bench.put_tripin(n, 1)
        bench.put_tripin(n, 0)
        assert bool(bench.regs.TZFLG.all & DCAEVT2) == (i == source)
        bench.regs.TZCLR.all = 0x7F


def test_nothing_costs_while_nothing_is_used(bench: Bench) -> None:
    before = len(bench.clock.waiting())
    event_a1(bench)
    bench.regs.DCFCTL.all = 1 << 4 | 1 << 2
    assert len(bench.clock.waiting()) == before, "no event is filtered"
    bench.regs.DCACTL.bit.EVT1SRCSEL = 1
    assert len(bench.clock.waiting()) == before + 1
    bench.regs.DCFCTL.bit.BLANKE = 0
    assert len(bench.clock.waiting()) == before


def test_a_blank_pulse_mix_is_told(bench: Bench) -> None:
    bench.regs.DCACTL.bit.EVT1SRCSEL = 1
    bench.regs.DCFCTL.all = 3 << 4 | 1 << 2
    [finding] = bench.findings
    assert (finding.rule, finding.object) == ("unmodelled", "EPwm2Regs.DCFCTL.PULSESEL")


def test_reset_ends_it_all(bench: Bench) -> None:
    filtered_a1(bench, pulse=1, offset=0, window=500)
    bench.put_tripin(4, 1)
    bench.clock.advance_to(150)
    bench.epwm.reset()
    assert bench.tripins == set()
    assert (bench.regs.TZFLG.all, bench.regs.DCFWINDOWCNT, len(bench.clock.waiting())) == (0, 0, 0)


# In C

COMPARATOR_TRIPS_PWM = """
Uint16 trips;

void setup(void)
{
    trips = 0;
    start();
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0;
    ClkCfgRegs.PERCLKDIVSEL.bit.EPWMCLKDIV = 0;
    Cmpss1Regs.COMPCTL.bit.COMPDACE = 1;
    Cmpss1Regs.COMPCTL.bit.COMPHSOURCE = 0;
    Cmpss1Regs.DACHVALS.bit.DACVAL = 2048;
    Cmpss1Regs.COMPCTL.bit.CTRIPHSEL = 0;
    Cmpss1Regs.COMPCTL.bit.CTRIPOUTHSEL = 0;
    OutputXbarRegs.OUTPUT3MUX0TO15CFG.bit.MUX0 = 0;
    OutputXbarRegs.OUTPUT3MUXENABLE.bit.MUX0 = 1;

    EPwm8Regs.TBCTL.bit.CLKDIV = 0;
    EPwm8Regs.TBCTL.bit.HSPCLKDIV = 0;
    EPwm8Regs.TBCTR = 0;
    EPwm8Regs.TBPRD = 0xFFFF;
    EPwm8Regs.TZCTL.bit.TZB = TZ_FORCE_HI;
    EPwm8Regs.TZDCSEL.bit.DCBEVT1 = TZ_DCBH_HI;
    EPwm8Regs.DCTRIPSEL.bit.DCBHCOMPSEL = 0xF;
    EPwm8Regs.DCBHTRIPSEL.bit.TRIPINPUT4 = 1;
    EPwm8Regs.TZSEL.bit.DCBEVT1 = 1;
    EPwm8Regs.DCBCTL.bit.EVT1SRCSEL = DC_EVT1;
    EPwm8Regs.DCBCTL.bit.EVT1FRCSYNCSEL = DC_EVT_ASYNC;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EPwmXbarRegs.TRIP4MUX0TO15CFG.bit.MUX0 = 0;
    EPwmXbarRegs.TRIP4MUXENABLE.bit.MUX0 = 1;
    EPwm8Regs.TZCLR.bit.OST = 1;
    EPwm8Regs.TZCLR.bit.INT = 1;
    EPwm8Regs.TZEINT.bit.OST = 1;
    EPwm8Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    EDIS;
    GPIO_SetupPinMux(14, GPIO_MUX_CPU1, 6);
    GPIO_SetupPinMux(15, GPIO_MUX_CPU1, 1);
}

void handle(void)
{
    if (EPwm8Regs.TZFLG.bit.OST)
    {
        EALLOW;
        trips++;
        while (Cmpss1Regs.COMPSTS.bit.COMPHSTS);
        EPwm8Regs.TZCLR.bit.OST = 1;
        EPwm8Regs.TZCLR.bit.INT = 1;
        EDIS;
    }
}
"""


def test_a_comparator_trips_an_epwm_through_the_xbar() -> None:
    """What TI's example of the asynchronous trip promises: CTRIPOUTH on OUTPUTXBAR3, CTRIPH trips EPWM8B high."""
    program = CChip(COMPARATOR_TRIPS_PWM)
    program.call("setup")
    chip, (shown, tripped) = program.chip, (program.chip.pins[14], program.chip.pins[15])
    analog = chip.analog["A"][2]
    program.call("handle")
    assert (shown.level, tripped.level, program.data("trips")) == (0, 0, [0])
    # A pulse of 100 us above 1.65 V.
    begin = chip.clock.now
    analog.follow("test", lambda cycles: 2.0 if cycles - begin < 20_000 else 1.0)
    assert (shown.level, tripped.level) == (1, 1)
    program.wait_ms(0.05)
    program.call("handle")
    # The routine has waited for the end of the pulse, which is known to a look of the comparator (1 us).
    assert 20_000 <= chip.clock.now - begin <= 20_000 + 400
    assert (shown.level, tripped.level, program.data("trips")) == (0, 0, [1])
    # A pulse that is over before anybody looks at the flag: the trip stands, the output has gone.
    analog.follow("test", lambda _cycles: 2.0, steady=True)
    analog.follow("test", lambda _cycles: 1.0, steady=True)
    assert (shown.level, tripped.level) == (0, 1)
    program.call("handle")
    assert (tripped.level, program.data("trips")) == (0, [2])
    assert program.found() == []


def test_a_pin_trips_an_epwm_by_its_input_and_by_the_xbar() -> None:
    """INPUT1 as TRIPIN1, and the same input as TRIP5 by the ePWM X-BAR, both of the low pin."""
    program = CChip(
        """
void setup(void)
{
    start();
    EALLOW;
    InputXbarRegs.INPUT1SELECT = 12;
    EPwmXbarRegs.TRIP5MUX0TO15CFG.bit.MUX1 = 1;
    EPwmXbarRegs.TRIP5MUXENABLE.bit.MUX1 = 1;
    EPwm1Regs.TZCTL.all = 0x0FFF;
    EPwm2Regs.TZCTL.all = 0x0FFF;
    EPwm1Regs.DCTRIPSEL.bit.DCAHCOMPSEL = DC_TRIPIN1;
    EPwm1Regs.TZDCSEL.bit.DCAEVT1 = TZ_DCAH_LOW;
    EPwm2Regs.DCTRIPSEL.bit.DCAHCOMPSEL = DC_TRIPIN5;
    EPwm2Regs.TZDCSEL.bit.DCAEVT1 = TZ_DCAH_LOW;
    EDIS;
}

void clear(void)
{
    EALLOW;
    EPwm1Regs.TZCLR.bit.DCAEVT1 = 1;
    EPwm2Regs.TZCLR.bit.DCAEVT1 = 1;
    EDIS;
}

Uint16 flags(void)
{
    return EPwm1Regs.TZFLG.bit.DCAEVT1 + 2 * EPwm2Regs.TZFLG.bit.DCAEVT1;
}
"""
    )
    pin = program.chip.pins[12]
    pin.drive("test", 1)
    program.wait_ms(0.01)
    program.call("setup")
    program.call("clear")
    assert program.call("flags") == 0
    pin.drive("test", 0)
    program.wait_ms(0.01)
    program.call("clear")
    assert program.call("flags") == 3, "the pin still is low"
    pin.drive("test", 1)
    program.wait_ms(0.01)
    program.call("clear")
    assert program.call("flags") == 0
    assert program.found() == []
