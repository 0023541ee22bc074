"""Rules of SYS/BIOS semaphores (knl/Semaphore.c 6.83)."""

from __future__ import annotations

from typing import Any

import pytest

from emulator.sysbios.core import KernelError
from tests.emulator.sysbios.bench import FOREVER, Bench

COUNTING, BINARY, COUNTING_PRIORITY, BINARY_PRIORITY = range(4)


def waiters(mode: int, *priorities: int) -> list[int]:
    """Tasks of these priorities block in this order (each by its own sleep); the order in which posts wake them."""
    b = Bench()
    k = b.kernel
    sem: list[Any] = []

    def waiter(i: int, priority: int) -> Any:
        def function(_a: int, _b: int) -> None:
            k.Task_sleep(i + 1)
            k.Semaphore_pend(sem[0], FOREVER)
            b.note(i)

        return function

    def poster(_a: int, _b: int) -> None:
        k.Task_sleep(20)
        for _ in priorities:
            k.Semaphore_post(sem[0])
            k.Task_sleep(1)

    b.boot(
        lambda: sem.append(b.semaphore(0, mode)),
        lambda: [b.task(waiter(i, p), p) for i, p in enumerate(priorities)],
        lambda: b.task(poster, 15),
    )
    b.run_ticks(40)
    return b.log


@pytest.mark.parametrize(
    ("mode", "priorities", "order"),
    [
        (COUNTING, (1, 5, 3), [0, 1, 2]),  # FIFO, whatever the priorities
        (BINARY, (1, 5, 3), [0, 1, 2]),
        (COUNTING_PRIORITY, (1, 5, 3), [1, 2, 0]),
        (BINARY_PRIORITY, (1, 5, 3), [1, 2, 0]),
        (COUNTING_PRIORITY, (2, 2, 4, 4), [2, 3, 0, 1]),  # FIFO among equals
    ],
)
def test_order_in_which_waiters_are_woken(mode: int, priorities: tuple[int, ...], order: list[int]) -> None:
    assert waiters(mode, *priorities) == order


@pytest.mark.parametrize(
    ("mode", "initial", "posts", "count"),
    [(COUNTING, 0, 3, 3), (COUNTING, 2, 1, 3), (BINARY, 0, 3, 1), (BINARY, 0, 1, 1), (COUNTING, 0x7FFF, 1, -32768)],
)
def test_count_after_posts(mode: int, initial: int, posts: int, count: int) -> None:
    """getCount is a 16-bit Int: 32768 reads negative."""
    b = Bench()
    sem = b.semaphore(initial, mode)
    for _ in range(posts):
        b.kernel.Semaphore_post(sem)
    assert b.kernel.Semaphore_getCount(sem) == count


def test_the_65536th_post_asserts_and_without_asserts_rolls_over() -> None:
    b = Bench()
    sem = b.semaphore(0)
    b.kernel.Semaphore_reset(sem, -1)  # 0xFFFF as a 16-bit Int
    with pytest.raises(KernelError, match="Semaphore_A_overflow"):
        b.kernel.Semaphore_post(sem)
    b = Bench(asserts=False)
    sem = b.semaphore(0)
    b.kernel.Semaphore_reset(sem, -1)
    b.kernel.Semaphore_post(sem)
    assert b.kernel.Semaphore_getCount(sem) == 0


def test_a_post_to_a_waiter_does_not_count() -> None:
    b = Bench()
    k = b.kernel
    sem: list[Any] = []
    b.boot(
        lambda: sem.append(b.semaphore()),
        lambda: b.task(lambda: k.Semaphore_pend(sem[0], FOREVER), 1),
        lambda: b.timer(lambda _arg: k.Semaphore_post(sem[0]), 2),
    )
    b.run_ticks(1)
    assert len(sem[0].waiters) == 1
    b.run_ticks(3)
    assert k.Semaphore_getCount(sem[0]) == 0


@pytest.mark.parametrize(("initial", "timeout", "result", "left"), [(2, FOREVER, 1, 1), (0, 0, 0, 0), (1, 0, 1, 0)])
def test_pend_that_need_not_wait(initial: int, timeout: int, result: int, left: int) -> None:
    b = Bench()
    sem = b.semaphore(initial)
    assert b.kernel.Semaphore_pend(sem, timeout) == result
    assert b.kernel.Semaphore_getCount(sem) == left


@pytest.mark.parametrize(
    ("narrow", "timeout", "ticks"),
    [(False, 3, 3), (True, 3, 3), (True, 0x10003, 3), (False, 0x10003, None), (False, 0xFFFF, None)],
)
def test_timeout_in_ticks(narrow: bool, timeout: int, ticks: int | None) -> None:
    """Up to 6.37 the timeout has 16 bits; 0xFFFF waits for ever in both."""
    b = Bench(narrow_timeouts=narrow)
    k = b.kernel
    sem: list[Any] = []
    b.boot(
        lambda: sem.append(b.semaphore()),
        lambda: b.task(lambda: b.note((k.Semaphore_pend(sem[0], timeout), k.Clock_getTicks())), 1),
    )
    b.run_ticks(100)
    assert b.log == ([] if ticks is None else [(0, ticks)])
    assert len(sem[0].waiters) == (1 if ticks is None else 0)
    # The temporary Clock object is gone (for the short ones), or waits (for 65,539 ticks), or never was.
    assert len(k.clocks.queue) == (1 if timeout == 0x10003 and not narrow else 0)


