"""What devices report, as findings of a board: at the statement that executes, or at the call of both accesses."""

from __future__ import annotations

import sys
from types import FrameType
from typing import Any

from emulator.c28x.findings import Finding, Findings, Place
from emulator.devices.report import Mark, shared


class Reports:
    """Reports of devices as findings of a board."""

    __slots__ = ("_findings",)

    def __init__(self, findings: Findings) -> None:
        self._findings = findings

    def __call__(
        self, rule: str, message: str, /, *, object: str = "", value: Any = None, since: Mark | None = None
    ) -> Finding:
        """Record it at the statement that executes, or at the one that made both accesses."""
        if since:
            path = self._path_of_both(since)
            cause = self._findings.cause
            if cause is not None and len(cause.path) == len(path):
                path = cause.path  # The statement before the wait in which the access ended.
            if path:
                return self._findings.report_at(
                    path[0], rule, message, object=object, value=value, how="dynamic", call_path=path
                )
        return self._findings.report(rule, message, object=object, value=value)

    def mark(self) -> tuple[FrameType, ...]:
        """The calls of the firmware now."""
        frames: list[FrameType] = []
        sources = self._findings.sources
        frame: FrameType | None = sys._getframe(1)
        while frame is not None:
            if frame.f_code.co_filename in sources:
                frames.append(frame)
            frame = frame.f_back
        return tuple(frames)

    def _path_of_both(self, earlier: Mark) -> tuple[Place, ...]:
        """From the innermost call of both accesses outwards; nothing if they share none."""
        now = self.mark()
        return tuple(map(self._place, now[len(now) - shared(earlier, now) :]))

    def _place(self, frame: FrameType) -> Place:
        file = frame.f_code.co_filename
        return Place(file, frame.f_lineno, frame.f_code.co_name, self._findings.sources[file])
