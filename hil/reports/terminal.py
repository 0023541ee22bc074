"""A report in a terminal: one line a finding, and on demand each finding in full."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from rich.console import Console, Group, RenderableType
from rich.markup import escape
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

from emulator.rules import Severity
from hil.reports.differences import Reach
from hil.reports.excerpt import excerpt, location, readable, relative_path, shown
from hil.reports.model import Entry, Report

STYLE: Final = {Severity.ERROR: "red", Severity.WARNING: "yellow", Severity.NOTE: "cyan"}
#: How many differing outputs a finding's details show.
OUTPUTS_SHOWN: Final = 6


def print_report(report: Report, console: Console, *, details: bool = False) -> None:
    """The findings as a table (and in full with `details`), what a baseline knew, and the count."""
    if report.entries:
        console.print(_table(report))
    if details:
        for number, entry in enumerate(report.worst_first, 1):
            console.print(_panel(number, entry))
    if report.proof:
        proof = report.proof
        console.print(
            f"Two fills ({proof.fill_a}, {proof.fill_b}): {escape(proof.whole.summary)}", soft_wrap=True,
        )  # fmt: skip
    for known in report.absent:
        gone = f"gone: {known.rule} in {known.c_file}: {known.function} ({escape(known.object)})"
        console.print(gone, soft_wrap=True)


def print_places(report: Report, console: Console, *, details: bool = False) -> None:
    """The findings of driver files as a table by place (and in full with `details`), and the functions not called."""
    if report.entries:
        console.print(_places(report))
    if details:
        for number, entry in enumerate(report.worst_first, 1):
            console.print(_panel(number, entry))
    for known in report.absent:
        gone = f"gone: {known.rule} in {known.c_file}: {known.function} ({escape(known.object)})"
        console.print(gone, soft_wrap=True)
    for declared in report.idle:
        place = f"{relative_path(declared.file)}:{declared.line}"
        console.print(escape(f"{place}: hil: allow {declared.text}: nothing was found there"), soft_wrap=True)
    called = [f"{one.name} ({one.calls})" for one in report.run.functions if one.called]
    if called:
        console.print(f"called, with how many argument lists: {escape(', '.join(called))}", soft_wrap=True)
    for one in report.run.functions:
        if one.note:
            what = "" if one.called else "not called: "
            place = f"{relative_path(one.file)}:{one.line}"
            console.print(f"{what}{escape(one.name)} ({escape(place)}): {escape(one.note)}", soft_wrap=True)


def as_a_compiler(report: Report) -> Iterator[str]:
    """The findings as a compiler prints its own, `FILE:LINE:COLUMN: SEVERITY: MESSAGE [RULE]`: editors read that."""
    for entry in report.worst_first:
        finding = entry.finding
        if entry.standing in ("accepted", "unchanged"):
            continue
        place = finding.place
        where = "hil" if place is None else f"{relative_path(place.file)}:{place.line}:{place.column or 1}"
        yield f"{where}: {entry.severity.value}: {readable(finding.message)} [{finding.rule}]"


def summary(report: Report) -> str:
    """How many findings of each severity, in words: "11 errors, 35 warnings"."""
    counts = [(report.count(severity), severity.value) for severity in reversed(Severity)]
    texts = [f"{number} {name}{'' if number == 1 else 's'}" for number, name in counts if number]
    return ", ".join(texts) or "no findings"


def last_line(report: Report) -> str:
    """What it came to, in one line."""
    number = len(report.entries)
    line = f"{number} finding{'' if number == 1 else 's'}" + (f" ({summary(report)})" if number else "")
    unchanged = sum(entry.state == "unchanged" for entry in report.entries)
    if unchanged:
        line += f", {unchanged} known"
    if accepted := report.accepted:
        line += f", {accepted} accepted in the source"
    if report.absent:
        line += f", {len(report.absent)} gone"
    if report.turned_off:
        line += f", {report.turned_off} turned off"
    return f"{line}; {len(report.counted)} count"


def _table(report: Report) -> Table:
    table = Table(title=f"Findings: {len(report.entries)}", title_justify="left")
    table.add_column("#", justify="right")
    for heading in ("severity", "rule", "object", "where", "task"):
        table.add_column(heading, overflow="fold")
    for heading in ("first (ms)", "times"):
        table.add_column(heading, justify="right")
    known = any(entry.standing for entry in report.entries)
    if known:
        table.add_column("state")
    proven = any(entry.reach for entry in report.entries)
    if proven:
        table.add_column("reaches", overflow="fold")
    for number, entry in enumerate(report.worst_first, 1):
        finding, place = entry.finding, entry.finding.place
        row: list[str | Text] = [
            str(number), Text(entry.severity.value, STYLE[entry.severity]), finding.rule, escape(finding.object),
            escape(shown(place)) if place else "", finding.task or finding.how,
            f"{finding.time_us / 1e3:.3f}" if finding.how != "static" else "", str(finding.count),
        ]  # fmt: skip
        if known:
            row.append(entry.standing)
        if proven:
            row.append(escape(entry.reach.summary) if entry.reach else "")
        table.add_row(*row, style=_style(entry))
    return table


def _style(entry: Entry) -> str | None:
    return "dim" if entry.standing in ("accepted", "unchanged") else None


def _places(report: Report) -> Table:
    """Driver files: where one edits, and what is wrong there."""
    table = Table(title=summary(report), title_justify="left")
    for heading in ("where", "severity", "rule", "object", "message"):
        table.add_column(heading, overflow="fold")
    known = any(entry.standing for entry in report.entries)
    if known:
        table.add_column("state")
    for entry in report.worst_first:
        finding, place = entry.finding, entry.finding.place
        row: list[str | Text] = [
            escape(location(place)) if place else "", Text(entry.severity.value, STYLE[entry.severity]), finding.rule,
            escape(finding.object), Text(readable(finding.message)),
        ]  # fmt: skip
        if known:
            row.append(entry.standing)
        table.add_row(*row, style=_style(entry))
    return table


def _panel(number: int, entry: Entry) -> Panel:
    title = f"{number}  {entry.severity.value}: {entry.finding.rule}"
    return Panel(
        Group(*_parts(entry)), title=escape(title), title_align="left", border_style=STYLE[entry.severity],
    )  # fmt: skip


def _parts(entry: Entry) -> Iterator[RenderableType]:
    finding = entry.finding
    yield Text(readable(finding.message), "bold")
    for sentence in finding.details:
        yield Text(readable(sentence))
    if finding.declaration:
        yield Text(f"declared: {finding.declaration}")
    if finding.place:
        for line in excerpt(finding.place.file, finding.place.line):
            mark = ">" if line.marked else " "
            yield Text(f"{mark} {line.number:5}  {line.text}", "bold" if line.marked else "dim")
    for step, place in enumerate(finding.call_path):
        yield Text(f"{'at' if step == 0 else 'called from'} {shown(place)}")
    if finding.how != "static":
        value = "" if finding.value is None else f", value {finding.value}"
        yield Text(f"first at {finding.time_us:.3f} us in {finding.task}, {finding.count} times{value}")
    if entry.reach:
        yield from _reach(entry.reach)
    if entry.accepted:
        yield Text(f"accepted in the source: {entry.accepted}")
    yield Text(f"fingerprint {entry.known.fingerprint}; hil explain {finding.rule}", "dim")


def _reach(reach: Reach) -> Iterator[RenderableType]:
    yield Text(f"reaches: {reach.summary}")
    if reach.frames.numbers:
        yield Text(f"frame {reach.frames.numbers[0]}: {reach.frames.first[0]} becomes {reach.frames.first[1]}")
    for d in [d for d in reach.differences if not d.only_times][:OUTPUTS_SHOWN]:
        change = f"number {d.index}: {d.shown(d.a)} becomes {d.shown(d.b)}"
        yield Text(f"  {d.output}: from {d.first_us:.3f} us ({change}), {d.differing} of {d.compared}")
