"""Helpers: put bytes on a line."""

from __future__ import annotations

from hil.client.decode import OdometryFrame
from hil.serial_port import SerialPort
from tests.hil.scripted_machine import BYTE_CYCLES


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
