"""Statements that do nothing, conditions that assign, bodies behind a semicolon: what only C can write."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import findings_of

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
    return [rule for rule, line in found if line == LINE and rule in ("idle-statement", "assigned-condition")]


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


def told_bodies(statement: str) -> list[int]:
    """The lines, from 0, of a statement at which a body is told that is none."""
    found = findings_of(f"#define TRACE()\n#define BOTH ) ;\n{HEAD}{statement}\n    return a + b;\n}}\n")
    return [line - LINE - 2 for rule, line in found if rule == "empty-body"]


@pytest.mark.parametrize(("statement", "lines"), [
    ("if (a > b); { k = 1; }", [0]), ("if (a > b);\n{ k = 1; }", [0]), ("if (a > b) ; k = 1;", [0]),
    ("    if (a > b);\n        k = 1;", [0]), ("if (a) { if (b)\n;\nif (a > b); { k = 1; } }", [2]),
    ("for (k = 0; k < 3; k++); { total++; }", [0]), ("while (live) ;\n{ total++; }", [0]),
])  # fmt: skip
def test_what_looks_like_the_body_behind_a_semicolon_is_told(statement: str, lines: list[int]) -> None:
    assert told_bodies(statement) == lines


@pytest.mark.parametrize("statement", [
    # What waits, or does nothing, and says so by where the `;` is or by what follows.
    "while (live); k = 1;", "while (live);\n    k = 1;", "for (k = 0; k < 3 && live; k++);\nk = 1;",
    "if (a > b)\n    ;\n{ k = 1; }", "    if (next());\n    k = 1;", "if (a) { if (next()); }",
    "if (next());\n\n{ k = 1; }",
    "if (a > b); else k = 1;", "if (a > b) /* nothing */ ;", "do k++; while (live); { k = 1; }",
    # A macro without text, and one that ends the statement.
    "if (a > b) TRACE(); k = 1;", "if (a > b BOTH { k = 1; }",
])  # fmt: skip
def test_a_semicolon_that_is_meant_is_not_told(statement: str) -> None:
    assert told_bodies(statement) == []
