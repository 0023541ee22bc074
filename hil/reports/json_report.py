"""Reports as JSON, for programs.  `report-1.schema.json` describes every key; `schema` names its version."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from enum import Enum
from math import isfinite
from pathlib import Path
from typing import Any, Final

from emulator.c28x.findings import Finding
from emulator.c28x.sites import Place
from emulator.rules import Rule, Severity
from hil.files import replacing
from hil.reports.differences import OutputDifference, RunDifferences, TwoFillProof
from hil.reports.excerpt import from_here, readable, relative_path
from hil.reports.model import TARGET, Report, ReportEntry, versions

#: Grows when a key goes away or changes its meaning; new keys do not change it.
SCHEMA: Final = "c2000-hil-report-1"


def write_json(path: Path, report: Report) -> None:
    """Write a report.  Raises OSError if it cannot be written."""
    text = json.dumps(as_dict(report), indent=2, ensure_ascii=False, allow_nan=False)
    with replacing(path) as new:
        new.write_text(text + "\n", encoding="utf-8")


def as_dict(report: Report) -> dict[str, Any]:
    """A report as plain data."""
    run = report.run
    data = {
        "schema": SCHEMA,
        "versions": versions(),
        "target": TARGET,
        "run": {
            "name": run.name,
            "setup": run.settings or None,
            "orders": run.orders,
            "virtual_s": run.virtual_s,
            "stopped": run.stopped or None,
            "outcome": run.outcome,
            "uncalibrated_factor": run.uncalibrated_factor,
            **({"faults": [fault.as_dict() for fault in run.faults]} if run.faults else {}),
            "not_silenced": list(run.not_silenced),
            "moved_inputs": list(run.moved),
            "functions": [{**asdict(one), "file": relative_path(one.file)} for one in run.functions],
        },
        "failed": report.failed,
        "counts": {severity.value: report.count(severity) for severity in Severity},
        "counted": len(report.counted),
        "turned_off": report.turned_off,
        "findings": findings_of(report),
        "absent": [asdict(known) for known in report.absent],
        "proof": _proof(report.proof) if report.proof else None,
        "rules": {rule.id: _rule(rule) for rule in report.rules},
    }
    plain: dict[str, Any] = _plain(data)
    return plain


def findings_of(report: Report) -> list[dict[str, Any]]:
    """Its findings as every command's JSON has them."""
    return [_entry(entry) for entry in report.entries]


def finding_of(finding: Finding) -> dict[str, Any]:
    """A finding as plain data, its paths as everywhere (`relative_path`)."""
    return {
        **finding.as_dict(),
        "file": relative_path(finding.place.file) if finding.place else "",
        "call_path": [_step(place) for place in finding.call_path],
        "details": [readable(sentence) for sentence in finding.details],
    }


def _entry(entry: ReportEntry) -> dict[str, Any]:
    return {
        **finding_of(entry.finding),
        "severity": entry.severity.value,
        "fingerprint": entry.known.fingerprint,
        "statement": entry.known.statement,
        "state": entry.state or None,
        "accepted": entry.accepted or None,
        "reaches": _reach(entry.reach) if entry.reach else None,
        **({"shown_by": list(entry.by)} if entry.by else {}),
    }


def _step(place: Place) -> dict[str, Any]:
    return {
        "file": relative_path(place.file), "line": place.line, "column": place.column, "function": place.function,
        "c_file": place.c_file,
    }  # fmt: skip


def _rule(rule: Rule) -> dict[str, Any]:
    return {"family": rule.family, "severity": rule.severity.value, "how": rule.how, "title": rule.title}


def _proof(proof: TwoFillProof) -> dict[str, Any]:
    return {"fills": [proof.fill_a, proof.fill_b], "whole": _reach(proof.whole)}


def _reach(reach: RunDifferences) -> dict[str, Any]:
    return {
        "summary": reach.summary,
        "anything": reach.anything,
        "seconds": reach.seconds,
        "tried": reach.tried,
        "stopped": reach.stopped,
        "frames": asdict(reach.frames),
        "outputs": [_difference(difference) for difference in reach.differences],
    }


def _difference(difference: OutputDifference) -> dict[str, Any]:
    return {**asdict(difference), "only_times": difference.only_times}


def _plain(value: Any) -> Any:
    """A value that JSON can hold; NaN and infinity become null."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, str):
        return from_here(value)
    return None if isinstance(value, float) and not isfinite(value) else value
