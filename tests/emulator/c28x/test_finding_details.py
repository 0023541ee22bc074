"""What a finding says beside its rule: neighbours, address 0, names of elements; and what is deliberately silent."""

from __future__ import annotations

import pytest

from emulator.c28x.findings import Finding
from emulator.c28x.memory import Pointer
from emulator.c28x.runtime import EndlessPoll
from emulator.c28x.symbols import SourceError
from tests.emulator.c28x.workshop import Workshop


def only(shop: Workshop, rule: str) -> Finding:
    (finding,) = [f for f in shop.findings if f.rule == rule]
    return finding


def test_an_index_behind_an_array_names_the_object_that_follows() -> None:
    shop = Workshop("v: array[int16, 2] = (1, 2)\nnext: int16 = 7\ndef f(i: int16) -> int16:\n    return v[i]\n")
    assert shop.f(2) == 7
    assert only(shop, "index").details == ("what is read instead: drv.next",)


def test_an_index_outside_a_local_names_the_local_that_lies_there() -> None:
    source = """
def f(i: int16) -> int16:
    v: array[int16, 2] = (1, 2)
    w: array[int16, 3] = (3, 4, 5)
    return v[i] + w[0]
"""
    shop = Workshop(source)
    shop.f(3)
    # v at words 2..3 of the frame (behind the return address), w at 4..6: v[3] is w[1]
    assert only(shop, "index").details == ("what is read instead: drv.f.w[1], a local of the same function",)
    shop = Workshop(source)
    shop.f(-1)
    assert "the return address of drv.f" in only(shop, "index").details[0]


def test_where_nothing_is_linked_the_neighbour_says_so() -> None:
    shop = Workshop("v: array[int16, 2] = (1, 2)\ndef f(i: int16) -> int16:\n    return v[i]\n")
    shop.f(2000)
    assert "nothing is linked" in only(shop, "index").details[0]


def test_a_wrapped_index_says_what_it_was() -> None:
    shop = Workshop("v: array[int16, 4] = (1, 2, 3, 4)\ndef f(i: uint16) -> int16:\n    return v[i - 1]\n")
    shop.f(0)
    assert "-1 became 65535" in only(shop, "index").details[1]


def test_an_inner_subscript_reads_the_next_row_and_says_so() -> None:
    source = """
m: array[array[int16, 3], 2] = ((1, 2, 3), (4, 5, 6))
def f(i: int16, j: int16) -> int16:
    return m[i][j]
"""
    shop = Workshop(source)
    assert shop.f(0, 3) == 4
    assert only(shop, "index").details == (
        "what is read instead: drv.m[1][0], within the same object", "the subscripts are [0][3]",
    )  # fmt: skip
    assert only(shop, "index").value == 3


def test_an_inner_subscript_of_a_local_writes_its_own_next_row() -> None:
    source = (
        "def f(i: int16, j: int16) -> int16:\n    m: array[array[int16, 2], 2] = ((1, 2), (3, 4))\n"
        "    m[i][j] = 9\n    return m[1][0]\n"
    )
    for watched in (False, True):
        shop = Workshop(source, watch=watched)
        assert shop.f(0, 2) == 9
        assert shop.rules() == ["index"]


def test_a_null_pointer_tells_what_address_zero_holds_and_who_shares_it() -> None:
    source = """
p: ptr[float32] = NULL
q: ptr[float32] = NULL
def put(x: ptr[float32]) -> void:
    x[0] = 1.5
def f() -> float32:
    put(p)
    return q[0]
"""
    shop = Workshop(source)
    assert shop.f() == 1.5
    first, second = shop.findings.of("null-dereference")
    assert "holds 0.0 as float" in first.details[0]
    assert "holds 1.5 as float" in second.details[0]
    # line 2 of the header, then the empty one: put is called in line 9
    shared = "null pointers that share this cell so far: drv.put.x, called in line 9 of f; drv.q"
    assert first.details[1] == second.details[1] == shared


