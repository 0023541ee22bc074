"""Log_write with UIABenchmark events."""

from __future__ import annotations

import pytest

from emulator.c28x.ctypes import CHAR, LONG, ArrayType
from emulator.c28x.tree import Declaration
from emulator.system import System
from tests.emulator.sysbios.bench import INT, POINTER, Bench, string


def test_benchmark_events_carry_their_label() -> None:
    b = Bench()
    b.listen()
    b.kernel.Log_write1(1, (POINTER, string("TaskNAV")))
    b.clock.charge(10)
    b.kernel.Log_write1(2, (POINTER, string("TaskNAV")))
    assert b.events == [(0, "benchmark start", "TaskNAV"), (10, "benchmark stop", "TaskNAV")]


def test_other_events_are_logged_by_number() -> None:
    b = Bench()
    b.listen()
    b.kernel.Log_write3(9, (INT, 1), (INT, 2), (INT, 3))
    b.kernel.Log_write0(8)
    assert b.events == [(0, "log", "9"), (0, "log", "8")]


def test_a_wrong_number_of_arguments_is_refused() -> None:
    with pytest.raises(ValueError, match="Log_write2 takes 2 arguments"):
        Bench().kernel.Log_write2(9, (INT, 1))


def test_a_label_that_c_casts_to_an_integer_is_still_a_label() -> None:
    # Log_write1(UIABenchmark_start, (xdc_IArg)"TaskNAV"): the 32-bit argument is the string's word address.
    board = System()
    events: list[tuple[int, str, str]] = []
    board.trace.listen(lambda cycles, kind, name: events.append((cycles, kind, name)))
    text = "TaskNAV"
    ctype = ArrayType("char[8]", CHAR, 8)
    constant = board.memory.place(Declaration(repr(text), ctype, "constant", "", 0), "econst", [*map(ord, text), 0])
    board.kernel.log.Log_write1(1, (LONG, constant.base))
    board.kernel.log.Log_write1(1, (LONG, constant.base + 4))  # from the fifth character on
    board.kernel.log.Log_write1(1, (LONG, constant.base + 8))  # behind its end: a number
    assert [name for _, _, name in events] == ["TaskNAV", "NAV", str(constant.base + 8)]
