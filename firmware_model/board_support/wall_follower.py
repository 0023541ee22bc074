"""Wall_Follower.c: keeping a distance to a wall at the side.

main_Robot.c includes Wall_Follower.h and calls nothing of it (the thesis replaced the course's wall following by its
own navigation, section 3.2.1).  CHOICE: a proportional law on the side distance with the front distance slowing the
robot down, in the units of the drivers: centimetres in, m/s and rad/s out.
"""

from __future__ import annotations

from emulator.c28x.language import *
from firmware_model.robot_types import REFERENCE

FRONT_STOP_CM = 25.0
FRONT_SLOW_CM = 60.0
V_CRUISE = 0.15  # m/s
K_SIDE = 0.02  # rad/s per centimetre
W_MAX = 0.5  # rad/s

WALL_LEFT = 0
WALL_RIGHT = 1


# Wall_Follower.c: Wall_Follower
def Wall_Follower(side: char, side_cm: float32, front_cm: float32, wanted_cm: float32, ref: ptr[REFERENCE]) -> void:
    W: float32

    W = K_SIDE * (side_cm - wanted_cm)
    if side == WALL_RIGHT:
        W = -W
    if W > W_MAX:
        W = W_MAX
    if W < -W_MAX:
        W = -W_MAX

    if front_cm < FRONT_STOP_CM:
        ref.V = 0.0
        if side == WALL_RIGHT:
            ref.W = W_MAX
        else:
            ref.W = -W_MAX
        return

    ref.V = V_CRUISE
    if front_cm < FRONT_SLOW_CM:
        ref.V = V_CRUISE * (front_cm - FRONT_STOP_CM) / (FRONT_SLOW_CM - FRONT_STOP_CM)
    ref.W = W
