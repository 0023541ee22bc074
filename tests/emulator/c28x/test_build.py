"""C's rules on typed nodes, as both readers use them: expected trees are written down by hand."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x import build
from emulator.c28x.build import Braces, Builder, Item
from emulator.c28x.ctypes import (
    BOOL,
    CHAR,
    FLOAT,
    INT,
    LLONG,
    LONG,
    UINT,
    ULLONG,
    ULONG,
    CType,
    StructType,
    UnionType,
    bit_field,
    complete,
    make_struct,
    scalars,
    usual,
)  # fmt: skip
from emulator.c28x.symbols import Module, SourceError
from emulator.c28x.tree import (
    Assign,
    Const,
    Declaration,
    Declare,
    Expr,
    If,
    Load,
    LValue,
    Variable,
    Where,
    While,
)  # fmt: skip

HERE = Where("m.c", 3, 5)


@pytest.fixture
def b() -> Builder:
    return build.file_scope(Module("m", "m.c", "", "m.c"))


def variable(name: str, ctype: CType = INT, kind: str = "global") -> Variable:
    return Variable(Declaration(name, ctype, "m", "m.c", 1), ctype, kind)


def place(name: str, ctype: CType = INT) -> LValue:
    return build.object_place(variable(name, ctype), HERE)


def number(value: int) -> Const:
    return build.integer(value, HERE)


@pytest.mark.parametrize(
    ("value", "decimal", "suffix", "ctype"),
    [
        (32767, True, "", INT),
        (32768, True, "", LONG),  # decimal: never unsigned int
        (32768, False, "", UINT),  # 0x8000
        (65536, False, "", LONG),
        (40000, True, "u", UINT),
        (1, True, "l", LONG),
        (1, True, "ul", ULONG),
        (1, True, "ll", LLONG),
        (1 << 32, True, "", LLONG),
        ((1 << 64) - 1, False, "", ULLONG),
    ],
)
def test_an_integer_constant_has_the_first_type_that_holds_it(
    value: int, decimal: bool, suffix: str, ctype: CType
) -> None:
    assert build.integer(value, HERE, decimal=decimal, suffix=suffix).ctype == ctype


def test_a_macro_in_an_error_names_both_its_ends() -> None:
    where = Where("m.c", 3, 5, Where("limits.h", 9, 20))
    error = SourceError.at(where, "no")
    assert str(error) == "m.c:3:5: no (written by the macro at limits.h:9:20)"


# Effects


def test_an_operand_that_a_later_effect_changes_is_kept_before_it(b: Builder) -> None:
    i = place("i")
    # i + i++: the left i is read first, then i++ happens.
    left, right = build.operands(b, lambda: build.value_of(b, i), lambda: build.step(b, "+", i, HERE, before=False))
    kept, old, stepped = b.out
    assert isinstance(old, Declare)  # the value of i++: i before the step
    assert isinstance(kept, Declare)
    assert isinstance(stepped, Assign)
    assert isinstance(left, Load)
    assert left.lvalue.root is kept.variable
    assert isinstance(right, Load)
    assert right.lvalue.root is old.variable


def test_two_effects_on_one_object_without_an_order_are_remarked_once(b: Builder) -> None:
    i = place("i")
    build.operands(
        b, lambda: build.step(b, "+", i, HERE, before=False), lambda: build.step(b, "+", i, HERE, before=False)
    )
    assert [(r.rule, r.name) for r in b.module.remarks] == [("unsequenced", "i")]


def test_effects_on_two_objects_are_right(b: Builder) -> None:
    i, k = place("i"), place("k")
    build.operands(
        b, lambda: build.step(b, "+", i, HERE, before=False), lambda: build.step(b, "+", k, HERE, before=False)
    )
    assert b.module.remarks == []


def test_an_effect_on_the_right_of_and_happens_only_if_the_left_is_true(b: Builder) -> None:
    i, k = place("i"), place("k")
    value = build.logic(
        b, "and", [lambda: build.value_of(b, i), lambda: build.step(b, "+", k, HERE, before=True)], HERE
    )
    decided, branch = b.out
    assert isinstance(decided, Declare)
    assert isinstance(branch, If)
    assert isinstance(branch.then[0], Assign)
    assert branch.then[0].target.root is k.root  # type: ignore[union-attr]
    assert isinstance(value, Load)


def test_three_operands_of_and_are_one_node(b: Builder) -> None:
    one, two, three = (build.value_of(b, place(n)) for n in "abc")
    inner = build.logic(b, "and", [lambda: one, lambda: two], HERE)
    assert build.logic(b, "and", [lambda: inner, lambda: three], HERE) == build.logic(
        b, "and", [lambda: one, lambda: two, lambda: three], HERE
    )


def test_an_assignment_as_a_value_is_what_the_object_holds(b: Builder) -> None:
    # (c = 0x1FF) of a bit-field of 8 bits is 0xFF.
    flags = complete(StructType("F"), [("c", UINT, 8)])
    c = build.member(b, place("f", flags), "c", HERE, text="f.c", base_text="f")
    value = build.assigned(b, c, number(0x1FF), HERE)
    assert build.constant_value(value) == 0xFF


def test_a_loop_whose_test_has_an_effect_tests_in_its_body(b: Builder) -> None:
    i = place("i")
    build.while_(b, lambda: build.step(b, "-", i, HERE, before=False), lambda: None, HERE)
    (loop,) = b.out
    assert isinstance(loop, While)
    assert loop.test == Const(INT, 1)
    assert isinstance(loop.body[-1], If)  # if (!old) break;


def test_a_loop_with_do_looks_at_its_test_behind_the_body(b: Builder) -> None:
    build.do_while(b, lambda: None, lambda: build.value_of(b, place("i")), HERE)
    (loop,) = b.out
    assert isinstance(loop, While)
    assert not loop.first


# Conversions and types


def test_64_bits_win_over_32_and_keep_what_is_unsigned() -> None:
    assert usual(LONG, LLONG) == LLONG
    assert usual(ULONG, LLONG) == LLONG  # long long holds every unsigned long
    assert usual(ULLONG, LLONG) == ULLONG
    assert usual(ULLONG, FLOAT) == FLOAT


def test_bool_is_0_or_1_and_promotes_to_int(b: Builder) -> None:
    assert build.constant_value(build.convert(b, number(256), BOOL)) == 1
    assert usual(BOOL, BOOL) == INT


def test_a_union_is_its_words_and_a_member_is_seen_through_a_pointer(b: Builder) -> None:
    both = UnionType("U")
    complete(both, [("f", FLOAT, None), ("w", build.array_of(UINT, 2, HERE), None)])
    assert (both.words, both.leaves, scalars(both)) == (2, 2, [(0, UINT), (1, UINT)])
    u = place("u", both)
    f = build.member(b, u, "f", HERE, text="u.f", base_text="u")
    assert isinstance(f, LValue)
    assert isinstance(f.root, Expr)
    assert (f.ctype, f.root.ctype) == (FLOAT, FLOAT.pointer)


def test_bit_fields_fill_a_word_from_its_lowest_bit() -> None:
    # a: bits 0-2, b: bits 3-11, c does not fit into the 4 bits left: the next word
    fields = complete(StructType("B"), [("a", UINT, 3), ("b", UINT, 9), ("c", UINT, 5)])
    assert [(m.offset, m.lo, m.width) for m in fields.members] == [(0, 0, 3), (0, 3, 9), (1, 0, 5)]
    assert fields.words == 2


def test_a_bit_field_of_width_0_ends_its_word() -> None:
    fields = complete(StructType("B"), [("a", UINT, 3), ("", UINT, 0), ("b", UINT, 3)])
    assert [(m.offset, m.lo) for m in fields.members] == [(0, 0), (1, 0)]


def test_a_signed_bit_field_has_a_sign() -> None:
    assert bit_field(3, signed=True).low == -4


# Initialisers


def item(value: int, *way: str | int) -> Item:
    return Item(HERE, lambda ctype: number(value), way)


def given_values(b: Builder, ctype: CType, *items: Item | Braces) -> list[int | float | None]:
    return [build.constant_value(v) for v in build.values(b, ctype, Braces(HERE, list(items)))]


def test_a_list_may_be_flat_or_nested(b: Builder) -> None:
    point = make_struct("P", [("x", INT), ("y", INT)])
    two = build.array_of(point, 2, HERE)
    flat = given_values(b, two, item(1), item(2), item(3))
    nested = given_values(b, two, Braces(HERE, [item(1), item(2)]), Braces(HERE, [item(3)]))
    assert flat == nested == [1, 2, 3, 0]


def test_designators_say_where_a_value_goes_and_what_follows_goes_on(b: Builder) -> None:
    point = make_struct("P", [("x", INT), ("y", INT), ("z", INT)])
    assert given_values(b, point, item(5, "y"), item(6)) == [0, 5, 6]
    assert given_values(b, build.array_of(INT, 4, HERE), item(5, 2), item(6), item(1, 0)) == [1, 0, 5, 6]
    assert given_values(b, build.array_of(point, 2, HERE), item(9, 1, "z")) == [0, 0, 0, 0, 0, 9]


def test_too_many_values_are_refused(b: Builder) -> None:
    with pytest.raises(SourceError, match="too many initialisers"):
        given_values(b, build.array_of(INT, 1, HERE), item(1), item(2))


def test_bit_fields_are_initialised_into_their_words(b: Builder) -> None:
    # a = 5 in bits 0-2, b = 2 in bits 3-11: 5 + 2 * 8 = 21
    fields = complete(StructType("B"), [("a", UINT, 3), ("b", UINT, 9), ("c", INT, None)])
    assert given_values(b, fields, item(5), item(2), item(-1)) == [21, 0xFFFF]


def test_an_array_takes_its_length_from_its_list_or_string() -> None:
    text = Item(HERE, lambda ctype: build.string("abc", HERE))
    assert build.length_given(CHAR, text) == 4
    assert build.length_given(INT, Braces(HERE, [item(1), item(7, 9), item(8)])) == 11


@given(values=st.lists(st.integers(-32768, 32767), min_size=1, max_size=6), length=st.integers(1, 8))
def test_a_flat_list_is_filled_up_with_zeros(values: list[int], length: int) -> None:
    b = build.file_scope(Module("m", "m.c", "", "m.c"))
    array = build.array_of(INT, length, HERE)
    if len(values) > length:
        with pytest.raises(SourceError):
            given_values(b, array, *map(item, values))
    else:
        assert given_values(b, array, *map(item, values)) == values + [0] * (length - len(values))
