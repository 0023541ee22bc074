"""One report: the findings of a run, with the severities of a policy, compared with a baseline, and with their
effects."""

from __future__ import annotations

import platform
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from emulator.c28x.declarations import UserDeclaration
from emulator.c28x.findings import Finding
from emulator.rules import RULES, Rule, Severity
from hil.machine import Circle, PathPoint, Setup, Wall
from hil.reports.accepted import acceptance, idle
from hil.reports.baseline import Baseline, KnownFinding, known
from hil.reports.differences import RunDifferences, TwoFillProof
from hil.reports.policy import Policy

if TYPE_CHECKING:
    from hil.faults import FaultOutcome

#: The chip whose run this is; stands in every report.
TARGET: Final = "TMS320F28377S"


def versions() -> dict[str, str]:
    """The versions of this tool and of Python."""
    return {"c2000-hil": version("c2000-hil"), "python": platform.python_version()}


@dataclass(frozen=True, slots=True)
class CalledFunction:
    """A function of driver files: whether it was called with generated arguments, how often, and why not."""

    name: str
    file: str
    line: int
    calls: int
    #: Why it was not called, or what else there is to say.
    note: str = ""
    called: bool = True


@dataclass(frozen=True, slots=True)
class Run:
    """The run of a report.  Everything here follows from the setup and the orders: no wall clock, no name of a
    machine."""

    #: What a reader calls it: a scenario's name, a test's identifier.
    name: str
    setup: Setup | None = None
    #: Virtual time since power-up, in seconds.
    virtual_s: float = 0.0
    #: Orders as they were given, "1.5:mission".
    orders: tuple[str, ...] = ()
    #: Why the firmware ended before its time; empty if it did not.
    stopped: str = ""
    #: More that the run came to: frames, digests.
    outcome: Mapping[str, Any] = field(default_factory=dict)
    #: Of driver files: their functions.
    functions: tuple[CalledFunction, ...] = ()
    #: Sources of a program that could fall silent, which was not tried.
    not_silenced: tuple[str, ...] = ()
    #: The inputs of a program that nothing on its board drives, and that a further run has moved.
    moved: tuple[str, ...] = ()
    #: Code ran that was not calibrated: its computation times may be so many times longer or shorter on the chip.
    uncalibrated_factor: float | None = None
    #: What came of each fault that was declared.
    faults: tuple[FaultOutcome, ...] = ()

    @property
    def silent(self) -> tuple[FaultOutcome, ...]:
        """The faults that never fired."""
        return tuple(fault for fault in self.faults if not fault.count)

    @property
    def how_sure(self) -> str:
        """The uncertainty of computation times, as a sentence; empty if all code was calibrated."""
        if self.uncalibrated_factor is None:
            return ""
        return (
            f"Computation times of this code may be {self.uncalibrated_factor:g} times longer or shorter on the chip: "
            "it was not calibrated."
        )

    @property
    def settings(self) -> dict[str, Any]:
        """The setup by its names; empty without one."""
        return self.setup.as_dict() if self.setup else {}


@dataclass(frozen=True, slots=True)
class DrivenTrack:
    """The true path of the robot and its odometry, for a picture.  Metres, in the world's frame."""

    walls: Sequence[Wall] = ()
    posts: Sequence[Circle] = ()
    true_path: Sequence[PathPoint] = ()
    odometry: Sequence[PathPoint] = ()


@dataclass(frozen=True, slots=True)
class ReportEntry:
    """A finding with everything that a report shows of it."""

    finding: Finding
    rule: Rule
    severity: Severity
    #: The finding as a baseline remembers it: fingerprint and statement.
    known: KnownFinding
    #: "new" or "unchanged" against a baseline; empty without one.
    state: str = ""
    #: What the object reaches by the two-fill proof; None: not examined.
    reach: RunDifferences | None = None
    #: Why the source accepts it (`hil: allow`); empty: it does not.
    accepted: str = ""
    #: Where several ran (tests, runs of a campaign, port and C): who showed it, first the one whose time it has.
    by: tuple[str, ...] = ()

    @property
    def state_word(self) -> str:
        """The state in one word: "accepted" by the source, else "new", "unchanged" or empty."""
        return "accepted" if self.accepted else self.state

    @property
    def shown_by(self) -> str:
        """`by` in a few words; empty where one ran."""
        more = f" and {len(self.by) - 1} more" if len(self.by) > 1 else ""
        return f"{self.by[0]}{more}" if self.by else ""


