"""Tests that let more through than the conversion behind them keeps, and their right twins."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import findings_of

HEAD = """typedef unsigned int Uint16; typedef unsigned long Uint32; typedef long int32; typedef int int16;
static Uint16 period; static int16 angle; volatile Uint16 in; static int32 wide;
void Set(Uint16 n) { period = n; }
"""


def told(body: str) -> bool:
    """Whether the first line of a function's body is told."""
    text = f"{HEAD}\nvoid f(int32 n, Uint32 u)\n{{\n{body}\n}}\n"
    return ("narrowed", HEAD.count("\n") + 4) in findings_of(text)


@pytest.mark.parametrize(
    "body",
    [
        "if (n > 0 && n <= 100000L) period = (Uint16)n;",
        "if (n > 0 && n <= 100000L) period = n;",
        "if (n < 65537L) { in = 1; Set((Uint16)n); }",
        "if (70000UL >= u) period = (Uint16)u;",
        "if (n >= 0 && n <= 40000L) angle = (int16)n;",
        "if (wide < 100000L) period = (Uint16)wide; else period = 1;",
        "if (n < 0 || n > 99999L) return; period = (Uint16)n;",
        "if (n < 0 || n > 99999L) return; Set(n);",
        "if (!(n <= 99999L)) { in = 1; return; } in = 2; Set((Uint16)n);",
        "while (in) { if (u >= 70000UL) break; period = (Uint16)u; }",
    ],
)
def test_a_limit_above_what_the_type_holds_is_told(body: str) -> None:
    assert told(body)


@pytest.mark.parametrize(
    "body",
    [
        "if (n > 0 && n <= 65535L) period = (Uint16)n;",
        "if (n < 65536L) period = (Uint16)n;",
        "if (n >= 0 && n < 32768L) angle = (int16)n;",
        "if (n <= 100000L) { period = (Uint16)n; in = (Uint16)(n >> 16); }",  # both words
        "if (n <= 100000L) { wide = n; period = (Uint16)n; }",
        "if (n <= 100000L) { if (n > 60000L) n = 60000L; period = (Uint16)n; }",
        "if (n <= 100000L) { if (n < 60000L) period = (Uint16)n; }",
        "if (n <= 100000L) { n /= 2; period = (Uint16)n; }",
        "if (n <= 100000L && n < 60000L) period = (Uint16)n;",
        "if (n < 60000L) { if (n <= 100000L) period = (Uint16)n; }",
        "if (n <= 100000L || in) period = (Uint16)n;",
        "if (n <= 100000L) period = (Uint16)(n / 10);",
        "if (n <= 100000L) period = (Uint16)(n & 0xFF);",
        "if (n > 100000L) return; period = (Uint16)u;",
        "if (n < 0 || n > 65535L) return; period = (Uint16)n;",
        "if (n > 99999L) return; if (n > 60000L) return; period = (Uint16)n;",
        "if (n > 99999L) return; period = (Uint16)n; in = (Uint16)(n >> 16);",
        "in = n / 65536L; if (n > 99999L) return; period = (Uint16)n;",
        "if (n < 0 && n > 99999L) return; period = (Uint16)n;",
        "if (n > 99999L) in = 1; period = (Uint16)n;",  # it goes on
    ],
)
def test_what_the_type_holds_or_the_branch_divides_is_silent(body: str) -> None:
    assert not told(body)
