"""An integrator that points nowhere."""

from __future__ import annotations

from emulator.c28x.language import *

integral: ptr[float32] = NULL


def integrate(error: float32) -> float32:
    integral[0] = integral[0] + error  # DEFECT
    return integral[0]


def run() -> void:
    integrate(1.0)
