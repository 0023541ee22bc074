"""Rules of the SYS/BIOS Clock (knl/Clock.c 6.83)."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator import compiled
from emulator.sysbios.core import KernelError
from tests.emulator.sysbios.bench import TICK, Bench
from tests.emulator.sysbios.c_program import seen


def stamp(b: Bench, name: str = "x") -> Any:
    """A Clock function that notes its name and the tick."""
    return lambda _arg: b.note((name, b.kernel.Clock_getTicks()))


@pytest.mark.parametrize(
    ("timeout", "period", "expected"),
    [(3, 0, [3]), (3, 4, [3, 7, 11]), (10, 5, [10]), (1, 1, list(range(1, 13))), (0x10002, 0, [2])],
)
def test_timeout_then_period_counted_from_bios_start(timeout: int, period: int, expected: list[int]) -> None:
    """create's timeout has 16 bits: 0x10002 is 2."""
    b = Bench()
    b.boot(lambda: b.timer(stamp(b), timeout, period=period))
    b.run_ticks(12)
    assert [tick for _, tick in b.log] == expected


def test_the_period_register_holds_the_period_and_the_timer_counts_one_more() -> None:
    b = Bench()
    b.boot(lambda: None)
    # 200,000 kHz * 1000 us / 1000 = 200,000 in PRD.
    assert b.period == 200_000 + 1
    b.run_ticks(5)
    assert b.kernel.Clock_getTicks() == 5
    assert b.kernel.Clock_getTickPeriod() == 1000


def test_the_period_is_a_constant_of_the_program_too() -> None:
    # Clock.h: `#define Clock_tickPeriod (ti_sysbios_knl_Clock_tickPeriod__C)`, a UInt32: nothing wraps at 65536.
    assert seen("""
void work(UArg a, UArg b)
{
    UInt32 asked = Clock_getTickPeriod();
    UInt ms = 100;
    note(Clock_tickPeriod == asked);
    note(ti_sysbios_knl_Clock_tickPeriod__C == asked);
    note(ms * Clock_tickPeriod == 100000UL);
    Task_sleep(10 * 1000 / Clock_tickPeriod);
    note((int)Clock_getTicks());
}
int main(void) { task(work, 1); BIOS_start(); return 0; }
""") == [1, 1, 1, 10]


def test_functions_of_one_tick_run_in_order_of_creation() -> None:
    b = Bench()
    b.boot(lambda: [b.timer(stamp(b, n), 4) for n in "cab"])
    b.run_ticks(4)
    assert [name for name, _ in b.log] == ["c", "a", "b"]


def test_a_sleeper_is_served_after_clocks_that_were_made_before() -> None:
    b = Bench()
    b.listen()
    b.boot(
        lambda: b.task(lambda: b.kernel.Task_sleep(3), 5),
        lambda: b.timer(stamp(b), 3),
    )
    b.run_ticks(3)
    order = [kind for kind, name in b.kinds("clock", "ready") if kind == "clock" or name != "Idle"]
    assert order == ["ready", "clock", "ready"]  # the first is the creation


def test_without_start_flag_a_clock_waits_for_start() -> None:
    b = Bench()
    made: list[Any] = []

    def task() -> None:
        b.kernel.Task_sleep(5)
        b.kernel.Clock_start(made[0])

    b.boot(lambda: made.append(b.timer(stamp(b), 3, start=False)), lambda: b.task(task, 1))
    b.run_ticks(20)
    assert [tick for _, tick in b.log] == [8]


def test_start_flag_with_timeout_0_asserts() -> None:
    b = Bench()
    with pytest.raises(KernelError):
        b.boot(lambda: b.timer(stamp(b), 0))


def test_start_of_a_running_clock_restarts_it_and_stop_is_idempotent() -> None:
    b = Bench()
    made: list[Any] = []

    def task() -> None:
        b.kernel.Task_sleep(4)
        b.kernel.Clock_start(made[0])  # again 5 ticks: at 9
        b.kernel.Task_sleep(9)  # until 13, after the periodic call at 12
        b.kernel.Clock_stop(made[0])
        b.kernel.Clock_stop(made[0])

    b.boot(lambda: made.append(b.timer(stamp(b), 5, period=3)), lambda: b.task(task, 1))
    b.run_ticks(30)
    assert [tick for _, tick in b.log] == [9, 12]
    assert b.kernel.Clock_isActive(made[0]) == 0
    assert b.kernel.Clock_getTimeout(made[0]) == 0


def test_set_period_and_set_timeout_store_for_later() -> None:
    b = Bench()
    made: list[Any] = []

    def task() -> None:
        b.kernel.Clock_setPeriod(made[0], 2)  # used from the call at 5 on
        b.kernel.Clock_setTimeout(made[0], 70_000)  # 32 bits; used by the next start
        b.kernel.Task_sleep(8)
        b.kernel.Clock_stop(made[0])
        b.kernel.Clock_start(made[0])
        b.note(("left", b.kernel.Clock_getTimeout(made[0])))

    b.boot(lambda: made.append(b.timer(stamp(b), 5, period=10)), lambda: b.task(task, 1))
    b.run_ticks(20)
    assert b.log == [("x", 5), ("x", 7), ("left", 70_000)]
    assert b.kernel.Clock_getPeriod(made[0]) == 2


def test_the_argument_reaches_the_function() -> None:
    b = Bench()
    b.boot(lambda: b.timer(b.note, 1, arg=0xCAFE))
    b.run_ticks(1)
    assert b.log == [0xCAFE]


