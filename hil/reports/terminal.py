"""A report in a terminal: the one table of findings that every command prints, and on demand each finding in full."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from rich import box
from rich.console import Console, Group, RenderableType
from rich.markup import escape
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

from emulator.rules import Severity, counted
from hil.reports.differences import RunDifferences
from hil.reports.excerpt import excerpt, function_of, location, readable, relative_path, shown
from hil.reports.model import CalledFunction, Report, ReportEntry

STYLE: Final = {Severity.ERROR: "bold red", Severity.WARNING: "yellow", Severity.NOTE: "cyan"}
#: How many differing outputs a finding's details show.
OUTPUTS_SHOWN: Final = 6
#: Findings that the end of a run shows; `hil check`, and the JSON of each command, have them all.
MAX_SHOWN: Final = 30
#: Notes of one rule on one peripheral or file that a table shows; if there are more, the last row counts the rest.
NOTES_ALIKE: Final = 3
#: From this width on everything has a column of its own.
WIDE: Final = 140


def print_report(report: Report, console: Console, *, details: bool = False, most: int | None = None) -> None:
    """The findings as a table (in full with `details`), what is gone or accepted in vain, functions that were called.

    `most`: only so many rows, the worst.  Without `details`, one row counts the rest of many notes that are alike.
    """
    if report.entries:
        console.print(Text(summary(report.entries), "bold"))
        rows = [[entry] for entry in report.worst_first] if details else _rows(report.worst_first)
        console.print(findings_table(rows, console.width, most))
    if details:
        for number, entry in enumerate(report.worst_first, 1):
            console.print(_panel(number, entry))
    for line in _lines(report):
        console.print(escape(line), soft_wrap=True)


def _lines(report: Report) -> Iterator[str]:
    """The lines besides the findings."""
    if report.proof:
        proof = report.proof
        yield f"Two fills ({proof.fill_a}, {proof.fill_b}): {proof.whole.summary}"
    for known in report.absent:
        yield f"gone: {known.rule} in {known.c_file}: {known.function} ({known.object})"
    for declared in report.idle:
        yield f"{relative_path(declared.file)}:{declared.line}: hil: allow {declared.text}: nothing was found there"
    if report.run.moved:
        yield f"inputs that no known part of its board drives, moved in a further run: {', '.join(report.run.moved)}"
    if report.run.not_silenced:
        yield f"could fall silent, which was not tried (--silence): {', '.join(report.run.not_silenced)}"
    called = [f"{one.name} ({one.calls})" for one in report.run.functions if one.called]
    if called:
        yield f"called, with how many argument lists: {', '.join(called)}"
    left: dict[str, list[CalledFunction]] = {}
    for one in report.run.functions:
        if one.note and one.called:
            yield f"{_placed(one)}: {one.note}"
        elif one.note:
            left.setdefault(one.note, []).append(one)
    for note, functions in left.items():
        several = f"{', '.join(one.name for one in functions)}: each"
        which = several if len(functions) > 1 else _placed(functions[0])
        yield f"not called with generated arguments: {which}: {note}"


def _placed(function: CalledFunction) -> str:
    return f"{function.name} ({relative_path(function.file)}:{function.line})"


def _rows(entries: Iterable[ReportEntry]) -> list[list[ReportEntry]]:
    """Rows of a table: each finding alone, but of many notes alike the first ones alone and the rest together."""
    rows: list[list[ReportEntry]] = []
    alike: dict[tuple[str, str, str], list[ReportEntry]] = {}
    for entry in entries:
        if entry.severity is Severity.NOTE:
            alike.setdefault((entry.finding.rule, _owner(entry), entry.state_word), []).append(entry)
        else:
            rows.append([entry])
    for notes in alike.values():
        alone = len(notes) if len(notes) <= NOTES_ALIKE else NOTES_ALIKE - 1
        rows += [[note] for note in notes[:alone]]
        if notes[alone:]:
            rows.append(notes[alone:])
    return rows


def _owner(entry: ReportEntry) -> str:
    """The first name in the object of a finding: a peripheral (`MemCfgRegs`), a C file (`us`); empty without object."""
    return (entry.finding.object or "").partition(".")[0]


def findings_table(rows: Sequence[Sequence[ReportEntry]], width: int, most: int | None = None) -> Table:
    """A table of findings: each row is one finding, or several of one rule that it counts."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    make = _in_columns if width >= WIDE else _stacked
    make(table, rows[:most])
    if left := sum(map(len, rows[most:])) if most is not None else 0:
        table.caption = f"{left} more"
        table.caption_justify = "left"
    return table


def _in_columns(table: Table, rows: Iterable[Sequence[ReportEntry]]) -> None:
    table.add_column("severity")
    table.add_column("rule", no_wrap=True)
    table.add_column("what", ratio=1, overflow="fold")
    table.add_column("where", overflow="fold")
    table.add_column("first seen", no_wrap=True)
    for row in rows:
        first = row[0]
        severity, what = Text(first.severity.value, STYLE[first.severity]), _what(row)
        for more in _besides(row):
            what.append(f"\n{more}", "dim")
        where = Text("\n").join(_where(row))
        table.add_row(severity, first.finding.rule, what, where, "\n".join(_seen(row)), style=_style(first))


