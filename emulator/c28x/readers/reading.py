"""The interpreter set up for reading and translating a program: room for recursion, and no collector on the way."""

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
    """Let calls nest `frames` deeper than here, and pause the cyclic collector; both as before afterwards.

    Frames of Python functions live on the heap (CPython 3.11 and later), so this costs no stack of the C library.  A
    tree that grows has no cycles, and walking over it again and again takes the collector as long as the parser.
    Both settings are the interpreter's: one reader at a time has them changed.
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
