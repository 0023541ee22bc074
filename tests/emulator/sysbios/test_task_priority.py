"""Task_setPri and priority -1 (knl/Task.c 6.83)."""

from __future__ import annotations

from typing import Any

from tests.emulator.sysbios.bench import FOREVER, Bench, logger, nothing


def test_priority_minus_1_is_inactive_until_raised() -> None:
    b = Bench()
    made: list[Any] = []
    b.boot(
        lambda: made.append(b.task(logger(b, "dormant", nothing), -1)),
        lambda: b.task(logger(b, "waker", nothing, lambda: b.kernel.Task_setPri(made[0], 3)), 2),
    )
    assert b.kernel.Task_getMode(made[0]) == 4
    b.kernel.run_until(1)
    assert b.log == ["waker0", "dormant0", "waker1"]


# setPri: a table of (who is changed, from, to) with two READY equals at the target.
def test_set_priority_of_a_waiting_ready_task_puts_it_at_the_tail() -> None:
    b = Bench()
    made: dict[str, Any] = {}
    b.boot(
        lambda: b.task(logger(b, "boss", lambda: b.kernel.Task_setPri(made["x"], 2)), 3),
        lambda: made.update(x=b.task(logger(b, "x", nothing), 1)),
        lambda: b.task(logger(b, "y", nothing), 2),
    )
    b.kernel.run_until(1)
    assert b.log == ["boss0", "y0", "x0"]


def test_set_priority_of_the_running_task_puts_it_at_the_front() -> None:
    b = Bench()
    k = b.kernel
    b.boot(
        lambda: b.task(logger(b, "boss", lambda: k.Task_setPri(k.Task_self(), 2)), 3),
        lambda: b.task(logger(b, "y", nothing), 2),
    )
    k.run_until(1)
    assert b.log == ["boss0", "y0"]


def test_set_priority_below_a_ready_task_switches() -> None:
    b = Bench()
    k = b.kernel
    b.boot(
        lambda: b.task(logger(b, "boss", lambda: k.Task_setPri(k.Task_self(), 1)), 3),
        lambda: b.task(logger(b, "y", nothing), 2),
    )
    k.run_until(1)
    assert b.log == ["y0", "boss0"]


def test_set_priority_returns_the_old_one_and_equal_is_no_change() -> None:
    b = Bench()
    k = b.kernel
    me: list[Any] = []
    b.boot(
        lambda: me.append(b.task(logger(b, "a", lambda: b.note(k.Task_setPri(me[0], 2))), 2)),
        lambda: b.task(logger(b, "b", nothing), 2),
    )
    k.run_until(1)
    assert b.log == [2, "a0", "b0"]


def test_set_priority_of_a_blocked_task_counts_when_it_wakes() -> None:
    b = Bench()
    k = b.kernel
    sem: list[Any] = []
    made: dict[str, Any] = {}

    def boss() -> None:
        k.Task_setPri(made["w"], 1)
        k.Semaphore_post(sem[0])

    b.boot(
        lambda: sem.append(b.semaphore()),
        lambda: made.update(w=b.task(logger(b, "w", lambda: k.Semaphore_pend(sem[0], FOREVER)), 5)),
        lambda: b.task(logger(b, "boss", boss), 3),
        lambda: b.task(logger(b, "other", nothing), 2),
    )
    k.run_until(1)
    assert b.log == ["boss0", "other0", "w0"]


def test_a_task_that_lowers_itself_stays_in_front_when_pre_empted_later() -> None:
    b = Bench()
    k = b.kernel
    sem = b.semaphore()
    b.boot(
        lambda: b.task(logger(b, "high", lambda: k.Semaphore_pend(sem, FOREVER)), 9),
        lambda: b.task(logger(b, "boss", lambda: k.Task_setPri(k.Task_self(), 2), lambda: k.Semaphore_post(sem)), 3),
        lambda: b.task(logger(b, "y", nothing), 2),
    )
    k.run_until(1)
    assert b.log == ["boss0", "high0", "boss1", "y0"]
