"""low_pass.c: a first-order low pass in fixed point, Q15, with the rounded half added."""

from __future__ import annotations

from emulator.c28x.language import *

ALPHA = 6554  # 0.2 in Q15

State: int32 = 0


# low_pass.c: Reset_Filter
def Reset_Filter(start: int16) -> void:
    State = int32(start) << 15


# low_pass.c: Filter
def Filter(sample: int16) -> int16:
    error: int32
    error = int32(sample) - (State >> 15)
    State = State + error * ALPHA
    return int16((State + 0x4000) >> 15)


# low_pass.c: Scale
def Scale(sample: int16, shift: uint16) -> int16:
    if shift > 15:
        shift = 15
    return sample >> shift
