"""Defects of servidores.c, in the order of its lines."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue.defect import Defect

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "SERV-unused-object", "servidores.c", "ROBOT_Odometry", "its declaration",
        "The odometry object with three members is declared and not used; one with six members has replaced it.",
        "TFG 3.1.5",
        "None: it uses six words of RAM, and a gate that seems to protect it.",
        "unused-object",
        "The object is removed.",
        line=19,
        severity=Severity.NOTE,
    ),
    Defect(
        "SERV-distances-apart", "servidores.c", "read_front_distance", "US_server is entered for one distance",
        "Left, front and right are written and read in three separate critical sections. TaskUS may run between two "
        "of the reader's sections. Then the three distances belong to two measurements.",
        "TFG 3.1.5: a server protects what belongs together",
        "Now and then the robot decides on a front and a side distance that were never true at the same time.",
        "consistent-set",
        "The code writes all three distances in one critical section, and reads them in one.",
        line=118,
        severity=Severity.WARNING,
    ),
    Defect(
        "SERV-trayect-gate", "servidores.c", "write_ODO_Trayect", "Odometry_server",
        "The program creates a gate for the trajectory and never enters it. The trajectory uses the gate of another "
        "object.",
        "SYS/BIOS GateMutexPri; TFG 3.1.5 lists one server for the odometry",
        "None today, because nothing else enters that gate. The first user of ROBOT_Odometry would wait for the "
        "trajectory.",
        "gate-unused",
        "The trajectory uses its own gate, and the other gate is not created.",
        line=173,
        severity=Severity.NOTE,
    ),
)  # fmt: skip
