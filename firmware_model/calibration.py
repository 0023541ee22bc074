"""How long each function of the firmware takes, relative to the cost table of the translator.

CHOICE: the code generator of the original is not at hand, so one factor a module or function brings whole tasks to the times
measured on the robot (TFG figures 37 and 39).  `hil tasks` prints what comes out.
"""

from __future__ import annotations

from typing import Final

#: `module.function` or `module` -> factor on the cycles of `emulator.c28x.costs`.
CALIBRATION: Final[dict[str, float]] = {}
