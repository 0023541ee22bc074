"""Rules and traps of GateMutexPri (gates/GateMutexPri.c 6.83)."""

from __future__ import annotations

from typing import Any

import pytest

from emulator.c28x.memory import NULL
from emulator.sysbios.core import KernelError
from tests.emulator.sysbios.bench import Bench


class Story:
    """Tasks that start at given ticks and log what they do."""

    def __init__(self, gates: int = 1, **switches: Any) -> None:
        self.b = Bench(**switches)
        self.k = self.b.kernel
        self.gates = [self.k.GateMutexPri_create(None, None) for _ in range(gates)]
        self.tasks: dict[str, Any] = {}

    def task(self, name: str, priority: int, start_tick: int, *steps: Any) -> None:
        """Steps: ("enter", g), ("leave", g), ("work", ms), ("sleep", ticks), ("note",), or a callable."""

        def function(_a: int, _b: int) -> None:
            k, b = self.k, self.b
            if start_tick:
                k.Task_sleep(start_tick)
            keys: dict[int, list[int]] = {}
            for step in steps:
                if callable(step):
                    step()
                    continue
                what, *more = step
                value = more[0] if more else 0
                if what == "enter":
                    keys.setdefault(value, []).append(k.GateMutexPri_enter(self.gates[value]))
                    b.note(f"{name} in{value}")
                elif what == "leave":
                    k.GateMutexPri_leave(self.gates[value], keys[value].pop())
                    b.note(f"{name} out{value}")
                elif what == "work":
                    b.clock.delay(round(value * 200_000))
                elif what == "sleep":
                    k.Task_sleep(value)
                elif what == "pri":
                    b.note((name, k.Task_getPri(k.Task_self())))
                else:
                    b.note(f"{name} {what}")

        function.__name__ = name
        self.tasks[name] = self.b.task(function, priority)

    def run(self, ticks: int = 60) -> list[Any]:
        self.b.boot()
        self.b.run_ticks(ticks)
        return self.b.log


def story(gates: int = 1, **switches: Any) -> Story:
    return Story(gates, **switches)


def test_keys_are_0_first_1_nested_and_1_before_tasks_run() -> None:
    s = story()
    k, gate = s.k, s.gates[0]
    assert k.GateMutexPri_enter(gate) == 1
    k.GateMutexPri_leave(gate, 1)
    s.task("a", 1, 0, lambda: s.b.note([k.GateMutexPri_enter(gate) for _ in range(3)]))
    assert s.run(1) == [[0, 1, 1]]


@pytest.mark.parametrize("handle", [None, NULL, 7])
def test_before_tasks_run_a_gate_that_nobody_has_created_is_not_looked_at(handle: Any) -> None:
    kernel = Bench().kernel
    key = kernel.GateMutexPri_enter(handle)
    assert key == 1
    kernel.GateMutexPri_leave(handle, key)
    kernel.GateMutexPri_leave(handle, 0)


def test_leave_with_a_nested_key_does_nothing() -> None:
    s = story()
    s.task("a", 1, 0, ("enter", 0), ("enter", 0), ("leave", 0), ("sleep", 3), ("leave", 0))
    s.task("b", 1, 1, ("enter", 0))
    assert s.run() == ["a in0", "a in0", "a out0", "a out0", "b in0"]


def test_nested_leaves_in_the_wrong_order_release_early() -> None:
    """There is no counter: the key 0 releases, whenever it is given back."""
    s = story()
    k, gate = s.k, s.gates[0]

    def body() -> None:
        first = k.GateMutexPri_enter(gate)
        k.GateMutexPri_enter(gate)
        k.GateMutexPri_leave(gate, first)
        s.b.note(gate.free)

    s.task("a", 1, 0, body)
    assert s.run(1) == [True]


def test_the_owner_inherits_only_when_somebody_higher_waits() -> None:
    """No ceiling: the middle task pre-empts the uncontended owner; once high waits, the owner runs before middle."""
    s = story()
    s.task("low", 1, 0, ("enter", 0), ("work", 6), ("pri",), ("leave", 0), ("pri",))
    s.task("middle", 5, 2, ("begins",), ("work", 3), ("ends",))
    s.task("high", 9, 3, ("wants",), ("enter", 0), ("leave", 0))
    assert s.run() == [
        "low in0", "middle begins", "high wants",
        ("low", 9), "high in0", "high out0", "middle ends", "low out0", ("low", 1),
    ]  # fmt: skip


def test_a_raised_ready_owner_goes_behind_ready_tasks_of_that_priority() -> None:
    s = story()
    s.task("owner", 1, 0, ("enter", 0), ("work", 4), ("leave", 0))
    s.task("equal", 5, 2, ("begins",), ("work", 2), ("ends",))
    s.task("waiter", 5, 2, ("wants",), ("enter", 0))
    # equal runs first (made first); waiter blocks after it; the owner at 5 then has the CPU alone.
    assert s.run() == ["owner in0", "equal begins", "equal ends", "waiter wants", "waiter in0", "owner out0"]
    s = story()
    s.task("owner", 1, 0, ("enter", 0), ("work", 4), ("leave", 0))
    s.task("waiter", 5, 2, ("wants",), ("enter", 0))
    s.task("equal", 5, 2, ("begins",), ("work", 2), ("ends",))
    # waiter blocks first; the raised owner is behind equal, which was ready already.
    assert s.run() == ["owner in0", "waiter wants", "equal begins", "equal ends", "waiter in0", "owner out0"]


