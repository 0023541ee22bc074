"""A console for the robot in a terminal: orders by key, frames, a small arena, findings of an emulated robot.

run.py does it; it needs textual, so this module only tells who has none.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from hil.machine import Machine, Setup
    from hil.terminal.run import Summary

MISSING = "the console in the terminal needs textual: pip install textual"


def run_terminal(
    port: str | None,
    setup: Setup | None = None,
    *,
    machine: Callable[[Setup], Machine] | None = None,
    pace: float = 1.0,
) -> Summary:
    """Run the console until the user leaves: for the robot behind `port` (a device or any URL of pyserial), or without
    one for an emulated robot of `setup`, made by `machine` (default: the real bench), at `pace` times real time.

    Raises ValueError, one line, for what the user can mend (no terminal, no textual, no such port or world), and
    FirmwareStopped when the emulated firmware did not run on.
    """
    if find_spec("textual") is None:
        raise ValueError(MISSING)
    from hil.terminal.run import run

    return run(port, setup, machine=machine, pace=pace)
