"""Streams of events: compared by order and payload, taken up again behind a difference."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.findings import Findings
from emulator.clock import Clock
from hil.diff.recorder import RecordedEvent, RunRecording
from hil.diff.streams import align, compare_recordings


def recording(*events: tuple[int, str]) -> RunRecording:
    return RunRecording(Findings(Clock()), {"TaskUS": [RecordedEvent(cycles, what, 0) for cycles, what in events]})


def test_equal_order_and_payload_is_equal_whatever_the_cycles() -> None:
    found = compare_recordings(recording((10, "a"), (20, "b")), recording((10, "a"), (27, "b")), 10_000_000)
    assert found.differences == []
    assert found.alike == {"TaskUS": 2}
    assert found.skew.first == (7, "TaskUS", "")  # 27 - 20


def test_behind_a_difference_both_are_taken_up_again() -> None:
    ours, theirs = recording((1, "a"), (2, "b"), (3, "c")), recording((1, "a"), (2, "x"), (3, "c"))
    (difference,) = compare_recordings(ours, theirs, 10_000_000).differences
    assert difference.cause.startswith("b in the port, x in the C, at ")
    assert difference.cause.endswith("; 1 events alike follow")


def test_what_the_end_of_the_run_cuts_off_is_no_difference() -> None:
    # The last event lies 10 cycles before the end: on the other side it comes after it.
    found = compare_recordings(recording((1, "a"), (1_000, "b")), recording((1, "a")), 1_010)
    assert found.differences == []


@given(st.lists(st.sampled_from("abc"), max_size=30), st.lists(st.sampled_from("abc"), max_size=30))
def test_every_event_is_alike_or_in_a_difference_once(ours: list[str], theirs: list[str]) -> None:
    pairs, unequal = align(ours, theirs)
    assert all(ours[i] == theirs[j] for i, j in pairs)
    assert sorted([i for i, _ in pairs] + [i for a, _ in unequal for i in a]) == list(range(len(ours)))
    assert sorted([j for _, j in pairs] + [j for _, b in unequal for j in b]) == list(range(len(theirs)))
