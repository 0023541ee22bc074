"""Rules of SYS/BIOS tasks (knl/Task.c 6.83)."""

from __future__ import annotations

from typing import Any

import pytest

from emulator.sysbios.core import KernelError
from tests.emulator.sysbios.bench import FOREVER, MS, TICK, Bench, logger, nothing


def test_tasks_made_in_main_start_by_priority_then_in_order_of_creation() -> None:
    b = Bench()
    b.boot(lambda: [b.task(logger(b, n, nothing), p) for n, p in (("a", 1), ("b", 3), ("c", 3), ("d", 2))])
    b.kernel.run_until(1)
    assert b.log == ["b0", "c0", "d0", "a0"]


def test_a_ready_task_of_equal_priority_does_not_pre_empt() -> None:
    b = Bench()
    k = b.kernel
    sem: list[Any] = []
    wait = lambda: k.Semaphore_pend(sem[0], FOREVER)  # noqa: E731
    post = lambda: k.Semaphore_post(sem[0])  # noqa: E731
    b.boot(
        lambda: sem.append(b.semaphore()),
        lambda: b.task(logger(b, "w", wait), 2),
        lambda: b.task(logger(b, "p", post, nothing), 2),
    )
    k.run_until(1)
    # No time slicing: the poster goes on to its end although the waiter became ready.
    assert b.log == ["p0", "p1", "w0"]


def test_a_ready_task_of_higher_priority_pre_empts_within_the_post() -> None:
    b = Bench()
    k = b.kernel
    sem: list[Any] = []
    b.boot(
        lambda: sem.append(b.semaphore()),
        lambda: b.task(logger(b, "w", lambda: k.Semaphore_pend(sem[0], FOREVER)), 3),
        lambda: b.task(logger(b, "p", lambda: k.Semaphore_post(sem[0]), nothing), 2),
    )
    k.run_until(1)
    assert b.log == ["w0", "p0", "p1"]


def test_a_pre_empted_task_resumes_before_its_equals() -> None:
    b = Bench()
    k = b.kernel
    sem: list[Any] = []
    b.boot(
        lambda: sem.append(b.semaphore()),
        lambda: b.task(logger(b, "high", lambda: k.Semaphore_pend(sem[0], FOREVER)), 3),
        lambda: b.task(logger(b, "first", lambda: k.Semaphore_post(sem[0]), nothing), 2),
        lambda: b.task(logger(b, "second", nothing), 2),
    )
    k.run_until(1)
    assert b.log == ["high0", "first0", "first1", "second0"]


def test_yield_sends_the_running_task_behind_its_equals() -> None:
    b = Bench()
    k = b.kernel
    b.boot(
        lambda: b.task(logger(b, "a", nothing, k.Task_yield), 2),
        lambda: b.task(logger(b, "b", nothing, k.Task_yield), 2),
    )
    k.run_until(1)
    assert b.log == ["a0", "b0", "a1", "b1"]


