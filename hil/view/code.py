"""A piece of firmware source with one line marked."""

from __future__ import annotations

from html import escape

from nicegui import ui

from emulator.c28x.sites import Place
from hil.reports.excerpt import excerpt, location


def show_code(place: Place, around: int = 4) -> None:
    """The lines around a place; one line that says so if the source cannot be read."""
    lines = excerpt(place.file, place.line, around)
    ui.label(location(place)).classes("soft mono")
    if not lines:
        ui.label("the source is not there").classes("soft")
        return
    rows = "".join(
        f'<div class="{"here" if each.marked else ""}">{each.number:5d}  {escape(each.text)}</div>' for each in lines
    )
    ui.html(f'<div class="code mono" tabindex="0">{rows}</div>', sanitize=False).classes("w-full")
