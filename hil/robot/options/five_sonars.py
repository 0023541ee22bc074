"""The two diagonal sonars: the ring of three becomes a ring of five.

They stand behind the three in the ring, so nothing on the board changes but where the last TX leads: LEFT, FRONT,
RIGHT, FRONT_LEFT, FRONT_RIGHT.  A turn of the ring takes 245 ms instead of 147.  Where they look: `in_world.py`.
"""

from __future__ import annotations

from typing import Final

#: CHOICE: the inputs of ADC-A beside those of the other sonars (ADCINA0 stays free: DACOUTA).
DIAGONAL_ADCIN: Final = {"FRONT_LEFT": 1, "FRONT_RIGHT": 5}
