"""Corners of C where a translation to Python goes wrong easily: each with what C gives, plain and watched."""

from __future__ import annotations

from typing import Any

import pytest
from greenlet import getcurrent, greenlet

from emulator.c28x.runtime import IllegalCall
from emulator.c28x.symbols import SourceError
from tests.emulator.c28x.linking import link
from tests.emulator.c28x.workshop import HEADER, Workshop

CASES: list[tuple[str, str, tuple[Any, ...], Any]] = [
    # The start of a for is evaluated once, before the variable is set: i = 2, turns 2, 3, 4.
    (
        "start",
        "def f() -> int16:\n    n: int16 = 0\n    i: int16 = 1\n    for i in range(i + 1, 5):\n        n += 1\n    return n * 10 + i\n",
        (),
        35,
    ),
    (
        "start call",
        "g: int16 = 0\ndef s() -> int16:\n    g += 1\n    return 2\ndef f() -> int16:\n    i: int16\n    for i in range(s(), 5):\n        pass\n    return g\n",
        (),
        1,
    ),
    (
        "start changed",
        "def f() -> int16:\n    i: int16\n    k: int16 = 0\n    for i in range(k, 5):\n        k = 10\n    return i\n",
        (),
        5,
    ),
    # The bound grows through a pointer up to 5.
    (
        "bound by pointer",
        "def inc(p: ptr[int16]) -> None:\n    if p[0] < 5:\n        p[0] += 1\ndef f() -> int16:\n    n: int16 = 2\n    i: int16\n    c: int16 = 0\n    for i in range(n):\n        inc(addressof(n))\n        c += 1\n    return c * 10 + i\n",
        (),
        55,
    ),
    # 0 < (unsigned) -1: the loop runs until the break.
    (
        "unsigned test",
        "def f(n: int16) -> int16:\n    i: uint16\n    t: int16 = 0\n    for i in range(n - 1):\n        t += 1\n        if t == 100:\n            break\n    return t\n",
        (0,),
        100,
    ),
    # 3 > (unsigned) -1 is false at once.
    (
        "unsigned down",
        "def f() -> int16:\n    i: uint16\n    t: int16 = 0\n    for i in range(3, -1, -1):\n        t += 1\n        if t == 100:\n            break\n    return t\n",
        (),
        0,
    ),
    (
        "len is a name",
        "def f(len: uchar) -> int16:\n    i: int16\n    for i in range(0, len & 15, 2):\n        pass\n    return i\n",
        (5,),
        6,
    ),
    (
        "two addressed parameters",
        "def f(a: int16, b: int16) -> int16:\n    return addressof(a) == addressof(b)\n",
        (1, 1),
        0,
    ),
    (
        "pointer to a row",
        "m: array[array[int16, 3], 2] = ((1, 2, 3), (4, 5, 6))\ndef f() -> int16:\n    p: ptr[array[int16, 3]]\n    p = addressof(m[0])\n    p += 1\n    return p[0][0]\n",
        (),
        4,
    ),
    (
        "null plus two floats",
        "def f() -> int16:\n    p: ptr[float32] = NULL\n    p += 2\n    return cast(int16, p)\n",
        (),
        4,
    ),
    (
        "negative label",
        "def f(u: uint16) -> int16:\n    match u:\n        case -1:\n            return 1\n        case _:\n            return 0\n",
        (65535,),
        1,
    ),
    (
        "global index changed",
        "v: array[int16, 2] = (7, 8)\ng: int16 = 0\ndef f() -> int16:\n    v[g] = 1\n    g += 1\n    return v[g] + 1\n",
        (),
        9,
    ),
    (
        "address initialisers",
        "a: array[int16, 3] = (1, 2, 3)\nx: int16 = 7\np: ptr[int16] = a\nq: ptr[int16] = addressof(x)\ndef f() -> int16:\n    return p[1] * 10 + q[0]\n",
        (),
        27,
    ),
    (
        "function initialiser",
        "def g(x: int16) -> int16:\n    return x + 1\nfp: funcptr[int16, int16] = g\ndef f() -> int16:\n    return fp(4)\n",
        (),
        5,
    ),
    (
        "constant initialisers",
        "N = 7\nx: int16 = N / 2\ny: uint16 = ~0\nz: int16 = 2.5\ndef f() -> int32:\n    return int32(x) * 100000 + y + z\n",
        (),
        365537,
    ),
]


@pytest.mark.parametrize("watched", [False, True], ids=["plain", "watched"])
@pytest.mark.parametrize(("source", "arguments", "expected"), [c[1:] for c in CASES], ids=[c[0] for c in CASES])
def test_c_gives(source: str, arguments: tuple[Any, ...], expected: Any, watched: bool) -> None:
    assert Workshop(source, watch=watched).f(*arguments) == expected


