"""Defects of servidores.c, in the order of its lines."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue.defect import Defect

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "SERV-unused-object", "servidores.c", "ROBOT_Odometry", "its declaration",
        "The odometry of three members is declared and served by nothing since that of six replaced it.",
        "TFG 3.1.5", "None: six words of RAM, and a gate that seems to protect them.",
        "unused-object", "The object goes.",
        line=19,
        severity=Severity.NOTE,
    ),
    Defect(
        "SERV-distances-apart", "servidores.c", "read_front_distance", "US_server is entered for one distance",
        "Left, front and right are written, and read, in three critical sections each. TaskUS may run between two of a "
        "reader's: the three distances are then of two measurements.",
        "TFG 3.1.5: a server protects what belongs together",
        "Now and then a decision on a front distance and a side that were never true together.",
        "consistent-set", "A measurement is published whole, and read whole.",
        line=118,
        severity=Severity.WARNING,
    ),
    Defect(
        "SERV-trayect-gate", "servidores.c", "write_ODO_Trayect", "Odometry_server",
        "A gate of its own is created for the trajectory and entered nowhere; the trajectory uses that of another object.",
        "SYS/BIOS GateMutexPri; TFG 3.1.5 lists one server for the odometry",
        "None today: nothing else enters that gate. The first user of ROBOT_Odometry waits for the trajectory.",
        "gate-unused", "The trajectory has its gate; the other one is not created.",
        line=173,
        severity=Severity.NOTE,
    ),
)  # fmt: skip
