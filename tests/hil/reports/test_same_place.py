"""One run and one seed: every command, file and table tells the same finding at the same place."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, TypeAlias
from xml.etree import ElementTree

import pytest

from hil.bench import Bench
from hil.cli import invoke
from hil.reports.excerpt import relative_path

SECONDS = "0.3"
ASKED = ("--for", SECONDS, "--order", "mission", "--seed", "1")
TEST = f"""
import pytest

@pytest.mark.seed(1)
def test_a_mission(bench):
    bench.feed("#MISN\\r")
    bench.run_for({SECONDS})
"""
#: Rule and object.
What: TypeAlias = tuple[str, str]
#: File, line.
Place: TypeAlias = tuple[str, int]


def places(findings: Iterable[Mapping[str, Any]]) -> dict[What, set[Place]]:
    """Of JSON; what the source shows without running has no run."""
    found: dict[What, set[Place]] = {}
    for one in findings:
        if one["how"] != "static":
            found.setdefault((one["rule"], one["object"]), set()).add((one["file"], one["line"]))
    return found


def of_sarif(file: Path) -> dict[What, set[Place]]:
    results = json.loads(file.read_text(encoding="utf-8"))["runs"][0]["results"]
    return places(
        {
            **one["properties"], "rule": one["ruleId"], "file": physical["artifactLocation"]["uri"],
            "line": physical["region"]["startLine"],
        }
        for one in results for physical in [one["locations"][0]["physicalLocation"]]
    )  # fmt: skip


def of_junit(file: Path) -> set[tuple[str, Place]]:
    cases = ElementTree.parse(file).iter("testcase")
    return {
        (case.get("classname", "").rpartition(".")[2], (case.get("file", ""), int(case.get("line") or 0)))
        for case in cases
    }


def test_a_finding_has_one_place_in_all_commands(
    pytester: pytest.Pytester, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    bench = Bench("corridor", seed=1)
    bench.boot()
    bench.feed("#MISN\r")
    bench.run_for(float(SECONDS))
    bench.close()
    in_python = places(
        finding.as_dict() | {"file": relative_path(finding.place.file)} for finding in bench.findings if finding.place
    )
    assert invoke(["run", "--no-port", "--pace", "max", *ASKED, "--json"]) == 0
    in_run = places(json.loads(capsys.readouterr().out)["findings"])
    files = ("--sarif", "a.sarif", "--junit", "a.xml", "--html", "a.html")
    assert invoke(["check", *ASKED, *files, "--json"]) == 1
    in_check = places(json.loads(capsys.readouterr().out)["findings"])
    pytester.makepyfile(TEST)
    pytester.runpytest("-p", "no:cacheprovider", "--hil-sarif", "tests.sarif").assert_outcomes(failed=1)

    assert len(in_run) > 10
    assert in_python == in_run
    assert in_run.items() <= in_check.items(), "hil check looks for more, and tells the same"
    assert of_sarif(Path("a.sarif")) == in_check
    told = of_junit(Path("a.xml"))
    page = Path("a.html").read_text(encoding="utf-8")
    for (rule, _), there in in_check.items():
        assert all((rule, place) in told for place in there), rule
        for file, line in there:
            assert re.search(rf"{re.escape(rule)}</span>.*?\({re.escape(file)}:{line}\)", page, re.DOTALL), rule
    by_pytest = of_sarif(Path("tests.sarif"))
    both = in_check.keys() & by_pytest.keys()
    assert len(both) > 10
    assert {what: in_check[what] for what in both} == {what: by_pytest[what] for what in both}
