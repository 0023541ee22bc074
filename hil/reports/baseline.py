"""Known findings: a file of fingerprints, kept beside a project, so that only new findings count.

A fingerprint says what is wrong where, but in no line number: rule, C function, object and statement.  Code above it
may move; a finding whose statement is rewritten is a new one.
"""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

from emulator.c28x.findings import Finding
from hil.files import parse_json, read_text, replacing
from hil.reports.excerpt import statement

#: Version of the file's layout.
VERSION: Final = 1


@dataclass(frozen=True, slots=True)
class KnownFinding:
    """A finding in the form of a baseline."""

    fingerprint: str
    rule: str
    c_file: str
    function: str
    object: str
    statement: str
    message: str


def known(findings: Iterable[Finding]) -> list[KnownFinding]:
    """Each finding in the form of a baseline, in the given order.

    The same statement twice in a function gives a second fingerprint, counted in the order of the lines.
    """
    listed = list(findings)
    bare = [_bare(finding) for finding in listed]
    seen: Counter[tuple[str, ...]] = Counter()
    fingerprints = [""] * len(listed)
    for index in sorted(range(len(listed)), key=lambda i: _line(listed[i])):
        key = bare[index]
        seen[key] += 1
        text = "|".join((*key, str(seen[key])) if seen[key] > 1 else key)
        fingerprints[index] = hashlib.sha256(text.encode()).hexdigest()[:16]
    return [
        KnownFinding(fingerprint, *key, message=finding.message)
        for fingerprint, key, finding in zip(fingerprints, bare, listed, strict=True)
    ]


def _bare(finding: Finding) -> tuple[str, str, str, str, str]:
    place = finding.place
    if place is None:
        return finding.rule, "", "", finding.object, ""
    return finding.rule, place.c_file, place.function, finding.object, statement(place.file, place.line)


def _line(finding: Finding) -> int:
    return finding.place.line if finding.place else 0


@dataclass(frozen=True, slots=True)
class Baseline:
    """The known findings of a project."""

    entries: tuple[KnownFinding, ...] = ()

    @classmethod
    def read(cls, path: Path) -> Baseline:
        """Read a baseline.  Raises ValueError with the file if it is not a baseline; OSError if it cannot be read."""
        if not path.is_file():
            raise ValueError(f"{path}: there is no such baseline: write it with hil check --update-baseline")
        content = read_text(path)
        try:
            data = parse_json(content, path.name)
            if data["version"] != VERSION:
                raise ValueError(f"version {data['version']}")
            return cls(tuple(_entry(item) for item in data["findings"]))
        except (ValueError, KeyError, TypeError) as error:
            raise ValueError(
                f"{path}: not a baseline of version {VERSION} ({error}): write it with hil check --update-baseline"
            ) from None

    def write(self, path: Path) -> None:
        """Write the baseline, sorted, so that a version control system shows what changed."""
        entries = sorted(self.entries, key=lambda e: (e.rule, e.c_file, e.function, e.object, e.fingerprint))
        data = {"version": VERSION, "findings": [asdict(entry) for entry in entries]}
        with replacing(path) as new:
            new.write_text(json.dumps(data, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")

    def __contains__(self, fingerprint: object) -> bool:
        return any(entry.fingerprint == fingerprint for entry in self.entries)

    def absent(self, present: Sequence[KnownFinding]) -> tuple[KnownFinding, ...]:
        """The known findings that are not among `present`."""
        there = {entry.fingerprint for entry in present}
        return tuple(entry for entry in self.entries if entry.fingerprint not in there)


def _entry(item: Any) -> KnownFinding:
    if not isinstance(item, dict) or not all(isinstance(value, str) for value in item.values()):
        raise ValueError("a finding is not an object of texts")
    return KnownFinding(**item)
