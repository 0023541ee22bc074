"""Searches that may end behind their table, and their right twins."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import findings_of

HEAD = """typedef unsigned int Uint16;
static const Uint16 Codes[4] = {200, 650, 1090, 3520}, Scale[4] = {200, 650, 1090, 4095};
static const struct { Uint16 code; int degrees; } Curve[3] = {{0, -40}, {1700, 25}, {3900, 150}};
static const int Degrees[4] = {0, 40, 80, 320};
static Uint16 mean; volatile Uint16 in; static int degrees;
void Sample(void) { mean = in; }
"""
CALL = "void Measure(void) { degrees = f(mean); }"


def told(body: str, call: str = CALL) -> bool:
    """Whether a function that looks a code up is told that the search may end behind the table."""
    text = f"{HEAD}static int f(Uint16 code)\n{{\nUint16 k = 1;\n{body}\n}}\n{call}\n"
    return "table-short" in [rule for rule, _ in findings_of(text)]


WHILE = "while (k < 4 && code > Codes[k]) k++;"
FOR = "for (k = 0; k < 4; k++) if (code <= Codes[k]) break;"


@pytest.mark.parametrize(
    ("body", "call"),
    [
        (WHILE + " if (code >= Codes[k]) return Degrees[k]; return Degrees[k - 1];", CALL),
        ("if (code <= Codes[0]) return 0; " + WHILE + " return Degrees[k];", CALL),
        (FOR + " return Degrees[k];", CALL),
        ("for (k = 0; k < 3; k++) if (Curve[k].code >= code) break; return Curve[k].degrees;", CALL),
        ("while (k <= 3 && Codes[k] < code) { k++; } return Degrees[k];", CALL),
    ],
)
def test_a_search_that_may_end_behind_its_table_is_told(body: str, call: str) -> None:
    assert told(body, call)


@pytest.mark.parametrize(
    ("body", "call"),
    [
        (WHILE.replace("k < 4", "k < 3") + " return Degrees[k];", CALL),
        (WHILE.replace("Codes", "Scale") + " return Degrees[k];", CALL),
        (WHILE + " return k < 4 ? Degrees[k] : 400;", CALL),
        (WHILE + " if (k == 4) return 400; return Degrees[k];", CALL),
        (WHILE + " return Degrees[k - 1];", CALL),
        ("if (code > 3500) code = 3500; " + WHILE + " return Degrees[k];", CALL),
        ("if (code >= Codes[3]) return 320; " + WHILE + " return Degrees[k];", CALL),
        (FOR + " if (k > 3) k = 3; return Degrees[k];", CALL),
        (WHILE + " return Degrees[k];", CALL.replace("degrees =", "if (mean < 3500) degrees =")),
        (WHILE + " return Degrees[k];", CALL.replace("f(mean)", "f(mean / 32)")),
        (WHILE + " return Degrees[k];", ""),  # nobody calls it
    ],
)
def test_a_search_that_ends_inside_or_is_tested_is_silent(body: str, call: str) -> None:
    assert not told(body, call)
