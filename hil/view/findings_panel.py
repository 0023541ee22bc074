"""Findings as they come: place, time, count; the statement, its call path, the meaning of the rule, and a way back to
it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Final

from markdown_it import MarkdownIt
from nicegui import ui

from emulator.c28x.findings import Finding
from emulator.rules import RULES, Severity
from hil.reports.excerpt import function_of, location, readable, shown
from hil.view.code import show_code
from hil.view.engine import Engine
from hil.view.rows import Rows, TableCell, TableRow
from hil.view.snapshot import Snapshot
from hil.view.time_panel import WherePanel

#: Page updates between two looks at the counts: once a second.
EVERY: Final = 20
WORST_FIRST: Final = sorted(Severity, key=lambda severity: -severity.rank)
COLUMNS: Final = ("severity", "finding", "where", "first")


def by_severity(rated: Iterable[tuple[Finding, Severity]]) -> dict[str, int]:
    """The number of findings of each severity, the worst first."""
    counts = {severity.value: 0 for severity in WORST_FIRST}
    for _, severity in rated:
        counts[severity.value] += 1
    return counts


def counted(counts: Mapping[str, int]) -> str:
    """Counts as coloured words of HTML."""
    words = [
        f'<span class="severity {severity}">{count} {severity}{"s" if count > 1 else ""}</span>'
        for severity, count in counts.items()
        if count
    ]
    return " ".join(words) or "none"


def key_of(finding: Finding) -> str:
    """A key that identifies a finding, also when the run is executed again."""
    return "\n".join((finding.rule, str(finding.place), finding.object, str(finding.time_cycles)))


def row_of(finding: Finding, severity: Severity) -> TableRow:
    """A row of the table."""
    place = finding.place
    line = "" if place is None else location(place).rpartition("/")[2]
    return TableRow(
        key_of(finding),
        (
            TableCell(severity.value, css=f"severity {severity.value}", order=WORST_FIRST.index(severity)),
            TableCell(finding.rule, finding.object),
            TableCell(
                "" if place is None else function_of(place),
                ", ".join(filter(None, (line, finding.task))),
                title="" if place is None else location(place),
            ),
            TableCell(f"{finding.time_us / 1e3:.3f} ms", f"{finding.count} x", order=finding.time_cycles),
        ),
    )


def worst_first(rated: Iterable[tuple[Finding, Severity]]) -> list[tuple[Finding, Severity]]:
    """Sort by severity; findings of one severity keep their order."""
    return sorted(rated, key=lambda each: -each[1].rank)


def has_words(row: TableRow, words: str) -> bool:
    """Whether a row contains each of some words, in any column and case."""
    text = " ".join(f"{cell.text} {cell.more} {cell.title}" for cell in row.cells).lower()
    return all(word in text for word in words.lower().split())


class FindingsPanel:
    """The table, and below it the finding that was chosen; `on_go_to(finding)` goes to its moment."""

    def __init__(self, engine: Engine, on_go_to: Callable[[Finding], None]) -> None:
        self._engine = engine
        self._on_go_to = on_go_to
        self._turn = 0
        self._shown: tuple[Finding, ...] = ()
        self._counted = -1
        with ui.row().classes("items-center gap-x-2 gap-y-0 w-full"):
            self._filters = {
                severity.value: ui.checkbox(severity.value, value=True, on_change=self._filter)
                .props("dense").classes(f"severity {severity.value}").mark(f"filter-{severity.value}")
                for severity in WORST_FIRST
            }  # fmt: skip
            ui.space()
            self._search = (
                ui.input(placeholder="search", on_change=self._filter)
                .props('dense clearable aria-label="search findings"').classes("w-40").mark("search-findings")
            )  # fmt: skip
        self._none = ui.label("nothing found yet").classes("soft")
        with ui.element("div").classes("scrolled w-full"):
            self._table = Rows(COLUMNS, self._chosen, name=1, sortable=True).classes("findings").mark("findings")
        self._where = WherePanel()
        self._detail = ui.column().classes("detail w-full gap-1").mark("finding")

    def update(self, now: Snapshot) -> None:
        """Update the panel while it is visible."""
        self._where.update(now)
        self._turn = (self._turn + 1) % EVERY
        if self._turn == 1 or len(self._shown) != len(self._engine.findings):
            self._fill()

    def _fill(self) -> None:
        self._shown = self._engine.findings
        self._filter()
        if self._counted != len(self._shown):
            self._counted = len(self._shown)
            for severity, count in by_severity(self._engine.policy.with_severities(self._shown)).items():
                self._filters[severity].text = f"{count} {severity}{'' if count == 1 else 's'}"

    def _filter(self) -> None:
        wanted = {severity for severity, box in self._filters.items() if box.value}
        rated = worst_first(self._engine.policy.with_severities(self._shown))
        rows = [row_of(finding, severity) for finding, severity in rated if severity.value in wanted]
        words = str(self._search.value or "")
        rows = [row for row in rows if has_words(row, words)]
        self._table.show(rows)
        text = "" if rows else "nothing of this kind" if self._shown else "nothing found yet"
        if self._none.text != text:
            self._none.text = text
            self._none.visible = bool(text)

    def show(self, finding: Finding) -> None:
        """Choose a finding, also one later than the present time."""
        self._table.choose(key_of(finding))
        self._tell(finding)

    def _chosen(self, key: str) -> None:
        finding = next((each for each in self._shown if key_of(each) == key), None)
        if finding is not None:
            self._tell(finding)

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
