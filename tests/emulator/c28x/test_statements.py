"""Statements, objects and pointers: C's meaning, the same plain and watched."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.c28x import build
from emulator.c28x.ctypes import UINT
from emulator.c28x.symbols import Define
from emulator.c28x.tree import NOWHERE
from tests.emulator.c28x.workshop import Workshop

both = pytest.mark.parametrize("watched", [False, True], ids=["plain", "watched"])


@both
def test_the_loop_variable_holds_the_bound_after_a_for(watched: bool) -> None:
    w = Workshop(
        "def f(n: uchar) -> int16:\n    i: uchar\n    for i in range(n):\n        pass\n    return i\n", watch=watched
    )
    assert [w.f(n) for n in (0, 1, 12)] == [0, 1, 12]


@both
def test_break_keeps_the_loop_variable_and_continue_steps_it(watched: bool) -> None:
    source = """
def f(stop: int16) -> int16:
    i: int16
    total: int16 = 0
    for i in range(10):
        if i % 2:
            continue
        if i == stop:
            break
        total += i
    return total * 100 + i
"""
    w = Workshop(source, watch=watched)
    # 0+2 before 4: total 2, i 4; never reached: 0+2+4+6+8 = 20, i = 10.
    assert (w.f(4), w.f(5)) == (204, 2010)


@both
def test_a_for_whose_bound_changes_in_the_body_tests_it_anew_each_time(watched: bool) -> None:
    source = """
def f() -> int16:
    i: int16
    n: int16 = 3
    turns: int16 = 0
    for i in range(n):
        if i == 1 and n < 5:
            n += 1
        if turns == 1:
            turns += 10
            continue
        turns += 1
    return turns * 10 + i
"""
    w = Workshop(source, watch=watched)
    # n becomes 4 once: i = 0, 1, 2, 3; turns 1, 11, 12, 13.
    assert w.f() == 134


@both
def test_a_for_over_a_shared_variable_wraps_at_its_width(watched: bool) -> None:
    source = """
i: uint16
def f() -> uint16:
    n: int16 = 0
    for i in range(65534, 65535):
        n += 1
    return i
"""
    assert Workshop(source, watch=watched).f() == 65535


@both
def test_match_takes_the_first_case_that_fits_or_the_default(watched: bool) -> None:
    source = """
class E(enum):
    A = 0
    B = 7
def f(e: E) -> int16:
    match e:
        case E.A:
            return 1
        case E.B | 8:
            return 2
        case _:
            return 3
"""
    w = Workshop(source, watch=watched)
    assert [w.f(v) for v in (0, 7, 8, 9)] == [1, 2, 2, 3]


@both
def test_pointers_walk_arrays_and_structures_share_storage(watched: bool) -> None:
    source = """
class P(struct):
    k: int16
    x: float32
    t: array[int16, 3]
g: P
a: array[P, 2]
def fill(p: ptr[P], n: int16) -> None:
    p.k = n
    p.x = n / 2
    p.t[1] = -n
def f() -> int16:
    q: ptr[P]
    q = addressof(a[0])
    q += 1
    fill(q, 7)
    fill(addressof(g), 40)
    g.t[2] = q.t[1]
    return g.k + a[1].k + g.t[2] + (q - addressof(a[0]))
"""
    w = Workshop(source, watch=watched)
    # 40 + 7 - 7 + 1
    assert w.f() == 41
    assert w.linked.objects["drv.a"].words == 16  # k, pad, x (2), t (3), pad: 8 words each


@both
def test_memcpy_counts_words_not_octets(watched: bool) -> None:
    source = """
a: array[float32, 4] = (1, 2, 3, 4)
b: array[float32, 4] = (9, 9, 9, 9)
def f(words: uint16) -> None:
    memcpy(b, a, words)
"""
    w = Workshop(source, watch=watched)
    w.f(4)
    # Four words are two floats.
    assert w.linked.objects["drv.b"].data == [1.0, 2.0, 9.0, 9.0]


@both
def test_half_a_float_can_be_copied(watched: bool) -> None:
    source = "a: float32 = 1.5\nb: float32 = 2.0\ndef f() -> None:\n    memcpy(addressof(b), addressof(a), 1)\n"
    w = Workshop(source, watch=watched)
    w.f()
    # Low word of 1.5 (0x3fc00000) is 0x0000, high word of 2.0 (0x40000000) is 0x4000: 2.0 again.
    assert w.value("b") == 2.0


@both
def test_writing_through_a_pointer_of_another_width_goes_by_words(watched: bool) -> None:
    source = """
x: float32 = 1.0
def f() -> None:
    p: ptr[uint16]
    p = cast(ptr[uint16], addressof(x))
    p[1] = 0x4000
"""
    w = Workshop(source, watch=watched)
    w.f()
    # 1.0 is 0x3f800000; with 0x4000 as its high word it is 2.0.
    assert w.value("x") == 2.0


@both
def test_sizeof_counts_sixteen_bit_words(watched: bool) -> None:
    source = (
        "class P(struct):\n    k: char\n    x: float32\ndef f() -> uint32:\n    return sizeof(P) * 10 + sizeof(char)\n"
    )
    # char, padding, float: 4 words; sizeof(char) is 1 although it has 16 bits.
    assert Workshop(source, watch=watched).f() == 41


@both
def test_a_string_is_a_constant_array_with_its_nul(watched: bool) -> None:
    source = """
