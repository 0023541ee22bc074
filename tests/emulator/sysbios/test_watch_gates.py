"""How gates and waits are used: every defect with its correct twin, which must be silent."""

from __future__ import annotations

import pytest

from emulator.sysbios.core import KernelError
from tests.emulator.sysbios.watched import Watched, found, two_tasks

ORDER = """
key = GateMutexPri_enter({0})
n = GateMutexPri_enter({1})
GateMutexPri_leave({1}, n)
GateMutexPri_leave({0}, key)
"""
GUARDED = "x = GateMutexPri_enter(third)\n" + ORDER + "GateMutexPri_leave(third, x)"

MONITOR = """
state: int16 = 0

def get() -> int16:
    key: IArg
    key = GateMutexPri_enter(gate)
    if state < 3:
        {leave}
        return 0
    GateMutexPri_leave(gate, key)
    return state
"""

#: Low holds `gate` and waits for `other`, High the other way round; both sleep in between so that they really meet.
EMBRACE = """
key = GateMutexPri_enter({0})
Task_sleep(2)
n = GateMutexPri_enter({1})
GateMutexPri_leave({1}, n)
GateMutexPri_leave({0}, key)
"""

ONCE = "every(postA, 5, 0)"

PAIRS = {
    "left with a made-up key": (
        "gate-key",
        two_tasks("", "key = GateMutexPri_enter(gate)\nGateMutexPri_leave(gate, 1)", "pass"),
        two_tasks("", "key = GateMutexPri_enter(gate)\nGateMutexPri_leave(gate, key)", "pass"),
    ),
    "inner leave with the outer key": (
        "gate-key",
        two_tasks("", "key = GateMutexPri_enter(gate)\nn = GateMutexPri_enter(gate)\nGateMutexPri_leave(gate, key)\n"
                  "GateMutexPri_leave(gate, n)", "pass"),
        two_tasks("", "key = GateMutexPri_enter(gate)\nn = GateMutexPri_enter(gate)\nGateMutexPri_leave(gate, n)\n"
                  "GateMutexPri_leave(gate, key)", "pass"),
    ),
    "left without being entered": (
        "gate-key", two_tasks("", "GateMutexPri_leave(gate, 1)", "pass"), two_tasks("", "pass", "pass"),
    ),
    "left twice": (
        "gate-owner",
        two_tasks("", "key = GateMutexPri_enter(gate)\nGateMutexPri_leave(gate, key)\nGateMutexPri_leave(gate, key)",
                  "pass"),
        two_tasks("", "key = GateMutexPri_enter(gate)\nGateMutexPri_leave(gate, key)", "pass"),
    ),
    "early return": (
        "gate-not-left", two_tasks(MONITOR.format(leave="pass"), "n = get()", "pass"),
        two_tasks(MONITOR.format(leave="GateMutexPri_leave(gate, key)"), "n = get()", "pass"),
    ),
    "task that ends with the gate": (
        "gate-not-left", two_tasks("", "key = GateMutexPri_enter(gate)\nreturn", "pass", clocks=ONCE),
        two_tasks("", "key = GateMutexPri_enter(gate)\nGateMutexPri_leave(gate, key)\nreturn", "pass", clocks=ONCE),
    ),
    "two gates in two orders": (
        "gate-order", two_tasks("", ORDER.format("gate", "other"), ORDER.format("other", "gate")),
        two_tasks("", ORDER.format("gate", "other"), ORDER.format("gate", "other")),
    ),
    "two gates in two orders, under a third": (
        "gate-order", two_tasks("", ORDER.format("gate", "other"), GUARDED.format("other", "gate")),
        two_tasks("", GUARDED.format("gate", "other"), GUARDED.format("other", "gate")),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", PAIRS)
def test_the_defect_is_found(name: str) -> None:
    rule, defect, _ = PAIRS[name]
    assert found(defect) == {rule}


@pytest.mark.parametrize("name", PAIRS)
def test_its_correct_twin_is_silent(name: str) -> None:
    assert found(PAIRS[name][2]) == set()


def test_a_gate_may_be_entered_in_one_function_and_left_in_another() -> None:
    source = """
held: IArg = 0

def lock() -> void:
    held = GateMutexPri_enter(gate)

def unlock() -> void:
    GateMutexPri_leave(gate, held)
"""
    assert found(two_tasks(source, "lock()\nx = 1\nunlock()", "lock()\nx = 2\nunlock()")) == set()


def test_a_forgotten_gate_is_reported_where_it_was_entered() -> None:
    specimen = Watched(two_tasks(MONITOR.format(leave="pass"), "n = get()", "pass")).run(30)
    finding = specimen.one("gate-not-left")
    assert specimen.statement(finding) == "key = GateMutexPri_enter(gate)"
    assert finding.object == "gate"
    assert "High (priority 3)" in finding.message


def test_two_tasks_that_wait_for_each_other_are_a_deadlock() -> None:
    specimen = Watched(two_tasks("", EMBRACE.format("gate", "other"), EMBRACE.format("other", "gate"))).run(60)
    assert {"deadlock", "gate-order"} <= specimen.rules()
    finding = specimen.one("deadlock")
    assert "High (priority 3)" in finding.message
    assert "Low (priority" in finding.message
    # Low took `other` first (High slept) and closes the ring when it wants `gate`, which High holds.
    assert specimen.statement(finding).startswith("n = GateMutexPri_enter(")
    (detail,) = finding.details
    assert "waits for" in detail
    calm = Watched(two_tasks("", EMBRACE.format("gate", "other"), EMBRACE.format("gate", "other"))).run(60)
    assert not calm.rules() & {"deadlock", "gate-order"}


def test_a_gate_that_nobody_enters_is_told_at_the_end() -> None:
    specimen = Watched(two_tasks("", "key = GateMutexPri_enter(gate)\nGateMutexPri_leave(gate, key)", "pass")).run(30)
    assert not specimen.findings.of("gate-unused")
    specimen.watch.finish()
    assert {f.object for f in specimen.findings.of("gate-unused")} == {"other", "third"}
    assert {specimen.statement(f) for f in specimen.findings.of("gate-unused")} == {
        "other = GateMutexPri_create(NULL, NULL)", "third = GateMutexPri_create(NULL, NULL)",
    }  # fmt: skip
    specimen.watch.finish()
    assert len(specimen.findings.of("gate-unused")) == 2


INTERRUPT = """
def release() -> void:
    key: IArg
    n: uint16
    {body}

def Low(a0: UArg, a1: UArg) -> void:
    Semaphore_pend(semB, BIOS_WAIT_FOREVER)

def main() -> void:
    objects()
    task(Low, 2)
    every(release, 5, 5)
    BIOS_start()
"""


@pytest.mark.parametrize("body", [
    "n = Semaphore_pend(semA, 10)", "key = GateMutexPri_enter(gate)", "Task_sleep(1)",
])  # fmt: skip
def test_waiting_in_a_clock_function_is_found_before_the_kernel_stops(body: str) -> None:
    specimen = Watched(INTERRUPT.format(body=body))
    with pytest.raises(KernelError):
        specimen.run(20)
    assert specimen.rules() == {"blocking-in-interrupt"}
    assert specimen.statement(specimen.one("blocking-in-interrupt")) == body


def test_asking_without_waiting_is_allowed_in_a_clock_function() -> None:
    specimen = Watched(INTERRUPT.format(body="n = Semaphore_pend(semA, BIOS_NO_WAIT)")).run(20)
    assert specimen.rules() == set()


PRODUCER = """
Full: Semaphore_Handle

# drv.c: Produce
def Produce() -> void:
    key: IArg
    key = GateMutexPri_enter(gate)
    GateMutexPri_leave(gate, key)
    Semaphore_post(Full)

# drv.c: Producer
def Producer(a0: UArg) -> void:
    while 1:
        Task_sleep(2)
        Produce()

# drv.c: Consumer
def Consumer(a0: UArg) -> void:
    key: IArg
    while 1:
        {consume}

{extra}
# drv.c: main
def main() -> void:
    objects()
    Full = Semaphore_create(0, NULL, NULL)
    task(Producer, 2)
    task(Consumer, 4)
    {start}
    BIOS_start()
"""
PEND = "Semaphore_pend(Full, {})"
HOLDING = "key = GateMutexPri_enter(gate)\n        {}\n        GateMutexPri_leave(gate, key)"
FOREVER = PEND.format("BIOS_WAIT_FOREVER")
CLOCK = "# drv.c: Other\ndef Other() -> void:\n    Semaphore_post(Full)\n"
TASK = "# drv.c: Other\ndef Other(a0: UArg) -> void:\n    Task_sleep(20)\n    Semaphore_post(Full)\n"


def test_a_pend_with_the_gate_of_the_only_poster_held_is_a_deadlock() -> None:
    specimen = Watched(PRODUCER.format(consume=HOLDING.format(FOREVER), extra="", start="pass")).run(30)
    finding = specimen.one("deadlock")
    assert specimen.statement(finding) == FOREVER
    assert (finding.object, finding.task) == ("gate", "Consumer")
    assert "Producer" in finding.message
    assert "in Produce (drv.py:" in finding.details[0]


@pytest.mark.parametrize(
    ("consume", "extra", "start"),
    [
        (FOREVER + "\n        " + HOLDING.format("DelayUs(10)"), "", "pass"),
        (HOLDING.format(PEND.format("3")), "", "pass"),
        (HOLDING.format(PEND.format("0x1FFFF")), "", "pass"),  # 32 bits: for ever is 0xFFFF alone
        (HOLDING.format(FOREVER), CLOCK, "every(Other, 20, 0)"),
        (HOLDING.format(FOREVER), TASK, "task(Other, 1)"),
        (HOLDING.format(FOREVER), CLOCK, "pass"),
    ],
    ids=[
        "left before",
        "timeout",
        "long timeout",
        "a Clock posts",
        "a third task posts",
        "nobody knows who calls a poster",
    ],
)
def test_a_wait_that_somebody_can_end_is_none(consume: str, extra: str, start: str) -> None:
    assert "deadlock" not in found(PRODUCER.format(consume=consume, extra=extra, start=start), 30)
