"""Products that overflow before their quotient reaches what it is compared with, and right twins."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import findings_of

HEAD = """static long counts; static int small; volatile int in; static unsigned long cycles;
void Count(long n) { counts += n; small += in; cycles += in; }
"""


def told(way: str, stop: str) -> bool:
    """Whether a way that is computed from counts is told."""
    text = f"{HEAD}{way}\nint Stop(void)\n{{\n{stop}\n}}\n"
    return ("overflow", HEAD.count("\n") + 1) in findings_of(text)


WAY = "static long Way(void) { return counts * 7500 / 2000; }"


@pytest.mark.parametrize(
    ("way", "stop"),
    [
        (WAY, "return Way() >= 12000000L;"),
        (WAY, "long way = Way(); if (way > 12000000L - 300000L) return 1; return way < -12000000L;"),
        (WAY.replace("counts * 7500", "7500L * counts"), "return 12000000L < Way();"),
        ("static unsigned long Us(void) { return cycles * 1000UL / 200UL; }", "return Us() > 30000000UL;"),
    ],
)
def test_a_quotient_that_cannot_reach_its_limit_is_told(way: str, stop: str) -> None:
    assert told(way, stop)


@pytest.mark.parametrize(
    ("way", "stop"),
    [
        (WAY, "return Way() >= 1000000L;"),
        ("static long Way(void) { return counts / 2000 * 7500; }", "return Way() >= 12000000L;"),
        ("static long Way(void) { return counts * 3 / 4; }", "return Way() >= 500000000L;"),
        # The product of an int fits, and no value of it reaches the limit.
        ("static long Way(void) { return (long)small * 7500 / 2000; }", "return Way() >= 12000000L;"),
        ("static long Way(void) { return in ? 12000001L : counts * 7500 / 2000; }", "return Way() > 12000000L;"),
        (WAY, "long way = Way(); way += counts; return way > 12000000L;"),
        ("static float Way(void) { return counts * 7500.0f / 2000; }", "return Way() > 12000000L;"),
        (WAY, "return Way() == 12000000L;"),
    ],
)
def test_a_quotient_that_reaches_its_limit_or_is_not_limited_is_silent(way: str, stop: str) -> None:
    assert not told(way, stop)
