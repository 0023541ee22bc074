"""The console on a screen of characters: orders by key, frames, arena, findings.

Colours are the terminal's own (its default background and foreground, red, magenta), so it reads on light and dark.
It speaks only through a `Link`; of an emulated robot it knows the port's name and the findings.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import time
from collections import deque
from collections.abc import Iterable, Sequence
from typing import ClassVar, Final

from rich.text import Text
from textual.app import App, ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.widget import Widget
from textual.widgets import Footer, Input, Static

from hil.client import keys
from hil.client.decode import OdometryFrame
from hil.client.orders import parse_order
from hil.reports.policy import Policy
from hil.terminal.arena import ArenaHistory
from hil.terminal.canvas import BRAILLE, HALF_BLOCKS, Layer
from hil.terminal.findings import FindingScreen, FindingsTable
from hil.terminal.link import Link
from hil.terminal.robot import EmulatedRobot
from hil.terminal.tele import Arrow

#: Between two looks at line and robot.
REFRESH_S: Final = 0.1
#: The robot sends every 250 ms: after this it is said to be silent.
SILENT_S: Final = 1.5
#: Lines that the list of frames remembers: more than any screen has.
MAX_LINES: Final = 200
STYLES: Final = {
    Layer.NOTHING: "", Layer.CLOUD: "red", Layer.PATH: "", Layer.ROBOT: "bold magenta", Layer.TEXT: "",
}  # fmt: skip


class ArenaView(Widget):
    """The arena, drawn in the available size."""

    def __init__(self) -> None:
        super().__init__(id="arena")
        self.arena = ArenaHistory()
        # Linux' own console has no braille.
        self.raster = HALF_BLOCKS if os.environ.get("TERM") == "linux" else BRAILLE

    def render(self) -> Text:
        """Draw the picture."""
        canvas = self.arena.draw(self.size.width, self.size.height, self.raster)
        lines = [Text.assemble(*((run, STYLES[layer]) for run, layer in line)) for line in canvas.lines()]
        return Text("\n", no_wrap=True).join(lines)


class FrameList(Widget):
    """The newest lines, as many as fit."""

    def __init__(self) -> None:
        super().__init__(id="frames")
        self._lines: deque[str] = deque(maxlen=MAX_LINES)

    def add(self, lines: Iterable[str]) -> None:
        """Add lines at the end."""
        self._lines.extend(lines)
        self.refresh()

    def render(self) -> Text:
        """Show the end of the list."""
        return Text("\n".join(list(self._lines)[-max(1, self.size.height) :]), no_wrap=True)


class TerminalApp(App[None]):
    """`hil console` in a terminal."""

    CSS_PATH = "app.tcss"
    TITLE = "hil console"
    ENABLE_COMMAND_PALETTE = False
    AUTO_FOCUS = ""
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (60, "-wide")]  # noqa: RUF012  (the base class says what it is)
    VERTICAL_BREAKPOINTS = [(0, "-low"), (18, "-high")]  # noqa: RUF012
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding(keys.STOP.terminal, "stop", "STOP", key_display=keys.STOP.shown, priority=True),
        Binding(keys.MISSION.terminal, "order('mission')", "mission"),
        Binding(keys.TELE.terminal, "tele", "tele"),
        Binding(keys.SET.terminal, "ask_reference", "set"),
        Binding(keys.CALIBRATE.terminal, "order('calibrate')", "calibrate"),
        Binding(keys.INIT.terminal, "order('init')", "init"),
        Binding(keys.REST.terminal, "rest", show=False),
        Binding(keys.LEAVE.terminal, "leave", show=False),
        Binding("l", "findings", "list"),
        Binding("q", "quit", "quit"),
        Binding("x", "clear", show=False),
        Binding("b", "raster", "blocks", show=False),
        *(
            Binding(arrow.name.lower(), f"drive('{arrow.name}')", show=False, priority=True) for arrow in Arrow
        ),
        Binding("ctrl+q,ctrl+c", "quit", show=False, priority=True),
    ]  # fmt: skip

    def __init__(
        self, link: Link | None, robot: EmulatedRobot | None, first: Sequence[str] = (), policy: Policy | None = None
    ) -> None:  # fmt: skip
        """The app for an open line, or for a robot that opens one and gets the orders `first`.

        `policy` sets the severities of findings (None: those of the rules).
        """
        super().__init__()
        self.link = link
        self.robot = robot
        self._first = first
        #: Why there will be no line.
        self.failure = ""
        self._message = ""
        self._frame: OdometryFrame | None = None
        self._frame_s = 0.0
        self._began_s = time.monotonic()
        self._status_line = Static(id="status", markup=False)
        self._view = ArenaView()
        self._pose_panel = Static(id="pose", markup=False)
        self._frames = FrameList()
        self._table = FindingsTable(policy or Policy()) if robot is not None else None
        self._prompt = Input(
            id="reference", placeholder="V W in m/s and rad/s, for instance 0.1 0 (Enter sends, Esc leaves)",
            compact=True, select_on_focus=False,
        )  # fmt: skip
        self._prompt.display = False
        self.theme = "ansi-dark"  # its background and foreground are the terminal's, dark or light

    def compose(self) -> ComposeResult:
        """Status above, arena and frames, findings of an emulated robot, keys below."""
        yield self._status_line
        with Horizontal(id="middle"):
            yield self._view
            with Vertical(id="side"):
                yield self._pose_panel
                yield self._frames
        if self._table is not None:
            yield self._table
        yield self._prompt
        yield Footer(show_command_palette=False)

    def on_mount(self) -> None:
        """Start the updates; handle signals so that the console leaves cleanly."""
        self._look()
        self.set_interval(REFRESH_S, self._look)
        # Windows' loop has no signal handlers, nor has one outside the main thread.
        with contextlib.suppress(NotImplementedError, RuntimeError, ValueError):
            for number in _signals():
                asyncio.get_running_loop().add_signal_handler(number, self._leave)

    def on_unmount(self) -> None:
        """Restore the signal handlers."""
        with contextlib.suppress(NotImplementedError, RuntimeError, ValueError):
            for number in _signals():
                asyncio.get_running_loop().remove_signal_handler(number)

    # Looking

    def _look(self) -> None:
        if self.robot is not None and self.robot.failure is not None and self.robot.address is None:
            self.exit()  # it never began: there is nothing to look at, and the reason is told at the shell
        self._open_line()
        if self.link is not None:
            self._show(self.link)
        if self.robot is not None and self._table is not None:
            self._table.show(self.robot.findings)
        _update(self._status_line, self._status())
        _update(self._pose_panel, self._pose())

    def _open_line(self) -> None:
        robot = self.robot
        if self.link is None and robot is not None and robot.address is not None and not self.failure:
            try:
                self.link = Link(robot.address)
            except ValueError as error:
                self.failure = str(error)
                return
            for keyword in self._first:
                self.action_order(keyword)

    def _show(self, link: Link) -> None:
        events = link.take()
        if not events:
            return
        lines = []
        for event in events:
            if isinstance(event, bytes):
                lines.append(f"> {event.decode('utf-8', 'replace').strip()}")
                continue
            self._view.arena.add(event)
            lines.append(f"#ODO {event.line}")
            self._frame, self._frame_s = event, time.monotonic()
        self._frames.add(lines)
        self._view.refresh()

    def _status(self) -> str:
        parts = [self._state()]
        if self.link is not None:
            traffic = self.link.traffic
            parts.append(f"frames {traffic.frames} bad {traffic.malformed}")
            parts += [f"refused {traffic.refused}"] if traffic.refused else []
        parts += [self._message] if self._message else []
        parts += [self.link.port] if self.link is not None else []
        return " | ".join(parts)

    def _state(self) -> str:
        if self.robot is not None and self.robot.failure is not None:
            return f"the robot stopped: {self.robot.failure}"
        if self.failure or (self.link is not None and self.link.failure):
            return f"line lost: {self.failure or (self.link.failure if self.link else '')}"
        if self.link is None:
            return f"start-up {self.robot.progress if self.robot else 0:.0%}"
        silent_s = time.monotonic() - (self._frame_s or self._began_s)
        if silent_s > SILENT_S:
            return f"robot silent for {silent_s:.0f} s"
        return "connected" if self._frame else "listening"

    def _pose(self) -> str:
        frame, tele = self._frame, self.link.tele if self.link is not None else None
        lines = ["no frame yet", "", ""]
        if frame is not None:
            lines = [
                f"x {frame.x_mm / 1e3:.3f}  y {frame.y_mm / 1e3:.3f} m",
                f"theta {frame.theta_rad} rad",
                " ".join(f"{name[0].upper()} {mm / 10:.1f}" for name, mm in frame.distances_mm.items()) + " cm",
            ]
        lines.append("tele off" if tele is None else f"tele V {tele[0]:.2f} m/s W {tele[1]:.2f} rad/s")
        return "\n".join(lines)

    # Orders

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Which keys are active: no orders while numbers are typed; arrows only while telemanipulation is on."""
        typing = isinstance(self.focused, Input)
        if action == "drive":
            return not typing and self.link is not None and self.link.tele is not None
        if action == "stop":
            return not typing
        return True if action != "findings" else self.robot is not None

    def action_order(self, keyword: str) -> None:
        """Send an order of one word."""
        self._set_message(self.link is not None and self.link.order(keyword), keyword)

    def action_stop(self) -> None:
        """Send STOP before everything that is queued."""
        self._set_message(self.link is not None and self.link.stop(), "stop")

    def action_tele(self) -> None:
        """Let the arrows drive from now on; a second press ends this with a stop."""
        if self.link is not None and self.link.tele is not None:
            self.action_stop()
        else:
            self._set_message(self.link is not None and self.link.begin_tele(), "tele: arrows drive")

    def action_rest(self) -> None:
        """Set V = W = 0 in telemanipulation."""
        if self.link is not None and self.link.tele is not None:
            self.link.rest()

    def action_drive(self, arrow: str) -> None:
        """Handle an arrow key in telemanipulation."""
        if self.link is not None:
            self.link.press(Arrow[arrow])

    def action_ask_reference(self) -> None:
        """Ask for V and W."""
        self._prompt.display = True
        self.set_focus(self._prompt)  # at once, or what is typed next would be orders

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Send V and W, or say what is wrong with them."""
        try:
            setr = parse_order(f"set {event.value}")
        except ValueError as error:
            shown = event.value.strip()
            self._message = str(error) if len(shown.replace(",", " ").split()) == 2 else f"not V W: {shown[:20]!r}"
            return
        event.input.clear()
        self.action_leave()
        self._set_message(self.link is not None and self.link.set_reference(setr), setr.decode("ascii").strip("#\r"))

    def _set_message(self, done: bool, what: str) -> None:
        self._message = what if done else f"not sent: {what}"
        _update(self._status_line, self._status())

    # The rest

    def action_leave(self) -> None:
        """Leave the prompt or the findings; where nothing is to leave, end telemanipulation with a stop."""
        if self.focused is None and self.link is not None and self.link.tele is not None:
            self.action_stop()
        self._prompt.display = False
        self.set_focus(None)

    def action_findings(self) -> None:
        """Choose a finding."""
        self.set_focus(self._table)

    def on_data_table_row_selected(self) -> None:
        """Show one finding in full."""
        if self._table is not None and (chosen := self._table.chosen) is not None:
            self.push_screen(FindingScreen(*chosen))

    def action_clear(self) -> None:
        """Clear the drawn points."""
        self._view.arena.clear()
        self._view.refresh()

    def action_raster(self) -> None:
        """Switch between braille and half blocks."""
        self._view.raster = BRAILLE if self._view.raster is HALF_BLOCKS else HALF_BLOCKS
        self._view.refresh()

    def _leave(self) -> None:
        """Leave on a signal, perhaps because the terminal was closed: stop the robot first."""
        if self.link is not None:
            self.link.close()
        self.exit()


def _update(widget: Static, text: str) -> None:
    """Write a text only if it has changed: a slow connection pays for each."""
    if widget.content != text:
        widget.update(text)


def _signals() -> list[signal.Signals]:
    return [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
