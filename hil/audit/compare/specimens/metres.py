"""Millimetres straight on, metres in a turn."""

from __future__ import annotations

from emulator.c28x.language import *


def way(speed: float32, rate: float32, period_ms: float32) -> float32:
    angle: float32

    angle = rate * period_ms / 1000
    if rate == 0:
        return speed * period_ms
    return speed / rate * angle  # DEFECT
