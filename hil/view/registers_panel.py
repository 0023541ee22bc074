"""Registers: blocks, registers, fields, with value, meaning and who wrote last.

Stored words are shown; nothing is read as the CPU reads, because that may clear flags or move counters.  A register
whose word is made when it is read (counters, FIFOs) says so.
"""

from __future__ import annotations

from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any, Final

from nicegui import events, ui

from emulator.clock import seconds
from emulator.registers.cell import Cell
from hil.reports.excerpt import shown
from hil.view.checkpoints import Run
from hil.view.code import show_code
from hil.view.engine import Engine
from hil.view.snapshot import Snapshot
from hil.view.taps import Taps, Writer

EVERY: Final = 5
#: A cell that chooses its row by mouse or key.
PICKED: Final = '<q-td :props="props"><button class="link">{{ props.value }}</button></q-td>'
_REGISTERS: Final[list[dict[str, Any]]] = [
    {"name": "name", "label": "register", "field": "name", "align": "left"},
    {"name": "value", "label": "value", "field": "value", "align": "left"},
    {"name": "reset", "label": "", "field": "reset", "align": "left"},
    {"name": "writer", "label": "last written by", "field": "writer", "align": "left"},
    {"name": "time", "label": "at, s", "field": "time"},
]
_FIELDS: Final[list[dict[str, Any]]] = [
    {"name": "bits", "label": "bits", "field": "bits", "align": "left"},
    {"name": "name", "label": "field", "field": "name", "align": "left"},
    {"name": "value", "label": "value", "field": "value", "align": "left"},
    {"name": "access", "label": "access", "field": "access", "align": "left"},
    {"name": "text", "label": "meaning", "field": "text", "align": "left"},
]


@dataclass(frozen=True, slots=True)
class Look:
    """A block at one moment."""

    rows: list[dict[str, Any]]
    fields: list[dict[str, Any]]
    note: str
    writer: Writer | None


def look(run: Run, taps: Taps, block: str, chosen: str) -> Look:
    """Rows of a block's registers and the fields of the chosen one."""
    registers = run.bench.board.blocks[block].registers
    register = registers.get(chosen)
    fields = [] if register is None else fields_of(register)
    note = ""
    if register is not None:
        note = f"{register.path} at {register.address:#07x}, {register.bits} bits"
        note += ", EALLOW protected" if register.eallow else ""
        note += "; its word is made when it is read: what is shown was stored last" if register.on_read else ""
    return Look(
        [row_of(each, taps.writer(each)) for each in registers.values()], fields, note,
        None if register is None else taps.writer(register),
    )  # fmt: skip


def row_of(register: Cell, writer: Writer | None) -> dict[str, Any]:
    """A line of the table."""
    digits = register.bits // 4
    return {
        "name": register.name,
        "value": f"0x{register.value:0{digits}X}",
        "reset": "" if register.value == register.reset_value else "changed",
        "writer": "" if writer is None else writer_text(writer),
        "time": "" if writer is None else f"{seconds(writer.cycles):.6f}",
    }


def writer_text(writer: Writer) -> str:
    """Function, line and task."""
    if writer.place is None:
        return "start-up or kernel"
    return f"{shown(writer.place)}, {writer.task}"


def fields_of(register: Cell) -> list[dict[str, Any]]:
    """A line for each field."""
    rows = []
    for name, field in sorted(register.fields.items(), key=lambda item: -item[1].lo):
        value = (register.value & field.mask) >> field.lo
        rows.append({
            "bits": f"{field.hi}:{field.lo}" if field.width > 1 else f"{field.lo}",
            "name": name,
            "value": f"{value} (0x{value:X})" if value > 9 else str(value),
            "access": field.access.value,
            "text": field.text + ("" if field.modelled else "  (not modelled: no effect here)"),
        })  # fmt: skip
    return rows


class RegistersPanel:
    """The panel."""

    def __init__(self, engine: Engine, blocks: list[str]) -> None:
        self._engine = engine
        self._turn = 0
        self._chosen = ""
        self._waiting: Future[Look] | None = None
        self._shown: Look | None = None
        self._writer: Writer | None = None
        with ui.row().classes("items-center gap-3"):
            self._block = (
                ui.select(blocks, value=blocks[0], label="block", with_input=True, on_change=self._other)
                .props("dense options-dense")
                .classes("w-44")
                .mark("block")
            )
            ui.switch(
                "record who writes", value=engine.record_writers, on_change=lambda e: self._record(bool(e.value))
            ).props("dense").tooltip("costs some speed; since power-up if it was on then")
        self._table = ui.table(
            columns=_REGISTERS, rows=[], row_key="name", selection="single", on_select=self._selected,
            pagination={"rowsPerPage": 10},
        ).classes("w-full mono pick").props("flat dense wrap-cells").mark("registers")  # fmt: skip
        self._table.add_slot("body-cell-name", PICKED)
        self._table.on("rowClick", self._clicked)
        self._note = ui.label().classes("head")
        self._fields = ui.table(columns=_FIELDS, rows=[], row_key="name", pagination={"rowsPerPage": 0}).classes(
            "w-full mono"
        ).props("flat dense wrap-cells hide-bottom").mark("fields")  # fmt: skip
        self._code = ui.column().classes("w-full gap-1")

    def update(self, _now: Snapshot) -> None:
        """While the panel is in sight."""
        if self._waiting is not None and self._waiting.done():
            answer, self._waiting = self._waiting, None
            if not answer.cancelled() and answer.exception() is None:
                self._show(answer.result())
        self._turn = (self._turn + 1) % EVERY
        if self._turn == 0 and self._waiting is None:
            block, chosen, engine = str(self._block.value), self._chosen, self._engine
            self._waiting = engine.submit(lambda run: look(run, engine.taps, block, chosen))

    def _show(self, now: Look) -> None:
        before, self._shown = self._shown, now
        if before is None or before.rows != now.rows:
            self._table.rows = now.rows
        if before is None or before.fields != now.fields:
            self._fields.rows = now.fields
        if self._note.text != now.note:
            self._note.text = now.note
        if now.writer != self._writer:
            self._writer = now.writer
            self._code.clear()
            if now.writer is not None and now.writer.place is not None:
                with self._code:
                    ui.label(f"last written with {now.writer.word:#x} by").classes("soft")
                    show_code(now.writer.place, 2)

    def _other(self) -> None:
        self._chosen = ""
        self._table.selected = []

    def _clicked(self, e: events.GenericEventArguments) -> None:
        self._table.selected = [e.args[1]]
        self._chosen = str(e.args[1]["name"])

    def _selected(self, e: events.TableSelectionEventArguments) -> None:
        self._chosen = str(e.selection[0]["name"]) if e.selection else ""

    def _record(self, on: bool) -> None:
        self._engine.record(on)
