"""Time between tasks: releases, starvation, busy waits, inversion; every defect with its correct twin."""

from __future__ import annotations

import pytest

from emulator.clock import CYCLES_PER_US
from tests.emulator.sysbios.watched import Watched, found, two_tasks


def periodic(work_us: int, *, wait: str = "DelayUs({})", period: int = 5) -> str:
    """High works `work_us` every 10 ticks, Low a little every `period` ticks."""
    return two_tasks(
        "", wait.format(work_us), "DelayUs(50)", clocks=f"every(postA, 10, 10)\nevery(postB, 10, {period})"
    )


CHAIN = """
# drv.c: Middle
def Middle(a0: UArg, a1: UArg) -> void:
    while 1:
        Semaphore_pend(semC, BIOS_WAIT_FOREVER)
        DelayUs(1500)

# drv.c: High
def High(a0: UArg, a1: UArg) -> void:
    key: IArg
    while 1:
        Semaphore_pend(semA, BIOS_WAIT_FOREVER)
        {high}

# drv.c: Low
def Low(a0: UArg, a1: UArg) -> void:
    key: IArg
    n: IArg
    while 1:
        Semaphore_pend(semB, BIOS_WAIT_FOREVER)
        {low}

# drv.c: Lowest
def Lowest(a0: UArg, a1: UArg) -> void:
    n: IArg
    Task_sleep(19)
    n = GateMutexPri_enter(other)
    DelayUs(5500)
    GateMutexPri_leave(other, n)
    Task_sleep(1000)

def main() -> void:
    objects()
    {main}
    task(High, 6)
    task(Middle, 4)
    task(Low, 2)
    every(postB, 20, 20)
    every(postA, 22, 20)
    every(postC, 23, 20)
    BIOS_start()
"""
TAKE = "key = GateMutexPri_enter(gate)\n        GateMutexPri_leave(gate, key)"
#: Low takes the gate at tick 20, High wants it at 22, Middle is released at 23; Low still has 3 ms to go by then.
HOLD = "key = GateMutexPri_enter(gate)\n        {}\n        GateMutexPri_leave(gate, key)"
#: Leaving an inner gate drops what was inherited (GateMutexPri.c: leave restores the priority saved at enter).
NESTED = HOLD.format(
    "n = GateMutexPri_enter(other)\n        DelayUs(3500)\n        GateMutexPri_leave(other, n)\n        DelayUs(1000)"
)
MUTEX = "Semaphore_pend({0}, BIOS_WAIT_FOREVER)\n        {1}\n        Semaphore_post({0})"

PAIRS = {
    "a task that takes longer than its period": ("deadline", periodic(12_000, period=20), periodic(2_000, period=20)),
    "releases faster than the task": (
        "semaphore-pile-up", two_tasks("", "DelayUs(6000)", "pass", clocks="every(postA, 2, 2)"),
        two_tasks("", "DelayUs(500)", "pass", clocks="every(postA, 2, 2)"),
    ),
    "release that nobody takes": (
        "semaphore-pile-up", two_tasks("", "pass", "pass", clocks="every(postC, 2, 2)"),
        two_tasks("", "pass", "pass", clocks="every(postA, 2, 2)"),
    ),
    "a task that leaves its loop": (
        "task-ended", two_tasks("", "return", "pass", clocks="every(postA, 2, 2)"),
        two_tasks("", "continue", "pass", clocks="every(postA, 2, 2)"),
    ),
    "ready and without CPU": ("starvation", periodic(7_000, period=5), periodic(2_000, period=5)),
    "waiting in a task": (
        "busy-wait", periodic(5_000, period=40), periodic(5, wait="Task_sleep({})", period=40),
    ),
    "waiting in a Clock function": (
        "busy-wait", two_tasks("def poll() -> void:\n    DelayUs(400)\n", "pass", "pass", clocks="every(poll, 3, 3)"),
        two_tasks("def poll() -> void:\n    DelayUs(20)\n", "pass", "pass", clocks="every(poll, 3, 3)"),
    ),
    "inheritance that is lost": (
        "no-inheritance", CHAIN.format(high=TAKE, low=NESTED, main="pass"),
        CHAIN.format(high=TAKE, low=HOLD.format("DelayUs(4500)"), main="pass"),
    ),
    "a holder that sleeps": (
        "priority-inversion", CHAIN.format(high=TAKE, low=HOLD.format("Task_sleep(6)"), main="pass"),
        CHAIN.format(high=TAKE, low=HOLD.format("DelayUs(1500)"), main="pass"),
    ),
    "a semaphore as a mutex": (
        "priority-inversion",
        "mutex: Semaphore_Handle\n" + CHAIN.format(
            high=MUTEX.format("mutex", "pass"), low=MUTEX.format("mutex", "DelayUs(4500)"),
            main="mutex = Semaphore_create(1, NULL, NULL)"),
        CHAIN.format(high=TAKE, low=HOLD.format("DelayUs(4500)"), main="pass"),
    ),
    "inheritance that is not passed on": (
        "no-inheritance",
        CHAIN.format(high=TAKE, low=HOLD.format("n = GateMutexPri_enter(other)\n        GateMutexPri_leave(other, n)"),
                     main="task(Lowest, 1)"),
        CHAIN.format(high=TAKE, low=HOLD.format("DelayUs(1500)"), main="task(Lowest, 1)"),
    ),
}  # fmt: skip
#: What goes with it: who waits busily in a specimen is seen doing so.
ALLOWED = {"busy-wait", "starvation", "deadline", "semaphore-pile-up"}


