"""Objects of C as a test sees them: read, written, given to functions and taken from them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.ctypes import CHAR, ArrayType
from emulator.c28x.memory import Pointer
from emulator.c28x.objects import Array, Structure, make
from emulator.image import Firmware
from firmware_model.image import link
from hil.robot.board import RobotBoard

TEXT = """
typedef unsigned int uint16_t;
typedef struct { uint16_t data[4]; uint16_t head, tail; } ring_t;
struct point { int x; long y; };
typedef struct { struct point at[2]; float gain; } body;
typedef union { unsigned long all; struct { uint16_t low : 4, high : 12; int sign : 3; } bit; } word;
enum mode { OFF, ON = 4 };

ring_t rx;
enum mode mode = ON;
struct point here = {1, 70000};
int table[3] = {1, 2, 3};
char frame[4];
int grid[2][3] = {{1, 2, 3}, {4, 5, 6}};
float gain;

uint16_t put(ring_t *r, uint16_t c) { r->data[r->head] = c; r->head = (r->head + 1) & 3; return r->head; }
struct point moved(struct point p, int by) { p.x += by; return p; }
ring_t *ring(int which) { return which ? &rx : 0; }
int total(const int *v, int n) { int s = 0, i; for (i = 0; i < n; i++) s += v[i]; return s; }
unsigned length(const char *s) { unsigned n = 0; while (s[n]) n++; return n; }
void spell(char *to) { to[0] = 'o'; to[1] = 'k'; to[2] = 0; }
char *name(void) { return "name"; }
char *its_frame(void) { return frame; }
int number(_Bool b) { return b; }
int apply(int (*f)(int), int x) { return f ? f(x) : -1; }
int twice(int x) { return 2 * x; }
uint16_t low(word w) { return w.bit.low; }
"""


@pytest.fixture
def fw(tmp_path: Path) -> Firmware:
    pytest.importorskip("pycparser", reason="needs the extra c: pip install 'c2000-hil[c]'")
    (tmp_path / "drv.c").write_text(TEXT, encoding="utf-8")
    return link(RobotBoard(), modules=[str(tmp_path / "drv.c")])


def test_a_new_structure_has_its_members_as_attributes_and_goes_to_a_pointer_parameter(fw: Firmware) -> None:
    ring = fw.new("ring_t", head=3, tail=0)
    assert fw.drv.put(ring, 7) == 0
    assert (ring.head, ring.data[3]) == (0, 7)
    with pytest.raises(AttributeError, match="ring_t has no member tale: it has data, head, tail"):
        ring.tale = 1
    assert not hasattr(ring, "tale")


def test_an_object_of_the_firmware_is_the_same_from_both_sides(fw: Firmware) -> None:
    fw.drv.rx.head = 2
    assert fw.drv.put(fw.drv.rx, 9) == 3
    assert fw.drv.rx.data[2] == 9
    assert fw.drv.ring(1) == fw.drv.rx
    assert isinstance(fw.drv.ring(1), Structure)
    assert fw.drv.ring(0) is None


def test_a_structure_by_value_is_a_copy(fw: Firmware) -> None:
    moved = fw.drv.moved(fw.drv.here, 5)
    assert (moved.x, moved.y) == (6, 70000)
    assert fw.drv.here.x == 1
    given = fw.drv.moved({"x": -3, "y": 1}, 1)
    assert (given.x, given.y) == (-2, 1)
    fw.drv.here = moved
    moved.x = 0
    assert fw.drv.here.x == 6


def test_nested_structures_and_arrays_are_assigned_whole(fw: Firmware) -> None:
    body = fw.new("body", at=[{"x": 1, "y": 2}, {"x": 3, "y": 4}], gain=0.5)
    assert [(point.x, point.y) for point in body.at] == [(1, 2), (3, 4)]
    body.at[0] = body.at[1]
    assert body.at[0].y == 4
    assert body.at[0] != body.at[1]
    points = fw.array("struct point", [{"x": 1, "y": 2}, {"x": 3, "y": 4}])
    assert points[1].x == 3


def test_members_of_a_union_share_words_and_bit_fields_share_a_word(fw: Firmware) -> None:
    # low is bits 0..3, high bits 4..15 of the first word; sign does not fit there: bits 0..2 of the second.
    word = fw.new("word", all=0x0006_ABC5)
    assert (word.bit.low, word.bit.high, word.bit.sign) == (0x5, 0xABC, -2)  # 0b110 in three bits is 6 - 8
    word.bit.high = 0x123
    word.bit.sign = 3
    assert word.all == 0x0003_1235
    assert fw.drv.low(word) == 5
    with pytest.raises(ValueError, match=r"4 is no int:3 \(-4\.\.3\)"):
        word.bit.sign = 4


def test_an_array_has_elements_slices_and_a_length(fw: Firmware) -> None:
    table = fw.drv.table
    assert (len(table), list(table), table[1:]) == (3, [1, 2, 3], [2, 3])
    table[:2] = [10, 20]
    assert fw.drv.total(table, 3) == 33
    assert fw.drv.total(table.at(1), 2) == 23
    fw.drv.table = [1, 1, 1]
    assert fw.drv.total(table, 3) == 3
    with pytest.raises(IndexError, match=r"index 3 of int\[3\]: 0\.\.2"):
        table[3]
    with pytest.raises(ValueError, match=r"2 values for 3 elements of int\[3\]"):
        fw.drv.table = [1, 2]


@pytest.mark.parametrize("ctype", ["int", "signed", "short int", "int16"])
def test_types_have_the_names_that_c_gives_them(fw: Firmware, ctype: str) -> None:
    assert fw.drv.total(fw.array(ctype, [4, 5]), 2) == 9
    assert fw.new("enum mode", 4).load() == fw.drv.mode == 4
    assert fw.new("uint16_t", 65535).load() == 65535
    assert fw.new("unsigned long", 1 << 31).load() == 1 << 31
    with pytest.raises(ValueError, match="no C type uint17_t"):
        fw.new("uint17_t")


def test_strings_go_in_and_come_out(fw: Firmware) -> None:
    assert fw.drv.length("four") == 4
    assert fw.drv.length("") == 0
    room = fw.array("char", [None] * 4)
    fw.drv.spell(room)
    assert fw.text(room) == "ok"
    assert fw.text(fw.drv.name()) == "name"
    assert list(fw.array("char", "ab")) == [97, 98, 0]


def test_bytes_are_text_where_c_wants_characters(fw: Firmware) -> None:
    assert fw.drv.length(b"four") == fw.drv.length(bytearray(b"four")) == 4
    fw.drv.frame = b"ok"
    # As `char frame[4] = "ok";`: the rest is 0.
    assert list(fw.drv.frame) == [111, 107, 0, 0]
    fw.drv.frame = "four"
    assert list(fw.drv.frame) == [*b"four"]
    assert list(fw.array("char", b"ab")) == [97, 98]
    with pytest.raises(ValueError, match=r"drv\.frame: b'fours' has 5 characters, which do not fit char\[4\]"):
        fw.drv.frame = b"fours"


@given(st.binary(max_size=8), st.binary(max_size=8))
def test_an_array_of_characters_equals_the_text_before_its_nul(held: bytes, asked: bytes) -> None:
    memory = RobotBoard().memory
    array = Array(make(memory, ArrayType("char[8]", CHAR, 8), "text", [*held, *[0] * (8 - len(held))]))
    codes = [*held, *[0] * (8 - len(held))]
    # By the definition of C: the same codes, and then a NUL or the end of the array.
    wanted = codes[: len(asked)] == [*asked] and (len(asked) == 8 or codes[len(asked)] == 0)
    assert (array == asked) == wanted
    assert (array == asked.decode("latin-1")) == wanted


def test_an_array_equals_a_list_of_its_values(fw: Firmware) -> None:
    assert fw.drv.table == [1, 2, 3]
    assert fw.drv.table == (1, 2, 3)
    assert fw.drv.table != [1, 2]
    assert fw.drv.table != [1, 2, 4]


def test_functions_of_the_firmware_and_of_python_are_pointers_to_functions(fw: Firmware) -> None:
    assert fw.drv.apply(fw.drv.twice, 4) == 8
    assert fw.drv.apply(lambda x: x + 1, 4) == 5
    assert fw.drv.apply(None, 4) == -1
    with pytest.raises(TypeError, match="4 is no function"):
        fw.drv.apply(4, 4)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda fw: fw.drv.total([1, 2], 2), r"\[1, 2\] is no int \*: make the object with array\(\.\.\.\) or new"),
        (lambda fw: fw.drv.put(fw.drv.table, 1), "a pointer to int is given where one to ring_t is wanted"),
        (lambda fw: fw.drv.moved(fw.drv.rx, 1), r"is no struct point: give one, or a mapping of its members"),
        (lambda fw: setattr(fw.drv, "table", 5), r"drv\.table: 5 is no int\[3\]: give its 3 values"),
        (lambda fw: fw.drv.twice(1, 2), r"twice\(int x\) takes 1 arguments, 2 given"),
    ],
)  # fmt: skip
def test_a_value_of_another_kind_is_refused_at_the_call(fw: Firmware, wrong: Any, message: str) -> None:
    with pytest.raises(TypeError, match=message):
        wrong(fw)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda fw: fw.drv.twice(40000), r"twice\(x\): 40000 is no int \(-32768\.\.32767\)"),
        (lambda fw: fw.drv.twice(1.0), r"twice\(x\): 1\.0 is no int \(-32768\.\.32767\)"),
        (lambda fw: setattr(fw.drv.rx, "head", -1), r"ring_t\.head: -1 is no unsigned int \(0\.\.65535\)"),
        (lambda fw: setattr(fw.drv, "gain", "x"), r"drv\.gain: 'x' is no float"),
        (lambda fw: setattr(fw.drv, "gain", 1e39), r"drv\.gain: 1e\+39 is no float \(up to 3\.4e38\)"),
        (lambda fw: fw.array("int", [1, None, 1 << 15]), r"array\('int'\)\[2\]: 32768 is no int"),
        (lambda fw: fw.new("struct point", x=1 << 15), r"struct point\.x: 32768 is no int"),
        (lambda fw: fw.new("int", "xy"), r"new\('int'\): 'xy' is no int"),
        (lambda fw: setattr(fw.drv, "table", [1]), r"drv\.table: 1 values for 3 elements of int\[3\]"),
    ],
)  # fmt: skip
def test_a_value_that_does_not_fit_is_refused_with_its_place(fw: Firmware, wrong: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        wrong(fw)


def test_numbers_of_numpy_are_numbers(fw: Firmware) -> None:
    assert fw.drv.twice(np.int16(4)) == 8
    fw.drv.gain = np.float32(0.5)
    assert fw.drv.gain == 0.5
    assert fw.drv.total(fw.array("int", np.arange(4)), 4) == 6
    fw.drv.table = np.arange(3)
    assert fw.drv.table == [0, 1, 2]


def test_a_repr_shows_the_values(fw: Firmware) -> None:
    assert repr(fw.drv.here) == "struct point(x=1, y=70000)"
    assert repr(fw.drv.table) == "int[3]{1, 2, 3}"
    assert repr(fw.drv.grid) == "int[2][3]{{1, 2, 3}, {4, 5, 6}}"
    assert repr(fw.array("int", range(20))) == "int[20]{0, 1, 2, 3, 4, 5, 6, 7, ...}"


def test_a_pointer_that_comes_back_has_the_type_that_the_function_declares(fw: Firmware) -> None:
    fw.drv.frame = b"ok"
    assert fw.text(fw.drv.its_frame()) == "ok"
    assert fw.drv.length(fw.drv.its_frame()) == 2


def test_whatever_is_not_0_is_true(fw: Firmware) -> None:
    assert fw.drv.number(2) == fw.drv.number(True) == 1  # C: the conversion to _Bool gives 0 or 1
    assert fw.drv.number(0) == 0


def test_an_address_is_a_pointer_too(fw: Firmware) -> None:
    table = fw.drv.table
    assert fw.drv.total(table.at(0).addr, 3) == 6
    assert isinstance(table, Array)
    assert isinstance(fw.new("int", 5), Pointer)