def test_inheritance_is_not_transitive() -> None:
    s = story(2)
    s.task("bottom", 1, 0, ("enter", 1), ("work", 6), ("leave", 1))
    s.task("owner", 2, 1, ("enter", 0), ("enter", 1), ("leave", 1), ("leave", 0))
    s.task("high", 9, 3, ("enter", 0))
    s.b.boot()
    s.b.run_ticks(5)
    # owner waits for gate 1 at priority 9, but bottom keeps the 2 that owner had when it began to wait.
    assert s.tasks["owner"].priority == 9
    assert s.tasks["bottom"].priority == 2


def test_leaving_an_inner_gate_drops_the_raise_of_the_outer_one() -> None:
    """Trap 4: the inner gate saved 1 before the raise; leaving it gives 1 although high still waits for the outer."""
    s = story(2)
    s.task("owner", 1, 0, ("enter", 0), ("enter", 1), ("work", 4), ("pri",), ("leave", 1), ("pri",), ("leave", 0))
    s.task("high", 9, 2, ("enter", 0), ("has",))
    log = s.run()
    assert log.index(("owner", 9)) < log.index(("owner", 1)) < log.index("high has")


def test_leaving_a_gate_taken_after_the_raise_keeps_it() -> None:
    s = story(2)
    s.task("owner", 1, 0, ("enter", 0), ("work", 4), ("enter", 1), ("leave", 1), ("pri",), ("leave", 0), ("pri",))
    s.task("high", 9, 2, ("enter", 0))
    assert s.run() == ["owner in0", "owner in1", "owner out1", ("owner", 9), "high in0", "owner out0", ("owner", 1)]


def test_a_sleeping_owner_has_its_raise_when_it_wakes() -> None:
    s = story()
    s.task("owner", 1, 0, ("enter", 0), ("sleep", 5), ("pri",), ("leave", 0))
    s.task("high", 9, 2, ("enter", 0))
    assert s.run() == ["owner in0", ("owner", 9), "high in0", "owner out0"]


@pytest.mark.parametrize(
    ("priorities", "order"),
    [((3, 5, 4), ["w1", "w2", "w0"]), ((4, 4, 4), ["w0", "w1", "w2"]), ((2, 6, 6), ["w1", "w2", "w0"])],
)
def test_waiters_get_the_gate_by_priority_then_in_order(priorities: tuple[int, ...], order: list[str]) -> None:
    s = story()
    # The owner works for 8 ticks; raised, it still sleeps between, so that all can queue up.
    s.task("owner", 1, 0, ("enter", 0), ("sleep", 8), ("leave", 0))
    for i, p in enumerate(priorities):
        s.task(f"w{i}", p, 2 + i, ("enter", 0), ("sleep", 1), ("leave", 0))
    assert [x.split()[0] for x in s.run() if str(x).endswith("in0")] == ["owner", *order]


@pytest.mark.parametrize(
    ("base", "order"),
    [(0xB800, ["w2", "w1", "w0"]), (0x2000, ["w0", "w1", "w2"])],
)
def test_the_old_fault_orders_waiters_by_half_an_address(base: int, order: list[str]) -> None:
    """Task objects above 0x7FFF read as negative priorities: last come, first served; below, the other way round."""
    s = story(gate_order_fault=True, task_object_base=base)
    s.task("owner", 1, 0, ("enter", 0), ("sleep", 8), ("leave", 0))
    for i, p in enumerate((3, 5, 4)):
        s.task(f"w{i}", p, 2 + i, ("enter", 0), ("sleep", 1), ("leave", 0))
    assert [x.split()[0] for x in s.run() if str(x).endswith("in0")] == ["owner", *order]


def test_leave_by_another_task_releases_and_is_a_finding() -> None:
    s = story()
    k, gate = s.k, s.gates[0]
    s.task("owner", 1, 0, ("enter", 0), ("sleep", 9))
    s.task("thief", 2, 2, lambda: k.GateMutexPri_leave(gate, 0))
    s.task("next", 3, 4, ("enter", 0))
    assert s.run(6) == ["owner in0", "next in0"]
    assert [f.rule for f in s.b.findings] == ["gate-owner"]


def test_waiting_with_a_disabled_scheduler_asserts_but_taking_a_free_gate_does_not() -> None:
    s = story(2)
    k = s.k
    s.task("owner", 1, 0, ("enter", 0), ("sleep", 9))
    s.task("other", 2, 2, lambda: (k.Task_disable(), s.b.note(k.GateMutexPri_enter(s.gates[1]))), ("enter", 0))
    with pytest.raises(KernelError, match="GateMutexPri_A_enterTaskDisabled"):
        s.run(6)
    assert s.b.log == ["owner in0", 0]


def test_a_gate_in_a_swi_asserts() -> None:
    b = Bench()
    gate = b.kernel.GateMutexPri_create(None, None)
    with pytest.raises(KernelError, match="GateMutexPri_A_badContext"):
        b.boot(lambda: b.kernel.Swi_post(b.swi(lambda: b.kernel.GateMutexPri_enter(gate), 1)))
