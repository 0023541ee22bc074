"""Functions called through a pointer of another type: what works works, what reads a wrong register is told."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import CWorkshop

FUNCTIONS = """
static int n = 0;
static void none(void) { n++; }
static int one(int x) { return x + 1; }
static long wide(long x) { return x + 1; }
static int real(float x) { return (int)x; }
static int by_pointer(int *p) { return *p; }
static int by_char(char c) { return c + 1; }
"""

# Nothing of these is lost: each argument has the register that the function reads, the rest is left lying there.
WORKS = {
    "a callback that needs no argument":
        ("int f(void) { void (*g)(int *) = (void (*)(int *))none; g(&n); return n; }", 1),
    "an argument too many": ("int f(void) { int (*g)(int, int) = (int (*)(int, int))one; return g(1, 7); }", 2),
    "a result that nobody wants": ("int f(void) { void (*g)(int) = (void (*)(int))one; g(1); return 3; }", 3),
    "parameters left open": ("int f(void) { int (*g)() = one; return g(4); }", 5),
    "another pointer": ("int f(void) { int (*g)(void *) = (int (*)(void *))by_pointer; n = 8; return g(&n); }", 8),
    "a character for an int": ("int f(void) { int (*g)(int) = (int (*)(int))by_char; return g(4); }", 5),
}  # fmt: skip

# int goes in AL, long in ACC, float in R0H, a pointer in XAR4: the emulator gives 0 for what is not there.
MISSES = {
    "an argument": ("int f(void) { int (*g)(void) = (int (*)(void))one; return g(); }", 1, "it takes 1 argument"),
    "half of a long":
        ("int f(void) { int (*g)(int) = (int (*)(int))wide; return g(4); }", 0, "argument 1 is passed as int"),
    "a float": ("int f(void) { int (*g)(int) = (int (*)(int))real; return g(4); }", 0, "taken as float"),
    "a result": ("int f(void) { int (*g)(void) = (int (*)(void))none; return g(); }", 0, "it gives no result"),
}  # fmt: skip


@pytest.mark.parametrize(("source", "value"), WORKS.values(), ids=WORKS.keys())
def test_what_nobody_misses_is_left_alone(source: str, value: int) -> None:
    shop = CWorkshop(FUNCTIONS + source)
    assert [shop.call("f"), shop.rules()] == [value, []]


@pytest.mark.parametrize(("source", "value", "why"), MISSES.values(), ids=MISSES.keys())
def test_what_the_function_or_its_caller_misses_is_told_at_the_call(source: str, value: int, why: str) -> None:
    shop = CWorkshop(FUNCTIONS + source)
    assert shop.call("f") == value
    (finding,) = shop.findings
    assert (finding.rule, finding.object) == ("called-as-another", "g")
    assert why in finding.message
    assert finding.place is not None
    assert finding.place.line == FUNCTIONS.count("\n") + 1


def test_every_call_is_counted() -> None:
    shop = CWorkshop(FUNCTIONS + MISSES["an argument"][0])
    shop.call("f")
    shop.call("f")
    assert [finding.count for finding in shop.findings] == [2]
