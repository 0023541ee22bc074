"""Registers: blocks, registers, fields, with value, meaning and last writer; with a search in all of them.

Stored words are shown, and nothing is read as the CPU reads, because that may clear flags or move counters.  A register
whose word is computed when it is read (counters, FIFOs) says so.
"""

from __future__ import annotations

from collections.abc import Iterable
from concurrent.futures import Future
from dataclasses import dataclass
from itertools import islice
from typing import Final

from nicegui import ui

from emulator.clock import seconds
from emulator.registers.cell import Cell
from emulator.registers.fields import F
from hil.reports.excerpt import function_of, location
from hil.view.checkpoints import RewindableRun
from hil.view.code import show_code
from hil.view.engine import Engine
from hil.view.meanings import meaning
from hil.view.rows import Rows, TableCell, TableRow
from hil.view.snapshot import Snapshot
from hil.view.taps import LastWriter, RegisterTaps

EVERY: Final = 5
#: CHOICE: the most registers that a search shows; with more, a user types on.
MOST: Final = 60
REGISTERS: Final = ("register", "value", "last written by")
FIELDS: Final = ("field", "value", "what it is")


@dataclass(frozen=True, slots=True)
class ShownRegister:
    """A register at one moment."""

    path: str
    word: int
    #: Its width in bits, and its word after reset.
    bits: int
    reset: int
    writer: LastWriter | None


@dataclass(frozen=True, slots=True)
class ShownField:
    """A field of the chosen register at one moment."""

    name: str
    field: F
    value: int
    reset: int


@dataclass(frozen=True, slots=True)
class RegistersSnapshot:
    """Some registers at one moment, and the chosen one."""

    cycles: int
    registers: list[ShownRegister]
    fields: list[ShownField]
    note: str
    writer: LastWriter | None


def register_at(run: RewindableRun, path: str) -> Cell:
    """The register of a path: `AdcaRegs.ADCCTL2`."""
    block, _, name = path.partition(".")
    return run.bench.board.blocks[block].registers[name]


def paths_of(run: RewindableRun, block: str, words: str) -> list[str]:
    """Paths of the registers of a block; of all that have each of some words in their path or in one of a field."""
    wanted = words.lower().split()
    if not wanted:
        return [register.path for register in run.bench.board.blocks[block]]

    def has_all(register: Cell) -> bool:
        text = " ".join((register.path, *register.fields)).lower()
        return all(word in text for word in wanted)

    every = (register for each in run.bench.board.blocks.values() for register in each)
    return [register.path for register in islice(filter(has_all, every), MOST)]


def look(
    run: RewindableRun, taps: RegisterTaps, paths: Iterable[str], chosen: str, *, only_set: bool = False
) -> RegistersSnapshot:
    """Rows of registers, `only_set` of those that are not as after reset, and the fields of the chosen one."""
    registers = [register_at(run, path) for path in paths]
    if only_set:
        registers = [each for each in registers if each.value != each.reset_value or each.path == chosen]
    register = next((each for each in registers if each.path == chosen), None)
    note = ""
    if register is not None:
        note = f"{register.path} at {register.address:#07x}, {register.bits} bits"
        note += ", EALLOW protected" if register.eallow else ""
        note += "; its word is made when it is read: what is shown was stored last" if register.on_read else ""
    return RegistersSnapshot(
        run.clock.now,
        [ShownRegister(each.path, each.value, each.bits, each.reset_value, taps.writer(each)) for each in registers],
        [] if register is None else fields_of(register),
        note,
        None if register is None else taps.writer(register),
    )


def row_of(register: ShownRegister, *, moved: bool, in_full: bool) -> TableRow:
    """A row of the table; with its block `in_full`."""
    value, reset = (f"0x{word:0{register.bits // 4}X}" for word in (register.word, register.reset))
    writer = register.writer
    return TableRow(
        register.path,
        (
            TableCell(register.path) if in_full else TableCell(register.path.partition(".")[2], css="whole"),
            _value(value, reset, moved=moved),
            TableCell("" if writer is None else writer_of(writer), "" if writer is None else writer_at(writer)),
        ),
    )


def _value(value: str, reset: str, more: str = "", *, moved: bool) -> TableCell:
    """A value, bold if it is not as after reset, marked if it has just changed."""
    css = " ".join(name for name, on in (("whole", True), ("moved", moved), ("not-reset", value != reset)) if on)
    return TableCell(value, more, css, "" if value == reset else f"after reset: {reset}")


def writer_of(writer: LastWriter) -> str:
    """The function that wrote last."""
    return "start-up or kernel" if writer.place is None else function_of(writer.place)


def writer_at(writer: LastWriter) -> str:
    """The place, task and time of the last write."""
    where = "" if writer.place is None else f"{location(writer.place).rpartition('/')[2]}, {writer.task}, "
    return f"{where}{seconds(writer.cycles):.6f} s"


def fields_of(register: Cell) -> list[ShownField]:
    """The fields of a register, the highest bits first."""
    return [
        ShownField(name, field, *((word & field.mask) >> field.lo for word in (register.value, register.reset_value)))
        for name, field in sorted(register.fields.items(), key=lambda item: -item[1].lo)
    ]


