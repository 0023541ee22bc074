"""A sum without a first value."""

from __future__ import annotations

from emulator.c28x.language import *


def average(v: ptr[float32], n: int16) -> float32:
    sum: float32
    i: int16

    for i in range(n):
        sum += v[i]  # DEFECT
    return sum / n


def run() -> void:
    v: array[float32, 3] = (1.0, 2.0, 3.0)

    average(v, 3)
