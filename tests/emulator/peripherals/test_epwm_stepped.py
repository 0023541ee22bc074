"""ePWM against a counter stepped one TBCLK at a time, after the manual's tables."""

from __future__ import annotations

import copy
from dataclasses import dataclass, field

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.emulator.peripherals.epwm_bench import (
    CLEAR,
    DOWN,
    NONE,
    SET,
    SHIFT,
    TOGGLE,
    UP,
    UP_DOWN,
    Bench,
)

#: Highest priority first (TRM, action-qualifier event priority).
PRIORITY_UP = ("PRD", "CBU", "CAU", "ZRO")


PRIORITY_DOWN = ("ZRO", "CBD", "CAD", "PRD")


PRIORITY_RISING = ("CBU", "CAU", "ZRO")


PRIORITY_FALLING = ("CBD", "CAD", "PRD", "CBU", "CAU")


@dataclass
class Stepped:
    mode: int
    period: int = 0
    a: int = 0
    b: int = 0
    control: int = 0
    force: int = 0
    count: int = 0
    rising: bool = True
    level: int = 0
    ticks: int = 0
    #: What waits in a shadow: name -> (value, load points "Z", "P" or "ZP").
    waiting: dict[str, tuple[int, str]] = field(default_factory=dict)

    def length(self) -> int:
        return max(2 * self.period, 1) if self.mode == UP_DOWN else self.period + 1

    def step(self) -> None:
        self.ticks += 1
        if self.mode == UP:
            self.count = 0 if self.count == self.period else self.count + 1
        elif self.mode == DOWN:
            self.count = self.period if self.count == 0 else self.count - 1
        elif self.period:
            self.count += 1 if self.rising else -1
        points = ("Z" if self.count == 0 else "") + ("P" if self.count == self.period else "")
        for name, (value, wanted) in list(self.waiting.items()):
            if set(points) & set(wanted):
                setattr(self, name, value)
                del self.waiting[name]
        if self.mode == UP_DOWN:
            if self.count == 0:
                self.rising = True
            elif self.count == self.period:
                self.rising = False
        self.qualify()

    def qualify(self) -> None:
        if self.force in (1, 2):
            self.level = self.force - 1
            return
        happening = set()
        if self.count == 0:
            happening.add("ZRO")
        if self.count == self.period:
            happening.add("PRD")
        for letter, compare in (("A", self.a), ("B", self.b)):
            if self.mode == UP:
                if self.count == compare:
                    happening.add(f"C{letter}U")
            elif self.mode == DOWN:
                if self.count == min(compare, self.period):
                    happening.add(f"C{letter}D")
            elif compare >= self.period:
                if self.count == self.period:
                    happening |= {f"C{letter}U", f"C{letter}D"} if self.period else {f"C{letter}U"}
            elif self.count == compare:
                happening.add(f"C{letter}U" if self.rising else f"C{letter}D")
        order = {UP: PRIORITY_UP, DOWN: PRIORITY_DOWN}.get(
            self.mode, PRIORITY_RISING if self.rising and self.period else PRIORITY_FALLING
        )
        if self.mode == UP_DOWN and not self.period:
            order = ("PRD", "CBU", "CAU", "ZRO")  # a counter that stays at 0: the module's CHOICE
        for name in order:
            action = self.control >> SHIFT[name] & 3
            if name in happening and action:
                self.level = {CLEAR: 0, SET: 1, TOGGLE: 1 - self.level}[action]
                return

    def run_to(self, ticks: int) -> None:
        while self.ticks < ticks:
            self.step()

    def steady_high(self) -> int:
        """TBCLK high in two periods, once every level follows from the events alone."""
        ahead = copy.deepcopy(self)
        for _ in range(2 * ahead.length()):
            ahead.step()
        high = 0
        for _ in range(2 * ahead.length()):
            ahead.step()
            high += ahead.level
        return high


six_actions = st.tuples(*[st.sampled_from([NONE, NONE, CLEAR, SET, TOGGLE])] * 6).map(
    lambda six: sum(action << 2 * i for i, action in enumerate(six))
)