def test_every_caller_that_hands_a_null_pointer_over_is_named() -> None:
    source = """
def put(x: ptr[int16]) -> void:
    x[0] = 1
def f() -> void:
    put(NULL)
def g() -> void:
    put(NULL)
"""
    shop = Workshop(source)
    shop.f()
    shop.g()
    details = only(shop, "null-dereference").details
    assert "line 7 of f" in details[1]
    assert "line 9 of g" in details[1]


@pytest.mark.parametrize(
    ("n", "rule"), [(4, "memcpy-octets"), (8, "memcpy-octets"), (12, "memcpy-octets"), (7, "memcpy-outside"), (6, None)]
)
def test_a_length_in_octets_is_told_from_any_other(n: int, rule: str | None) -> None:
    # 3 floats are 6 words: 12 octets; two floats are 4 words, 8 octets; one is 2 words, 4 octets, which fits
    source = (
        f"a: array[float32, 3] = (1, 2, 3)\nb: array[float32, 3] = (0, 0, 0)\ndef f() -> void:\n    memcpy(b, a, {n})\n"
    )
    shop = Workshop(source)
    shop.f()
    assert shop.rules() == ([rule, rule] if rule and n > 6 else [])


def test_a_block_names_what_lies_behind_its_target() -> None:
    shop = Workshop("a: array[int16, 2] = (0, 0)\nflag: int16 = 0\ndef f() -> void:\n    memset(a, 1, 3)\n")
    shop.f()
    assert shop.value("flag") == 1
    assert only(shop, "memcpy-outside").details == ("what lies there: drv.flag",)


@pytest.mark.parametrize(
    ("call", "why"),
    [
        ('sprintf(text, "%d of %d", 12, 34)', "the text has 9 characters with its NUL"),
        ('strcpy(text, "overload")', "the text has 9 characters with its NUL"),
        ("memset(text, 0, 9)", "sizes count 16-bit words here"),
    ],
)
def test_a_text_that_is_too_long_is_no_matter_of_sizes(call: str, why: str) -> None:
    shop = Workshop(f"from emulator.c28x.rts import sprintf\ntext: array[char, 8]\ndef f() -> void:\n    {call}\n")
    shop.f()
    assert only(shop, "memcpy-outside").message.endswith(f"(8 words): {why}")


def test_the_element_that_was_never_written_is_named() -> None:
    source = """
class P(struct):
    x: int16
    y: array[float32, 2]
p: array[P, 2]
def f(i: int16) -> float32:
    return p[i].y[1]
"""
    shop = Workshop(source)
    shop.f(1)
    assert "drv.p[1].y[1] is read" in only(shop, "uninitialised").message


def test_the_element_behind_a_pointer_is_named() -> None:
    source = """
class P(struct):
    x: int16
    y: array[float32, 2]
p: array[P, 2]
def g(q: ptr[P]) -> float32:
    return q.y[0]
def f() -> float32:
    return g(addressof(p[1]))
"""
    shop = Workshop(source)
    shop.f()
    assert "drv.p[1].y[0] is read through drv.g.q" in only(shop, "uninitialised").message


def test_a_block_that_is_partly_written_is_copied_in_silence() -> None:
    source = "a: array[int16, 3]\nb: array[int16, 3]\ndef f() -> void:\n    a[1] = 5\n    memcpy(b, a, 3)\n"
    shop = Workshop(source)
    shop.f()
    assert shop.rules() == []
    assert shop.linked.objects["drv.b"].data == [None, 5, None]


def test_a_dangling_pointer_still_finds_the_old_value_until_somebody_lies_there() -> None:
    source = """
def make() -> ptr[int16]:
    x: int16 = 7
    return addressof(x)
def other(p: ptr[int16]) -> int16:
    y: int16 = 9
    q: ptr[int16]
    q = addressof(y)
    return p[0] + q[0] * 0
def first() -> int16:
    return make()[0]
def second() -> int16:
    return other(make())
"""
    shop = Workshop(source)
    assert shop.first() == 7
    assert "points to drv.make.x, whose function has returned" in only(shop, "dangling-pointer").message
    shop = Workshop(source)
    # y of `other` has the place in its frame that x had in that of `make`
    assert shop.second() == 9
    assert "drv.other.y lies there now" in only(shop, "dangling-pointer").details[0]


