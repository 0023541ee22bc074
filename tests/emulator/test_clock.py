"""Virtual time: order, exactness, cancellation, idling, polling."""

from __future__ import annotations

from functools import partial

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.clock import NEVER, Clock, ClockEvent


@given(st.lists(st.tuples(st.integers(0, 50), st.integers(0, 3)), max_size=30))
def test_events_run_by_time_then_priority_then_order_of_scheduling(plan: list[tuple[int, int]]) -> None:
    clock = Clock()
    seen: list[int] = []
    for number, (time, priority) in enumerate(plan):
        clock.schedule(time, lambda number=number: seen.append(number), priority)  # type: ignore[misc]
    clock.advance_to(100)
    assert seen == sorted(range(len(plan)), key=lambda n: (plan[n][0], plan[n][1], n))
    assert clock.now == 100


@given(st.lists(st.integers(1, 40), min_size=1, max_size=20), st.lists(st.integers(0, 300), max_size=20))
def test_a_callback_sees_its_own_time_however_coarse_the_charge(charges: list[int], times: list[int]) -> None:
    clock = Clock()
    seen: list[tuple[int, int]] = []
    for time in times:
        clock.schedule(time, lambda time=time: seen.append((time, clock.now)))  # type: ignore[misc]
    for cycles in charges:
        clock.charge(cycles)
    assert all(due == at for due, at in seen)
    assert sorted(t for t in times if t <= sum(charges)) == [due for due, _ in seen]
    assert clock.now == sum(charges)


def test_an_event_scheduled_by_an_event_within_the_same_charge_runs_in_it() -> None:
    clock = Clock()
    seen: list[int] = []
    clock.schedule(10, lambda: clock.after(5, lambda: seen.append(clock.now)) and None)
    clock.charge(20)
    assert seen == [15]
    assert clock.next == NEVER


def test_a_cancelled_event_does_not_run_and_does_not_wake_anybody() -> None:
    clock = Clock()
    event = clock.schedule(10, lambda: pytest.fail("cancelled"))
    clock.schedule(30, lambda: None)
    clock.cancel(event)
    clock.cancel(event)
    clock.cancel(None)
    assert clock.next == 30
    clock.advance_to(40)


def test_scheduling_in_the_past_is_refused_and_shows_both_times() -> None:
    clock = Clock()
    clock.charge(5)
    with pytest.raises(ValueError, match=r"cycle 3 lies before now \(5\)"):
        clock.schedule(3, lambda: None)


def test_attention_comes_after_the_events_with_the_time_of_the_cpu() -> None:
    clock = Clock()
    seen: list[int] = []
    clock.serve_with(lambda: seen.append(clock.now))
    clock.schedule(4, clock.request_attention)
    clock.charge(10)
    assert seen == [10]
    clock.request_attention()
    assert seen == [10]
    clock.charge(1)
    assert seen == [10, 11]


def test_cancelling_an_event_does_not_lose_a_request_for_attention() -> None:
    clock = Clock()
    seen: list[int] = []
    clock.serve_with(lambda: seen.append(clock.now))
    event = clock.schedule(2000, lambda: None)
    clock.schedule(2010, lambda: None)
    clock.request_attention()
    clock.cancel(event)
    clock.charge(10)
    assert seen == [10]


def test_a_delay_counts_executed_cycles_so_interruption_makes_it_longer() -> None:
    clock = Clock()

    def interrupted() -> None:
        clock.charge(100)

    clock.serve_with(interrupted)
    clock.schedule(30, clock.request_attention)
    clock.delay(50)
    assert clock.now == 150


@given(st.integers(1, 1000), st.integers(1, 50))
def test_a_poll_goes_whole_iterations_to_the_first_at_or_after_the_event(due: int, iteration: int) -> None:
    clock = Clock()
    clock.schedule(due, lambda: None)
    assert clock.poll(iteration) == clock.now
    assert clock.now % iteration == 0
    assert due <= clock.now < due + iteration


def test_a_poll_without_any_event_says_so() -> None:
    clock = Clock()
    assert clock.poll(4) == NEVER
    assert clock.now == 0


def test_what_waits_is_known_by_its_callbacks() -> None:
    clock = Clock()
    ran: list[int] = []
    first, second, third = (partial(ran.append, n) for n in range(3))
    clock.after(5, first)
    later = clock.after(9, second)
    clock.after(7, third)
    assert sorted(map(id, clock.waiting())) == sorted(map(id, (first, second, third)))
    clock.cancel(later)
    clock.advance_to(6)
    assert clock.waiting() == [third]


@given(st.lists(st.tuples(st.integers(0, 9), st.integers(0, 20)), min_size=1, max_size=20))
def test_an_event_that_is_started_again_runs_once_and_at_its_last_time(steps: list[tuple[int, int]]) -> None:
    clock = Clock()
    ran: list[int] = []
    event = ClockEvent(lambda: ran.append(clock.now))
    for n in range(5):
        clock.schedule(7 * n, lambda: None)
    expected: list[int] = []
    due: int | None = None
    for cycles, ahead in steps:
        clock.advance_to(clock.now + cycles)
        if due is not None and due <= clock.now:
            expected.append(due)
        due = clock.now + ahead
        clock.start(event, due)
        assert event.waits
        assert (event.time, clock.waiting().count(event.callback)) == (due, 1)
    clock.advance_to(1000)
    assert ran == [*expected, due]
    assert not event.waits
