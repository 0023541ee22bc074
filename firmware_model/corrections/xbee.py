"""XBee.c: what a corrected protocol.c asks of it."""

from __future__ import annotations

from emulator.c28x.language import *
from firmware_model.board_support.xbee import Tx_Count


# XBee.c: Frame_Leaving
def Frame_Leaving() -> char:
    return Tx_Count > 0