def test_yield_from_a_clock_function_slices_time() -> None:
    b = Bench()

    def spin(name: str) -> Any:
        def function(_a: int, _b: int) -> None:
            while True:
                b.clock.charge(MS // 4)
                b.note(name)

        return function

    b.boot(
        lambda: b.task(spin("a"), 2),
        lambda: b.task(spin("b"), 2),
        lambda: b.timer(lambda _arg: b.kernel.Task_yield(), 1, period=1),
    )
    b.run_ticks(3)
    # Notes of a at 50, 100, 150 and 200 thousand cycles; the tick at 200,001 falls into its fifth charge.  Then b from
    # 250 thousand on: two notes, and in its third charge the tick at 400,002; a ends its fifth, and so on.
    assert "".join(b.log) == "aaaa" + "bb" + "aaaa" + "bb"


@pytest.mark.parametrize(("ticks", "woken_at"), [(1, 3), (2, 4), (10, 12)])
def test_sleep_ends_within_the_last_tick_period(ticks: int, woken_at: int) -> None:
    """Called 2.5 ticks after the start, sleep(n) ends at tick 2 + n: after n - 0.5 periods, which lies in (n-1, n]."""
    b = Bench()

    def sleeper(_a: int, _b: int) -> None:
        b.clock.charge(TICK * 5 // 2)
        b.kernel.Task_sleep(ticks)
        b.note(b.clock.now - b.tick_time(woken_at))

    b.boot(lambda: b.task(sleeper, 1))
    b.run_ticks(20)
    # The core's own entry and exit (14 + 8 cycles) are the only time that costs here.
    assert b.log == [22]


def test_sleep_0_returns_at_once_without_a_yield() -> None:
    b = Bench()
    b.boot(
        lambda: b.task(logger(b, "a", lambda: b.kernel.Task_sleep(0)), 1),
        lambda: b.task(logger(b, "b", nothing), 1),
    )
    b.kernel.run_until(1)
    assert b.log == ["a0", "b0"]


@pytest.mark.parametrize(
    ("call", "identifier"),
    [
        (lambda k: k.Task_sleep(0xFFFF), "Task_A_badTimeout"),
        (lambda k: (k.Task_disable(), k.Task_sleep(1)), "Task_A_sleepTaskDisabled"),
        (lambda k: (k.Swi_disable(), k.Task_sleep(1)), "Task_A_sleepTaskDisabled"),
        (lambda k: k.Task_setPri(k.Task_self(), 0), "Task_A_badPriority"),
        (lambda k: k.Task_setPri(k.Task_self(), 16), "Task_A_badPriority"),
        (lambda k: k.Task_setPri(k.Task_self(), -2), "Task_A_badPriority"),
    ],
)
def test_a_broken_rule_is_the_kernels_assertion(call: Any, identifier: str) -> None:
    b = Bench()
    b.boot(lambda: b.task(lambda _a, _b: call(b.kernel), 1))
    with pytest.raises(KernelError) as error:
        b.kernel.run_until(1)
    assert error.value.identifier == identifier


def test_a_task_that_ends_while_Swis_are_disabled_ends_the_program() -> None:
    """No task can follow it, and the function that it would return to is none."""
    b = Bench()
    b.boot(lambda: b.task(lambda: b.kernel.Swi_disable(), 1))
    with pytest.raises(KernelError, match="Swi_disable is in force"):
        b.kernel.run_until(MS)


@pytest.mark.parametrize("priority", [0, 16, -2])
def test_create_refuses_a_priority_that_is_not_for_users(priority: int) -> None:
    b = Bench()
    with pytest.raises(KernelError, match="Task_A_badPriority"):
        b.boot(lambda: b.task(nothing, priority))


def test_a_task_cannot_be_created_in_a_swi() -> None:
    b = Bench()
    with pytest.raises(KernelError, match="Task_A_badThreadType"):
        b.boot(lambda: b.kernel.Swi_post(b.swi(lambda: b.task(nothing, 1), 1)))


def test_a_task_created_by_a_lower_one_pre_empts_it() -> None:
    b = Bench()
    b.boot(lambda: b.task(logger(b, "low", lambda: b.task(logger(b, "high", nothing), 2)), 1))
    b.kernel.run_until(1)
    assert b.log == ["high0", "low0"]


def test_disable_holds_switches_until_the_outermost_restore() -> None:
    b = Bench()
    k = b.kernel
    sem: list[Any] = []

    def low() -> None:
        outer = k.Task_disable()
        inner = k.Task_disable()
        k.Semaphore_post(sem[0])
        b.note((outer, inner))
        k.Task_restore(inner)
        b.note("still low")
        k.Task_restore(outer)

    b.boot(
        lambda: sem.append(b.semaphore()),
        lambda: b.task(logger(b, "high", lambda: k.Semaphore_pend(sem[0], FOREVER)), 3),
        lambda: b.task(logger(b, "low", low), 2),
    )
    k.run_until(1)
    assert b.log == [(0, 1), "still low", "high0", "low0"]


def test_a_task_is_pre_empted_between_two_charges() -> None:
    b = Bench()
    k = b.kernel
    sem: list[Any] = []

    def low() -> None:
        for i in range(4):
            b.clock.charge(TICK // 2)
            b.note(i)

    b.boot(
        lambda: sem.append(b.semaphore()),
        lambda: b.timer(lambda _arg: k.Semaphore_post(sem[0]), 1),
        lambda: b.task(logger(b, "high", lambda: k.Semaphore_pend(sem[0], FOREVER)), 3),
        lambda: b.task(logger(b, "low", low), 2),
    )
    b.run_ticks(3)
    # Half a tick each: 100,000 + 100,000 lies a cycle before tick 1 (period 200,001), so it falls into the third.
    assert b.log == [0, 1, "high0", 2, 3, "low0"]


def test_return_from_the_function_ends_the_task() -> None:
    b = Bench()
    made: list[Any] = []
    b.boot(lambda: made.append(b.task(logger(b, "a", nothing), 1)))
    b.kernel.run_until(1)
    assert b.kernel.Task_getMode(made[0]) == 3
    assert b.kernel.exit_status is None


def test_the_end_of_the_last_vital_task_ends_the_program() -> None:
    b = Bench(idle_vital=False)
    b.boot(
        lambda: b.task(logger(b, "vital", nothing), 1),
        lambda: b.task(logger(b, "other", lambda: b.kernel.Task_sleep(5)), 2, vitalTaskFlag=0),
    )
    b.kernel.run_until(10 * MS)
    assert b.log == ["vital0"]
    assert b.kernel.exit_status == 0
    assert b.clock.now == 10 * MS


def test_arguments_reach_the_task_and_unused_ones_are_dropped() -> None:
    b = Bench()
    b.boot(
        lambda: b.task(lambda a0, a1: b.note((a0, a1)), 3, arg0=7, arg1=9),
        lambda: b.task(lambda: b.note("none"), 2),
    )
    b.kernel.run_until(1)
    assert b.log == [(7, 9), "none"]


def test_a_function_that_wants_more_arguments_is_refused() -> None:
    b = Bench()
    with pytest.raises(ValueError, match="wants 3 arguments, the kernel passes 2"):
        b.boot(lambda: b.task(lambda a, c, d: None, 1))


def test_eallow_set_at_a_voluntary_block_leaks_into_the_next_task() -> None:
    """ST1 is not part of what TaskSupport_swap saves; only an interrupt saves and clears it."""
    b = Bench()
    k = b.kernel

    def first() -> None:
        b.cpu.eallow = True
        k.Task_sleep(1)

    b.boot(
        lambda: b.task(logger(b, "first", first), 2),
        lambda: b.task(logger(b, "second", lambda: b.note(b.cpu.eallow)), 1),
    )
    b.run_ticks(0)
    assert b.log[0] is True


def test_a_pre_empted_task_gets_its_eallow_back() -> None:
    b = Bench()
    k = b.kernel
    sem: list[Any] = []

    def low() -> None:
        b.cpu.eallow = True
        b.clock.charge(TICK + 5)
        b.note(b.cpu.eallow)

    def high() -> None:
        k.Semaphore_pend(sem[0], FOREVER)
        b.note(b.cpu.eallow)

    b.boot(
        lambda: sem.append(b.semaphore()),
        lambda: b.timer(lambda _arg: k.Semaphore_post(sem[0]), 1),
        lambda: b.task(logger(b, "high", high), 3),
        lambda: b.task(logger(b, "low", low), 2),
    )
    b.run_ticks(2)
    assert b.log == [False, "high0", True, "low0"]


def test_making_an_equal_ready_is_no_switch() -> None:
    b = Bench()
    b.listen()
    k = b.kernel
    sem = b.semaphore()
    b.boot(
        lambda: b.task(logger(b, "w", lambda: k.Semaphore_pend(sem, FOREVER)), 2),
        lambda: b.task(logger(b, "p", lambda: k.Semaphore_post(sem), nothing), 2),
    )
    k.run_until(1)
    assert [name for _, name in b.kinds("switch")] == ["w", "p", "w", "Idle"]


def test_disabled_interrupts_belong_to_the_task_that_disabled_them() -> None:
    b = Bench()
    k = b.kernel
    sem = b.semaphore()

    def first() -> None:
        key = k.Hwi_disable()
        k.Semaphore_pend(sem, FOREVER)
        b.note(("first", b.cpu.intm))
        k.Hwi_restore(key)

    def second() -> None:
        b.note(("second", b.cpu.intm))
        k.Semaphore_post(sem)
        b.note(("second", b.cpu.intm))

    b.boot(lambda: b.task(logger(b, "a", first), 2), lambda: b.task(logger(b, "b", second), 1))
    k.run_until(1)
    assert b.log == [("second", False), ("first", True), "a0", ("second", False), "b0"]
