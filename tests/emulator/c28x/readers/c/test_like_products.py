"""Products of 16 bits beside others that are widened first: wrong programs, and their right twins."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import findings_of

PROGRAM = """typedef struct {{ int x, y, z, scale; }} Vector;
int mg[3], other[3]; unsigned int raw[3]; char small[3]; int first, second; Vector p, q;
static const int TAPS[3] = {{ 1000, 1000, 3 }}; int weights[3] = {{ 1000, 1000, 3 }};
volatile int source;
long out; float outf;
void Fill(int x, int y)
{{
    mg[0] = source; mg[1] = source; other[0] = x; other[1] = y;
}}
void Step(int x, int y, int duty, const Vector *at)
{{
    int i = 0, near = source & 0x7F, fear = source;
    {body}
}}
"""
LINE = PROGRAM.format(body="").count("\n") - 1


def told(body: str) -> list[tuple[str, int]]:
    """The findings about a body."""
    found = findings_of(PROGRAM.format(body=body))
    return [(rule, line) for rule, line in found if rule in ("widened-late", "overflow", "unsigned-wrap")]


@pytest.mark.parametrize("body", [
    "out = (long)mg[0] * mg[0] + (long)mg[1] * mg[1] + mg[2] * mg[2];",
    "out = mg[0] * mg[0] + (long)mg[1] * mg[1] + (long)mg[2] * mg[2];",
    "outf = (float)mg[0] * mg[0] + mg[1] * mg[1];",
    "out = (long)raw[0] * raw[0] + raw[1] * raw[1];",
    "out = (long)x * x + y * y;",
    "if (x > 0) out = (long)x * x + y * y;",
    "if ((long)x * x + y * y > 10000) out = 1;",
    "out = (long)p.x * p.x + (long)p.y * p.y + p.z * p.z;",
    "out = (long)at->x * at->x + at->y * at->y;",
    "out = (long)p.x * q.y - p.y * q.x;",
    "out = (long)mg[0] * other[1] - mg[1] * other[0];",
    "out = (long)mg[0] * other[0] + (long)mg[1] * other[1] + mg[2] * other[2];",
])  # fmt: skip
def test_a_product_that_was_forgotten(body: str) -> None:
    assert told(body) == [("widened-late", LINE)]


@pytest.mark.parametrize("body", [
    "out = (long)mg[0] * mg[0] + (long)mg[1] * mg[1] + (long)mg[2] * mg[2];",
    "out = mg[0] * mg[0] + mg[1] * mg[1];",  # nobody says that it does not fit
    "out = (long)mg[0] * mg[0] + (int)(mg[1] * mg[1]);",  # the wrap is meant
    "out = (long)small[0] * small[0] + small[1] * small[1];",  # characters are small
    "out = (long)x * x + duty * duty;",
    "out = (long)mg[0] * 39 + other[0] * 2;",
    "out = (long)mg[0] * TAPS[0] + (long)mg[1] * TAPS[1] + mg[2] * TAPS[2];",  # 3 * 4095
    "out = (long)mg[0] * weights[0] + mg[1] * weights[2];",
    "out = (long)mg[0] * x + mg[1] * y;",
    "out = (long)fear * fear + near * near;",  # of 7 bits
    "if (y > 100) y = 100; out = (long)x * x + y * y;",
    "if (mg[2] < 180 && mg[2] > -180) out = (long)mg[0] * mg[0] + mg[2] * mg[2];",
    "out = (long)p.x * p.x + p.scale * p.scale;",
    "out = (long)p.x * p.x + p.scale * p.z;",
    "out = (long)mg[0] * mg[0] + other[1] * other[1];",
    "for (i = 0; i < 3; i++) out += (long)mg[i] * mg[i];",
    "out = (long)mg[0] * mg[0] + mg[1] * 2 + i;",
    "first = mg[0] * mg[0] + mg[1] * mg[1];",
])  # fmt: skip
def test_right_sums(body: str) -> None:
    assert told(body) == []
