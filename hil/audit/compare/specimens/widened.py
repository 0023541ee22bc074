"""A product widened after it was cut to 16 bits."""

from __future__ import annotations

from emulator.c28x.language import *


def area(width: uint16, height: uint16) -> int32:
    return width * height  # DEFECT


def run() -> void:
    area(300, 300)
