"""FIXED("ID") is decided before anything is translated."""

from __future__ import annotations

import ast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.readers.python.preprocessor import fixed_ids, preprocess


def after(text: str, *fixes: str) -> str:
    return ast.unparse(preprocess(ast.parse(text), frozenset(fixes)))


def test_a_branch_that_is_not_taken_is_gone() -> None:
    text = 'def f():\n    if FIXED("A"):\n        x: int16 = 1\n'
    text += '    elif FIXED("B"):\n        x: int16 = 2\n    return x'
    assert after(text, "A") == "def f():\n    x: int16 = 1\n    return x"
    assert after(text, "B") == "def f():\n    x: int16 = 2\n    return x"
    assert after(text) == "def f():\n    return x"


def test_a_body_that_loses_everything_is_an_empty_statement() -> None:
    assert after('while x:\n    if FIXED("A"):\n        y = 1') == "while x:\n    pass"


def test_an_expression_may_depend_on_a_correction() -> None:
    assert after('x = 13 if FIXED("A") else 12', "A") == "x = 13"
    assert after('x = 13 if FIXED("A") else 12') == "x = 12"


def test_within_a_longer_condition_a_decided_part_vanishes() -> None:
    text = 'if (not FIXED("A") or i > 0) and v > 1 and (FIXED("B") or v > 350):\n    y = 1'
    assert after(text) == "if v > 1 and v > 350:\n    y = 1"
    assert after(text, "A", "B") == "if i > 0 and v > 1:\n    y = 1"


def test_anywhere_else_it_is_an_error() -> None:
    with pytest.raises(ValueError, match="allowed in a condition only"):
        preprocess(ast.parse('x = FIXED("A") + 1'), frozenset())


def test_ids_are_found_wherever_they_stand() -> None:
    assert fixed_ids(ast.parse('if FIXED("A") and not FIXED("B"):\n    x = 1 if FIXED("C") else 2')) == {"A", "B", "C"}


_conditions = st.recursive(
    st.sampled_from(['FIXED("A")', 'FIXED("B")', "p", "q"]),
    lambda inner: st.one_of(
        inner.map(lambda c: f"(not {c})"),
        st.tuples(inner, st.sampled_from(["and", "or"]), inner).map(lambda t: f"({t[0]} {t[1]} {t[2]})"),
    ),
    max_leaves=8,
)


@given(condition=_conditions, fixes=st.sets(st.sampled_from("AB")), p=st.booleans(), q=st.booleans())
def test_a_condition_means_the_same_before_and_after(condition: str, fixes: set[str], p: bool, q: bool) -> None:
    expected = eval(condition, {"FIXED": fixes.__contains__, "p": p, "q": q})
    decided = after(f"y = 0\nif {condition}:\n    y = 1", *fixes)
    space = {"p": p, "q": q}
    exec(decided, space)
    assert bool(space["y"]) == bool(expected)
