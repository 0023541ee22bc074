"""Two effects on one object without an order between them are a finding; where C gives an order there is none.

Also a finding: a function that is called before anything has declared it.
"""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import CWorkshop, findings_of

HEAD = """int v[4] = { 0, 1, 2, 3 };
int two(int a, int b) { return a + b; }
struct ring { unsigned low : 4; unsigned high : 4; int head, tail; };
static struct ring a, b;

int f(int i)
{
    struct ring *p = &a, *q = &b; int k = p == q;
"""


def text(line: str) -> str:
    """A function with the line, which is line 9."""
    return f"{HEAD}    {line}\n    return i + k;\n}}\n"


@pytest.mark.parametrize(
    "line",
    [
        "i = i++ + 1;",
        "i = ++i + 1;",
        "k = i++ + i++;",
        "k = i++ + i;",
        "v[i] = i++;",
        "v[i++] = i;",
        "k = two(i++, i);",
        "k = two(i = 1, i = 2);",
        "k = (i = 2) + i;",
        "k = v[i++] + v[i];",
        "i += i++;",
        "v[p->head++] = v[p->head];",
        "k = p->head++ + p->head++;",
        "k = p->low++ + p->low;",
    ],
)
def test_two_effects_without_an_order_are_found_at_their_line(line: str) -> None:
    assert ("unsequenced", 9) in findings_of(text(line))


@pytest.mark.parametrize(
    "line",
    [
        "i = i + 1;",
        "k = i++, i;",
        "k = (i++, i);",
        "k = i++ && i;",
        "k = i++ || i;",
        "k = i++ ? i : -i;",
        "k = two(i++, k++);",
        "v[i++] = k++;",
        "k = v[i]++;",
        "k = two((i++, i), k);",
        "i = two(i, i);",
        "k = sizeof(i++) + i;",
        "i = k = i + 1;",
        "v[p->head++] = v[q->head];",
        "k = p->head++ + p->tail++;",
        "k = p->low++ + p->high++;",
        "for (i = 0, k = i; i < 3; i++, k += i)\n        ;",
    ],
)
def test_where_c_gives_an_order_nothing_is_found(line: str) -> None:
    assert "unsequenced" not in [rule for rule, _ in findings_of(text(line))]


def test_a_function_that_nothing_has_declared_is_found_at_its_call() -> None:
    # memcpy takes a size of 32 bits; without its prototype 4 * n goes as one of 16.
    source = "int a[8], b[8];\nvoid f(int n)\n{\n    memcpy(a, b, 4 * n);\n}\n"
    assert ("implicit-declaration", 4) in findings_of(source)


def test_a_function_that_is_declared_is_not() -> None:
    source = "#include <string.h>\nint a[8], b[8];\nvoid f(int n)\n{\n    memcpy(a, b, 4 * n);\n}\n"
    assert "implicit-declaration" not in [rule for rule, _ in findings_of(source)]


@pytest.mark.parametrize(
    ("function", "arguments", "rule", "named"),
    [
        # The object is the one that the source names, not the value that is kept of it.
        ("int f(int n)\n{\n    return n--;\n}\n", (-32768,), "overflow", "n - 1"),
        (
            "int v[2] = { 1, 2 };\nint f(int n)\n{\n    int *p = v + n;\n    return *p++;\n}\n", (2,),
            "pointer-outside", "p",
        ),
        (
            "union u { union u *next; int w[2]; };\nint f(int n)\n{\n    union u *p = 0;\n    return p->w[n];\n}\n",
            (0,), "null-dereference", "p",
        ),
    ],
)
def test_what_is_kept_of_an_object_is_told_by_its_name(
    function: str, arguments: tuple[int, ...], rule: str, named: str
) -> None:
    workshop = CWorkshop(function)
    workshop.call("f", *arguments)
    (told,) = [finding for finding in workshop.findings if finding.rule == rule]
    assert told.object.rsplit(".", 1)[-1] == named
