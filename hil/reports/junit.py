"""A report as JUnit XML, which build servers show as tests.

One case a finding: it fails if it counts, is skipped if it is known or below the threshold.  A report without findings
is one case that passes.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final
from xml.etree import ElementTree

from hil.files import replacing
from hil.reports.excerpt import readable, relative_path, shown
from hil.reports.model import Report, ReportEntry

_ILLEGAL: Final = re.compile("[^\\t\\n\\r\\x20-\\ud7ff\\ue000-\\ufffd\\U00010000-\\U0010ffff]")


def write_junit(path: Path, report: Report) -> None:
    """Write a report.  Raises OSError if it cannot be written."""
    tree = ElementTree.ElementTree(junit(report))
    ElementTree.indent(tree)
    with replacing(path) as new:
        tree.write(new, encoding="utf-8", xml_declaration=True)


def junit(report: Report) -> ElementTree.Element:
    """A report as a `testsuites` element."""
    root = ElementTree.Element("testsuites")
    failed = len(report.counted)
    errors = int(bool(report.run.stopped))
    faults, silent = report.run.faults, report.run.silent
    suite = ElementTree.SubElement(
        root, "testsuite", name=f"hil check {report.run.name}",
        tests=str(max(1, len(report.entries)) + errors + len(faults)),
        failures=str(failed + len(silent)), errors=str(errors), skipped=str(len(report.entries) - failed),
        time=f"{report.run.virtual_s:.6f}",
    )  # fmt: skip
    properties = ElementTree.SubElement(suite, "properties")
    for name, value in report.run.settings.items():
        ElementTree.SubElement(properties, "property", name=name, value=str(value))
    if errors:
        case = ElementTree.SubElement(suite, "testcase", classname="firmware", name="runs on")
        ElementTree.SubElement(case, "error", message=legal(report.run.stopped))
    for fault in faults:
        case = ElementTree.SubElement(suite, "testcase", classname="faults", name=legal(str(fault.fault)))
        if fault in silent:
            ElementTree.SubElement(case, "failure", message=legal(str(fault)))
    if not report.entries:
        ElementTree.SubElement(suite, "testcase", classname="findings", name="none")
    for entry in report.entries:
        _case(suite, entry, fails=report.fails(entry))
    return root


def _case(suite: ElementTree.Element, entry: ReportEntry, *, fails: bool) -> None:
    finding, place = entry.finding, entry.finding.place
    where = shown(place) if place else "outside the firmware"
    case = ElementTree.SubElement(
        suite, "testcase", classname=f"{entry.rule.family}.{finding.rule}", name=legal(f"{where}: {finding.object}"),
    )  # fmt: skip
    if place:
        case.set("file", relative_path(place.file))
        case.set("line", str(place.line))
    if fails:
        failure = ElementTree.SubElement(case, "failure", type=entry.severity.value, message=legal(finding.message))
        by = [f"shown by {entry.shown_by}"] if entry.by else []
        failure.text = legal("\n".join((*map(readable, finding.details), *map(shown, finding.call_path), *by)))
    else:
        reason = f"{entry.severity.value}: below the threshold"
        if entry.accepted:
            reason = f"accepted in the source: {entry.accepted}"
        elif entry.state == "unchanged":
            reason = "known"
        ElementTree.SubElement(case, "skipped", message=legal(f"{reason}: {finding.message}"))


def legal(text: str) -> str:
    """XML 1.0 knows no control characters but tab and line ends; a message may quote what was on the wire."""
    return _ILLEGAL.sub("\N{REPLACEMENT CHARACTER}", text)