@given(
    mode=st.sampled_from([UP, DOWN, UP_DOWN]),
    period=st.integers(1, 12),
    a=st.integers(0, 14),
    b=st.integers(0, 14),
    control=six_actions,
    divider=st.integers(1, 3),
)
def test_duty_equals_a_counter_stepped_tbclk_by_tbclk(
    mode: int, period: int, a: int, b: int, control: int, divider: int
) -> None:
    bench = Bench(divider=divider)
    bench.start(mode, period, a, b, control_a=control)
    stepped = Stepped(mode, period, a, b, control)
    high, length = stepped.steady_high(), stepped.length()
    assert bench.a.duty == pytest.approx(high / (2 * length), abs=1e-12)
    if high in (0, 2 * length):
        assert bench.a.period_cycles == 0
    else:
        # Half a period longer only where each period is the other's complement.
        assert bench.a.period_cycles in (length * divider, 2 * length * divider)
    assert (bench.b.duty, bench.b.period_cycles) == (0.0, 0)


@dataclass(frozen=True)
class Step:
    wait: int
    name: str
    value: int


steps = st.lists(
    st.one_of(
        st.builds(Step, st.integers(0, 40), st.just("period"), st.integers(0, 10)),
        st.builds(Step, st.integers(0, 40), st.sampled_from(["a", "b"]), st.integers(0, 12)),
        st.builds(Step, st.integers(0, 40), st.just("control"), six_actions),
        st.builds(Step, st.integers(0, 40), st.just("force"), st.integers(0, 3)),
    ),
    max_size=14,
)


@given(
    mode=st.sampled_from([UP, DOWN, UP_DOWN]),
    period=st.integers(0, 10),
    load_a=st.integers(0, 2),
    load_b=st.integers(0, 2),
    load_force=st.integers(0, 2),
    shadow_control=st.booleans(),
    changes=steps,
    divider=st.integers(1, 3),
)
def test_shadow_loads_at_any_time_equal_the_stepped_counter(
    mode: int, period: int, load_a: int, load_b: int, load_force: int, shadow_control: bool, changes: list[Step],
    divider: int,
) -> None:  # fmt: skip
    bench = Bench(divider=divider)
    regs = bench.regs
    regs.CMPCTL.bit.LOADAMODE = load_a
    regs.CMPCTL.bit.LOADBMODE = load_b
    regs.AQSFRC.bit.RLDCSF = load_force
    regs.AQCTL.bit.SHDWAQAMODE = int(shadow_control)
    regs.TBCTL.bit.PRDLD = 1
    regs.TBPRD = period
    regs.TBCTL.bit.PRDLD = 0
    regs.TBCTL.bit.CTRMODE = mode
    stepped = Stepped(mode, period)
    load = {"period": "Z", "a": ("Z", "P", "ZP")[load_a], "b": ("Z", "P", "ZP")[load_b], "control": "Z",
            "force": ("Z", "P", "ZP")[load_force]}  # fmt: skip
    for change in [*changes, Step(60, "end", 0)]:
        bench.clock.advance_to(bench.clock.now + change.wait)
        stepped.run_to(bench.clock.now // divider)
        assert regs.TBCTR == stepped.count
        assert bench.epwm.levels()[0] == stepped.level
        assert regs.CMPCTL.bit.SHDWAFULL == ("a" in stepped.waiting)
        if mode == UP_DOWN and stepped.period and 0 < stepped.count < stepped.period:
            assert regs.TBSTS.bit.CTRDIR == stepped.rising
        if not stepped.waiting:
            # Nothing waits but the mark that reading TBCTR and TBSTS leaves for a poll.
            assert [event.__name__ for event in bench.clock.waiting() if event.__name__ != "_check_again"] == []
            assert bench.a.duty == pytest.approx(stepped.steady_high() / (2 * stepped.length()), abs=1e-12)
        if change.name == "end":
            continue
        if change.name == "control" and not shadow_control:
            stepped.control = change.value
        else:
            stepped.waiting[change.name] = (change.value, load[change.name])
        if change.name == "period":
            regs.TBPRD = change.value
        elif change.name == "a":
            regs.CMPA.bit.CMPA = change.value
        elif change.name == "b":
            regs.CMPB.bit.CMPB = change.value
        elif change.name == "control":
            regs.AQCTLA.all = change.value
        else:
            regs.AQCSFRC.bit.CSFA = change.value