def _stacked(table: Table, rows: Iterable[Sequence[ReportEntry]]) -> None:
    table.add_column("finding", no_wrap=True)
    table.add_column("what, where, first seen", overflow="fold")
    for row in rows:
        first = row[0]
        finding = Text.assemble((first.severity.value, STYLE[first.severity]), "\n", first.finding.rule)
        lines = [_what(row)]
        stands = Text(" ").join(_where(row))
        if seen := ", ".join(_seen(row)):
            stands.append(f"  {seen}" if stands else seen, "dim")
        if stands:
            lines.append(stands)
        lines += [Text(more, "dim") for more in _besides(row)]
        table.add_row(finding, Text("\n").join(lines), style=_style(first))


def _what(row: Sequence[ReportEntry]) -> Text:
    """The message of one finding; of several, their number."""
    if len(row) == 1:
        return Text(readable(row[0].finding.message))
    owner = _owner(row[0])
    return Text(f"{len(row)} more of {owner}" if owner else f"{len(row)} more")


def _where(row: Sequence[ReportEntry]) -> list[Text]:
    """The place of one finding; of several, their lines in each file."""
    places = [entry.finding.place for entry in row if entry.finding.place]
    if len(row) == 1:
        return [Text(location(place), "bold") for place in places] + [Text(function_of(p), "dim") for p in places]
    lines: dict[str, list[int]] = {}
    for place in places:
        lines.setdefault(relative_path(place.file), []).append(place.line)
    return [
        Text(f"{file}:{min(of)} to {max(of)}" if min(of) < max(of) else f"{file}:{min(of)}", "bold")
        for file, of in lines.items()
    ]


def _seen(row: Sequence[ReportEntry]) -> list[str]:
    """The task, time and count; empty for several findings, and for one that the source shows without a run."""
    finding = row[0].finding
    if len(row) > 1 or finding.how == "static":
        return []
    times = f", {finding.count} times" if finding.count > 1 else ""
    return [*filter(None, [finding.task]), f"{finding.time_us / 1e3:.3f} ms{times}"]


def _besides(row: Sequence[ReportEntry]) -> Iterator[str]:
    """The properties of a finding that only some commands know."""
    entry = row[0]
    if entry.accepted:
        yield "accepted in the source" if len(row) > 1 else f"accepted in the source: {entry.accepted}"
    elif entry.state:
        yield "known" if entry.state == "unchanged" else entry.state
    if len(row) > 1:
        return
    if entry.reach:
        yield f"reaches: {entry.reach.summary}"
    if entry.by:
        yield f"shown by {entry.shown_by}"


def as_a_compiler(report: Report) -> Iterator[str]:
    """The findings as a compiler prints its own, `FILE:LINE:COLUMN: SEVERITY: MESSAGE [RULE]`: editors read that."""
    for entry in report.worst_first:
        finding = entry.finding
        if entry.state_word in ("accepted", "unchanged"):
            continue
        place = finding.place
        where = "hil" if place is None else f"{relative_path(place.file)}:{place.line}:{place.column or 1}"
        yield f"{where}: {entry.severity.value}: {readable(finding.message)} [{finding.rule}]"


def summary(entries: Iterable[ReportEntry]) -> str:
    """The number of findings of each severity: "11 errors, 35 warnings"."""
    return counted(entry.severity for entry in entries)


def last_line(report: Report) -> str:
    """The result in one line."""
    parts = [summary(report.entries)]
    if unchanged := sum(entry.state == "unchanged" for entry in report.entries):
        parts.append(f"{unchanged} known")
    if accepted := report.accepted:
        parts.append(f"{accepted} accepted in the source")
    if report.absent:
        parts.append(f"{len(report.absent)} gone")
    if report.turned_off:
        parts.append(f"{report.turned_off} turned off")
    line = ", ".join(parts)
    if not report.entries:
        return line
    counted = len(report.counted)
    return f"{line}; {counted or 'none'} {'fail' if counted > 1 else 'fails'} the check"


def _style(entry: ReportEntry) -> str | None:
    return "dim" if entry.state_word in ("accepted", "unchanged") else None


def _panel(number: int, entry: ReportEntry) -> Panel:
    title = f"{number}  {entry.severity.value}: {entry.finding.rule}"
    return Panel(
        Group(*_parts(entry)), title=escape(title), title_align="left", border_style=STYLE[entry.severity],
    )  # fmt: skip


def _parts(entry: ReportEntry) -> Iterator[RenderableType]:
    finding = entry.finding
    yield Text(readable(finding.message), "bold")
    for sentence in finding.details:
        yield Text(readable(sentence))
    if finding.object:
        declared = f", declared {finding.declaration}" if finding.declaration else ""
        yield Text(f"object {finding.object}{declared}")
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


def _reach(reach: RunDifferences) -> Iterator[RenderableType]:
    yield Text(f"reaches: {reach.summary}")
    if reach.frames.numbers:
        yield Text(f"frame {reach.frames.numbers[0]}: {reach.frames.first[0]} becomes {reach.frames.first[1]}")
    for d in [d for d in reach.differences if not d.only_times][:OUTPUTS_SHOWN]:
        change = f"number {d.index}: {d.shown(d.a)} becomes {d.shown(d.b)}"
        yield Text(f"  {d.output}: from {d.first_us:.3f} us ({change}), {d.differing} of {d.compared}")
