"""Odometry.c: dead reckoning from the commanded velocities.  Sources: TFG section 3.1.3, annex 1."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.c28x.rts import cos, fabs, sin
from firmware_model.robot_types import ODOMETRY_Trayect

titamax: float32 = 0


# Odometry.c: Odom_Trayect
def Odom_Trayect(
    Robot_Odometry: ptr[ODOMETRY_Trayect],
    Vactual: float32,
    Wactual: float32,
    A: float32,
    B: float32,
    C: float32,
    Tcontrol: float32,
) -> void:

    dtita: float32
    ds: float32
    dx: float32
    dy: float32

    dtita = (Wactual * Tcontrol) / 1000
    if Wactual * Wactual < 0.0001:
        ds = Vactual * Tcontrol
        Robot_Odometry.tita = Robot_Odometry.tita
        dtita = 0
    else:
        ds = Vactual / Wactual * dtita  # as in C: metres here, millimetres above
        Robot_Odometry.tita = Robot_Odometry.tita + dtita

    dx = ds * cos(Robot_Odometry.tita * 0.78 + (dtita / 2))
    dy = ds * sin(Robot_Odometry.tita * 0.78 + (dtita / 2))

    Robot_Odometry.X = Robot_Odometry.X + dx
    Robot_Odometry.Y = Robot_Odometry.Y + dy

    Robot_Odometry.df = A
    Robot_Odometry.dl = B
    Robot_Odometry.dr = C

    if fabs(Wactual) > titamax:
        titamax = fabs(Wactual)
