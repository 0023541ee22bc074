"""Telemanipulation without key releases: steps of the thesis console, one a period; a dead man."""

from __future__ import annotations

import re

from hypothesis import given
from hypothesis import strategies as st

from hil.terminal.tele import DEAD_MAN_S, PERIOD_S, Arrow, TerminalTele


def driving(now_s: float = 0.0) -> TerminalTele:
    tele = TerminalTele()
    tele.begin(now_s)
    return tele


def test_the_steps_are_those_of_the_thesis_console() -> None:
    # Annex 2: up and down +-0.01 m/s, left +0.03, right -0.03 rad/s, every 101 ms.
    assert PERIOD_S == 0.101
    for arrow, data in (
        (Arrow.UP, b"#SETR0.01,0.0\r"),
        (Arrow.DOWN, b"#SETR-0.01,0.0\r"),
        (Arrow.LEFT, b"#SETR0.0,0.03\r"),
        (Arrow.RIGHT, b"#SETR0.0,-0.03\r"),
    ):
        tele = driving()
        tele.press(arrow, 0.0)
        assert tele.tick(0.1) == data


def test_a_held_key_repeats_faster_than_the_period_and_counts_once_in_it() -> None:
    tele = driving()
    for _ in range(4):
        tele.press(Arrow.UP, 0.0)
    assert tele.tick(0.1) == b"#SETR0.01,0.0\r"


def test_two_axes_change_in_one_period_and_of_two_keys_of_one_axis_the_later_counts() -> None:
    tele = driving()
    for arrow in (Arrow.UP, Arrow.LEFT, Arrow.DOWN):
        tele.press(arrow, 0.0)
    assert tele.tick(0.1) == b"#SETR-0.01,0.03\r"


def test_a_speed_holds_until_the_dead_man_and_then_both_are_zero() -> None:
    tele = driving()
    tele.press(Arrow.UP, 1.0)
    tele.press(Arrow.RIGHT, 1.0)
    assert tele.tick(1.1) == b"#SETR0.01,-0.03\r"
    assert tele.tick(1.0 + DEAD_MAN_S) == b"#SETR0.01,-0.03\r"
    assert tele.tick(1.01 + DEAD_MAN_S) == b"#SETR0.0,0.0\r"
    assert tele.active
    # From rest again, not from where it was.
    tele.press(Arrow.UP, 9.0)
    assert tele.tick(9.1) == b"#SETR0.01,0.0\r"


def test_beginning_again_says_that_somebody_is_there_and_changes_no_speed() -> None:
    tele = driving()
    tele.press(Arrow.UP, 0.0)
    tele.tick(0.1)
    tele.begin(DEAD_MAN_S)
    assert tele.tick(DEAD_MAN_S + 1.0) == b"#SETR0.01,0.0\r"


def test_each_telemanipulation_begins_at_rest() -> None:
    # The thesis console starts at once with the speeds of the last one.
    tele = driving()
    tele.press(Arrow.UP, 0.0)
    tele.tick(0.1)
    tele.end()
    tele.begin(0.2)
    assert tele.tick(0.3) == b"#SETR0.0,0.0\r"


@given(st.lists(st.sampled_from(Arrow), max_size=300))
def test_whatever_is_pressed_the_order_is_a_plain_decimal_within_the_limits(arrows: list[Arrow]) -> None:
    tele = driving()
    now_s = 0.0
    for arrow in arrows:
        tele.press(arrow, now_s)
        now_s += PERIOD_S
        match = re.fullmatch(rb"#SETR(-?\d\.\d{1,2}),(-?\d\.\d{1,2})\r", tele.tick(now_s))
        assert match is not None
        assert abs(float(match[1])) <= 0.5
        assert abs(float(match[2])) <= 3.0
