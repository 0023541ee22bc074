"""Random expressions: the translator, plain and watched, against C's rules applied with numpy's fixed-width types.

The model is written apart from the translator: it holds every value as a numpy scalar of the C type, and takes
promotions and usual conversions from a table spelled out by hand from ISO C 6.3.1 for a 16-bit int.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.emulator.c28x.workshop import Workshop

NUMPY: dict[str, Any] = {
    "char": np.int16, "schar": np.int16, "uchar": np.uint16, "int16": np.int16, "uint16": np.uint16,
    "int32": np.int32, "uint32": np.uint32, "float32": np.float32,
}  # fmt: skip
#: Integer promotion: unsigned char has 16 bits here and becomes unsigned int.
PROMOTED = {"char": "int16", "schar": "int16", "uchar": "uint16"}
#: The type of a binary operation on promoted operands (symmetric).
USUAL = {
    ("int16", "int16"): "int16", ("int16", "uint16"): "uint16", ("uint16", "uint16"): "uint16",
    ("int16", "int32"): "int32", ("uint16", "int32"): "int32", ("int32", "int32"): "int32",
    ("int16", "uint32"): "uint32", ("uint16", "uint32"): "uint32", ("int32", "uint32"): "uint32",
    ("uint32", "uint32"): "uint32",
}  # fmt: skip
VARIABLES = {
    "a": "int16",
    "b": "uint16",
    "c": "uchar",
    "d": "char",
    "e": "int32",
    "f": "uint32",
    "x": "float32",
    "y": "float32",
}


def promoted(ctype: str) -> str:
    return PROMOTED.get(ctype, ctype)


def usual(a: str, b: str) -> str:
    if "float32" in (a, b):
        return "float32"
    pair = (promoted(a), promoted(b))
    return USUAL.get(pair) or USUAL[pair[1], pair[0]]


def flush(value: Any) -> Any:
    """The FPU has no denormals."""
    return np.float32(0) if value.dtype == np.float32 and 0 < abs(value) < np.float32(2.0**-126) else value


def model(node: Any, env: dict[str, Any]) -> tuple[Any, str]:
    """(value, C type) of an expression by the independent model."""
    match node:
        case ("var", name):
            return env[name], VARIABLES[name]
        case ("const", value):
            ctype = "int16" if -32768 <= value <= 32767 else "int32"
            return NUMPY[ctype](value), ctype
        case ("cast", ctype, inner):
            value, _ = model(inner, env)
            return convert(value, ctype), ctype
        case ("-" | "~" as op, inner):
            value, ctype = model(inner, env)
            ctype = promoted(ctype)
            value = convert(value, ctype)
            return (np.negative(value) if op == "-" else np.invert(value)), ctype
        case ("<<" | ">>" as op, left, count):
            value, ctype = model(left, env)
            ctype = promoted(ctype)
            value = convert(value, ctype)
            shift = NUMPY[ctype](count)
            return (np.left_shift(value, shift) if op == "<<" else np.right_shift(value, shift)), ctype
        case (op, left, right):
            (a, ta), (b, tb) = model(left, env), model(right, env)
            ctype = usual(ta, tb)
            a, b = convert(a, ctype), convert(b, ctype)
            if op in ("<", "=="):
                return np.int16(a < b if op == "<" else a == b), "int16"
            operation = {
                "+": np.add,
                "-": np.subtract,
                "*": np.multiply,
                "&": np.bitwise_and,
                "|": np.bitwise_or,
                "^": np.bitwise_xor,
            }[op]
            return flush(operation(a, b)), ctype
    raise AssertionError(node)


def convert(value: Any, ctype: str) -> Any:
    if ctype == "float32":
        return flush(np.float32(value))
    if isinstance(value, np.floating):
        info = np.iinfo(NUMPY[ctype])
        # Out of range is undefined in C; the policy under test saturates.
        low, high = int(info.min), int(info.max)
        if not math.isfinite(value):
            return NUMPY[ctype](low if value < 0 else high)
        return NUMPY[ctype](min(max(int(value), low), high))
    return np.array(value).astype(NUMPY[ctype])[()]


def text(node: Any) -> str:
    match node:
        case ("var", name):
            return name
        case ("const", value):
            return f"({value})"
        case ("cast", ctype, inner):
            return f"{ctype}({text(inner)})"
        case (op, inner):
            return f"({op}{text(inner)})"
        case (op, left, int(count)):
            return f"({text(left)} {op} {count})"
        case (op, left, right):
            return f"({text(left)} {op} {text(right)})"
    raise AssertionError(node)


leaves = st.one_of(
    st.sampled_from(sorted(VARIABLES)).map(lambda n: ("var", n)), st.integers(0, 40000).map(lambda v: ("const", v))
)


def integer(node: Any) -> bool:
    """Whether the model's type of `node` is an integer type."""
    zero = {name: NUMPY[t](0) for name, t in VARIABLES.items()}
    with np.errstate(all="ignore"):
        return model(node, zero)[1] != "float32"


