"""A peripheral whose clock is off."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import SpiaRegs


def run() -> void:
    SpiaRegs.SPIBRR.bit.SPI_BIT_RATE = 49  # DEFECT
