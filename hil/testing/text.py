"""The text of findings in a test report: a finding as a few lines, those of a session as a table."""

from __future__ import annotations

import io

from rich.console import Console

from emulator.c28x.findings import Finding
from emulator.clock import ms
from hil.reports.excerpt import location, shown, source_line
from hil.reports.model import Report, ReportEntry
from hil.reports.terminal import MAX_SHOWN, print_report


def table(report: Report, width: int, *, coloured: bool) -> str:
    """The table of findings that every command shows."""
    written = io.StringIO()
    terminal = Console(file=written, width=width, force_terminal=coloured, highlight=False, emoji=False)
    print_report(report, terminal, most=MAX_SHOWN)
    return written.getvalue().rstrip()


def one_line(finding: Finding) -> str:
    """A finding in one line: rule, message, place."""
    where = f" ({location(finding.place)})" if finding.place else ""
    return f"{finding.rule}: {finding.message}{where}"


def entry_lines(entry: ReportEntry) -> list[str]:
    """The lines of a finding: rule, message, place, call path, task, time, value, count."""
    finding, place = entry.finding, entry.finding.place
    lines = [f"{entry.severity.value} {finding.rule}: {finding.message}"]
    if place is not None:
        lines.append(f"    at       {shown(place)}")
        lines.append(f"             {source_line(place.file, place.line)}")
    lines += [f"    called   {shown(p)}" for p in finding.call_path[1:]]
    if finding.object:
        declared = f", declared {finding.declaration}" if finding.declaration else ""
        lines.append(f"    object   {finding.object}{declared}")
    if finding.value is not None:
        lines.append(f"    value    {finding.value}")
    if finding.how == "static":
        lines.append("    seen     in the source, before it ran")
    else:
        lines.append(f"    seen     in {finding.task} at {ms(finding.time_cycles):.4f} ms, {_times(finding.count)}")
    return lines + [f"    note     {detail}" for detail in finding.details]


def _times(count: int) -> str:
    return "once" if count == 1 else f"{count} times"
