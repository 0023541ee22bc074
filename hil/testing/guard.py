"""No call of a test hangs: a driver function that does not return is ended, with a finding at the loop it is in.

A loop that is written without an end is right where it is, at the end of `main`: who calls it is told so, without a
finding.  In an interrupt routine it is none of that kind.
An interrupt routine is a call too, whoever lets the time pass in which it is taken.  The loop is that of the innermost
function that has not returned for half of the time: what it calls comes and goes.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial, wraps
from typing import Any, Final, NoReturn

from emulator.c28x.findings import Findings
from emulator.c28x.link import Linked
from emulator.c28x.runtime import EndlessPoll, Idling
from emulator.c28x.sites import Calls, Place
from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ, Event, seconds
from hil.board import Board
from hil.testing.waits import Wait, Waits

#: How often a call is looked at, and what it may compute before its loop is examined: a fiftieth of a second of the
#: chip's, less than half of one of this machine's.
_LOOK_CYCLES: Final = 10 * CYCLES_PER_MS
_COMPUTED_CYCLES: Final = 4_000_000


def guard(board: Board, linked: Linked, limit_s: float) -> None:
    """End every call of a test that takes longer than `limit_s` seconds of virtual time: EndlessPoll, Idling.

    One that has computed for long is ended before if nothing is left that could end its loop (`Wait.hopeless`).
    """
    waits = Waits(board, linked)
    board.vectors.around = partial(_guarded_routine, waits, linked, limit_s)
    functions = linked.functions
    for path, function in functions.items():
        functions[path] = _guarded(waits, linked, path, function, limit_s)


def _guarded_routine(waits: Waits, linked: Linked, limit_s: float, routine: Callable[[], Any]) -> Callable[[], Any]:
    return _guarded(waits, linked, routine.__qualname__, routine, limit_s)


def _guarded(
    waits: Waits, linked: Linked, path: str, function: Callable[..., Any], limit_s: float
) -> Callable[..., Any]:  # fmt: skip
    clock, findings = linked.runtime.clock, linked.runtime.findings
    position = findings.position
    limit = round(limit_s * SYSCLK_HZ)

    @wraps(function)
    def call(*arguments: Any) -> Any:
        halfway: list[Calls | None] = []
        before: list[Calls | None] = []
        #: Since when a loop has been hopeless.
        hopeless: dict[Place, int] = {}
        began = clock.now
        computed = clock.now - clock.waited
        who = findings.context()
        core = waits.board.cpu
        level = core.in_interrupt
        events: list[Event] = []

        def loop(called: tuple[Place, ...]) -> Wait | None:
            wait = waits.at(called[0]) if called else None
            if wait is not None:
                wait.interrupted = core.in_interrupt > level
            return wait

        def half() -> None:
            halfway.extend(running for _, running in position.frames())

        def look() -> None:
            events[2] = clock.after(_LOOK_CYCLES, look)
            if clock.now - clock.waited - computed > _COMPUTED_CYCLES:
                called = _path_from(findings, before)
                wait = loop(called)
                # What has just come is seen in the next turn: so hopeless twice, and as long again in between.
                if wait is None or not wait.hopeless:
                    hopeless.clear()
                elif clock.now - began >= 2 * (hopeless.setdefault(wait.place, clock.now) - began):
                    stop(called, wait)
            before[:] = [running for _, running in position.frames()]

        def end() -> None:
            called = _path_from(findings, halfway)
            if called and called[0].kind == "idle" and not waits.board.cpu.in_interrupt:
                raise Idling(
                    f"{path} idles for ever at {called[0]}, as it is written: no call of it returns; a main runs with "
                    "the fixture `kernel` (kernel.start(main)), time with advance() and until()"
                )
            stop(called, loop(called))

        def stop(called: tuple[Place, ...], wait: Wait | None) -> NoReturn:
            message = f"{path} has run for {seconds(clock.now - began):.2g} s without returning: this loop does not end"
            details = tuple(wait.sentences()) if wait is not None else ()
            rule = "endless-poll" if wait is None else wait.rule
            if called:
                place = called[0] if wait is None else wait.place
                findings.report_at(
                    place, rule, message, object=path, how="dynamic", call_path=(place, *called[1:]),
                    details=details, task=who,
                )  # fmt: skip
            else:
                findings.report("endless-poll", message, object=path)
            raise EndlessPoll(message)

        events += clock.after(limit // 2, half), clock.after(limit, end), clock.after(_LOOK_CYCLES, look)
        try:
            return function(*arguments)
        finally:
            for event in events:
                clock.cancel(event)
            halfway.clear()
            before.clear()

    return call


def _path_from(findings: Findings, halfway: list[Calls | None]) -> tuple[Place, ...]:
    """The call path of the innermost firmware function that is one of `halfway` still; nothing if there is none."""
    for at, running in findings.position.frames():
        if any(running is call for call in halfway):
            return findings.path(at, running)
    return ()
