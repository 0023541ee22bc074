"""Tasks against time from kernel events that are written down here, so the spans follow from SYS/BIOS' rules."""

from __future__ import annotations

import itertools

from hil.instruments.timeline import Span, TaskState, spans

BASE = {"Low": 1, "High": 5, "Idle": 0}


def test_a_pre_empted_task_is_ready_until_it_runs_again() -> None:
    events = [
        (0, "switch", "Low"), (10, "ready", "High"), (12, "switch", "High"), (30, "block", "High"),
        (31, "switch", "Low"), (40, "block", "Low"),
    ]  # fmt: skip
    drawn = spans(events, BASE, 50)
    assert [each for each in drawn if each.lane == "Low"] == [
        Span("Low", 0, 12, TaskState.RUNNING), Span("Low", 12, 31, TaskState.READY),
        Span("Low", 31, 40, TaskState.RUNNING),
    ]  # fmt: skip
    assert [each for each in drawn if each.lane == "High"] == [
        Span("High", 10, 12, TaskState.READY), Span("High", 12, 30, TaskState.RUNNING),
    ]  # fmt: skip


def test_waiting_at_a_gate_and_the_inherited_priority_are_shown() -> None:
    events = [
        (0, "switch", "Low"), (5, "gate enter", "gate"), (10, "ready", "High"), (11, "switch", "High"),
        (20, "gate wait", "gate"), (21, "block", "High"), (22, "priority", "Low=5"), (23, "switch", "Low"),
        (40, "priority", "Low=1"), (41, "ready", "High"), (42, "switch", "High"),
    ]  # fmt: skip
    drawn = spans(events, BASE, 50)
    assert Span("High", 21, 41, TaskState.WAITING) in drawn
    assert Span("Low", 23, 40, TaskState.RUNNING, raised=True) in drawn
    assert Span("Low", 42, 50, TaskState.READY) in drawn
    assert not any(each.raised for each in drawn if each.begin >= 40)


def test_interrupts_and_swis_have_lanes_of_their_own_and_nest() -> None:
    events = [
        (0, "switch", "Low"), (5, "swi", "Clock"), (6, "hwi", "tick"), (8, "hwi end", "tick"), (9, "swi end", "Clock"),
    ]  # fmt: skip
    drawn = spans(events, BASE, 20)
    assert Span("Hwi tick", 6, 8, TaskState.RUNNING) in drawn
    assert Span("Swi Clock", 5, 9, TaskState.RUNNING) in drawn


def test_nobody_runs_twice_at_a_time() -> None:
    events = [
        (0, "switch", "Idle"), (10, "ready", "Low"), (11, "switch", "Low"), (15, "ready", "High"),
        (16, "switch", "High"), (20, "block", "High"), (21, "switch", "Low"), (30, "block", "Low"),
        (31, "switch", "Idle"),
    ]  # fmt: skip
    running = sorted((e.begin, e.end) for e in spans(events, BASE, 40) if e.state is TaskState.RUNNING)
    assert all(first[1] <= second[0] for first, second in itertools.pairwise(running))
    assert running[0][0] == 0
    assert running[-1][1] == 40
