"""Watching, checking and their slow paths change no value: plain and watched code compute the same."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from tests.emulator.c28x.workshop import Workshop

TYPES = {
    "a": "int16",
    "b": "int16",
    "u": "uint16",
    "v": "uint16",
    "c": "uchar",
    "s": "schar",
    "l": "int32",
    "w": "uint32",
}
RANGES = {
    "int16": (-32768, 32767), "uint16": (0, 65535), "uchar": (0, 65535), "schar": (-32768, 32767),
    "int32": (-(1 << 31), (1 << 31) - 1), "uint32": (0, (1 << 32) - 1),
}  # fmt: skip
EDGES = (0, 1, -1, 2, 127, 128, 255, 256, 32767, -32768, 65535, 40000, (1 << 31) - 1)

leaf = st.one_of(st.sampled_from(sorted(TYPES)), st.sampled_from([str(e) if e >= 0 else f"({e})" for e in EDGES]))


def grown(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    pairs = st.tuples(inner, inner)
    return st.one_of(
        st.tuples(pairs, st.sampled_from(["+", "-", "*", "&", "|", "^", "+", "-", "*", "/", "%"])).map(
            lambda x: f"({x[0][0]} {x[1]} {x[0][1]})"
        ),
        st.tuples(pairs, st.sampled_from(["<", "<=", ">", ">=", "==", "!="])).map(
            lambda x: f"({x[0][0]} {x[1]} {x[0][1]})"
        ),
        st.tuples(inner, st.sampled_from(["<<", ">>"]), st.integers(0, 15)).map(lambda x: f"({x[0]} {x[1]} {x[2]})"),
        st.tuples(st.sampled_from(sorted(RANGES)), inner).map(lambda x: f"{x[0]}({x[1]})"),
        inner.map(lambda x: f"(-{x})"),
        inner.map(lambda x: f"(~{x})"),
        st.tuples(inner, inner, inner).map(lambda x: f"({x[0]} if {x[1]} else {x[2]})"),
        inner.map(lambda x: f"table[({x}) & 7]"),
    )


expressions = st.recursive(leaf, grown, max_leaves=8)


def source(expression: str, result: str) -> str:
    parameters = ", ".join(f"{name}: {ctype}" for name, ctype in TYPES.items())
    return (
        "table: array[int16, 8] = (3, -1, 7, 32767, -32768, 0, 255, 256)\n"
        f"def f({parameters}) -> {result}:\n    r: {result}\n    r = {expression}\n    return r\n"
    )


@settings(max_examples=250, deadline=None)
@given(expressions, st.sampled_from([*RANGES, "float32"]), st.data())
def test_a_value_does_not_depend_on_how_the_image_is_linked(expression: str, result: str, data: st.DataObject) -> None:
    text = source(expression, result)
    shops = [Workshop(text), Workshop(text, watch=True)]
    for _ in range(3):
        values = [
            data.draw(st.one_of(st.integers(low, high), st.sampled_from([e for e in EDGES if low <= e <= high])))
            for low, high in (RANGES[ctype] for ctype in TYPES.values())
        ]
        first, *others = [repr(shop.f(*values)) for shop in shops]
        assert others == [first], expression
    assert len({shop.clock.now for shop in shops}) == 1, "the same time passes"
