"""Locals read before they are written: what is said without running, and what a run finds there.

A run is held against an interpreter of its own: reads of locals that nothing has written are counted by walking the
same statements in Python.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.emulator.c28x.readers.c.workshop import CWorkshop

RULES = ("maybe-uninitialised", "switch-no-default", "missing-return", "unreachable")

# Each function reads `x` in the line that is marked.  ISO C 6.7.9 10: a local without initialiser is indeterminate.
DEFECTS = {
    "a break past the assignment": """
int f(int a, int n) {
    int x;
    switch (n) {
    case 1: if (a) break; x = 1; break;
    default: x = 2;
    }
    return x; // <-
}""",
    "a case that is entered below the declaration's value": """
int f(int n) {
    int r = 0;
    switch (n) {
    case 0: ; int x = 5; r = x; break;
    case 1: r = x; break; // <-
    default: break;
    }
    return r;
}""",
    "a condition that a conversion changes: 0x10000 is not 0, its low word is": """
int f(long n) {
    int x;
    if ((int)n) x = 1;
    if (n) return x; // <-
    return 0;
}""",
    "a condition on a counter that has moved on": """
int f(void) {
    int i, x;
    for (i = 0; i < 4; i++) { if (i == 4) x = 1; }
    if (i == 4) return x; // <-
    return 0;
}""",
    "a step that has counted to the end": """
