"""sorted_window.c: the median of the last five distances, sorted in a copy."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.c28x.rts import memcpy

N = 5

Window: array[float32, N] = (0.0, 0.0, 0.0, 0.0, 0.0)
Next: uint16 = 0


# sorted_window.c: Add
def Add(distance: float32) -> void:
    Window[Next] = distance
    Next = (Next + 1) % N


# sorted_window.c: Median
def Median() -> float32:
    copy: array[float32, N]
    i: int16
    j: int16
    t: float32
    memcpy(copy, Window, sizeof(Window))
    for i in range(1, N):
        t = copy[i]
        j = i - 1
        while j >= 0 and copy[j] > t:
            copy[j + 1] = copy[j]
            j -= 1
        copy[j + 1] = t
    return copy[N / 2]
