"""The acceptance: the console of the thesis, unmodified, clicked through on a desktop nobody sees.

Its path comes from the environment variable ``C2000_HIL_CONSOLE``; this project carries no copy.  Pictures of each step
go to the folder ``C2000_HIL_SCREENSHOTS`` names, if it is set.
"""

from __future__ import annotations

import json
import math
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from hil.bench import Bench
from hil.client.decode import LONGEST_FRAME, FrameDecoder, OdometryFrame
from hil.machine import PathPoint
from hil.recording.log import Direction, Record, Recording, read_log
from hil.recording.replay import replay_orders, setup_of
from hil.session import NS_PER_CYCLE
from tests.hil.console.desk import Desk, desk, missing
from tests.hil.waiting import TIMEOUT_S, eventually

APP = os.environ.get("C2000_HIL_CONSOLE", "")
REPOSITORY = Path(__file__).parents[3]
SEED = 1

pytestmark = [
    pytest.mark.skipif(not APP, reason="C2000_HIL_CONSOLE does not name the console of the thesis"),
    pytest.mark.skipif(os.name != "posix", reason="--app is for Linux and macOS"),
    pytest.mark.skipif(bool(missing()), reason=missing() or "-"),
]

#: Where its widgets are, in the coordinates of its source, and how high it is without its menu.
MISION, STOP, CALIBRACION = (60, 75), (180, 75), (320, 75)
TELE, SET = (60, 115), (60, 155)
V_ENTRY, W_ENTRY = (210, 112), (210, 152)
NOWHERE = (330, 260)
HEIGHT = 300
#: Tk's "green", and matplotlib's "blue", "r", "g".
GREEN, BLUE, RED, PLOT_GREEN = (0, 128, 0), (0, 0, 255), (255, 0, 0), (0, 128, 0)
#: Long enough that no wall ends a drive, however slow the computer is that clicks; narrow enough for the sonars.
HALL = """
name = "hall"
[start]
x_m = 1.0
y_m = 1.5
heading_deg = 0.0
[[wall]]
points_m = [[0.0, 0.0], [60.0, 0.0], [60.0, 5.0], [0.0, 5.0]]
closed = true
"""
ORDERS = re.compile(rb"(?:#(?:STOP|MISN|TELE|CALB|INIT|SETR-?[\d.]+,-?[\d.]+)\r)*")


def whole_orders(recording: Recording) -> list[Record]:
    """Orders, each with the time of its last byte: the console writes one in up to five pieces."""
    result, gathered = [], b""
    for record in recording.records:
        if record.direction is Direction.TO_ROBOT:
            *whole, gathered = (gathered + record.data).split(b"\r")
            result += [Record(record.time_ns, Direction.TO_ROBOT, order + b"\r") for order in whole]
    return result


def speeds(order: Record) -> tuple[float, float]:
    """V and W of an order ``#SETRV,W``."""
    v, w = order.data[5:-1].split(b",")
    return float(v), float(w)


