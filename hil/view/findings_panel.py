"""Findings as they come: where, when, how often; the statement, the way to it, what the rule means, and back to it."""

from __future__ import annotations

from typing import Any, Final

from markdown_it import MarkdownIt
from nicegui import events, ui

from emulator.c28x.findings import Finding
from emulator.rules import RULES
from hil.reports.excerpt import readable, shown
from hil.view.code import show_code
from hil.view.engine import Engine
from hil.view.snapshot import Snapshot

#: Page updates between two looks at the counts: once a second.
EVERY: Final = 20
_COLUMNS: Final[list[dict[str, Any]]] = [
    {"name": "severity", "label": "severity", "field": "severity", "align": "left"},
    {"name": "rule", "label": "rule", "field": "rule", "align": "left", "sortable": True},
    {"name": "where", "label": "where", "field": "where", "align": "left", "sortable": True},
    {"name": "object", "label": "object", "field": "object", "align": "left"},
    {"name": "task", "label": "task", "field": "task", "align": "left", "sortable": True},
    {"name": "time_ms", "label": "first, ms", "field": "time_ms", "sortable": True},
    {"name": "count", "label": "times", "field": "count", "sortable": True},
]


def row_of(index: int, finding: Finding) -> dict[str, Any]:
    """A line of the table."""
    place, rule = finding.place, RULES.get(finding.rule)
    return {
        "id": index,
        "severity": rule.severity.value if rule is not None else "",
        "rule": finding.rule,
        "where": shown(place) if place is not None else "",
        "object": finding.object,
        "task": finding.task,
        "time_ms": round(finding.time_us / 1e3, 3),
        "count": finding.count,
    }


class FindingsPanel:
    """The table, and below it the finding that was chosen."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._turn = 0
        self._rows: list[dict[str, Any]] = []
        self._none = ui.label("nothing found yet").classes("soft")
        self._table = ui.table(
            columns=_COLUMNS, rows=[], row_key="id", selection="single", on_select=self._selected,
            pagination={"rowsPerPage": 8, "sortBy": "time_ms"},
        ).classes("w-full findings").props("flat dense hide-selected-banner wrap-cells").mark("findings")  # fmt: skip
        self._table.on("rowClick", self._clicked)
        self._detail = ui.column().classes("w-full gap-1").mark("finding")

    def update(self, _now: Snapshot) -> None:
        """While the panel is in sight."""
        self._turn = (self._turn + 1) % EVERY
        if self._turn != 1 and len(self._rows) == len(self._engine.findings):
            return
        rows = [row_of(index, finding) for index, finding in enumerate(self._engine.findings)]
        if rows != self._rows:
            self._rows = rows
            self._table.rows = rows
        self._none.visible = not rows

    def _clicked(self, e: events.GenericEventArguments) -> None:
        row = e.args[1]
        self._table.selected = [row]
        self._show(int(row["id"]))

    def _selected(self, e: events.TableSelectionEventArguments) -> None:
        if e.selection:
            self._show(int(e.selection[0]["id"]))

    def _show(self, index: int) -> None:
        findings = self._engine.findings
        if index >= len(findings):
            return
        finding = findings[index]
        rule = RULES.get(finding.rule)
        self._detail.clear()
        with self._detail:
            with ui.row().classes("items-center gap-2"):
                ui.label(f"{finding.rule}: {rule.title if rule else ''}").classes("head")
                ui.button(
                    f"Go back to {finding.time_us / 1e3:.3f} ms",
                    on_click=lambda: self._engine.go_to(finding.time_cycles),
                ).props("no-caps dense").mark("back")
            ui.label(readable(finding.message))
            for detail in finding.details:
                ui.label(readable(detail)).classes("soft")
            if finding.declaration:
                ui.label(f"declared: {finding.declaration}").classes("soft")
            if finding.place is not None:
                show_code(finding.place)
            if len(finding.call_path) > 1:
                ui.label("called from").classes("soft")
                for place in finding.call_path[1:]:
                    ui.label(shown(place)).classes("mono")
            if rule is not None:
                with ui.expansion("What this means").classes("w-full").props("dense"):
                    ui.html(MarkdownIt().render(rule.page), sanitize=False)
                    if rule.source:
                        ui.label(f"Source: {rule.source}").classes("soft")
