"""Processes that work for this one, and end when it wants no more of them: after the last result, or after Ctrl-C."""

from __future__ import annotations

import multiprocessing
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager

from hil import ending


@contextmanager
def workers(count: int) -> Iterator[ProcessPoolExecutor]:
    """So many processes, while this lasts.  What they are at when it ends is given up.

    They are spawned, not forked: the same on every system, and nothing of this process is in them.  Ctrl-C of a
    terminal reaches them, too, and means nothing there: this process ends them.
    """
    others = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(count, multiprocessing.get_context("spawn"), initializer=ending.ignored)
    try:
        yield pool
    finally:
        for child in set(multiprocessing.active_children()) - others:
            child.kill()
        pool.shutdown(wait=True, cancel_futures=True)
