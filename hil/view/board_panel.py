"""The board: its parts with their pins, and controls for their faces; a face with a range has a slider.

A value stays until it is set again, even if a world would change it.  It is an input of the run, so it is repeated
when the run is executed again.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from math import isfinite
from typing import Final

from nicegui import ui

from hil.board import Board, Face, Part
from hil.view.engine import Engine
from hil.view.notice import Notice
from hil.view.snapshot import Snapshot

#: CHOICE: steps of a slider from one end to the other.
STEPS: Final = 200
#: CHOICE: for this time after the user moved a slider, the run does not set it back.
HOLD_S: Final = 0.5
HELP: Final = "A value that you set here stays until you set it again, even if a world would change it."
NO_FACES: Final = "There is nothing to set here: no part of this board has a value that can be set."


class BoardPanel:
    """The panel.  `board` is one like that of the run: only its names, pins and ranges are looked at."""

    def __init__(self, engine: Engine, board: Board) -> None:
        self._engine = engine
        #: Whether it has a line to a PC.
        self.has_pc = board.pc is not None
        self._faces: dict[tuple[str, str], FaceRow] = {}
        ui.label(f"{type(board).__name__}: parts").classes("head")
        ui.label(HELP if any(part.faces for part in board.parts.values()) else NO_FACES).classes("soft")
        for part in board.parts.values():
            with ui.column().classes("panel w-full gap-1").mark(f"part-{part.name}"):
                with ui.row().classes("items-baseline gap-3"):
                    ui.label(part.name).classes("head")
                    ui.label(part.kind).classes("soft")
                    ui.label("  ".join(f"{signal} {pin}" for signal, pin in part.pins.items())).classes("mono")
                for face in part.faces:
                    self._faces[part.name, face.name] = FaceRow(part, face, self._put)

    def update(self, now: Snapshot) -> None:
        """Update the panel, 20 times a second, while it is visible."""
        for part, face, value in now.faces:
            row = self._faces.get((part, face))
            if row is not None:
                row.show(value)

    def _put(self, part: Part, face: Face, value: float) -> None:
        part.check(face.name, value)
        self._engine.act("put", part.name, face.name, value)


class FaceRow:
    """One face: its name, unit and present value, and the control that sets it.

    `put` raises ValueError for a value that the face cannot have.
    """

    def __init__(self, part: Part, face: Face, put: Callable[[Part, Face, float], None]) -> None:
        self._part, self._face, self._put = part, face, put
        #: What slider and field show; and until when they follow the person and not the run, on the monotonic clock.
        self._shown: float | None = None
        self._held_until_s = 0.0
        self._slider: ui.slider | None = None
        self._field: ui.number | None = None
        with ui.row().classes("items-center gap-x-3 gap-y-0 w-full"):
            settable = part.is_set(face.name)
            if settable:
                self._field = (
                    ui.number(str(face), format="%.6g").props("dense stack-label").style("flex:2 1 12em")
                    .mark(f"put-{part.name}-{face.name}")
                )  # fmt: skip
                self._field.on("keydown.enter", self._typed)
                self._field.on("blur", self._typed)
            else:
                ui.label(face.name).style("flex:2 1 12em")
            self._now = ui.label().style("flex:1 1 6em").classes("value").mark(f"now-{part.name}-{face.name}")
            if not settable:
                ui.label("read only").classes("soft").style("flex:3 1 8em")
                return
            if isfinite(face.low) and isfinite(face.high):
                self._slider = (
                    ui.slider(
                        min=face.low, max=face.high, step=_step(face), value=face.low,
                        on_change=lambda e: self._slid(e.value),
                    )
                    .props(f'aria-label="{part.name} {face.name}"').style("flex:3 1 8em;width:auto")
                    .classes("pr-3 unset").mark(f"slide-{part.name}-{face.name}")
                )  # fmt: skip
            self._notice = Notice()

    def show(self, value: float | None) -> None:
        """Show the present value; None: the part does not give it."""
        unset = "" if self._field is None else "not set"
        text = unset if value is None else value_text(value, self._face.unit)
        if self._now.text != text:
            self._now.text = text
        if value is not None and value != self._shown and time.monotonic() >= self._held_until_s:
            self._set(value)

    def _set(self, value: float) -> None:
        """Show a value in slider and field, without setting it."""
        self._shown = value
        if self._slider is not None:
            self._slider.value = value
            self._slider.classes(remove="unset")
        if self._field is not None:
            self._field.value = value

    def _slid(self, value: float | None) -> None:
        # The slider's own grid has other numbers than what was typed.
        if value is not None and self._shown is not None and abs(value - self._shown) < _step(self._face) / 2:
            return
        self._want(value)

    def _typed(self) -> None:
        if self._field is not None:
            self._want(self._field.value)

    def _want(self, value: float | None) -> None:
        if value is None or value == self._shown:
            return
        self._held_until_s = time.monotonic() + HOLD_S
        self._set(float(value))
        try:
            self._put(self._part, self._face, float(value))
        except ValueError as error:
            self._notice.tell(str(error))
        else:
            self._notice.tell("")


def value_text(value: float, unit: str) -> str:
    """A value with its unit; for a face that is yes or no (`1 = pressed`), the word."""
    yes = unit.removeprefix("1 = ")
    if yes != unit and value in (0.0, 1.0):
        return yes if value else f"not {yes}"
    return f"{value:.6g} {unit}"


def _step(face: Face) -> float:
    """The step of the slider; 1 for a face that is yes or no."""
    span = face.high - face.low
    return 1.0 if span == 1.0 and face.low == int(face.low) else span / STEPS
