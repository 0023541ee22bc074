"""Rules of software interrupts (knl/Swi.c 6.83)."""

from __future__ import annotations

from typing import Any

import pytest

from emulator.sysbios.core import KernelError
from tests.emulator.sysbios.bench import Bench


def named(b: Bench, name: str, *more: Any) -> Any:
    """A Swi function that notes its name, then runs the actions."""

    def function(_a: int, _b: int) -> None:
        b.note(name)
        for action in more:
            action()
        if more:
            b.note(f"{name} end")

    return function


def in_task(b: Bench, body: Any, priority: int = 1) -> None:
    b.boot(lambda: b.task(lambda _a, _c: body(), priority))
    b.kernel.run_until(b.clock.now + 1)


def test_swis_posted_in_main_run_by_priority_when_the_kernel_starts() -> None:
    b = Bench()

    def main() -> None:
        for name, priority in (("a", 2), ("b", 7), ("c", 2), ("d", 0)):
            b.kernel.Swi_post(b.swi(named(b, name), priority))
        b.note("main")

    b.boot(main)
    assert b.log == ["main", "b", "a", "c", "d"]


@pytest.mark.parametrize(
    ("posted_priority", "log"),
    [(1, ["x", "x end", "y"]), (2, ["x", "x end", "y"]), (3, ["x", "y", "x end"])],
)
def test_only_a_higher_swi_pre_empts_a_swi(posted_priority: int, log: list[str]) -> None:
    b = Bench()
    y = b.swi(named(b, "y"), posted_priority)
    x = b.swi(named(b, "x", lambda: b.kernel.Swi_post(y)), 2)
    in_task(b, lambda: b.kernel.Swi_post(x))
    assert b.log == log


def test_several_posts_before_it_starts_are_one_run() -> None:
    b = Bench()
    x = b.swi(named(b, "x"), 2)

    def body() -> None:
        key = b.kernel.Swi_disable()
        for _ in range(3):
            b.kernel.Swi_post(x)
        b.kernel.Swi_restore(key)

    in_task(b, body)
    assert b.log == ["x"]


def test_a_post_during_its_run_queues_one_more() -> None:
    b = Bench()
    made: list[Any] = []
    again = [True]

    def repost() -> None:
        if again.pop() if again else False:
            b.kernel.Swi_post(made[0])
            b.kernel.Swi_post(made[0])

    made.append(b.swi(named(b, "x", repost), 2))
    in_task(b, lambda: b.kernel.Swi_post(made[0]))
    assert b.log == ["x", "x end", "x", "x end"]


@pytest.mark.parametrize(
    ("initial", "calls", "triggers"),
    [
        (0, [("or", 5)], [5]),
        (8, [("or", 5), ("or", 2)], [13, 10]),  # each run starts again from the initial trigger
        (0, [("inc",), ("inc",)], [1, 1]),
        (3, [("andn", 1), ("andn", 2)], [0]),  # 3 -> 2 -> 0: posted once, at 0
        (2, [("dec",), ("dec",)], [0]),
        (0, [("andn", 1), ("dec",)], []),  # a trigger of 0 is left alone
        (4, [("post",)], [4]),
        (0xFFFF, [("inc",)], [0]),  # 16 bits
    ],
)
def test_triggers(initial: int, calls: list[tuple[Any, ...]], triggers: list[int]) -> None:
    b = Bench()
    k = b.kernel
    swi = b.swi(lambda: b.note(k.Swi_getTrigger()), 2, trigger=initial)
    in_task(b, lambda: [getattr(k, f"Swi_{name}")(swi, *more) for name, *more in calls])
    assert b.log == triggers
    assert swi.trigger == initial


def test_inc_counts_posts_that_became_one_run() -> None:
    b = Bench()
    k = b.kernel
    swi = b.swi(lambda: b.note(k.Swi_getTrigger()), 2)

    def body() -> None:
        key = k.Swi_disable()
        for _ in range(4):
            k.Swi_inc(swi)
        k.Swi_restore(key)

    in_task(b, body)
    assert b.log == [4]


def test_disable_nests_and_stops_task_switches_too() -> None:
    b = Bench()
    k = b.kernel
    sem: list[Any] = []

    def low() -> None:
        outer = k.Swi_disable()
        inner = k.Swi_disable()
        k.Semaphore_post(sem[0])
        k.Swi_restore(inner)
        b.note((outer, inner))
        k.Swi_enable()
        b.note("low")

    b.boot(
        lambda: sem.append(b.semaphore()),
        lambda: b.task(lambda: (k.Semaphore_pend(sem[0], 0xFFFF), b.note("high")), 3),
        lambda: b.task(low, 2),
    )
    k.run_until(1)
    assert b.log == [(0, 1), "high", "low"]


def test_a_task_readied_by_a_swi_runs_after_all_swis() -> None:
    b = Bench()
    k = b.kernel
    sem = b.semaphore()
    low = b.swi(named(b, "low swi"), 1)
    high = b.swi(named(b, "high swi", lambda: k.Semaphore_post(sem), lambda: k.Swi_post(low)), 5)
    b.boot(
        lambda: b.task(lambda: (k.Semaphore_pend(sem, 0xFFFF), b.note("task")), 9),
        lambda: b.task(lambda: (k.Swi_post(high), b.note("poster")), 1),
    )
    k.run_until(1)
    assert b.log == ["high swi", "high swi end", "low swi", "task", "poster"]


def test_the_default_priority_is_the_highest() -> None:
    b = Bench()
    assert b.kernel.Swi_getPri(b.kernel.Swi_create(named(b, "x"), None, None)) == 15


def test_a_priority_above_15_asserts() -> None:
    b = Bench()
    with pytest.raises(KernelError, match="Swi_A_badPriority"):
        b.swi(named(b, "x"), 16)


def test_context_and_stack_of_a_swi() -> None:
    b = Bench()
    k = b.kernel

    def function(a0: int, a1: int) -> None:
        b.note((a0, a1, k.context(), k.BIOS_getThreadType(), b.cpu.sp, k.Swi_self() is swi))

    swi = b.swi(function, 3, arg0=4, arg1=5)
    in_task(b, lambda: (k.Swi_post(swi), b.note((k.BIOS_getThreadType(), k.Swi_self(), b.cpu.sp))))
    assert b.log == [(4, 5, "Swi:function", 1, 0x400, True), (2, None, 0x8006)]
