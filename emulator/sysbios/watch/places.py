"""Where the firmware stands: the statement that runs, the statement at which a suspended task waits.

A greenlet keeps its frames while it does not run, and interrupts are nested calls on the interrupted one, so both are
found by walking frames.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from types import CodeType, FrameType
from typing import Final

from emulator.c28x.findings import Place
from emulator.cpu import Cpu
from emulator.sysbios.scheduler import Task
from emulator.sysbios.swi import SwiModule
from emulator.waits import WAITS

#: A statement as the interpreter names it: cheap to keep, a `Place` only when somebody reads it.
Spot = tuple[CodeType, int]

#: Frames of these functions lie between an interrupt and what it interrupts.
_BOUNDARIES: Final = frozenset((Cpu.service.__code__, SwiModule.run_ready.__code__))


class Places:
    """Finds statements by their frames; `sources` maps a firmware file to the C file that it mirrors."""

    def __init__(self, sources: Mapping[str, str]) -> None:
        self._sources = sources

    def place(self, spot: Spot | None) -> Place | None:
        """The statement, for a finding."""
        if spot is None:
            return None
        code, line = spot
        return Place(code.co_filename, line, code.co_name, self._sources.get(code.co_filename, ""))

    def text(self, spot: Spot | None) -> str:
        """The statement, for a sentence."""
        place = self.place(spot)
        return str(place) if place is not None else "no statement of the firmware"

    def here(self) -> Spot | None:
        """The innermost firmware statement that is executing."""
        frame = self.frame()
        return (frame.f_code, frame.f_lineno) if frame is not None else None

    def frame(self) -> FrameType | None:
        """The innermost firmware frame."""
        frame: FrameType | None = sys._getframe(1)
        sources = self._sources
        while frame is not None and frame.f_code.co_filename not in sources:
            frame = frame.f_back
        return frame

    def of(self, task: Task, current: Task | None) -> Spot | None:
        """Where `task` stands: below whatever has interrupted it, or suspended.  None before its first statement."""
        if task is current:
            return self._innermost(_above(_interrupted(sys._getframe(1))))
        frame = task.greenlet.gr_frame if task.greenlet is not None else None
        return self._innermost(_above(_interrupted(frame)))

    def sample(self) -> tuple[Spot, str, FrameType] | None:
        """What an interrupt that has just been taken interrupts: the statement, "poll", "delay" or "", its frame."""
        kind = ""
        below = False
        for frame in _above(sys._getframe(1)):
            code = frame.f_code
            if not below:
                below = code in _BOUNDARIES
            elif code in _BOUNDARIES:
                return None
            elif code in WAITS:
                kind = WAITS[code]
            elif code.co_filename in self._sources:
                return (code, frame.f_lineno), kind, frame
        return None

    def _innermost(self, frames: Iterator[FrameType]) -> Spot | None:
        for frame in frames:
            if frame.f_code.co_filename in self._sources:
                return frame.f_code, frame.f_lineno
        return None


def running(frame: FrameType) -> bool:
    """Whether the call of `frame` has not returned: it lies under the code that runs now."""
    return any(f is frame for f in _above(sys._getframe(1)))


def _above(frame: FrameType | None) -> Iterator[FrameType]:
    while frame is not None:
        yield frame
        frame = frame.f_back


def _interrupted(frame: FrameType | None) -> FrameType | None:
    """The first frame below the outermost interrupt of a stack."""
    base = frame
    for f in _above(frame):
        if f.f_code in _BOUNDARIES:
            base = f.f_back
    return base