@pytest.mark.parametrize("watched", [False, True], ids=["plain", "watched"])
def test_a_call_in_the_target_of_a_compound_assignment_runs_once(watched: bool) -> None:
    source = "n: int16 = 0\nv: array[int16, 2] = (1, 2)\ndef s() -> int16:\n    global n\n    n += 1\n    return n\n"
    w = Workshop(source + "def f() -> int16:\n    v[s()] += 5\n    return v[1] * 10 + n\n", watch=watched)
    assert w.f() == 71  # v[1] = 2 + 5, one call


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("class P(struct):\n    x: int16\np: P\ndef f() -> None:\n    for p.x in range(3):\n        pass\n", "plain object"),
        ("def g(x: int16) -> int16:\n    return x\ndef f() -> int16:\n    p: funcptr[int16, int16]\n    p = g\n    return p()\n", "takes 1 arguments, 0 given"),
    ],
)  # fmt: skip
def test_what_would_be_translated_wrongly_is_refused(source: str, message: str) -> None:
    with pytest.raises(SourceError, match=message):
        Workshop(source)


def test_one_name_for_two_functions_is_refused_as_by_a_linker() -> None:
    other = Workshop("")
    program = type(other.linked.program)()
    program.add("a", "a.py", HEADER + "def init() -> int16:\n    return 1\ndef fa() -> int16:\n    return init()\n")
    program.add("b", "b.py", HEADER + "def init() -> int16:\n    return 2\ndef fb() -> int16:\n    return init()\n")
    with pytest.raises(ValueError, match="init is defined in a and in b"):
        link(program, other.runtime, other.linked.options, registers=lambda b, n: None, externs={})


def test_a_continue_costs_time_so_that_an_event_can_end_the_loop() -> None:
    w = Workshop("g: int16 = 0\ndef f() -> None:\n    while g == 0:\n        continue\n")
    data = w.linked.objects["drv.g"].data
    w.clock.schedule(5000, lambda: data.__setitem__(0, 1))
    w.f()
    assert w.clock.now >= 5000


def test_a_copy_of_something_never_written_is_still_never_written() -> None:
    source = """
class P(struct):
    x: float32
def f() -> float32:
    p: P
    q: P
    p.x = 1.0
    p = q
    return p.x + 1.0
"""
    w = Workshop(source)
    assert w.f() == 1.0
    # Where it is copied, and where the copy is read.
    assert w.rules() == ["uninitialised", "uninitialised"]


def test_a_function_that_falls_off_its_end_owes_a_value() -> None:
    w = Workshop("def g(x: int16) -> int16:\n    if x:\n        return 1\ndef f() -> int16:\n    return g(0) + 1\n")
    assert w.f() == 1
    assert w.rules() == ["uninitialised"]


def test_memset_past_an_object_is_reported() -> None:
    w = Workshop("a: array[int16, 2] = (1, 2)\nb: int16 = 3\ndef f() -> int16:\n    memset(a, 0, 3)\n    return b\n")
    assert w.f() == 0
    assert w.rules() == ["memcpy-outside"]


def test_a_task_that_returns_first_takes_only_its_own_locals_along() -> None:
    source = """
@extern
def pause() -> None: ...
def use(p: ptr[int16]) -> None:
    pause()
def f() -> None:
    x: int16 = 1
    use(addressof(x))
"""
    host = getcurrent()
    w = Workshop(source, externs={"pause": lambda: host.switch()})
    first, second = greenlet(lambda: w.f()), greenlet(lambda: w.f())
    first.switch()
    second.switch()
    of_second = w.memory.live_locals[1]
    first.switch()
    assert w.memory.live_locals == [of_second]
    second.switch()
    assert w.memory.live_locals == []


def test_what_an_exception_ends_is_of_one_stack_only() -> None:
    source = """
Data: ptr[int16] = NULL
@extern
def pause() -> None: ...
@extern
def stop() -> None: ...
def task() -> None:
    x: int16 = 1
    Data = addressof(x)
    pause()
def call() -> None:
    y: int16 = 2
    Data = addressof(y)
    stop()
def use() -> int16:
    return Data[0]
"""
    host = getcurrent()

    def stop() -> None:
        raise InterruptedError

    w = Workshop(source, externs={"pause": lambda: host.switch(), "stop": stop})
    sp, w.cpu.sp = w.cpu.sp, 0x0600  # the task's own stack
    task = greenlet(lambda: w.task())
    task.switch()
    w.cpu.sp = sp
    with pytest.raises(InterruptedError):
        w.call()
    w.runtime.unwind(sp)
    assert [obj.declaration.name for obj in w.memory.live_locals] == ["x"]
    assert w.cpu.sp == sp
    assert (w.use(), w.rules()) == (2, ["dangling-pointer"])
    task.switch()
    assert w.memory.live_locals == []


def test_a_structure_copied_from_outside_an_array_is_reported() -> None:
    source = "class P(struct):\n    x: float32\na: array[P, 2]\np: P = (1,)\ndef f(i: int16) -> None:\n    p = a[i]\n"
    w = Workshop(source)
    w.f(2)
    assert w.rules() == ["pointer-outside"]


def test_a_call_through_a_null_function_pointer_is_a_finding_and_an_end() -> None:
    w = Workshop("p: funcptr[int16] = NULL\ndef f() -> int16:\n    return p()\n")
    with pytest.raises(IllegalCall, match="p is called, but it points to no function"):
        w.f()
    assert w.rules() == ["null-dereference"]
