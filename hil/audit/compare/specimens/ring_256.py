"""A ring that relies on a char of 8 bits to come round."""

from __future__ import annotations

from emulator.c28x.language import *

ring: array[int16, 256]
head: uchar = 0


def put(value: int16) -> void:
    ring[head] = value  # DEFECT
    head += 1


def run() -> void:
    i: int16

    for i in range(300):
        put(i)
