"""Findings as they come: where, when, how often; the statement, the way to it, what the rule means, and back to it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, Final

from markdown_it import MarkdownIt
from nicegui import events, ui

from emulator.c28x.findings import Finding
from emulator.rules import RULES, Severity
from hil.reports.excerpt import readable, shown
from hil.view.code import show_code
from hil.view.engine import Engine
from hil.view.registers_panel import PICKED
from hil.view.snapshot import Snapshot
from hil.view.time_panel import WherePanel

#: Page updates between two looks at the counts: once a second.
EVERY: Final = 20
WORST_FIRST: Final = sorted(Severity, key=lambda severity: -severity.rank)
_COLUMNS: Final[list[dict[str, Any]]] = [
    {"name": "severity", "label": "severity", "field": "severity", "align": "left", "sortable": True},
    {"name": "rule", "label": "rule", "field": "rule", "align": "left", "sortable": True},
    {"name": "where", "label": "where", "field": "where", "align": "left", "sortable": True},
    {"name": "object", "label": "object", "field": "object", "align": "left"},
    {"name": "task", "label": "task", "field": "task", "align": "left", "sortable": True},
    {"name": "time_ms", "label": "first, ms", "field": "time_ms", "sortable": True},
    {"name": "count", "label": "times", "field": "count", "sortable": True},
]


def severity_of(finding: Finding) -> str:
    """That of its rule; "" of a rule that nobody knows."""
    rule = RULES.get(finding.rule)
    return rule.severity.value if rule is not None else ""


def by_severity(findings: Iterable[Finding]) -> dict[str, int]:
    """How many there are of each severity, the worst first."""
    counts = {severity.value: 0 for severity in WORST_FIRST}
    for finding in findings:
        severity = severity_of(finding)
        counts[severity] = counts.get(severity, 0) + 1
    return counts


def counted(counts: Mapping[str, int]) -> str:
    """Counts as coloured words of HTML."""
    words = [
        f'<span class="severity {severity}">{count} {severity}{"s" if count > 1 else ""}</span>'
        for severity, count in counts.items()
        if count
    ]
    return " ".join(words) or "none"


def row_of(index: int, finding: Finding) -> dict[str, Any]:
    """A line of the table."""
    place = finding.place
    return {
        "id": index,
        "severity": severity_of(finding),
        "rule": finding.rule,
        "where": shown(place) if place is not None else "",
        "object": finding.object,
        "task": finding.task,
        "time_ms": round(finding.time_us / 1e3, 3),
        "count": finding.count,
    }


def worst_first(rows: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """By severity; those of one severity as they came."""
    order = [severity.value for severity in WORST_FIRST]
    return sorted(rows, key=lambda row: order.index(row["severity"]) if row["severity"] in order else len(order))


class FindingsPanel:
    """The table, and below it the finding that was chosen; `on_go_to(finding)` goes to its moment."""

    def __init__(self, engine: Engine, on_go_to: Callable[[Finding], None]) -> None:
        self._engine = engine
        self._on_go_to = on_go_to
        self._turn = 0
        self._rows: list[dict[str, Any]] = []
        with ui.row().classes("items-center gap-2 w-full"):
            self._filters = {
                severity.value: ui.checkbox(severity.value, value=True, on_change=self._filter)
                .props("dense").classes(f"severity {severity.value}").mark(f"filter-{severity.value}")
                for severity in WORST_FIRST
            }  # fmt: skip
            ui.space()
            self._search = (
                ui.input(placeholder="search", on_change=lambda e: self._look_for(str(e.value or "")))
                .props('dense clearable aria-label="search findings"').classes("w-40").mark("search-findings")
            )  # fmt: skip
        self._none = ui.label("nothing found yet").classes("soft")
        self._table = ui.table(
            columns=_COLUMNS, rows=[], row_key="id", selection="single", on_select=self._selected,
            pagination=10,
        ).classes("w-full pick findings").props("flat dense hide-selected-banner wrap-cells")  # fmt: skip
        self._table.mark("findings")
        self._table.add_slot(
            "body-cell-severity",
            '<q-td :props="props"><span :class="`severity ${props.value}`">{{ props.value }}</span></q-td>',
        )
        self._table.add_slot("body-cell-rule", PICKED)
        self._table.on("rowClick", self._clicked)
        self._where = WherePanel()
        self._detail = ui.column().classes("w-full gap-1").mark("finding")

    def update(self, now: Snapshot) -> None:
        """While the panel is in sight."""
        self._where.update(now)
        self._turn = (self._turn + 1) % EVERY
        if self._turn == 1 or len(self._rows) != len(self._engine.findings):
            self._fill()

    def _fill(self) -> None:
        findings = self._engine.findings
        rows = worst_first(row_of(index, finding) for index, finding in enumerate(findings))
        if rows == self._rows:
            return
        self._rows = rows
        self._filter()
        self._none.visible = not rows
        for severity, count in by_severity(findings).items():
            box, text = self._filters.get(severity), f"{count} {severity}{'' if count == 1 else 's'}"
            if box is not None and box.text != text:
                box.text = text

    def _filter(self) -> None:
        hidden = {severity for severity, box in self._filters.items() if not box.value}
        self._table.rows = [row for row in self._rows if row["severity"] not in hidden]

    def _look_for(self, text: str) -> None:
        self._table.filter = text

    def _clicked(self, e: events.GenericEventArguments) -> None:
        row = e.args[1]
        self._table.selected = [row]
        self._show(int(row["id"]))

    def _selected(self, e: events.TableSelectionEventArguments) -> None:
        if e.selection:
            self._show(int(e.selection[0]["id"]))

    def show(self, finding: Finding) -> None:
        """Choose a finding."""
        self._fill()
        for index, each in enumerate(self._engine.findings):
            if each is finding:
                self._table.selected = [row for row in self._rows if row["id"] == index]
                self._tell(finding)

    def _show(self, index: int) -> None:
        findings = self._engine.findings
        if index < len(findings):
            self._tell(findings[index])

    def _tell(self, finding: Finding) -> None:
        rule = RULES.get(finding.rule)
        self._detail.clear()
        with self._detail:
            with ui.row().classes("items-center gap-2"):
                ui.label(f"{finding.rule}: {rule.title if rule else ''}").classes("head")
                ui.button(
                    f"Go to its statement at {finding.time_us / 1e3:.3f} ms", on_click=lambda: self._on_go_to(finding)
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
