"""Errors of regulators that lose their sign: wrong programs, and their right twins."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import findings_of

PROGRAM = """#define SET 2000
unsigned measured = 10, wanted = 20;
unsigned long position = 0, goal = 5;
int signed_one = 3;
long out;
float outf;
typedef struct {{ float error; long diff; }} State;
State state;
void Step(void)
{{
    {declared}
    {body}
}}
"""


@pytest.mark.parametrize(("declared", "body"), [
    ("long error = SET - measured;", "out = error / 2;"),
    ("float err;", "err = wanted - measured; outf = err;"),
    ("", "state.error = wanted - measured;"),
    ("long diff = SET - measured;", "out = diff;"),
    ("", "state.diff = SET - measured;"),
    ("long fehler = signed_one - measured;", "out = fehler;"),
    ("float error = goal - position;", "outf = error;"),
])  # fmt: skip
def test_an_error_without_a_sign(declared: str, body: str) -> None:
    """It is told in the line of the difference."""
    line = 12 if "-" in declared else 13
    assert ("widened-late", line - 1) in findings_of(PROGRAM.format(declared=declared, body=body))


@pytest.mark.parametrize(("declared", "body"), [
    ("long error = (long) SET - measured;", "out = error / 2;"),
    ("int error = SET - measured;", "out = error;"),  # 16 bits wrap back
    ("long error = (int) (SET - measured);", "out = error;"),
    ("long diff = wanted - measured;", "out = diff;"),  # perhaps an elapsed count
    ("long rest = SET - measured;", "out = rest;"),
    ("long error = 4095 - measured;", "out = error;"),  # a code of 12 bits is not above
    ("float error = 100 - measured;", "outf = error;"),  # per cent
    ("unsigned long error = SET - measured;", "out = error;"),
    ("long error = 0;", "if (measured < SET) error = SET - measured; out = error;"),
    ("long error = measured > wanted ? measured - wanted : 0;", "out = error;"),
    ("float error = signed_one - 5;", "outf = error;"),
    ("long error = measured - 2000;", "if (measured < 2000) error = 0; out = error;"),
])  # fmt: skip
def test_right_errors(declared: str, body: str) -> None:
    """The difference has a sign, or cannot be below 0."""
    rules = [rule for rule, _ in findings_of(PROGRAM.format(declared=declared, body=body))]
    assert "widened-late" not in rules
