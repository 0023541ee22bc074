"""Statements that do nothing, and conditions that assign or test something else: what only C can write."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import CWorkshop, findings_of

HEAD = """enum mode { OFF, SLOW, FAST };
struct link { struct link *next; int n; };
enum mode mode; int total, k; volatile int live; struct link *list; char *to, *from;
int next(void) { return 1; }
int f(int a, int b)
{
"""
LINE = HEAD.count("\n") + 1


def told(statement: str) -> list[str]:
    """The rules of this file that a statement is told by."""
    found = findings_of(f"{HEAD}    {statement}\n    return a + b;\n}}\n")
    mine = ("idle-statement", "assigned-condition", "constant-condition", "mixed-logic")
    return [rule for rule, line in found if line == LINE and rule in mine]


@pytest.mark.parametrize(
    "statement",
    ["mode == OFF;", "a + b;", "a < 3 && b < 3;", "next() == 1;", "for (a = 0; a < 3; b++, a + 1) if (next()) a++;"],
)
def test_a_statement_that_does_nothing_is_told(statement: str) -> None:
    assert told(statement) == ["idle-statement"]


@pytest.mark.parametrize(
    "statement",
    ["(void)a;", "(void)(a == b);", "a == 1 && next();", "a || next();", "next();", "a++, b--;", "live;"],
)
def test_a_statement_that_acts_or_is_said_to_be_idle_is_not_told(statement: str) -> None:
    assert told(statement) == []


@pytest.mark.parametrize(
    "statement",
    [
        "if (mode = FAST) a = 1;",
        "if ((mode = FAST)) a = 1;",
        "while (a = 0) b++;",
        "do b++; while (a = 0);",
        "if (a = b) k = 1;",
        "if (a = b) { b = a; k = a; }",
        "if (total = next()) k = 1;",
        "if (k == 1) b = 1; else if (mode = OFF) b = 2;",
        "if (a = b) k++; else k = a;",  # which is 0 there
    ],
)
def test_a_condition_that_assigns_is_told(statement: str) -> None:
    assert told(statement) == ["assigned-condition"]


@pytest.mark.parametrize(
    "statement",
    [
        "if (mode == FAST) a = 1;",
        "if ((a = next())) k = 1;",
        "if (a = next()) k = a;",
        "if (a = b) k = a;",
        "if (a = next()) k = 1;",  # it is looked at behind the branch
        "if (list = list->next) k = list->n;",
        "while (*to++ = *from++) ;",
        "while ((a = next()) != 0) k++;",
        "while (list = list->next) k += list->n;",
        "if (a += b) k = 1;",
        "if (a = b) k++; else a = 1;",
        "if (a = b) k++; else a++;",
    ],
)
def test_an_assignment_whose_value_is_wanted_is_not_told(statement: str) -> None:
    assert told(statement) == []


@pytest.mark.parametrize("statement", [
    "if (next) a = 1;", "while (!next) b++;", "if (a && next) b = 1;", "a = next ? 1 : 2;", "if (a && 4) b = 1;",
    'if (from == "on") b = 1;', 'if (a || from != "on") b = 1;', "if (a == 1) b = 1; else if (a == 1) b = 2;",
    "if (a == 1 || b == 2) k = 1; else if (k == 3) k = 2; else if (b == 2) k = 3;",
    "if (list->n == a) b = 1; else if (list->n == a) b = 2;",
])  # fmt: skip
def test_a_condition_that_tests_something_else_is_told(statement: str) -> None:
    assert told(statement) == ["constant-condition"]


@pytest.mark.parametrize("statement", [
    "if (next()) a = 1;", "if (list) a = 1;", "if (a && 1) b = 1;", "if (a & 4) b = 1;", "if (from == to) b = 1;",
    "if (*from == 'o') b = 1;", "if (live == 1) b = 1; else if (live == 1) b = 2;",
    "if (next() == 1) b = 1; else if (next() == 1) b = 2;", "if (a == 1) b = 1; else if (a == 2) b = 2;",
    "if (a == 1 && b == 2) k = 1; else if (b == 2) k = 3;", "if (a == 1) { b = 1; } if (a == 1) k = 2;",
    "if (a == 1) b = 1; else { a = next(); if (a == 1) b = 2; }",
])  # fmt: skip
def test_a_condition_that_can_change_is_not_told(statement: str) -> None:
    assert told(statement) == []


@pytest.mark.parametrize(("statement", "rules"), [
    ("a = 10^3;", ["mixed-logic"]), ("a = 2 ^ 15;", ["mixed-logic"]), ("a = b * 10^3;", ["mixed-logic"]),
    ("a = 0x10 ^ 3;", []), ("a = 3 ^ 2;", []), ("a = b ^ 2;", []), ("a = 10 ^ b;", []), ("a = b * k ^ 3;", []),
    ("a = b + 2 ^ 3;", []), ("a = 2 ^ 0x55;", []),
])  # fmt: skip
def test_an_exclusive_or_for_a_power_is_told(statement: str, rules: list[str]) -> None:
    assert told(statement) == rules


def test_a_repeated_test_names_the_line_of_the_first() -> None:
    chain = "    if (a == 1)\n        b = 1;\n    else if (a == 1)\n        b = 2;\n"
    drv = CWorkshop(f"{HEAD}{chain}    return b;\n}}\n", static=True)
    (finding,) = drv.findings.of("constant-condition")
    assert f"line {LINE} has tested it" in finding.message
    assert finding.place is not None
    assert finding.place.line == LINE + 2
