"""Tests that let one element too many into an array, and their right twins."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import findings_of

HEAD = """typedef unsigned int Uint16;
static char line[8];
static struct { Uint16 used; char text[8]; } kept;
static Uint16 n, m, more[9];
volatile char in; volatile int port;
static int Last(Uint16 at) { return line[at] == 0; }
static void Obey(void) { in = line[0]; }
"""


def told(take: str, rest: str, main: str = "int main(void) { for (;;) Take(in); }") -> bool:
    """Whether a function that takes one character is told that its array is too short."""
    text = f"{HEAD}void Take(char c)\n{{\n{take}\n}}\n{rest}\n{main}\n"
    return ("table-short", HEAD.count("\n") + 3) in findings_of(text)


@pytest.mark.parametrize(
    ("take", "rest"),
    [
        ("if (c == '\\n') { Obey(); n = 0; } else if (n <= 8) line[n++] = c;", ""),
        ("if (n <= 8) line[n++] = c;", "int At(struct { Uint16 at; } *p) { return line[p->at]; }"),
        ("if (in) n = 0; if (c == '\\n') { line[n] = 0; } else if (n <= 8) { line[n++] = c; }", ""),
        ("if (n < 9 && c != 0) { line[n] = c; n++; } else n = 0;", ""),
        ("if (n > 8) { n = 0; } line[n++] = c;", ""),
        ("if (n >= 9) return; line[n++] = c;", "void Clear(void) { n = 0; }"),
        ("if (kept.used <= 8) kept.text[kept.used++] = c; else kept.used = 0;", ""),
        # It is counted behind a further test.
        ("if (n <= 9) { in = more[n]; m++; if (m >= more[n]) { n++; m = 0; } } else in = 0;", ""),
        ("if (in) { n = 0; } else if (n <= 8) { in = line[n]; if (in > m && port) n++; }", ""),
        ("if (n > 8) n = 0; in = line[n]; if (c != 0) { if (port) n++; }", ""),
        # The end of the text.
        ("if (n < 8) line[n++] = c;", "void End(void) { line[n] = 0; n = 0; Obey(); }"),
        ("if (n < 8) { line[n++] = c; line[n] = 0; }", ""),
        ("if (in) n = 0; if (c == '\\n') { line[n] = 0; Obey(); n = 0; } else if (n < 8) line[n++] = c;", ""),
        ("if (kept.used < 8) kept.text[kept.used++] = c; else { kept.text[kept.used] = 0; kept.used = 0; }", ""),
        # What looks at it later sets it back in any case.
        ("if ((c & 128) || n > 8) in = 1; else line[n++] = c;", "void End(void) { if (n == 8) Obey(); n = 0; }"),
        ("if (n <= 8) line[n++] = c;", "void End(void) { if (n >= 4 && line[0]) { if (n < 8) Obey(); } n = 0; }"),
    ],
)
def test_one_element_too_many_is_told(take: str, rest: str) -> None:
    assert told(take, rest)


@pytest.mark.parametrize(
    ("take", "rest"),
    [
        ("if (n < 8) line[n++] = c;", ""),
        ("if (n < 8) { line[n] = c; n++; }", ""),
        ("if (n < 8) { if (c) { line[n] = c; n++; } }", ""),
        ("if (in) { if (n < 8) { line[n] = c; n++; } }", ""),
        ("if (n >= 8) { in = 0; } else { line[n] = c; n++; }", ""),
        ("if (n <= 7) line[n++] = c; else n = 0;", ""),
        ("if (n < 7) line[n++] = c;", "void End(void) { line[n] = 0; n = 0; Obey(); }"),
        ("if (n >= 8) n = 0; line[n++] = c;", ""),
        ("if (n >= 8) return; line[n++] = c;", ""),
        ("if (n <= 8) more[n++] = c;", ""),
        # It is counted behind a further test, no further than the last element.
        ("if (n < 9) { in = more[n]; m++; if (m >= more[n]) { n++; m = 0; } } else in = 0;", ""),
        ("if (n <= 9) { in = more[n]; if (n < 8 && port) n++; }", ""),
        ("if (n <= 9) { if (port) n++; if (n < 9) in = more[n]; }", ""),
        ("if (n <= 9) { in = more[n]; if (port) { n++; m--; if (m == 0) n = 0; } }", ""),
        # A further test may find a mark in the last element.
        ("if (n <= 9) { in = more[n]; if (more[n] != 0) n++; }", ""),
        ("if (n <= 9) { in = more[n]; if (more[n]) n++; }", ""),
        ("if (n <= 9) { in = more[n]; if (more[n] > 0 && port) n++; }", ""),
        ("if (n <= 9) { m = more[n]; if (m != 0xFFFF) { if (port) n++; } }", ""),
        ("if (n <= 9) { Uint16 length = more[n]; if (port && length) n++; }", ""),
        ("if (n <= 9) { in = more[n]; if (Last(n)) n++; }", ""),
        # Another test ends the count.
        ("if (n <= 8) { line[n++] = c; if (n == 8) n = 0; }", ""),
        ("if (n <= 8) line[n++] = c;", "void Look(void) { if (n >= 8) { Obey(); n = 0; } }"),
        ("if (n < 8) line[n++] = c;", "void End(void) { if (n < 8) line[n] = 0; n = 0; Obey(); }"),
        ("if (n <= 8) line[n++] = c;", "void End(void) { if (n == 8) { Obey(); n = 0; } }"),
        ("if (n <= 8) line[n++] = c;", "void End(void) { if (n != 8) return; n = 0; Obey(); }"),
        ("if (n <= 8) line[n++] = c;", "void End(void) { if (n < 8) { in = 1; return; } n = 0; Obey(); }"),
        ("if (n < 8) line[n++] = c;", "void End(void) { if (n == 8) Obey(); else line[n] = 0; n = 0; }"),
        ("if (n <= 8) { line[n++] = c; if (n == 8) Obey(); }", "void End(void) { if (n == 8) Obey(); n = 0; }"),
        # It is set back before.
        ("if (n < 8) { line[n++] = c; } else { n = 0; line[n] = c; }", ""),
        ("if (c == '\\r') n = 0; if (c == '\\r') line[n] = c; if (n < 8) n++;", ""),
        ("n = 0; if (n <= 8) line[n++] = c;", ""),
        # In a loop, the turns may be the limit.
        ("n = 0; for (m = 0; m < 8; m++) { if (n <= 8) line[n++] = more[m]; }", ""),
        # It is counted down elsewhere, or gets what nobody knows.
        ("if (n <= 8) line[n++] = c;", "void Back(void) { if (n) n--; }"),
        ("if (n <= 8) line[n++] = c;", "void Set(Uint16 to) { n = to; }"),
        ("const char *end; if (n < 8) line[n++] = c; end = &line[n]; in = end[-1];", ""),
    ],
)
def test_as_many_elements_as_there_are_is_silent(take: str, rest: str) -> None:
    assert not told(take, rest)


def test_an_object_that_another_file_may_test_is_silent() -> None:
    assert not told("if (n <= 8) line[n++] = c;", "", main="")
