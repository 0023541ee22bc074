"""SARIF: valid by the published schema whatever was found, and with what a viewer needs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft4Validator, FormatChecker

from emulator.c28x.findings import Finding
from emulator.c28x.sites import Place
from emulator.rules import RULES, Severity
from hil.machine import Setup
from hil.reports.baseline import Baseline, known
from hil.reports.excerpt import relative_path
from hil.reports.model import Report, Run
from hil.reports.policy import Policy
from hil.reports.sarif import FINGERPRINT, sarif, write_sarif
from tests.hil.reports.samples import finding, findings, module, texts

SCHEMA = Draft4Validator(
    json.loads((Path(__file__).parent / "sarif-schema-2.1.0.json").read_text(encoding="utf-8")),
    format_checker=FormatChecker(),
)


def check(log: dict[str, Any]) -> dict[str, Any]:
    """`log` as another program reads it, if it is valid."""
    read: dict[str, Any] = json.loads(json.dumps(log, allow_nan=False))
    assert [f"{list(error.path)}: {error.message}" for error in SCHEMA.iter_errors(read)] == []
    return read


@given(st.lists(findings(), max_size=4), st.lists(findings(), max_size=2), texts)
def test_every_report_is_valid(found: list[Finding], before: list[Finding], stopped: str) -> None:
    run = Run("x", Setup(), 1.0, ("mission",), stopped)
    (read,) = check(sarif(Report.of(found, run=run, baseline=Baseline(tuple(known(before))))))["runs"]
    shown = [result for result in read["results"] if result["baselineState"] != "absent"]
    assert [result["ruleId"] for result in shown] == [one.rule for one in found]
    rules = read["tool"]["driver"]["rules"]
    assert all(rules[result["ruleIndex"]]["id"] == result["ruleId"] for result in read["results"])


def test_the_schema_refuses_what_is_no_sarif() -> None:
    assert list(SCHEMA.iter_errors({"version": "2.1.0", "runs": [{}]}))


@pytest.fixture
def result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """One finding of two tasks, as SARIF."""
    monkeypatch.chdir(tmp_path)
    file = module(tmp_path)
    other = Place(str(file), 5, "g", "us.c")
    report = Report.of([finding(file, 3, count=7, details=(f"and written at {other}",))], run=Run("x"))
    (one,) = check(sarif(report))["runs"][0]["results"]
    return dict(one)


def test_a_location_is_relative_and_shows_its_line(result: dict[str, Any]) -> None:
    (location,) = result["locations"]
    physical = location["physicalLocation"]
    assert physical["artifactLocation"] == {"uri": "us.py", "uriBaseId": "SRCROOT"}
    assert physical["region"] == {"startLine": 3, "snippet": {"text": "total += v[i]"}}
    assert physical["contextRegion"]["startLine"] == 1
    assert location["logicalLocations"][0]["fullyQualifiedName"] == "us.c::f"


def test_the_code_flow_goes_from_the_task_to_the_finding(result: dict[str, Any]) -> None:
    (flow,) = result["codeFlows"]
    main = flow["threadFlows"][0]
    assert main["id"] == "TaskUS"
    lines = [step["location"]["physicalLocation"]["region"]["startLine"] for step in main["locations"]]
    assert lines == [1, 3]


def test_a_second_place_is_a_thread_flow_of_its_own(result: dict[str, Any]) -> None:
    other = result["codeFlows"][0]["threadFlows"][1]
    assert other["locations"][0]["location"]["physicalLocation"]["region"]["startLine"] == 5
    assert result["relatedLocations"][0]["logicalLocations"][0]["name"] == "g"
    # The sentence names the file as the rest of the report does.
    assert other["message"]["text"] == "and written at g (us.py:5)"


def test_counts_and_values_are_kept(result: dict[str, Any]) -> None:
    assert result["occurrenceCount"] == 7
    # 2 000 000 cycles of 5 ns.
    assert result["properties"]["time_us"] == 10_000
    assert result["properties"]["object"] == "us.f.total"
    assert FINGERPRINT in result["partialFingerprints"]


def test_levels_are_the_projects_and_the_rules_keep_their_own(tmp_path: Path) -> None:
    report = Report.of([finding(module(tmp_path), 3)], run=Run("x"), policy=Policy({"rotation-sign": Severity.NOTE}))
    (run,) = check(sarif(report))["runs"]
    assert run["results"][0]["level"] == "note"
    (rule,) = run["tool"]["driver"]["rules"]
    assert rule["defaultConfiguration"]["level"] == "error"
    assert rule["help"]["markdown"] == RULES["rotation-sign"].page


def test_baseline_states(tmp_path: Path) -> None:
    file = module(tmp_path)
    old, gone, new = finding(file, 3), finding(file, 4), finding(file, 6)
    report = Report.of([old, new], run=Run("x"), baseline=Baseline(tuple(known([old, gone]))))
    results = check(sarif(report))["runs"][0]["results"]
    assert [one["baselineState"] for one in results] == ["unchanged", "new", "absent"]


def test_a_stopped_firmware_is_no_successful_invocation(tmp_path: Path) -> None:
    write_sarif(tmp_path / "x.sarif", Report.of([], run=Run("x", stopped="a trap")))
    (run,) = check(json.loads((tmp_path / "x.sarif").read_text(encoding="utf-8")))["runs"]
    assert run["invocations"][0]["executionSuccessful"] is False


def test_a_file_of_an_installed_package_stands_from_its_root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "site" / "driver" / "low"
    package.mkdir(parents=True)
    for folder in (package, package.parent):
        (folder / "__init__.py").touch()
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert relative_path(str(module(package))) == "driver/low/us.py"
