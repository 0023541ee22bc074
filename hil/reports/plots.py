"""Pictures of a report as SVG text within a page.

They take the page's colours and name no address; two of the same data are the same text.
"""

from __future__ import annotations

import io
import re
from typing import Any, Final

from emulator.rules import Severity
from hil.client.plot import draw_drive, place
from hil.reports.model import DrivenTrack, Report, ReportEntry

COLOUR: Final = {Severity.ERROR: "#d33a2c", Severity.WARNING: "#d99000", Severity.NOTE: "#2a7ab8"}


def timeline(report: Report) -> str:
    """First occurrences over virtual time, a row a rule, or a test: each has its own time.

    Empty if nothing was found while running.
    """
    entries = [entry for entry in report.entries if entry.finding.how == "dynamic"]
    if not entries:
        return ""
    names = list(dict.fromkeys(map(_row, entries)))[::-1]
    figure, axes = _figure(8, 0.9 + 0.28 * len(names))
    for severity in Severity:
        shown = [entry for entry in entries if entry.severity is severity]
        times = [entry.finding.time_us / 1e6 for entry in shown]
        rows = [names.index(_row(entry)) for entry in shown]
        if shown:
            axes.plot(times, rows, "o", color=COLOUR[severity], label=severity.value)
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(-0.6, len(names) - 0.4)
    end = max(report.run.virtual_s, *(entry.finding.time_us / 1e6 for entry in entries)) or 1.0
    axes.set_xlim(-0.02 * end, 1.02 * end)
    axes.set_xlabel("virtual time of the first occurrence (s)")
    axes.grid(axis="x", alpha=0.3)
    axes.legend(loc="upper left", bbox_to_anchor=(1, 1), fontsize="small")
    return _svg(figure)


def _row(entry: ReportEntry) -> str:
    return entry.by[0].rpartition("/")[2] if entry.by else entry.rule.id


def trajectory(drive: DrivenTrack) -> str:
    """Walls, true path and odometry; empty if the robot has no path."""
    if not drive.true_path:
        return ""
    start = drive.true_path[0]
    figure, axes = _figure(8, 5)
    odometry = place([(p.x_m, p.y_m) for p in drive.odometry], start.x_m, start.y_m, start.heading_rad)
    draw_drive(
        axes, odometry=odometry, cloud=(), true_path=[(p.x_m, p.y_m) for p in drive.true_path], walls=drive.walls,
        posts=drive.posts,
    )  # fmt: skip
    return _svg(figure)


def _figure(width: float, height: float) -> tuple[Any, Any]:
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained", facecolor="none")
    FigureCanvasSVG(figure)
    axes = figure.add_subplot(facecolor="none")
    return figure, axes


def _svg(figure: Any) -> str:
    from matplotlib import rc_context

    text = io.StringIO()
    with rc_context({"svg.hashsalt": "hil", "svg.fonttype": "none"}):
        figure.savefig(text, format="svg")
    svg = text.getvalue()
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg[svg.index("<svg") :], flags=re.DOTALL)
    # Black is the colour of the page's text; white is its background.
    svg = re.sub(r"fill: #ffffff", "fill: none", svg)
    svg = re.sub(r"(fill|stroke): (?:#000000|black)", r"\1: currentColor", svg)
    return svg.replace("<svg ", '<svg fill="currentColor" role="img" ', 1)
