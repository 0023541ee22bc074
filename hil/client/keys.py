"""The keys that drive a robot.  The console in the terminal and the one in the browser are both made from this table.

Space is STOP everywhere, and no other key is.
"""

from __future__ import annotations

from typing import Final, NamedTuple


class Key(NamedTuple):
    """A key and what it does."""

    #: As people read it.
    shown: str
    #: As a terminal names it (textual), and a browser (`KeyboardEvent.key`).
    terminal: str
    browser: str
    text: str


STOP: Final = Key("space", "space", " ", "STOP")
MISSION: Final = Key("m", "m", "m", "mission")
TELE: Final = Key("t", "t", "t", "telemanipulation on, off")
REST: Final = Key("0", "0", "0", "V = W = 0, in telemanipulation")
LEAVE: Final = Key("Esc", "escape", "Escape", "leave a field; end telemanipulation with a stop")
SET: Final = Key("v", "v", "v", "set V and W")
CALIBRATE: Final = Key("c", "c", "c", "calibrate")
INIT: Final = Key("i", "i", "i", "initialise")
#: In the order of every help; each is a key of both consoles.
KEYS: Final = (STOP, MISSION, TELE, REST, LEAVE, SET, CALIBRATE, INIT)
#: What an arrow changes (reference: annex 2).
V_STEP_M_S: Final = 0.01
W_STEP_RAD_S: Final = 0.03


def listed() -> tuple[tuple[str, str], ...]:
    """What to press, and what it does."""
    return (*((key.shown, key.text) for key in KEYS), ("arrows", "drive, in telemanipulation"))