@pytest.mark.parametrize("name", PAIRS)
def test_the_defect_is_found(name: str) -> None:
    rule, defect, _ = PAIRS[name]
    rules = found(defect, 120)
    assert rule in rules
    assert rules <= ALLOWED | {rule}


@pytest.mark.parametrize("name", PAIRS)
def test_its_correct_twin_is_silent(name: str) -> None:
    rules = found(PAIRS[name][2], 120)
    assert PAIRS[name][0] not in rules
    assert rules <= {"busy-wait"}


def test_an_inversion_is_told_where_the_holder_sleeps() -> None:
    specimen = Watched(CHAIN.format(high=TAKE, low=HOLD.format("Task_sleep(6)"), main="pass")).run(60)
    finding = specimen.one("priority-inversion")
    assert finding.place is not None
    assert specimen.lines[finding.place.line - 1].strip() == "Task_sleep(6)"
    assert finding.task == "Low"
    assert finding.details[1].startswith("High waits in High (drv.py:")


def test_an_inversion_names_the_own_priority_of_a_task() -> None:
    # Low passes the gate on to Lowest while no task may run.  High then wants it, and Lowest inherits 6 before it runs.
    low = HOLD.format("Task_sleep(4)\n        n = Task_disable()") + "\n        DelayUs(3000)\n        Task_restore(n)"
    text = CHAIN.format(high=TAKE, low=low, main="task(Lowest, 5)").replace("postA, 22", "postA, 26")
    waits = "Task_sleep(21)\n    n = GateMutexPri_enter(gate)\n    GateMutexPri_leave(gate, n)"
    begin, end = text.index("Task_sleep(19)"), text.index("\n    Task_sleep(1000)")
    finding = Watched(text[:begin] + waits + text[end:]).run(60).one("priority-inversion")
    assert finding.message.startswith("Lowest (priority 5) waited")


def test_a_missed_deadline_gives_the_longest_response_and_who_ran() -> None:
    """Low is released every 20 ms and needs 3 ms; High takes 19 of every 20 ms: Low cannot finish in time."""
    specimen = Watched(two_tasks(
        "", "DelayUs(19000)", "DelayUs(3000)", clocks="every(postA, 10, 20)\nevery(postB, 10, 20)"
    )).run(200)  # fmt: skip
    finding = next(f for f in specimen.findings.of("deadline") if f.object == "Low")
    # 1 ms is left of every period (less what the tick takes), so a job of 3 ms ends in the fourth period at the latest.
    assert 40_000 < finding.value < 200_000
    assert specimen.statement(finding) == "DelayUs(3000)"
    assert any("High (priority 3) ran for" in detail for detail in finding.details)
    assert finding.count > 1


def test_a_task_that_has_ended_is_told_where_its_function_begins() -> None:
    specimen = Watched(two_tasks("", "return", "pass", clocks="every(postA, 2, 2)")).run(20)
    finding = specimen.one("task-ended")
    assert finding.object == "High"
    assert finding.place is not None
    assert finding.place.function == "High"
    assert "semA is still posted" in finding.message


def test_a_task_may_end_when_nobody_posts_for_it_any_more() -> None:
    specimen = Watched(two_tasks("", "return", "pass", clocks="every(postA, 2, 0)")).run(20)
    assert not specimen.rules()


def test_a_pile_up_gives_its_size_and_where_the_task_stands() -> None:
    specimen = Watched(two_tasks("", "DelayUs(6000)", "pass", clocks="every(postA, 2, 2)")).run(61)
    finding = specimen.one("semaphore-pile-up")
    # 30 posts by tick 60, a job of a little over 6 ms: 9 or 10 taken.
    assert 18 <= finding.value <= 21
    assert finding.object == "semA"
    assert specimen.statement(finding) == "Semaphore_post(semA)"
    assert "High (priority 3) does not take them" in finding.message


