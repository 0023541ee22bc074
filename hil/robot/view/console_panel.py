"""The console: the orders of the thesis console, the received frames, trajectory files.  It uses only a line."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Final

from nicegui import events, ui

from hil.client import keys
from hil.client.decode import OdometryFrame
from hil.client.orders import number, order, parse_order, set_reference
from hil.recording.trajectory import HEADINGS, parse_trajectory
from hil.robot.view.tele import BrowserTele
from hil.view.line import LogEntry, RobotLine
from hil.view.notice import Notice

#: The name of the thesis console's file (reference: annex 2).
FILE: Final = "trayectoria.txt"
#: Each line is an element of the page, and each of the 20 updates a second goes through all elements.
MAX_LINES: Final = 100
MAX_UPLOAD: Final = 4_000_000
HELP: Final = (
    "In telemanipulation, a held arrow key changes V by 0.01 m/s or W by 0.03 rad/s ten times a second; let go, the "
    "robot drives on. The stick sets both; let go, it stops. Set V, W holds until another order."
)
TELE_OFF: Final = "Telemanipulation is off"
#: The browser's sign of life, once a second: without it, driving by hand ends.
_HERE: Final = "hil-here"
_TELL_HERE: Final = f'setInterval(() => emitEvent("{_HERE}"), 1000)'


def file_of(frames: list[OdometryFrame]) -> bytes:
    """A file of frames, as the thesis console writes it: a line of headings, then six numbers in each line."""
    return "\n".join([HEADINGS, *(frame.line for frame in frames), ""]).encode("ascii")


def ended_by_others(entries: list[LogEntry]) -> bool:
    """Whether another order came after the last `#TELE`, from any button, page or port.  It ends driving by hand."""
    orders = [entry.text for entry in entries if entry.to_robot and not entry.text.startswith("#SETR")]
    return bool(orders) and orders[-1] != "#TELE"


class ConsolePanel:
    """The panel.  `on_loaded(frames)` is called with the points of a loaded file."""

    def __init__(self, line: RobotLine, on_loaded: Callable[[list[OdometryFrame]], None]) -> None:
        self._line = line
        self._on_loaded = on_loaded
        self.tele = BrowserTele()
        #: The reference that follows the `#TELE` of "Set V, W".
        self._delayed_reference: ui.timer | None = None
        self._epoch = line.log.epoch
        self._next = 0
        self._stick_on = False
        with ui.row().classes("gap-4 items-center no-wrap w-full"):
            self._stick = ui.joystick(
                color="#2a6bd1", size=120, mode="static", position={"left": "50%", "top": "50%"},
                on_move=lambda e: self.tele.stick(e.x, e.y), on_end=lambda _: self.tele.rest(),
            ).classes("panel stick off").mark("stick").props('role=application aria-label="stick"')  # fmt: skip
            with ui.column().classes("gap-2").style("flex:1 1 0;min-width:0"):
                with ui.row().classes("gap-2 items-center"):
                    self._tele_button = (
                        ui.button("Telemanipulation", on_click=self.toggle_tele).props("no-caps").mark("tele")
                    )
                    ui.button("V = W = 0", on_click=lambda: self.tele.rest()).props("no-caps outline").mark("rest")
                self._reference = ui.label(TELE_OFF).classes("value")
                ui.label(HELP).classes("soft wide")
        with ui.row().classes("gap-2 items-end"):
            self._v = ui.number("V, m/s", value=0.1, step=0.05).props("dense stack-label").classes("w-20").mark("v")
            self._w = ui.number("W, rad/s", value=0.0, step=0.1).props("dense stack-label").classes("w-20").mark("w")
            ui.button("Set V, W", on_click=self._set).props("no-caps outline dense").mark("set")
            ui.button("Calibrate", on_click=lambda: self.send(order("calibrate"))).props("no-caps outline dense").mark(
                "calb"
            )
            ui.button("Initialise", on_click=lambda: self.send(order("init"))).props("no-caps outline dense").mark(
                "init"
            )
            self._raw = ui.input("any order", placeholder="#SETR0.2,0").classes("w-36")
            self._raw.props("dense stack-label maxlength=200")
            self._raw.on("keydown.enter", self._send_raw)
        self._order_notice = Notice()
        with ui.row().classes("gap-2 items-center w-full"):
            ui.label("Serial line").classes("head")
            self._counts = ui.label().classes("soft value")
            ui.space()
            ui.button("Save points", on_click=self._save).props("no-caps dense flat size=sm").mark("save")
            upload = ui.upload(auto_upload=True, max_files=1, on_upload=self._load).props(
                f"accept=.txt,.csv max-file-size={MAX_UPLOAD}"
            ).classes("unseen").mark("load")  # fmt: skip
            load = ui.button("Load points", on_click=lambda: upload.run_method("pickFiles"))
            load.props("no-caps dense flat size=sm")
        self._load_notice = Notice()
        self._log = ui.log(max_lines=MAX_LINES).classes("w-full mono log").props(
            'role=log aria-label="serial line" tabindex=0'
        ).mark("log")  # fmt: skip
        self._failure = ui.label().style("color:var(--bad)")
        ui.on(_HERE, lambda: self.tele.alive(time.monotonic()))
        ui.run_javascript(_TELL_HERE)

    def send(self, data: bytes) -> None:
        """Send bytes to the robot.  A reference that was to follow an earlier order is dropped."""
        if data:
            if self._delayed_reference is not None:
                self._delayed_reference.cancel()
                self._delayed_reference = None
            self._line.write(data)

    def mission(self) -> None:
        """Order a mission."""
        self.leave_tele()
        self.send(order("mission"))

    def stop(self) -> None:
        """Stop at once."""
        self.tele.end()
        self.send(order("stop"))

    def toggle_tele(self) -> None:
        """Begin telemanipulation, or end it with a stop."""
        if self.tele.on:
            self.stop()
        else:
            self.send(self.tele.begin(time.monotonic()))

    def end_tele(self) -> None:
        """End telemanipulation with a stop, as ESC does in the thesis console."""
        if self.tele.on:
            self.stop()

    def leave_tele(self) -> None:
        """Stop the robot if it is driven by hand."""
        self.send(self.tele.end())

    @property
    def actions(self) -> Mapping[str, Callable[[], None]]:
        """Key -> action, except for driving."""
        return {
            keys.STOP.browser: self.stop, keys.MISSION.browser: self.mission, keys.TELE.browser: self.toggle_tele,
            keys.REST.browser: self.tele.rest, keys.LEAVE.browser: self.end_tele,
            keys.SET.browser: self._focus_reference,
            keys.CALIBRATE.browser: lambda: self.send(order("calibrate")),
            keys.INIT.browser: lambda: self.send(order("init")),
        }  # fmt: skip

    def key(self, name: str, down: bool) -> bool:
        """Handle a key for driving.  Returns whether it was one."""
        return self.tele.on and self.tele.key(name, down, time.monotonic())

    def update(self) -> None:
        """Update the panel, up to 20 times a second."""
        if self._line.flowing:
            self.send(self.tele.tick(time.monotonic()))
        reference = f"V {self.tele.v_m_s:+.2f} m/s   W {self.tele.w_rad_s:+.2f} rad/s"
        _text(self._reference, reference if self.tele.on else TELE_OFF)
        if self.tele.on is not self._stick_on:
            self._stick_on = self.tele.on
            self._stick.classes(remove="off") if self._stick_on else self._stick.classes("off")
        _text(self._tele_button, "End telemanipulation" if self.tele.on else "Telemanipulation")
        log = self._line.log
        if log.epoch != self._epoch:
            self._epoch = log.epoch
            self._log.clear()
        elif log.count == self._next:
            _text(self._failure, self._line.failure)
            return
        # More lines may have come since the last update than a page can show.
        entries = log.entries_since(max(self._next, log.count - MAX_LINES))
        for entry in entries:
            self._log.push(f"{entry.time_s:9.3f} s  {'->' if entry.to_robot else '<-'}  {entry.text}")
            self._next = entry.number + 1
        if self.tele.on and ended_by_others(entries):
            self.tele.end()
        frames = "frame" if log.malformed == 1 else "frames"
        damaged = f", {log.malformed} damaged {frames}" if log.malformed else ""
        _text(self._counts, f"{log.bytes_from_robot} B in, {log.bytes_to_robot} B out{damaged}")

    def _focus_reference(self) -> None:
        self._v.run_method("focus")

    def _set(self) -> None:
        if self._v.value is None or self._w.value is None:
            self._order_notice.tell("V and W must be numbers such as 0.2")
            return
        try:
            data = set_reference(number(str(self._v.value), "V"), number(str(self._w.value), "W"))
        except ValueError as error:
            self._order_notice.tell(str(error))
            return
        self._order_notice.tell("")
        # Telemanipulation comes first, as in the console; otherwise the robot accepts no reference.
        self.tele.end()
        self.send(order("tele"))
        self._delayed_reference = ui.timer(0.5, lambda: self.send(data), once=True)

    def _send_raw(self) -> None:
        try:
            self.send(parse_order(str(self._raw.value or "")))
        except ValueError as error:
            self._order_notice.tell(str(error))
        else:
            self._order_notice.tell("")

    def _save(self) -> None:
        ui.download.content(file_of(self._line.log.frames_since(0)), FILE)

    async def _load(self, e: events.UploadEventArguments) -> None:
        if e.file.size() > MAX_UPLOAD:  # the browser's own limit is only the browser's
            self._load_notice.tell(f"{e.file.name}: more than {MAX_UPLOAD / 1e6:g} MB")
            return
        trajectory = parse_trajectory(await e.file.read())
        if trajectory.frames:
            self._on_loaded(trajectory.frames)
            loaded = f"{len(trajectory.frames)} points of {e.file.name}"
        else:
            loaded = f"{e.file.name}: no points; the first line is {HEADINGS}"
        self._load_notice.tell("\n".join([loaded, *trajectory.problems]), wrong=not trajectory.frames)
        e.sender.reset()  # type: ignore[attr-defined]


def _text(element: ui.label | ui.button, text: str) -> None:
    """Send a text only if it has changed."""
    if element.text != text:
        element.text = text
