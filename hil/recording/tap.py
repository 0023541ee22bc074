"""A tap between a robot's port and the port of a PC program.  It passes every byte on, and tells a `WireListener`.

    robot  <->  DevicePort  <->  Tap  <->  SerialPort  <->  PC program

Towards the PC program it does what the robot's own port does: it delivers whole frames, and drops the oldest if nobody
reads (`hil.serial_port.frames`).  Towards the robot nothing is dropped: the program is read only as fast as the robot's
device accepts bytes.

Times are those of this computer when the bytes were read.  An adapter may have had them for some time (the latency
timer of an FTDI: 16 ms).
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

#: The longest wait for bytes, in seconds.
TURN_S: Final = 0.005
#: The wait if a port has to be polled, because the system cannot wait for it: two byte times of the line.
POLL_S: Final = 0.002
#: The most bytes that wait for the robot.  A robot that accepts orders never lets more wait.
_ROOM: Final = 64
_CHUNK: Final = 4096


def open_robot(device: str) -> DevicePort:
    """Open the robot's port for a tap.  Written bytes leave one by one.  Raises PortError."""
    return DevicePort(device, keep=_ROOM, deliver=Delivery.BYTES)


class Tap:
    """Connects two ports."""

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
        """The time since the tap was created, in nanoseconds."""
        return self._monotonic_ns() - self._began_ns

    @property
    def elapsed_s(self) -> float:
        """The time since the tap was created, in seconds."""
        return self.elapsed_ns / 1e9

    def stop(self) -> None:
        """End `run` after the present turn.  Safe in a signal handler."""
        self._stop = True

    def run(self, duration_s: float | None = None) -> None:
        """Pass bytes on for a time, or until `stop` is called.  Raises PortError when a device is removed."""
        while not self._stop and (duration_s is None or self.elapsed_s < duration_s):
            self._wait()
            self.turn()
            if self._tick is not None:
                self._tick(self)

    def turn(self) -> None:
        """Pass on the bytes that have arrived."""
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
        # While the robot accepts nothing, its program is not read; its bytes are no reason to look again at once.
        held_back = self.robot.outbound.has_piece
        robot, console = self.robot.wait_fds(), self.console.wait_fds()
        # A port without a descriptor (Windows, rfc2217://) must be polled, and so must one that accepts nothing.
        must_ask = held_back or not robot or not console
        wait_readable([*robot, *(() if held_back else console)], POLL_S if must_ask else TURN_S)
