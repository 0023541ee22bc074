"""``hil drive`` against a port that the test turns."""

from __future__ import annotations

import json
import os
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from hil.cli import invoke
from hil.cli.drive import complete_words, format_frame
from hil.client.decode import OdometryFrame
from hil.serial_port.pty_port import PtyPort
from tests.hil.serial_port.lines import Robot, frame

pytestmark = pytest.mark.skipif(os.name != "posix", reason="needs a pseudo-terminal")


class Served:
    """A port that sends a numbered frame at each turn and collects orders."""

    def __init__(self) -> None:
        self.port = PtyPort()
        self.orders = bytearray()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._serve)
        self._thread.start()

    def _serve(self) -> None:
        robot = Robot(self.port)
        number = 0
        while not self._ended.wait(0.01):
            robot.send(frame(number % 30000))
            number += 1
            self.orders.extend(self.port.receive(64))

    def end(self) -> bytes:
        self._ended.set()
        self._thread.join()
        self.orders.extend(self.port.receive(4096))
        return bytes(self.orders)


@pytest.fixture
def served() -> Iterator[Served]:
    port = Served()
    yield port
    port.end()
    port.port.close()


def test_a_row_of_orders_is_sent_in_order(served: Served) -> None:
    assert invoke(["drive", served.port.device, "tele", "set", "-0.1", "0.3", "stop"]) == 0
    assert served.end() == b"#TELE\r#SETR-0.1,0.3\r#STOP\r"


def test_watch_shows_frames_and_draws_them(served: Served, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "drive.png"
    assert invoke(["drive", served.port.device, "mission", "watch", "--for", "0.5", "--png", str(picture)]) == 0
    out = capsys.readouterr().out
    assert "x " in out
    assert "front" in out
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert served.end() == b"#MISN\r"


def test_json_lists_the_frames(served: Served, capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["drive", served.port.device, "watch", "--for", "0.5", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    numbers = [values[0] for values in result["frames"]]
    assert len(numbers) > 1
    # Each the one after the other; opening discards what lay there.
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))


def test_a_port_that_goes_away_leaves_what_came_until_then(capsys: pytest.CaptureFixture[str]) -> None:
    master, slave = os.openpty()
    device = os.ttyname(slave)

    def robot() -> None:
        heard = b""
        while heard.count(b"\r") < 3:  # an answer to each of three orders
            heard += os.read(master, 64)
            os.write(master, frame(7))
        os.close(master)

    thread = threading.Thread(target=robot)
    thread.start()
    assert invoke(["drive", device, "tele", "mission", "stop", "watch", "--json"]) == 2
    thread.join()
    os.close(slave)
    out, err = capsys.readouterr()
    result = json.loads(out)
    assert {values[0] for values in result["frames"]} == {7}
    assert result["sent"] == ["#TELE\r", "#MISN\r", "#STOP\r"]
    assert err.startswith(f"hil: error: {device}: the port has gone away (")
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["/dev/no-such-port", "stop"], "/dev/no-such-port"),
        (["nonsense://x", "stop"], "nonsense"),
        (["socket://127.0.0.1:1", "stop"], "socket://127.0.0.1:1"),
        (["/dev/null", "stop"], "/dev/null"),
        (["x", "jump"], "no order 'jump'"),
        (["x", "set", "1"], "set needs two numbers"),
        (["x", "set", "fast", "0"], "V is 'fast'"),
        (["x", "watch", "--png", "a.doc"], "a picture's name ends in"),
        (["x"], "ORDER"),
    ],
)
def test_wrong_input_is_one_line_on_stderr_and_status_2(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert invoke(["drive", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("hil: error: ")
    assert message in err
    assert err.count("\n") == 1


def test_completion_offers_the_orders() -> None:
    assert complete_words("s") == ["stop", "set"]
    assert complete_words("wat") == ["watch"]


def test_a_frame_for_people_has_metres_and_centimetres() -> None:
    text = format_frame(OdometryFrame(1500, -20, 1, 1922, 300, 301))
    assert " ".join(text.split()) == ("x 1.500 m y -0.020 m theta 1 rad front 192.2 right 30.0 left 30.1 cm")
