"""ePWM in register language, and against a counter stepped TBCLK by TBCLK."""

from __future__ import annotations

import copy
from dataclasses import dataclass, field

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.findings import Findings
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.peripherals.epwm import EPwm
from emulator.registers.epwm import EPwmRegs
from emulator.signals import DutyWire

UP, DOWN, UP_DOWN, STOPPED = range(4)
NONE, CLEAR, SET, TOGGLE = range(4)
#: Position of each event's action in AQCTLA and AQCTLB.
SHIFT = {"ZRO": 0, "PRD": 2, "CAU": 4, "CAD": 6, "CBU": 8, "CBD": 10}


def actions(**named: int) -> int:
    return sum(action << SHIFT[name] for name, action in named.items())


class Bench:
    """EPWM2 with a TBCLK of `divider` SYSCLK cycles, once HSPCLKDIV is 0."""

    def __init__(self, divider: int = 1, tbclksync: bool = True) -> None:
        self.clock = Clock()
        self.findings = Findings(self.clock)
        self.cpu = Cpu(self.clock, self.findings)
        self.regs = EPwmRegs("EPwm2Regs", 0x4100, self.cpu)
        self.a, self.b = DutyWire("EPWM2A"), DutyWire("EPWM2B")
        self.interrupts: list[int] = []
        self.soc_a: list[int] = []
        self.soc_b: list[int] = []
        self.trips: list[int] = []
        self.divider = divider
        self.epwm = EPwm(
            self.clock, self.cpu, self.regs, self.a, self.b, number=2,
            interrupt=lambda: self.interrupts.append(self.clock.now),
            soc_a=lambda: self.soc_a.append(self.clock.now),
            soc_b=lambda: self.soc_b.append(self.clock.now),
            trip_interrupt=lambda: self.trips.append(self.clock.now),
            epwmclk_divider=lambda: self.divider,
        )  # fmt: skip
        self.epwm.set_tbclksync(tbclksync)
        self.regs.TBCTL.bit.HSPCLKDIV = 0

    def start(self, mode: int, period: int, a: int = 0, b: int = 0, control_a: int = 0, control_b: int = 0) -> None:
        """Everything immediate and in force from the first TBCLK on."""
        regs = self.regs
        regs.TBCTL.bit.PRDLD = 1
        regs.CMPCTL.bit.SHDWAMODE = 1
        regs.CMPCTL.bit.SHDWBMODE = 1
        regs.TBPRD = period
        regs.CMPA.bit.CMPA = a
        regs.CMPB.bit.CMPB = b
        regs.AQCTLA.all = control_a
        regs.AQCTLB.all = control_b
        regs.TBCTL.bit.CTRMODE = mode

    def protected(self) -> None:
        self.cpu.eallow = True


@pytest.fixture
def bench() -> Bench:
    return Bench()


# -- a counter stepped one TBCLK at a time, after the manual's tables ---------------------------------------------

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
            assert bench.clock.pending == 0
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


@pytest.mark.parametrize(
    ("compare", "duty"), [(0, 0.0), (1, 0.01), (50, 0.5), (99, 0.99), (100, 1.0), (0xFFFF, 1.0)]
)
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
    bench.a.before_change(lambda: changes.append(bench.clock.now))
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


def test_a_stopped_counter_loads_nothing(bench: Bench) -> None:
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


def test_a_trip_to_high_impedance_is_shown_low_and_reported(bench: Bench) -> None:
    bench.start(UP, 99, control_a=actions(ZRO=SET))
    bench.protected()
    bench.regs.TZFRC.bit.OST = 1
    assert bench.a.duty == 0.0
    assert [f.object for f in bench.findings.of("unmodelled")] == ["EPWM2A", "EPWM2B"]


def test_tzctl_3_leaves_the_output_alone(bench: Bench) -> None:
    bench.start(UP, 99, a=30, control_a=actions(ZRO=SET, CAU=CLEAR))
    bench.protected()
    bench.regs.TZCTL.all = 0b1111
    bench.regs.TZFRC.bit.OST = 1
    assert bench.a.duty == 0.3


# -- event trigger -----------------------------------------------------------------------------------------------


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


def test_dead_band_is_reported_as_unmodelled(bench: Bench) -> None:
    bench.regs.DBCTL.bit.OUT_MODE = 3
    assert [f.object for f in bench.findings.of("unmodelled")] == ["EPwm2Regs.DBCTL.OUT_MODE"]


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
