"""Limits that leave nothing between them, digits that are added with their codes; and right twins."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import findings_of

CLAMP = """int Wanted = 0;
float Integral = 0.0f;
int Clamp(int x)
{{
    {first}
    {second}
    return x;
}}
"""


def told(first: str, second: str) -> list[int]:
    """The lines at which `limits-crossed` is told."""
    found = findings_of(CLAMP.format(first=first, second=second))
    return [line for rule, line in found if rule == "limits-crossed"]


@pytest.mark.parametrize(("first", "second"), [
    ("if (x > 100) x = 100;", "if (x < 100) x = -100;"), ("if (x < 100) { x = -100; }", "if (100 <= x) x = 100;"),
    ("if (Integral > 0.8f) Integral = 0.8f;", "else if (Integral < 0.8f) Integral = -0.8f;"),
    # The names of the limits are exchanged.
    ("if (x > -100) x = -100;", "if (x < 100) x = 100;"),
])  # fmt: skip
def test_limits_that_leave_nothing_between_them_are_told(first: str, second: str) -> None:
    assert told(first, second) == [6]


@pytest.mark.parametrize(("first", "second"), [
    ("if (x > 100) x = 100;", "if (x < -100) x = -100;"), ("if (x > 100) x = 100; else if (x < 0)", "x = 0;"),
    # A sign; a value that is one of two; a dead band; another value; another test between them.
    ("if (x > 0) x = 1;", "if (x < 0) x = -1;"), ("if (x > 100) x = 100;", "else if (x < 100) x = 0;"),
    ("if (x < 20) x = 0;", "if (x > 100) x = 100;"), ("if (x > 100) x = 100;", "if (Wanted < 100) Wanted = -100;"),
    ("if (x > 100) x = 100;", "x -= Wanted; if (x < 100) x = -100;"),
    ("if (x > 100) x = 100;", "if (x < Wanted) x = Wanted;"),
])  # fmt: skip
def test_limits_with_values_between_them_are_silent(first: str, second: str) -> None:
    assert told(first, second) == []


NUMBER = """int Number(const char *text)
{{
    int value = 0, n = 0;
    while ({digit}) {{ {step} }}
    return value;
}}
"""
IS_DIGIT = "*text >= '0' && *text <= '9'"


@pytest.mark.parametrize(("digit", "step"), [
    (IS_DIGIT, "value = value * 10 + *text; text++;"), (IS_DIGIT, "value = *text + 10 * value; text++;"),
    ("text[n] >= '0' && !(text[n] > '9')", "value = value * 10 + text[n]; n++;"),
])  # fmt: skip
def test_a_digit_that_is_added_with_its_code_is_told(digit: str, step: str) -> None:
    assert ("digit-code", 4) in findings_of(NUMBER.format(digit=digit, step=step))


@pytest.mark.parametrize(("digit", "step"), [
    (IS_DIGIT, "value = value * 10 + (*text - '0'); text++;"), (IS_DIGIT, "value = value * 10 + (*text & 15); text++;"),
    (IS_DIGIT, "value = value * 10 + *text - '0'; text++;"), (IS_DIGIT, "value = value * 31 + *text; text++;"),
    (IS_DIGIT, "value = value * 10 + *text++; value -= '0';"),
    # No digit: a number that is compared with 57.
    ("*text < 57", "value = value * 10 + *text; text++;"),
])  # fmt: skip
def test_a_digit_that_is_added_with_its_value_is_silent(digit: str, step: str) -> None:
    assert [rule for rule, _ in findings_of(NUMBER.format(digit=digit, step=step)) if rule == "digit-code"] == []
