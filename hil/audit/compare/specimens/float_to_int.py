"""Millimetres beyond an int of 16 bits."""

from __future__ import annotations

from emulator.c28x.language import *


def whole(millimetres: float32) -> int16:
    return int16(millimetres)  # DEFECT


def run() -> void:
    whole(40000.0)
