"""The PC of a console's user in virtual time: its clock, the keys and clicks of a script, its serial port on a bench.

The console on it (`console_program` or `console_model`) calls `write`, `read`, `wait` and `update`, as the program of
TFG annex 2 calls pyserial, `time.sleep` and Tk.  Nothing waits for real time, so a script gives the same bytes each
time.

CHOICE: computation takes `UPDATE_S` for each update of the window, and the script's time for a point of the map.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from emulator.clock import SYSCLK_HZ
from hil.bench import Bench

UPDATE_S: Final = 1e-3
#: The driver of Windows keeps this number of unread characters (the default of SetupComm).  Later ones are lost.
RECEIVED_MOST: Final = 4096


class ScriptEnded(BaseException):
    """The script has ended.  It leaves any loop that the console is in."""


@dataclass(frozen=True, slots=True)
class PressedKey:
    """A key that is held down, with times in s from the start of the console."""

    name: str
    begin_s: float
    end_s: float


@dataclass(frozen=True, slots=True)
class Script:
    """The actions of the user, with times in s from the start of the console."""

    seconds: float
    #: The clicks: the time, and the text of the button or menu entry.
    clicks: tuple[tuple[float, str], ...] = ()
    keys: tuple[PressedKey, ...] = ()
    #: The text of the two entries beside SET.
    v: str = ""
    w: str = ""
    #: The characters that a disturbed line adds: the time, and the characters.
    noise: tuple[tuple[float, bytes], ...] = ()
    #: From this time on, nothing comes from the robot.
    silent_from_s: float = float("inf")
    #: The time that the PC computes for a point of the map, added to the program's own pause.
    drawing_s: float = 0.0
    #: The first line of the configuration file, and the name of the file of drives in its second line.
    port: str = "COM3 "
    archive: str = "trayectoria.txt"
    #: The files that exist at the start, by name.
    files: tuple[tuple[str, str], ...] = ()
    #: From this time on, another window has the keyboard.
    elsewhere_from_s: float = float("inf")


@dataclass(frozen=True, slots=True)
class MapPoint:
    """A point of the map, in cm: the robot, and the points where its left and right sonar see a wall."""

    time_s: float
    robot: tuple[float, float]
    left: tuple[float, float]
    right: tuple[float, float]


class Desk:
    """The environment of the console, and a record of its actions."""

    def __init__(self, bench: Bench, script: Script) -> None:
        self.bench = bench
        self.script = script
        #: The commands of the buttons, by the text of the button.
        self.commands: dict[str, Callable[[], object]] = {}
        self.wire: list[tuple[float, bytes]] = []
        self.drawn: list[MapPoint] = []
        #: The characters from the robot, and when the last one came.
        self.frames: list[tuple[float, bytes]] = []
        self.files: dict[str, str] = dict(script.files)
        self.opened = ""
        #: The text of the label about the robot.
        self.label = ""
        #: The points of a loaded drive, and their positions on the axes.
        self.loaded = 0
        self.path: list[tuple[float, float]] = []
        #: The number of lines of the map's legend.
        self.legend = 0
        #: The errors that Tk would print.
        self.errors: list[str] = []
        self.left_at_s: float | None = None
        self._start = bench.clock.now
        self._received = bytearray()
        self._frame = bytearray()
        self._clicks = sorted(script.clicks)
        self._noise = sorted(script.noise)
        self.heard_s = float("-inf")
        self._stop_hearing = bench.uart_sent.connect(self._heard)

    # Time and the user

    @property
    def now_s(self) -> float:
        """The time since the start of the console."""
        return (self.bench.clock.now - self._start) / SYSCLK_HZ

    def wait(self, duration_s: float) -> None:
        """Let the program sleep.  The window is not updated."""
        self.bench.run_for(duration_s)
        while self._noise and self._noise[0][0] <= self.now_s:
            self._take(self._noise.pop(0)[1])

    def update(self) -> None:
        """Update the window: handle the clicks since the last update."""
        self.wait(UPDATE_S)
        if self.now_s >= self.script.seconds:
            raise ScriptEnded
        while self._clicks and self._clicks[0][0] <= self.now_s:
            text = self._clicks.pop(0)[1]
            try:
                self.commands[text]()
            except Exception as error:  # like Tk, which prints it and keeps the window
                self.errors.append(f"{type(error).__name__}: {error}")

    def draw(self, robot: tuple[float, float], left: tuple[float, float], right: tuple[float, float]) -> None:
        """Draw a point of the map, and the points that the sonars see from there."""
        self.drawn.append(MapPoint(self.now_s, robot, left, right))
        self.wait(self.script.drawing_s)

    def pressed(self, name: str) -> bool:
        """Whether a key is down now."""
        return any(key.name == name and key.begin_s <= self.now_s < key.end_s for key in self.script.keys)

    @property
    def in_front(self) -> bool:
        """Whether the console's window has the keyboard."""
        return self.now_s < self.script.elsewhere_from_s

    def run(self, program: Callable[[Desk], None]) -> Desk:
        """Run a console from its start until the script or the console has ended."""
        try:
            program(self)
        except ScriptEnded:
            pass
        except SystemExit:
            self.left_at_s = self.now_s
        self._stop_hearing()
        return self

    # The port

    def _heard(self, byte: int, _cycles: int) -> None:
        if self.now_s >= self.script.silent_from_s:
            return
        self._frame.append(byte)
        if byte == 0x0D:
            self.frames.append((self.now_s, bytes(self._frame)))
            self._frame.clear()
        self._take(bytes((byte,)))

    def _take(self, data: bytes) -> None:
        self.heard_s = self.now_s
        self._received += data[: RECEIVED_MOST - len(self._received)]

    @property
    def waiting(self) -> int:
        """The number of characters that were received but not read."""
        return len(self._received)

    def read(self, size: int = 1, timeout_s: float = 0.25) -> bytes:
        """Read `size` characters, or those that have come within `timeout_s`."""
        until_s = self.now_s + timeout_s
        while len(self._received) < size and self.now_s < until_s:
            self.wait(UPDATE_S)
        data = bytes(self._received[:size])
        del self._received[:size]
        return data

    def write(self, data: bytes) -> None:
        """Send characters to the robot."""
        self.wire.append((self.now_s, data))
        self.bench.feed(data)

    @property
    def sent(self) -> bytes:
        """All characters that the console has sent."""
        return b"".join(data for _, data in self.wire)
