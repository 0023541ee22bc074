"""No call of a test hangs: a driver function that does not return is ended, with a finding at the loop it is in.

A loop that is written without an end is right where it is, at the end of `main`: who calls it is told so, without a
finding.  In an interrupt routine it is none of that kind.
An interrupt routine is a call too, whoever lets the time pass in which it is taken.  The loop is that of the innermost
function that has not returned for half of the time: what it calls comes and goes.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial, wraps
from typing import Any

from emulator.board import Board
from emulator.c28x.findings import Findings
from emulator.c28x.link import Linked
from emulator.c28x.runtime import EndlessPoll, Idling
from emulator.c28x.sites import Calls, Place
from emulator.clock import SYSCLK_HZ


def guard(board: Board, linked: Linked, limit_s: float) -> None:
    """End every call of a test that takes longer than `limit_s` seconds of virtual time: EndlessPoll, Idling."""
    board.vectors.around = partial(_guarded_routine, board, linked, limit_s)
    functions = linked.functions
    for path, function in functions.items():
        functions[path] = _guarded(board, linked, path, function, limit_s)


def _guarded_routine(board: Board, linked: Linked, limit_s: float, routine: Callable[[], Any]) -> Callable[[], Any]:
    return _guarded(board, linked, routine.__qualname__, routine, limit_s)


def _guarded(
    board: Board, linked: Linked, path: str, function: Callable[..., Any], limit_s: float
) -> Callable[..., Any]:  # fmt: skip
    clock, findings = linked.runtime.clock, linked.runtime.findings
    position = findings.position
    limit = round(limit_s * SYSCLK_HZ)

    @wraps(function)
    def call(*arguments: Any) -> Any:
        halfway: list[Calls | None] = []

        def half() -> None:
            halfway.extend(running for _, running in position.frames())

        def end() -> None:
            message = f"{path} has run for {limit_s:g} s without returning: this loop does not end"
            loop = _path_from(findings, halfway)
            if loop and loop[0].kind == "idle" and not board.cpu.in_interrupt:
                raise Idling(
                    f"{path} idles for ever at {loop[0]}, as it is written: no call of it returns; a main runs with "
                    "the fixture `kernel` (kernel.start(main)), time with advance() and until()"
                )
            if loop:
                findings.report_at(loop[0], "endless-poll", message, object=path, how="dynamic", call_path=loop)
            else:
                findings.report("endless-poll", message, object=path)
            raise EndlessPoll(message)

        events = clock.after(limit // 2, half), clock.after(limit, end)
        try:
            return function(*arguments)
        finally:
            for event in events:
                clock.cancel(event)
            halfway.clear()

    return call


def _path_from(findings: Findings, halfway: list[Calls | None]) -> tuple[Place, ...]:
    """The call path of the innermost firmware function that is one of `halfway` still; nothing if there is none."""
    for at, running in findings.position.frames():
        if any(running is call for call in halfway):
            return findings.path(at, running)
    return ()
