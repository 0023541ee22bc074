"""Defects of Odometry.c, in the order of its lines."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue.defect import Defect

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "ODO-slow-turn-lost", "Odometry.c", "Odom_Trayect", "if (Wactual*Wactual < 0.0001)",
        "Below 0.01 rad/s the heading stays as it is: a minute at 0.009 rad/s is 31 degrees that the odometry never sees. "
        "The test is there to avoid a division, not a turn.",
        "TFG 3.3.2: the heading grows by W times the period, always",
        "A robot that drives a slow curve is drawn on a straight line.",
        "odometry-path", "The heading is advanced in both branches.",
        line=11,
        severity=Severity.WARNING,
    ),
    Defect(
        "ODO-units-turning", "Odometry.c", "Odom_Trayect", "ds = Vactual/Wactual*dtita",
        "Straight on, V [m/s] times the period [ms] gives millimetres; in a turn, V/W [m] times an angle gives metres. A "
        "turning robot hardly moves.",
        "Units; TFG figure 15: 50 a frame at 0.2 m/s",
        "Every curve is drawn as a turn on the spot.",
        "unit", "Times 1000 in the turn.",
        line=17,
        severity=Severity.ERROR,
    ),
    Defect(
        "ODO-angle-factor", "Odometry.c", "Odom_Trayect", "tita * 0.78 in cos and sin",
        "The heading is multiplied by 0.78 before its cosine is taken: after a quarter turn the robot is drawn at 70 "
        "degrees. Text and kinematics have no such factor.",
        "TFG 3.3.2: dx = ds cos(theta + dtheta/2)",
        "Squares are drawn open, corridors bend.",
        "odometry-path", "The heading itself.",
        line=21,
        severity=Severity.ERROR,
    ),
    Defect(
        "ODO-half-step", "Odometry.c", "Odom_Trayect", "tita + dtita/2 after tita += dtita",
        "The chord of a step points along the heading in the middle of it. The heading has been advanced by the whole step "
        "before half a step is added: the chord points one step ahead.",
        "TFG 3.3.2 updates theta last",
        "Arcs are drawn turned by W times the period, 22 degrees at full rate.",
        "odometry-path", "Half a step is taken off the advanced heading.",
        line=21,
        severity=Severity.WARNING,
    ),
    Defect(
        "ODO-heading-unwrapped", "Odometry.c", "Odom_Trayect", "Robot_Odometry->tita + dtita",
        "The heading counts whole turns for ever. A float of 24 bits has it in steps of 0.002 rad beyond 16384 rad, and "
        "an int of the frame ends at 32767 rad, after 5.8 hours of turning at 1.57 rad/s.",
        "ISO C 6.3.1.4: conversion of a float beyond an int; TFG 3.1.4 names such an overflow",
        "None in a lesson; a robot that turns for hours is drawn with any heading.",
        "float-to-int", "It is held between -pi and pi: the same direction.",
        covered_by=("PROTO-angle-unit",),
        line=18,
        severity=Severity.NOTE,
    ),
)  # fmt: skip
