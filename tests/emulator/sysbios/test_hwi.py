"""Rules of hardware interrupts and their dispatcher (family/c28/Hwi.c 6.83)."""

from __future__ import annotations

from typing import Any

import pytest

from emulator.sysbios.core import KernelError
from tests.emulator.sysbios.bench import Bench, Struct

SCIC_RX = 92  # 32 + 8 * (8 - 1) + 4: INT8.5
SCIC_TX = 93
ADCA1 = 32  # INT1.1


def handler(b: Bench, name: str, cycles: int = 0) -> Any:
    def function(_arg: int) -> None:
        b.note(name)
        if cycles:
            b.clock.charge(cycles)
            b.note(f"{name} end")

    function.__name__ = name
    return function


def run(b: Bench, body: Any, *setup: Any) -> None:
    b.boot(*setup, lambda: b.task(lambda _a, _c: body(), 1))
    b.kernel.run_until(b.clock.now + 100_000)


@pytest.mark.parametrize(
    ("number", "ier_bit"), [(14, 13), (13, 12), (32, 0), (39, 0), (40, 1), (92, 7), (127, 11), (128, 0), (223, 11)]
)
def test_the_ier_bit_of_an_interrupt(number: int, ier_bit: int) -> None:
    b = Bench()
    b.kernel.hwis.table.clear()  # 14 belongs to the tick
    b.kernel.Hwi_create(number, handler(b, "h"), None, None)
    assert b.cpu.ier == 1 << ier_bit
    assert b.pie.enabled == ({number} if number >= 32 else set())
    assert (number in b.pie.vectors) == (number >= 32)


@pytest.mark.parametrize("number", [0, 16, 31, 224])
def test_a_number_that_is_no_interrupt_asserts(number: int) -> None:
    b = Bench()
    with pytest.raises(KernelError, match="Hwi_A_badIntNum"):
        b.kernel.Hwi_create(number, handler(b, "h"), None, None)


def test_a_second_handler_is_an_error_or_null() -> None:
    b = Bench()
    b.kernel.Hwi_create(SCIC_RX, handler(b, "one"), None, None)
    with pytest.raises(KernelError, match="Hwi_E_alreadyDefined"):
        b.kernel.Hwi_create(SCIC_RX, handler(b, "two"), None, None)
    block = Struct()
    block.values["id"] = 0
    assert b.kernel.Hwi_create(SCIC_RX, handler(b, "two"), None, block) is None
    assert b.kernel.Error_getId(block) != 0


def test_without_enable_int_nothing_is_enabled() -> None:
    b = Bench()
    params = Struct()
    b.kernel.Hwi_Params_init(params)
    params.values["enableInt"] = 0
    b.kernel.Hwi_create(SCIC_RX, handler(b, "h"), params, None)
    assert b.cpu.ier == 0
    assert b.pie.enabled == set()
    b.kernel.Hwi_enableInterrupt(SCIC_RX)
    assert b.cpu.ier == 1 << 7
    b.kernel.Hwi_disableInterrupt(SCIC_RX)
    assert b.pie.enabled == set()
    assert b.cpu.ier == 1 << 7  # the group's IER bit is left alone


@pytest.mark.parametrize(("number", "bit"), [(14, 1 << 13), (SCIC_RX, 1 << 4), (128 + 9, 1 << 8 + 1)])
def test_enabling_and_disabling_give_the_old_bit_in_its_place(number: int, bit: int) -> None:
    """IER of a CPU interrupt, PIEIER of the PIE; no handler is needed."""
    k = Bench().kernel
    calls = (k.Hwi_disableInterrupt, k.Hwi_enableInterrupt, k.Hwi_enableInterrupt, k.Hwi_disableInterrupt)
    assert [call(number) for call in calls] == [0, 0, bit, bit]


def test_enabling_an_interrupt_of_the_pie_without_a_handler_sets_the_bit_of_its_group() -> None:
    b = Bench()
    b.kernel.Hwi_enableInterrupt(SCIC_RX)
    assert (b.cpu.ier, b.pie.enabled) == (1 << 7, {SCIC_RX})


@pytest.mark.parametrize("number", [0, 15, 31, 224])
def test_a_number_that_cannot_be_enabled_asserts(number: int) -> None:
    k = Bench().kernel
    for call in (k.Hwi_enableInterrupt, k.Hwi_disableInterrupt):
        with pytest.raises(KernelError, match="Hwi_A_badIntNum"):
            call(number)


def test_a_pie_interrupt_is_acknowledged_before_the_handler_runs() -> None:
    b = Bench()
    run(
        b,
        lambda: (b.pie.request(SCIC_RX), b.clock.charge(100)),
        lambda: b.kernel.Hwi_create(SCIC_RX, lambda _arg: b.note(list(b.pie.acknowledged)), None, None),
    )
    assert b.log == [[8]]


def test_the_argument_and_context_of_a_handler() -> None:
    b = Bench()
    params = Struct()
    b.kernel.Hwi_Params_init(params)
    params.values["arg"] = 77

    def receive(arg: int) -> None:
        b.note((arg, b.kernel.context(), b.kernel.BIOS_getThreadType(), b.cpu.sp))

    run(
        b,
        lambda: (b.pie.request(SCIC_RX), b.clock.charge(100)),
        lambda: b.kernel.Hwi_create(SCIC_RX, receive, params, None),
    )
    assert b.log == [(77, "Hwi:receive", 0, 0x400)]


