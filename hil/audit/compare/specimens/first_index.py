"""The element before the first one."""

from __future__ import annotations

from emulator.c28x.language import *


def changes(v: ptr[int16], n: uchar) -> int16:
    i: uchar
    count: int16 = 0

    for i in range(n):
        if v[i - 1] != v[i]:  # DEFECT
            count += 1
    return count


def run() -> void:
    v: array[int16, 4] = (1, 1, 2, 2)

    changes(v, 4)
