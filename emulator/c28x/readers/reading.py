"""Set up the interpreter for reading and translating a program: deep recursion, no garbage collection."""

from __future__ import annotations

import gc
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

_LOCK = threading.RLock()


@contextmanager
def reading(frames: int) -> Iterator[None]:
    """Let calls nest `frames` deeper than here, and pause the cyclic garbage collector.  Restores both afterwards.

    Frames of Python functions are on the heap (CPython 3.11 and later), so this needs no C stack.  A growing tree has
    no cycles, and repeated collections over it would take as long as the parser.  Both settings are global to the
    interpreter, so only one reader at a time changes them.
    """
    with _LOCK:
        limit = sys.getrecursionlimit()
        collects = gc.isenabled()
        depth = 0
        frame: FrameType | None = sys._getframe()
        while frame is not None:
            depth += 1
            frame = frame.f_back
        sys.setrecursionlimit(max(limit, depth + frames))
        gc.disable()
        try:
            yield
        finally:
            sys.setrecursionlimit(limit)
            if collects:
                gc.enable()
