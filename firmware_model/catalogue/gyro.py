"""Defects of GYRO.c, in the order of its lines."""

from __future__ import annotations

from typing import Final

from emulator.rules import Severity
from firmware_model.catalogue.defect import Defect

DEFECTS: Final[tuple[Defect, ...]] = (
    Defect(
        "GYRO-global-names", "GYRO.c", "readReg", "int i, int aux, char temp at file scope",
        "Working variables of one function are global symbols of the program, under its shortest names. Seven functions "
        "hide i or temp with a local of their own; the one that forgets to changes Init_GYRO's index.",
        "ISO C 6.2.1: scope; main_Robot.c has its own globals of one letter",
        "None today: link errors, or a wrong offset, for the next driver that says int i.",
        "hidden-name", "The loop counter is the index; the global names go.",
        line=193,
        severity=Severity.NOTE,
    ),
    Defect(
        "GYRO-fifo-bypassed", "GYRO.c", "Init_GYRO", "REG5_FIFO_EN with FIFO_CTRL_REG = 0",
        "The FIFO is enabled and left in bypass, where it holds nothing: 32 samples of buffer are switched on and not used.",
        "L3G4200D, FIFO_CTRL_REG: FM = 000 is bypass", "None: each read gives the newest sample.",
        "fifo-bypassed", "The FIFO stays off.",
        line=95,
        severity=Severity.NOTE,
    ),
    Defect(
        "GYRO-write-unchecked", "GYRO.c", "Init_GYRO", "the four calls of writeReg",
        "writeReg reads back what it wrote and says whether it was kept; nobody looks. One disturbed byte leaves the "
        "sensor in power-down.",
        "GYRO.c: writeReg returns 0 when the value read back differs",
        "A robot that drives straight on in every turn because its gyro reads 0 since power-up.",
        "no-effect", "Each register is written up to three times until it reads back.",
        line=94,
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-turn-on", "GYRO.c", "Init_GYRO", "from CTRL_REG1 to the first getZ",
        "Sampling starts right behind the write that ends power-down; the output settles for some 300 ms.",
        "L3G4200D turn-on: drivers of its maker's platforms wait 300 ms after power-down",
        "The first fifteen of a hundred samples of the offset are of a sensor that is still starting.",
        "startup-read", "Sleep 300 ms first.",
        line=101,
        depends_on="how long this sensor takes to settle: typically 300 ms",
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-xy-off", "GYRO.c", "Init_GYRO", "CTRL_REG1 = PD | Zen",
        "X and Y are exported by getX, getY, Offset_GYRO and get_GYRO, and are switched off: they read as standing still.",
        "L3G4200D, CTRL_REG1: Xen, Yen enable the axes", "None in the mission; any use of X or Y reads 0.",
        "not-configured", "All three axes are enabled.",
        line=97,
        severity=Severity.NOTE,
    ),
    Defect(
        "GYRO-sum16", "GYRO.c", "Init_GYRO", "aux += buff[i]",
        "A hundred samples are added in 16 bits. The zero-rate level may be 10 deg/s, 1143 digits: the sum is 114300, "
        "and 328 digits are enough to overflow.",
        "L3G4200D table 4: zero-rate level +-10 dps at 250 dps; ISO C 6.5 p5: signed overflow",
        "On some robots, or some days, the offset is that of another sensor and the robot drives curves.",
        "overflow", "The sum has 32 bits and starts at 0.",
        line=102,
        depends_on="the zero-rate level of this sensor, which may be up to 10 deg/s",
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-starves-at-start", "GYRO.c", "Init_GYRO", "DelayUs(20000), a hundred times",
        "A busy wait of 2 s in a task of priority 5: everything below it gets no processor, releases pile up, orders "
        "are not read.",
        "TFG 3.4: deadlines of 6.25 ms (orders) to 250 ms (odometry)",
        "Two seconds without a frame, then eight of them at once over each other.",
        "starvation", "Task_sleep(20): the same wait, and the processor is free.",
        line=104,
        severity=Severity.ERROR,
    ),
    Defect(
        "GYRO-answer-unchecked", "GYRO.c", "getZ", "readReg(OUT_Z_L, temp, 2)",
        "Two octets are a rate whoever sent them. A bus on which nobody answers gives 0xFFFF or 0, which are -1 and 0 "
        "digits, and so does a gyro that has been reset and sleeps.",
        "L3G4200D data sheet, CTRL_REG1: PD = 0 after a reset; SPI read of a register",
        "The heading stands still while the robot turns; a mission turns for 6 s by an angle that nobody measures.",
        "closed-loop",
        "Every 10 ms CTRL_REG1 is read back; as long as it is not what was written the rate is 0 and a mission stands.",
        line=142,
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-bias-unsigned", "GYRO.c", "getZ", "zAxis = zAxis + Z_Calib_b, also in getX and getY",
        "The sample is unsigned when the bias is added, and the sum goes back to unsigned: a turn to the right is 65000 "
        "plus bias, and a sum below 0 has no value.",
        "ISO C 6.3.1.4: conversion of a negative float to an unsigned type is undefined",
        "None while the three biases are 0; the first calibration through them breaks one direction.",
        "float-to-int", "The sample is signed before anything is added, and held within an int after.",
        line=146,
        severity=Severity.NOTE,
    ),
    Defect(
        "GYRO-offset-wraps", "GYRO.c", "getZ", "(int) zAxis - Z_dc_offset",
        "Near full scale the difference leaves 16 bits and comes back with the other sign.",
        "ISO C 6.5 p5: signed overflow; full scale is 32767 digits, 286.7 deg/s",
        "A very fast turn is read as a fast turn the other way.",
        "overflow", "The difference is held within an int.",
        line=147,
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-temperature-unused", "GYRO.c", "getTemp", "no caller",
        "Nothing asks for the temperature.", "TFG 3.1.2: what the robot takes from the sensor is a rate of turn",
        "None but for flash, and a sign that nobody noticed (GYRO-temperature-sign).",
        "never-called", "It goes.",
        line=150,
        severity=Severity.NOTE,
    ),
    Defect(
        "GYRO-temperature-sign", "GYRO.c", "getTemp", "44 - temp",
        "The register is an octet in two's complement; a signed char has 16 bits here, so its sign bit is a value of 128. "
        "A register of -10 gives -202 instead of 54.",
        "L3G4200D, OUT_TEMP: 8 bits, two's complement; compiler guide table 6-1: char has 16 bits",
        "Temperatures above 44 degrees read as hundreds of degrees of frost.",
        "wrong-result", "The sign is extended from bit 7.", gone_with="GYRO-temperature-unused",
        line=156,
        severity=Severity.NOTE,
    ),
    Defect(
        "GYRO-offset-one-sample", "GYRO.c", "Offset_GYRO", "fifty calls of getZ in a row",
        "Fifty reads take two milliseconds; at 100 Hz they see one sample, or two. The mean of fifty is the noise of one.",
        "L3G4200D, CTRL_REG1: DR = 00 is 100 Hz, a sample every 10 ms",
        "An offset with the full noise of the sensor: some 0.1 deg/s that the heading drifts by.",
        "stale-sample", "10 ms of sleep between two samples.",
        covered_by=("GYRO-offset-moving",),
        line=228,
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-offset-moving", "GYRO.c", "Offset_GYRO", "bias_Gyro = resultZ/50",
        "The mean of fifty samples is the offset, whatever they are. Nobody looks whether the robot stood meanwhile.",
        "TFG 3.1.2: the offset compensates the error of a robot at rest; L3G4200D table 4: zero-rate level +-10 dps",
        "Switched on, or calibrated, in somebody's hands, the robot takes a turn for rest until the next calibration.",
        "rotation-bias",
        "Fifty samples that differ by more than 3.5 deg/s, or a calibration's, are of no robot at rest: at the start it "
        "measures again, and a calibration leaves the offset as it was.",
        line=231,
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-offset-unknown-axis", "GYRO.c", "Offset_GYRO", "return bias_Gyro",
        "For any axis but the three, the result is what the stack held.", "ISO C 6.7.8 p10", "None today.",
        "no-case", "The result is 0.",
        line=235,
        severity=Severity.NOTE,
    ),
    Defect(
        "GYRO-scale", "GYRO.c", "get_GYRO", "250.0 / 32767.0",
        "A digit is 8.75 mdps at a range of 250 deg/s, not 250 / 32767 = 7.63: full scale is 286.7 deg/s. Every rate is "
        "12.8 % too small.",
        "L3G4200D table 4: sensitivity 8.75 mdps/digit at FS = 250 dps; TFG 3.1.2 repeats the formula",
        "Turns of 90 degrees end at 103.",
        "rotation-scale", "8.75 mdps a digit.",
        line=257,
        severity=Severity.ERROR,
    ),
    Defect(
        "GYRO-radians", "GYRO.c", "get_GYRO", "0.0174",
        "Pi / 180 is 0.0174533: three digits lose 0.3 %.", "Arithmetic; TFG 3.1.2",
        "0.3 % of every turn, 1 degree a revolution.", "rotation-scale", "0.01745329.",
        line=258,
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-xy-result", "GYRO.c", "get_GYRO", "return Wabs after case X and case Y",
        "X and Y compute W and return Wabs, which only Z gives a value.", "ISO C 6.7.8 p10",
        "None in the mission; X and Y return what the stack held.", "uninitialised", "Wabs = W in both.",
        line=266,
        severity=Severity.NOTE,
    ),
    Defect(
        "GYRO-clockwise-zero", "GYRO.c", "get_GYRO", "if (W <= 0.01)",
        "The dead band is meant for noise about 0 and takes every negative rate: a turn to the right reads 0.",
        "L3G4200D figure 2: counter-clockwise is positive, clockwise negative",
        "The robot believes to stand still while it turns right, and controls towards the left.",
        "rotation-sign", "The dead band is +-0.01 rad/s.",
        line=259,
        severity=Severity.ERROR,
    ),
    Defect(
        "GYRO-dead-band", "GYRO.c", "get_GYRO", "if (W <= 0.01)",
        "Rates below 0.01 rad/s, 65 digits, are set to 0. That is 0.57 degrees a second, 34 degrees a minute, which no "
        "integrated angle ever sees; the noise is 0.2 degrees/s and has no mean.",
        "L3G4200D table 4: rate noise density 0.03 dps/sqrt(Hz)",
        "A robot that bends slowly to one side takes its course for straight.",
        "rotation-sign", "Every rate counts.",
        line=259,
        severity=Severity.WARNING,
    ),
    Defect(
        "GYRO-unknown-axis", "GYRO.c", "get_GYRO", "no default in the switch",
        "For any axis but the three, the result is what the stack held.", "ISO C 6.7.8 p10", "None today.",
        "uninitialised", "The result is 0.",
        line=242,
        severity=Severity.NOTE,
    ),
)  # fmt: skip
