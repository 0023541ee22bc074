"""Findings at the line that one edits: in the files that were named, not in what they bring with them."""

from __future__ import annotations

from collections.abc import Set
from dataclasses import replace

from emulator.c28x.findings import Finding


def anchored(finding: Finding, files: Set[str], others: Set[str]) -> Finding | None:
    """A finding at the innermost place of its call path that stands in `files`, or in a header of theirs.

    `others` are the modules that the files bring with them.  None: what is found there happens without the files.
    """
    if finding.place is None or finding.place.file not in others:
        return finding
    for depth, place in enumerate(finding.call_path):
        if place.file in files:
            seen = f"seen in {finding.place}"
            return replace(
                finding, place=place, call_path=finding.call_path[depth:], details=(*finding.details, seen)
            )
    return None
