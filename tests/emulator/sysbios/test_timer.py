"""Idle ticks taken together: nothing that a program, a device or the host can see tells them from single ones."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import partial
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.peripherals.cpu_timer import CpuTimer
from emulator.registers.core import ALL
from emulator.registers.cpu_timer import CpuTimerRegs
from tests.emulator.sysbios.bench import MS, TICK, Bench, Struct

#: costs.py and the core: entry 14, prologue 90, handler 40, epilogue 60, exit 8, Swi 80, its work 70; 14 an object.
TICK_CYCLES = 14 + 90 + 40 + 60 + 8 + 80 + 70
WALK_CYCLES = 14


class TimerBench(Bench):
    """The kernel on a real CPU timer 2, whose trigger `on_trigger` may start something."""

    def __init__(self, **switches: Any) -> None:
        self.on_trigger: Callable[[], None] = lambda: None
        self.on_start: Callable[[], None] = lambda: None
        self.skipped = 0
        super().__init__(cost_scale=1.0, **switches)
        self.regs = CpuTimerRegs("CpuTimer2Regs", 0x0C10, self.cpu)
        self.timer2 = CpuTimer(
            self.clock, self.cpu, self.regs, lambda: self.cpu.raise_line(14), trigger=lambda: self.on_trigger()
        )

    def start_tick(self, period_register: int, handler: Callable[[], None]) -> TimerBench:
        registers = self.regs.registers
        registers["PRD"].write(period_register, ALL)
        registers["TCR"].write(1 << 15 | 1 << 14 | 1 << 5, ALL)
        self.started, self.period = self.clock.now, period_register + 1
        self.on_start()
        return self

    def skip(self, most: int, cycles: int) -> range:
        taken = self.timer2.skip(most, cycles)
        self.skipped += len(taken)
        return taken

    def periodic(self, period: int, function: Callable[[int], None]) -> None:
        params = Struct()
        self.kernel.Clock_Params_init(params)
        params.values.update(period=period, startFlag=True)
        self.kernel.Clock_create(function, period, params)

    def state(self) -> tuple[Any, ...]:
        cpu, kernel, registers = self.cpu, self.kernel, self.regs.registers
        return (
            self.clock.now, kernel.clocks.ticks, cpu.ifr, cpu.ier, cpu.intm, cpu.sp, cpu.stack_limit, cpu.eallow,
            cpu.in_interrupt, kernel.tasks.locked, kernel.swis.locked, kernel.core.thread_type, kernel.context(),
            registers["TIM"].read(), registers["TPR"].read(), registers["TCR"].read(),
        )  # fmt: skip


#: Where the handler begins and, with one to five Clock objects, where its cycles end.
OFFSET = st.integers(-3, 3) | st.integers(TICK_CYCLES + WALK_CYCLES - 9, TICK_CYCLES + 5 * WALK_CYCLES + 3)
KIND = st.sampled_from(["look", "interrupt", "slow interrupt"])


@settings(max_examples=60, deadline=None)
@given(
    periods=st.lists(st.integers(1, 6), max_size=3),
    work=st.integers(0, 3 * MS),
    sleeps=st.lists(st.integers(1, 5), max_size=3),
    # Around a tick's own cycles as well as anywhere.
    near=st.lists(st.tuples(st.integers(1, 12), OFFSET, KIND), max_size=6),
    events=st.lists(st.tuples(st.integers(0, 12 * TICK), KIND), max_size=6),
    pauses=st.lists(st.integers(0, 13 * TICK), max_size=5),
    trigger_at=st.sets(st.integers(0, 12), max_size=3),
    trigger_delay=st.integers(0, 600),
)
def test_taking_idle_ticks_together_changes_nothing(
    periods: list[int], work: int, sleeps: list[int], near: list[tuple[int, int, str]], events: list[tuple[int, str]],
    pauses: list[int], trigger_at: set[int], trigger_delay: int,
) -> None:  # fmt: skip
    def run(join: bool) -> tuple[list[Any], int]:
        bench = TimerBench(join_idle_ticks=join)
        kernel, clock = bench.kernel, bench.clock
        triggers = 0

        def note(what: str) -> None:
            bench.note((what, clock.now, kernel.clocks.ticks, kernel.context()))

        def trigger() -> None:
            nonlocal triggers
            bench.note(("trigger", clock.now))  # a device sees the time, not the kernel
            if triggers in trigger_at:
                clock.after(trigger_delay, lambda: note("conversion"))
            triggers += 1

        def main() -> None:
            wake = kernel.Semaphore_create(0)

            def waiter(_a: int, _b: int) -> None:
                while kernel.Semaphore_pend(wake, 0xFFFF):
                    note("woken")
                    clock.charge(work // 3)

            def sleeper(_a: int, _b: int) -> None:
                while sleeps:
                    for ticks in sleeps:
                        kernel.Task_sleep(ticks)
                        note("slept")
                        clock.charge(work)

            def interrupted(_arg: int) -> None:
                note("handler")
                kernel.Semaphore_post(wake)

            params = Struct()
            kernel.Hwi_Params_init(params)
            kernel.Hwi_create(33, interrupted, params)
            kernel.Hwi_create(34, lambda _arg: clock.charge(TICK // 2), params)
            bench.task(waiter, 3)
            bench.task(sleeper, 2)
            for period in periods:
                bench.periodic(period, lambda _arg: note("clock"))

            def happen(what: str) -> None:
                note(what)
                if what != "look":
                    bench.pie.request(33 if what == "interrupt" else 34)

            def start() -> None:
                for at, what in events + [(tick * TICK + offset, what) for tick, offset, what in near]:
                    clock.after(at, partial(happen, what))

            bench.on_start = start
            bench.on_trigger = trigger
            kernel.BIOS_start()

        kernel.start(main)
        for pause in sorted(pauses):
            kernel.run_until(clock.now + pause // 5)
            bench.note(bench.state())
        kernel.run_until(14 * TICK)
        bench.note(bench.state())
        kernel.shutdown()
        return bench.log, bench.skipped

    joined, _ = run(True)
    single, never = run(False)
    assert never == 0
    assert joined == single


def test_idle_ticks_really_are_taken_together_and_stand_at_their_cycle() -> None:
    bench = TimerBench()

    def main() -> None:
        bench.periodic(5, lambda _arg: bench.note(bench.kernel.clocks.ticks))
        bench.kernel.BIOS_start()

    bench.kernel.start(main)
    bench.kernel.run_until(bench.tick_time(21) + 1000)
    # Ticks 5, 10, 15, 20 call the function; the other four of each five only count.
    assert bench.log == [5, 10, 15, 20]
    assert bench.skipped == 16 + 1
    assert bench.kernel.clocks.ticks == 21


@pytest.mark.parametrize(("distance", "taken"), [(TICK_CYCLES + WALK_CYCLES, 0), (TICK_CYCLES + WALK_CYCLES + 1, 1)])
def test_an_event_within_the_cycles_of_a_tick_has_it_taken_by_itself(distance: int, taken: int) -> None:
    bench = TimerBench()
    seen: list[int] = []

    def main() -> None:
        bench.periodic(100, lambda _arg: None)
        bench.kernel.BIOS_start()

    bench.kernel.start(main)
    first = bench.tick_time(1)
    bench.clock.schedule(first + distance, lambda: seen.append(bench.skipped))
    bench.kernel.run_until(first + distance + 1)
    assert seen == [taken]


def test_with_a_listener_every_tick_is_taken_by_itself() -> None:
    bench = TimerBench()
    bench.listen()

    def main() -> None:
        bench.periodic(5, lambda _arg: None)
        bench.kernel.BIOS_start()

    bench.kernel.start(main)
    bench.kernel.run_until(bench.tick_time(3) + 1000)
    assert bench.skipped == 0
    assert bench.kinds("hwi", "swi") == [("hwi", "Clock_tick"), ("swi", "Clock")] * 3


def test_a_digest_and_who_only_reads_events_hear_of_ticks_taken_in_one_step() -> None:
    def run(join: bool) -> tuple[str, list[tuple[int, str, str]], int]:
        bench = TimerBench(join_idle_ticks=join)
        events: list[tuple[int, str, str]] = []
        bench.trace.keep_digest()
        bench.trace.read(lambda cycles, kind, name: events.append((cycles, kind, name)))

        def main() -> None:
            bench.periodic(5, lambda _arg: bench.note(bench.kernel.clocks.ticks))
            bench.kernel.BIOS_start()

        bench.kernel.start(main)
        bench.kernel.run_until(bench.tick_time(21) + 1000)
        return bench.trace.sha256, events, bench.skipped

    digest, events, skipped = run(True)
    assert skipped == 16 + 1
    assert run(False) == (digest, events, 0)
    # The digest is of one line an event.
    lines = "".join(f"{cycles} {kind} {name}\n" for cycles, kind, name in events)
    assert digest == hashlib.sha256(lines.encode()).hexdigest()


def test_without_a_digest_there_is_none() -> None:
    bench = TimerBench()
    assert bench.trace.sha256 == ""
