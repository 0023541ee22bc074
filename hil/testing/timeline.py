"""Lets virtual time pass in a test: for a duration, or until a trigger fires.

A call of a driver function takes its own time.  Between calls `Timeline` advances the time: through the kernel if one
runs, else from event to event with an idle CPU.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from emulator.clock import SYSCLK_HZ, ms, seconds
from hil.board import Board
from hil.testing.triggers import Trigger


class NotReached(AssertionError):
    """A trigger did not fire within its virtual time."""


class Timeline:
    """The virtual time of one board.

    `run_until(cycles)` lets time pass while the board's kernel runs.  Without a kernel, the CPU is idle.
    """

    def __init__(self, board: Board, run_until: Callable[[int], None] | None = None) -> None:
        self.clock = board.clock
        self._kernel = board.kernel
        self._run_until = run_until

    def run_kernel(self) -> None:
        """Note that the board's kernel has started.  It runs while time passes."""
        self._run_until = self._kernel.run_until

    @property
    def now_s(self) -> float:
        """The virtual time since power-up in seconds."""
        return seconds(self.clock.now)

    def advance(self, duration_s: float) -> None:
        """Let `duration_s` seconds of virtual time pass.  Raises ValueError for a negative time."""
        if duration_s < 0.0:
            raise ValueError(f"advance({duration_s}): time goes forward only")
        self._run(self.clock.now + round(duration_s * SYSCLK_HZ), lambda: False)

    def until(self, trigger: Trigger, within_s: float = 1.0) -> Any:
        """Let time pass until `trigger` fires.  Returns its value (a pin's level, a match, a finding).

        Raises NotReached, which names the present state, after `within_s` seconds of virtual time.
        """
        __tracebackhide__ = True
        start = self.clock.now
        limit = start + round(within_s * SYSCLK_HZ)
        fired: list[Any] = []

        def fire(value: Any) -> None:
            if not fired:
                fired.append(value)
                if self._run_until is not None:
                    self._kernel.pause()

        disarm = trigger.arm(fire)
        try:
            if not fired:
                self._run(limit, lambda: bool(fired))
        finally:
            disarm()
        if fired:
            return fired[0]
        waited = f"within {within_s:g} s of virtual time ({ms(start):.3f} to {ms(self.clock.now):.3f} ms)"
        instead = trigger.instead()
        raise NotReached(f"{trigger} did not come {waited}" + (f": {instead}" if instead else ""))

    def later(self, delay_s: float, action: Callable[[], Any]) -> None:
        """Call `action()` after `delay_s` seconds of virtual time, whichever thread runs then."""
        self.clock.after(round(delay_s * SYSCLK_HZ), action)

    def _run(self, limit: int, done: Callable[[], bool]) -> None:
        clock = self.clock
        while clock.now < limit and not done():
            if self._run_until is not None:
                self._run_until(limit)
            else:
                clock.advance_to(min(max(clock.next, clock.now), limit))
