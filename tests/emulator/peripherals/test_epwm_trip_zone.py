"""The trip zone of an ePWM: TZ1 to TZ6, one-shot and cycle by cycle, flags, interrupt (TRM, trip-zone submodule)."""

from __future__ import annotations

from dataclasses import dataclass, field

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.emulator.peripherals.epwm_bench import CLEAR, SET, UP, UP_DOWN, Bench, actions
from tests.emulator.peripherals.test_epwm_stepped import Stepped

HIGH_IMPEDANCE, HIGH, LOW, UNTOUCHED = range(4)
INT, CBC, OST = 1, 2, 4


@pytest.fixture
def bench() -> Bench:
    """Both outputs high for the first 30 of 100 TBCLK; every input of the trip zone high."""
    bench = Bench()
    drive = actions(ZRO=SET, CAU=CLEAR)
    bench.start(UP, 99, a=30, b=30, control_a=drive, control_b=drive)
    bench.protected()
    bench.regs.TZCTL.all = LOW << 2 | HIGH
    return bench


@pytest.mark.parametrize("n", range(1, 7))
def test_a_one_shot_trip_outlasts_its_input(bench: Bench, n: int) -> None:
    bench.regs.TZSEL.all = 1 << 7 + n
    bench.regs.TZEINT.bit.OST = 1
    bench.clock.advance_to(50)
    bench.epwm.trip_input(n, 0)
    bench.epwm.trip_input(n, 1)
    bench.clock.advance_to(1_050)
    assert (bench.a.duty, bench.b.duty, bench.a.level, bench.b.level) == (1.0, 0.0, 1, 0)
    assert (bench.regs.TZFLG.all, bench.regs.TZOSTFLG.all, bench.regs.TZCBCFLG.all) == (OST | INT, 1 << n - 1, 0)
    assert bench.trips == [50]
    bench.regs.TZCLR.all = OST | INT
    bench.regs.TZOSTCLR.all = 1 << n - 1
    assert (bench.a.duty, bench.regs.TZFLG.all, bench.regs.TZOSTFLG.all) == (0.3, 0, 0)
    assert not list(bench.findings)


def test_an_input_that_is_not_selected_does_nothing_and_trips_when_it_is(bench: Bench) -> None:
    bench.regs.TZSEL.bit.OSHT1 = 1
    bench.epwm.trip_input(2, 0)
    assert bench.regs.TZFLG.all == 0
    bench.regs.TZSEL.bit.OSHT2 = 1
    assert (bench.regs.TZFLG.all, bench.regs.TZOSTFLG.all) == (OST, 2)


def test_clearing_a_one_shot_trip_whose_input_is_low_trips_again(bench: Bench) -> None:
    bench.regs.TZSEL.bit.OSHT3 = 1
    bench.regs.TZEINT.bit.OST = 1
    bench.epwm.trip_input(3, 0)
    bench.regs.TZCLR.all = OST | INT
    assert (bench.regs.TZFLG.all, bench.a.duty, len(bench.trips)) == (OST | INT, 1.0, 2)


def test_a_cycle_by_cycle_trip_ends_at_zero_and_its_flag_stays(bench: Bench) -> None:
    bench.regs.TZSEL.bit.CBC1 = 1
    heard: list[tuple[int, int | None]] = []
    bench.a.changed.connect(lambda level: heard.append((bench.clock.now, level)))
    bench.clock.advance_to(140)
    bench.epwm.trip_input(1, 0)
    bench.clock.advance_to(150)
    bench.epwm.trip_input(1, 1)
    bench.clock.advance_to(350)
    # High from the action qualifier at 100 to 130; tripped high at 140; at 200 the trip ends, where CTR = 0 sets A.
    assert heard == [(100, 1), (130, 0), (140, 1), (230, 0), (300, 1), (330, 0)]
    assert (bench.regs.TZFLG.all, bench.regs.TZCBCFLG.all, bench.a.duty) == (CBC, 1, 0.3)
    bench.regs.TZCLR.bit.CBC = 1
    bench.regs.TZCBCCLR.bit.CBC1 = 1
    assert (bench.regs.TZFLG.all, bench.regs.TZCBCFLG.all) == (0, 0)


