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
        "Called millivolts, but like the numbers of annex A.3.1 these are sums of twelve conversions divided by 2.3, 17.6 "
        "to 18.1 a centimetre by the annex's own slopes. The voltage changes by 2.54 mV a centimetre.",
        "us.c, Read_Distance; LV-MaxSonar-EZ PI10003b: Vcc/512 per inch, Vcc 3.3 V",
        "Who takes them for millivolts reads the window of 8.5 as 3.3 cm; it is half a centimetre.",
        "16.5 units of the sum divided by 2.3; 2.54 mV/cm.",
    ),
    _figure(
        "FIG-left-calibration", "TFG annex A.3.1", "left sensor at 40 cm",
        "The left column at 40 cm averages 521, between 401 at 25 cm and 842 at 50 cm: 33 cm on its own line. The other "
        "two sensors have 667 and 679. The regression took it in: slope 0.0551 instead of 0.0585.",
        "Least squares over the table without that row",
        "The left distance is 1.3 cm short at 60 cm and 0.4 cm long at 20 cm.",
        "0.0585 cm a unit, 0.29 cm at zero.",
        severity=Severity.WARNING,
    ),
    _figure(
        "FIG-field-order", "TFG 3.1.4", "structure of the frame",
        "The text has the distances in the order front, left, right; the frame has front, right, left, and so has the "
        "table of the same section.",
        "protocol.c, Send_ODO_Trayect; TFG figure 15",
        "A console written from the text draws the walls on the wrong sides.", "Front, right, left: left is the sixth.",
        severity=Severity.WARNING,
    ),
    _figure(
        "FIG-end-mark", "TFG 3.1.4", "end of the frame",
        "The text ends a frame with a line feed; the robot ends it with line feed and carriage return.",
        "protocol.c, Send_ODO_Trayect", "A console that splits at line feeds begins each frame with a carriage return.",
        "The last character is 13.",
    ),
    _figure(
        "FIG-odometry-threshold", "TFG 3.3.2", "W squared against 0.001",
        "The text takes a rate as zero below 0.032 rad/s, the code below 0.01 rad/s.", "Odometry.c, Odom_Trayect",
        "None: both lose turns.", "0.0001.",
    ),
    _figure(
        "FIG-arc-formula", "TFG 3.3.2", "ds = V/W * Tcontrol",
        "A length is V/W times an angle; times a time it has no meaning. At 0.3 m/s and 0.5 rad/s it gives 0.15 for 0.075 m.",
        "Kinematics: ds = V/W * dtheta", "None: the code has the angle.", "V / W * dtheta.",
    ),
    _figure(
        "FIG-periodic-tasks", "TFG 3.4.4", "6 periodic tasks",
        "Five tasks are released by a clock; TaskORD is sporadic, as the section itself says further up.",
        "main_Robot.c: five calls of Clock_create", "None.", "5.",
    ),
    _figure(
        "FIG-time-unit", "TFG 3.4.2", "figures 37 and 38",
        "The table is announced in microseconds and holds nanoseconds: with 106602.9 us each 5 ms, TaskUS alone would take "
        "21 processors.",
        "Load = C / T; figure 39 has 106.55 us", "None.", "106.6 us.",
    ),
    _figure(
        "FIG-worst-times", "TFG 3.4.2", "C of TaskUS, TaskGYRO and TaskSERVO in figure 39",
        "The analysis is of the worst case; figure 39 has 20.91 us for TaskSERVO, where figure 37 measured 28.87 both times: "
        "it takes as little only while the robot stands. TaskUS (106.55) and TaskGYRO (42.97) have means in place of the "
        "largest, 107.28 and 43.29.",
        "TFG figure 37", "Bounds that are not bounds.", "107.28, 43.29 and 28.87 us.",
    ),
    _figure(
        "FIG-order-bits", "TFG 3.4.2", "the shortest order",
        "#STOP and its end mark are called 6 bits; they are 6 characters, 60 bits on the line.",
        "8N1: 10 bits a character", "None: the 6.25 ms that follow are right.", "60 bits.",
    ),
    _figure(
        "FIG-odometry-ceiling", "TFG 3.4.3", "figure 40",
        "The odometry's server is given priority 3; only TaskODO, priority 1, enters it.",
        "Ceiling: the highest priority of the tasks that use it; main_Robot.c", "Blocking is reckoned that does not exist.",
        "1.",
    ),
    _figure(
        "FIG-ceiling-protocol", "TFG 3.4.3", "priority ceiling",
        "Blocking is computed by ceilings; GateMutexPri has none: it lends priority when somebody waits. TaskNAVIGATION "
        "stays at 2 inside the server of the sonars, ceiling 6.",
        "SYS/BIOS GateMutexPri: priority inheritance", "A task is blocked once by each lower one, not once at all.",
        "2 inside an uncontended gate.",
    ),
    _figure(
        "FIG-blocking-orders", "TFG 3.4.3", "B of TaskGYRO and TaskORD",
        "4.05 + 12 + 17.2 us, and the 17.2 hold the same 12 us of the sonars' server once more. Besides, TaskNAVIGATION, "
        "the only task below them that enters their servers, is in one of them at a time.",
        "hil rta --thesis: each lower task blocks for one critical section", "Bounds that are too large.",
        "12 us for both.",
    ),
    _figure(
        "FIG-blocking-servo", "TFG 3.4.3", "B of TaskSERVO",
        "6.7 us + 10 us is given as 16.5 us. By the ceilings of figure 40 TaskODO blocks for 10 us, and TaskNAVIGATION for "
        "the longest it is in any server, 12 us, as it inherits the priority of whoever waits.",
        "hil rta --thesis: inheritance; TFG figure 40", "A bound that is none.",
        "22 us; 12 us with the users of annex 1, where only TaskODO enters the server of the odometry.",
    ),
    _figure(
        "FIG-response-interrupts", "TFG 3.4.4", "W of TaskUS",
        "The bounds leave out both interrupts of figure 39: a tick of 5 us and a character of 7 us come within every "
        "millisecond.",
        "Response-time analysis: every higher priority counts", "Every W is too small.", "130.55 us.",
    ),
    _figure(
        "FIG-response-orders", "TFG 3.4.4", "W of TaskORD",
        "The quotient 6.25/5 is not rounded up to 2 releases, as the formula says, but taken as 1.25; and TaskGYRO has "
        "42.67 us, where figure 39 and every other line have 42.97.",
        "TFG 3.4.4, its own formula", "112 us are missing of a bound of 359.83.", "359.83 us.",
    ),
    _figure(
        "FIG-response-navigation", "TFG 3.4.4", "W of TaskNAVIGATION",
        "1796.71 us are given as 1.79 ms.", "Rounding", "None.", "1.80 ms.",
    ),
    _figure(
        "FIG-utilisation", "TFG 3.4.4", "U",
        "The sum takes the two interrupts at the periods of figure 39, 10 ms and 2 ms. A tick comes every 1 ms, as periods "
        "of 5 ticks are 5 ms, and a character every 1.0417 ms, as 3.4.2 has it.",
        "main_Robot.c: US_Period = 5; 10 bits at 9600 baud", "95.68 % of free time are 94.91 %.", "0.0509.",
    ),
)  # fmt: skip
