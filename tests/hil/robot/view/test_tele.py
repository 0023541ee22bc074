"""Driving by hand: steps and period are the thesis console's (annex 2: 0.01 m/s and 0.03 rad/s each 0.1 s)."""

from __future__ import annotations

import itertools

from hil.robot.view.tele import BrowserTele


def driven() -> BrowserTele:
    tele = BrowserTele()
    assert tele.begin(10.0) == b"#TELE\r"
    return tele


def test_the_first_reference_follows_half_a_second_after_the_order() -> None:
    tele = driven()
    assert tele.tick(10.4) == b""
    assert tele.tick(10.5) == b"#SETR0.0,0.0\r"


def test_references_are_a_tenth_of_a_second_apart() -> None:
    tele = driven()
    sent = [now for now in range(1050, 1200) if tele.tick(now / 100)]
    assert {b - a for a, b in itertools.pairwise(sent)} == {10}


def test_a_held_arrow_adds_one_step_to_each_reference() -> None:
    tele = driven()
    tele.key("ArrowUp", True, 10.5)
    # 3 x 0.01 m/s
    assert [tele.tick(10.5), tele.tick(10.6), tele.tick(10.7)][-1] == b"#SETR0.03,0.0\r"
    tele.key("ArrowUp", False, 10.75)
    assert tele.tick(10.8) == b"#SETR0.03,0.0\r"


def test_left_turns_counter_clockwise() -> None:
    tele = driven()
    tele.key("ArrowLeft", True, 10.5)
    assert tele.tick(10.5) == b"#SETR0.0,0.03\r"
    tele.key("ArrowRight", True, 10.55)
    tele.tick(10.6)
    # 0.03 - 2 x 0.03
    assert tele.tick(10.7) == b"#SETR0.0,-0.03\r"


def test_a_key_whose_release_was_never_seen_is_let_go() -> None:
    tele = driven()
    tele.key("ArrowUp", True, 10.5)
    tele.tick(10.5)
    assert tele.tick(11.5) == tele.tick(11.6) == b"#SETR0.01,0.0\r"


def test_a_repeating_key_stays_held() -> None:
    tele = driven()
    for tenth in range(20):
        tele.key("ArrowDown", True, 10.5 + tenth / 10)
        last = tele.tick(10.5 + tenth / 10)
    assert last == b"#SETR-0.2,0.0\r"


def test_the_stick_sets_both_speeds_and_rests_at_zero() -> None:
    tele = driven()
    tele.stick(0.5, 1.0)
    assert tele.tick(10.5) == b"#SETR0.2,-0.5\r"
    tele.rest()
    assert tele.tick(10.6) == b"#SETR0.0,0.0\r"


def test_leaving_stands_still_and_the_next_drive_begins_at_rest() -> None:
    tele = driven()
    tele.stick(0.0, 1.0)
    assert tele.end() == b"#SETR0.0,0.0\r"
    assert tele.end() == b""
    assert tele.tick(12.0) == b""
    tele.begin(13.0)
    assert tele.tick(13.5) == b"#SETR0.0,0.0\r"


def test_other_keys_are_not_taken() -> None:
    assert not driven().key("m", True, 10.5)


def test_a_browser_without_a_sign_of_life_drives_no_more() -> None:
    tele = driven()
    tele.stick(0.0, 0.5)
    assert tele.tick(10.5) == b"#SETR0.1,0.0\r"
    tele.alive(14.0)
    assert tele.tick(19.0) == b"#SETR0.1,0.0\r"
    assert tele.tick(19.1) == b"#SETR0.0,0.0\r"
    assert not tele.on
    # The next drive is another one.
    tele.begin(40.0)
    assert tele.tick(40.5) == b"#SETR0.0,0.0\r"
    assert tele.on
