"""Driving by hand: arrow keys and the stick change V and W, and orders follow.

It works as in the thesis console: `#TELE`, then `#SETRv,w` ten times a second.  With each of them, an arrow key that is
held changes V by 0.01 m/s or W by 0.03 rad/s, one key at a time.  There are three differences: the end of driving stops
the robot, and the next drive begins at rest; a key counts as released if its release was never seen, because another
window got it; and driving ends if the browser gives no sign of life for a while, because it or the network is gone.
"""

from __future__ import annotations

from typing import Final

from hil.client.keys import V_STEP_M_S, W_STEP_RAD_S
from hil.client.orders import order, set_reference

PERIOD_S: Final = 0.1
#: Browsers repeat a held key after half a second at the latest.
FORGET_S: Final = 0.8
#: The time without a sign of life after which driving ends.  CHOICE: a robot goes 1 m in it.
GONE_S: Final = 5.0
#: The speeds with the stick at its edge.  CHOICE: the speed of a mission, and a quarter turn in less than 2 s.
STICK_V_M_S: Final = 0.2
STICK_W_RAD_S: Final = 1.0

_KEYS: Final = {
    "ArrowUp": (V_STEP_M_S, 0.0), "ArrowDown": (-V_STEP_M_S, 0.0),
    "ArrowLeft": (0.0, W_STEP_RAD_S), "ArrowRight": (0.0, -W_STEP_RAD_S),
}  # fmt: skip


class BrowserTele:
    """The state of driving by hand.  Times are in seconds of any monotonic clock."""

    def __init__(self) -> None:
        self.on = False
        self.v_m_s = 0.0
        self.w_rad_s = 0.0
        self._key: str | None = None
        self._seen_s = 0.0
        self._alive_s = 0.0
        self._due_s = 0.0

    def begin(self, now_s: float) -> bytes:
        """The order that starts driving.  The first reference follows half a second later, as in the console."""
        self.on = True
        self.v_m_s = self.w_rad_s = 0.0
        self._key = None
        self._alive_s = now_s
        self._due_s = now_s + 0.5
        return order("tele")

    def end(self) -> bytes:
        """The order that stops the robot; empty if it was not driven."""
        if not self.on:
            return b""
        self.on = False
        self.v_m_s = self.w_rad_s = 0.0
        return set_reference(0.0, 0.0)

    def key(self, name: str, down: bool, now_s: float) -> bool:
        """Handle a key that was pressed (or repeats) or released.  Returns whether it is a key for driving."""
        if name not in _KEYS:
            return False
        if down:
            self._key, self._seen_s = name, now_s
        elif self._key == name:
            self._key = None
        return True

    def stick(self, right: float, up: float) -> None:
        """Set the position of the stick, -1 to 1 each; (0, 0) when it is released."""
        self.v_m_s = round(STICK_V_M_S * max(-1.0, min(1.0, up)), 3)
        self.w_rad_s = round(STICK_W_RAD_S * max(-1.0, min(1.0, -right)), 3) + 0.0  # never -0.0

    def alive(self, now_s: float) -> None:
        """The browser has given a sign of life."""
        self._alive_s = now_s

    def rest(self) -> None:
        """Set V and W to zero.  Telemanipulation goes on."""
        self.v_m_s = self.w_rad_s = 0.0

    def tick(self, now_s: float) -> bytes:
        """The order that is due; b"" if there is none."""
        if not self.on or now_s < self._due_s:
            return b""
        if now_s - self._alive_s > GONE_S:
            return self.end()
        self._due_s = now_s + PERIOD_S
        if self._key is not None:
            if now_s - self._seen_s > FORGET_S:
                self._key = None
            else:
                v, w = _KEYS[self._key]
                self.v_m_s, self.w_rad_s = round(self.v_m_s + v, 3), round(self.w_rad_s + w, 3)
        return set_reference(self.v_m_s, self.w_rad_s)
