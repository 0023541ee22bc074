"""Waits of the CPU as frames that can be seen, whether the clock is compiled or not.

Compiled functions leave no frame.  Who asks what the CPU is doing (a watch that an interrupt has just started) looks
for the code objects in `WAITS`.
"""

from __future__ import annotations

from types import CodeType, FunctionType
from typing import Final

from emulator.clock import Clock


def poll(clock: Clock, iteration_cycles: int) -> bool:
    """`clock.poll`."""
    return clock.poll(iteration_cycles)


def delay(clock: Clock, cycles: int) -> None:
    """`clock.delay`."""
    clock.delay(cycles)


#: Code object -> what the CPU does while it runs.  Where the clock is Python, firmware polls it directly.
WAITS: Final[dict[CodeType, str]] = {poll.__code__: "poll", delay.__code__: "delay"}
if isinstance(Clock.poll, FunctionType):
    WAITS[Clock.poll.__code__] = "poll"
