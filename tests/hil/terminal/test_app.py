"""The screen: keys become orders on the wire, what comes is shown, whatever it is."""

from __future__ import annotations

import os
import random
import re
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from textual.events import Key
from textual.pilot import Pilot

from emulator.c28x.sites import Place
from emulator.rules import RULES
from hil.client.decode import OdometryFrame
from hil.client.orders import order, set_reference
from hil.machine import FirmwareStopped, Setup
from hil.terminal.app import TerminalApp
from hil.terminal.findings import FindingScreen
from hil.terminal.link import Link
from hil.terminal.robot import EmulatedRobot
from tests.hil.scripted_machine import ScriptedMachine
from tests.hil.terminal.desk import FarEnd, becomes, play, screen
from tests.hil.waiting import eventually

pytestmark = pytest.mark.skipif(os.name != "posix", reason="needs a pseudo-terminal")

SETR = re.compile(rb"(#SETR-?\d+\.\d+,-?\d+\.\d+\r)+")


@pytest.fixture
def robot() -> Iterator[FarEnd]:
    far_end = FarEnd()
    yield far_end
    far_end.close()


@pytest.fixture
def app(robot: FarEnd) -> Iterator[TerminalApp]:
    link = Link(robot.port)
    yield TerminalApp(link, None)
    link.close()


@pytest.mark.parametrize(
    ("key", "keyword", "data"),
    [
        ("m", "mission", b"#MISN\r"),
        ("c", "calibrate", b"#CALB\r"),
        ("i", "init", b"#INIT\r"),
        ("space", "stop", b"#STOP\r"),
    ],
)
def test_a_key_is_an_order(app: TerminalApp, robot: FarEnd, key: str, keyword: str, data: bytes) -> None:
    assert order(keyword) == data

    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press(key)
        await becomes(pilot, lambda: robot.heard == data)
        await becomes(pilot, lambda: f"> {data.decode().strip()}" in "".join(screen(app)))

    play(app, scene)


def test_numbers_after_v_are_a_set_and_keys_typed_there_are_no_orders(app: TerminalApp, robot: FarEnd) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("v", *"0.1", "space", *"-0.2", "m", "backspace", "enter")
        await becomes(pilot, lambda: robot.heard == order("tele") + set_reference(0.1, -0.2))
        assert not app._prompt.display
        await pilot.press("m")
        await becomes(pilot, lambda: robot.heard.endswith(b"#SETR0.1,-0.2\r#MISN\r"))

    play(app, scene)


@pytest.mark.parametrize(("typed", "said"), [("fast 0", "V is 'fast'"), ("1", "not V W: '1'"), ("5000 0", "5000")])
def test_what_is_no_speed_is_said_and_not_sent(app: TerminalApp, robot: FarEnd, typed: str, said: str) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("v", *("space" if letter == " " else letter for letter in typed), "enter")
        await becomes(pilot, lambda: said in screen(app)[0])
        assert app._prompt.display
        await pilot.press("escape", "space")
        await becomes(pilot, lambda: robot.heard == b"#STOP\r")

    play(app, scene)


def test_keys_that_come_faster_than_the_screen_are_not_orders_once_numbers_are_asked_for(
    app: TerminalApp, robot: FarEnd
) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        for key in ("v", "m", "c", "escape", "space"):
            app.post_message(Key(key, key if len(key) == 1 else None))
        await becomes(pilot, lambda: b"#STOP" in robot.heard)
        assert robot.heard == b"#STOP\r"

    play(app, scene)


def test_arrows_drive_while_tele_is_on_and_only_then(app: TerminalApp, robot: FarEnd) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("up", "t")
        await becomes(pilot, lambda: b"#SETR" in robot.heard)
        assert robot.heard.startswith(b"#TELE\r#SETR0.0,0.0\r")
        await pilot.press("up", "left")
        await becomes(pilot, lambda: b"#SETR0.01,0.03\r" in robot.heard)
        await becomes(pilot, lambda: "tele V 0.01 m/s W 0.03 rad/s" in "".join(screen(app)))
        await pilot.press("down", "right")
        await becomes(pilot, lambda: robot.heard.endswith(b"#SETR0.0,0.0\r"))
        await pilot.press("space")
        await becomes(pilot, lambda: robot.heard.endswith(b"#STOP\r"))
        await pilot.press("up")
        await pilot.pause(0.3)  # three periods
        assert SETR.fullmatch(robot.heard.removeprefix(b"#TELE\r").removesuffix(b"#STOP\r"))
        assert "tele off" in "".join(screen(app))

    play(app, scene)