def grow(inner: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    whole = inner.filter(integer)
    return st.one_of(
        st.tuples(st.sampled_from(["+", "-", "*", "<", "=="]), inner, inner),
        st.tuples(st.sampled_from(["&", "|", "^"]), whole, whole),
        st.tuples(st.sampled_from(["<<", ">>"]), whole, st.integers(0, 15)),
        st.tuples(st.just("-"), inner),
        st.tuples(st.just("~"), whole),
        st.tuples(st.just("cast"), st.sampled_from(sorted(NUMPY)), inner),
    )


expressions = st.recursive(leaves, grow, max_leaves=8)


def values(ctype: str) -> st.SearchStrategy[Any]:
    if ctype == "float32":
        return st.floats(-1e5, 1e5, width=32).map(lambda v: flush(np.float32(v)))
    info = np.iinfo(NUMPY[ctype])
    return st.integers(int(info.min), int(info.max)).map(NUMPY[ctype])


environments = st.fixed_dictionaries({name: values(ctype) for name, ctype in VARIABLES.items()})


@settings(max_examples=150, deadline=None)
@given(expressions, st.sampled_from(sorted(NUMPY)), st.lists(environments, min_size=1, max_size=4))
def test_an_expression_has_the_value_that_c_gives_it(node: Any, result: str, cases: list[dict[str, Any]]) -> None:
    parameters = ", ".join(f"{name}: {ctype}" for name, ctype in VARIABLES.items())
    source = f"def f({parameters}) -> {result}:\n    return {text(node)}\n"
    plain, watched = Workshop(source), Workshop(source, watch=True)
    for env in cases:
        with np.errstate(all="ignore"):
            expected = convert(model(node, env)[0], result)
        arguments = [env[name].item() for name in VARIABLES]
        for workshop in (plain, watched):
            actual = workshop.f(*arguments)
            assert actual == expected.item() or (math.isnan(actual) and math.isnan(expected)), source


@settings(max_examples=60, deadline=None)
@given(st.integers(-32768, 32767), st.integers(-32768, 32767), st.sampled_from("+-*"))
def test_a_signed_overflow_wraps_and_is_reported_only_when_it_happens(a: int, b: int, op: str) -> None:
    workshop = Workshop(f"def f(a: int16, b: int16) -> int16:\n    return a {op} b\n")
    exact = {"+": a + b, "-": a - b, "*": a * b}[op]
    assert workshop.f(a, b) == int(np.int64(exact).astype(np.int16))
    assert workshop.rules() == ([] if -32768 <= exact <= 32767 else ["overflow"])


@given(st.integers(0, 65535), st.integers(0, 65535))
def test_unsigned_arithmetic_wraps_silently(a: int, b: int) -> None:
    workshop = Workshop("def f(a: uint16, b: uint16) -> uint16:\n    return a - b\n")
    assert workshop.f(a, b) == (a - b) % 65536
    assert workshop.rules() == []
