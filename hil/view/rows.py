"""A table whose rows stay while what stands in them changes.

NiceGUI draws the whole page anew at each change.  A table of Quasar with cells of one's own then makes all of them
again, 20 times a second, under the mouse and under the focus.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from nicegui import events
from nicegui.element import Element


@dataclass(frozen=True, slots=True)
class TableCell:
    """The content of a cell: a text, `more` below it, a title for the mouse, a class, and the sort key."""

    text: str
    more: str = ""
    css: str = ""
    title: str = ""
    #: None: by the text.
    order: float | None = None


@dataclass(frozen=True, slots=True)
class TableRow:
    """A row; `key` identifies it."""

    key: str
    cells: tuple[TableCell, ...]


class Rows(Element, component="rows.js"):
    """The table.  `on_chosen(key)`: a row was chosen, by the mouse or by the button in its column `name`."""

    def __init__(
        self, columns: Sequence[str], on_chosen: Callable[[str], None] | None = None, *, name: int = 0,
        sortable: bool = False,
    ) -> None:  # fmt: skip
        super().__init__()
        self._rows: list[TableRow] = []
        self._props |= {
            "columns": list(columns), "rows": [], "chosen": "", "sortable": sortable,
            "name": -1 if on_chosen is None else name,
        }  # fmt: skip
        self.classes("rows")
        if on_chosen is not None:
            self.on("choose", lambda e: self._choose(e, on_chosen))

    def show(self, rows: Sequence[TableRow]) -> None:
        """Show these rows."""
        if self._rows != list(rows):
            self._rows = list(rows)
            self._props["rows"] = [{"key": row.key, "cells": [_plain(cell) for cell in row.cells]} for row in rows]
            self.update()

    def choose(self, key: str) -> None:
        """Mark a row; "": none."""
        if self._props["chosen"] != key:
            self._props["chosen"] = key
            self.update()

    def _choose(self, e: events.GenericEventArguments, on_chosen: Callable[[str], None]) -> None:
        key = str(e.args)
        if any(row.key == key for row in self._rows):
            self.choose(key)
            on_chosen(key)


def _plain(cell: TableCell) -> dict[str, Any]:
    """A cell for the browser, without empty values."""
    entries = {"text": cell.text, "more": cell.more, "css": cell.css, "title": cell.title, "order": cell.order}
    return {name: value for name, value in entries.items() if value not in ("", None) or name == "text"}
