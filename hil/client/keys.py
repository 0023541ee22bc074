"""The keys that drive a robot.  The console in the terminal and the one in the browser are both made from this table.

Space is STOP everywhere, and no other key is.
"""

from __future__ import annotations

from typing import Final, NamedTuple


class KeyBinding(NamedTuple):
    """A key and its meaning."""

    #: The name of the key in help texts.
    shown: str
    #: The name of the key in a terminal (textual), and in a browser (`KeyboardEvent.key`).
    terminal: str
    browser: str
    text: str


STOP: Final = KeyBinding("space", "space", " ", "STOP")
MISSION: Final = KeyBinding("m", "m", "m", "mission")
TELE: Final = KeyBinding("t", "t", "t", "telemanipulation on, off")
REST: Final = KeyBinding("0", "0", "0", "V = W = 0, in telemanipulation")
LEAVE: Final = KeyBinding("Esc", "escape", "Escape", "leave a field; end telemanipulation with a stop")
SET: Final = KeyBinding("v", "v", "v", "set V and W")
CALIBRATE: Final = KeyBinding("c", "c", "c", "calibrate")
INIT: Final = KeyBinding("i", "i", "i", "initialise")
#: All keys, in the order of the help texts.  Each key works in both consoles.
KEYS: Final = (STOP, MISSION, TELE, REST, LEAVE, SET, CALIBRATE, INIT)
#: The change of speed for each press of an arrow key (reference: annex 2).
V_STEP_M_S: Final = 0.01
W_STEP_RAD_S: Final = 0.03


def listed() -> tuple[tuple[str, str], ...]:
    """Each key and its meaning, for help texts."""
    return (*((key.shown, key.text) for key in KEYS), ("arrows", "drive, in telemanipulation"))