def test_a_written_dangling_pointer_changes_the_stack_and_not_the_dead_object() -> None:
    source = """
def make() -> ptr[int16]:
    x: int16 = 7
    return addressof(x)
def f() -> int16:
    p: ptr[int16]
    p = make()
    p[0] = 4
    return p[0]
"""
    shop = Workshop(source)
    assert shop.f() == 4
    assert [f.place.line for f in shop.findings if f.place] == [9 + 1, 9 + 2]


def test_a_pointer_to_a_callers_local_is_fine() -> None:
    shop = Workshop(
        "def put(p: ptr[int16]) -> void:\n    p[0] = 3\n"
        "def f() -> int16:\n    x: int16\n    put(addressof(x))\n    return x\n"
    )
    assert (shop.f(), shop.rules()) == (3, [])


@pytest.mark.parametrize(
    ("body", "now", "then"),
    [("return uint16(now - then) * 1.0", 5, 65530), ("return (now - then) * 1.0", 5, 65530)],
    ids=["cast", "plain"],
)
def test_elapsed_counts_of_a_free_running_timer_are_silent(body: str, now: int, then: int) -> None:
    shop = Workshop(f"def f(now: uint16, then: uint16) -> float32:\n    {body}\n")
    assert (shop.f(now, then), shop.rules()) == (11.0, [])


def test_a_sum_that_comes_right_in_the_end_is_silent() -> None:
    # adc + trim with trim = -3: 1000 + 65533 wraps to 997, which is what is meant
    shop = Workshop("def f(adc: uint16, trim: int16) -> float32:\n    return adc + trim\n")
    assert (shop.f(1000, -3), shop.rules()) == (997.0, [])
    assert shop.f(1, -3) == 65534.0
    assert shop.rules() == ["widened-late"]


def test_a_widened_overflow_says_so() -> None:
    shop = Workshop("def f(a: int16) -> int32:\n    return a * 1000\ndef g(a: int16) -> int16:\n    return a * 1000\n")
    shop.f(40)
    assert shop.rules() == ["widened-late", "overflow"]
    assert "instead of 40000" in only(shop, "widened-late").message
    shop = Workshop("def g(a: int16) -> int16:\n    return a * 1000\n")
    shop.g(40)
    assert shop.rules() == ["overflow"]


def test_the_mask_of_bit_15_is_silent_unless_it_is_widened() -> None:
    shop = Workshop("def f(n: int16) -> uint16:\n    return 1 << n\ndef g(n: int16) -> int32:\n    return 1 << n\n")
    assert (shop.f(15), shop.rules()) == (0x8000, [])
    assert shop.g(15) == -32768
    assert shop.rules() == ["widened-late", "overflow"]


def test_a_counter_of_characters_may_pass_255() -> None:
    shop = Workshop("def f() -> int16:\n    i: uchar = 0\n    while i < 300:\n        i += 1\n    return i\n")
    assert (shop.f(), shop.rules()) == (300, [])


def test_a_local_of_a_block_ends_with_it() -> None:
    source = "def f(a: int16) -> int16:\n    if a:\n        x: int16 = 1\n    return x\n"
    with pytest.raises(SourceError, match=r"drv.py:6:12: x is declared in an inner block \(line 5\) that has ended"):
        Workshop(source)


def test_two_blocks_may_have_a_local_of_the_same_name_and_may_hide_an_outer_one() -> None:
    source = """
def f() -> int16:
    i: int16
    t: int16 = 100
    s: int16 = 0
    for i in range(2):
        t: int16 = i
        s += t
    for i in range(2):
        t: float32 = i * 2
        s += t
    return s + t
"""
    for watched in (False, True):
        shop = Workshop(source, watch=watched)
        # 0 + 1 + 0 + 2 + 100
        assert (shop.f(), shop.rules()) == (103, [])


def test_a_loop_without_an_end_ends_the_call() -> None:
    source = "def f(n: int16) -> int16:\n    i: int16 = 0\n    while i < n:\n        n = 5\n    return i\n"
    shop = Workshop(source)
    with pytest.raises(EndlessPoll, match="i < n"):
        shop.f(5)
    assert only(shop, "endless-loop").place is not None
    assert only(shop, "endless-loop").place.line == 5  # type: ignore[union-attr]