@pytest.mark.parametrize(("clock_first", "result"), [(True, 1), (False, 0)])
def test_post_against_timeout_in_the_same_tick_has_one_winner(clock_first: bool, result: int) -> None:
    """A Clock made before the pend is served first and posts; one made after the pend comes too late and counts."""
    b = Bench()
    k = b.kernel
    sem: list[Any] = []

    def post(_arg: int) -> None:
        k.Semaphore_post(sem[0])

    def late_maker(_a: int, _b: int) -> None:
        b.timer(post, 5)

    b.boot(
        lambda: sem.append(b.semaphore()),
        lambda: b.timer(post, 5) if clock_first else None,
        lambda: b.task(lambda: b.note(k.Semaphore_pend(sem[0], 5)), 2),
        lambda: None if clock_first else b.task(late_maker, 1),
    )
    b.run_ticks(6)
    assert b.log == [result]
    assert k.Semaphore_getCount(sem[0]) == 1 - result


def test_a_post_before_the_timeout_leaves_no_second_wake_up() -> None:
    b = Bench()
    k = b.kernel
    sem: list[Any] = []

    def waiter() -> None:
        b.note(k.Semaphore_pend(sem[0], 10))
        b.note(k.Semaphore_pend(sem[0], 20))
        b.note(k.Clock_getTicks())

    b.boot(
        lambda: sem.append(b.semaphore()),
        lambda: b.timer(lambda _arg: k.Semaphore_post(sem[0]), 4),
        lambda: b.task(waiter, 2),
    )
    b.run_ticks(30)
    assert b.log == [1, 0, 24]


def test_reset_stores_the_count_and_wakes_nobody() -> None:
    b = Bench()
    k = b.kernel
    sem: list[Any] = []
    b.boot(
        lambda: sem.append(b.semaphore()),
        lambda: b.task(lambda: b.note(k.Semaphore_pend(sem[0], FOREVER)), 2),
        lambda: b.task(lambda: k.Semaphore_reset(sem[0], 4), 1),
    )
    b.run_ticks(2)
    assert b.log == []
    assert k.Semaphore_getCount(sem[0]) == 4


def in_swi(b: Bench, action: Any) -> None:
    b.boot(lambda: b.kernel.Swi_post(b.swi(action, 1)))


@pytest.mark.parametrize(
    ("initial", "timeout", "identifier"),
    [(0, 1, "Semaphore_A_badContext"), (1, 1, "Semaphore_A_badContext"), (0, 0, None), (1, 0, None)],
)
def test_pend_in_a_swi(initial: int, timeout: int, identifier: str | None) -> None:
    """A timeout other than 0 asserts even if the count would do."""
    b = Bench()
    sem = b.semaphore(initial)
    pend = lambda: b.note(b.kernel.Semaphore_pend(sem, timeout))  # noqa: E731
    if identifier is None:
        in_swi(b, pend)
        assert b.log == [initial]
    else:
        with pytest.raises(KernelError, match=identifier):
            in_swi(b, pend)


def test_blocking_in_main_asserts() -> None:
    b = Bench()
    with pytest.raises(KernelError, match="Semaphore_A_badContext"):
        b.boot(lambda: b.kernel.Semaphore_pend(b.semaphore(0), 5))


@pytest.mark.parametrize("lock", ["Task_disable", "Swi_disable"])
def test_blocking_with_a_disabled_scheduler_asserts(lock: str) -> None:
    b = Bench()
    sem = b.semaphore()
    b.boot(lambda: b.task(lambda: (getattr(b.kernel, lock)(), b.kernel.Semaphore_pend(sem, 5)), 1))
    with pytest.raises(KernelError, match="Semaphore_A_pendTaskDisabled"):
        b.kernel.run_until(1)


def test_a_post_in_a_clock_function_switches_after_the_swi() -> None:
    b = Bench()
    k = b.kernel
    sem: list[Any] = []

    def release(_arg: int) -> None:
        k.Semaphore_post(sem[0])
        b.note("after post")

    b.boot(
        lambda: sem.append(b.semaphore()),
        lambda: b.timer(release, 1),
        lambda: b.task(lambda: (k.Semaphore_pend(sem[0], FOREVER), b.note("task")), 15),
    )
    b.run_ticks(1)
    assert b.log == ["after post", "task"]


@pytest.mark.parametrize("count", [-1, 65536])
def test_create_refuses_a_count_outside_16_bits(count: int) -> None:
    with pytest.raises(KernelError, match="Semaphore_A_overflow"):
        Bench().semaphore(count)


def test_a_post_from_a_handler_at_any_cycle_around_the_timeout_has_one_winner() -> None:
    """Also when the handler comes while the Clock Swi is about to call the timeout's function."""
    results = set()
    for delay in range(0, 900, 7):
        b = Bench(cost_scale=1.0)
        k = b.kernel
        sem = k.Semaphore_create(0, None, None)
        b.boot(
            lambda b=b, k=k, sem=sem: k.Hwi_create(92, lambda _arg: k.Semaphore_post(sem), None, None),
            lambda b=b, k=k, sem=sem: b.task(lambda: b.note(k.Semaphore_pend(sem, 3)), 2),
        )
        b.clock.schedule(b.tick_time(3) + delay, lambda b=b: b.pie.request(92))
        b.run_ticks(4)
        assert b.log == [1 - sem.count]
        results.add(b.log[0])
        k.shutdown()
    assert results == {0, 1}
