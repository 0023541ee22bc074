"""C text of types and constants: what is written is what a parser of C reads."""

from __future__ import annotations

import ast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.ctypes import (
    BASIC,
    INT,
    VOID,
    ArrayType,
    CType,
    FunctionType,
    HandleType,
    PointerType,
    make_struct,
)
from emulator.c28x.readers.c.declarators import declarator, definition
from emulator.c28x.readers.python.written import expression, replacement
from emulator.c28x.symbols import Define
from emulator.c28x.tree import Const
from tests.emulator.c28x.readers.c.parsed import Parsed, shape

PAIR = make_struct("Pair", [("a", INT), ("b", INT)])
HANDLE = HandleType("Task_Handle")
NAMED = "struct Pair { int a; int b; }; typedef struct Pair Pair; typedef struct Task_Object *Task_Handle;\n"


def pointer(target: CType) -> CType:
    return PointerType(f"{target} *", target)


def array(element: CType, length: int) -> CType:
    return ArrayType(f"{element}[{length}]", element, length)


def function(result: CType, parameters: list[CType]) -> CType:
    return FunctionType("funcptr", result, tuple(parameters))


OBJECTS = st.recursive(
    st.sampled_from([t for t in BASIC.values() if t != VOID] + [PAIR, HANDLE]),
    lambda inner: st.one_of(
        st.builds(pointer, inner),
        st.builds(array, inner, st.integers(1, 99)),
        # C functions return no arrays and take none.
        st.builds(
            function,
            inner.filter(lambda t: not isinstance(t, ArrayType)),
            st.lists(inner.filter(lambda t: not isinstance(t, ArrayType)), max_size=3),
        ),
    ),
    max_leaves=6,
)


@given(OBJECTS)
def test_a_declaration_is_read_back_as_its_type(ctype: CType) -> None:
    parsed = Parsed(f"{NAMED}extern {declarator(ctype, 'x')};", lambda name: None)
    assert parsed.shape(parsed.names["x"]) == shape(ctype)


@pytest.mark.parametrize(
    ("ctype", "text"),
    [
        (pointer(VOID), "void *x"),
        (pointer(array(INT, 3)), "int (*x)[3]"),
        (array(pointer(INT), 3), "int *x[3]"),
        (array(function(VOID, [INT]), 4), "void (*x[4])(int)"),
        (function(pointer(INT), []), "int *(*x)()"),
    ],
)
def test_declarators_are_written_inside_out(ctype: CType, text: str) -> None:
    assert declarator(ctype, "x") == text


def test_a_type_without_a_name_is_what_a_cast_takes() -> None:
    assert declarator(pointer(INT)) == "int *"
    assert declarator(INT) == "int"


def define(text: str) -> Define:
    node = ast.parse(text, mode="eval").body
    return Define("N", lambda b, where: Const(INT, 0), lambda: replacement(node, (text,)))


@pytest.mark.parametrize(
    ("python", "c"),
    [
        ("0x0F", "#define N 0x0F"),  # as it stands: 0x8000 is unsigned, 32768 a long
        ("65_535", "#define N 65535"),
        ("0b101", "#define N 5"),  # C99 has no binary constants
        ("0.5", "#define N 0.5"),
        ("'A'", "#define N 'A'"),
        ("'\\r'", "#define N '\\r'"),
        ("'%d\\n'", '#define N "%d\\n"'),
        ("1 << 4", "#define N (1 << 4)"),
        ("A | (B << 2)", "#define N (A | (B << 2))"),
        ("-1", "#define N (-1)"),
        ("~(A + 1)", "#define N (~(A + 1))"),
        ("US_SENSOR.LEFT", "#define N (LEFT)"),
        ("uint32(1000)", "#define N ((unsigned long)1000)"),
        ("int16(A + 1)", "#define N ((int)(A + 1))"),
    ],
)
def test_a_constant_keeps_its_writing_where_C_has_it(python: str, c: str) -> None:
    assert definition("N", define(python)) == c


@pytest.mark.parametrize("python", ["True", "None", "f(1)", "[1]", "b'x'", "2 ** 3"])
def test_what_C_has_no_constant_for_is_left_out(python: str) -> None:
    assert definition("N", define(python)) is None


@given(st.recursive(
    st.integers(0, 99).map(str),
    lambda inner: st.one_of(
        st.builds("({} {} {})".format, inner, st.sampled_from(["+", "-", "*", "|", "&", "^", "<<"]), inner),
        st.builds("(-{})".format, inner),
        st.builds("(~{})".format, inner),
    ),
    max_leaves=5,
).filter(lambda text: text.count("<<") < 2))  # fmt: skip
def test_operators_group_as_they_do_in_Python(text: str) -> None:
    # Both languages know these operators; parentheses stand wherever their precedence could differ.
    written = expression(ast.parse(text, mode="eval").body, (text,))
    assert written is not None
    try:
        expected = eval(text)
    except ValueError:  # a negative shift
        return
    assert eval(written) == expected
