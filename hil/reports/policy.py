"""A project's policy: its own severities, its baseline, and the severity from which a run fails.

In `pyproject.toml`::

    [tool.c2000-hil]
    baseline = "hil-baseline.json"      # known findings, relative to this file
    fail_on = "error"                   # error, warning (default), note, never

    [tool.c2000-hil.severity]
    index = "note"
    odd-access = "off"
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Final

from emulator.c28x.findings import Finding
from emulator.rules import RULES, Severity
from hil.files import parse_toml, read_text

TABLE: Final = "tool.c2000-hil"
#: `Finding.how` of what a call with generated arguments has shown (`hil.drivers.call_checker`).
GENERATED: Final = "generated"
_SEVERITIES: Final = {severity.value: severity for severity in Severity}


def nearest(rule_id: str) -> str:
    """The end of a message about an unknown identifier: a similar known one."""
    close = get_close_matches(rule_id, RULES, n=3, cutoff=0.5)
    return f"did you mean {', '.join(close)}?" if close else "hil explain lists them all"


def parse_fail_on(text: str) -> Severity | None:
    """``error``, ``warning``, ``note`` or ``never`` (None).  Raises ValueError."""
    if text == "never":
        return None
    if text not in _SEVERITIES:
        raise ValueError(f"fail_on {text!r}: must be error, warning, note or never")
    return _SEVERITIES[text]


def parse_severities(table: Any) -> dict[str, Severity | None]:
    """A table of rule = severity; None is "off".  Raises ValueError for an unknown rule or severity."""
    if not isinstance(table, Mapping):
        raise ValueError('severity: must be a table of RULE = "error", "warning", "note" or "off"')
    severities: dict[str, Severity | None] = {}
    for rule_id, text in table.items():
        if rule_id not in RULES:
            raise ValueError(f"severity: no rule {rule_id!r}: {nearest(rule_id)}")
        if text != "off" and text not in _SEVERITIES:
            raise ValueError(f"severity.{rule_id}: {text!r} must be error, warning, note or off")
        severities[rule_id] = None if text == "off" else _SEVERITIES[text]
    return severities


@dataclass(frozen=True, slots=True)
class Policy:
    """The severities of findings.  `Policy()` has the severity of every rule, no baseline, and fails from a warning
    on."""

    #: What differs from the rules' own severities; None is "off": not reported at all.
    severities: Mapping[str, Severity | None] = field(default_factory=dict)
    #: The file of known findings, or None.  It need not exist yet.
    baseline: Path | None = None
    #: A finding of this severity or above fails a run; None: none does.
    fail_on: Severity | None = Severity.WARNING

    @classmethod
    def load(cls, directory: Path) -> Policy:
        """The policy of the nearest `pyproject.toml` at or above `directory`; without one, or without a table in it,
        `Policy()`.

        Raises ValueError, one line naming file and key, for what it does not know.
        """
        directory = directory.resolve()
        for folder in (directory, *directory.parents):
            path = folder / "pyproject.toml"
            if path.is_file():
                table = parse_toml(read_text(path), str(path)).get("tool", {}).get("c2000-hil", {})
                try:
                    return cls().changed(table, folder)
                except ValueError as error:
                    raise ValueError(f"{path}: [{TABLE}]: {error}") from None
        return cls()

    def changed(self, table: Mapping[str, Any], folder: Path) -> Policy:
        """This policy with the keys `baseline`, `fail_on` and `severity` of a table; paths are relative to `folder`.

        Raises ValueError for an unknown key or value.
        """
        policy = self
        for key, value in table.items():
            if key == "severity":
                policy = replace(policy, severities={**policy.severities, **parse_severities(value)})
            elif key not in ("baseline", "fail_on"):
                raise ValueError(f"no key {key!r}: there are baseline, fail_on and severity")
            elif not isinstance(value, str):
                raise ValueError(f"{key}: must be a text")
            elif key == "baseline":
                policy = replace(policy, baseline=folder / value)
            else:
                policy = replace(policy, fail_on=parse_fail_on(value))
        return policy

    def severity(self, rule_id: str) -> Severity | None:
        """The severity of a rule in this policy; None: turned off.  An unknown rule has that of a warning."""
        if rule_id in self.severities:
            return self.severities[rule_id]
        rule = RULES.get(rule_id)
        return Severity.WARNING if rule is None else rule.severity

    def severity_of(self, finding: Finding) -> Severity | None:
        """The severity of a finding in this policy; None: turned off.

        A finding that only generated arguments have shown is a note: the contract of the function may exclude them.
        """
        severity = self.severity(finding.rule)
        return Severity.NOTE if severity is not None and finding.how == GENERATED else severity

    def with_severities(self, findings: Iterable[Finding]) -> list[tuple[Finding, Severity]]:
        """The findings with their severities, in their order, without those that are turned off."""
        every = ((finding, self.severity_of(finding)) for finding in findings)
        return [(finding, severity) for finding, severity in every if severity is not None]

    def fails(self, severity: Severity) -> bool:
        """Whether a finding of this severity fails a run."""
        return self.fail_on is not None and severity.rank >= self.fail_on.rank
