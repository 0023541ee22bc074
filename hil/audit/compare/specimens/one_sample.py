"""Fifty reads of one sample."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import DelayUs
from firmware_model.gyro import Init_GYRO, getZ


def offset() -> float32:
    sum: float32 = 0
    i: int16

    for i in range(50):
        sum += getZ()  # DEFECT
    return sum / 50


def run() -> void:
    Init_GYRO()
    DelayUs(50000)
    offset()
