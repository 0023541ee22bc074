"""ROBOT_types.h: the types that the robot's C files share.

The header is not printed.  Members are those that the drivers use; their order in ODOMETRY_Trayect is the order in
which `servidores.c` copies them and `protocol.c` sends them.  CHOICE: the order of the enumerators is that in which
`main_Robot.c` writes them (STATUS) and `protocol.c` returns them (ORDER); no program depends on the numbers.
Sources: TFG annex 1, sections 3.1.3 to 3.1.5.
"""

from __future__ import annotations

from emulator.c28x.language import *


class STATUS(enum):
    STOP = 0
    MISSION = 1
    TELEMANIPULATION = 2
    CALIBRATION = 3
    INITIALITATION = 4


class ORDER(enum):
    O_STOP = 0
    O_MISSION = 1
    O_TELEMANIPULATION = 2
    O_SETR = 3
    O_CALIBRATION = 4
    O_INITIALITATION = 5
    O_ERROR = 6


class REFERENCE(struct):
    V: float32
    W: float32


class ODOMETRY(struct):
    X: float32
    Y: float32
    tita: float32


class ODOMETRY_Trayect(struct):
    X: float32
    Y: float32
    tita: float32
    df: float32
    dr: float32
    dl: float32