@pytest.mark.parametrize(
    ("second", "masking", "log"),
    [
        (SCIC_TX, None, ["rx", "rx end", "tx"]),  # SELF: the same group waits
        (ADCA1, None, ["rx", "tx", "rx end"]),  # another group nests
        (ADCA1, 1, ["rx", "rx end", "tx"]),  # ALL
        (SCIC_TX, 0, ["rx", "tx", "rx end"]),  # NONE
        (ADCA1, 3, ["rx", "rx end", "tx"]),  # BITMASK with bit 0
        (SCIC_TX, 4, ["rx", "rx end", "tx"]),  # LOWER is SELF here
    ],
)
def test_nesting_by_masking_option(second: int, masking: int | None, log: list[str]) -> None:
    b = Bench()
    params = Struct()
    b.kernel.Hwi_Params_init(params)
    if masking is not None:
        params.values.update(maskSetting=masking, disableMask=1, restoreMask=1)

    def receive(_arg: int) -> None:
        b.note("rx")
        b.pie.request(second)
        b.clock.charge(50)
        b.note("rx end")

    run(
        b,
        lambda: (b.pie.request(SCIC_RX), b.clock.charge(100)),
        lambda: b.kernel.Hwi_create(SCIC_RX, receive, params, None),
        lambda: b.kernel.Hwi_create(second, handler(b, "tx"), None, None),
    )
    assert b.log == log
    assert b.cpu.in_interrupt == 0
    # All lines enabled again: INT14 of the tick, group 8, and the second's group.
    assert b.cpu.ier == 1 << 13 | 1 << 7 | (1 if second == ADCA1 else 0)


def test_disable_holds_interrupts_until_the_outermost_restore() -> None:
    b = Bench()
    k = b.kernel

    def body() -> None:
        outer = k.Hwi_disable()
        inner = k.Hwi_disable()
        b.pie.request(SCIC_RX)
        b.clock.charge(500)
        k.Hwi_restore(inner)
        b.clock.charge(500)
        b.note((outer, inner))
        k.Hwi_restore(outer)
        b.note("body")

    run(b, body, lambda: k.Hwi_create(SCIC_RX, handler(b, "rx"), None, None))
    assert b.log == [(0, 1), "rx", "body"]


def test_enable_lets_interrupts_through_and_tells_what_was() -> None:
    b = Bench()
    k = b.kernel

    def body() -> None:
        k.Hwi_disable()
        b.pie.request(SCIC_RX)
        b.note(k.Hwi_enable())
        b.note(k.Hwi_enable())

    run(b, body, lambda: k.Hwi_create(SCIC_RX, handler(b, "rx"), None, None))
    assert b.log == ["rx", 1, 0]


def test_main_runs_with_interrupts_off() -> None:
    b = Bench()

    def main() -> None:
        b.kernel.Hwi_create(SCIC_RX, handler(b, "rx"), None, None)
        b.pie.request(SCIC_RX)
        b.clock.charge(1000)
        b.note("main")

    b.boot(main)
    b.kernel.run_until(b.clock.now + 100)
    assert b.log == ["main", "rx"]


def test_swis_and_tasks_follow_after_the_outermost_handler() -> None:
    b = Bench()
    k = b.kernel
    sem = b.semaphore()
    swi = b.swi(lambda: b.note("swi"), 5)

    def receive(_arg: int) -> None:
        k.Semaphore_post(sem)
        k.Swi_post(swi)
        b.note("rx")

    b.boot(
        lambda: k.Hwi_create(SCIC_RX, receive, None, None),
        lambda: b.task(lambda: (k.Semaphore_pend(sem, 0xFFFF), b.note("high")), 3),
        lambda: b.task(lambda: (b.pie.request(SCIC_RX), b.clock.charge(10), b.note("low")), 1),
    )
    k.run_until(1000)
    assert b.log == ["rx", "swi", "high", "low"]


def test_a_handler_in_a_task_that_holds_the_scheduler_switches_at_its_restore() -> None:
    b = Bench()
    k = b.kernel
    sem = b.semaphore()

    def low() -> None:
        key = k.Task_disable()
        b.pie.request(SCIC_RX)
        b.clock.charge(10)
        b.note("low")
        k.Task_restore(key)

    b.boot(
        lambda: k.Hwi_create(SCIC_RX, lambda _arg: k.Semaphore_post(sem), None, None),
        lambda: b.task(lambda: (k.Semaphore_pend(sem, 0xFFFF), b.note("high")), 3),
        lambda: b.task(low, 1),
    )
    k.run_until(1000)
    assert b.log == ["low", "high"]


@pytest.mark.parametrize("call", ["enter", "sleep", "create"])
def test_what_a_handler_must_not_call(call: str) -> None:
    b = Bench()
    k = b.kernel
    gate = k.GateMutexPri_create(None, None)
    calls = {
        "enter": lambda: k.GateMutexPri_enter(gate),
        "sleep": lambda: k.Task_sleep(1),
        "create": lambda: b.task(lambda: None, 1),
    }
    names = {
        "enter": "GateMutexPri_A_badContext",
        "sleep": "Task_A_sleepTaskDisabled",
        "create": "Task_A_badThreadType",
    }
    with pytest.raises(KernelError, match=names[call]):
        run(
            b,
            lambda: (b.pie.request(SCIC_RX), b.clock.charge(100)),
            lambda: k.Hwi_create(SCIC_RX, lambda _arg: calls[call](), None, None),
        )
