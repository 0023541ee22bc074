"""A search that relies on finding something: here it finds what stands behind the frame."""

from __future__ import annotations

from emulator.c28x.language import *

frame: array[char, 8] = "0.2\r"
text_behind: array[char, 8] = "1,2"


def comma(text: ptr[char]) -> int16:
    i: int16 = 0

    while text[i] != ",":  # DEFECT
        i += 1
    return i


def run() -> void:
    comma(frame)