class Console:
    """The console on its desk, the robot behind it, the log between them."""

    def __init__(self, the_desk: Desk, folder: Path) -> None:
        self.desk = the_desk
        self.folder = folder / "run"
        self.log = folder / "run.wire"
        self.summary: dict[str, Any] = {}
        hall = folder / "hall.toml"
        hall.write_text(HALL)
        self.process = subprocess.Popen(
            [
                sys.executable, "-m", "hil", "console", "--app", APP, "--wire", str(self.log), "--json",
                "--dir", str(self.folder), "--world", str(hall), "--seed", str(SEED),
            ],
            cwd=folder, env={**the_desk.environment, "PYTHONPATH": str(REPOSITORY)},
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip

    def appears(self) -> None:
        eventually(lambda: "Buscando" in self.output() or self.process.poll() is not None, what="the console starts")
        assert self.process.poll() is None, self.process.communicate()
        self.window = self.desk.window("Consola Tele")
        _, _, _, height = self.window.geometry()
        self.menu_height = height - HEIGHT

    def click(self, place: tuple[int, int]) -> None:
        self.window.click(place[0], place[1] + self.menu_height)

    def menu(self, *keys: str) -> None:
        """Open its menu and move in it."""
        self.desk.until_it_changes(lambda: self.click((35, -self.menu_height // 2)))
        for key in keys:
            self.desk.until_it_changes(lambda key=key: self.desk.key(key))  # type: ignore[misc]

    def output(self) -> str:
        path = self.folder / "output.txt"
        return path.read_text("utf-8") if path.exists() else ""

    def drawn(self) -> list[tuple[float, ...]]:
        """The points it says that it draws.  It draws a frame again until the next one comes, so many are equal."""
        line = r"^Time: .*, x: (.*), y: (.*), angle: (.*), dF: (.*), dL: (.*), dR: (.*)\n"
        return [tuple(float(text) for text in point) for point in re.findall(line, self.output(), re.M)]

    def recording(self) -> Recording:
        return read_log(self.log)

    def orders(self) -> list[Record]:
        return whole_orders(self.recording())

    def sent(self, order: bytes) -> int:
        return sum(record.data == order for record in self.orders())

    def frames(self) -> list[tuple[int, OdometryFrame]]:
        decoder = FrameDecoder()
        return [
            (record.time_ns, frame)
            for record in self.recording().records
            if record.direction is Direction.FROM_ROBOT
            for frame in decoder.feed(record.data)
        ]

    def points(self) -> list[str]:
        """What it wrote as its trajectory, without the header."""
        (path,) = self.folder.rglob("trayectoria.txt")
        return path.read_text("utf-8").split("\n")[1:-1]

    def place(self) -> tuple[float, float]:
        """Where the robot says it is, in metres."""
        frame = self.frames()[-1][1]
        return frame.x_mm / 1e3, frame.y_mm / 1e3

    def steady(self) -> bool:
        """Whether the last second of orders is one and the same."""
        return len({order.data for order in self.orders()[-10:]}) == 1

    def silent(self) -> bool:
        """Whether for half a second of frames no order came."""
        frames, orders = self.frames(), self.orders()
        return not orders or frames[-1][0] - orders[-1].time_ns > 500_000_000

    def stands(self) -> bool:
        """Whether the last second of frames shows one place."""
        last = [(frame.x_mm, frame.y_mm) for _, frame in self.frames()[-4:]]
        return len(last) == 4 and len(set(last)) == 1


@pytest.fixture
def console(tmp_path: Path) -> Iterator[Console]:
    pictures = Path(os.environ.get("C2000_HIL_SCREENSHOTS", tmp_path / "pictures"))
    with desk(pictures) as the_desk:
        running = Console(the_desk, tmp_path)
        try:
            yield running
        finally:
            if running.process.poll() is None:
                running.process.send_signal(signal.SIGTERM)
            running.process.communicate(timeout=TIMEOUT_S)


def drive(orders: list[Record], start: PathPoint, until_ns: int) -> tuple[float, float, float]:
    """Where a robot that does exactly as it is told would be: x, y and the length of its way, in metres."""
    x, y, heading, length = start.x_m, start.y_m, start.heading_rad, 0.0
    v = w = 0.0
    now_ns = orders[0].time_ns
    for record in [*orders, Record(until_ns, Direction.TO_ROBOT, b"")]:
        dt = (record.time_ns - now_ns) / 1e9
        x += v * dt * math.cos(heading + w * dt / 2)
        y += v * dt * math.sin(heading + w * dt / 2)
        heading += w * dt
        length += abs(v) * dt
        now_ns = record.time_ns
        if match := re.fullmatch(rb"#SETR(.*),(.*)\r", record.data):
            v, w = float(match[1]), float(match[2])
    return x, y, length


def test_the_whole_way_through(console: Console) -> None:
    shows_it_is_connected(console)
    mission_draws_what_the_frames_say(console)
    escape_ends_the_drawing_and_not_the_mission(console)
    stop_stops(console)
    arrows_drive_as_the_orders_say(console)
    set_drives(console)
    calibration_is_ordered(console)
    the_menu_works(console)
    leaving_stops_the_robot(console)
    recording = console.recording()
    assert recording.problems == []
    nothing_was_lost_or_invented(console, recording)
    the_recording_is_the_run_and_the_robot_moved_as_told(recording)


def shows_it_is_connected(console: Console) -> None:
    console.appears()
    eventually(lambda: "\nRobot Conectado\n" in console.output(), what="the console finds the robot")
    eventually(lambda: GREEN in console.window.colours(), what="the green label")
    assert console.sent(b"#STOP\r") == 1
    console.desk.photograph("1-connected")


def mission_draws_what_the_frames_say(console: Console) -> None:
    before = len(console.frames())
    console.click(MISION)
    figure = console.desk.window("Figure 1")
    figure.move(500, 0)
    eventually(lambda: len(console.drawn()) >= 15 and len(set(console.drawn())) > 5, what="15 points, six of them new")
    assert console.sent(b"#MISN\r") == 1
    eventually(lambda: {BLUE, RED, PLOT_GREEN} <= figure.colours(), what="robot and sonar points in their colours")
    console.desk.photograph("2-mission")
    shown = console.drawn()
    # The console shows mm as cm and radians as degrees.
    possible = {
        (f.x_mm / 10, f.y_mm / 10, f.theta_rad * 180 / math.pi, f.front_mm / 10, f.left_mm / 10, f.right_mm / 10)
        for _, f in console.frames()
    }
    assert set(shown) <= possible
    assert max(x for x, *_ in shown) > 0
    assert len(console.frames()) > before


def escape_ends_the_drawing_and_not_the_mission(console: Console) -> None:
    orders = len(console.orders())
    console.desk.point(*NOWHERE)  # the keyboard is where the mouse is
    with console.desk.held("Escape"):
        # The file is written when the loop ends.
        eventually(lambda: len(console.points()) >= 15, what="the loop ends")
    lines = console.output().count("\nTime: ")
    bodies = [frame.line for _, frame in console.frames()]
    place = 0
    for point in console.points():
        place = bodies.index(point, place)  # in the frames' order, and no other
    assert len(console.orders()) == orders
    seen = len(console.frames())
    eventually(lambda: len(console.frames()) >= seen + 4, what="the robot goes on sending")
    assert not console.stands()
    assert console.output().count("\nTime: ") == lines
    console.desk.photograph("3-escape")


def stop_stops(console: Console) -> None:
    before = console.sent(b"#STOP\r")
    console.click(STOP)
    eventually(lambda: console.sent(b"#STOP\r") == before + 1, what="the order")
    eventually(console.stands, what="the robot stands")
    eventually(lambda: "\nRobot Parado\n" in console.output(), what="the console says so")
    console.desk.photograph("4-stop")


def arrows_drive_as_the_orders_say(console: Console) -> None:
    console.click(TELE)
    eventually(lambda: console.sent(b"#TELE\r") == 1, what="the order")
    eventually(lambda: console.sent(b"#SETR0.0,0.0\r") > 0, what="the first reference")
    tele = len(console.orders())
    start = console.frames()[-1][1]
    console.desk.point(*NOWHERE)
    with console.desk.held("Up"):
        eventually(lambda: b"#SETR0.1," in console.orders()[-1].data, what="0.1 m/s")
    eventually(lambda: console.frames()[-1][1].x_mm > start.x_mm + 200, what="20 cm straight ahead")
    with console.desk.held("Left"):
        eventually(lambda: re.search(rb",0\.(?:2|3)", console.orders()[-1].data), what="a turn to the left")
    # A tap is one step, however short.
    eventually(console.steady, what="the keys are up")
    v, w = speeds(console.orders()[-1])
    console.desk.key("Right")
    eventually(lambda: speeds(console.orders()[-1]) == (v, round(w - 0.03, 3)), what="less of a turn")
    console.desk.key("Down")
    eventually(lambda: speeds(console.orders()[-1]) == (round(v - 0.01, 3), round(w - 0.03, 3)), what="slower")
    console.desk.photograph("5-tele")
    eventually(lambda: console.frames()[-1][1].theta_rad > start.theta_rad, what="a turn of a radian")
    with console.desk.held("Escape"):
        eventually(console.silent, what="the orders end")
    console.click(STOP)
    eventually(console.stands, what="the robot stands")
    assert console.process.poll() is None
    setr = [speeds(order) for order in console.orders()[tele:] if order.data.startswith(b"#SETR")]
    steps = {(round(v2 - v1, 3), round(w2 - w1, 3)) for (v1, w1), (v2, w2) in pairwise(setr)}
    # A key held is a step of 0.01 m/s or 0.03 rad/s each time, and nothing else changes.
    assert steps == {(0.0, 0.0), (0.01, 0.0), (-0.01, 0.0), (0.0, 0.03), (0.0, -0.03)}


def set_drives(console: Console) -> None:
    console.click(V_ENTRY)
    console.desk.write("-0.1")
    console.click(W_ENTRY)
    console.desk.write("0.0")
    before = console.place()
    console.click(SET)
    eventually(lambda: console.sent(b"#SETR-0.1,0.0\r") == 1, what="the order")
    assert [order.data for order in console.orders()[-2:]] == [b"#TELE\r", b"#SETR-0.1,0.0\r"]
    eventually(lambda: math.dist(before, console.place()) > 0.1, what="the robot backs")
    console.desk.photograph("6-set")
    console.click(STOP)
    eventually(console.stands, what="the robot stands")


def calibration_is_ordered(console: Console) -> None:
    console.click(CALIBRACION)
    eventually(lambda: console.sent(b"#CALB\r") == 1, what="the order")
    eventually(lambda: "\nRobot Calibrado\n" in console.output(), what="the console has waited its 6.5 s")
    console.desk.photograph("7-calibrated")
    console.click(STOP)
    eventually(lambda: console.orders()[-1].data == b"#STOP\r", what="the order")


def the_menu_works(console: Console) -> None:
    # Opciones: Herramientas (active when it opens), Salir.  Herramientas: empty the file, initialise, change the port.
    assert console.points()
    console.menu("Right")
    console.desk.photograph("8-menu")
    console.desk.key("Return")
    eventually(lambda: not console.points(), what="an empty file")
    console.menu("Right", "Down")
    console.desk.key("Return")
    eventually(lambda: console.sent(b"#INIT\r") == 1, what="the order")
    eventually(lambda: "\nRobot Inicializado\n" in console.output(), what="the console says so")


def leaving_stops_the_robot(console: Console) -> None:
    assert (console.folder / "COM3").is_symlink()
    stops = console.sent(b"#STOP\r")
    console.menu("Down")
    console.desk.photograph("9-leaving")
    console.desk.key("Return")
    out, err = console.process.communicate(timeout=TIMEOUT_S)
    assert console.process.returncode == 0, err
    assert console.sent(b"#STOP\r") == stops + 1
    assert not (console.folder / "COM3").is_symlink()
    assert "Traceback" not in console.output()
    console.summary = json.loads(out)


def nothing_was_lost_or_invented(console: Console, recording: Recording) -> None:
    to_robot = recording.stream(Direction.TO_ROBOT)
    assert ORDERS.fullmatch(to_robot)  # whole orders and nothing else
    assert console.summary["bytes_to_robot"] == len(to_robot)
    from_robot = recording.stream(Direction.FROM_ROBOT)
    port = console.summary["port"]
    assert port["bytes_from_robot"] == len(from_robot)
    assert 0 <= len(from_robot) - port["bytes_delivered"] - port["bytes_dropped"] <= LONGEST_FRAME
    decoder = FrameDecoder()
    decoder.feed(from_robot)
    assert decoder.malformed == 0


def the_recording_is_the_run_and_the_robot_moved_as_told(recording: Recording) -> None:
    """The same robot given the same orders sends the same bytes, so its true path is that of the run.

    The path and not the frames: the C's dead reckoning adds metres to millimetres in a turn (Odometry.c), so frames
    stand still in a bend.
    """
    setup = setup_of(recording)
    assert setup is not None
    bench = Bench(setup)
    bench.boot()
    ready_ns = bench.clock.now * NS_PER_CYCLE
    assert replay_orders(recording, bench).equal
    orders = whole_orders(recording)
    first = next(index for index, order in enumerate(orders) if order.data.startswith(b"#SETR"))
    last = next(index for index, order in enumerate(orders[first:], first) if not order.data.startswith(b"#SETR"))
    path = bench.true_path()
    begin, *_, end = (
        point for point in path if orders[first].time_ns <= point.time_s * 1e9 - ready_ns <= orders[last].time_ns
    )
    bench.close()
    x, y, length = drive(orders[first:last], begin, orders[last].time_ns)
    assert length > 0.5
    # Servos follow late and wheels slip: within 15 % of the way it is where it was told to go.
    assert math.dist((end.x_m, end.y_m), (x, y)) < 0.15 * length
    # And that is not where it would be without the turn.
    ahead = (begin.x_m + length * math.cos(begin.heading_rad), begin.y_m + length * math.sin(begin.heading_rad))
    assert math.dist((end.x_m, end.y_m), ahead) > 0.3 * length
