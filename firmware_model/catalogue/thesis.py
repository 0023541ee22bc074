"""Figures and statements of the thesis that do not follow from its own numbers, from a data sheet or from the code."""

from __future__ import annotations

from typing import Final

from firmware_model.catalogue.defect import Defect, Kind


def _figure(id: str, section: str, place: str, wrong: str, source: str, symptom: str, correction: str) -> Defect:
    return Defect(id, "thesis", section, place, wrong, source, symptom, "figure", correction, Kind.FIGURE)


DEFECTS: Final[tuple[Defect, ...]] = (
    _figure(
        "FIG-sonar-sensitivity", "TFG 3.1.1", "16.5 mV/cm",
        "The typical unit of the sonar is given as 16.5 mV/cm; Vcc/512 per inch is 2.54 mV/cm at 3.3 V and 3.84 at 5 V.",
        "LV-MaxSonar-EZ PI10003b: analogue voltage of Vcc/512 per inch",
        "The window of +-8.5 mV is 3.3 cm, not half a centimetre.", "2.54 mV/cm.",
    ),
    _figure(
        "FIG-left-calibration", "TFG annex A.3.1", "left sensor at 40 cm",
        "The left column at 40 cm averages 521, between 401 at 25 cm and 842 at 50 cm: 33 cm on its own line. The other "
        "two sensors have 667 and 679. The regression took it in: slope 0.0551 instead of 0.0585.",
        "Least squares over the table without that row",
        "The left distance is 1.3 cm short at 60 cm and 0.4 cm long at 20 cm.",
        "0.0585 cm a unit, 0.29 cm at zero.",
    ),
    _figure(
        "FIG-field-order", "TFG 3.1.4", "structure of the frame",
        "The text has the distances in the order front, left, right; the frame has front, right, left, and so has the "
        "table of the same section.",
        "protocol.c, Send_ODO_Trayect; TFG figure 15",
        "A console written from the text draws the walls on the wrong sides.", "Front, right, left: left is the sixth.",
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
        "FIG-worst-us", "TFG 3.4.2", "C of TaskUS in figure 39",
        "The analysis is of the worst case and uses 106.55 us, below the mean that figure 37 measured; its maximum is 107.28.",
        "TFG figure 37", "Bounds that are not bounds.", "107.28 us.",
    ),
    _figure(
        "FIG-worst-gyro", "TFG 3.4.2", "C of TaskGYRO in figure 39",
        "42.97 us against a measured maximum of 43.29.", "TFG figure 37", "Bounds that are not bounds.", "43.29 us.",
    ),
    _figure(
        "FIG-worst-servo", "TFG 3.4.2", "C of TaskSERVO in figure 39",
        "20.91 us against a measured maximum of 28.87, 38 % more.", "TFG figure 37", "Bounds that are not bounds.",
        "28.87 us.",
    ),
    _figure(
        "FIG-clock-period", "TFG 3.4.2", "T of Clock in figure 39",
        "10 ms; but the clock releases tasks every 5 ms, with a period of 5 ticks, so a tick is 1 ms.",
        "main_Robot.c: US_Period = 5 with a period of 5 ms", "The clock's load is ten times that of the table.", "1 ms.",
    ),
    _figure(
        "FIG-interrupt-period", "TFG 3.4.2", "T of the order interrupt in figure 39",
        "2 ms; the section computes 1.0416 ms between two characters.", "10 bits at 9600 baud",
        "The interrupt's load is twice that of the table.", "1.0417 ms.",
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
        "SYS/BIOS GateMutexPri: priority inheritance", "A task can be blocked once for each gate, not once.",
        "2 inside an uncontended gate.",
    ),
    _figure(
        "FIG-blocking-servo", "TFG 3.4.3", "B of TaskSERVO",
        "6.7 us + 10 us is given as 16.5 us.", "Arithmetic", "0.2 us.", "16.7 us.",
    ),
    _figure(
        "FIG-response-interrupts", "TFG 3.4.4", "W of TaskUS",
        "The bounds leave out both interrupts of figure 39: five ticks of 5 us and five characters of 7 us within 5 ms.",
        "Response-time analysis: every higher priority counts", "Every W is too small.", "178.55 us.",
    ),
    _figure(
        "FIG-gyro-time", "TFG 3.4.4", "C of TaskGYRO in W of TaskORD",
        "42.67 us where figure 39 and every other line have 42.97.", "TFG figure 39", "0.6 us.", "42.97 us.",
    ),
    _figure(
        "FIG-response-orders", "TFG 3.4.4", "W of TaskORD",
        "The quotient 6.25/5 is not rounded up to 2 releases, as the formula says, but taken as 1.25.",
        "TFG 3.4.4, its own formula", "112 us are missing of a bound of 359.83.", "359.83 us.",
    ),
    _figure(
        "FIG-response-navigation", "TFG 3.4.4", "W of TaskNAVIGATION",
        "1796.71 us are given as 1.79 ms.", "Rounding", "None.", "1.80 ms.",
    ),
    _figure(
        "FIG-utilisation", "TFG 3.4.4", "U",
        "The sum takes the two interrupts at 10 ms and 2 ms; at their periods of 1 ms and 1.0417 ms it is 0.0509.",
        "TFG 3.4.2 for both periods", "95.68 % of free time are 94.91 %.", "0.0509.",
    ),
)  # fmt: skip
