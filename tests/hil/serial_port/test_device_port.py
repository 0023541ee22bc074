"""An existing serial device; here the far end of a pseudo-terminal stands for it."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest

from hil.serial_port import PortError, open_port
from hil.serial_port.device_port import DevicePort
from tests.hil.serial_port.lines import Robot, frame
from tests.hil.waiting import eventually

pytestmark = pytest.mark.skipif(os.name != "posix", reason="needs a pseudo-terminal as stand-in")


@pytest.fixture
def far_end() -> Iterator[tuple[int, str]]:
    master, slave = os.openpty()
    os.set_blocking(master, False)
    yield master, os.ttyname(slave)
    for fd in (master, slave):
        os.close(fd)


def read(fd: int) -> bytes:
    try:
        return os.read(fd, 4096)
    except BlockingIOError:
        return b""


def test_bytes_pass_in_both_directions(far_end: tuple[int, str]) -> None:
    master, name = far_end
    port = open_port(device=name)
    Robot(port).send(frame(1))
    got = bytearray()
    eventually(lambda: bytes(got) == frame(1), lambda: got.extend(read(master)))
    os.write(master, b"#MISN\r")
    order = bytearray()
    eventually(lambda: bytes(order) == b"#MISN\r", lambda: order.extend(port.receive(4)))
    assert port.address == name
    port.close()


def test_a_device_that_takes_nothing_never_blocks_and_later_gets_whole_frames(far_end: tuple[int, str]) -> None:
    master, name = far_end
    port = DevicePort(name, keep=4)
    robot = Robot(port)
    number = 0

    def another() -> None:
        nonlocal number
        robot.send(frame(number))
        number += 1

    eventually(lambda: port.counters.frames_dropped > 20, another)
    got = bytearray()

    def read_on() -> None:
        got.extend(read(master))
        port.transmit(robot.now)

    eventually(lambda: got.endswith(frame(number - 1)), read_on)
    assert got.count(b"#") == got.count(b"\r") == number - port.counters.frames_dropped
    port.close()


def test_a_device_that_is_not_there_is_one_clear_line() -> None:
    with pytest.raises(PortError, match="cannot open the serial port /dev/no-such-port"):
        open_port(device="/dev/no-such-port")


def test_a_device_that_goes_away_is_said_so() -> None:
    master, slave = os.openpty()
    port = DevicePort(os.ttyname(slave))
    os.close(slave)
    os.close(master)
    with pytest.raises(PortError, match="has gone away"):
        eventually(lambda: False, lambda: port.receive(10))
    port.close()
