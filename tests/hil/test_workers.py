"""Processes that work for this one end with the block that has them, whatever they are at."""

from __future__ import annotations

import multiprocessing
import os
import time

from hil.workers import workers

#: Longer than any test may take.
TOO_LONG_S = 100_000.0


def test_what_is_not_wanted_any_more_is_given_up() -> None:
    with workers(1) as pool:
        assert pool.submit(os.getpid).result() != os.getpid()
        pool.submit(time.sleep, TOO_LONG_S)
        pool.submit(time.sleep, TOO_LONG_S)
        (child,) = multiprocessing.active_children()
    child.join()
    assert child.exitcode is not None


def test_processes_of_others_stay() -> None:
    with workers(1) as outer:
        assert outer.submit(abs, -1).result() == 1
        with workers(1) as inner:
            assert inner.submit(abs, -2).result() == 2
        assert outer.submit(abs, -3).result() == 3
