"""A sum that 16 bits do not hold."""

from __future__ import annotations

from emulator.c28x.language import *


def mean(v: ptr[int16], n: int16) -> int16:
    sum: int16 = 0
    i: int16

    for i in range(n):
        sum += v[i]  # DEFECT
    return sum / n


def run() -> void:
    v: array[int16, 100]
    i: int16

    for i in range(100):
        v[i] = 400
    mean(v, 100)
