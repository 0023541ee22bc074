"""Log_write with UIABenchmark events."""

from __future__ import annotations

import pytest

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
