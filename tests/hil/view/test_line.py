"""The line as the console panel sees it."""

from __future__ import annotations

import os
import select

import pytest

from hil.client.decode import OdometryFrame
from hil.recording.trajectory import parse_trajectory
from hil.serial_url import PortError
from hil.view.line import MAX_ENTRIES, LineLog, SerialPortLine
from tests.hil.waiting import eventually

FRAME = OdometryFrame(1, -2, 3, 1922, 427, 650)


def read_from_line(master: int, count: int) -> bytes:
    """The next ``count`` bytes: a read may give a part, as the kernel moves the bytes of a pseudo-terminal later."""
    data = b""
    while len(data) < count:
        assert select.select([master], [], [], 20)[0], f"only {data!r} came"
        data += os.read(master, count - len(data))
    return data


def test_frames_and_orders_are_numbered_in_order() -> None:
    log = LineLog()
    log.received(FRAME.encode()[:9], 1.0)
    log.sent(b"#STOP\r", 1.1)
    log.received(FRAME.encode()[9:], 1.2)
    assert [(e.number, e.text, e.to_robot) for e in log.entries_since(0)] == [
        (0, "#STOP", True), (1, "#ODO 1,-2,3,1922,427,650", False),
    ]  # fmt: skip
    assert log.frames_since(0) == [FRAME]
    assert log.frames_since(1) == []
    assert log.entries_since(1)[0].number == 1


def test_what_is_kept_is_bounded_and_the_newest() -> None:
    log = LineLog()
    for number in range(MAX_ENTRIES + 10):
        log.received(OdometryFrame(number, 0, 0, 0, 0, 0).encode(), float(number))
    kept = log.entries_since(0)
    assert len(kept) == MAX_ENTRIES
    assert kept[-1].number == MAX_ENTRIES + 9
    assert log.last_frame() == OdometryFrame(MAX_ENTRIES + 9, 0, 0, 0, 0, 0)


def test_frames_are_bounded_too_and_keep_their_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("hil.view.line.MAX_FRAMES", 5)
    log = LineLog()
    frames = [OdometryFrame(number, -number, 0, 32767, -32768, 1) for number in range(23)]
    for frame in frames:
        log.received(frame.encode(), 0.0)
    kept = log.frames_since(0)
    assert 5 <= len(kept) < 10
    assert kept == frames[-len(kept) :]
    assert log.frames_since(21) == frames[21:]
    assert log.frames_since(23) == []


def test_a_stream_without_frame_ends_is_cut_and_shown() -> None:
    log = LineLog()
    log.received(b"\xff" * 1000, 0.0)
    assert len(log.entries_since(0)) == 3
    assert log.entries_since(0)[0].text.startswith("\\xff")


def test_clearing_begins_another_epoch_with_numbers_that_go_on() -> None:
    log = LineLog()
    log.received(FRAME.encode(), 0.0)
    log.clear()
    assert (log.epoch, log.entries_since(0), log.frames_since(0)) == (1, [], [])
    log.received(FRAME.encode(), 0.0)
    assert log.frames_since(1) == [FRAME]


@pytest.mark.skipif(os.name != "posix", reason="needs a pseudo-terminal")
def test_a_serial_port_carries_bytes_both_ways_and_its_end_is_told() -> None:
    master, slave = os.openpty()
    line = SerialPortLine(os.ttyname(slave))
    os.close(slave)
    line.write(b"#MISN\r")
    assert read_from_line(master, 6) == b"#MISN\r"
    os.write(master, FRAME.encode())
    eventually(lambda: line.log.frames_since(0), line.turn, what="a frame")
    assert line.log.frames_since(0) == [FRAME]
    os.close(master)
    eventually(lambda: line.failure, line.turn, what="the end of the port")
    assert "the port has gone away" in line.failure
    assert not line.flowing
    line.close()
    assert line.log.bytes_to_robot == len(b"#MISN\r")


@pytest.mark.skipif(os.name != "posix", reason="needs a pseudo-terminal")
def test_whoever_closes_the_port_stops_the_robot() -> None:
    master, slave = os.openpty()
    line = SerialPortLine(os.ttyname(slave))
    line.write(b"#MISN\r")
    line.close()
    assert read_from_line(master, 12) == b"#MISN\r#STOP\r"
    os.close(slave)
    os.close(master)


def test_a_port_that_is_not_there_is_one_line() -> None:
    with pytest.raises(PortError, match=r"^cannot open the serial port /dev/nothing: .*$"):
        SerialPortLine("/dev/nothing")


@pytest.mark.parametrize(
    ("orders", "ended"),
    [
        ([], False),
        (["#TELE", "#SETR0.1,0.0"], False),
        (["#MISN", "#TELE"], False),
        (["#TELE", "#SETR0.1,0.0", "#STOP"], True),
        (["#CALB", "#SETR0.1,0.0"], True),
    ],
)
def test_any_other_order_ends_driving_by_hand(orders: list[str], ended: bool) -> None:
    pytest.importorskip("nicegui", reason="needs the extra view (NiceGUI)")
    from hil.robot.view.console_panel import ended_by_others

    log = LineLog()
    for text in orders:
        log.sent(f"{text}\r".encode(), 0.0)
        log.received(FRAME.encode(), 0.0)
    assert ended_by_others(log.entries_since(0)) is ended


def test_the_file_of_points_is_the_consoles_own() -> None:
    pytest.importorskip("nicegui", reason="needs the extra view (NiceGUI)")
    from hil.robot.view.console_panel import file_of

    frames = [FRAME, OdometryFrame(-32768, 32767, 0, 0, 0, 0)]
    data = file_of(frames)
    # Annex 2: headings X,Y,theta,dF,dR,dL, then six numbers a line.
    assert data.splitlines()[:2] == [b"X,Y,theta,dF,dR,dL", b"1,-2,3,1922,427,650"]
    assert parse_trajectory(data).frames == frames
