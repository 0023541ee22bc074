"""Formats against their arguments: wide enough, of the right kind, as many (ISO C 7.19.6.1, with an int of 16 bits)."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.image import link
from emulator.system import System
from tests.emulator.c28x.readers.c.workshop import findings_of

HEAD = """#include <stdio.h>
char line[80], name[4], c; int i, *p; unsigned int u; long l; unsigned long ul; float x; enum E { A, B } e;
int f(void)
{
"""


def told(call: str) -> list[str]:
    """The rules about formats at the line of a call."""
    found = findings_of(f"{HEAD}    return {call};\n}}\n")
    return [rule for rule, line in found if line == 5 and rule.startswith(("varargs", "printf"))]


@pytest.mark.parametrize(
    "call",
    [
        'sprintf(line, "%d %i %u %x %X %o %c", i, i, u, u, i, u, c)',  # all of one word
        'sprintf(line, "%hd %d", i, e)',
        'sprintf(line, "%ld %li %lu %08lx", l, l, ul, ul)',
        'sprintf(line, "%f %5.2f %e %g", x, x, x, 1.0)',  # a double is a float here
        'sprintf(line, "%s %.3s %-8s %p", name, line, "text", p)',
        'sprintf(line, "%*d %-*.*f", i, u, i, i, x)',
        'sprintf(line, "100 %%, %d", i)',
        'sprintf(line, "%d", (int)l)',
        'sprintf(line, "%ld", (long)i)',
        'sprintf(line, "%ld", i + 1L)',  # the sum is a long
        'snprintf(line, sizeof line, "%lx", (unsigned long)p)',
        'sprintf(line, i ? "%d" : "%ld", i)',  # no format that stands in the call
        'sprintf(line, name, i)',
        'sprintf(line, "%d" " %d", i, i)',  # one text
        'sprintf(line, "nothing")',
    ],
)
def test_what_fits_is_told_nothing(call: str) -> None:
    assert told(call) == []


@pytest.mark.parametrize(
    ("call", "rule"),
    [
        ('sprintf(line, "%d", l)', "varargs-type"),
        ('sprintf(line, "%u", ul)', "varargs-type"),
        ('sprintf(line, "%x", p)', "varargs-type"),
        ('sprintf(line, "%d", x)', "varargs-type"),
        ('sprintf(line, "%ld", i)', "varargs-type"),
        ('sprintf(line, "%ld", x)', "varargs-type"),
        ('sprintf(line, "%f", i)', "varargs-type"),
        ('sprintf(line, "%s", i)', "varargs-type"),
        ('sprintf(line, "%s", name[0])', "varargs-type"),
        ('sprintf(line, "%c", name)', "varargs-type"),
        ('sprintf(line, "%*d", l, i)', "varargs-type"),
        ('sprintf(line, "%d", i * 10L)', "varargs-type"),
        ('snprintf(line, 80, "%d %d", i, l)', "varargs-type"),
        ('printf("%d", l)', "varargs-type"),
        ('sprintf(line, "%d %d", i)', "varargs-missing"),
        ('sprintf(line, "%s")', "varargs-missing"),
        ('sprintf(line, "%d", i, i)', "varargs-surplus"),
        ('sprintf(line, "nothing", i)', "varargs-surplus"),
        ('sprintf(line, "%d %\\r\\n", i)', "printf-format"),
        ('sprintf(line, "%d %", i)', "printf-format"),
        ('sprintf(line, "%d%)", i)', "printf-format"),
    ],
)
def test_what_does_not_fit_is_told_once(call: str, rule: str) -> None:
    assert told(call) == [rule]


@pytest.mark.parametrize(("conversion", "rules"), [("%d", ["varargs-type"]), ("%ld", [])])
def test_the_kernels_own_function_is_looked_at_too(conversion: str, rules: list[str], tmp_path: Path) -> None:
    text = "#include <xdc/runtime/System.h>\nchar line[20];\nlong l;\nint f(void)\n{\n"
    file = tmp_path / "f.c"
    file.write_text(f'{text}    return System_sprintf(line, "{conversion}", l);\n}}\n', encoding="utf-8")
    system = System()
    link(system, [str(file)], static=True)
    assert [finding.rule for finding in system.findings if finding.place and finding.place.line == 6] == rules
