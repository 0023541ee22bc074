"""Locals that only hold a value for the next statement."""

from __future__ import annotations

import pytest

from emulator.c28x.passes.held import with_held_values
from emulator.c28x.tree import Assign, Call, Declare, Evaluate, Expr, If, Return
from emulator.c28x.tree_queries import source_text, statements
from tests.emulator.c28x.readers.c.workshop import findings_of, read

HEAD = """\
int count, limit, shown, state; volatile int pressed; int again(void); int twice(int n);
"""


def values(body: str) -> list[str]:
    """The tests and values of the statements of a function, in the trees with held values."""
    (module,) = with_held_values(read({"drv.c": f"{HEAD}int f(int p)\n{{\n{body}\nreturn 0;\n}}\n"}).translate())
    function = next(each for each in module.functions if each.name == "f")
    found: list[Expr | None] = []
    for s in statements(function.body):
        match s:
            case If(test=value) | Assign(value=value) | Evaluate(value=value) | Return(value=value):
                found.append(value)
            case Declare(value=Expr() as value):
                found.append(value)
    return [source_text(value) for value in found if value is not None][:-1]


@pytest.mark.parametrize(("body", "kept"), [
    ("int held = count > limit; if (held) shown = 1;", ["count > limit", "1"]),
    ("int held; held = count > limit; if (held) shown = 1;", ["count > limit", "1"]),
    ("long held = count + p; shown = held;", ["count + p"]),
    ("int a = count; int b = limit; if (a > b) shown = 1;", ["count > limit", "1"]),
    ("int a = count + 1; int b = a * 2; shown = b;", ["(count + 1) * 2"]),
    ("int held = again(); shown = held;", ["again(...)"]),
    ("int held = pressed; if (held) shown = 1;", ["pressed", "1"]),
    ("if (p) shown = 1; else { int held = count; if (held) shown = 2; }", ["p", "1", "count", "2"]),
])  # fmt: skip
def test_a_value_for_the_next_statement_stands_where_it_is_read(body: str, kept: list[str]) -> None:
    assert values(body) == kept


@pytest.mark.parametrize(("body", "kept"), [
    # Read twice, set twice, changed between, or the name of a constant.
    ("int held = count; if (held) shown = held;", ["count", "held", "held"]),
    ("int held = count; if (p) held = limit; shown = held;", ["count", "p", "limit", "held"]),
    ("int held = count; count = 3; shown = held;", ["count", "3", "held"]),
    ("int held = 3; if (held) shown = 1;", ["3", "held", "1"]),
    ("int held = count; while (held) shown = 1;", ["count", "1"]),
    # A call changes what the value reads, or comes too late.
    ("int held = count; shown = again() + held;", ["count", "again(...) + held"]),
    ("int a = count; int b = again(); if (a > b) shown = 1;", ["count", "again(...)", "a > b", "1"]),
    ("int held = again(); if (p && held) shown = 1;", ["again(...)", "p and held", "1"]),
    ("int held = pressed; if (p || held) shown = 1;", ["pressed", "p or held", "1"]),
])  # fmt: skip
def test_a_value_that_is_not_the_same_there_stays_in_its_local(body: str, kept: list[str]) -> None:
    assert values(body) == kept


def rules(body: str) -> list[tuple[str, int]]:
    """What is told of statements of a function, which begin in line 2."""
    head = "static struct { int sum, number; unsigned flags; } own; int air, wanted, cooling, full;"
    return findings_of(f"{head} void f(int raw, int LIMIT) {{\n{body}\n}} void g(void) {{ own.flags |= 4u; }}\n")


@pytest.mark.parametrize(("body", "rule", "wrong"), [
    ("if (air > wanted - 5) cooling = 1; else { int held = air < wanted + 5; if (held) cooling = 0; }",
     "constant-condition", True),
    ("if (air > wanted + 5) cooling = 1; else { int held = air < wanted - 5; if (held) cooling = 0; }",
     "constant-condition", False),
    ("own.number = 0; own.sum += raw; own.number++; if (own.number >= 64) full = 1;", "constant-condition", True),
    ("own.number += raw; own.number++; if (own.number >= 64) full = 1;", "constant-condition", False),
    ("own.flags &= !1u;", "mixed-logic", True),
    ("own.sum &= !1u;", "mixed-logic", False),
])  # fmt: skip
def test_members_and_held_values_are_told_like_objects_and_conditions(body: str, rule: str, *, wrong: bool) -> None:
    assert ((rule, 2) in rules(body)) == wrong


def test_the_tree_that_is_read_stays_as_it_is() -> None:
    body = "int a = count + 1; int b = a * 2; twice(b); return 0;"
    modules = read({"drv.c": f"{HEAD}int f(int p) {{ {body} }}\n"}).translate()
    declared = (s for s in modules[0].functions[-1].body if isinstance(s, Declare))
    held = next(s for s in declared if s.variable.declaration.name == "b")
    (module,) = with_held_values(modules)
    (call,) = (s for s in module.functions[-1].body if isinstance(s, Evaluate))
    assert isinstance(call.value, Call)
    assert source_text(call.value.arguments[0]) == "(count + 1) * 2"
    assert isinstance(held.value, Expr)
    assert source_text(held.value) == "a * 2"
