"""Defects of Odometry.c, in the order of its lines."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue.defect import Defect

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "ODO-slow-turn-lost", "Odometry.c", "Odom_Trayect", "if (Wactual*Wactual < 0.0001)",
        "Below 0.01 rad/s the code does not change the heading. One minute at 0.009 rad/s is a turn of 31 degrees "
        "that the odometry never sees. The test is only meant to avoid a division by 0.",
        "TFG 3.3.2: the heading grows by W times the period, always",
        "The map shows a straight line for a robot that drives a slow curve.",
        "odometry-path",
        "Both branches advance the heading.",
        line=11,
        severity=Severity.WARNING,
    ),
    Defect(
        "ODO-units-turning", "Odometry.c", "Odom_Trayect", "ds = Vactual/Wactual*dtita",
        "On a straight line, V [m/s] times the period [ms] gives millimetres. In a turn, V/W [m] times an angle gives "
        "metres. So a turning robot hardly moves on the map.",
        "Units; TFG figure 15: 50 a frame at 0.2 m/s",
        "The map shows every curve as a turn on the spot.",
        "unit",
        "In a turn the result is multiplied by 1000.",
        line=17,
        severity=Severity.ERROR,
    ),
    Defect(
        "ODO-angle-factor", "Odometry.c", "Odom_Trayect", "tita * 0.78 in cos and sin",
        "The code multiplies the heading by 0.78 before it takes the cosine. After a quarter turn the map shows the "
        "robot at 70 degrees. Neither the text nor the kinematics has such a factor.",
        "TFG 3.3.2: dx = ds cos(theta + dtheta/2)",
        "On the map squares are open and corridors are bent.",
        "odometry-path",
        "The code uses the heading itself.",
        line=21,
        severity=Severity.ERROR,
    ),
    Defect(
        "ODO-half-step", "Odometry.c", "Odom_Trayect", "tita + dtita/2 after tita += dtita",
        "The chord of a step has the direction of the heading in the middle of the step. The code first adds the "
        "whole step to the heading and then half a step more, so the chord points one step ahead.",
        "TFG 3.3.2 updates theta last",
        "On the map arcs are rotated by W times the period, 22 degrees at full rate.",
        "odometry-path",
        "The code subtracts half a step from the new heading.",
        line=21,
        severity=Severity.WARNING,
    ),
    Defect(
        "ODO-heading-unwrapped", "Odometry.c", "Odom_Trayect", "Robot_Odometry->tita + dtita",
        "The heading counts whole turns without a limit. Beyond 16384 rad a float with 24 significant bits has steps "
        "of 0.002 rad. The int in the frame ends at 32767 rad, after 5.8 hours of turning at 1.57 rad/s.",
        "ISO C 6.3.1.4: conversion of a float beyond an int; TFG 3.1.4 names such an overflow",
        "None in a lesson. After hours of turning the map shows any heading.",
        "float-to-int",
        "The heading stays between -pi and pi, which is the same direction.",
        covered_by=("PROTO-angle-unit",),
        line=18,
        severity=Severity.NOTE,
    ),
)  # fmt: skip
