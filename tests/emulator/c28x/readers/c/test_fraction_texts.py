"""Numbers that are printed in two parts, before and behind the point."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import findings_of

HEAD = """#include <stdio.h>
#include <stdlib.h>
char line[80]; static int raw, plain, cv, stepped, version, sum; static long mg, ms, um; static unsigned u; int day;
struct NOW { long um; int tenths; int mv; } now;
static int To_mv(int n) { return (int)((long)n * 33L / 40L - 5L); }
void Step(void)
{
    cv = raw * 33 / 40 - 500; mg = (long)raw * 250; ms++; um = mg - 5; stepped = raw * 25; now.um = mg + um;
    version = day * 100 + 7; sum += raw; now.tenths = raw - 400;
    now.mv = To_mv(raw);
}
"""


def told(body: str) -> bool:
    """Whether a function with this body is told."""
    return "fraction-text" in {rule for rule, _ in findings_of(f"{HEAD}void f(const struct NOW *n)\n{{ {body} }}\n")}


@pytest.mark.parametrize(
    "body",
    [
        'sprintf(line, "%ld.%ld g", um / 1000L, um % 1000L);',
        'sprintf(line, "%c%ld.%ld", um < 0 ? \'-\' : \' \', labs(um) / 1000L, labs(um) % 1000L);',
        'long m = um < 0 ? -um : um; sprintf(line, "%ld.%ld", m / 1000L, m % 1000L);',
        'sprintf(line, "%d.%d", cv / 100, cv % 100);',
        'sprintf(line, "%d.%3d", cv / 1000, cv % 1000);',  # blanks are no zeros
        'sprintf(line, "%d.%02d", cv / 1000, cv % 1000);',
        'sprintf(line, "%d.%02d", cv / 10, cv % 10);',
        'int a = cv / 100, b = cv % 100; sprintf(line, "%d.%d", a, b);',
        'sprintf(line, "U=%d.%d I=%u", cv / 1000, cv % 1000 / 10, u);',
        'sprintf(line, "%lu.%lu s", (unsigned long)ms / 1000UL, (unsigned long)ms % 1000UL);',
        'sprintf(line, "%ld.%ld", n->um / 1000L, n->um % 1000L);',
        'sprintf(line, "%u.%u V", u / 100, u % 100);',
        'sprintf(line, "%d.%d", sum / 100, sum % 100);',
        'sprintf(line, "%d.%02d", plain / 100, abs(plain % 100));',  # -0.5
        'sprintf(line, "%d.%d C", n->tenths / 10, abs(n->tenths % 10));',
        'sprintf(line, "T %d.%d", plain / 10, abs(plain) % 10);',
        'sprintf(line, "U=%d.%d I=%u", n->mv / 1000, n->mv % 1000, u);',
    ],
)
def test_a_fraction_without_its_zeros_or_its_sign_is_told(body: str) -> None:
    assert told(body)


@pytest.mark.parametrize(
    "body",
    [
        'sprintf(line, "%ld.%03ld g", um / 1000L, um % 1000L);',
        'sprintf(line, "%ld.%.3ld g", um / 1000L, um % 1000L);',
        'sprintf(line, "%d.%d V", cv / 10, cv % 10);',
        'sprintf(line, "%d.%d V", cv / 1000, cv % 1000 / 100);',
        'sprintf(line, "%d.%02d V", cv / 1000, cv % 1000 / 10);',
        'sprintf(line, "%d.%d V", stepped / 100, stepped % 100);',  # 0, 25, 50, 75
        'sprintf(line, "v%d.%d", cv / 100, cv % 100);',
        'sprintf(line, "Firmware %d.%d", version / 100, version % 100);',
        'sprintf(line, "%d.%d.%d", day / 10000, day / 100 % 100, day % 100);',
        'sprintf(line, "%d.%d", day / 100, day % 100);',
        'sprintf(line, "%d.%d V", plain / 100, u % 100);',  # two numbers
        'sprintf(line, "%d:%d s", cv / 100, cv % 100);',
        'sprintf(line, "%s%d.%02d", plain < 0 ? "-" : "", abs(plain) / 100, abs(plain) % 100);',
        'sprintf(line, "%s%d.%02d", plain < 0 ? "-" : "", plain / 100, abs(plain % 100));',
        'sprintf(line, "%d.%0*d V", cv / 100, u, cv % 100);',
        'sprintf(line, "%x.%x", cv / 100, cv % 100);',
    ],
)
def test_a_fraction_with_its_zeros_and_what_is_no_fraction_is_silent(body: str) -> None:
    assert not told(body)