def test_starvation_names_the_busy_wait_and_its_length() -> None:
    """A delay of 150 ms in a task of priority 3: nothing below has the CPU for that long."""
    specimen = Watched(two_tasks("", "DelayUs(50000)\nDelayUs(50000)\nDelayUs(50000)", "pass",
                                 clocks="every(postA, 10, 400)\nevery(postB, 11, 100)")).run(300)  # fmt: skip
    finding = specimen.one("starvation")
    assert finding.object == "Low"
    assert finding.place is not None
    assert finding.place.function == "High"
    assert 149_000 < finding.value < 152_000
    assert "was in DelayUs" in finding.message


ASKS = "if Semaphore_pend(semC, BIOS_NO_WAIT) == TRUE:"
COMPUTES = "total = total * 3 + 1"


@pytest.mark.parametrize(("turns", "statement"), [(300, ASKS), (30_000, COMPUTES)])
def test_starvation_names_the_semaphore_that_is_asked_and_not_waited_for(turns: int, statement: str) -> None:
    """With few turns between, it asks all the time; with many, it is the computation that lasts."""
    high = f"n = 0\nwhile 1:\n    {ASKS}\n        n += 1\n    for i in range({turns}):\n        {COMPUTES}"
    source = two_tasks("total: uint32 = 0\n", high, "pass", clocks="every(postA, 10, 20)\nevery(postB, 11, 40)")
    specimen = Watched(source).run(160)
    finding = specimen.one("starvation")
    assert finding.object == "Low"
    assert specimen.statement(finding) == statement


def test_a_burst_that_is_worked_off_is_no_pile_up() -> None:
    """A handler or task may post several times at once: counting is what the semaphore is for."""
    burst = "for i in range(5):\n    Semaphore_post(semB)"
    assert found(two_tasks("", burst, "pass", clocks="every(postA, 5, 5)"), 60) == set()


@pytest.mark.parametrize(("work", "rules"), [("pass", set()), ("DelayUs(1500)", {"semaphore-pile-up"})])
def test_a_clock_function_may_post_once_for_each_item(work: str, rules: set[str]) -> None:
    """Four items each 5 ms are one release; they pile up only if the next four come before these are done."""
    function = "def four() -> void:\n    i: int16\n    for i in range(4):\n        Semaphore_post(semA)\n"
    source = two_tasks(function, work, "pass", clocks="every(four, 5, 5)")
    assert found(source, 60) & {"deadline", "semaphore-pile-up"} == rules


def test_a_semaphore_of_resources_does_not_pile_up() -> None:
    source = two_tasks(
        "pool: Semaphore_Handle",
        "Semaphore_pend(pool, BIOS_WAIT_FOREVER)",
        "Semaphore_post(pool)",
        start="pool = Semaphore_create(4, NULL, NULL)",
    )
    assert found(source, 60) == set()


def test_a_loop_that_polls_is_a_busy_wait_too() -> None:
    """Nothing ends this loop but the Clock function 6 ms later; Low is ready after the first of them."""
    source = two_tasks(
        "flag: int16 = 0\n\ndef raise_flag() -> void:\n    flag = 1\n",
        "while flag == 0:\n    pass\nflag = 0",
        "pass",
        clocks="every(postA, 10, 20)\nevery(postB, 11, 40)\nevery(raise_flag, 16, 20)",
    )
    specimen = Watched(source).run(120)
    finding = specimen.one("busy-wait")
    assert specimen.statement(finding) == "while flag == 0:"
    assert "a polling loop while Low (priority 2)" in finding.message
    assert "starvation" not in specimen.rules()


def test_a_post_of_a_handler_is_no_release_even_where_it_interrupts_a_clock_function() -> None:
    """High is interrupt-driven and takes longer than the period of the Clock object that happens to run."""
    source = two_tasks(
        """
def isr(arg: UArg) -> void:
    Semaphore_post(semA)

def busy() -> void:
    {call}
""",
        "DelayUs(3000)",
        "pass",
        start="Hwi_create(40, isr, NULL, NULL)",
        clocks="every(busy, 2, 2)",
    )
    specimen = Watched(source.format(call="DelayUs(90)")).run(1)
    for tick in range(2, 40, 2):
        at = specimen.bench.tick_time(tick) + 40 * CYCLES_PER_US
        specimen.bench.clock.schedule(at, lambda: specimen.interrupt(40))
    assert not specimen.run(42).rules() & {"deadline", "semaphore-pile-up"}
    assert "deadline" in found(source.format(call="Semaphore_post(semA)"), 42)


