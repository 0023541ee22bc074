"""memcpy counted in octets: right on a PC, twice too long on this chip."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.c28x.rts import memcpy


def last(v: ptr[float32], n: int16) -> float32:
    copy: array[float32, 20]

    memcpy(copy, v, 4 * n)  # DEFECT
    return copy[n - 1]


def run() -> void:
    v: array[float32, 13] = (0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0)

    last(v, 13)
