"""One test in the plugin: the boards that it used, the findings that it expects, and whether it has failed.

A finding fails the test that caused it, unless the test expects or allows it.  An expected finding that does not come
fails the test, too.  Severities, baseline and threshold are those of the project (`hil.reports.policy`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from fnmatch import fnmatchcase
from typing import Final

from emulator.c28x.findings import Finding, Findings
from emulator.rules import RULES
from hil.reports.baseline import Baseline
from hil.reports.model import Report, ReportEntry, Run
from hil.reports.policy import Policy, nearest
from hil.testing.text import entry_lines

#: From this similarity on, an unknown identifier counts as a mistyped rule (0 to 1, `difflib`).
_ALIKE: Final = 0.75


@dataclass(frozen=True, slots=True)
class ExpectedFinding:
    """A finding that a test expects (`required`) or allows.

    `rule` may have wildcards if the finding is not required.  `object` is the object's name or its path (`result`,
    `us.Read_Distance.result`), `function` the C function.  Parts of the user may report rules of their own, so only a
    name that looks like a mistyped rule is refused.
    """

    rule: str
    object: str = ""
    function: str = ""
    required: bool = True

    def __post_init__(self) -> None:
        """Raise ValueError for a name that is no rule but similar to one."""
        wild = not self.required and any(c in self.rule for c in "*?[")
        if not wild and self.rule not in RULES and get_close_matches(self.rule, RULES, cutoff=_ALIKE):
            raise ValueError(f"no rule {self.rule!r}: {nearest(self.rule)}")

    def fits(self, finding: Finding) -> bool:
        """Whether a finding is the expected one."""
        function = finding.place.function if finding.place else ""
        return (
            fnmatchcase(finding.rule, self.rule)
            and (not self.object or f".{finding.object}".endswith(f".{self.object}"))
            and (not self.function or function == self.function)
        )

    def __str__(self) -> str:
        wanted = [f"{key}={value!r}" for key, value in (("object", self.object), ("function", self.function)) if value]
        return f"expects({', '.join([repr(self.rule), *wanted])})"


#: Two findings of different tests with the same key are the same: rule, file, line, object.
Key = tuple[str, str, int, str]


def key_of(finding: Finding) -> Key:
    """The place and the object of a finding."""
    place = finding.place
    return finding.rule, place.file if place else "", place.line if place else 0, finding.object


class Case:
    """A running test.  `reported` are the static findings that belong to earlier tests of this process."""

    def __init__(self, name: str, policy: Policy, baseline: Baseline | None, reported: set[Key]) -> None:
        self.name = name
        self.policy = policy
        self.baseline = baseline
        self.expectations: list[ExpectedFinding] = []
        self._reported = reported
        self._watched: list[Findings] = []
        self._ends: list[Callable[[], None]] = []

    def watch(self, findings: Findings, end: Callable[[], None]) -> None:
        """Include the findings of a board in this test.  `end()` ends its run, because some rules check that."""
        self._watched.append(findings)
        self._ends.append(end)

    def finish(self) -> None:
        """End the runs of all boards."""
        for end in self._ends:
            end()

    def expect(self, rule: str, *, object: str = "", function: str = "", required: bool = True) -> None:
        """Expect or allow a finding.  Raises ValueError for a mistyped rule."""
        self.expectations.append(ExpectedFinding(rule, object, function, required))

    @property
    def findings(self) -> list[Finding]:
        """The findings of this test's boards, in order."""
        return [finding for findings in self._watched for finding in findings]

    def expected(self, finding: Finding) -> bool:
        """Whether the test expects or allows this finding."""
        return any(e.fits(finding) for e in self.expectations)

    def missing(self) -> list[ExpectedFinding]:
        """The expected findings that have not come."""
        return [e for e in self.expectations if e.required and not any(e.fits(f) for f in self.findings)]

    def unexpected(self) -> list[Finding]:
        """The findings that the test neither expects nor allows.

        A static finding belongs to the first test that links its module.  If a read before the first write was found
        in the run, the static finding about the same object need not be expected, too.
        """
        read = {key_of(f)[1:] for f in self.findings if f.rule == "uninitialised"}
        return [
            f
            for f in self.findings
            if not self.expected(f)
            and not (f.how == "static" and key_of(f) in self._reported)
            and not (f.rule == "maybe-uninitialised" and key_of(f)[1:] in read)
        ]

    def not_modelled(self) -> list[str]:
        """The registers, functions and parts that the boards used and that are not modelled, each once."""
        used = (f for f in self.findings if f.rule == "unmodelled" and self.policy.severity_of(f) is not None)
        return list(dict.fromkeys(".".join(f.object.split(".")[:2]) or f.message for f in used))

    def counted(self) -> list[ReportEntry]:
        """The findings that fail this test, the worst first: unexpected, severe enough, and not in the baseline."""
        report = Report.of(self.unexpected(), run=Run(self.name), policy=self.policy, baseline=self.baseline)
        return sorted(report.counted, key=lambda entry: -entry.severity.rank)

    def verdict(self) -> str:
        """Why the test has failed, the most important reason first; empty if it has not failed.

        Pytest's summary shows the first line: the first finding, and the number of findings.
        """
        try:
            entries, missing = self.counted(), self.missing()
        except ValueError as error:  # a wrong declaration in the firmware's comments
            return str(error)
        blocks = [entry_lines(entry) for entry in entries]
        blocks += [[f"{expectation}: did not come", *_instead(self.findings)] for expectation in missing]
        if len(entries) > 1:
            blocks[0][0] += f" (1 of {len(entries)} findings)"
        return "\n\n".join("\n".join(block) for block in blocks)

    def close(self) -> None:
        """End the test.  Its static findings are not reported again."""
        self._reported.update(key_of(f) for f in self.findings if f.how == "static")


def _instead(findings: Iterable[Finding]) -> list[str]:
    """The text of the findings that came when others were expected."""
    found = sorted({f"{f.rule} ({f.object})" if f.object else f.rule for f in findings})
    return [f"    found: {', '.join(found) or 'nothing'}"]
