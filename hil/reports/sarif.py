"""Reports as SARIF 2.1.0 (OASIS Static Analysis Results Interchange Format), which editors and code hosts show.

A report is one run.  A result's code flow ends at the finding and begins at the task's entry; every further
place that its details name (another task's access, the earlier of two writes) is a thread flow of its own.  Not
written: fixes, graphs, stacks, taxonomies.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from math import isfinite
from pathlib import Path, PurePath
from typing import Any, Final
from urllib.parse import quote

from emulator.c28x.findings import Finding
from emulator.c28x.sites import Place
from emulator.rules import Rule
from hil.files import replacing
from hil.reports.baseline import KnownFinding
from hil.reports.excerpt import excerpt, function_of, places_in, readable, relative_path, source_line
from hil.reports.model import TARGET, Report, ReportEntry, rule_of, versions

SCHEMA: Final = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
#: The folder against which every path within it stands.  It has no address here, so that a file says the same
#: everywhere; a file outside keeps its own.
ROOT: Final = "SRCROOT"
#: The name under which a baseline's fingerprint stands; its number changes with what goes into it.
FINGERPRINT: Final = "c2000Hil/v1"


def write_sarif(path: Path, report: Report) -> None:
    """Write a report.  Raises OSError if it cannot be written."""
    text = json.dumps(sarif(report), indent=2, ensure_ascii=False, allow_nan=False)
    with replacing(path) as new:
        new.write_text(text + "\n", encoding="utf-8")


def sarif(report: Report) -> dict[str, Any]:
    """A report as a SARIF log in plain data."""
    return {"$schema": SCHEMA, "version": "2.1.0", "runs": [_run(report)]}


def _run(report: Report) -> dict[str, Any]:
    ids = dict.fromkeys([*(rule.id for rule in report.rules), *(entry.rule for entry in report.absent)])
    rules = [rule_of(rule_id) for rule_id in ids]
    index = {rule.id: number for number, rule in enumerate(rules)}
    invocation: dict[str, Any] = {"executionSuccessful": not report.run.stopped}
    if report.run.stopped:
        invocation["toolExecutionNotifications"] = [
            {"level": "error", "message": {"text": f"the firmware stopped: {report.run.stopped}"}}
        ]
    return {
        "tool": {
            "driver": {
                "name": "c2000-hil",
                "semanticVersion": versions()["c2000-hil"],
                "shortDescription": {"text": f"Firmware of a {TARGET} in virtual time"},
                "rules": [_rule(rule) for rule in rules],
            }
        },
        "automationDetails": {"id": f"c2000-hil/{report.run.name}"},
        "invocations": [invocation],
        "columnKind": "unicodeCodePoints",
        "originalUriBaseIds": {ROOT: {"description": {"text": "The folder that holds the firmware's package."}}},
        "results": [
            *(_result(entry, index) for entry in report.entries),
            *(_absent(entry, index) for entry in report.absent),
        ],
        "properties": {
            "target": TARGET,
            "setup": report.run.settings,
            "orders": list(report.run.orders),
            "virtual_s": report.run.virtual_s,
            "versions": versions(),
        },
    }


def _rule(rule: Rule) -> dict[str, Any]:
    described: dict[str, Any] = {
        "id": rule.id,
        "shortDescription": {"text": rule.title},
        "defaultConfiguration": {"level": rule.severity.value},
        "properties": {"tags": sorted({rule.family, *rule.how.split("/")}), "source": rule.source},
    }
    if rule.page:
        described["help"] = {"text": rule.page, "markdown": rule.page}
    return described


def _result(entry: ReportEntry, index: dict[str, int]) -> dict[str, Any]:
    finding = entry.finding
    result: dict[str, Any] = {
        "ruleId": finding.rule,
        "ruleIndex": index[finding.rule],
        "level": entry.severity.value,
        "message": {"text": "\n".join((*map(readable, (finding.message, *finding.details)), *_shown_by(entry)))},
        "occurrenceCount": finding.count,
        "partialFingerprints": {FINGERPRINT: entry.known.fingerprint},
        "properties": {
            "task": finding.task,
            "how": finding.how,
            "time_us": finding.time_us,
            "count": finding.count,
            "object": finding.object,
            "declaration": finding.declaration,
            "value": _value(finding.value),
            **({"reaches": entry.reach.summary} if entry.reach else {}),
            **({"tests": list(entry.by)} if entry.by else {}),
        },
    }
    if finding.place is not None:
        result["locations"] = [_location(finding.place, context=True)]
        result["codeFlows"] = [{"threadFlows": list(_flows(finding))}]
        others = dict.fromkeys(place for sentence in finding.details for place in places_in(sentence))
        if others:
            result["relatedLocations"] = [_location(place) for place in others]
    if entry.state:
        result["baselineState"] = entry.state
    if entry.accepted:
        result["suppressions"] = [{"kind": "inSource", "justification": entry.accepted}]
    return result


def _shown_by(entry: ReportEntry) -> list[str]:
    return [f"shown by {entry.shown_by}"] if entry.by else []


def _absent(known: KnownFinding, index: dict[str, int]) -> dict[str, Any]:
    """A known finding that did not appear."""
    return {
        "ruleId": known.rule,
        "ruleIndex": index[known.rule],
        "kind": "informational",
        "level": "none",
        "message": {"text": known.message},
        "partialFingerprints": {FINGERPRINT: known.fingerprint},
        "baselineState": "absent",
    }


def _flows(finding: Finding) -> Iterator[dict[str, Any]]:
    """The call path of the finding, and the other places that it names."""
    steps = [_step(place, source_line(place.file, place.line)) for place in reversed(finding.call_path)]
    steps[-1]["location"]["message"] = {"text": readable(finding.message)}
    steps[-1]["importance"] = "essential"
    yield {"id": finding.task or finding.how, "locations": steps}
    for sentence in finding.details:
        places = places_in(sentence)
        if places:
            text = readable(sentence)
            yield {"message": {"text": text}, "locations": [_step(place, text) for place in places]}


def _step(place: Place, text: str) -> dict[str, Any]:
    location = _location(place)
    location["message"] = {"text": text or function_of(place)}
    return {"location": location}


def _location(place: Place, *, context: bool = False) -> dict[str, Any]:
    region: dict[str, Any] = {"startLine": place.line}
    if place.column:
        region["startColumn"] = place.column
    text = source_line(place.file, place.line)
    if text:
        region["snippet"] = {"text": text}
    path = relative_path(place.file)
    outside = path.startswith("../") or PurePath(path).is_absolute()
    artifact = {"uri": Path(place.file).as_uri()} if outside else {"uri": quote(path), "uriBaseId": ROOT}
    physical: dict[str, Any] = {"artifactLocation": artifact, "region": region}
    around = excerpt(place.file, place.line) if context else ()
    if around:
        physical["contextRegion"] = {
            "startLine": around[0].number,
            "endLine": around[-1].number,
            "snippet": {"text": "\n".join(line.text for line in around) + "\n"},
        }
    module = place.c_file or PurePath(place.file).name
    if place.function:
        name = {"name": place.function, "kind": "function", "fullyQualifiedName": f"{module}::{place.function}"}
    else:
        name = {"name": module, "kind": "module"}
    return {"physicalLocation": physical, "logicalLocations": [name]}


def _value(value: Any) -> Any:
    """A value that JSON has: a number that is none becomes its name."""
    if isinstance(value, float) and not isfinite(value):
        return str(value)
    return value if isinstance(value, int | float | str) else None
