"""Values over virtual time."""

from __future__ import annotations

from array import array
from itertools import count, islice

import pytest

from emulator.clock import NEVER
from hil.feeds.course import REMEMBERED, STEP_CYCLES, Computed, Constant, GeneratedCourse, Points

S = 200_000_000  # cycles a second


def points(how: str, origin: int = 0) -> Points:
    return Points(array("q", [0, S, S, 3 * S]), array("d", [1.0, 2.0, 5.0, 9.0]), how, origin)


@pytest.mark.parametrize(
    ("time", "hold", "linear"),
    # Before the first point the first value, after the last the last; of two at 1 s the second counts from there on.
    [(-S, 1.0, 1.0), (0, 1.0, 1.0), (S // 2, 1.0, 1.5), (S - 1, 1.0, 2.0 - 1 / S), (S, 5.0, 5.0), (2 * S, 5.0, 7.0),
     (3 * S, 9.0, 9.0), (4 * S, 9.0, 9.0)],
)  # fmt: skip
def test_between_points_it_stays_or_goes_straight(time: int, hold: float, linear: float) -> None:
    assert points("hold").at(time) == hold
    assert points("linear").at(time) == pytest.approx(linear, abs=1e-12)
    assert points("linear", origin=7 * S).at(time + 7 * S) == pytest.approx(linear, abs=1e-12)


def test_it_says_when_to_look_again() -> None:
    hold, linear = points("hold", S), points("linear", S)
    assert [hold.after(t * S) for t in (0, 1, 2, 3, 4)] == [S, 2 * S, 4 * S, 4 * S, NEVER]
    assert [linear.after(t * S) for t in (0, 1, 4)] == [S, S + STEP_CYCLES, NEVER]
    assert linear.after(2 * S - 5) == 2 * S, "no step beyond a point"
    assert Constant(3.0).after(0) == NEVER


def test_a_function_is_asked_for_seconds_and_checked() -> None:
    checked: list[tuple[float, float]] = []
    course = Computed(lambda time_s: 2.0 * time_s, lambda value, time_s: checked.append((value, time_s)), origin=S)
    assert course.at(4 * S) == 6.0
    assert checked == [(6.0, 3.0)]


def test_an_endless_generator_is_drawn_as_far_as_it_is_needed() -> None:
    drawn: list[int] = []

    def pairs() -> object:
        for index in count():
            drawn.append(index)
            yield index, 10.0 * index

    course = GeneratedCourse(iter(pairs()), lambda value, time_s: None, "linear", 0)  # type: ignore[call-overload]
    assert course.at(2 * S + S // 2) == 25.0
    assert drawn == [0, 1, 2, 3]
    assert course.at(S // 2) == 5.0, "the past, for sensors that catch up"
    far = 2 * REMEMBERED
    assert course.at(far * S) == 10.0 * far
    assert course.at(0) == 10.0 * (far + 2 - REMEMBERED), "what is remembered is bounded"


def test_a_generator_that_ends_stays() -> None:
    course = GeneratedCourse(iter([(0.0, 1.0), (1.0, 2.0)]), lambda value, time_s: None, "hold", 0)
    assert [course.at(t * S // 2) for t in (-1, 0, 1, 2, 9)] == [1.0, 1.0, 1.0, 2.0, 2.0]
    assert course.after(S) == NEVER


def test_a_generator_that_goes_back_or_has_nothing_is_an_error() -> None:
    with pytest.raises(ValueError, match=r"time 0.5 s comes before the previous time, 1 s"):
        GeneratedCourse(iter([(0.0, 1.0), (1.0, 2.0), (0.5, 3.0)]), lambda value, time_s: None, "hold", 0).at(2 * S)
    with pytest.raises(ValueError, match="yields nothing"):
        GeneratedCourse(islice(iter([(0.0, 1.0)]), 0), lambda value, time_s: None, "hold", 0)
