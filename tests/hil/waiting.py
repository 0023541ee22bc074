"""Waiting in a test for what other threads, processes and the system do in their own time."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

#: A test that waits longer has failed; nothing is asserted about times below it.
TIMEOUT_S = 120.0
#: Between two looks.  What is waited for sends no event to a test.
SAMPLE_S = 0.02

T = TypeVar("T")


def rest() -> None:
    """Let the others run."""
    time.sleep(SAMPLE_S)


def eventually(look: Callable[[], T], turn: Callable[[], object] = rest, *, what: str = "") -> T:
    """Take turns until there is something to see, and return it."""
    limit = time.monotonic() + TIMEOUT_S
    while not (seen := look()):
        assert time.monotonic() < limit, f"it did not happen: {what}"
        turn()
    return seen
