"""Defects of servidores.c, in the order of its lines."""

from __future__ import annotations

from typing import Final

from firmware_model.catalogue.defect import Defect

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "SERV-unused-object", "servidores.c", "file scope", "ROBOT_Odometry",
        "The odometry of three members is declared and served by nothing since that of six replaced it.",
        "TFG 3.1.5", "None: six words of RAM, and a gate that seems to protect them.",
        "unused-object", "The object goes.",
    ),
    Defect(
        "SERV-distances-apart", "servidores.c", "read_front_distance", "one critical section a distance",
        "Left, front and right are written, and read, in three critical sections each. TaskUS may run between two of a "
        "reader's: the three distances are then of two measurements.",
        "TFG 3.1.5: a server protects what belongs together",
        "Now and then a decision on a front distance and a side that were never true together.",
        "consistent-set", "A measurement is published whole, and read whole.",
    ),
    Defect(
        "SERV-trayect-gate", "servidores.c", "write_ODO_Trayect", "Odometry_server",
        "A gate of its own is created for the trajectory and entered nowhere; the trajectory uses that of another object.",
        "SYS/BIOS GateMutexPri; TFG 3.1.5 lists one server for the odometry",
        "None today: nothing else enters that gate. The first user of ROBOT_Odometry waits for the trajectory.",
        "gate-unused", "The trajectory has its gate; the other one is not created.",
    ),
)  # fmt: skip
