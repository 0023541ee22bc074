"""Findings in the terminal: a table that grows while the robot runs, and one finding in full with its rule's page."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from rich.text import Text
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import VerticalScroll
from textual.screen import ModalScreen
from textual.widgets import DataTable, Footer, Markdown, Static

from emulator.c28x.findings import Finding
from emulator.rules import RULES, Severity
from hil.client.keys import LEAVE, STOP
from hil.reports.excerpt import readable, shown
from hil.reports.policy import Policy

#: The longest last: on a narrow screen it is the one that is cut (arrow keys scroll).
COLUMNS = ("severity", "rule", "times", "first ms", "task", "place")
#: Colours that can be read on light and on dark.
STYLE = {Severity.ERROR: "bold red", Severity.WARNING: "magenta", Severity.NOTE: "blue"}


class FindingsTable(DataTable[Text]):
    """Findings in order of first occurrence, each with its count."""

    BORDER_TITLE = "findings"

    def __init__(self, policy: Policy) -> None:
        """The table; `policy` sets the severities."""
        super().__init__(cursor_type="row", id="findings")
        self._policy = policy
        self._shown: Sequence[tuple[Finding, Severity]] = ()

    def on_mount(self) -> None:
        """Add the columns."""
        for name in COLUMNS:
            self.add_column(name, key=name)

    def show(self, findings: Sequence[Finding]) -> None:
        """Add new findings, and update counts."""
        if not self.columns:
            return  # not on the screen yet
        rated = self._policy.with_severities(findings)
        for number, (finding, _) in enumerate(rated[: len(self._shown)]):
            times = Text(str(finding.count), justify="right")
            if self.get_cell(str(number), "times") != times:
                self.update_cell(str(number), "times", times)
        for number in range(len(self._shown), len(rated)):
            self.add_row(*_row(*rated[number]), key=str(number))
        if len(rated) != len(self._shown):
            self.border_title = f"findings: {len(rated)}"
        self._shown = rated

    @property
    def chosen(self) -> tuple[Finding, Severity] | None:
        """The finding under the cursor, and its severity."""
        return self._shown[self.cursor_row] if 0 <= self.cursor_row < len(self._shown) else None


def _row(finding: Finding, severity: Severity) -> list[Text]:
    place = finding.place
    where = shown(place) if place else finding.object
    first = f"{finding.time_us / 1e3:.3f}"
    return [
        Text(severity.value, STYLE[severity]), Text(finding.rule), Text(str(finding.count), justify="right"),
        Text(first, justify="right"), Text(finding.task), Text(where),
    ]  # fmt: skip


class FindingScreen(ModalScreen[None]):
    """One finding: message, call path, and what its rule means."""

    BINDINGS: ClassVar[list[BindingType]] = [
        (LEAVE.terminal, "leave", "Back"),
        ("enter", "leave"),
        (STOP.terminal, "app.stop", "Stop"),
    ]

    def __init__(self, finding: Finding, severity: Severity) -> None:
        super().__init__()
        self._finding, self._severity = finding, severity

    def compose(self) -> ComposeResult:
        """Build a page that scrolls."""
        rule = RULES.get(self._finding.rule)
        with VerticalScroll(id="page"):
            yield Static(_in_full(self._finding, self._severity), markup=False)
            if rule is not None:
                yield Markdown(rule.page, open_links=False)
        yield Footer(show_command_palette=False)

    def on_mount(self) -> None:
        """Let the arrows scroll."""
        self.query_one("#page").focus()

    def action_leave(self) -> None:
        """Return to the console."""
        self.dismiss()


def _in_full(finding: Finding, severity: Severity) -> Text:
    rule = RULES.get(finding.rule)
    title = f": {rule.title}" if rule else ""
    text = Text.assemble((finding.rule, "bold"), f" ({severity.value}){title}\n\n")
    text.append(f"{readable(finding.message)}\n")
    for detail in finding.details:
        text.append(f"{readable(detail)}\n")
    if finding.object:
        text.append(f"object {finding.object}" + (f", {finding.declaration}" if finding.declaration else "") + "\n")
    text.append(
        f"task {finding.task or '-'}, first at {finding.time_us / 1e3:.3f} ms, {finding.count} times\n\ncall path\n"
    )
    for place in finding.call_path:
        text.append(f"  {shown(place)}\n")
    return text
