"""A search that relies on finding something."""

from __future__ import annotations

from emulator.c28x.language import *


def comma(text: ptr[char]) -> int16:
    i: int16 = 0

    while text[i] != ",":  # DEFECT
        i += 1
    return i


def run() -> void:
    frame: array[char, 8] = "0.2\r"

    comma(frame)