#: High gets an order each 40 ticks, then works in three steps of 2 ticks; the Clock function posts all the time.
ORDERS = """
# drv.c: High
def High(a0: UArg, a1: UArg) -> void:
    n: int16
    key: IArg
    while 1:
        {order}
        while Semaphore_pend(semA, BIOS_NO_WAIT):
            pass
        for n in range(3):
            DelayUs({work})
            Semaphore_pend(semA, BIOS_WAIT_FOREVER)

# drv.c: Low
def Low(a0: UArg, a1: UArg) -> void:
    key: IArg
    while 1:
        {give}

def main() -> void:
    binary: Semaphore_Params
    objects()
    Semaphore_Params_init(addressof(binary))
    binary.mode = Semaphore_Mode_BINARY
    semA = Semaphore_create(0, addressof(binary), NULL)
    semC = Semaphore_create({count}, NULL, NULL)
    orders = Event_create(NULL, NULL)
    task(High, 6)
    task(Low, 2)
    every(postA, 2, 2)
    BIOS_start()
"""
GIVE = "Semaphore_post(semC)\n        Task_sleep(40)"
TAKE_ORDER = "Semaphore_pend(semC, BIOS_WAIT_FOREVER)"
EVENT = "orders: Event_Handle\n"


@pytest.mark.parametrize(
    ("order", "give", "work", "count", "rules"),
    [
        (TAKE_ORDER, GIVE, 300, 0, set()),
        ("Event_pend(orders, 0, 1, BIOS_WAIT_FOREVER)", "Event_post(orders, 1)\n        Task_sleep(40)", 300, 0, set()),
        # A step that takes longer than the period is late, whatever comes before the job.
        (TAKE_ORDER, GIVE, 2700, 0, {"deadline"}),
        # A wait that has an end belongs to the job; so does the wait for what another task holds.
        ("Task_sleep(15)", "Task_sleep(40)", 300, 0, {"deadline"}),
        ("Semaphore_pend(semC, 30)", GIVE, 300, 0, {"deadline"}),
        (
            f"{TAKE_ORDER}\n        Semaphore_post(semC)",
            f"{TAKE_ORDER}\n        DelayUs(9000)\n        Semaphore_post(semC)\n        Task_sleep(9)",
            300, 1, {"deadline"},
        ),
        (
            "key = GateMutexPri_enter(gate)\n        GateMutexPri_leave(gate, key)",
            "key = GateMutexPri_enter(gate)\n        DelayUs(9000)\n        GateMutexPri_leave(gate, key)\n"
            "        Task_sleep(9)",
            300, 0, {"deadline"},
        ),
    ],
)  # fmt: skip
def test_a_task_that_waits_for_its_next_order_has_no_job(
    order: str, give: str, work: int, count: int, rules: set[str]
) -> None:
    source = EVENT + ORDERS.format(order=order, give=give, work=work, count=count)
    assert found(source, 200) & {"deadline"} == rules


def test_watching_does_not_change_the_run() -> None:
    """The detectors charge no time: the same specimen ends its jobs in the same cycle."""
    source = two_tasks("n: int16 = 0", "n = n + 1\nDelayUs(700)", "DelayUs(300)")
    watched, plain = Watched(source).run(40), Watched(source, watch=False).run(40)
    assert watched.linked.objects["drv.n"].data == plain.linked.objects["drv.n"].data
    assert watched.events == plain.events
    assert watched.bench.clock.now // CYCLES_PER_US == plain.bench.clock.now // CYCLES_PER_US


#: Released once, neither comes back: High posts semC every so many ticks, Low takes from it.
SENDER = "while 1:\n    Semaphore_post(semC)\n    Task_sleep({})"
RECEIVER = "while 1:\n    Semaphore_pend(semC, BIOS_WAIT_FOREVER)\n    Task_sleep({})"


@pytest.mark.parametrize(("sends", "takes", "rules"), [(10, 11, {"semaphore-pile-up"}), (11, 10, set())])
def test_a_task_that_posts_faster_than_another_takes_for_a_second(sends: int, takes: int, rules: set[str]) -> None:
    once = "every(postA, 5, 0)\nevery(postB, 5, 0)"
    source = two_tasks("", SENDER.format(sends), RECEIVER.format(takes), clocks=once)
    # The count first stays above 0 about ten posts on (100 ms); a second later it is a backlog.
    assert found(source, 900) == set()
    assert found(source, 2500) == rules
