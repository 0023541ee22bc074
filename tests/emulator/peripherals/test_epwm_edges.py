"""Levels and edges of an ePWM behind its dead band, against a model stepped one TBCLK at a time.

The model knows the figure of the dead band: a delay is a wait that the opposite edge ends; nothing is computed ahead.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import groupby

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.emulator.peripherals.epwm_bench import CLEAR, DOWN, SET, UP, UP_DOWN, Bench, actions
from tests.emulator.peripherals.test_epwm_stepped import Stepped, six_actions

modes = st.sampled_from([UP, DOWN, UP_DOWN])


@dataclass
class Wait:
    """A delay of the edges to `slow`, stepped: `left` TBCLK until the edge under way comes out."""

    slow: int
    ticks: int
    before: int = 0
    out: int = 0
    left: int = -1

    def step(self, level: int) -> int:
        if self.left > 0:
            self.left -= 1
        if level != self.before:
            self.before = level
            self.left = self.ticks if level == self.slow else -1
            if level != self.slow:
                self.out = level
        if self.left == 0:
            self.out = self.slow
            self.left = -1
        return self.out


@dataclass
class SteppedBand:
    """TRM, configuration options of the dead band: switches S0 to S8."""

    control: int
    rising: int
    falling: int
    red: Wait = field(init=False)
    fed: Wait = field(init=False)

    def __post_init__(self) -> None:
        self.red, self.fed = Wait(1, self.rising), Wait(0, self.falling)

    def switch(self, bit: int) -> int:
        return self.control >> bit & 1

    def step(self, a: int, b: int) -> tuple[int, int]:
        s0, s1, s2, s3, s4, s5 = (self.switch(bit) for bit in range(6))
        s7, s6, s8 = (self.switch(bit) for bit in (12, 13, 14))
        red = self.red.step((a, b)[s4])
        fed = self.fed.step(red if s8 else (a, b)[s5])
        path_a = red ^ s2 if s1 else a
        path_b = fed ^ s3 if s0 else b
        return (path_b if s6 else path_a), (path_a if s7 else path_b)


#: OUT_MODE, POLSEL, IN_MODE, OUTSWAP, DEDB_MODE.
controls = st.tuples(
    st.integers(0, 3), st.integers(0, 3), st.integers(0, 3), st.integers(0, 3), st.integers(0, 1)
).map(lambda five: five[0] | five[1] << 2 | five[2] << 4 | five[3] << 12 | five[4] << 14)  # fmt: skip


class Model:
    """Both outputs of a module: two qualifiers on one counter, and the dead band."""

    def __init__(self, mode: int, period: int, a: int, b: int, control_a: int, control_b: int) -> None:
        self.a = Stepped(mode, period, a, b, control_a)
        self.b = Stepped(mode, period, a, b, control_b)
        self.band = SteppedBand(0, 0, 0)
        self.levels = [(0, 0)]

    def run_to(self, ticks: int) -> tuple[int, int]:
        while len(self.levels) <= ticks:
            self.a.step()
            self.b.step()
            self.levels.append(self.band.step(self.a.level, self.b.level))
        return self.levels[ticks]

    def edges(self, output: int, divider: int, until: int) -> list[tuple[int, int]]:
        """(cycle, level) of every edge after the start."""
        runs = groupby(enumerate(pair[output] for pair in self.levels[: until + 1]), key=lambda at: at[1])
        first = [next(run) for _, run in runs]
        return [(tick * divider, level) for tick, level in first[1:]]


def configured(bench: Bench, control: int, red: int, fed: int) -> None:
    bench.regs.DBRED.bit.DBRED = red
    bench.regs.DBFED.bit.DBFED = fed
    bench.regs.DBCTL.all = control


def listened(bench: Bench) -> tuple[list[tuple[int, int | None]], list[tuple[int, int | None]]]:
    a: list[tuple[int, int | None]] = []
    b: list[tuple[int, int | None]] = []
    bench.a.changed.connect(lambda level: a.append((bench.clock.now, level)))
    bench.b.changed.connect(lambda level: b.append((bench.clock.now, level)))
    return a, b


@given(
    mode=modes, period=st.integers(1, 9), compare=st.tuples(st.integers(0, 11), st.integers(0, 11)),
    control=st.tuples(six_actions, six_actions), band=controls, red=st.integers(0, 25), fed=st.integers(0, 25),
    divider=st.integers(1, 3),
)  # fmt: skip
def test_edges_and_duties_behind_the_dead_band_are_those_of_the_figure(
    mode: int, period: int, compare: tuple[int, int], control: tuple[int, int], band: int, red: int, fed: int,
    divider: int,
) -> None:  # fmt: skip
    bench = Bench(divider=divider)
    configured(bench, band, red, fed)
    model = Model(mode, period, *compare, *control)
    model.band = SteppedBand(band, red, fed)
    model.levels = [model.band.step(0, 0)]
    heard = listened(bench)
    bench.start(mode, period, *compare, *control)
    duties = [(wire.duty, wire.period_cycles) for wire in (bench.a, bench.b)]
    bench.clock.advance_to(120 * divider)
    model.run_to(1000)
    for output in (0, 1):
        assert heard[output] == model.edges(output, divider, 120)
        # After 900 TBCLK nothing of the beginning is left: delays are 50 at most, two periods 36.
        length = model.a.length()
        window = [pair[output] for pair in model.levels[900 : 900 + 2 * length]]
        duty, period_cycles = duties[output]
        assert duty == pytest.approx(sum(window) / len(window), abs=1e-12)
        if len(set(window)) == 1:
            assert period_cycles == 0
        elif window[:length] == window[length:]:
            assert period_cycles == length * divider
        else:
            assert period_cycles == 2 * length * divider


@dataclass(frozen=True)
class Write:
    wait: int
    name: str
    value: int


writes = st.lists(
    st.one_of(
        st.builds(Write, st.integers(0, 60), st.just("red"), st.integers(0, 20)),
        st.builds(Write, st.integers(0, 60), st.just("fed"), st.integers(0, 20)),
        st.builds(Write, st.integers(0, 60), st.just("a"), st.integers(0, 9)),
        st.builds(Write, st.integers(0, 60), st.just("look"), st.just(0)),
        st.builds(Write, st.integers(100, 900), st.just("look"), st.just(0)),
    ),
    max_size=12,
)


@given(
    mode=modes, period=st.integers(1, 8), control=st.tuples(six_actions, six_actions),
    band=controls.filter(lambda word: bool(word & 3)), changes=writes, divider=st.integers(1, 3), watched=st.booleans(),
)  # fmt: skip
def test_delays_loaded_at_zero_and_looks_at_any_time_equal_the_stepped_model(
    mode: int, period: int, control: tuple[int, int], band: int, changes: list[Write], divider: int, watched: bool
) -> None:
    """DBRED and DBFED in shadow mode (SHDWDBREDMODE, SHDWDBFEDMODE), loaded at CTR = 0, as CMPA is."""
    bench = Bench(divider=divider)
    configured(bench, band | 1 << 10 | 1 << 11, 0, 0)
    model = Model(mode, period, 3, 5, *control)
    model.band = SteppedBand(band, 0, 0)
    model.levels = [model.band.step(0, 0)]
    waiting: dict[str, int] = {}
    step = model.a.step

    def loading() -> None:
        step()
        if model.a.count == 0:
            model.b.a = waiting.get("a", model.b.a)
            model.band.red.ticks = waiting.pop("red", model.band.red.ticks)
            model.band.fed.ticks = waiting.pop("fed", model.band.fed.ticks)

    model.a.step = loading  # type: ignore[method-assign]
    heard = listened(bench) if watched else None
    bench.start(mode, period, 3, 5, *control)
    bench.regs.CMPCTL.bit.SHDWAMODE = 0
    for change in [*changes, Write(50, "look", 0)]:
        bench.clock.advance_to(bench.clock.now + change.wait)
        expected = model.run_to(bench.clock.now // divider)
        assert bench.epwm.levels() == expected
        assert (bench.a.level, bench.b.level) == expected
        if change.name == "red":
            bench.regs.DBRED.bit.DBRED = waiting["red"] = change.value
        elif change.name == "fed":
            bench.regs.DBFED.bit.DBFED = waiting["fed"] = change.value
        elif change.name == "a":
            bench.regs.CMPA.bit.CMPA = waiting["a"] = change.value
            model.a.waiting["a"] = (change.value, "Z")
    if heard is not None:
        for output in (0, 1):
            assert heard[output] == model.edges(output, divider, bench.clock.now // divider)


def test_nobody_listening_costs_no_events_and_a_listener_two_a_period() -> None:
    bench = Bench()
    drive = actions(ZRO=SET, CAU=CLEAR)
    bench.start(UP, 99, a=30, control_a=drive)
    bench.clock.advance_to(100_000)
    assert (bench.a.level, bench.clock.events_run, bench.clock.pending) == (1, 0, 0)
    edges: list[tuple[int, int | None]] = []

    def hear(level: int | None) -> None:
        edges.append((bench.clock.now, level))

    stop = bench.a.changed.connect(hear)
    bench.clock.advance_to(100_230)
    assert edges == [(100_030, 0), (100_100, 1), (100_130, 0), (100_200, 1), (100_230, 0)]
    assert bench.clock.events_run == 5
    stop()
    bench.clock.advance_to(200_000)
    assert (len(edges), bench.clock.events_run) == (5, 5)


def test_writes_that_change_a_level_at_once_are_edges_at_once() -> None:
    bench = Bench()
    bench.start(UP, 99, a=30, control_a=actions(ZRO=SET, CAU=CLEAR))
    heard, _ = listened(bench)
    bench.clock.advance_to(50)
    bench.regs.AQSFRC.all = SET | 1 << 2  # one-shot: set A
    bench.clock.advance_to(60)
    bench.protected()
    bench.regs.TZCTL.bit.TZA = 2
    bench.regs.TZFRC.bit.OST = 1
    bench.clock.advance_to(200)
    bench.regs.TZCLR.bit.OST = 1  # at CTR = 0, which has set A
    assert heard == [(50, 1), (60, 0), (200, 1)]


def test_half_a_bridge_has_the_duties_and_gaps_of_active_high_complementary() -> None:
    # TRM, classical dead-band modes: AHC is POLSEL = 2, OUT_MODE = 3 with A in as both sources.
    # A in is high for TBCLK 0 to 39 of 100; A rises RED = 7 later, B is its complement and rises FED = 11 after the
    # fall of A in.
    bench = Bench()
    configured(bench, 3 | 2 << 2, 7, 11)
    a, b = listened(bench)
    bench.start(UP, 99, a=40, control_a=actions(ZRO=SET, CAU=CLEAR))
    assert (bench.a.duty, bench.a.period_cycles) == (0.33, 100)
    assert (bench.b.duty, bench.b.period_cycles) == (pytest.approx(0.49), 100)
    bench.clock.advance_to(250)
    assert a == [(107, 1), (140, 0), (207, 1), (240, 0)]
    # A in is low in the beginning and always was: B is high, before anybody listens.
    assert b == [(100, 0), (151, 1), (200, 0)]
    assert not bench.findings.of("unmodelled")


def test_dbctl_waits_in_its_shadow() -> None:
    # DBCTL2: SHDWDBCTLMODE = 1, LOADDBCTLMODE = 1: at CTR = TBPRD.
    bench = Bench()
    bench.start(UP, 99, a=40, control_a=actions(ZRO=SET, CAU=CLEAR))
    bench.regs.DBCTL2.all = 1 << 2 | 1
    bench.regs.DBFED.bit.DBFED = 10
    bench.regs.DBCTL.all = 1  # B path delayed: B = A in with a falling edge delay
    bench.clock.advance_to(98)
    assert (bench.b.duty, bench.regs.DBCTL.all) == (0.0, 1)
    bench.clock.advance_to(99)
    assert bench.b.duty == 0.5


def test_a_pulse_shorter_than_its_delay_is_swallowed() -> None:
    # A in is high for 5 TBCLK: a rising edge delayed by 5 has the falling one before it.
    for red, duty in ((4, 0.01), (5, 0.0), (60, 0.0)):
        bench = Bench()
        configured(bench, 2, red, 0)
        bench.start(UP, 99, a=5, control_a=actions(ZRO=SET, CAU=CLEAR))
        assert bench.a.duty == duty


def test_a_look_while_an_edge_is_under_way_does_not_hurry_it() -> None:
    # A in rises at 0 of each 100; delayed by 30.  The looks leave 1000 periods out.
    bench = Bench()
    configured(bench, 2, 30, 0)
    bench.start(UP, 99, a=60, control_a=actions(ZRO=SET, CAU=CLEAR))
    seen = []
    for cycle in (100_010, 100_029, 100_030, 100_059, 100_060):
        bench.clock.advance_to(cycle)
        seen.append(bench.a.level)
    assert seen == [0, 0, 1, 1, 0]
