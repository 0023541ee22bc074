"""The mathematics: against textbooks, against a library of the PROSA project, against brute force."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil.rta.analysis import Protocol, analyse, blocking_ns, bounds, most_computation_ns, most_growth, start_up
from hil.rta.task_set import Arrival, Interrupt, Section, TaskModel, TaskSet
from tests.hil.rta.brute_force import worst_responses


def task(name: str, priority: int, period: int, computation: int, *, deadline: int = 0, jitter: int = 0) -> TaskModel:
    return TaskModel(name, priority, Arrival(period, jitter), computation, deadline or period)


def responses(task_set: TaskSet, protocol: Protocol = Protocol.INHERITANCE) -> dict[str, int | None]:
    return {response.task.name: response.response_ns for response in analyse(task_set, protocol)}


def test_the_response_times_of_burns_and_wellings() -> None:
    # Burns and Wellings, Real-Time Systems and Programming Languages, task set B: T, C = (80, 40), (40, 10), (20, 5);
    # R = 80, 15, 5: utilisation is 1 and yet every deadline is kept.
    task_set = TaskSet((task("a", 1, 80, 40), task("b", 2, 40, 10), task("c", 3, 20, 5)))
    assert responses(task_set) == {"a": 80, "b": 15, "c": 5}
    assert bounds(task_set).utilisation == pytest.approx(1)
    assert not bounds(task_set).liu_layland_holds


def test_the_response_beyond_the_period_of_lehoczky() -> None:
    # Lehoczky 1990: T, C = (70, 26), (100, 62): the worst response of the second is that of its fifth activation.
    task_set = TaskSet((task("a", 2, 70, 26), task("b", 1, 100, 62, deadline=120)))
    assert responses(task_set) == {"a": 26, "b": 118}


def test_a_full_processor_has_no_response() -> None:
    assert responses(TaskSet((task("a", 2, 10, 6), task("b", 1, 10, 5))))["b"] is None


def test_jitter_of_another_and_ones_own() -> None:
    # b: w = 3 + ceil((w + 8) / 10) * 2: 3 -> 7 -> 7; its own 1 of jitter comes on top.
    task_set = TaskSet((task("a", 2, 10, 2, jitter=8), task("b", 1, 50, 3, jitter=1)))
    found = {response.task.name: response for response in analyse(task_set)}
    assert (found["b"].ready_to_end_ns, found["b"].response_ns) == (7, 8)


def test_an_arrival_by_distances_counts_its_burst() -> None:
    # Two may come 1 apart, three span at least 10, and so on from there.
    burst = Arrival(1, distances_ns=(1, 10))
    assert [burst.count(window) for window in (0, 1, 2, 10, 11, 12)] == [0, 1, 2, 2, 3, 4]


def gated(*, nested: bool = False) -> TaskSet:
    """Gates as in a textbook: g for the highest and the lowest, h for the middle and the low, k for the last two.

    Nested: low enters h within k.
    """
    apart, within = (Section("h", 5), Section("k", 9)), (Section("k", 9, (Section("h", 5),)),)
    return TaskSet(
        (
            TaskModel("high", 4, Arrival(1000), 10, 1000, (Section("g", 2),)),
            TaskModel("middle", 3, Arrival(1000), 20, 1000, (Section("h", 3),)),
            TaskModel("low", 2, Arrival(1000), 30, 1000, within if nested else apart),
            TaskModel("lowest", 1, Arrival(1000), 40, 1000, (Section("g", 7), Section("k", 4))),
        )
    )


@pytest.mark.parametrize(
    ("protocol", "expected"),
    [
        # high: g of lowest.  middle: h of low and g of lowest.  low: g or k of lowest, once.
        (Protocol.INHERITANCE, {"high": 7, "middle": 12, "low": 7, "lowest": 0}),
        (Protocol.CEILING, {"high": 7, "middle": 7, "low": 7, "lowest": 0}),
    ],
)
def test_blocking(protocol: Protocol, expected: dict[str, int]) -> None:
    task_set = gated()
    assert {task.name: blocking_ns(task_set, task, protocol) for task in task_set.tasks} == expected


def test_without_inheritance_all_between_run_before_the_owner() -> None:
    # high waits for lowest, and all run before that, once each in so short a time: 10 + 20 + 30 + 40.
    assert responses(gated(), Protocol.NONE)["high"] == 100
    assert responses(gated(nested=True), Protocol.INHERITANCE) == responses(gated(), Protocol.NONE)
    assert responses(gated(), Protocol.INHERITANCE)["high"] == 17


def test_a_gate_within_a_gate_under_the_ceiling() -> None:
    tasks = (
        TaskModel("high", 3, Arrival(1000), 10, 1000, (Section("b", 2),)),
        TaskModel("middle", 2, Arrival(1000), 20, 1000, (Section("a", 3),)),
        TaskModel("low", 1, Arrival(1000), 30, 1000, (Section("a", 12, (Section("b", 5),)),)),
    )
    # high: b of low.  middle: all of a, with b in it.  Without a ceiling: all run before high, once each.
    assert responses(TaskSet(tasks), Protocol.CEILING) == {"high": 15, "middle": 42, "low": 60}
    assert responses(TaskSet(tasks))["high"] == 60


def test_who_may_wait_in_a_circle_has_no_bound() -> None:
    one, other, outside = (
        TaskModel("one", 4, Arrival(1000), 10, 1000, (Section("a", 4, (Section("b", 2),)),)),
        TaskModel("other", 2, Arrival(1000), 10, 1000, (Section("b", 5, (Section("a", 2),)),)),
        TaskModel("outside", 5, Arrival(1000), 10, 1000),
    )
    both = TaskSet((one, other, outside))
    assert both.circles() == {"a", "b"}
    assert responses(both) == {"outside": 10, "one": None, "other": None}
    # b of other is 5 long, and nobody waits within it.
    assert responses(both, Protocol.CEILING) == {"outside": 10, "one": 25, "other": 30}
    # A third that holds c meanwhile, and a fourth that wants c, wait with them.
    third = TaskModel("third", 3, Arrival(1000), 10, 1000, (Section("c", 3, (Section("a", 1),)),))
    fourth = TaskModel("fourth", 1, Arrival(1000), 10, 1000, (Section("c", 3),))
    found = responses(TaskSet((one, other, third, fourth, outside)), Protocol.NONE)
    assert [name for name, time in found.items() if time is not None] == ["outside"]


def test_a_circle_takes_two() -> None:
    a_b, b_c, c_a = (
        Section(x, 4, (Section(y, 2),)) for x, y in (("a", "b"), ("b", "c"), ("c", "a"))
    )  # fmt: skip
    tasks = [TaskModel(f"t{n}", n, Arrival(1000), 50, 1000, sections) for n, sections in enumerate([(a_b,), (b_c,)], 1)]
    assert TaskSet(tuple(tasks)).circles() == frozenset()
    # Whoever enters all of them one within the other waits for nobody but oneself.
    alone = TaskModel("alone", 1, Arrival(1000), 50, 1000, (a_b, b_c, c_a))
    assert TaskSet((alone,)).circles() == frozenset()
    tasks.append(TaskModel("t3", 3, Arrival(1000), 50, 1000, (c_a,)))
    assert TaskSet(tuple(tasks)).circles() == {"a", "b", "c"}


def test_one_gate_blocks_once_though_two_below_enter_it() -> None:
    tasks = [TaskModel(f"t{p}", p, Arrival(1000), 50, 1000, (Section("g", 10 * p),)) for p in (1, 2, 3)]
    assert blocking_ns(TaskSet(tuple(tasks)), tasks[2], Protocol.INHERITANCE) == 20


def test_growth_is_the_last_that_keeps_every_deadline() -> None:
    task_set = TaskSet((task("a", 2, 10, 2), task("b", 1, 20, 6)))
    # b ends at 20 with 6 + x from a: two of a in 20 -> a may take 7; b may take 20 - 2 * 2.
    assert most_computation_ns(task_set, "a") == 7
    assert most_computation_ns(task_set, "b") == 16
    assert most_growth(TaskSet((task("a", 1, 1000, 250),))) == 4
    assert most_growth(TaskSet((task("a", 1, 1000, 1001),))) is None


def test_interrupts_and_switches_are_on_top() -> None:
    task_set = TaskSet((task("a", 1, 100, 10),), (Interrupt("tick", Arrival(10), 2),), switch_ns=1)
    # w = 10 + 2 + 2 * ceil(w / 10): 12 -> 16 -> 16.
    assert responses(task_set)["a"] == 16


def test_start_up() -> None:
    # Above, 50 at once and then 10 every 100 from the first release at 60: 30 + 50 + ... = 80, one release in: 90.
    first = TaskModel("first", 2, Arrival(100), 10, 100, start_up_ns=50)
    second = TaskModel("second", 1, Arrival(20), 1, 20, start_up_ns=30)
    ready = {found.task.name: (found.ready_ns, found.releases) for found in start_up(TaskSet((first, second)), 60)}
    assert ready == {"first": (50, 0), "second": (90, 2)}


PERIODS = [4, 5, 6, 8, 10, 12, 15, 20, 24, 30]


@st.composite
def task_sets(draw: st.DrawFn) -> TaskSet:
    """Up to four tasks of different priorities that do not fill the processor."""
    count = draw(st.integers(1, 4))
    tasks = []
    for priority in range(count, 0, -1):
        period = draw(st.sampled_from(PERIODS))
        tasks.append(task(f"t{priority}", priority, period, draw(st.integers(1, max(1, period // 2)))))
    while sum(t.utilisation for t in tasks) > 1:
        tasks.pop()
    return TaskSet(tuple(tasks))


@settings(max_examples=200, deadline=None)
@given(task_sets())
def test_at_the_critical_instant_what_is_seen_is_what_was_computed(task_set: TaskSet) -> None:
    seen = worst_responses(task_set.tasks, dict.fromkeys((t.name for t in task_set.tasks), 0))
    assert seen == responses(task_set)


@settings(max_examples=200, deadline=None)
@given(task_sets(), st.data())
def test_no_phasing_gives_more_than_was_computed(task_set: TaskSet, data: st.DataObject) -> None:
    offsets = {t.name: data.draw(st.integers(0, t.arrival.period_ns - 1)) for t in task_set.tasks}
    computed = responses(task_set)
    for name, seen in worst_responses(task_set.tasks, offsets).items():
        assert seen <= (computed[name] or 0)


@settings(max_examples=150, deadline=None)
@given(task_sets(), st.data())
def test_as_the_library_of_the_prosa_project(task_set: TaskSet, data: st.DataObject) -> None:
    from response_time_analysis import fp, model  # imported here: only this test needs it

    tasks = [
        TaskModel(
            t.name, t.priority, Arrival(t.arrival.period_ns, data.draw(st.integers(0, 6))), t.computation_ns, 1000
        )
        for t in task_set.tasks
    ]
    blocked = data.draw(st.integers(0, 5))
    ours = analyse(TaskSet(tuple(tasks)), blocked_ns=dict.fromkeys((t.name for t in tasks), blocked))
    # The lowest priority of theirs blocks by a section that nobody pre-empts, one longer: it must have begun before.
    theirs = [
        model.Task(
            model.PeriodicWithJitter(period=t.arrival.period_ns, jitter=t.arrival.jitter_ns),
            model.FullyPreemptive(model.WCET(t.computation_ns)), model.Deadline(1000), model.Priority(t.priority),
        )
        for t in tasks
    ]  # fmt: skip
    if blocked:
        theirs.append(
            model.Task(
                model.Sporadic(mit=10**6), model.FullyNonPreemptive(model.WCET(blocked + 1)), model.Deadline(10**6),
                model.Priority(0),
            )
        )  # fmt: skip
    for response in ours:
        of_theirs = theirs[tasks.index(response.task)]
        solution = fp.rta(model.taskset(*theirs), of_theirs, model.IdealProcessor(), horizon=100_000)
        if response.response_ns is None or not solution.bound_found():
            assert response.response_ns is None
            assert not solution.bound_found()
            continue
        # Theirs counts from the release itself, as late as that may be.
        assert solution.response_time_bound == response.ready_to_end_ns
