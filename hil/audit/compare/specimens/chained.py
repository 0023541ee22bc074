"""A range written as in mathematics."""

from __future__ import annotations

from emulator.c28x.language import *


def near(cm: float32) -> int16:
    return (25 < cm) < 90  # DEFECT


def run() -> void:
    near(300.0)
