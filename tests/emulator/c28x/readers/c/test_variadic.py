"""Variadic functions of the firmware: its own `printf`, and lists of values."""

from __future__ import annotations

from typing import Any

import pytest

from hil.drivers.check import DriverFiles, check_files
from hil.image import Build
from tests.emulator.c28x.readers.c.workshop import CWorkshop

TEXT = """#include <stdarg.h>
#include <stdio.h>
#include <string.h>
static char Out[60];
int Format(char *to, const char *form, va_list list)
{
    return vsprintf(to, form, list);
}
int Print(char *form, ...)
{
    va_list list;
    va_start(list, form);
    Format(Out, form, list);
    va_end(list);
    return strlen(Out);
}
long Sum(int n, ...)
{
    long sum = 0;
    va_list list, again;
    va_start(list, n);
    va_copy(again, list);
    while (n--)
        sum += va_arg(list, int);
    return 1000L * va_arg(again, int) + sum;
}
float Mixed(int a, ...)
{
    va_list list;
    float f;
    long l;
    char *text;
    va_start(list, a);
    f = va_arg(list, double);
    l = va_arg(list, long);
    text = va_arg(list, char *);
    return a + f + l + text[1];
}
int Rest(char *form, ...)
{
    va_list list;
    va_start(list, form);
    va_arg(list, int);
    vsnprintf(Out, 5, form, list);
    return strlen(Out);
}
char At(int i) { return Out[i]; }
%s
"""


def run(call: str, result: str = "long", before: str = "") -> tuple[Any, str, list[str]]:
    """The result of a call, the text that was printed, and the rules of what was found."""
    shop = CWorkshop(TEXT % f"{result} f(void) {{ {before} return {call}; }}")
    value = shop.call("f")
    text = "".join(chr(shop.call("At", i)) for i in range(60)) if "Out" not in before else ""
    return value, text.split("\0")[0], [finding.rule for finding in shop.findings if finding.rule != "uninitialised"]


def test_a_printf_of_ones_own_prints() -> None:
    # "-7 x 70000 abc" has 14 characters; %ld takes two words, on an even place.
    assert run('Print("%d %c %ld %s", -7, \'x\', 70000L, "abc")') == (14, "-7 x 70000 abc", [])


@pytest.mark.parametrize(("call", "value"), [
    ("Sum(3, 10, 20, 30)", 10_060),
    # A call among the arguments of another: the inner one gives 4000 + 4.
    ("Sum(2, (int)Sum(1, 4), 1)", 4_004_000 + 4_005),
    ("Sum(1, -1)", -1_001),
])  # fmt: skip
def test_integers_are_taken_one_after_the_other(call: str, value: int) -> None:
    assert run(call, before="Out[0] = 0;") == (value, "", [])


def test_values_of_two_words_lie_on_even_places() -> None:
    # 2 + 1.5 + 100000 + 'A' (65)
    assert run('Mixed(2, 1.5f, 100000L, "xA")', "float", "Out[0] = 0;") == (100_068.5, "", [])


def test_a_list_that_was_read_from_goes_on_where_it_stands() -> None:
    # Behind the 1 that va_arg took; four characters and the NUL fit.
    assert run('Rest("%d!%d", 1, 23, 456)') == (4, "23!4", [])


def test_more_than_was_passed_is_told() -> None:
    _, _, rules = run("Sum(3, 1, 2)", before="Out[0] = 0;")
    assert rules[0] == "varargs-missing"
    _, _, rules = run('Print("%d %d", 1)')
    assert rules == ["varargs-missing"]


def test_another_type_than_was_passed_is_read_by_words() -> None:
    # 70000 = 0x11170: its low word is 4464.
    assert run("Sum(1, 70000L)", before="Out[0] = 0;")[0] == 4_464 * 1_001


def test_a_list_of_nobody_is_told() -> None:
    assert run('Format(Out, "%d", NULL)')[2] == ["varargs-missing"]


def test_what_is_passed_is_gone_when_the_call_has_returned() -> None:
    shop = CWorkshop(TEXT % 'void f(void) { int i; for (i = 0; i < 50; i++) Print("%d", i); }')
    before = len(shop.memory._blocks)
    shop.call("f")
    assert len(shop.memory._blocks) == before


def test_the_check_runs_it_and_says_why_it_is_not_called_alone(tmp_path: Any) -> None:
    file = tmp_path / "own.c"
    file.write_text(TEXT % 'int f(void) { return Print("%d", 1); }', encoding="utf-8")
    assert Build([str(file)]).image().call("own.f", []) == 1
    checked = check_files(DriverFiles([file], calls=1))
    reasons = {function.name: function.note for function in checked.functions}
    assert reasons["Print"] == "it takes any number of arguments"
