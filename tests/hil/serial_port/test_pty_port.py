"""The pseudo-terminal as a program sees it."""

from __future__ import annotations

import os
import select
import subprocess
import sys
import termios
from collections.abc import Iterator
from pathlib import Path

import pytest
import serial
from hypothesis import given, settings
from hypothesis import strategies as st

from hil.client.decode import FrameDecoder, OdometryFrame
from hil.serial_port import Delivery, PortError
from hil.serial_port.frames import PAUSE_CYCLES
from hil.serial_port.pty_port import PtyPort
from tests.hil.serial_port.lines import Robot, frame
from tests.hil.waiting import eventually

pytestmark = pytest.mark.skipif(os.name != "posix", reason="pseudo-terminals are a POSIX thing")


@pytest.fixture
def port() -> Iterator[PtyPort]:
    pty = PtyPort(keep=4)
    yield pty
    pty.close()


def read_all(fd: int) -> bytes:
    """Everything that lies there (a read takes the kernel's work in progress along)."""
    data = b""
    while select.select([fd], [], [], 0)[0]:
        data += os.read(fd, 4096)
    return data


def numbers(data: bytes) -> list[int]:
    return [decoded.x_mm for decoded in FrameDecoder().feed(data)]


def test_it_is_raw_and_without_echo_before_anybody_opens_it(port: PtyPort) -> None:
    fd = os.open(port.device, os.O_RDWR | os.O_NOCTTY)
    lflag = termios.tcgetattr(fd)[3]
    os.close(fd)
    assert lflag & (termios.ECHO | termios.ICANON | termios.ISIG) == 0
    Robot(port).send(frame(1))
    assert port.receive(100) == b""


def test_opened_and_closed_a_hundred_times_every_frame_and_order_passes(port: PtyPort) -> None:
    robot = Robot(port)
    descriptors = len(os.listdir("/dev/fd")) if sys.platform == "linux" else None
    for number in range(100):
        with serial.Serial(port.device, 9600, timeout=0) as line:
            robot.send(frame(number))
            got = bytearray()
            eventually(lambda got=got: got.endswith(b"\r"), lambda got=got, line=line: got.extend(line.read(100)))
            assert bytes(got) == frame(number)
            line.write(b"#STOP\r")
            order = bytearray()
            eventually(lambda order=order: len(order) >= 6, lambda order=order: order.extend(port.receive(64)))
            assert bytes(order) == b"#STOP\r"
    if descriptors is not None:
        assert len(os.listdir("/dev/fd")) == descriptors


def test_when_nobody_reads_the_newest_whole_frames_are_what_a_late_reader_finds(port: PtyPort) -> None:
    robot = Robot(port)
    fd = os.open(port.device, os.O_RDWR | os.O_NOCTTY)
    try:
        number = 0

        def another() -> None:
            nonlocal number
            robot.send(frame(number))
            number += 1

        # Far more than the kernel holds (20 KB are about 900 of these frames), and never a block.
        eventually(lambda: number >= 1500 and port.counters.frames_dropped > 1000, another)
        seen = numbers(read_all(fd))
        # The kernel counts what lies unread with a little delay; then it is four, the newest, in order.
        assert seen == list(range(number - len(seen), number))
        assert len(seen) + port.counters.frames_dropped == number
        eventually(lambda: port.unread() == 0)
    finally:
        os.close(fd)


def test_a_reader_that_took_a_part_of_a_frame_finds_its_rest_and_whole_frames_after_it(port: PtyPort) -> None:
    robot = Robot(port)
    fd = os.open(port.device, os.O_RDWR | os.O_NOCTTY)
    try:
        robot.send(frame(0))
        eventually(lambda: port.unread() > 0)
        assert os.read(fd, 1) == b"#"
        number = 1

        def another() -> None:
            nonlocal number
            robot.send(frame(number))
            number += 1

        eventually(lambda: port.counters.frames_dropped >= 3, another)
        data = read_all(fd)
        assert data.startswith(frame(0)[1:])
        later = numbers(data[len(frame(0)) - 1 :])
        assert 1 <= len(later) <= 4
        assert later == list(range(number - len(later), number))
    finally:
        os.close(fd)