def test_clearing_the_flag_of_a_trip_that_lasts_does_not_release_the_output(bench: Bench) -> None:
    bench.regs.TZSEL.bit.CBC1 = 1
    bench.clock.advance_to(140)
    bench.epwm.trip_input(1, 0)
    bench.regs.TZCLR.bit.CBC = 1
    assert bench.regs.TZFLG.all == CBC  # the input is low still
    bench.epwm.trip_input(1, 1)
    bench.regs.TZCLR.bit.CBC = 1
    assert (bench.regs.TZFLG.all, bench.a.level) == (0, 1)
    bench.clock.advance_to(240)
    assert bench.a.level == 0


@pytest.mark.parametrize(("pulse", "end"), [(0, 400), (1, 300), (2, 300), (3, None)])
def test_cbcpulse_says_where_a_cycle_by_cycle_trip_ends(pulse: int, end: int | None) -> None:
    # Up-down, TBPRD = 100: CTR = 0 at 0, 200, 400 and TBPRD at 100, 300.  Untripped A stays low.
    bench = Bench()
    bench.start(UP_DOWN, 100)
    bench.protected()
    bench.regs.TZCTL.all = HIGH
    bench.regs.TZCLR.all = pulse << 14
    assert bench.regs.TZCLR.all == pulse << 14
    heard: list[int] = []
    bench.a.changed.connect(lambda _level: heard.append(bench.clock.now))
    bench.clock.advance_to(250)
    bench.regs.TZFRC.bit.CBC = 1
    bench.clock.advance_to(1_000)
    assert heard == ([250] if end is None else [250, end])
    assert (bench.regs.TZFLG.all, bench.regs.TZCBCFLG.all) == (CBC, 0)


def test_the_interrupt_comes_again_until_the_input_goes(bench: Bench) -> None:
    # What TI's example of trip zones says of its routine: it clears CBC and INT, and is taken until the pin is high.
    bench.regs.TZSEL.bit.CBC1 = 1
    bench.regs.TZEINT.bit.CBC = 1
    bench.epwm.trip_input(1, 0)
    for taken in (1, 2, 3):
        assert len(bench.trips) == taken
        bench.regs.TZCLR.bit.CBC = 1
        bench.regs.TZCLR.bit.INT = 1
    bench.epwm.trip_input(1, 1)
    bench.regs.TZCLR.bit.CBC = 1
    bench.regs.TZCLR.bit.INT = 1
    assert (len(bench.trips), bench.regs.TZFLG.all) == (4, 0)


def test_enabling_the_interrupt_of_a_standing_flag_gives_it(bench: Bench) -> None:
    bench.regs.TZFRC.bit.OST = 1
    assert bench.trips == []
    bench.regs.TZEINT.bit.OST = 1
    assert (bench.trips, bench.regs.TZFLG.all) == ([0], OST | INT)


def test_inputs_are_listened_to_while_they_are_selected() -> None:
    asked: list[tuple[int, bool]] = []
    bench = Bench()
    bench.listen = lambda n, on: asked.append((n, on))
    bench.protected()
    bench.regs.TZSEL.all = 1 | 2 << 8
    bench.regs.TZSEL.all = 1 << 8
    assert asked == [(1, True), (2, True), (2, False)]
    bench.epwm.reset()
    assert asked[3:] == [(1, False)]


def test_reset_releases_and_forgets(bench: Bench) -> None:
    bench.regs.TZSEL.bit.CBC1 = 1
    bench.epwm.trip_input(1, 0)
    bench.epwm.trip_input(1, 1)
    bench.epwm.reset()
    assert (bench.regs.TZFLG.all, bench.regs.TZCBCFLG.all, bench.a.duty, bench.a.released) == (0, 0, 0.0, False)
    assert bench.clock.pending == 0


