"""The middle of an even number of values, one too high."""

from __future__ import annotations

from emulator.c28x.language import *


def middle(sorted: ptr[float32], n: int16) -> float32:
    if n % 2:
        return sorted[n / 2]
    return (sorted[n / 2] + sorted[n / 2 + 1]) / 2  # DEFECT
