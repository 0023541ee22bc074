"""Calls of small functions are what these return, for checks of a whole program."""

from __future__ import annotations

import pytest

from emulator.c28x.passes.small_functions import with_small_functions
from emulator.c28x.tree import Assign, Evaluate, If, LValue, Return, Switch
from emulator.c28x.tree_queries import source_text, statements
from tests.emulator.c28x.readers.c.workshop import findings_of, read

HEAD = """\
static int level, limit, table[4]; static volatile int pressed; int again(void);
static int Get(void) { return level; }
static void Set(int value) { level = value; }
static int More(int n) { return n + limit; }
static int Twice(int n) { return n + n; }
static int At(int place) { return table[place]; }
static void Put(int place, int value) { table[place] = value; }
static int Full(void) { return More(Get()) > 7; }
static int Both(int a, int b) { return a && b; }
static int Late(int n) { return again() + n; }
static int Fast(void) { return 1; }
static int Down(int n) { return n ? Down(n - 1) : level; }
static int Count(void) { level++; return level; }
static void Begin(int n) { level = n + 1; }
"""


def texts(body: str) -> tuple[list[str], set[str]]:
    """The statements of a function, and the functions that are left."""
    (module,) = with_small_functions(read({"drv.c": f"{HEAD}int f(int p)\n{{\n{body}\n}}\n"}).translate())
    function = next(each for each in module.functions if each.name == "f")
    found = []
    for s in statements(function.body):
        match s:
            case Assign(target=LValue(text=text), value=value):
                found.append(f"{text} = {source_text(value)}")
            case If(test=value) | Evaluate(value=value) | Switch(subject=value):
                found.append(source_text(value))
            case Return(value=value) if value is not None:
                found.append(source_text(value))
        assert s.where.line > HEAD.count("\n")
    return found, {each.name for each in module.functions}


@pytest.mark.parametrize(("body", "shown"), [
    ("return Get();", ["level"]),
    ("if (Get() > 3) Set(0); return 2;", ["level > 3", "Set(...)", "2"]),
    ("return More(p * 2);", ["p * 2 + limit"]),
    ("switch (More(pressed)) { case 1: Put(2, pressed); } return 2;", ["pressed + limit", "Put(...)", "2"]),
    ("return At(p) - At(limit);", ["table[p] - table[limit]"]),
    ("return Twice(level);", ["level + level"]),
    ("if (Full()) limit = 1; return 2;", ["level + limit > 7", "limit = 1", "2"]),
    ("return Late(3);", ["again(...) + 3"]),
])  # fmt: skip
def test_a_call_is_what_the_function_returns(body: str, shown: list[str]) -> None:
    assert texts(body)[0] == shown


@pytest.mark.parametrize(("body", "shown"), [
    # An argument would be evaluated twice, perhaps not at all, or too late.
    ("return Twice(pressed);", ["Twice(...)"]),
    ("return Both(p, again());", ["Both(...)"]),
    ("return Late(level);", ["Late(...)"]),
    # A choice of the build, a function that calls itself, one that does two things, one that acts.
    ("return Fast();", ["Fast(...)"]),
    ("return Down(p);", ["Down(...)"]),
    ("return Count();", ["Count(...)"]),
    ("Begin(2); return p;", ["Begin(...)", "p"]),
])  # fmt: skip
def test_a_call_that_would_not_be_the_same_stays(body: str, shown: list[str]) -> None:
    assert texts(body)[0] == shown


def test_a_function_that_nothing_calls_any_more_is_left_out() -> None:
    _, left = texts("Set(1); return Twice(level) + Twice(pressed) + At(p);")
    assert "At" not in left
    assert {"Set", "Twice", "Put"} <= left  # called still, and never called


def rules(statements_of_f: str) -> set[tuple[str, int]]:
    """What is told of a function; its statements are in line 2."""
    head = "static int n, air, sum; static int Get(void) { return n; } static void Set(int v) { n = v; }"
    air = "static int Low(int by) { return air < by; } static int High(int by) { return air > by; }"
    return set(findings_of(f"{head} {air} void f(int raw) {{\n{statements_of_f}\n}}\n"))


@pytest.mark.parametrize(("body", "rule", "wrong"), [
    ("n = 0; sum += raw; n++; if (Get() >= 64) sum = 0;", "constant-condition", True),
    ("sum += raw; n++; if (Get() >= 64) sum = 0;", "constant-condition", False),
    ("Set(0); sum += raw; Set(Get() + 1); if (Get() >= 64) sum = 0;", "constant-condition", False),
    ("if (High(20)) sum = 1; else if (Low(30)) sum = 2;", "constant-condition", True),
    ("if (High(30)) sum = 1; else if (Low(20)) sum = 2;", "constant-condition", False),
])  # fmt: skip
def test_what_small_functions_return_is_told_like_what_is_used_in_place(body: str, rule: str, *, wrong: bool) -> None:
    assert ((rule, 2) in rules(body)) == wrong
