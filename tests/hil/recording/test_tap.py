"""A tap between two ports: every byte, both ways, and a log of them."""

from __future__ import annotations

import io
import os
from collections.abc import Iterator

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hil.client.decode import OdometryFrame
from hil.recording.log import Direction, parse_log
from hil.recording.tap import Tap, open_robot
from hil.recording.wire import WireLog
from hil.serial_port import PortError
from hil.serial_port.device_port import DevicePort
from hil.serial_port.pty_port import PtyPort
from tests.hil.waiting import eventually

pytestmark = pytest.mark.skipif(os.name != "posix", reason="pseudo-terminals are a POSIX thing")


class Rig:
    """A robot's pseudo-terminal, a tap, and a console at its end."""

    def __init__(self) -> None:
        # The robot's end is the master of this pair; the tap opens the device.
        self.robot, slave = os.openpty()
        os.set_blocking(self.robot, False)
        self.device: DevicePort = open_robot(os.ttyname(slave))
        os.close(slave)
        self.port = PtyPort()
        self.console = os.open(self.port.device, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        self.file = io.StringIO()
        self.wire = WireLog(self.file, {})
        self.tap = Tap(self.device, self.port, wire=self.wire)

    def read(self, fd: int) -> bytes:
        try:
            return os.read(fd, 65536)
        except BlockingIOError:
            return b""

    def close(self) -> None:
        self.device.close()
        self.port.close()
        os.close(self.robot)
        os.close(self.console)

    def carry(self, fd: int, count: int) -> bytes:
        """Turn until `count` bytes came out at an end."""
        data = bytearray()

        def turn() -> None:
            self.tap.turn()
            data.extend(self.read(fd))

        eventually(lambda: len(data) >= count, turn)
        return bytes(data)


@pytest.fixture
def rig() -> Iterator[Rig]:
    made = Rig()
    yield made
    made.close()


@settings(max_examples=25)
@given(st.lists(st.binary(min_size=1, max_size=200), min_size=1, max_size=6))
def test_every_byte_of_a_console_reaches_the_robot_in_order(pieces: list[bytes]) -> None:
    rig = Rig()
    try:
        for piece in pieces:
            os.write(rig.console, piece)
        data = b"".join(pieces)
        assert rig.carry(rig.robot, len(data)) == data
        rig.wire.end(rig.tap.elapsed_ns)
        recording = parse_log(rig.file.getvalue().encode(), "x")
        assert recording.stream(Direction.TO_ROBOT) == data
        assert rig.tap.bytes_to_robot == len(data)
    finally:
        rig.close()


def test_frames_of_the_robot_reach_the_console_whole(rig: Rig) -> None:
    frames = [OdometryFrame(number, 0, 0, 1, 2, 3).encode() for number in range(20)]
    for frame in frames:
        os.write(rig.robot, frame[:7])
        rig.tap.turn()
        os.write(rig.robot, frame[7:])
        rig.tap.turn()
    data = b"".join(frames)
    assert rig.carry(rig.console, len(data)) == data
    rig.wire.end(rig.tap.elapsed_ns)
    recording = parse_log(rig.file.getvalue().encode(), "x")
    assert recording.stream(Direction.FROM_ROBOT) == data
    assert [record.data for record in recording.records] == frames


def test_a_console_that_does_not_read_finds_the_newest_whole_frames(rig: Rig) -> None:
    frames = [OdometryFrame(number, 0, 0, 1, 2, 3).encode() for number in range(300)]
    for frame in frames:
        os.write(rig.robot, frame)
        eventually(lambda: rig.tap.bytes_from_robot >= sum(map(len, frames[: frames.index(frame) + 1])), rig.tap.turn)  # noqa: B023
    eventually(lambda: rig.port.unread() > 0, rig.tap.turn)
    seen = rig.read(rig.console)
    assert b"".join(frames).endswith(seen)
    assert seen.startswith(b"#")
    assert rig.port.counters.frames_dropped == 300 - seen.count(b"\r")


def test_a_robot_that_takes_nothing_holds_its_console_back(rig: Rig) -> None:
    sent = 0
    try:
        for _ in range(4000):
            sent += os.write(rig.console, b"#STOP\r" * 10)
            rig.tap.turn()
    except BlockingIOError:
        pass
    assert sent < 240_000  # the console's own buffer is full, as at a real port
    taken = b""

    def turn() -> None:
        nonlocal taken
        rig.tap.turn()
        taken += rig.read(rig.robot)

    eventually(lambda: len(taken) >= sent, turn)
    assert taken == (b"#STOP\r" * (sent // 6 + 1))[:sent]


def test_a_robot_whose_device_goes_away_is_one_line(rig: Rig) -> None:
    os.close(rig.robot)
    try:
        with pytest.raises(PortError, match="gone away"):
            rig.tap.run(5.0)
    finally:
        rig.robot = os.open(os.devnull, os.O_RDONLY)


def test_no_such_robot_is_one_line() -> None:
    with pytest.raises(PortError, match="cannot open the serial port /dev/nothing"):
        open_robot("/dev/nothing")
