"""A tap between a robot's port and the port of a PC program: carries every byte both ways and tells a `WireListener`.

    robot  <->  DevicePort  <->  Tap  <->  SerialPort  <->  PC program

Towards the PC program it does what the robot's own port does: frames are handed over whole, and when nobody reads, the
oldest give way (`hil.serial_port.frames`).  Towards the robot nothing gives way: the program is read only as fast as
the robot's device takes bytes.

Times are this computer's, when the bytes were read; an adapter may have had them for a while (an FTDI's latency timer:
16 ms).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Final

from hil.pacing import wait_readable
from hil.recording.wire import WireListener
from hil.serial_port import Delivery, SerialPort
from hil.serial_port.device_port import DevicePort
from hil.session import NS_PER_CYCLE

#: How long nothing is looked at when nothing comes.
TURN_S: Final = 0.005
#: The same while a port that the system cannot wait for must be asked: two byte times of the line.
POLL_S: Final = 0.002
#: A robot that takes orders never lets more wait than this.
_ROOM: Final = 64
_CHUNK: Final = 4096


def open_robot(device: str) -> DevicePort:
    """The robot's port, for a tap: what is written leaves byte by byte.  Raises PortError."""
    return DevicePort(device, keep=_ROOM, deliver=Delivery.BYTES)


class Tap:
    """Two ports joined."""

    def __init__(
        self,
        robot: SerialPort,
        console: SerialPort,
        *,
        wire: WireListener | None = None,
        tick: Callable[[Tap], None] | None = None,
        monotonic_ns: Callable[[], int] = time.monotonic_ns,
    ) -> None:
        """`robot` comes from `open_robot`; `tick` is called after every turn."""
        self.robot = robot
        self.console = console
        self.bytes_from_robot = 0
        self.bytes_to_robot = 0
        self._wire = wire
        self._tick = tick
        self._monotonic_ns = monotonic_ns
        self._began_ns = monotonic_ns()
        self._stop = False

    @property
    def elapsed_ns(self) -> int:
        """Time since the tap was made."""
        return self._monotonic_ns() - self._began_ns

    @property
    def elapsed_s(self) -> float:
        """The same in seconds."""
        return self.elapsed_ns / 1e9

    def stop(self) -> None:
        """End `run` after the present turn.  Safe in a signal handler."""
        self._stop = True

    def run(self, duration_s: float | None = None) -> None:
        """Carry bytes for a time, or until `stop`.  Raises PortError when a device goes away."""
        while not self._stop and (duration_s is None or self.elapsed_s < duration_s):
            self._wait()
            self.turn()
            if self._tick is not None:
                self._tick(self)

    def turn(self) -> None:
        """Carry what lies there."""
        data = self.robot.receive(_CHUNK)
        now_ns = self.elapsed_ns
        cycles = now_ns // NS_PER_CYCLE
        if data:
            self.bytes_from_robot += len(data)
            if self._wire is not None:
                self._wire.from_robot(data, now_ns)
            for byte in data:
                self.console.robot_sent(byte, cycles)
        self.console.transmit(cycles)
        if not self.robot.outbound.has_piece:
            order = self.console.receive(_ROOM)
            if order:
                self.feed(order)
        self.robot.transmit(cycles)

    def feed(self, data: bytes) -> None:
        """Send bytes to the robot."""
        now_ns = self.elapsed_ns
        self.bytes_to_robot += len(data)
        if self._wire is not None:
            self._wire.to_robot(data, now_ns)
        for byte in data:
            self.robot.robot_sent(byte, now_ns // NS_PER_CYCLE)

    def _wait(self) -> None:
        # A robot that takes nothing leaves its program unread: that is no reason to turn at once.
        held_back = self.robot.outbound.has_piece
        robot, console = self.robot.wait_fds(), self.console.wait_fds()
        # A port without a descriptor (Windows, rfc2217://) must be asked, and so must one that takes nothing.
        must_ask = held_back or not robot or not console
        wait_readable([*robot, *(() if held_back else console)], POLL_S if must_ask else TURN_S)
