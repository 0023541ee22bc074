"""Start-up, idle, pausing, ends and failures of the kernel as its host sees them."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.sysbios.core import KernelError
from tests.emulator.sysbios.bench import MS, TICK, Bench


def workload(b: Bench) -> None:
    """Three periodic tasks that share a gate, with time-outs, a Swi and work that is pre-empted."""
    k = b.kernel
    gate = k.GateMutexPri_create(None, None)
    swi = b.swi(lambda: b.note(("swi", b.clock.now)), 3)

    def periodic(name: str, priority: int, period: int, work: int) -> None:
        sem = k.Semaphore_create(0, None, None)
        b.timer(lambda _arg: k.Semaphore_post(sem), period, period=period)

        def function(_a: int, _b: int) -> None:
            while True:
                got = k.Semaphore_pend(sem, 2)
                key = k.GateMutexPri_enter(gate)
                for _ in range(20):
                    b.clock.charge(work // 20)
                k.GateMutexPri_leave(gate, key)
                k.Swi_post(swi)
                b.note((name, got, b.clock.now))

        function.__name__ = name
        b.task(function, priority)

    periodic("fast", 5, 2, 30_000)
    periodic("slow", 2, 7, 500_000)
    periodic("middle", 3, 3, 90_000)


def run(pauses: list[int]) -> tuple[list[Any], list[Any], int]:
    b = Bench(cost_scale=1.0)
    b.listen()
    b.boot(lambda: workload(b))
    for pause in pauses:
        b.kernel.run_until(pause)
    b.kernel.run_until(20 * MS)
    result = (b.log, b.events, b.clock.now)
    b.kernel.shutdown()
    return result


WHOLE = run([])


@settings(max_examples=25, deadline=None)
@given(st.lists(st.integers(0, 20 * MS), max_size=40))
def test_pausing_leaves_no_trace(pauses: list[int]) -> None:
    log, events, _ = run(sorted(pauses))
    assert log == WHOLE[0]
    assert events == WHOLE[1]


def test_two_runs_are_the_same_run() -> None:
    assert run([]) == WHOLE
    assert len(WHOLE[0]) > 20


@pytest.mark.parametrize("ms", [1, 2.5, 10])
def test_an_idle_kernel_stops_exactly_at_the_asked_cycle(ms: float) -> None:
    b = Bench()
    b.boot()
    b.run_ms(ms)
    assert b.clock.now == round(ms * MS)
    assert b.kernel.context() == "Idle"


def test_a_passed_time_returns_at_once() -> None:
    b = Bench()
    b.boot()
    b.run_ms(2)
    b.run_ms(1)
    assert b.clock.now == 2 * MS


def test_what_the_host_does_while_paused_is_seen() -> None:
    b = Bench()
    b.boot(lambda: b.kernel.Hwi_create(92, lambda _arg: b.note(b.clock.now), None, None))
    b.run_ms(1)
    b.pie.request(92)
    b.run_ms(2)
    # Taken at once: the core's 14 cycles after the pause.
    assert b.log == [1 * MS + 14]


def test_time_moved_by_the_host_does_not_run_firmware_in_the_hosts_place() -> None:
    b = Bench()
    b.boot(lambda: b.kernel.Hwi_create(92, lambda _arg: b.note(b.clock.now), None, None))
    b.run_ms(1)
    b.clock.after(100, lambda: b.pie.request(92))
    b.clock.advance_to(1 * MS + 500)
    assert b.log == []
    b.run_ms(2)
    assert b.log == [1 * MS + 500 + 14]


def test_context_names_what_runs() -> None:
    b = Bench()
    k = b.kernel
    seen: list[str] = []
    see = lambda *_: seen.append(b.findings.context())  # noqa: E731

    def TaskUS(_a: int, _b: int) -> None:
        see()
        k.Swi_post(swi)
        b.pie.request(92)
        b.clock.charge(1)

    def release() -> None:
        see()

    def receive(_arg: int) -> None:
        see()

    swi = b.swi(release, 1)
    b.boot(see, lambda: b.task(TaskUS, 1), lambda: k.Hwi_create(92, receive, None, None))
    k.run_until(100)
    assert seen == ["main", "TaskUS", "Swi:release", "Hwi:receive"]
    assert k.context() == "Idle"


def test_equal_names_are_told_apart() -> None:
    b = Bench()
    made: list[Any] = []

    def worker() -> None:
        """Does nothing."""

    b.boot(lambda: made.extend(b.task(worker, 1) for _ in range(3)))
    assert [task.name for task in made] == ["worker", "worker#2", "worker#3"]


def test_an_exception_in_a_task_reaches_the_host_once_with_its_name() -> None:
    b = Bench()

    def TaskUS(_a: int, _b: int) -> None:
        b.clock.charge(2000)
        raise ZeroDivisionError("boom")

    b.boot(lambda: b.task(TaskUS, 1))
    with pytest.raises(ZeroDivisionError) as error:
        b.run_ms(1)
    assert error.value.__notes__ == ["in TaskUS at 10.000 us of virtual time"]
    with pytest.raises(ValueError, match="the kernel has stopped: ZeroDivisionError in TaskUS"):
        b.run_ms(2)


def test_an_exception_in_a_clock_function_names_the_swi_and_the_stack() -> None:
    b = Bench()

    def release(_arg: int) -> None:
        raise KeyError("x")

    b.boot(lambda: b.timer(release, 1))
    with pytest.raises(KeyError) as error:
        b.run_ms(2)
    assert error.value.__notes__[0].startswith("in Swi:Clock, on the stack of Idle at ")


def test_an_exception_in_main_reaches_start() -> None:
    b = Bench()
    with pytest.raises(ZeroDivisionError) as error:
        b.kernel.start(lambda: 1 // 0)
    assert error.value.__notes__[0].startswith("in main at ")


def test_exit_leaves_the_world_running_and_the_cpu_still() -> None:
    b = Bench()

    def task(_a: int, _b: int) -> None:
        b.clock.charge(100)
        b.kernel.BIOS_exit(4)
        b.note("never")

    b.boot(lambda: b.task(task, 1), lambda: b.timer(b.note, 1, period=1))
    b.clock.schedule(3 * MS, lambda: b.note("world"))
    b.run_ms(5)
    assert b.log == ["world"]
    assert b.kernel.exit_status == 4
    b.run_ms(6)
    assert b.clock.now == 6 * MS


def test_main_that_returns_ends_the_program() -> None:
    b = Bench()
    b.kernel.start(lambda: b.note("main"))
    assert b.kernel.exit_status == 0
    b.run_ms(1)
    assert b.clock.now == MS


def test_shutdown_ends_every_task_and_may_be_repeated() -> None:
    b = Bench()

    def task(_a: int, _b: int) -> None:
        try:
            b.kernel.Task_sleep(100)
        finally:
            b.clock.charge(10)
            b.note("cleaned")

    b.boot(lambda: [b.task(task, p) for p in (1, 2, 3)])
    b.run_ms(1)
    b.kernel.shutdown()
    b.kernel.shutdown()
    assert b.log == ["cleaned"] * 3
    with pytest.raises(ValueError, match="it was shut down"):
        b.run_ms(2)


def test_many_kernels_live_side_by_side() -> None:
    benches = [Bench(cost_scale=1.0) for _ in range(10)]
    for b in benches:
        b.listen()
        b.boot(lambda b=b: workload(b))
    for step in range(1, 21):
        for b in benches:
            b.kernel.run_until(step * MS)
    assert all(b.log == WHOLE[0] for b in benches)
    for b in benches:
        b.kernel.shutdown()


def test_run_before_start_and_a_second_start_are_refused() -> None:
    b = Bench()
    with pytest.raises(ValueError, match="after start"):
        b.run_ms(1)
    b.boot()
    with pytest.raises(ValueError, match="started already"):
        b.kernel.start(lambda: None)


def test_bios_start_twice_is_an_error() -> None:
    b = Bench()
    b.boot(lambda: b.task(lambda: b.kernel.BIOS_start(), 1))
    with pytest.raises(KernelError, match="BIOS_start"):
        b.kernel.run_until(1)


def test_start_up_runs_in_the_kernels_order() -> None:
    """Timer, interrupts, Swis posted in main, then tasks."""
    b = Bench()
    b.listen()
    swi = b.swi(lambda: b.note(("swi", b.cpu.intm, b.period > 0)), 1)
    b.boot(
        lambda: b.note(("main", b.cpu.intm, b.period > 0)),
        lambda: b.kernel.Swi_post(swi),
        lambda: b.task(lambda: b.note(("task", b.cpu.intm)), 1),
    )
    b.kernel.run_until(1)
    assert b.log == [("main", True, False), ("swi", False, True), ("task", False)]


def test_idle_functions_run_again_and_again_when_nothing_is_ready() -> None:
    b = Bench(idle_functions=[lambda: b.clock.charge(50_000) or b.note(b.kernel.context())])
    b.boot()
    b.run_ticks(1)
    # One and a half ticks of 50,020 cycles each: 300,001 / 50,020 = 5.9.
    assert b.log == ["Idle"] * 5


def test_every_prototype_has_its_function_and_every_function_its_prototype() -> None:
    import emulator.c28x.rts as rts
    import emulator.sysbios.headers as headers

    b = Bench()
    prefixes = (
        "BIOS_", "Task_", "Swi_", "Hwi_", "Clock_", "Semaphore_", "Event_", "Mailbox_", "Queue_", "GateMutexPri_",
        "GateMutex_", "GateTask_", "GateSwi_", "GateHwi_", "GateAll_", "HeapMem_", "HeapBuf_", "Memory_", "System_",
        "Log_", "Error_",
    )  # fmt: skip
    declared = {
        name
        for name, value in vars(headers).items()
        if name.startswith(prefixes) and callable(value) and not isinstance(value, type)
    }
    library = {"malloc", "calloc", "realloc", "free"}  # of emulator.c28x.rts: the heap is the kernel's
    assert declared | library == set(b.kernel.externs)
    assert library <= set(vars(rts))
    assert b.kernel.Semaphore_post == b.kernel.externs["Semaphore_post"]
    with pytest.raises(AttributeError, match="the kernel has no function HeapTrack_alloc"):
        b.kernel.HeapTrack_alloc


def test_a_tick_in_a_task_costs_the_table() -> None:
    """Core 14 + 8; prologue 90, tick 40, epilogue 60; Swi run 80, work 70, walk 14 an object (1 object)."""
    b = Bench(cost_scale=1.0)
    times: list[int] = []

    def task(_a: int, _b: int) -> None:
        before = b.clock.now
        b.clock.delay(TICK)
        times.append(b.clock.now - before)

    b.boot(lambda: b.task(task, 1), lambda: b.timer(lambda: None, 1000))
    b.run_ticks(2)
    assert times == [TICK + 14 + 8 + 90 + 40 + 60 + 80 + 70 + 14]


def test_everything_due_in_the_last_cycle_has_happened_when_a_run_ends() -> None:
    b = Bench()
    b.boot()
    b.run_ms(1)
    b.clock.schedule(2 * MS, lambda: b.note("before"))
    b.clock.schedule(2 * MS, lambda: b.clock.schedule(2 * MS, lambda: b.note("after")), 5)
    b.run_ms(2)
    assert b.log == ["before", "after"]
