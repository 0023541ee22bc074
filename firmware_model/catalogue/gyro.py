"""Defects of GYRO.c, in the order of its lines."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue.defect import Defect

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "GYRO-global-names", "GYRO.c", "readReg", "int i, int aux, char temp at file scope",
        "The working variables of one function (i, aux, temp) are global symbols of the program, with very short "
        "names. Seven functions hide i or temp with a local of their own. The one that does not changes Init_GYRO's "
        "index.",
        "ISO C 6.2.1: scope; main_Robot.c has its own globals of one letter",
        "None today. The next driver that declares int i gets a link error or a wrong offset.",
        "hidden-name",
        "The loop counter is the index, and the global variables are removed.",
        line=193,
        severity=Severity.NOTE,
    ),
    Defect(
        "GYRO-fifo-bypassed", "GYRO.c", "Init_GYRO", "REG5_FIFO_EN with FIFO_CTRL_REG = 0",
        "The code enables the FIFO and leaves it in bypass mode, where it stores nothing. The 32 samples of the "
        "buffer are not used.",
        "L3G4200D, FIFO_CTRL_REG: FM = 000 is bypass",
        "None: each read gives the newest sample.",
        "fifo-bypassed",
        "The FIFO stays off.",
        line=95,
        severity=Severity.NOTE,
    ),
    Defect(
        "GYRO-write-unchecked", "GYRO.c", "Init_GYRO", "the four calls of writeReg",
        "writeReg reads back what it wrote and returns whether the value is there. The four callers ignore the "
        "result. One disturbed byte can leave the sensor in power-down.",
        "GYRO.c: writeReg returns 0 when the value read back differs",
        "The gyro reads 0 since power-up, and the robot takes every turn for driving straight on.",
        "no-effect",
        "The code writes each register up to three times until it reads back the value.",
        line=94,
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-turn-on", "GYRO.c", "Init_GYRO", "from CTRL_REG1 to the first getZ",
        "The code samples directly after the write that ends power-down. The output needs about 300 ms to settle.",
        "L3G4200D turn-on: drivers of its maker's platforms wait 300 ms after power-down",
        "Of the hundred samples for the offset, the first fifteen come from a sensor that is still starting.",
        "startup-read",
        "The task sleeps 300 ms first.",
        line=101,
        depends_on="how long this sensor takes to settle: typically 300 ms",
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-xy-off", "GYRO.c", "Init_GYRO", "CTRL_REG1 = PD | Zen",
        "getX, getY, Offset_GYRO and get_GYRO offer the axes X and Y, but these axes are switched off and read as 0.",
        "L3G4200D, CTRL_REG1: Xen, Yen enable the axes",
        "None in the mission. Any use of X or Y reads 0.",
        "not-configured",
        "All three axes are enabled.",
        line=97,
        severity=Severity.NOTE,
    ),
    Defect(
        "GYRO-sum16", "GYRO.c", "Init_GYRO", "aux += buff[i]",
        "The code adds a hundred samples in 16 bits. The zero-rate level may be 10 deg/s, which is 1143 digits, so "
        "the sum can be 114300. An offset of 328 digits is enough for an overflow.",
        "L3G4200D table 4: zero-rate level +-10 dps at 250 dps; ISO C 6.5 p5: signed overflow",
        "On some robots, or on some days, the offset is wrong and the robot drives curves.",
        "overflow",
        "The sum has 32 bits and starts at 0.",
        line=102,
        depends_on="the zero-rate level of this sensor, which may be up to 10 deg/s",
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-starves-at-start", "GYRO.c", "Init_GYRO", "DelayUs(20000), a hundred times",
        "A task of priority 5 busy-waits for 2 s. No task below it gets the CPU, releases accumulate, and orders are "
        "not read.",
        "TFG 3.4: deadlines of 6.25 ms (orders) to 250 ms (odometry)",
        "For two seconds no frame comes, then eight frames come at once and overwrite each other.",
        "starvation",
        "Task_sleep(20) waits for the same time and leaves the CPU to other tasks.",
        line=104,
        severity=Severity.ERROR,
    ),
    Defect(
        "GYRO-answer-unchecked", "GYRO.c", "getZ", "readReg(OUT_Z_L, temp, 2)",
        "The code takes any two bytes as a rate. If no device answers on the bus, it reads 0xFFFF or 0, which are -1 "
        "and 0 digits. A gyro that has been reset is in power-down and reads the same.",
        "L3G4200D data sheet, CTRL_REG1: PD = 0 after a reset; SPI read of a register",
        "The heading stays constant while the robot turns. A mission turns for 6 s by an angle that nothing measures.",
        "closed-loop",
        "Every 10 ms the code reads CTRL_REG1 back. While it differs from what was written, the rate is 0 and a "
        "mission stops.",
        line=142,
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-bias-unsigned", "GYRO.c", "getZ", "zAxis = zAxis + Z_Calib_b, also in getX and getY",
        "The sample is unsigned when the code adds the bias, and the sum is converted to unsigned again. A turn to "
        "the right becomes 65000 plus bias. For a sum below 0, C does not define the result.",
        "ISO C 6.3.1.4: conversion of a negative float to an unsigned type is undefined",
        "None while the three biases are 0. The first calibration that sets them breaks one direction.",
        "float-to-int",
        "The code makes the sample signed before it adds anything, and limits the sum to the range of int.",
        line=146,
        severity=Severity.NOTE,
    ),
    Defect(
        "GYRO-offset-wraps", "GYRO.c", "getZ", "(int) zAxis - Z_dc_offset",
        "Near full scale the difference does not fit 16 bits and changes its sign.",
        "ISO C 6.5 p5: signed overflow; full scale is 32767 digits, 286.7 deg/s",
        "The robot reads a very fast turn as a fast turn to the other side.",
        "overflow",
        "The difference is limited to the range of int.",
        line=147,
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-temperature-unused", "GYRO.c", "getTemp", "no caller",
        "Nothing calls the function that reads the temperature.",
        "TFG 3.1.2: what the robot takes from the sensor is a rate of turn",
        "None, but it uses flash, and its sign error went unnoticed (GYRO-temperature-sign).",
        "never-called",
        "The function is removed.",
        line=150,
        severity=Severity.NOTE,
    ),
    Defect(
        "GYRO-temperature-sign", "GYRO.c", "getTemp", "44 - temp",
        "The register is a byte in two's complement. A signed char has 16 bits here, so bit 7 counts as 128 and not "
        "as the sign. For a register of -10 the function returns -202 instead of 54.",
        "L3G4200D, OUT_TEMP: 8 bits, two's complement; compiler guide table 6-1: char has 16 bits",
        "Temperatures above 44 degrees read as about -200 degrees.",
        "wrong-result",
        "The code extends the sign from bit 7.",
        gone_with="GYRO-temperature-unused",
        line=156,
        severity=Severity.NOTE,
    ),
    Defect(
        "GYRO-offset-one-sample", "GYRO.c", "Offset_GYRO", "fifty calls of getZ in a row",
        "Fifty reads take two milliseconds. At 100 Hz that is one sample, or two. The mean of fifty reads has the "
        "noise of one sample.",
        "L3G4200D, CTRL_REG1: DR = 00 is 100 Hz, a sample every 10 ms",
        "The offset has the full noise of the sensor, and the heading drifts by about 0.1 deg/s.",
        "stale-sample",
        "The task sleeps 10 ms between two samples.",
        covered_by=("GYRO-offset-moving",),
        line=228,
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-offset-moving", "GYRO.c", "Offset_GYRO", "bias_Gyro = resultZ/50",
        "The code takes the mean of fifty samples as the offset. It does not check whether the robot stood still.",
        "TFG 3.1.2: the offset compensates the error of a robot at rest; L3G4200D table 4: zero-rate level +-10 dps",
        "If somebody holds the robot while it is switched on or calibrated, it takes that turn for rest until the "
        "next calibration.",
        "rotation-bias",
        "If the fifty samples, or those of a calibration, differ by more than 3.5 deg/s, the robot is not at rest. At "
        "the start the code then measures again; a calibration keeps the old offset.",
        line=231,
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-offset-unknown-axis", "GYRO.c", "Offset_GYRO", "return bias_Gyro",
        "For any axis except X, Y and Z the function returns what the stack held.",
        "ISO C 6.7.8 p10",
        "None today.",
        "no-case",
        "For an unknown axis the result is 0.",
        line=235,
        severity=Severity.NOTE,
    ),
    Defect(
        "GYRO-scale", "GYRO.c", "get_GYRO", "250.0 / 32767.0",
        "At a range of 250 deg/s a digit is 8.75 mdps, not 250 / 32767 = 7.63 mdps (32767 digits are 286.7 deg/s). So "
        "every rate is 12.8 % too small.",
        "L3G4200D table 4: sensitivity 8.75 mdps/digit at FS = 250 dps; TFG 3.1.2 repeats the formula",
        "Turns of 90 degrees end at 103 degrees.",
        "rotation-scale",
        "A digit is 8.75 mdps.",
        line=257,
        severity=Severity.ERROR,
    ),
    Defect(
        "GYRO-radians", "GYRO.c", "get_GYRO", "0.0174",
        "Pi / 180 is 0.0174533. The code uses three digits, 0.0174, which is 0.3 % too small.",
        "Arithmetic; TFG 3.1.2",
        "Every turn is wrong by 0.3 %, 1 degree per revolution.",
        "rotation-scale",
        "The factor is 0.01745329.",
        line=258,
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-xy-result", "GYRO.c", "get_GYRO", "return Wabs after case X and case Y",
        "The cases X and Y compute W and return Wabs. Only case Z gives Wabs a value.",
        "ISO C 6.7.8 p10",
        "None in the mission. For X and Y the function returns what the stack held.",
        "uninitialised",
        "Wabs = W in both.",
        line=266,
        severity=Severity.NOTE,
    ),
    Defect(
        "GYRO-clockwise-zero", "GYRO.c", "get_GYRO", "if (W <= 0.01)",
        "The dead band should suppress noise around 0, but it suppresses every negative rate. A turn to the right "
        "reads 0.",
        "L3G4200D figure 2: counter-clockwise is positive, clockwise negative",
        "While the robot turns right it measures no turn, and its controller steers to the left.",
        "rotation-sign",
        "The dead band is +-0.01 rad/s.",
        line=259,
        severity=Severity.ERROR,
    ),
    Defect(
        "GYRO-dead-band", "GYRO.c", "get_GYRO", "if (W <= 0.01)",
        "The code sets rates below 0.01 rad/s (65 digits) to 0. That is 0.57 degrees/s, or 34 degrees in a minute, "
        "which no integrated angle contains. The noise is only 0.2 degrees/s, and its mean is 0.",
        "L3G4200D table 4: rate noise density 0.03 dps/sqrt(Hz)",
        "A robot that slowly drifts to one side takes its course for straight.",
        "rotation-sign",
        "The code uses every rate.",
        line=259,
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-unknown-axis", "GYRO.c", "get_GYRO", "no default in the switch",
        "For any axis except X, Y and Z the function returns what the stack held.",
        "ISO C 6.7.8 p10",
        "None today.",
        "uninitialised",
        "For an unknown axis the result is 0.",
        line=242,
        severity=Severity.NOTE,
    ),
)  # fmt: skip
