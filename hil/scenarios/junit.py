"""The outcomes of scenarios as JUnit XML: each scenario is a suite, each expectation of each run a case."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree

from hil.files import replacing
from hil.reports.junit import legal
from hil.scenarios.running import ScenarioOutcome, ScenarioRun


def write_junit(path: Path, outcomes: Sequence[ScenarioOutcome]) -> None:
    """Write the file.  Raises OSError if it cannot be written."""
    root = ElementTree.Element("testsuites")
    for outcome in outcomes:
        _suite(root, outcome)
    tree = ElementTree.ElementTree(root)
    ElementTree.indent(tree)
    with replacing(path) as new:
        tree.write(new, encoding="utf-8", xml_declaration=True)


def _suite(root: ElementTree.Element, outcome: ScenarioOutcome) -> None:
    suite = ElementTree.SubElement(
        root, "testsuite", name=outcome.name, time=f"{sum(leg.virtual_s for leg in outcome.legs):.6f}"
    )
    counts = {"tests": 0, "failures": 0, "errors": 0}
    for place, leg in enumerate(outcome.legs):
        _leg(suite, outcome, leg, counts, faithful=place > 0)
    for name, count in counts.items():
        suite.set(name, str(count))


def _leg(
    suite: ElementTree.Element, outcome: ScenarioOutcome, leg: ScenarioRun, counts: dict[str, int], *, faithful: bool
) -> None:
    classname = f"{outcome.name}.{'faithful' if faithful else 'run'}"
    runs_on = not leg.stopped or (faithful and bool(outcome.faithful_fails))
    case = ElementTree.SubElement(suite, "testcase", classname=classname, name="runs on")
    counts["tests"] += 1
    if not runs_on:
        counts["errors"] += 1
        ElementTree.SubElement(case, "error", message=legal(leg.stopped))
    for check in leg.checks:
        wanted = not (faithful and check.name in outcome.faithful_fails)
        name = legal(check.name if wanted else f"{check.name} (must fail)")
        case = ElementTree.SubElement(suite, "testcase", classname=classname, name=name)
        counts["tests"] += 1
        if check.ok is not wanted:
            counts["failures"] += 1
            ElementTree.SubElement(case, "failure", message=legal(check.seen))