@dataclass
class SteppedTrips:
    """The latches of the manual's figures, for TZ1 (one-shot) and TZ2 (cycle by cycle)."""

    pulse: int
    low: dict[int, bool] = field(default_factory=lambda: {1: False, 2: False})
    once: bool = False
    cycle: bool = False
    flags: int = 0

    def step(self, count: int, period: int) -> None:
        at = (count == 0) | (count == period) << 1
        if at & (1, 2, 3, 0)[self.pulse]:
            self.cycle = False
        self.latch()

    def latch(self) -> None:
        if self.low[1]:
            self.once = True
            self.flags |= OST
        if self.low[2]:
            self.cycle = True
            self.flags |= CBC

    def clear(self, word: int) -> None:
        self.flags &= ~word
        if word & OST:
            self.once = False
        self.latch()


@dataclass(frozen=True)
class Step:
    wait: int
    name: str
    value: int


steps = st.lists(
    st.one_of(
        st.builds(Step, st.integers(0, 30), st.sampled_from(["TZ1", "TZ2", "TZ2"]), st.integers(0, 1)),
        st.builds(Step, st.integers(0, 30), st.just("clear"), st.sampled_from([CBC, OST, CBC | OST])),
        st.builds(Step, st.integers(0, 30), st.just("force"), st.just(CBC)),
        st.builds(Step, st.integers(0, 30), st.just("compare"), st.integers(0, 9)),
    ),
    max_size=16,
)


@given(mode=st.sampled_from([UP, UP_DOWN]), period=st.integers(1, 9), pulse=st.integers(0, 3),
       action=st.integers(0, 3), by_events=st.booleans(), changes=steps)  # fmt: skip
def test_trips_at_any_time_equal_the_stepped_latches(
    mode: int, period: int, pulse: int, action: int, by_events: bool, changes: list[Step]
) -> None:
    """`by_events`: DCAEVT1 and DCAEVT2 are the causes, of TRIPIN1 and TRIPIN2 that are low, instead of TZ1 and TZ2."""
    bench = Bench()
    bench.protected()
    # The events leave the output to the trips.
    bench.regs.TZCTL.all = action | UNTOUCHED << 4 | UNTOUCHED << 6
    bench.regs.TZCLR.all = pulse << 14
    bench.tripin_levels = {1: 1, 2: 1}
    bench.regs.DCTRIPSEL.all = 0 | 1 << 4
    bench.regs.TZDCSEL.all = (1 | 3 << 3) * by_events
    bench.regs.TZSEL.all = 1 << 14 | 1 << 6 if by_events else 1 << 8 | 2
    control = actions(ZRO=SET, CAU=CLEAR)
    bench.start(mode, period, 3, 0, control_a=control)
    bench.regs.CMPCTL.bit.SHDWAMODE = 0
    counter, trips = Stepped(mode, period, 3, 0, control), SteppedTrips(pulse)
    expected: list[tuple[int, int | None]] = []
    heard: list[tuple[int, int | None]] = []
    last: int | None = 0

    def level() -> int | None:
        tripped = trips.once or trips.cycle
        return {HIGH_IMPEDANCE: None, HIGH: 1, LOW: 0}.get(action, counter.level) if tripped else counter.level

    def note() -> None:
        nonlocal last
        if level() != last:
            last = level()
            expected.append((counter.ticks, last))

    bench.a.changed.connect(lambda level: heard.append((bench.clock.now, level)))
    for change in [*changes, Step(30, "end", 0)]:
        bench.clock.advance_to(bench.clock.now + change.wait)
        while counter.ticks < bench.clock.now:
            counter.step()
            trips.step(counter.count, period)
            note()
        assert bench.regs.TZFLG.all & (CBC | OST) == trips.flags
        assert bench.a.level == level()
        if change.name in ("TZ1", "TZ2"):
            n = int(change.name[2])
            trips.low[n] = not change.value
            trips.latch()
            if by_events:
                bench.put_tripin(n, change.value)
            else:
                bench.epwm.trip_input(n, change.value)
        elif change.name == "clear":
            trips.clear(change.value)
            bench.regs.TZCLR.all = change.value | pulse << 14
        elif change.name == "force":
            trips.cycle = True
            trips.flags |= CBC
            bench.regs.TZFRC.bit.CBC = 1
        elif change.name == "compare":
            counter.waiting["a"] = (change.value, "Z")
            bench.regs.CMPA.bit.CMPA = change.value
        note()
    assert heard == expected