def test_a_loop_without_an_end_may_call_functions_that_only_compute() -> None:
    source = (
        "def twice(n: int16) -> int16:\n    return n * 2\n"
        "def f(n: int16) -> int16:\n    i: int16 = 0\n    while i < n:\n        n = twice(n) % 7 + 1\n    return i\n"
    )
    shop = Workshop(source)
    with pytest.raises(EndlessPoll, match="i < n"):
        shop.f(5)
    place = only(shop, "endless-loop").place
    assert place is not None
    assert place.line == 7


def test_a_long_delay_loop_is_no_endless_loop() -> None:
    shop = Workshop("def f() -> void:\n    n: uint32 = 4000000\n    while n > 0:\n        n -= 400\n")
    shop.runtime.loop_limit = 1000
    shop.f()
    assert shop.rules() == []


def test_nan_is_reported_where_it_is_born_and_where_it_arrives_not_in_between() -> None:
    source = """
g: float32 = 0
def f(x: float32) -> float32:
    a: float32
    b: float32
    a = x * 1e30
    b = a - a
    b = b * 2.0
    g = b
    return sin(b)
"""
    shop = Workshop(source, watch=True)
    shop.f(1e20)
    assert [(f.rule, f.place.line) for f in shop.findings if f.place] == [
        ("nan", 8),
        ("nan-output", 11),
        ("nan-output", 12),
    ]


def test_the_default_build_pays_nothing_for_nan() -> None:
    text = Workshop("def f(x: float32) -> float32:\n    return x * 2.0 - 1.0\n").linked.sources["drv.f"]
    assert "float_result" not in text
    assert "_c_touch" not in text


def test_sqrt_of_a_negative_number_is_reported_in_any_build() -> None:
    header = "from emulator.c28x.language import *\nfrom emulator.c28x.rts import sqrt\n"
    shop = Workshop("def f(x: float32) -> float32:\n    return sqrt(x)\n", header=header)
    assert shop.f(-1.0) != shop.f(-1.0)
    assert shop.rules() == ["nan"]


def test_a_function_of_the_kernel_that_reads_a_buffer_reports_what_was_never_written() -> None:
    header = "from emulator.c28x.language import *\n@extern\ndef show(text: ptr[char]) -> int16: ...\n"
    source = "text: array[char, 3]\ndef f() -> int16:\n    text[0] = 'a'\n    return show(text)\n"

    def show(text: Pointer) -> int:
        return sum(text.at(i).read() for i in range(2))

    shop = Workshop(source, header=header, externs={"show": show})
    assert shop.f() == ord("a")
    finding = only(shop, "uninitialised")
    assert "drv.text[1]" in finding.message
    assert finding.place is not None
    assert finding.place.line == 7


def test_an_element_of_a_member_is_named_with_its_member() -> None:
    source = """
class F(struct):
    n: uint16
    data: array[uint16, 2]
    crc: uint16
Sent: F = (1, (2, 3), 4)
def f(i: int16) -> uint16:
    return Sent.data[i]
"""
    shop = Workshop(source)
    assert shop.f(2) == 4
    assert only(shop, "index").message.startswith("drv.Sent.data[2] is read: ")


def test_an_expression_keeps_the_parentheses_that_its_operators_need() -> None:
    shop = Workshop("def f(a: float32, b: float32, c: float32) -> float32:\n    return (a - b) / (c * b) - (a - b)\n")
    shop.f(1.0, 2.0, 0.0)
    assert only(shop, "division-by-zero").message.startswith("(a - b) / (c * b): ")


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("def f() -> int16:\n    break\n    return 1\n", "'break' outside loop"),
        ("def f(*a: int16) -> int16:\n    return 1\n", "only plain parameters"),
        ("def f(a: int16 = 3) -> int16:\n    return a\n", "only plain parameters"),
    ],
)
def test_what_is_python_and_not_the_language_is_refused_in_one_line(body: str, message: str) -> None:
    with pytest.raises(SourceError, match=message):
        Workshop(body)