@dataclass(frozen=True, slots=True)
class Report:
    """The findings of one run.  Create it with `Report.of`."""

    run: Run
    entries: tuple[ReportEntry, ...]
    policy: Policy = field(default_factory=Policy)
    #: How many findings belong to rules that are turned off.
    turned_off: int = 0
    #: What the files that were checked allow and nothing asked for.
    idle: tuple[UserDeclaration, ...] = ()
    #: Known findings that did not appear.
    absent: tuple[KnownFinding, ...] = ()
    proof: TwoFillProof | None = None
    drive: DrivenTrack | None = None

    @classmethod
    def of(
        cls, findings: Iterable[Finding], *, run: Run, policy: Policy | None = None, baseline: Baseline | None = None,
        proof: TwoFillProof | None = None, drive: DrivenTrack | None = None, by: Sequence[Sequence[str]] = (),
        checked: Iterable[str] = (),
    ) -> Report:  # fmt: skip
        """A report of `findings` in their order.

        `policy` weighs them (default: every rule's own severity) and leaves out what it turns off; `baseline` tells new
        ones from known ones; `proof` says what they reach; `by` names for each finding who showed it;
        `checked` are the files of which it says what they allow in vain.  Raises ValueError for a wrong `hil: allow` in
        a file of a finding.
        """
        policy = policy or Policy()
        listed = list(findings)
        present = known(listed)
        entries = []
        asked = []
        for finding, as_known, named in zip(listed, present, by or [()] * len(listed), strict=True):
            severity = policy.severity_of(finding)
            if severity is None:
                continue
            state = "" if baseline is None else "unchanged" if as_known.fingerprint in baseline else "new"
            reach = proof.reach_of(finding) if proof else None
            reason = ""
            if allowed := acceptance(finding):
                asked.append(allowed[0])
                reason = allowed[1]
            rule = rule_of(finding.rule)
            entries.append(ReportEntry(finding, rule, severity, as_known, state, reach, reason, tuple(named)))
        absent = baseline.absent(present) if baseline else ()
        off = len(listed) - len(entries)
        return cls(run, tuple(entries), policy, off, tuple(idle(checked, asked)), absent, proof, drive)

    @property
    def has_times(self) -> bool:
        """Whether any finding has a time."""
        return any(entry.finding.how != "static" for entry in self.entries)

    def fails(self, entry: ReportEntry) -> bool:
        """Whether a finding fails the run: severe enough, not known before, and not accepted by the source."""
        return entry.state != "unchanged" and not entry.accepted and self.policy.fails(entry.severity)

    @property
    def counted(self) -> tuple[ReportEntry, ...]:
        """The findings that fail the run."""
        return tuple(filter(self.fails, self.entries))

    @property
    def failed(self) -> bool:
        """Whether the run has failed: a finding counts, the firmware did not run on, or a fault never fired."""
        return bool(self.counted) or bool(self.run.stopped) or bool(self.run.silent)

    @property
    def worst_first(self) -> list[ReportEntry]:
        """The findings by severity, those of one severity in their order."""
        return sorted(self.entries, key=lambda entry: -entry.severity.rank)

    @property
    def accepted(self) -> int:
        """The number of findings that the source accepts."""
        return sum(bool(entry.accepted) for entry in self.entries)

    def count(self, severity: Severity) -> int:
        """The number of findings with this severity."""
        return sum(entry.severity is severity for entry in self.entries)

    @property
    def rules(self) -> tuple[Rule, ...]:
        """The rules that the findings name, each once, in their order."""
        return tuple({entry.rule.id: entry.rule for entry in self.entries}.values())


def report_of(findings: Iterable[Finding], name: str = "run", by: Sequence[Sequence[str]] = ()) -> Report:
    """A report of what a run has found, weighed as the project of the current folder says.  Raises ValueError."""
    return Report.of(findings, run=Run(name), policy=Policy.load(Path.cwd()), by=by)


def merged(findings: Iterable[Finding]) -> list[Finding]:
    """Merge the findings of several runs: each defect once, as it was found first, with its count in all of them."""
    return [finding for finding, _ in merged_by(("", finding) for finding in findings)]


def merged_by(found: Iterable[tuple[str, Finding]]) -> list[tuple[Finding, tuple[str, ...]]]:
    """As `merged`, for pairs of (test or run, finding): each defect with all tests or runs that showed it."""
    known: dict[tuple[object, ...], tuple[Finding, dict[str, None]]] = {}
    for who, finding in found:
        key = (finding.rule, finding.object, finding.place)
        if key in known:
            first, by = known[key]
            known[key] = replace(first, count=first.count + finding.count), {**by, who: None}
        else:
            known[key] = finding, {who: None}
    return [(finding, tuple(by)) for finding, by in known.values()]


def rule_of(rule_id: str) -> Rule:
    """The rule of an identifier; for a detector of somebody's own, a rule without a page."""
    return RULES.get(rule_id) or Rule(
        rule_id, Severity.WARNING, "own", f"Reported as {rule_id} by a detector outside this project.", ""
    )