def test_a_fast_writer_is_held_back_until_the_line_has_room(port: PtyPort) -> None:
    fd = os.open(port.device, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    try:
        written = 0

        def write_on() -> None:
            nonlocal written
            while written < 1 << 20:
                written += os.write(fd, b"#SETR0.1,0.2\r" * 32)
                assert port.receive(0) == b""  # the line has no room: nothing may be taken

        with pytest.raises(BlockingIOError):
            write_on()
        assert not select.select([], [fd], [], 0)[1]
        got = 0
        while chunk := port.receive(64):
            assert len(chunk) <= 64
            got += len(chunk)
        eventually(lambda: bool(select.select([], [fd], [], 0)[1]))
        assert got == written
    finally:
        os.close(fd)


def test_an_order_split_anywhere_arrives_in_order(port: PtyPort) -> None:
    with serial.Serial(port.device, 9600, timeout=0) as line:
        for piece in (b"#SETR", b"0.07", b",", b"-0.03", b"\r#ST", b"OP\r"):
            line.write(piece)
        got = bytearray()
        eventually(lambda: len(got) >= 22, lambda: got.extend(port.receive(5)))
        assert bytes(got) == b"#SETR0.07,-0.03\r#STOP\r"


@settings(max_examples=60, deadline=None)
@given(st.lists(st.binary(min_size=1, max_size=300), max_size=8))
def test_any_bytes_pass_unchanged_in_both_directions(chunks: list[bytes]) -> None:
    sent = b"".join(chunks)
    port = PtyPort(keep=64)
    fd = os.open(port.device, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    try:
        got = bytearray()
        for chunk in chunks:
            os.write(fd, chunk)
            got.extend(port.receive(64))
        eventually(lambda: len(got) >= len(sent), lambda: got.extend(port.receive(64)))
        assert bytes(got) == sent
        # The other way, to a listener that keeps up: nothing lost, nothing invented.
        robot = Robot(port)
        heard = bytearray()
        for chunk in chunks:
            for start in range(0, len(chunk), 50):
                robot.send(chunk[start : start + 50])
                heard.extend(read_all(fd))
        robot.pause(PAUSE_CYCLES)
        eventually(lambda: len(heard) >= len(sent), lambda: heard.extend(read_all(fd)))
        assert bytes(heard) == sent
        assert port.counters.frames_dropped == 0
    finally:
        os.close(fd)
        port.close()


def test_byte_delivery_shows_a_frame_growing() -> None:
    port = PtyPort(deliver=Delivery.BYTES)
    fd = os.open(port.device, os.O_RDWR | os.O_NOCTTY)
    try:
        robot = Robot(port)
        robot.send(frame(5)[:8])
        data = bytearray()
        eventually(lambda: len(data) >= 8, lambda: data.extend(read_all(fd)))
        assert bytes(data) == frame(5)[:8]
    finally:
        os.close(fd)
        port.close()


def test_a_program_that_claims_the_terminal_and_leaves_locks_nobody_out(port: PtyPort) -> None:
    import fcntl

    fd = os.open(port.device, os.O_RDWR | os.O_NOCTTY)
    fcntl.ioctl(fd, termios.TIOCEXCL)
    os.close(fd)
    port.transmit(0)
    if sys.platform == "linux":
        tiocgexcl = 0x80045440
        fd = os.open(port.device, os.O_RDWR | os.O_NOCTTY)
        assert fcntl.ioctl(fd, tiocgexcl, b"\0\0\0\0") == b"\0\0\0\0"
        os.close(fd)


class TestLink:
    """The stable name."""

    def test_it_leads_to_the_terminal_and_goes_with_the_port(self, tmp_path: Path) -> None:
        port = PtyPort(tmp_path / "COM3", link_records=tmp_path / "records")
        assert os.readlink(tmp_path / "COM3") == port.device
        with serial.Serial(str(tmp_path / "COM3"), 9600):
            pass
        port.close()
        assert not os.path.lexists(tmp_path / "COM3")

    @pytest.mark.parametrize("kind", ["file", "folder", "link", "dangling link"])
    def test_what_is_not_ours_is_never_touched(self, tmp_path: Path, kind: str) -> None:
        name = tmp_path / "COM3"
        if kind == "file":
            name.write_text("mine")
        elif kind == "folder":
            name.mkdir()
        else:
            name.symlink_to("/dev/null" if kind == "link" else "/dev/pts/99999")
        before = os.lstat(name)
        with pytest.raises(PortError, match="COM3: exists and is not a link of ours"):
            PtyPort(name, link_records=tmp_path / "records")
        assert os.lstat(name).st_ino == before.st_ino

    def test_the_link_of_a_running_robot_is_refused(self, tmp_path: Path) -> None:
        first = PtyPort(tmp_path / "COM3", link_records=tmp_path / "records")
        with pytest.raises(PortError, match="a robot that is running"):
            PtyPort(tmp_path / "COM3", link_records=tmp_path / "records")
        assert os.readlink(tmp_path / "COM3") == first.device
        first.close()

    def test_the_stale_link_of_a_killed_robot_is_replaced(self, tmp_path: Path) -> None:
        # A killed process leaves link and record, and the system gives back its lock.
        program = (
            "import os, sys; from pathlib import Path; from hil.serial_port.pty_port import PtyPort\n"
            "port = PtyPort(Path(sys.argv[1]) / 'COM3', link_records=Path(sys.argv[1]) / 'records')\n"
            "os._exit(0)"
        )
        subprocess.run([sys.executable, "-c", program, str(tmp_path)], check=True, timeout=60)
        assert os.path.islink(tmp_path / "COM3")
        port = PtyPort(tmp_path / "COM3", link_records=tmp_path / "records")
        assert os.readlink(tmp_path / "COM3") == port.device
        port.close()

    def test_a_file_put_in_its_place_is_not_removed(self, tmp_path: Path) -> None:
        port = PtyPort(tmp_path / "COM3", link_records=tmp_path / "records")
        (tmp_path / "COM3").unlink()
        (tmp_path / "COM3").write_text("mine")
        port.close()
        assert (tmp_path / "COM3").read_text() == "mine"

    def test_a_missing_folder_is_one_clear_line(self, tmp_path: Path) -> None:
        with pytest.raises(PortError, match="cannot create the link"):
            PtyPort(tmp_path / "no" / "COM3", link_records=tmp_path / "records")


def test_frames_of_the_line_equal_what_the_decoder_sees(port: PtyPort) -> None:
    with serial.Serial(port.device, 9600, timeout=0) as line:
        Robot(port).send(OdometryFrame(-32768, 32767, -3, 1, 2, 3).encode())
        decoder = FrameDecoder()
        frames: list[OdometryFrame] = []
        eventually(lambda: bool(frames), lambda: frames.extend(decoder.feed(line.read(100))))
    assert frames == [OdometryFrame(-32768, 32767, -3, 1, 2, 3)]
