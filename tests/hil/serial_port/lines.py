"""Helpers: put bytes on a line, and wait for what the system does on its own without fixed pauses."""

from __future__ import annotations

import time
from collections.abc import Callable

from hil.client.decode import OdometryFrame
from hil.serial_port import SerialPort

#: One byte time of 9600 baud in cycles of 200 MHz.
BYTE_CYCLES = 208_333
#: A test that waits longer has failed; nothing is asserted about times below it.
PATIENCE_S = 20.0


class Robot:
    """Sends bytes back to back, keeping the line's time."""

    def __init__(self, port: SerialPort) -> None:
        self.port = port
        self.now = 0

    def send(self, data: bytes) -> None:
        for byte in data:
            self.now += BYTE_CYCLES
            self.port.robot_sent(byte, self.now)
        self.port.transmit(self.now)

    def pause(self, cycles: int) -> None:
        self.now += cycles
        self.port.transmit(self.now)


def frame(number: int) -> bytes:
    return OdometryFrame(number, 0, 0, 1, 2, 3).encode()


def eventually(condition: Callable[[], bool], turn: Callable[[], object] = lambda: None) -> None:
    """Take turns until `condition` holds."""
    limit = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < limit, "it did not happen"
        turn()
