"""A dead band that takes every turn to the right."""

from __future__ import annotations

from emulator.c28x.language import *


def turn(rate: float32) -> float32:
    if rate <= 0.01:  # DEFECT
        return 0
    return rate
