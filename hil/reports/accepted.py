"""Findings that the source accepts: ``hil: allow RULE, reason`` in a comment at the statement."""

from __future__ import annotations

from collections.abc import Iterable

from emulator.c28x.declarations import UserDeclaration, declarations
from emulator.c28x.findings import Finding
from emulator.rules import RULES
from hil.reports.policy import nearest


def allowances(file: str) -> dict[UserDeclaration, tuple[str, str]]:
    """Each `allow` of a file with its rule and its reason.

    Raises ValueError, one line with file and line, for a rule that is none, and for one without a reason.
    """
    found = {}
    for declared in declarations(file):
        if declared.word != "allow":
            continue
        rule, reason = (part.strip() for part in f"{declared.text},".split(",", 1))
        reason = reason.removesuffix(",").strip()
        if rule not in RULES:
            raise ValueError(f"{declared}: no rule {rule!r}: {nearest(rule)}")
        if not reason:
            raise declared.wrong("why is missing")
        found[declared] = rule, reason
    return found


def acceptance(finding: Finding) -> tuple[UserDeclaration, str] | None:
    """The comment that accepts a finding, and its reason; None: no comment does.  Raises ValueError as `allowances`."""
    place = finding.place
    if place is None:
        return None
    for declared, (rule, reason) in allowances(place.file).items():
        if rule == finding.rule and declared.about[0] <= place.line <= declared.about[1]:
            return declared, reason
    return None


def why_accepted(finding: Finding) -> str:
    """The reason in the source; empty: no comment accepts the finding.

    For a finding that is shown while the program runs.  A file with a wrong `hil: allow` accepts nothing; the report at
    the end names it.
    """
    try:
        allowed = acceptance(finding)
    except ValueError:
        return ""
    return allowed[1] if allowed else ""


def idle(files: Iterable[str], used: Iterable[UserDeclaration]) -> list[UserDeclaration]:
    """The `allow` comments of `files` that no finding needed."""
    asked = set(used)
    return [declared for file in files for declared in allowances(file) if declared not in asked]