int f(int n) {
    int i, x;
    for (i = 0; i < 10; i += 2) { n++; }
    while (i < 5) { x = 1; i++; }
    return x; // <-
}""",
}  # fmt: skip

SILENT = {
    "a do runs once": "int f(int n) { int x; do { x = n; n--; } while (n > 0); return x; }",
    "the condition guards the operand": "int f(int ok) { int x; if (ok) x = 3; return ok ? x : 0; }",
    "a flag guards the value":
        "int f(int n) { int i, x, found = 0; for (i = 0; i < n; i++) if (i == 3) { x = i; found = 1; }"
        " return found ? x : 0; }",
    "cases that fall through":
        "int f(int n) { int x; switch (n) { case 0: x = 1; case 1: x = 2; break; default: x = 3; } return x; }",
    "every constant of an enumeration":
        "enum e { A, B }; int f(enum e k) { int x; switch (k) { case A: x = 1; break; case B: x = 2; break; }"
        " return x; }",
    "a return for every constant":
        "enum e { A, B }; int f(enum e k) { switch (k) { case A: return 1; case B: return 2; } }",
}  # fmt: skip


def said(shop: CWorkshop) -> list[tuple[str, int]]:
    return [(f.rule, f.place.line) for f in shop.findings if f.rule in RULES and f.place is not None]


@pytest.mark.parametrize("source", DEFECTS.values(), ids=DEFECTS.keys())
def test_a_way_without_a_value_is_shown_without_running(source: str) -> None:
    (line,) = (number for number, text in enumerate(source.splitlines(), 1) if "<-" in text)
    assert said(CWorkshop(source, static=True)) == [("maybe-uninitialised", line)]


@pytest.mark.parametrize("source", SILENT.values(), ids=SILENT.keys())
def test_a_right_function_is_not_told_that_it_is_wrong(source: str) -> None:
    assert said(CWorkshop(source, static=True)) == []


def test_a_declaration_that_a_case_jumps_over_gives_no_value() -> None:
    shop = CWorkshop(DEFECTS["a case that is entered below the declaration's value"])
    assert shop.call("f", 0) == 5
    assert shop.rules() == []
    assert shop.call("f", 1) == 0  # nothing has written x: the fill policy gives 0
    assert shop.rules() == ["uninitialised"]


@pytest.mark.parametrize("source", ["every constant of an enumeration", "a return for every constant"])
def test_an_enumeration_that_holds_something_else_is_found_once_when_it_runs(source: str) -> None:
    shop = CWorkshop(SILENT[source])
    assert [shop.call("f", value) for value in (0, 1)] == [1, 2]
    assert shop.rules() == []
    shop.call("f", 7)
    # That x, or the function, has no value then is the consequence of the missing case, and not told besides.
    assert shop.rules() == ["no-case"]
    shop.findings.clear()
    shop.call("f", -1)  # "none" may be meant to have no case, but then nothing may read what has no value
    assert shop.rules() == ["uninitialised"]


def test_a_read_that_another_way_leaves_without_a_value_is_told_beside_the_missing_case() -> None:
    source = (
        "enum e { A, B }; int f(enum e k, int ok) { int x; if (ok) { switch (k) { case A: x = 1; break;\n"
        "case B: x = 2; break; } } return x; }"
    )
    shop = CWorkshop(source)
    shop.call("f", 7, 1)
    shop.call("f", 0, 0)
    assert shop.rules() == ["no-case", "uninitialised"]


@pytest.mark.parametrize("way", ["struct S y; y = g();", "struct S y = g();"])
def test_what_a_structure_s_copy_never_held_is_not_there_in_the_target(way: str) -> None:
    source = f"struct S {{ int a, b; }}; struct S g(void) {{ struct S s; s.b = 4; return s; }} int f(void) {{ {way} "
    shop = CWorkshop(source + "return y.b * 10 + y.a; }")
    assert shop.call("f") == 40
    assert shop.rules() == ["uninitialised"]


# `g` and member b of what `partly` returns are never written; the fill policy gives 0 for them.
COPIES = {
    "a parameter": ("static int h(struct S s) { return s.b; } int f(void) { return h(g); }", "drv.h.s"),
    "an element of a parameter": (
        "static int h(struct S s, int i) { return s.v[i]; } int f(void) { return h(g, 1); }", "drv.h.s"
    ),
    "a parameter that another one was copied to": (
        "static int h(struct S s, struct S t) { s = t; return s.b; } int f(void) { return h(partly(), g); }", "drv.h.s"
    ),
    "a result": ("int f(void) { return partly().b; }", "partly().b"),
    "the value of an assignment": ("int f(void) { struct S s; return (s = g).b; }", "(s = g).b"),
}  # fmt: skip


@pytest.mark.parametrize("fill", ["zero", "stack"])
@pytest.mark.parametrize(("source", "named"), COPIES.values(), ids=COPIES.keys())
def test_a_member_of_a_copy_that_nothing_has_written_is_told_by_the_name_of_the_copy(
    source: str, named: str, fill: str
) -> None:
    kinds = "struct S { int a, b, v[2]; }; static struct S g; static struct S partly(void) { struct S s; s.a = 1; "
    shop = CWorkshop(kinds + "return s; }\n" + source, fill=fill)
    assert shop.call("f") == 0
    assert [(f.rule, f.object) for f in shop.findings] == [("uninitialised", named)]


def test_a_scalar_parameter_that_memcpy_fills_from_what_nothing_has_written_is_told() -> None:
    shop = CWorkshop(
        '#include <string.h>\nstatic float raw[2]; float f(float x) { memcpy(&x, raw, sizeof x); return x + 1.0f; }'
    )
    assert shop.call("f", 3.0) == 1.0
    assert shop.rules()[0] == "uninitialised"


# Statements as tuples: what they are, and what they are made of.  `n` and `m` are parameters, a, b, c locals.
_locals = st.sampled_from("abc")
_tests = st.tuples(st.sampled_from("nm"), st.sampled_from(["==", "!=", ">", "<"]), st.integers(-1, 2))
_simple = st.one_of(
    st.tuples(st.just("write"), _locals, st.integers(0, 2)),
    st.tuples(st.just("read"), _locals),
    st.tuples(st.just("change"), st.sampled_from("nm"), st.integers(-2, 2)),
    st.tuples(st.just("guarded"), _locals, _locals),
    st.sampled_from([("break",), ("continue",)]),
)


def _compound(inner: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    body = st.lists(inner, max_size=4)
    return st.one_of(
        st.tuples(st.just("if"), _tests, body, body),
        st.tuples(st.sampled_from(["while", "do", "for"]), _tests, body),
        st.tuples(st.just("switch"), st.lists(st.tuples(body, st.booleans()), min_size=1, max_size=3), st.booleans()),
    )


PROGRAMS = st.lists(st.recursive(_simple, _compound, max_leaves=12), min_size=1, max_size=6)


@dataclass
class Text:
    """The statements as C.  A loop turns at most three times, by a counter of its own."""

    counters: int = 0

    def block(self, body: Any, around: str = "") -> str:
        return "{ " + " ".join(self.statement(s, around) for s in body) + " }"

    def statement(self, s: Any, around: str) -> str:
        match s:
            case ("write", name, value):
                return f"{name} = {value};"
            case ("read", name):
                return f"r += {name};"
            case ("change", name, by):
                return f"{name} += {by};"
            case ("guarded", flag, name):
                return f"if ({flag}) r += {name};"
            case ("break",):
                return "break;" if around else ";"
            case ("continue",):
                return "continue;" if "loop" in around else ";"
            case ("if", (name, op, value), then, otherwise):
                return f"if ({name} {op} {value}) {self.block(then, around)} else {self.block(otherwise, around)}"
            case ("switch", cases, default):
                texts = []
                for number, (body, falls) in enumerate(cases):
                    last = default and number == len(cases) - 1
                    label = "default" if last else f"case {number}"
                    leave = "" if falls and number < len(cases) - 1 else " break;"
                    texts.append(f"{label}: {self.block(body, around + 'switch')}{leave}")
                return f"switch (n) {{ {' '.join(texts)} }}"
            case (kind, (name, op, value), body):
                self.counters += 1
                i = f"i{self.counters}"
                inner = self.block(body, around + "loop")
                if kind == "for":
                    return f"for ({i} = 0; {i} < 3 && {name} {op} {value}; {i}++) {inner}"
                if kind == "while":
                    return f"{i} = 0; while ({i}++ < 3 && {name} {op} {value}) {inner}"
                return f"{i} = 0; do {inner} while ({i}++ < 3 && {name} {op} {value});"
        raise AssertionError(s)


class Leave(Exception):
    """`break` or `continue`."""


class Break(Leave):
    pass


class Continue(Leave):
    pass


@dataclass
class Run:
    """The statements run in Python; `missing`: the locals that were read with nothing in them (they read 0)."""

    values: dict[str, int]
    r: int = 0
    missing: set[str] = field(default_factory=set)

    def get(self, name: str) -> int:
        if name not in self.values:
            self.missing.add(name)
        return self.values.get(name, 0)

    def holds(self, test: tuple[str, str, int]) -> bool:
        name, op, value = test
        left = self.get(name)
        return {"==": left == value, "!=": left != value, ">": left > value, "<": left < value}[op]

    def block(self, body: Any, around: str = "") -> None:
        for s in body:
            self.statement(s, around)

    def statement(self, s: Any, around: str) -> None:
        match s:
            case ("write", name, value):
                self.values[name] = value
            case ("read", name):
                self.r += self.get(name)
            case ("change", name, by):
                self.values[name] += by
            case ("guarded", flag, name):
                if self.get(flag):
                    self.r += self.get(name)
            case ("break",):
                if around:
                    raise Break
            case ("continue",):
                if "loop" in around:
                    raise Continue
            case ("if", test, then, otherwise):
                self.block(then if self.holds(test) else otherwise, around)
            case ("switch", cases, default):
                n = self.values["n"]
                last = len(cases) - 1
                entered = n if 0 <= n <= last - default else last if default else len(cases)
                try:
                    for number in range(entered, len(cases)):
                        body, falls = cases[number]
                        self.block(body, around + "switch")
                        if not falls:
                            return
                except Break:
                    return
            case (kind, test, body):
                turns = 0
                while (kind == "do" and turns == 0) or (turns < 3 + (kind == "do") and self.holds(test)):
                    turns += 1
                    try:
                        self.block(body, around + "loop")
                    except Break:
                        return
                    except Continue:
                        pass


@given(PROGRAMS, st.integers(-1, 3), st.integers(-1, 3))
def test_a_run_reads_what_nothing_wrote_just_where_c_does_and_only_where_it_was_foretold(
    program: Any, n: int, m: int
) -> None:
    text = Text()
    body = text.block(program)
    counters = "".join(f", i{i + 1} = 0" for i in range(text.counters))
    shop = CWorkshop(f"int f(int n, int m) {{ int a, b, c, r = 0{counters}; {body} return r; }}", static=True)
    foretold = {f.object for f in shop.findings if f.rule == "maybe-uninitialised"}
    expected = Run({"n": n, "m": m})
    expected.block(program)
    assert shop.call("f", n, m) == expected.r
    assert {f.object for f in shop.findings if f.rule == "uninitialised"} == {f"drv.f.{x}" for x in expected.missing}
    assert {f"drv.f.{x}" for x in expected.missing} <= foretold