def f() -> uint32:
    return strlen("abcd")
def g(p: ptr[char]) -> int16:
    return p[0] == "#"
def h() -> int16:
    return g("#x")
"""
    w = Workshop(source, watch=watched)
    assert (w.f(), w.h()) == (4, 1)


@both
def test_integer_constants_have_the_types_of_a_16_bit_int(watched: bool) -> None:
    # 0x8000 is unsigned int, 32768 is long: shifted left once they differ.
    source = "def f() -> int32:\n    return 0x8000 * 2\ndef g() -> int32:\n    return 32768 * 2\n"
    w = Workshop(source, watch=watched)
    assert (w.f(), w.g()) == (0, 65536)


@both
def test_a_poll_is_carried_to_the_event_that_ends_it(watched: bool) -> None:
    source = "flag: int16 = 0\ndef f() -> None:\n    while flag == 0:\n        pass\n"
    w = Workshop(source, watch=watched)
    data = w.linked.objects["drv.flag"].data

    def set_flag() -> None:
        data[0] = 1

    w.clock.schedule(100_000, set_flag)
    w.f()
    assert 100_000 <= w.clock.now < 100_100


class Stepped:
    """A clock whose poll executes every iteration."""

    def __init__(self, clock: Any) -> None:
        self.__dict__["clock"] = clock

    def poll(self, cycles: int) -> int:
        self.clock.charge(cycles)
        now: int = self.clock.now
        return now

    def __getattr__(self, name: str) -> Any:
        return getattr(self.clock, name)

    def __setattr__(self, name: str, value: Any) -> None:
        setattr(self.clock, name, value)


@settings(deadline=None, max_examples=30)
@given(st.integers(1, 5000), st.integers(0, 400))
def test_a_carried_poll_ends_at_the_same_cycle_as_a_stepped_one(event: int, other: int) -> None:
    source = "flag: int16 = 0\ndef f() -> None:\n    while flag == 0:\n        pass\n"
    times = []
    for stepped in (False, True):
        w = Workshop(source)
        data = w.linked.objects["drv.flag"].data
        w.clock.schedule(event, lambda data=data: data.__setitem__(0, 1))  # type: ignore[misc]
        w.clock.schedule(other, lambda: None)
        if stepped:
            w.linked.namespace["_c_clock"] = Stepped(w.clock)
        w.f()
        times.append(w.clock.now)
    assert times[0] == times[1]


@both
def test_time_passes_and_a_statement_can_be_interrupted(watched: bool) -> None:
    source = "g: int16 = 0\ndef f() -> int16:\n    g = 1\n    g = 2\n    g = 3\n    return g\n"
    w = Workshop(source, watch=watched)
    seen: list[int] = []
    for cycle in range(1, 60):
        w.clock.schedule(cycle, lambda: seen.append(w.value("g")))
    assert w.f() == 3
    assert {0, 1, 2} <= set(seen)


def test_plain_and_watched_charge_the_same_cycles() -> None:
    source = """
v: array[int16, 4]
def f(n: int16) -> int16:
    i: int16
    x: int16
    for i in range(n):
        v[i] = i * n
    x = v[1]
    return x
"""
    cycles = []
    for watched in (False, True):
        w = Workshop(source, watch=watched)
        w.f(3)
        cycles.append(w.clock.now)
    assert cycles[0] == cycles[1]


@settings(deadline=None, max_examples=40)
@given(st.lists(st.integers(-100, 100), min_size=1, max_size=12))
def test_a_sort_in_the_language_sorts(values: list[int]) -> None:
    source = """
v: array[int16, 12]
def f(n: uchar) -> None:
    i: uchar
    j: uchar
    t: int16
    for i in range(1, n):
        for j in range(n - i):
            if v[j] > v[j + 1]:
                t = v[j + 1]
                v[j + 1] = v[j]
                v[j] = t
"""
    w: Any = Workshop(source)
    w.linked.objects["drv.v"].data[: len(values)] = values
    w.f(len(values))
    assert w.linked.objects["drv.v"].data[: len(values)] == sorted(values)
    assert w.rules() == []


@pytest.mark.parametrize("fill", ["zero", "stack"])
def test_a_local_with_initialiser_may_be_declared_in_a_branch_that_is_not_taken(fill: str) -> None:
    source = """
def f(c: int16) -> int16:
    if c == 1:
        return 7
    else:
        i: int16 = 0
        for i in range(3):
            pass
        return i
"""
    w = Workshop(source, fill=fill)
    assert (w.f(1), w.f(0)) == (7, 3)


def test_an_imported_define_is_typed_as_it_is_written_in_its_own_file() -> None:
    w = Workshop("")
    program = type(w.linked.program)()
    program.add("h", "h.py", "\n" * 60 + "MASK = 0xFFFF\n")
    module = program.add("m", "m.py", "from emulator.c28x.language import *\n")
    module.symbols["MASK"] = program.modules["h"].symbols["MASK"]
    mask = module.symbols["MASK"]
    assert isinstance(mask, Define)
    assert mask.expression(build.file_scope(module), NOWHERE).ctype == UINT
