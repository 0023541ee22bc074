"""The shadow call stack: what the firmware says about where it is, read back in every way."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from emulator.c28x.position import INTERRUPT, Position, frames, interrupted
from tests.emulator.c28x.workshop import HEADER, Workshop


def called(position: Position) -> object:
    """What a function does at its entry; returns the identity of the call."""
    position.calls = (position.at, position.calls)
    return position.calls


def test_a_position_lists_its_statements_from_the_innermost_outwards() -> None:
    position = Position()
    outer = called(position)  # from no firmware: 0
    position.at = 5
    inner = called(position)
    position.at = 7
    # 7 executes in the inner call, 5 is the call of it in the outer one; 0 is no statement.
    assert list(position.frames()) == [(7, inner), (5, outer)]
    assert position.innermost() == 7


def test_two_calls_from_one_statement_are_two_calls() -> None:
    position = Position()
    position.at = 5
    calls = position.calls
    first = called(position)
    position.at, position.calls = 5, calls
    second = called(position)
    assert first == second  # the same steps
    assert first is not second
    assert isinstance(first, tuple)
    assert isinstance(second, tuple)
    assert not position.within(first)
    assert position.within(second)


def test_an_interrupt_stands_on_what_it_interrupts_and_goes_back_to_it() -> None:
    position = Position()
    task = called(position)
    position.at = 5
    below = position.calls = (position.at, position.calls, INTERRUPT)
    position.at = 0
    assert position.at == 0
    # Before its first statement the innermost one is that which waits for the interrupt.
    assert position.innermost() == 5
    called(position)
    position.at = 9
    nested = position.calls = (position.at, position.calls, INTERRUPT)
    position.at = 0
    # The thread itself stands below the outermost of its interrupts.
    assert interrupted(position.at, position.calls) == (5, task)
    position.at, position.calls, _ = nested
    assert position.at == 9
    position.at, position.calls, _ = below
    assert (position.at, position.calls) == (5, task)
    assert interrupted(position.at, position.calls) == (5, task)


def test_a_position_that_was_kept_says_the_same_later() -> None:
    position = Position()
    called(position)
    position.at = 5
    called(position)
    position.at = 7
    kept = position.at, position.calls
    there = list(position.frames())
    position.at, position.calls = 0, None
    assert list(position.frames()) == []
    assert list(frames(*kept)) == there


STEPPED = """
def doubled(n: int16) -> int16:
    return n * 2

def f(n: int16) -> int16:
    sum: int16 = 0
    i: int16
    for i in range(n):
        sum += doubled(i)
    return sum
"""


def test_an_image_for_stepping_tells_each_statement_before_it_runs_with_locals_and_callers() -> None:
    shop = Workshop(STEPPED, steps=True)
    told: list[tuple[list[tuple[str, int]], dict[str, Any]]] = []

    def hold(values: Mapping[str, Any]) -> None:
        position = shop.findings.position
        path = shop.findings.path(position.at, position.calls)
        ours = {name: value for name, value in values.items() if not name.startswith("_")}
        told.append(([(place.function, place.line - HEADER.count("\n")) for place in path], ours))

    shop.findings.position.hold = hold
    assert shop.f(2) == 2
    # Lines of STEPPED, whose first is empty.  The loop is told at each look at its test: three times for two turns.
    # A statement is told with the values from before it: `sum` and `i` were never written at line 6, `i` not before the
    # loop.
    assert told == [
        ([("f", 6)], {"n": 2, "sum": None, "i": None}),
        ([("f", 8)], {"n": 2, "sum": 0, "i": None}),
        ([("f", 9)], {"n": 2, "sum": 0, "i": 0}),
        ([("doubled", 3), ("f", 9)], {"n": 0}),
        ([("f", 8)], {"n": 2, "sum": 0, "i": 0}),
        ([("f", 9)], {"n": 2, "sum": 0, "i": 1}),
        ([("doubled", 3), ("f", 9)], {"n": 1}),
        ([("f", 8)], {"n": 2, "sum": 2, "i": 1}),
        ([("f", 10)], {"n": 2, "sum": 2, "i": 2}),
    ]


def test_stepping_changes_neither_results_nor_time() -> None:
    plain, stepped = Workshop(STEPPED), Workshop(STEPPED, steps=True)
    assert plain.f(5) == stepped.f(5)
    assert plain.clock.now == stepped.clock.now
