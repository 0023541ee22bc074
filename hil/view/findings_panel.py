"""The findings: a table with place, time and count, and an explanation of the chosen one.

The explanation has the statement, its call path, the meaning of the rule, and a button that goes to its moment.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from markdown_it import MarkdownIt
from nicegui import ui

from emulator.c28x.findings import Finding
from emulator.rules import RULES
from hil.reports.excerpt import function_of, location, readable, shown
from hil.view.code import show_code
from hil.view.engine import Engine
from hil.view.rated_finding import (
    ACCEPTED,
    KINDS,
    WORST_FIRST,
    RatedFinding,
    by_kind,
    in_words,
    rated,
    worst_first,
)
from hil.view.rows import Rows, TableCell, TableRow
from hil.view.snapshot import Snapshot
from hil.view.time_panel import WherePanel

#: Page updates between two looks at the counts: once a second.
EVERY: Final = 20
COLUMNS: Final = ("severity", "finding", "where", "first seen")


def key_of(finding: Finding) -> str:
    """A key that identifies a finding, also when the run is executed again."""
    return "\n".join((finding.rule, str(finding.place), finding.object, str(finding.time_cycles)))


def row_of(rated_finding: RatedFinding, *, ahead: bool = False) -> TableRow:
    """A row of the table.  `ahead`: the run has gone back to a time before the finding."""
    finding, severity = rated_finding.finding, rated_finding.severity
    place = finding.place
    line = "" if place is None else location(place).rpartition("/")[2]
    return TableRow(
        key_of(finding),
        (
            TableCell(
                severity.value,
                ACCEPTED if rated_finding.accepted else "",
                css=f"severity {rated_finding.kind}",
                title=f"accepted in the source: {rated_finding.accepted}" if rated_finding.accepted else "",
                order=WORST_FIRST.index(severity),
            ),
            TableCell(finding.rule, finding.object),
            TableCell(
                "" if place is None else function_of(place),
                ", ".join(filter(None, (line, finding.task))),
                title="" if place is None else location(place),
            ),
            TableCell(
                f"{finding.time_us / 1e3:.3f} ms", "ahead" if ahead else f"{finding.count} x", order=finding.time_cycles
            ),
        ),
    )


def has_words(row: TableRow, words: str) -> bool:
    """Whether a row contains each of some words, in any column and case."""
    text = " ".join(f"{cell.text} {cell.more} {cell.title}" for cell in row.cells).lower()
    return all(word in text for word in words.lower().split())


class FindingsPanel:
    """The table, and below it the chosen finding; `on_go_to(finding)` goes to its moment."""

    def __init__(self, engine: Engine, on_go_to: Callable[[Finding], None]) -> None:
        self._engine = engine
        self._on_go_to = on_go_to
        self._turn = 0
        self._shown: tuple[Finding, ...] = ()
        self._rated: list[RatedFinding] = []
        with ui.row().classes("items-center gap-x-2 gap-y-0 w-full"):
            self._filters = {
                kind: ui.checkbox(in_words(kind, 0), value=True, on_change=self._filter)
                .props("dense").classes(f"severity {kind}").mark(f"filter-{kind}")
                for kind in KINDS
            }  # fmt: skip
            ui.space()
            self._search = (
                ui.input(placeholder="search", on_change=self._filter)
                .props('dense clearable aria-label="search findings"').classes("w-40").mark("search-findings")
            )  # fmt: skip
        self._note = ui.label("nothing found yet").classes("soft")
        with ui.element("div").classes("scrolled w-full"):
            self._table = Rows(COLUMNS, self._chosen, name=1, sortable=True).classes("findings").mark("findings")
        self._where = WherePanel()
        self._detail = ui.column().classes("detail w-full gap-1").mark("finding")

    def update(self, now: Snapshot) -> None:
        """Update the panel while it is visible."""
        self._where.update(now)
        self._turn = (self._turn + 1) % EVERY
        if self._turn == 1 or len(self._shown) != len(self._engine.known_findings):
            self._refresh()

    def _refresh(self) -> None:
        self._shown = self._engine.known_findings
        self._rated = worst_first(rated(self._shown, self._engine.policy))
        self._filter()
        for kind, count in by_kind(self._rated).items():
            box = self._filters[kind]
            if box.text != in_words(kind, count):
                box.text = in_words(kind, count)
            # Few programs accept anything.
            box.visible = kind != ACCEPTED or count > 0

    def _filter(self) -> None:
        wanted = {kind for kind, box in self._filters.items() if box.value}
        now = self._engine.snapshot.cycles
        words = str(self._search.value or "")
        every = [row_of(each, ahead=each.finding.time_cycles > now) for each in self._rated if each.kind in wanted]
        rows = [row for row in every if has_words(row, words)]
        self._table.show(rows)
        ahead = sum(each.finding.time_cycles > now for each in self._rated)
        if not rows:
            text = "nothing of this kind" if self._rated else "nothing found yet"
        else:
            text = f"{ahead} of them are ahead: the run has gone back" if ahead else ""
        if self._note.text != text:
            self._note.text = text
            self._note.visible = bool(text)

    def show(self, finding: Finding) -> None:
        """Choose a finding, also one later than the present time."""
        self._table.choose(key_of(finding))
        self._explain(finding)

    def _chosen(self, key: str) -> None:
        finding = next((each for each in self._shown if key_of(each) == key), None)
        if finding is not None:
            self._explain(finding)

    def _explain(self, finding: Finding) -> None:
        rule = RULES.get(finding.rule)
        self._detail.clear()
        with self._detail:
            with ui.row().classes("items-center gap-2"):
                ui.label(f"{finding.rule}: {rule.title if rule else ''}").classes("head")
                ui.button(
                    f"Go to its statement at {finding.time_us / 1e3:.3f} ms", on_click=lambda: self._on_go_to(finding)
                ).props("no-caps dense").mark("back")
            ui.label(readable(finding.message))
            for each in rated([finding], self._engine.policy):
                if each.accepted:
                    ui.label(f"accepted in the source: {each.accepted}").classes("soft")
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
