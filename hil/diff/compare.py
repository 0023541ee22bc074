"""The three steps: trees, calls of what differs, runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from emulator.c28x.findings import Finding
from emulator.c28x.program import Program
from firmware_model.c_files import own as own_files
from firmware_model.calibration import CALIBRATION
from firmware_model.image import MODULES
from hil.diff.calls import CallComparison, Caller
from hil.diff.difference import BOTH, Difference
from hil.diff.runs import Runs, compare_runs
from hil.diff.trees import Trees, compare_trees
from hil.image import Build
from hil.machine import Setup
from hil.reports.json_report import findings_of
from hil.reports.model import Report, report_of
from hil.scenarios.scenario import Scenario

#: Told what is done now, and how far it has come (0..1).
Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class ComparisonOptions:
    """What is compared, and how."""

    #: The robot's own C files, or folders with them.
    files: Sequence[str]
    include: Sequence[str] = ()
    defines: Sequence[str] = ()
    world: str = "corridor"
    seed: int = 1
    fill: str = "zero"
    #: Argument lists a function and circumstance.
    calls: int = 30
    #: Virtual time of the runs after start-up.
    seconds: float = 5.0
    orders: Sequence[str] = ("mission",)
    #: Whether cycles must be equal, too.
    cycles: bool = False


@dataclass
class Result:
    """What the comparison came to."""

    trees: Trees
    #: Function that differs -> what calls of it showed.
    calls: dict[str, CallComparison] = field(default_factory=dict)
    runs: Runs | None = None
    cycles: bool = False

    @property
    def findings(self) -> list[tuple[Finding, str]]:
        """The findings of the runs, and of the calls what one side alone shows; each with which side shows it."""
        found = list(self.runs.findings) if self.runs is not None else []
        known = {(finding.rule, finding.object, side) for finding, side in found}
        of_calls = [each for called in self.calls.values() for each in called.findings]
        return found + [each for each in of_calls if (each[0].rule, each[0].object, each[1]) not in known]

    @property
    def report(self) -> Report:
        """The findings as every command reports them.  Raises ValueError for a wrong policy of the project."""
        found = self.findings
        return report_of([finding for finding, _ in found], "diff", [(side,) for _, side in found])

    @property
    def alone(self) -> list[Finding]:
        """Findings that one side alone shows."""
        return [finding for finding, side in self.findings if side != BOTH]

    @property
    def observed(self) -> list[Difference]:
        """Differences in what a program can observe, besides the findings of one side."""
        found = [d for called in self.calls.values() for d in called.differences]
        found += [d for d in self.trees.others if d.port and d.own]
        return found + (self.runs.differences if self.runs is not None else [])

    @property
    def unproven(self) -> list[str]:
        """Functions that differ, and that neither calls nor runs have come through on both sides."""
        ran = self.runs.functions if self.runs is not None else set()
        return [
            path
            for path, differences in self.trees.functions.items()
            if all(d.port and d.own for d in differences)
            and not self.calls[path].calls
            and path.rpartition(".")[2] not in ran
        ]

    @property
    def skewed(self) -> bool:
        """Whether something happened in other cycles."""
        return self.runs is not None and self.runs.streams.skew.first is not None

    @property
    def different(self) -> bool:
        """Whether a program can tell them apart, as far as was asked."""
        return bool(self.observed or self.alone or self.unproven or (self.cycles and self.skewed))

    @property
    def verdict(self) -> str:
        """The result in one sentence."""
        if n := len(self.observed) + len(self.alone):
            return f"different: {n} difference{'s' if n > 1 else ''} in what a program can observe"
        if self.unproven:
            return f"not shown to be equal: nothing has run {', '.join(self.unproven)}"
        if self.cycles and self.skewed:
            return "different: in cycles only"
        if self.trees.differences or self.skewed:
            return "equal in what a program can observe" + (", but for cycles" if self.skewed else "")
        return "equal"

    def as_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        runs = self.runs
        return {
            "verdict": self.verdict,
            "different": self.different,
            "trees": {
                "equal": self.trees.equal,
                "different": list(self.trees.functions),
                "differences": [d.as_dict() for d in self.trees.differences],
            },
            "calls": {path: called.as_dict() for path, called in self.calls.items()},
            "runs": None if runs is None else {
                "seconds": runs.seconds,
                "events_alike": runs.streams.alike,
                "differences": [d.as_dict() for d in runs.differences],
                "first_skew": runs.streams.skew.first,
                "largest_skew": runs.streams.skew.largest,
            },
            "findings": findings_of(self.report),
        }  # fmt: skip


def compare_firmware(wanted: ComparisonOptions, progress: Progress = lambda what, fraction: None) -> Result:
    """Compare the port with C files of the robot.

    Raises ValueError for what is no file of the robot, SourceError for what is outside the language, LinkError for a
    name that nothing defines.
    """
    progress("translate", 0.0)
    files = own_files(wanted.files)
    port = Build(Program(MODULES), fill=wanted.fill, seed=wanted.seed, calibration=CALIBRATION)
    progress("translate", 0.5)
    program = Program(
        (*MODULES, *files.besides), include=wanted.include, defines=wanted.defines, **files.arguments()
    )
    own = Build(program, fill=wanted.fill, seed=wanted.seed, calibration=CALIBRATION)
    modules = [name.rpartition(".")[2] for name in files.instead]
    result = Result(compare_trees(port.compiled, own.compiled, modules), cycles=wanted.cycles)
    caller = Caller(port, own, calls=wanted.calls, seed=wanted.seed)
    for number, path in enumerate(result.trees.functions):
        progress("call", number / len(result.trees.functions))
        result.calls[path] = caller.compare(path)
    setup = Setup(world=wanted.world, seed=wanted.seed, fill=wanted.fill)
    ours = Scenario(setup=setup, seconds=wanted.seconds, orders=tuple(wanted.orders))
    theirs = replace(
        ours,
        setup=replace(setup, firmware=files.files, include=tuple(wanted.include), defines=tuple(wanted.defines)),
    )
    names = [{f.function.name for f in build.compiled.functions} for build in (port, own)]
    result.runs = compare_runs(ours, theirs, frozenset(names[0] & names[1]), lambda part: progress("run", part))
    progress("done", 1.0)
    return result
