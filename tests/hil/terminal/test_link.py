"""The line under the console: orders byte for byte, whatever comes, nothing without bound."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterator

import pytest

from hil.client.decode import OdometryFrame
from hil.client.orders import order, set_reference
from hil.terminal import link as link_module
from hil.terminal.link import MAX_EVENTS, MAX_ORDERS, Link
from hil.terminal.tele import Arrow
from tests.hil.terminal.desk import FarEnd
from tests.hil.waiting import eventually

pytestmark = pytest.mark.skipif(os.name != "posix", reason="needs a pseudo-terminal")


@pytest.fixture
def robot() -> Iterator[FarEnd]:
    far_end = FarEnd()
    yield far_end
    far_end.close()


@pytest.fixture
def link(robot: FarEnd) -> Iterator[Link]:
    line = Link(robot.port)
    yield line
    line.close()


def frames_of(line: Link) -> list[OdometryFrame]:
    return [event for event in line.take() if isinstance(event, OdometryFrame)]


@pytest.mark.parametrize("keyword", ["mission", "calibrate", "init", "stop"])
def test_an_order_is_on_the_line_as_the_client_builds_it(robot: FarEnd, link: Link, keyword: str) -> None:
    assert link.order(keyword)
    eventually(lambda: robot.heard == order(keyword))
    eventually(lambda: link.traffic.orders == 1)
    assert link.take() == [order(keyword)]


def test_orders_leave_in_the_row_in_which_they_were_given(robot: FarEnd, link: Link) -> None:
    assert link.order("calibrate")
    assert link.order("mission")
    eventually(lambda: robot.heard == b"#CALB\r#MISN\r")


def test_a_set_is_tele_and_then_one_setr(robot: FarEnd, link: Link) -> None:
    assert link.set_reference(set_reference(0.1, -0.2))
    eventually(lambda: robot.heard == b"#TELE\r#SETR0.1,-0.2\r")
    assert link.tele is None


def test_a_stop_overtakes_what_waits(robot: FarEnd, link: Link) -> None:
    assert link.set_reference(set_reference(0.1, 0.0))
    assert link.stop()
    eventually(lambda: robot.heard.endswith(b"#STOP\r"))
    # The SETR was due half a second after the TELE; if the TELE had left already, the stop came after it.
    time.sleep(link_module.SET_DELAY_S + 0.2)  # that nothing comes has no event
    assert robot.heard in (b"#STOP\r", b"#TELE\r#STOP\r")


@pytest.mark.parametrize("keyword", ["mission", "calibrate"])
def test_another_order_makes_a_pending_setr_void(robot: FarEnd, link: Link, keyword: str) -> None:
    assert link.set_reference(set_reference(0.1, 0.0))
    eventually(lambda: robot.heard == b"#TELE\r")
    assert link.order(keyword)
    time.sleep(link_module.SET_DELAY_S + 0.2)  # that no SETR comes has no event
    assert robot.heard == b"#TELE\r" + order(keyword)


def test_tele_sends_setr_without_a_screen_until_stop(robot: FarEnd, link: Link) -> None:
    assert link.begin_tele()
    eventually(lambda: robot.heard.count(b"#SETR0.0,0.0\r") >= 2)
    assert robot.heard.startswith(b"#TELE\r#SETR0.0,0.0\r#SETR0.0,0.0\r")
    link.press(Arrow.UP)
    link.press(Arrow.LEFT)
    eventually(lambda: b"#SETR0.01,0.03\r" in robot.heard)
    assert link.stop()
    eventually(lambda: robot.heard.endswith(b"#STOP\r"))
    time.sleep(0.3)  # three periods, in which nothing is to come
    assert robot.heard.endswith(b"#STOP\r")
    assert link.take().count(b"#TELE\r") == 1


def test_leaving_forgets_what_waits_and_sends_stop_last(robot: FarEnd, link: Link) -> None:
    assert link.begin_tele()
    eventually(lambda: b"#SETR" in robot.heard)
    assert link.set_reference(set_reference(0.5, 0.0))
    link.close()
    link.close()
    assert link.stop_sent
    assert robot.heard.endswith(b"#STOP\r")
    assert b"0.5" not in robot.heard
    assert not link.order("mission")


def test_frames_come_whole_however_they_were_cut(robot: FarEnd, link: Link) -> None:
    sent = [OdometryFrame(number, -number, 1, 300, 200, 201) for number in range(20)]
    stream = b"".join(frame.encode() for frame in sent)
    for start in range(0, len(stream), 7):
        robot.say(stream[start : start + 7])
    seen: list[OdometryFrame] = []
    eventually(lambda: bool(seen.extend(frames_of(link))) or len(seen) == len(sent))
    assert seen == sent
    assert link.traffic.malformed == 0


def test_frames_that_nobody_takes_are_bounded_and_counted_and_the_newest_remain(robot: FarEnd, link: Link) -> None:
    count = 3 * MAX_EVENTS
    for number in range(count):
        data = OdometryFrame(number, 0, 0, 1, 1, 1).encode()
        while data:
            data = data[robot.say(data) :]
    eventually(lambda: link.traffic.frames == count)
    assert [frame.x_mm for frame in frames_of(link)] == list(range(count - MAX_EVENTS, count))
    assert link.traffic.unseen == count - MAX_EVENTS


def test_noise_costs_nothing_but_a_count(robot: FarEnd, link: Link) -> None:
    noise = bytes(range(256)) * 40 + b"#ODO " + b"1" * 5000 + b"#ODO 1,2,3\r" + b"#ODO 40000,0,0,0,0,0\n\r" + b"#" * 500
    while noise:
        noise = noise[robot.say(noise) :]
    good = OdometryFrame(1, 2, 3, 4, 5, 6)
    robot.say(good.encode())
    eventually(lambda: link.traffic.frames == 1)
    assert frames_of(link) == [good]
    assert link.traffic.malformed > 500
    assert link.failure == ""


def test_a_robot_that_reads_nothing_stops_no_screen_and_no_frame(
    robot: FarEnd, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(link_module, "WRITE_TIMEOUT_S", 0.2)
    line = Link(robot.port)
    try:
        filler = b"#" + b"x" * 4000
        # Fill the line; nobody reads the far end.
        eventually(lambda: not line._send(filler) or line.traffic.refused > 0)
        robot.say(OdometryFrame(1, 0, 0, 1, 1, 1).encode())
        eventually(lambda: line.traffic.frames == 1)
        assert len(line._orders) <= MAX_ORDERS + 1
        eventually(lambda: line.traffic.refused > 0)
    finally:
        line.close()
    assert not line.stop_sent


def test_a_line_that_goes_is_said_in_one_line_and_orders_are_refused(robot: FarEnd, link: Link) -> None:
    robot.close()
    eventually(lambda: link.failure != "")
    assert robot.port in link.failure
    assert "\n" not in link.failure
    assert not link.order("mission")
    link.close()
    assert not link.stop_sent


@pytest.mark.parametrize("port", ["/dev/no-such-port", "nonsense://x", "/dev/null", "socket://127.0.0.1:1", ""])
def test_a_port_that_cannot_be_opened_is_one_line(port: str) -> None:
    before = threading.active_count()
    with pytest.raises(ValueError, match=r"^[^\n]+$"):
        Link(port)
    assert threading.active_count() == before
