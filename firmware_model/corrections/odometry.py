"""Odometry.c with its defects corrected, each where its id stands."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.c28x.rts import cos, fabs, sin
from firmware_model.odometry import titamax
from firmware_model.robot_types import ODOMETRY_Trayect

PI: const[float32] = 3.1415927


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
        if FIXED("ODO-slow-turn-lost"):
            Robot_Odometry.tita = Robot_Odometry.tita + dtita
        else:
            Robot_Odometry.tita = Robot_Odometry.tita
            dtita = 0
    else:
        ds = Vactual / Wactual * dtita * 1000 if FIXED("ODO-units-turning") else Vactual / Wactual * dtita
        Robot_Odometry.tita = Robot_Odometry.tita + dtita

    if FIXED("ODO-angle-factor") and FIXED("ODO-half-step"):
        dx = ds * cos(Robot_Odometry.tita - (dtita / 2))
        dy = ds * sin(Robot_Odometry.tita - (dtita / 2))
    elif FIXED("ODO-angle-factor"):
        dx = ds * cos(Robot_Odometry.tita + (dtita / 2))
        dy = ds * sin(Robot_Odometry.tita + (dtita / 2))
    elif FIXED("ODO-half-step"):
        dx = ds * cos((Robot_Odometry.tita - dtita) * 0.78 + (dtita / 2))
        dy = ds * sin((Robot_Odometry.tita - dtita) * 0.78 + (dtita / 2))
    else:
        dx = ds * cos(Robot_Odometry.tita * 0.78 + (dtita / 2))
        dy = ds * sin(Robot_Odometry.tita * 0.78 + (dtita / 2))

    if FIXED("ODO-heading-unwrapped"):
        while Robot_Odometry.tita > PI:
            Robot_Odometry.tita = Robot_Odometry.tita - 2 * PI
        while Robot_Odometry.tita < -PI:
            Robot_Odometry.tita = Robot_Odometry.tita + 2 * PI

    Robot_Odometry.X = Robot_Odometry.X + dx
    Robot_Odometry.Y = Robot_Odometry.Y + dy

    Robot_Odometry.df = A
    Robot_Odometry.dl = B
    Robot_Odometry.dr = C

    if fabs(Wactual) > titamax:
        titamax = fabs(Wactual)
