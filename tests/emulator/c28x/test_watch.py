"""An image linked with `watch` tells of every access of an object that others can reach, in C's order."""

from __future__ import annotations

import pytest

from emulator.c28x.watcher import CallingWatcher
from tests.emulator.c28x.workshop import Workshop

SOURCE = """
class POINT(struct):
    X: int16
    Y: int32

n: int16 = 0
a: array[int16, 4] = (1, 2, 3, 4)
m: array[array[float32, 3], 2] = ((1, 2, 3), (4, 5, 6))
p: POINT = (1, 2)
q: POINT = (0, 0)
line: array[POINT, 2] = ((1, 2), (3, 4))

def direct(x: int16) -> void:
    n = n + x

def element(i: int16) -> void:
    a[i] = a[i + 1] * 2

def proven() -> int16:
    return a[2]

def deep(i: int16, j: int16) -> void:
    m[i][j] = m[0][j] + 1

def members() -> void:
    p.Y = p.X

def array_of_structures(i: int16) -> int32:
    return line[i].Y

def through(t: ptr[int16]) -> int16:
    t[1] = 5
    return t[0]

def outside() -> int16:
    return through(a)

def copied() -> void:
    q = p

def block() -> void:
    memcpy(a + 2, a, 2)

def own() -> int16:
    x: int16 = 3
    return x

def lent() -> int16:
    x: array[int16, 2] = (3, 4)
    return through(x)

def counted() -> void:
    for n in range(2):
        pass

def tested() -> void:
    while n > 0 and a[0]:
        n -= 1
"""

Touch = tuple[str, int, str]


class Watched(Workshop):
    """A workshop that keeps what was touched."""

    def __init__(self, source: str = SOURCE, *, watch: bool = True) -> None:
        super().__init__(source, watch=watch)
        self.touched: list[Touch] = []
        self.linked.watch_with(
            CallingWatcher(lambda obj, offset, write: self.touched.append((obj.declaration.name, offset, "rw"[write])))
        )


CASES: dict[str, tuple[tuple[int, ...], list[Touch]]] = {
    # a long stands at word 2 of the structure (32-bit members on even words); a float takes 2 words
    "direct": ((1,), [("n", 0, "r"), ("n", 0, "w")]),
    "element": ((1,), [("a", 2, "r"), ("a", 1, "w")]),
    "proven": ((), [("a", 2, "r")]),
    "deep": ((1, 2), [("m", 4, "r"), ("m", 10, "w")]),
    "members": ((), [("p", 0, "r"), ("p", 2, "w")]),
    "array_of_structures": ((1,), [("line", 6, "r")]),
    "outside": ((), [("a", 1, "w"), ("a", 0, "r")]),
    "copied": ((), [("p", 0, "r"), ("p", 2, "r"), ("q", 0, "w"), ("q", 2, "w")]),
    "block": ((), [("a", 0, "r"), ("a", 1, "r"), ("a", 2, "w"), ("a", 3, "w")]),
    "own": ((), []),
    "lent": ((), [("x", 1, "w"), ("x", 0, "r")]),
    # n = 0; n < 2; n++; n < 2; n++; n < 2
    "counted": ((), [("n", 0, "w"), *[("n", 0, "r"), ("n", 0, "r"), ("n", 0, "w")] * 2, ("n", 0, "r")]),
}


@pytest.mark.parametrize("name", CASES)
def test_every_access_is_told(name: str) -> None:
    arguments, expected = CASES[name]
    shop = Watched()
    getattr(shop, name)(*arguments)
    assert shop.touched == expected


def test_what_is_not_reached_is_not_touched() -> None:
    shop = Watched()
    shop.tested()  # n is 0: the second operand of && is not evaluated
    assert shop.touched == [("n", 0, "r")]


@pytest.mark.parametrize("name", CASES)
def test_watching_changes_nothing_that_is_computed(name: str) -> None:
    plain, watched = Workshop(SOURCE), Watched()
    arguments = CASES[name][0]
    assert getattr(plain, name)(*arguments) == getattr(watched, name)(*arguments)
    assert [o.data for o in plain.linked.objects.values()] == [o.data for o in watched.linked.objects.values()]
    assert plain.clock.now == watched.clock.now


def test_without_watch_no_access_is_told() -> None:
    shop = Watched(watch=False)
    for name, (arguments, _) in CASES.items():
        if name != "block":
            getattr(shop, name)(*arguments)
    assert shop.touched == []
    assert all("_c_touch" not in text for text in shop.linked.sources.values())
