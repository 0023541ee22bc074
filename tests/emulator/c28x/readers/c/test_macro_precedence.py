"""Macros without parentheses: told where an operator takes a part of the text or of an argument, silent where not."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.readers.c.preprocessor import preprocess_text
from tests.emulator.c28x.readers.c.workshop import CWorkshop, findings_of


def remarks(defines: str, use: str) -> list[str]:
    """The macros that are told, each with the operator beside the part that it takes."""
    unit = preprocess_text(f"{defines}\ny = {use};\n", "t.c")
    return [f"{r.name} {r.message.split(': the ')[1].split()[0]}" for r in unit.remarks if r.rule == "macro-precedence"]


@pytest.mark.parametrize(("defines", "use", "told"), [
    ("#define S(x) x * 2", "S(a + b)", ["S *"]), ("#define S(x) 2 * x", "S(a - b)", ["S *"]),
    ("#define S(x) x * 2 + 1", "S(a) * 2", ["S *"]), ("#define S(x) x / 8", "S(a << 3)", ["S /"]),
    ("#define F A | B", "x & F", ["F &"]), ("#define F A | B", "F == 0", ["F =="]), ("#define F A & B", "!F", ["F !"]),
    ("#define R 3 / 4", "x / R", ["R /"]), ("#define R a - b", "x - R", ["R -"]), ("#define R a + b", "-R", ["R -"]),
    ("#define M(a, b) a > b ? a : b", "M(x, y) + 1", ["M +"]),
    ("#define M(a, b) a > b ? a : b", "M(x & 1, y)", ["M >"]),
    ("#define N(x) -x", "N(a + b)", ["N -"]), ("#define N(x) ~x", "N(a | b)", ["N ~"]),
    ("#define LEN sizeof(v) / sizeof(v[0])", "n % LEN", ["LEN %"]),
    ("#define D(A) f(((long double) A * 1000.0L) / 5)", "D(a + b)", ["D *"]),
    ("#define A x + y\n#define B A * 2", "B", ["A *"]), ("#define A x + y\n#define S(x) (x * 2)", "S(A)", ["S *"]),
])  # fmt: skip
def test_a_part_of_a_text_or_of_an_argument_is_told(defines: str, use: str, told: list[str]) -> None:
    assert remarks(defines, use) == told


@pytest.mark.parametrize(("defines", "use"), [
    ("#define S(x) ((x) * 2)", "S(a + b) * 3"), ("#define S(x) x * 2", "S(a)"), ("#define S(x) x * 2", "S(a * b)"),
    ("#define S(x) x * 2", "S((a + b))"), ("#define S(x) x * 2", "S(f(a + b, c)[i + 1])"),
    ("#define S(x) f(x, 2)", "S(a + b)"),
    ("#define S(x) x << 2", "S(a + b)"), ("#define S(x) x + 2", "S(a - b)"), ("#define S(x) #x", "S(a + b) * 2"),
    ("#define F A | B", "F | x"), ("#define F A | B", "x || F"), ("#define F A | B", "f(F, 2)"),
    ("#define F A | B", "F"),
    ("#define R 3 / 4", "x * R"), ("#define R 3 / 4", "R * x"), ("#define R 3 / 4", "(float) R"),
    ("#define R 3 / 4", "-R"),
    ("#define R a - b", "x + R"), ("#define R a - b", "R - x"), ("#define E (int) -1", "E * 2"),
    ("#define E -1", "x - E"),
    ("#define P (*(volatile int *) 0x7000)", "P * 2"), ("#define U unsigned long", "sizeof(U) * 2"),
    ("#define L(x) do { x * 2; } while (0)", "0; L(a)"), ("#define I int *", "(I) p"),
    ("#define C a, b + c", "f(C) * 2"),
    ("#define LEN sizeof(v) / sizeof(v[0])", "n < LEN - 1"), ("#define S sizeof(int)", "n / S"),
    ("#define T(x) (long) x", "T(a + b)"), ("#define A x = y", "A * 2"),
])  # fmt: skip
def test_what_is_the_same_with_parentheses_or_meant_so_is_not_told(defines: str, use: str) -> None:
    assert remarks(defines, use) == []


def test_the_finding_stands_at_the_use_in_its_function() -> None:
    text = "#define F 1 | 2\nint g(int x)\n{\n    return x & F;\n}\n"
    assert [found for found in findings_of(text) if found[0] == "macro-precedence"] == [("macro-precedence", 4)]


OPERATORS = ("*", "/", "%", "+", "-", "<<", ">>", "<", "==", "&", "^", "|", "&&", "||")


@given(st.sampled_from(OPERATORS), st.sampled_from(OPERATORS), st.booleans())
def test_what_is_not_told_is_what_parentheses_give(outer: str, inner: str, behind: bool) -> None:
    """Computed with both texts: where the values differ, it is told, but for `*` before a quotient."""
    use = f"M {outer} c" if behind else f"c {outer} M"
    body = "int f(int a, int b, int c) { return " + use + "; }\n"
    told = bool(remarks(f"#define M a {inner} b", use))
    values = [
        [CWorkshop(f"#define M {text}\n{body}").call("f", a, b, c) for a, b, c in ((7, 2, 3), (5, 3, 2), (9, 4, 1))]
        for text in (f"a {inner} b", f"(a {inner} b)")
    ]  # fmt: skip
    if values[0] != values[1] and not (outer == "*" and inner in ("/", "%") and not behind):
        assert told
