"""Whatever is scheduled, cancelled and polled for: callbacks run at their times, by time, priority and scheduling."""

from __future__ import annotations

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from emulator.clock import NEVER, Clock, ClockEvent

#: (what to do, cycles, priority)
STEPS = st.lists(
    st.tuples(
        st.sampled_from(["after", "cancel", "charge", "poll", "attention"]), st.integers(0, 40), st.integers(0, 2)
    ),
    max_size=60,
)


@given(STEPS, st.integers(0, 25))
def test_events_run_in_order_at_their_times(steps: list[tuple[str, int, int]], echo: int) -> None:
    clock = Clock()
    ran: list[tuple[int, int, int]] = []
    due: dict[int, tuple[int, int, int]] = {}
    events: list[tuple[int, ClockEvent]] = []

    def schedule(cycles: int, priority: int, again: bool) -> None:
        number = len(events)
        due[number] = (clock.now + cycles, priority, number)

        def run() -> None:
            assert clock.now == due[number][0]
            ran.append(due.pop(number))
            if again:  # a callback schedules, also for this very cycle
                schedule(echo, priority, False)

        events.append((number, clock.after(cycles, run, priority)))

    for what, cycles, priority in steps:
        before = clock.now
        if what == "after":
            schedule(cycles, priority, cycles % 2 == 0)
        elif what == "cancel" and events:
            number, event = events[cycles % len(events)]
            clock.cancel(event)
            due.pop(number, None)
        elif what == "charge":
            clock.charge(cycles)
            assert clock.now == before + cycles
        elif what == "poll":
            assert clock.poll(cycles + 1) in (clock.now, NEVER)
            assert (clock.now - before) % (cycles + 1) == 0
        elif what == "attention":
            clock.request_attention()
        if what in ("charge", "poll"):
            assert all(time > clock.now for time, _, _ in due.values())
        assert clock.next <= min((time for time, _, _ in due.values()), default=clock.next)
        assert clock.events_run == len(ran)
        assert clock.pending >= len(due)
    clock.charge(100)
    assert not due
    # In order, save that a callback may add an event of a lower priority number to the cycle that it runs in.
    assert all(a[0] <= b[0] for a, b in pairwise(ran))
    assert all(a < b for a, b in pairwise(ran) if echo or a[0] != b[0])
