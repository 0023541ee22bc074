"""Tables that are shorter than a remainder or a mask allows, and their right twins."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import findings_of

HEAD = """typedef unsigned int Uint16;
static const int row[5] = {1, 2, 3, 4, 5}, table[4][3] = {{1}};
volatile Uint16 in;
static Uint16 place, *where, at, rows[6];
static struct { Uint16 at, level; } ring;
static Uint16 Word(void) { return in >> 8 & 7; }
static void Set(Uint16 n) { place = n % 7; }
"""


def told(body: str, more: str = "") -> bool:
    """Whether a function is told that a table is too short."""
    text = f"{HEAD}{more}\nint f(Uint16 n)\n{{\n{body}\n}}\n"
    return ("table-short", HEAD.count("\n") + 4) in findings_of(text)


@pytest.mark.parametrize(
    ("body", "more"),
    [
        ("return row[n & 7];", ""),
        ("return row[n % 6];", ""),
        ("return table[2][n & 3];", ""),
        ("return table[n % (sizeof table / sizeof table[0][0])][0];", ""),
        ("return row[Word()];", ""),
        ("Uint16 w = Word(); return row[w];", ""),
        ("return row[place];", ""),
        ("return n < 3 ? 0 : row[n % 9];", ""),  # a test of the number before its remainder excludes none
        ("return row[at];", "void Next(void) { at++; if (at > 5) at = 0; }"),
        ("return row[at];", "void Next(void) { if (++at > 5) { at = 0; in = 1; } }"),
        ("return row[at];", "void Next(void) { at = at + 1; if (at >= 6) at = 0; }"),
        ("return row[at];", "void Next(void) { at++; if (at == 6) at = 0; }"),
        ("return row[ring.at];", "void Next(void) { ring.at++; in = 2; if (ring.at > 5) ring.at = 0; }"),
        ("return row[at];", "void Next(void) { at = at < 5 ? at + 1 : 0; }"),
        ("return row[at];", "void Next(void) { at = at == 5 ? 0 : at + 1; }"),
        ("return row[ring.at];", "void Next(void) { if (ring.at >= 5) ring.at = 0; else ring.at++; }"),
        ("return row[at];", "void Next(void) { if (at == 0) at = 5; else at--; }"),
        ("return row[at];", "void Next(void) { at = at > 0 ? at - 1 : 5; }"),
        ("return row[(n & 0x70) >> 4];", ""),
        ("return row[at] + (at == place);", "void Next(void) { rows[at++] = in; if (at > 5) at = 0; }"),
    ],
)
def test_an_index_that_may_be_too_high_is_told(body: str, more: str) -> None:
    assert told(body, more)


@pytest.mark.parametrize(
    ("body", "more"),
    [
        ("return row[n % 5];", ""),
        ("return row[at];", "void Next(void) { at = at < 4 ? at + 1 : 0; }"),
        ("return row[at];", "void Next(void) { at = at >= 4 ? 0 : at + 1; }"),
        ("return row[at];", "void Next(void) { if (at == 4) at = 0; else at++; }"),
        ("return row[at];", "void Next(void) { if (at == 0) at = 4; else at--; }"),
        ("return row[at - 1];", "void Next(void) { at = at > 1 ? at - 1 : 5; }"),
        ("return row[at];", "void Next(void) { if (at < 5) { rows[at] = row[at]; at++; } else at = 0; }"),
        ("return at == 5 ? 0 : row[at];", "void Next(void) { at = at < 5 ? at + 1 : 0; }"),
        ("return row[(n & 0x50) >> 4];", ""),  # a mask with gaps
        ("if ((n & 0x70) > 0x40) return 0; return row[(n & 0x70) >> 4];", ""),
        ("return table[n & 3][n % 3];", ""),
        ("return table[n % (sizeof table / sizeof table[0])][0];", ""),
        ("return row[n >> 14 & 7];", ""),  # two bits
        ("return row[n & 5 & 4];", ""),  # a mask with gaps
        ("Uint16 w = Word(); if (w > 4) w = 4; return row[w];", ""),
        ("if ((n & 7) > 4) return 0; return row[n & 7];", ""),
        ("switch (n & 7) { case 5: case 6: case 7: return 0; } return row[n & 7];", ""),
        ("return place < 5 ? row[place] : 0;", ""),
        ("return row[place];", "static void Other(Uint16 n) { place = n; }"),
        ("return row[place];", "static void Other(void) { where = &place; }"),
        ("const int *end = &row[n % 6]; return *where + (end != row);", ""),
        ("return row[n];", ""),
        ("return row[at];", "void Next(void) { at++; if (at >= 5) at = 0; }"),
        ("return row[at];", "void Next(void) { at++; if (at > 4) at = 0; }"),
        ("return row[at];", "void Next(void) { at++; if (at == 5) at = 0; }"),
        ("return row[at];", "void Next(void) { at++; if (at > 5) in = 0; }"),  # nothing sets it back
        ("return at < 5 ? row[at] : 0;", "void Next(void) { at++; if (at > 5) at = 0; }"),
        ("if (at == 5) return 0; return row[at];", "void Next(void) { at++; if (at > 5) at = 0; }"),
        ("return row[at - 1];", "void Next(void) { at++; if (at > 5) at = 1; }"),
        ("return row[at];", "void Next(void) { at++; if (at > 5 || in) at = 0; }"),  # what the other half does is open
        ("return row[at];", "void Next(void) { at++; if (at > 5) at = 0; } void Give(Uint16 n) { at = n; }"),
    ],
)
def test_an_index_that_stays_inside_or_is_tested_is_silent(body: str, more: str) -> None:
    assert not told(body, more)
