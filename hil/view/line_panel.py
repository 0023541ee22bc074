"""The serial line of any board: the received lines, and a field for text to send."""

from __future__ import annotations

from typing import Final

from nicegui import ui

from hil.view.line import RobotLine
from hil.view.notice import Notice

#: Each is an element of the page, and all of them are gone through 20 times a second.
MAX_LINES: Final = 100
ENDS: Final = {"\r": "CR", "\n": "LF", "\r\n": "CR LF", "": "nothing"}


class LinePanel:
    """The panel; it uses only the line, not the board."""

    def __init__(self, line: RobotLine) -> None:
        self._line = line
        self._epoch = line.log.epoch
        self._next = 0
        with ui.row().classes("gap-2 items-center w-full"):
            ui.label("Serial line").classes("head")
            self._text = ui.input("to the board").props("dense stack-label").classes("w-56").mark("send")
            self._text.on("keydown.enter", self._send)
            self._end = ui.select(ENDS, value="\r", label="then").props("dense").classes("w-24").mark("end")
            ui.button("Send", on_click=self._send).props("no-caps dense outline")
            ui.space()
            self._counts = ui.label().classes("soft value")
        self._notice = Notice()
        self._log = ui.log(max_lines=MAX_LINES).classes("w-full mono log").mark("log")

    def update(self, _now: object = None) -> None:
        """Update the panel, up to 20 times a second."""
        log = self._line.log
        counts = f"{log.bytes_from_robot} B in, {log.bytes_to_robot} B out"
        if self._counts.text != counts:
            self._counts.text = counts
        if log.epoch != self._epoch:
            self._epoch = log.epoch
            self._log.clear()
        elif log.count == self._next:
            return
        # A line may bring more in this time than a page can show.
        for entry in log.entries_since(max(self._next, log.count - MAX_LINES)):
            self._log.push(f"{entry.time_s:9.3f} s  {'->' if entry.to_robot else '<-'}  {entry.text}")
            self._next = entry.number + 1

    def _send(self) -> None:
        text = str(self._text.value or "") + str(self._end.value)
        try:
            data = text.encode("latin-1")
        except UnicodeEncodeError:
            self._notice.tell("only characters of one byte can be sent")
            return
        self._notice.tell("")
        if data:
            self._line.write(data)
            self._text.value = ""