def test_missed_ticks_are_replayed_in_order() -> None:
    """A Swi above none: the Clock Swi is held back for 3.5 ticks, then serves ticks 1, 2, 3 one after the other."""
    b = Bench()
    b.listen()

    def hold(_a: int, _b: int) -> None:
        key = b.kernel.Swi_disable()
        b.clock.delay(TICK * 7 // 2)
        b.kernel.Swi_restore(key)

    b.boot(
        lambda: b.timer(stamp(b, "each"), 1, period=1),
        lambda: b.timer(stamp(b, "second"), 2),
        lambda: b.task(hold, 1),
    )
    b.run_ticks(4)
    # The live tick is 3 during the replay; the order within shows the ticks.
    assert b.log == [("each", 3), ("each", 3), ("second", 3), ("each", 3), ("each", 4)]
    assert b.kinds("clock late") == [("clock late", "3")]


def test_a_periodic_clock_does_not_drift_when_late() -> None:
    b = Bench()

    def hold(_a: int, _b: int) -> None:
        b.kernel.Task_sleep(1)
        key = b.kernel.Swi_disable()
        b.clock.delay(TICK * 5)
        b.kernel.Swi_restore(key)

    b.boot(lambda: b.timer(stamp(b), 4, period=4), lambda: b.task(hold, 1))
    b.run_ticks(13)
    # Due at 4, 8, 12; held from 1 to 6: the first call is late, the others are not.
    assert [tick for _, tick in b.log] == [6, 8, 12]


def test_start_in_a_late_clock_function_counts_from_the_live_tick() -> None:
    b = Bench()
    made: list[Any] = []

    def late(_arg: int) -> None:
        b.kernel.Clock_start(made[0])

    def hold(_a: int, _b: int) -> None:
        key = b.kernel.Swi_disable()
        b.clock.delay(TICK * 7 // 2)
        b.kernel.Swi_restore(key)

    b.boot(
        lambda: made.append(b.timer(stamp(b), 2, start=False)),
        lambda: b.timer(late, 1),
        lambda: b.task(hold, 1),
    )
    b.run_ticks(10)
    # Served for tick 1 while the live tick is 3: 3 + 2.
    assert [tick for _, tick in b.log] == [5]


def test_a_long_clock_function_delays_tasks_but_not_handlers() -> None:
    b = Bench()

    def long_one(_arg: int) -> None:
        b.clock.delay(TICK * 2)
        b.note(("long", b.kernel.Clock_getTicks()))

    b.boot(
        lambda: b.timer(long_one, 1),
        lambda: b.task(lambda: (b.kernel.Task_sleep(1), b.note(("task", b.kernel.Clock_getTicks()))), 9),
    )
    b.run_ticks(5)
    # The tick handler goes on counting (3 when the function ends), the sleeper of tick 1 runs after it.
    assert b.log == [("long", 3), ("task", 3)]


def test_clock_create_in_a_swi_asserts() -> None:
    b = Bench()
    with pytest.raises(KernelError, match="Clock_A_badThreadType"):
        b.boot(lambda: b.kernel.Swi_post(b.swi(lambda: b.timer(stamp(b), 3), 1)))


def test_without_clock_objects_the_swi_is_not_posted() -> None:
    b = Bench()
    b.listen()
    b.boot(lambda: None)
    b.run_ticks(3)
    assert b.kinds("hwi", "swi") == [("hwi", "Clock_tick")] * 3


def test_the_tick_count_wraps_at_32_bits() -> None:
    b = Bench()
    b.kernel.clocks.ticks = 0xFFFFFFFE
    b.boot(lambda: b.timer(stamp(b), 3))
    b.run_ticks(3)
    assert b.log == [("x", 1)]


ACTIONS = st.lists(
    st.tuples(
        st.integers(1, 12),  # at this tick
        st.integers(0, 3),  # this clock
        st.sampled_from(["start", "stop", "timeout", "period", "hold"]),
        st.integers(1, 6),
    ),
    max_size=12,
)


@pytest.mark.skipif(
    compiled.MODE == "compiled", reason="needs plain Python (HIL_PURE=1): a compiled object keeps its class"
)
@settings(max_examples=60, deadline=None)
@given(
    clocks=st.lists(st.tuples(st.integers(1, 6), st.integers(0, 4), st.booleans()), min_size=4, max_size=4),
    actions=ACTIONS,
)
def test_skipping_the_walk_gives_what_walking_gives(clocks: list[tuple[int, int, bool]], actions: list[Any]) -> None:
    """With `_next_due` always passed, every tick walks the queue: the same functions run at the same cycles."""

    def run(walk_always: bool) -> tuple[list[Any], int]:
        b = Bench(cost_scale=1.0)
        k = b.kernel
        if walk_always:
            module = type(k.clocks)
            k.clocks.__class__ = type(
                "Walking", (module,), {"_next_due": property(lambda _self: -1, lambda _self, _value: None)}
            )
        made: list[Any] = []

        def task() -> None:
            for at, which, what, value in sorted(actions):
                ticks = k.Clock_getTicks()
                if at > ticks:
                    k.Task_sleep(at - ticks)
                timer = made[which]
                if what == "start":
                    k.Clock_start(timer)
                elif what == "stop":
                    k.Clock_stop(timer)
                elif what == "timeout":
                    k.Clock_setTimeout(timer, value)
                elif what == "period":
                    k.Clock_setPeriod(timer, value)
                else:
                    key = k.Swi_disable()
                    b.clock.delay(value * TICK * 2 // 3)
                    k.Swi_restore(key)

        def setup() -> None:
            for i, (timeout, period, start) in enumerate(clocks):
                made.append(b.timer(lambda _arg, i=i: b.note((i, b.clock.now)), timeout, period=period, start=start))
            b.task(task, 3)

        b.boot(setup)
        b.run_ticks(25)
        now = b.clock.now
        k.shutdown()
        return b.log, now

    assert run(False) == run(True)
