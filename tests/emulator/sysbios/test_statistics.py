"""Task times from the trace."""

from __future__ import annotations

import pytest

from emulator.sysbios.statistics import CycleStatistics, TaskStatistics
from tests.emulator.sysbios.bench import FOREVER, MS, TICK, Bench


def test_series() -> None:
    series = CycleStatistics()
    assert series.as_dict() == {"count": 0, "min": 0, "mean": 0, "max": 0, "total": 0}
    for value in (5, 2, 9, 2):
        series.add(value)
    assert series.as_dict() == {"count": 4, "min": 2, "mean": 4, "max": 9, "total": 18}


def feed(statistics: TaskStatistics, *events: tuple[int, str, str]) -> TaskStatistics:
    for event in events:
        statistics(*event)
    return statistics


def test_pre_emption_and_interrupts_do_not_count_as_computation() -> None:
    s = feed(
        TaskStatistics(),
        (0, "switch", "low"),
        (0, "ready", "low"),
        (100, "ready", "high"),  # low had 100
        (100, "switch", "high"),
        (150, "block", "high"),  # high had 50
        (150, "switch", "low"),
        (214, "hwi", "tick"),  # low had 50 up to the core's entry 14 cycles earlier
        (300, "hwi end", "tick"),  # the interrupt lasts to 308
        (308, "swi", "Clock"),
        (400, "swi end", "Clock"),
        (500, "block", "low"),  # low had 100 more
    )
    assert s.tasks["low"].computation.as_dict() == {"count": 1, "min": 250, "mean": 250, "max": 250, "total": 250}
    assert s.tasks["low"].response.total == 500
    assert (s.tasks["high"].computation.total, s.tasks["high"].response.total) == (50, 50)
    assert s.interrupts == {"Hwi:tick": 108, "Swi:Clock": 92}
    assert s.load(500) == {"low": 0.5, "high": 0.1, "Hwi:tick": 0.216, "Swi:Clock": 0.184}


def test_waiting_for_a_gate_does_not_end_an_activation() -> None:
    s = feed(
        TaskStatistics(),
        (0, "ready", "a"),
        (0, "switch", "a"),
        (40, "gate wait", "g"),
        (40, "block", "a"),
        (40, "switch", "b"),
        (90, "ready", "a"),
        (90, "switch", "a"),
        (100, "block", "a"),
    )
    assert s.tasks["a"].computation.as_dict() == {"count": 1, "min": 50, "mean": 50, "max": 50, "total": 50}
    assert s.tasks["a"].response.total == 100


def test_benchmarks_are_wall_clock_by_label() -> None:
    s = feed(
        TaskStatistics(),
        (10, "benchmark start", "x"),
        (30, "benchmark start", "y"),
        (50, "benchmark stop", "x"),
        (60, "benchmark stop", "z"),
        (70, "benchmark stop", "y"),
    )
    assert {name: series.total for name, series in s.benchmarks.items()} == {"x": 40, "y": 40}


@pytest.mark.parametrize("work", [10_000, 123_456, 450_000])
def test_a_periodic_tasks_computation_is_its_work_however_often_it_is_interrupted(work: int) -> None:
    """Costs 0, so an activation is the work alone; a tick in it lasts the core's 22 cycles, in the response only."""
    b = Bench()
    statistics = TaskStatistics()
    b.trace.listen(statistics)
    k = b.kernel

    def task(_a: int, _b: int) -> None:
        sem = k.Semaphore_create(0, None, None)
        b.timer(lambda _arg: k.Semaphore_post(sem), 1, period=5)
        while True:
            k.Semaphore_pend(sem, FOREVER)
            b.clock.delay(work)

    b.boot(lambda: b.task(task, 3))
    b.run_ticks(48)
    activity = statistics.tasks["task"]
    # Ready at ticks 1, 6, ... 46; the creation is an activation of its own with no work.
    assert activity.computation.count == 11
    assert (activity.computation.minimum, activity.computation.maximum) == (0, work)
    # Made ready by the Swi, 22 cycles after the tick; every further tick before the end of the work adds 22.
    assert activity.response.maximum == work + 22 * ((work + 22) // TICK)
    shares = statistics.load(b.clock.now)
    assert sum(shares.values()) == pytest.approx(1.0, abs=1e-12)
    assert shares["task"] == pytest.approx(10 * work / b.clock.now, abs=1e-9)


def test_reset_forgets_the_past() -> None:
    b = Bench(cost_scale=1.0)
    statistics = TaskStatistics()
    b.trace.listen(statistics)
    k = b.kernel

    def task(_a: int, _b: int) -> None:
        b.clock.delay(MS * 3)  # start-up
        while True:
            k.Task_sleep(2)
            b.clock.delay(1000)

    b.boot(lambda: b.task(task, 3))
    b.run_ms(10)
    assert statistics.tasks["task"].computation.maximum > MS * 3
    statistics.reset(b.clock.now)
    b.run_ms(30)
    # 1000 + switch 180 + the sleep's 160; the tick at its end is not part of it.
    assert statistics.tasks["task"].computation.maximum == 1000 + 180 + 160
    assert statistics.busy(b.clock.now) < 0.02
