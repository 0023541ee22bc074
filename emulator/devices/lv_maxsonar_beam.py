"""What the LV-MaxSonar-EZ detects: the beam as pure functions, for the world that casts the rays.

Modelled: walls as mirrors (detection by the angle between boresight and the perpendicular), small round objects by
diameter, range and bearing, order of several reflectors.
Not modelled: side lobes, absorption, surface texture (walls smoother than 4 mm are mirrors at 42 kHz).
Sources: EZ beam plots (figures read off a 12-inch grid, 10 %).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

INCH_M: Final = 0.0254

#: CHOICE: a wall is always detected up to A0 off its perpendicular, and never beyond A1.  In between the probability
#: falls linearly.
A0_RAD: Final = math.radians(20.0)
A1_RAD: Final = math.radians(30.0)

#: Half angle within which small round objects are heard (16-20 degrees in the plots), and where that fades to nothing.
OBJECT_HALF_ANGLE_RAD: Final = math.radians(17.0)
OBJECT_LIMIT_RAD: Final = math.radians(20.0)

#: Diameter in inches, greatest range in feet at 5 V and at 3.3 V: dowels A, B and rod C of the beam plots.
OBJECT_RANGE: Final[tuple[tuple[float, float, float], ...]] = ((0.25, 3.9, 2.9), (1.0, 8.5, 6.6), (3.25, 11.0, 8.9))


@dataclass(frozen=True, slots=True)
class Echo:
    """A reflector in the beam.

    `range_m`: from the sensor's face to the reflecting point (for a wall the foot of the perpendicular).  `strength`:
    probability 0..1 that one ping hears it.  `behind`: the next farther reflector, heard when this one is missed.
    """

    range_m: float
    strength: float = 1.0
    behind: Echo | None = None


def detection_probability(incidence_rad: float) -> float:
    """The probability that a plane wall is heard whose perpendicular is `incidence_rad` off the boresight."""
    angle = abs(incidence_rad)
    if angle <= A0_RAD:
        return 1.0
    if angle >= A1_RAD:
        return 0.0
    return (A1_RAD - angle) / (A1_RAD - A0_RAD)


def object_range_m(diameter_m: float, vcc_v: float = 3.3) -> float:
    """Greatest range at which a round object of `diameter_m` is heard.

    CHOICE: straight in the logarithm of the diameter and in the supply between the plotted figures, held at the ends.
    """
    if diameter_m <= 0.0:
        raise ValueError(f"diameter {diameter_m} m of an object in the beam: expected more than 0")
    supply = min(1.0, max(0.0, (vcc_v - 3.3) / (5.0 - 3.3)))
    x = math.log(diameter_m / INCH_M)
    points = [(math.log(d), low + (high - low) * supply) for d, high, low in OBJECT_RANGE]
    if x <= points[0][0]:
        feet = points[0][1]
    elif x >= points[-1][0]:
        feet = points[-1][1]
    else:
        (x0, y0), (x1, y1) = next((p, q) for p, q in pairwise(points) if x <= q[0])
        feet = y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return feet * 12.0 * INCH_M


def object_detection_probability(diameter_m: float, range_m: float, bearing_rad: float, vcc_v: float = 3.3) -> float:
    """The probability that a round object at `range_m` and `bearing_rad` off the boresight is heard."""
    angle = abs(bearing_rad)
    if range_m > object_range_m(diameter_m, vcc_v) or angle >= OBJECT_LIMIT_RAD:
        return 0.0
    if angle <= OBJECT_HALF_ANGLE_RAD:
        return 1.0
    return (OBJECT_LIMIT_RAD - angle) / (OBJECT_LIMIT_RAD - OBJECT_HALF_ANGLE_RAD)


def in_order(echoes: Iterable[Echo]) -> Echo | None:
    """Several reflectors as one Echo: the nearest, each with the next behind it; None when there is none."""
    nearest: Echo | None = None
    for echo in sorted(echoes, key=lambda e: e.range_m, reverse=True):
        if echo.strength > 0.0:
            nearest = Echo(echo.range_m, echo.strength, nearest)
    return nearest
