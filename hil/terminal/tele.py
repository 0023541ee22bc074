"""Drives with the arrow keys.  A terminal reports only presses, not releases.

* A press changes the speed by the thesis console's step (annex 2: 0.01 m/s, 0.03 rad/s).  However fast a terminal
  repeats a held key, an axis changes by at most one step a period, as in that console.
* The speed holds when nothing is pressed, so driving straight needs no key held.
* Dead man: `DEAD_MAN_S` after the last key both speeds become 0.  A connection that hangs brings no keys.

Unlike the thesis console, each telemanipulation begins at rest and speeds are limited.
"""

from __future__ import annotations

from enum import Enum
from typing import Final

from hil.client.keys import V_STEP_M_S, W_STEP_RAD_S
from hil.client.orders import set_reference

#: Between two ``#SETR``: measured at the thesis console.
PERIOD_S: Final = 0.101
#: CHOICE: at full speed the robot rolls 1.5 m in this time.
DEAD_MAN_S: Final = 3.0
#: CHOICE: 0.5 m/s is what the motors reach (NXT: 170 rpm, wheel radius 0.027 m); 3 rad/s: half a turn a second.
V_MOST_STEPS: Final = 50
W_MOST_STEPS: Final = 100


class Arrow(Enum):
    """An arrow key as steps of (linear, angular) speed; left is counter-clockwise."""

    UP = (1, 0)
    DOWN = (-1, 0)
    LEFT = (0, 1)
    RIGHT = (0, -1)


class TerminalTele:
    """The speeds that the arrows ask for.  Times are seconds of one monotonic clock."""

    def __init__(self, *, dead_man_s: float = DEAD_MAN_S) -> None:
        self.active = False
        self._dead_man_s = dead_man_s
        self._v_steps = self._w_steps = 0
        self._v_pressed = self._w_pressed = 0
        self._last_key_s = 0.0

    @property
    def v_m_s(self) -> float:
        """The ordered linear speed."""
        return self._v_steps * V_STEP_M_S

    @property
    def w_rad_s(self) -> float:
        """The ordered angular speed."""
        return self._w_steps * W_STEP_RAD_S

    def begin(self, now_s: float) -> None:
        """Begin telemanipulation, at rest; while it is on, only reset the dead man's timer."""
        if not self.active:
            self.active = True
            self._rest()
        self._last_key_s = now_s

    def end(self) -> None:
        """End telemanipulation."""
        self.active = False
        self._rest()

    def press(self, arrow: Arrow, now_s: float) -> None:
        """Note an arrow key, which takes effect at the next tick."""
        v, w = arrow.value
        self._v_pressed = v or self._v_pressed
        self._w_pressed = w or self._w_pressed
        self._last_key_s = now_s

    def rest(self, now_s: float) -> None:
        """Set both speeds to 0, still in telemanipulation."""
        self._rest()
        self._last_key_s = now_s

    def tick(self, now_s: float) -> bytes:
        """End a period, and return the order to send."""
        if now_s - self._last_key_s > self._dead_man_s:
            self._rest()
        self._v_steps = _limited(self._v_steps + self._v_pressed, V_MOST_STEPS)
        self._w_steps = _limited(self._w_steps + self._w_pressed, W_MOST_STEPS)
        self._v_pressed = self._w_pressed = 0
        return set_reference(self.v_m_s, self.w_rad_s)

    def _rest(self) -> None:
        self._v_steps = self._w_steps = self._v_pressed = self._w_pressed = 0


def _limited(steps: int, most: int) -> int:
    return max(-most, min(most, steps))
