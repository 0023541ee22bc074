"""No call of a test hangs: a driver function that does not return is ended, with a finding at the loop it is in.

An interrupt routine is a call too, whoever lets the time pass in which it is taken.  The loop is that of the innermost
function that has not returned for half of the time: what it calls comes and goes.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from functools import partial, wraps
from types import FrameType
from typing import Any

from emulator.board import Board
from emulator.c28x.findings import Findings, Place
from emulator.c28x.runtime import EndlessPoll
from emulator.clock import SYSCLK_HZ
from firmware_model.image import Firmware


def guard(board: Board, firmware: Firmware, limit_s: float) -> None:
    """End every call of a test that takes longer than `limit_s` seconds of virtual time: EndlessPoll."""
    board.vectors.around = partial(_guarded_routine, firmware, limit_s)
    functions = firmware.linked.functions
    for path, function in functions.items():
        functions[path] = _guarded(firmware, path, function, limit_s)


def _guarded_routine(firmware: Firmware, limit_s: float, routine: Callable[[], Any]) -> Callable[[], Any]:
    return _guarded(firmware, routine.__qualname__, routine, limit_s)


def _guarded(firmware: Firmware, path: str, function: Callable[..., Any], limit_s: float) -> Callable[..., Any]:
    clock, findings = firmware.runtime.clock, firmware.runtime.findings
    limit = round(limit_s * SYSCLK_HZ)

    @wraps(function)
    def call(*arguments: Any) -> Any:
        halfway: list[FrameType] = []

        def end() -> None:
            message = f"{path} has run for {limit_s:g} s without returning: this loop does not end"
            loop = _path_from(findings, halfway)
            if loop:
                findings.report_at(loop[0], "endless-poll", message, object=path, how="dynamic", call_path=loop)
            else:
                findings.report("endless-poll", message, object=path)
            raise EndlessPoll(message)

        events = clock.after(limit // 2, lambda: halfway.extend(_frames())), clock.after(limit, end)
        try:
            return function(*arguments)
        finally:
            for event in events:
                clock.cancel(event)
            halfway.clear()

    return call


def _frames() -> Iterator[FrameType]:
    """What executes, from the innermost function outwards."""
    frame: FrameType | None = sys._getframe(1)
    while frame is not None:
        yield frame
        frame = frame.f_back


def _path_from(findings: Findings, halfway: list[FrameType]) -> tuple[Place, ...]:
    """The call path of the innermost firmware function that is one of `halfway` still; nothing if there is none."""
    firmware = [frame for frame in _frames() if frame.f_code.co_filename in findings.sources]
    for depth, frame in enumerate(firmware):
        if frame in halfway:
            return findings.here(len(firmware))[depth:]
    return ()
