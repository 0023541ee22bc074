"""A report as one HTML file: no script, nothing loaded from elsewhere, light and dark, filters in style sheets.

`report.html.j2` is the template; this module gives it the report and a few filters.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Final

from jinja2 import Environment, PackageLoader, StrictUndefined
from markdown_it import MarkdownIt
from markupsafe import Markup

from emulator.rules import Severity
from hil.files import replacing
from hil.reports.excerpt import excerpt, readable, relative_path, shown
from hil.reports.model import TARGET, Report, ReportEntry, versions
from hil.reports.plots import timeline, trajectory
from hil.reports.terminal import last_line, summary

#: Outputs of the proof that the page lists; the JSON report has them all.
OUTPUTS_SHOWN: Final = 40


def write_html(path: Path, report: Report) -> None:
    """Write a report.  Raises OSError if it cannot be written."""
    with replacing(path) as new:
        new.write_text(html(report), encoding="utf-8")


def html(report: Report) -> str:
    """A report as the text of one page."""
    environment = Environment(
        loader=PackageLoader("hil.reports", "."), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True,
    )  # fmt: skip
    environment.filters.update(markdown=markdown, readable=readable, place=shown, relative=relative_path)
    return environment.get_template("report.html.j2").render(
        report=report,
        setup=report.run.settings,
        versions=versions(),
        target=TARGET,
        last_line=last_line(report),
        summary=summary(report.entries),
        severities=[severity.value for severity in reversed(Severity) if report.count(severity)],
        tasks=_tasks(report.entries),
        source=lambda entry: excerpt(entry.finding.place.file, entry.finding.place.line) if entry.finding.place else (),
        task_of=_task,
        # Functions called on their own have each its own time; so have tests, each its own row.
        timeline=Markup(timeline(report)) if report.run.virtual_s or any(e.by for e in report.entries) else "",
        trajectory=Markup(trajectory(report.drive)) if report.drive else "",
        outputs_shown=OUTPUTS_SHOWN,
    )


def _task(entry: ReportEntry) -> str:
    return entry.finding.task or entry.finding.how


def _tasks(entries: Iterable[ReportEntry]) -> list[str]:
    return list(dict.fromkeys(_task(entry) for entry in entries))


def markdown(text: str) -> Markup:
    """A rule's page; markup within it is shown, not obeyed."""
    return Markup(MarkdownIt("commonmark", {"html": False}).enable("table").render(text))
