"""Orders as bytes."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hil.client.orders import (
    TimedOrder,
    checked,
    order,
    parse_order,
    parse_timed_order,
    parse_words,
    set_reference,
)


@pytest.mark.parametrize(
    ("word", "data"),
    [
        ("stop", b"#STOP\r"),
        ("mission", b"#MISN\r"),
        ("tele", b"#TELE\r"),
        ("calibrate", b"#CALB\r"),
        ("init", b"#INIT\r"),
    ],
)
def test_each_word_is_its_order(word: str, data: bytes) -> None:
    assert order(word) == parse_order(word.upper()) == parse_order(data[1:5].decode()) == data
    assert parse_order(data.decode()) == data


@pytest.mark.parametrize("text", ["set 0.2 0", "SETR0.2,0.0", "setr 0.2, 0", "set 0.2,0"])
def test_set_is_understood_as_people_and_the_console_write_it(text: str) -> None:
    assert parse_order(text) == b"#SETR0.2,0.0\r"


@given(st.floats(-1000, 1000), st.floats(-1000, 1000))
def test_speeds_have_no_exponent_and_come_back(v: float, w: float) -> None:
    data = set_reference(v, w)
    assert data.startswith(b"#SETR")
    assert data.endswith(b"\r")
    assert b"e" not in data
    v_text, w_text = data[5:-1].split(b",")
    # Six decimals: half a millionth.
    assert math.isclose(float(v_text), v, abs_tol=6e-7)
    assert math.isclose(float(w_text), w, abs_tol=6e-7)


@pytest.mark.parametrize("bad", [math.nan, math.inf, 1e6])
def test_a_speed_that_is_none_is_refused(bad: float) -> None:
    with pytest.raises(ValueError, match="speed"):
        set_reference(bad, 0.0)


def test_a_time_before_the_colon_is_the_orders_time() -> None:
    assert parse_timed_order("12.5:STOP") == TimedOrder(12.5, b"#STOP\r")
    assert parse_timed_order("MISN") == TimedOrder(0.0, b"#MISN\r")
    assert parse_timed_order("3:set 0.1 -0.3") == TimedOrder(3.0, b"#SETR0.1,-0.3\r")


def test_a_row_of_words_is_a_row_of_orders() -> None:
    assert parse_words(["tele", "set", "-0.1", "0.3", "stop"]) == [b"#TELE\r", b"#SETR-0.1,0.3\r", b"#STOP\r"]


@pytest.mark.parametrize("words", [["set"], ["set", "1"], ["set", "x", "1"], ["go"], ["stop", "1"], ["#" + "x" * 90]])
def test_wrong_words_are_refused(words: list[str]) -> None:
    with pytest.raises(ValueError, match=r"set needs|must be a number|no order|buffer has 80"):
        parse_words(words)


@given(st.text(max_size=60))
def test_no_text_makes_anything_but_an_order_or_a_value_error(text: str) -> None:
    try:
        timed = parse_timed_order(text)
    except ValueError:
        return
    assert timed.data.startswith(b"#")
    assert timed.data.endswith(b"\r")


def test_a_check_is_the_exclusive_or_of_what_stands_before_it() -> None:
    # A ^ B = 0x03; of nothing it is 0.
    assert checked(b"#AB\r") == b"#AB*03\r"
    assert checked(b"#\r") == b"#*00\r"
    assert checked(order("stop")) == b"#STOP*%02X\r" % (0x53 ^ 0x54 ^ 0x4F ^ 0x50)
