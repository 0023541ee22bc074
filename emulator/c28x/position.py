"""Where the firmware is: the shadow call stack.

Generated code stores the number of a statement in `Position.at` before others can notice it.  A function with such
statements saves the place of its caller while it runs.  Findings, watches and debuggers read the place of the firmware
here, whether the code is interpreted or compiled.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final

from mypy_extensions import i64

#: The callers of the running function: (place of the call, callers of the caller); None at the bottom of a stack.  Each
#: call makes a new tuple, so the tuple is also the identity of the call.  A third member (`INTERRUPT`) marks a step
#: that is not a call: an interrupt, or something that runs from one.
Calls = tuple[Any, ...]
INTERRUPT: Final = "interrupt"


def _nobody(statement: Any, values: Mapping[str, Any]) -> None:
    """Nobody follows the statements."""


class Position:
    """Where one CPU is in its firmware.

    `at` is the number of the statement that executes (0: none); `calls` are the callers of its function.
    A kernel saves both for each thread.  An interrupt runs on the stack of another thread and adds a step `INTERRUPT`.
    `who` is the running thread: a task's name, `Idle`, `Swi:...`, `Hwi:...`, `main`, or `Isr:...` for an interrupt
    routine that the kernel does not manage.  The code that switches threads sets it.
    """

    __slots__ = ("at", "calls", "follow", "hold", "who")

    def __init__(self) -> None:
        self.at: i64 = 0
        self.calls: Calls | None = None
        self.who = "main"
        #: Called with the locals before each statement, in an image linked with `CompileOptions.steps`.
        self.hold: Callable[[Mapping[str, Any]], None] | None = None
        #: Called with each statement before it begins, and the locals, in an image linked with `CompileOptions.follow`.
        self.follow: Callable[[Any, Mapping[str, Any]], None] = _nobody

    def innermost(self) -> int:
        """The statement that executes; if none does, the innermost one that was interrupted or has called; 0: none."""
        if self.at:
            return self.at
        for at, _ in frames(0, self.calls):
            return at
        return 0

    def within(self, call: Calls) -> bool:
        """Whether a call has not returned yet; `call` is its identity."""
        calls = self.calls
        while calls is not None:
            if calls is call:
                return True
            calls = calls[1]
        return False

    def frames(self) -> Iterator[tuple[int, Calls | None]]:
        """(place, identity of the call) of every active function, the innermost first, without interrupt steps."""
        return frames(self.at, self.calls)


def frames(at: int, calls: Calls | None) -> Iterator[tuple[int, Calls | None]]:
    """As `Position.frames`, for a saved position."""
    while True:
        if at:
            yield at, calls
        if calls is None:
            return
        at, calls = calls[0], calls[1]


def interrupted(at: int, calls: Calls | None) -> tuple[int, Calls | None]:
    """The part of a position below its outermost interrupt: where the interrupted thread itself is."""
    step = calls
    while step is not None:
        if len(step) > 2:
            at, calls = step[0], step[1]
        step = step[1]
    return at, calls
