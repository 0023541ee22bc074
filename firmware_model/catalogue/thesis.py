"""Figures and statements of the thesis that do not follow from its own numbers, from a data sheet or from the code."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue.defect import Defect, DefectKind


def _figure(
    id: str, section: str, place: str, wrong: str, source: str, symptom: str, correction: str,
    severity: Severity = Severity.NOTE,
) -> Defect:  # fmt: skip
    return Defect(
        id, "thesis", section, place, wrong, source, symptom, "figure", correction, DefectKind.FIGURE, severity=severity
    )


DEFECTS: Final[tuple[Defect, ...]] = (
    _figure(
        "FIG-sonar-sensitivity", "TFG 3.1.1", "16.5 mV/cm, +-8.5 mV",
        "The text calls these numbers millivolts. Like the numbers of annex A.3.1 they are sums of twelve conversions "
        "divided by 2.3; the slopes of the annex give 17.6 to 18.1 per centimetre. The voltage changes by 2.54 mV per "
        "centimetre.",
        "us.c, Read_Distance; LV-MaxSonar-EZ PI10003b: Vcc/512 per inch, Vcc 3.3 V",
        "If they were millivolts, the window of 8.5 would be 3.3 cm. It is half a centimetre.",
        "16.5 units of the sum divided by 2.3; 2.54 mV/cm.",
    ),
    _figure(
        "FIG-left-calibration", "TFG annex A.3.1", "left sensor at 40 cm",
        "In the left column the mean at 40 cm is 521, between 401 at 25 cm and 842 at 50 cm. On its own regression "
        "line that is 33 cm. The other two sensors have 667 and 679. The regression included this row, so its slope "
        "is 0.0551 instead of 0.0585.",
        "Least squares over the table without that row",
        "The left distance is 1.3 cm too short at 60 cm and 0.4 cm too long at 20 cm.",
        "0.0585 cm a unit, 0.29 cm at zero.",
        severity=Severity.WARNING,
    ),
    _figure(
        "FIG-field-order", "TFG 3.1.4", "structure of the frame",
        "The text gives the distances in the order front, left, right. The frame has front, right, left, and so does "
        "the table in the same section.",
        "protocol.c, Send_ODO_Trayect; TFG figure 15",
        "A console that follows the text draws the walls on the wrong sides.",
        "Front, right, left: left is the sixth.",
        severity=Severity.WARNING,
    ),
    _figure(
        "FIG-end-mark", "TFG 3.1.4", "end of the frame",
        "According to the text a frame ends with a line feed. The robot sends line feed and carriage return.",
        "protocol.c, Send_ODO_Trayect",
        "A console that splits at line feeds starts each frame with a carriage return.",
        "The last character is 13.",
    ),
    _figure(
        "FIG-odometry-threshold", "TFG 3.3.2", "W squared against 0.001",
        "The text treats rates below 0.032 rad/s as 0, the code rates below 0.01 rad/s.",
        "Odometry.c, Odom_Trayect",
        "None: both lose turns.",
        "0.0001.",
    ),
    _figure(
        "FIG-arc-formula", "TFG 3.3.2", "ds = V/W * Tcontrol",
        "V/W times an angle is a length; V/W times a time has no meaning. At 0.3 m/s and 0.5 rad/s the formula gives "
        "0.15 instead of 0.075 m.",
        "Kinematics: ds = V/W * dtheta",
        "None: the code uses the angle.",
        "V / W * dtheta.",
    ),
    _figure(
        "FIG-periodic-tasks", "TFG 3.4.4", "6 periodic tasks",
        "A Clock releases five tasks. TaskORD is sporadic, as the same section says earlier.",
        "main_Robot.c: five calls of Clock_create",
        "None.",
        "5.",
    ),
    _figure(
        "FIG-time-unit", "TFG 3.4.2", "figures 37 and 38",
        "The text announces microseconds, and the table holds nanoseconds. With 106602.9 us every 5 ms TaskUS alone "
        "would need 21 processors.",
        "Load = C / T; figure 39 has 106.55 us",
        "None.",
        "106.6 us.",
    ),
    _figure(
        "FIG-worst-times", "TFG 3.4.2", "C of TaskUS, TaskGYRO and TaskSERVO in figure 39",
        "The analysis needs worst cases. Figure 39 has 20.91 us for TaskSERVO, where figure 37 measured 28.87 us "
        "twice; the task takes 20.91 us only while the robot stands. For TaskUS (106.55) and TaskGYRO (42.97) the "
        "figure has means instead of the largest values, 107.28 and 43.29.",
        "TFG figure 37",
        "The bounds can be exceeded.",
        "107.28, 43.29 and 28.87 us.",
    ),
    _figure(
        "FIG-order-bits", "TFG 3.4.2", "the shortest order",
        "The text counts #STOP and its end mark as 6 bits. They are 6 characters, 60 bits on the line.",
        "8N1: 10 bits a character",
        "None: the resulting 6.25 ms are right.",
        "60 bits.",
    ),
    _figure(
        "FIG-odometry-ceiling", "TFG 3.4.3", "figure 40",
        "The text gives the odometry's server a ceiling of 3. Only TaskODO, priority 1, enters it.",
        "Ceiling: the highest priority of the tasks that use it; main_Robot.c",
        "The analysis includes blocking that cannot occur.",
        "1.",
    ),
    _figure(
        "FIG-ceiling-protocol", "TFG 3.4.3", "priority ceiling",
        "The text computes blocking with priority ceilings. GateMutexPri has no ceilings: it raises the owner's "
        "priority only while another task waits. So TaskNAVIGATION stays at 2 inside the server of the sonars, whose "
        "ceiling is 6.",
        "SYS/BIOS GateMutexPri: priority inheritance",
        "Each lower task can block a task once; with ceilings only one of them could.",
        "2 inside an uncontended gate.",
    ),
    _figure(
        "FIG-blocking-orders", "TFG 3.4.3", "B of TaskGYRO and TaskORD",
        "The text adds 4.05, 12 and 17.2 us, and the 17.2 us already contain the 12 us of the sonars' server. "
        "Besides, TaskNAVIGATION is the only lower task that enters these servers, and it is in one of them at a "
        "time.",
        "hil rta --thesis: each lower task blocks for one critical section",
        "The bounds are too large.",
        "12 us for both.",
    ),
    _figure(
        "FIG-blocking-servo", "TFG 3.4.3", "B of TaskSERVO",
        "The text gives 6.7 us + 10 us as 16.5 us. With the ceilings of figure 40 TaskODO blocks for 10 us. "
        "TaskNAVIGATION blocks for its longest time in any server, 12 us, because it inherits the priority of the "
        "task that waits.",
        "hil rta --thesis: inheritance; TFG figure 40",
        "With the ceilings of the text the bound can be exceeded.",
        "22 us; 12 us with the users of annex 1, where only TaskODO enters the server of the odometry.",
    ),
    _figure(
        "FIG-response-interrupts", "TFG 3.4.4", "W of TaskUS",
        "The bounds leave out both interrupts of figure 39. In every millisecond a tick (5 us) and a character (7 us) "
        "interrupt the task.",
        "Response-time analysis: every higher priority counts",
        "Every W is too small.",
        "130.55 us.",
    ),
    _figure(
        "FIG-response-orders", "TFG 3.4.4", "W of TaskORD",
        "The formula rounds the quotient 6.25/5 up to 2 releases; the text uses 1.25. For TaskGYRO it uses 42.67 us, "
        "where figure 39 and every other line have 42.97 us.",
        "TFG 3.4.4, its own formula",
        "The bound is 112 us too small; it should be 359.83 us.",
        "359.83 us.",
    ),
    _figure(
        "FIG-response-navigation", "TFG 3.4.4", "W of TaskNAVIGATION",
        "The text gives 1796.71 us as 1.79 ms.",
        "Rounding",
        "None.",
        "1.80 ms.",
    ),
    _figure(
        "FIG-utilisation", "TFG 3.4.4", "U",
        "The sum uses the periods of figure 39 for the two interrupts, 10 ms and 2 ms. A tick comes every 1 ms, "
        "because 5 ticks are 5 ms. A character comes every 1.0417 ms, as section 3.4.2 says.",
        "main_Robot.c: US_Period = 5; 10 bits at 9600 baud",
        "The text has 95.68 % of free time; it is 94.91 %.",
        "0.0509.",
    ),
)  # fmt: skip