def field_row(shown: ShownField, *, moved: bool) -> TableRow:
    """A row of the table of fields."""
    field = shown.field
    value, reset = (f"{each} (0x{each:X})" if each > 9 else str(each) for each in (shown.value, shown.reset))
    text = field.text + ("" if field.modelled else "  (not modelled: no effect here)")
    return TableRow(
        shown.name,
        (
            TableCell(shown.name, f"bits {field.hi}:{field.lo}" if field.width > 1 else f"bit {field.lo}", css="whole"),
            _value(value, reset, meaning(field.text, shown.value), moved=moved),
            TableCell(text, field.access.value),
        ),
    )


class RegistersPanel:
    """The panel."""

    def __init__(self, engine: Engine, blocks: list[str]) -> None:
        self._engine = engine
        self._turn = 0
        self._chosen = ""
        #: What is looked at; None: what was asked for has still to be found.
        self._paths: list[str] | None = None
        self._finding: Future[list[str]] | None = None
        self._waiting: Future[RegistersSnapshot] | None = None
        self._last: RegistersSnapshot | None = None
        #: Bits that changed between the last two moments at which it was looked.
        self._moved: dict[str, int] = {}
        self._writer: LastWriter | None = None
        with ui.row().classes("items-center gap-x-3 gap-y-1"):
            self._block = (
                ui.select(blocks, value=blocks[0], label="block", with_input=True, on_change=self._find)
                .props("dense options-dense")
                .classes("w-36")
                .mark("block")
            )
            self._search = (
                ui.input("search all registers", placeholder="register or field", on_change=self._find)
                .props("dense clearable stack-label debounce=200").classes("w-44").mark("search-registers")
            )  # fmt: skip
            self._only_set = ui.checkbox("not as after reset").props("dense").mark("only-set")
            ui.switch(
                "record who writes", value=engine.record_writers, on_change=lambda e: self._record(bool(e.value))
            ).props("dense").tooltip("costs some speed; since power-up if it was on then")
        with ui.element("div").classes("scrolled w-full"):
            self._table = Rows(REGISTERS, self._choose).classes("mono registers").mark("registers")
        self._count = ui.label().classes("soft")
        self._note = ui.label().classes("head")
        self._fields = Rows(FIELDS).classes("mono fields").mark("fields")
        self._fields.visible = False
        self._code = ui.column().classes("w-full gap-1")

    def update(self, _now: Snapshot) -> None:
        """Update the panel while it is visible."""
        if self._waiting is not None and self._waiting.done():
            answer, self._waiting = self._waiting, None
            if not answer.cancelled() and answer.exception() is None:
                self._show(answer.result())
        self._turn = (self._turn + 1) % EVERY
        if self._turn or self._waiting is not None:
            return
        engine, chosen, only_set = self._engine, self._chosen, bool(self._only_set.value)
        paths = self._known_paths()
        if paths is not None:
            self._waiting = engine.submit(lambda run: look(run, engine.taps, paths, chosen, only_set=only_set))

    def _known_paths(self) -> list[str] | None:
        """The paths to be shown; None while they are being searched."""
        if self._paths is None and self._finding is None:
            block, words = str(self._block.value), str(self._search.value or "")
            self._finding = self._engine.submit(lambda run: paths_of(run, block, words))
        elif self._paths is None and self._finding is not None and self._finding.done():
            answer, self._finding = self._finding, None
            self._paths = [] if answer.cancelled() or answer.exception() is not None else answer.result()
        return self._paths

    def _show(self, now: RegistersSnapshot) -> None:
        before, self._last = self._last, now
        if before is not None and before.cycles != now.cycles:
            words = {each.path: each.word for each in before.registers}
            changes = {each.path: each.word ^ words.get(each.path, each.word) for each in now.registers}
            self._moved = {path: bits for path, bits in changes.items() if bits}
        in_full = bool(self._search.value)
        self._table.show([row_of(each, moved=each.path in self._moved, in_full=in_full) for each in now.registers])
        bits = self._moved.get(self._chosen, 0)
        self._fields.show([field_row(each, moved=bool(bits & each.field.mask)) for each in now.fields])
        if self._fields.visible is not bool(now.fields):
            self._fields.visible = bool(now.fields)
        many = len(now.registers)
        count = f"{many} register{'' if many == 1 else 's'}" + (" and more" if in_full and many == MOST else "")
        _text(self._count, f"{count}; bold: not as after reset; marked: changed since the last stop or look")
        _text(self._note, now.note)
        if now.writer != self._writer:
            self._writer = now.writer
            self._code.clear()
            if now.writer is not None and now.writer.place is not None:
                with self._code:
                    ui.label(f"last written with {now.writer.word:#x} by").classes("soft")
                    show_code(now.writer.place, 2)

    def _find(self) -> None:
        self._paths = self._finding = None

    def _choose(self, path: str) -> None:
        self._chosen = path
        self._turn = EVERY - 1

    def _record(self, on: bool) -> None:
        self._engine.record(on)


def _text(label: ui.label, text: str) -> None:
    """Send a text only if it has changed."""
    if label.text != text:
        label.text = text
