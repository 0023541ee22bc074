"""The arithmetic of the eQEP position counter: the value after some steps, and the steps to a value.

These are pure functions on a 32-bit counter that wraps at QPOSMAX.  A forward step from QPOSMAX goes to 0 (overflow), a
backward step from 0 goes to QPOSMAX (underflow).  So with QPOSMAX = 0 the counter never leaves 0.

CHOICE: the manual does not describe a counter beyond QPOSMAX (written, or QPOSMAX lowered).  Here the hardware compares
for equality only: the counter counts on to 0xFFFFFFFF, wraps to 0 without a flag, and is inside from then on.

Sources: TRM eQEP, position counter operating modes (figure "underflow/overflow", QPOSMAX = 4).
"""

from __future__ import annotations

from typing import Final

_SPAN: Final = 1 << 32


def move(position: int, steps: int, forward: bool, maximum: int) -> tuple[int, bool]:
    """The counter after `steps` (at least 1) in one direction, and whether it wrapped at `maximum`."""
    cycle = maximum + 1
    if not forward:
        if steps <= position:
            return position - steps, False
        return maximum - (steps - position - 1) % cycle, True
    if position <= maximum:
        room = maximum - position
        if steps <= room:
            return position + steps, False
        return (steps - room - 1) % cycle, True
    room = _SPAN - 1 - position
    if steps <= room:
        return position + steps, False
    beyond = steps - room - 1
    return beyond % cycle, beyond >= cycle


def distance(position: int, target: int, forward: bool, maximum: int) -> int | None:
    """Steps (at least 1) in one direction until the counter equals `target`; None if it never does."""
    if forward:
        limit = maximum if position <= maximum else _SPAN - 1
        if position < target <= limit:
            return target - position
        return limit - position + 1 + target if target <= maximum else None
    if target < position:
        return position - target
    return position + 1 + maximum - target if target <= maximum else None
