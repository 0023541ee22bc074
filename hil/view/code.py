"""A piece of firmware source with one line marked."""

from __future__ import annotations

from html import escape
from textwrap import dedent

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
    # Without the indentation that all lines have, more of them is in sight.
    texts = dedent("\n".join(each.text for each in lines)).split("\n")
    rows = "".join(
        f'<div class="{"here" if each.marked else ""}">{each.number:5d}  {escape(text)}</div>'
        for each, text in zip(lines, texts, strict=True)
    )
    ui.html(f'<div class="code mono" tabindex="0">{rows}</div>', sanitize=False).classes("w-full")
