"""The two diagonal sonars: the ring of three becomes a ring of five.

They stand behind the three in the ring, so nothing on the board changes but where the last TX leads: LEFT, FRONT,
RIGHT, FRONT_LEFT, FRONT_RIGHT.  A turn of the ring takes 245 ms instead of 147.  How they stand in a world:
`in_world.py`.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Final


@dataclass(frozen=True, slots=True)
class Diagonal:
    """One of the two: its input of ADC-A; how far ahead and to the left of the axle's middle it sits; where it looks.

    The bearing is counter-clockwise from straight ahead.
    """

    adcin: int
    x_m: float
    y_m: float
    bearing_rad: float


#: CHOICE: inputs beside those of the other sonars (ADCINA0 stays free: DACOUTA); places between their neighbours, 45
#: degrees to each side (thesis, figure 42: no measures).
DIAGONALS: Final = {
    "FRONT_LEFT": Diagonal(1, 0.080, 0.040, pi / 4.0),
    "FRONT_RIGHT": Diagonal(5, 0.080, -0.040, -pi / 4.0),
}