def test_zero_rests_and_t_or_escape_end_telemanipulation_with_a_stop(app: TerminalApp, robot: FarEnd) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        for ending in ("t", "escape"):
            stops = robot.heard.count(b"#STOP\r")
            await pilot.press("t")
            await becomes(pilot, lambda: app.link is not None and app.link.tele is not None)
            await pilot.press("up")
            await becomes(pilot, lambda: robot.heard.endswith(b"#SETR0.01,0.0\r"))
            await pilot.press("0")
            await becomes(pilot, lambda: robot.heard.endswith(b"#SETR0.0,0.0\r"))
            assert app.link is not None
            assert app.link.tele is not None
            await pilot.press(ending)
            await becomes(pilot, lambda stops=stops: robot.heard.count(b"#STOP\r") == stops + 1)  # type: ignore[misc]
            assert app.link.tele is None

    play(app, scene)


def test_the_screen_of_a_real_robot_at_80_columns(app: TerminalApp, robot: FarEnd) -> None:
    frames = [OdometryFrame(10 * number, -5, 1, 1922, 300, 301) for number in range(1, 31)]

    async def scene(pilot: Pilot[None]) -> None:
        await becomes(pilot, lambda: "robot silent for" in screen(app)[0])
        robot.say(b"".join(frame.encode() for frame in frames))
        await becomes(pilot, lambda: "frames 30 bad 0" in screen(app)[0])
        lines = screen(app)
        assert len(lines) == 24
        assert all(len(line) <= 80 for line in lines)
        assert lines[0] == f"connected | frames 30 bad 0 | {robot.port}"
        side = [line[47:].strip("│ ") for line in lines[2:22]]
        # Last frame: X 300 mm, Y -5 mm, 1 rad, front 1922 mm, right 300 mm, left 301 mm.
        assert side[:5] == [
            "x 0.300  y -0.005 m", "theta 1 rad", "F 192.2 R 30.0 L 30.1 cm", "tele off", "─" * 31,
        ]  # fmt: skip
        # The newest frames, as they came.
        assert side[5:] == [f"#ODO {10 * number},-5,1,1922,300,301" for number in range(16, 31)]
        picture = "\n".join(line[1:46] for line in lines[2:22])
        assert "↗" in picture  # 1 rad = 57 deg, nearest to 45
        assert re.search(r"├─+┤ [\d.]+ m", picture)
        assert any(0x2800 < ord(letter) <= 0x28FF for letter in picture)
        assert lines[23].split() == [
            "space", "STOP", "m", "mission", "t", "tele", "v", "set", "c", "calibrate", "i", "init", "q", "quit",
        ]  # fmt: skip
        await pilot.press("b")
        await becomes(pilot, lambda: "▀" in "".join(screen(app)))
        await pilot.press("x")
        await becomes(pilot, lambda: "↗" not in "".join(screen(app)))

    play(app, scene)


@pytest.mark.parametrize("size", [(40, 10), (20, 5), (10, 3), (2, 2), (300, 100)])
def test_any_size_of_screen_is_bearable(app: TerminalApp, robot: FarEnd, size: tuple[int, int]) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        robot.say(OdometryFrame(100, 100, 1, 500, 300, 301).encode())
        await becomes(pilot, lambda: app._frame is not None)
        await pilot.press("v", "1", "escape", "m", "space")
        await becomes(pilot, lambda: robot.heard.endswith(b"#MISN\r#STOP\r"))
        lines = screen(app)
        assert len(lines) == size[1]
        assert all(len(line) <= size[0] for line in lines)

    play(app, scene, size=size)


def test_a_narrow_screen_gives_its_room_to_the_arena(app: TerminalApp, robot: FarEnd) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        robot.say(OdometryFrame(100, 100, 1, 500, 300, 301).encode())
        await becomes(pilot, lambda: "↗" in "".join(screen(app)))
        assert app._view.size.width == 38  # 40 less its frame

    play(app, scene, size=(40, 12))


def test_hostile_bytes_neither_crash_nor_reach_the_screen_nor_pile_up(app: TerminalApp, robot: FarEnd) -> None:
    dice = random.Random(4)
    hostile = b"\x1b[2J\x1b]0;title\x07[bold]#ODO \xff\xfe\x00\r#ODO 1,2,3,4,5,6\r\n#ODO 99999,0,0,0,0,0\n\r"
    hostile += bytes(dice.randrange(256) for _ in range(60_000)) + b"#" * 2000 + b"#ODO 1,-" * 1000
    hostile += b"".join(OdometryFrame(*(dice.randrange(-32768, 32768) for _ in range(6))).encode() for _ in range(2000))
    last = OdometryFrame(123, 456, 1, 700, 800, 900)

    def flood() -> None:
        data = hostile + b"\r" + last.encode()
        while data:
            data = data[robot.say(data) :]

    async def scene(pilot: Pilot[None]) -> None:
        thread = threading.Thread(target=flood)
        thread.start()
        await becomes(pilot, lambda: app._frame == last)
        thread.join()
        text = "".join(screen(app))
        assert text.isprintable()
        assert "x 0.123  y 0.456 m" in text
        await pilot.press("space")
        await becomes(pilot, lambda: robot.heard == b"#STOP\r")

    play(app, scene)


def test_a_line_that_goes_is_said_and_the_screen_stays(app: TerminalApp, robot: FarEnd) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await pilot.pause()
        robot.close()
        await becomes(pilot, lambda: screen(app)[0].startswith("line lost: "))
        await pilot.press("m")
        await becomes(pilot, lambda: "not sent: mission" in app._status())

    play(app, scene)


@pytest.mark.parametrize("key", ["q", "ctrl+q", "ctrl+c"])
def test_three_keys_leave(app: TerminalApp, key: str) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("v")
        # Ctrl leaves while numbers are typed, too; q is a letter there.
        await pilot.press("escape" if key == "q" else "1", key)
        await pilot.pause()

    play(app, scene)
    assert app.return_code == 0
    assert not app.is_running


# An emulated robot


def machine_with_findings(setup: Setup) -> ScriptedMachine:
    machine = ScriptedMachine(setup)
    # The firmware does not run here, so a place is given.
    place = Place(str(Path.cwd() / "us.py"), 120, "average", "us.c")
    machine.findings.report_at(
        place, "uninitialised", "`result` [bold]was read[/] before anything was written to it", object="result",
        declaration="float result", how="dynamic", task="TaskUS",
        call_path=(place, Place(str(Path.cwd() / "us.py"), 80, "Read_Distance", "us.c")),
    )  # fmt: skip
    return machine


def test_findings_are_listed_and_enter_shows_one_in_full() -> None:
    robot = EmulatedRobot(Setup(), machine=machine_with_findings, pace=10)
    app = TerminalApp(None, robot)

    async def scene(pilot: Pilot[None]) -> None:
        assert screen(app)[0].startswith("start-up") or app.link is not None
        await becomes(pilot, lambda: "findings: 2" in "".join(screen(app)))
        await becomes(pilot, lambda: "connected" in screen(app)[0])
        (row,) = [line for line in screen(app) if "uninitialised" in line]
        assert row.strip("│ ").split() == ["error", "uninitialised", "1", "0.000", "TaskUS", "average", "(us.py:120)"]
        next(iter(robot.findings)).count = 70
        await becomes(pilot, lambda: any(re.search("uninitialised +70 ", line) for line in screen(app)))
        await pilot.press("l", "enter")
        await becomes(pilot, lambda: isinstance(app.screen, FindingScreen) and "call path" in "".join(screen(app)))
        page = "\n".join(screen(app))
        assert "`result` [bold]was read[/] before anything was written to it" in page  # no markup of ours
        assert "average (us.py:120)" in page
        assert "Read_Distance (us.py:80)" in page
        assert RULES["uninitialised"].title in " ".join(page.replace("┃", " ").split())
        first_words = " ".join(RULES["uninitialised"].page.split()[:5])
        await becomes(pilot, lambda: first_words in " ".join(" ".join(screen(app)).replace("┃", " ").split()))
        # The robot can be stopped from here, too.
        await pilot.press("space")
        await becomes(pilot, lambda: app.link is not None and app.link.traffic.orders == 1)
        await pilot.press("escape", "escape", "t")
        await becomes(pilot, lambda: app.link is not None and app.link.tele is not None)

    try:
        play(app, scene, size=(80, 40))
    finally:
        if app.link is not None:
            app.link.close()
        robot.end()


def test_firmware_that_stops_is_said_and_its_findings_stay() -> None:
    def ill(setup: Setup) -> ScriptedMachine:
        machine = machine_with_findings(setup)
        running = machine.run_until

        def run_until(cycles: int) -> None:
            running(cycles)
            if machine.frames_sent > 8:
                raise FirmwareStopped("a poll that nothing can end")

        machine.run_until = run_until  # type: ignore[method-assign]
        return machine

    robot = EmulatedRobot(Setup(), machine=ill, pace=10)
    app = TerminalApp(None, robot)

    async def scene(pilot: Pilot[None]) -> None:
        await becomes(pilot, lambda: screen(app)[0].startswith("the robot stopped: a poll that nothing can end"))
        await pilot.press("l", "enter")
        await becomes(pilot, lambda: isinstance(app.screen, FindingScreen))

    try:
        play(app, scene)
    finally:
        if app.link is not None:
            app.link.close()
        robot.end()


def test_a_key_before_the_robot_is_there_is_not_sent_and_said() -> None:
    release = threading.Event()

    def slow(setup: Setup) -> ScriptedMachine:
        release.wait(30)
        return ScriptedMachine(setup)

    robot = EmulatedRobot(Setup(), machine=slow)
    app = TerminalApp(None, robot)

    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("m", "t", "up", "space")
        assert screen(app)[0] == "start-up 0% | not sent: stop"

    play(app, scene)
    release.set()
    eventually(lambda: robot.progress > 0)
    robot.end()
