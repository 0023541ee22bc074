"""Severities of a project: found where the project is, refused in one line where they are wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.rules import RULES, Severity
from hil.reports.policy import Policy


def project(folder: Path, text: str) -> Path:
    (folder / "pyproject.toml").write_text(text, encoding="utf-8")
    return folder


def test_without_a_table_every_rule_has_its_own_severity_and_warnings_fail(tmp_path: Path) -> None:
    policy = Policy.load(project(tmp_path, "[project]\nname = 'x'\n"))
    assert all(policy.severity(rule.id) is rule.severity for rule in RULES.values())
    assert [policy.fails(severity) for severity in Severity] == [False, True, True]
    assert policy.baseline is None


def test_the_nearest_pyproject_above_decides_and_its_paths_are_its_own(tmp_path: Path) -> None:
    project(
        tmp_path,
        "[tool.c2000-hil]\nbaseline = 'known.json'\nfail_on = 'error'\n"
        "[tool.c2000-hil.severity]\nunit = 'note'\nfigure = 'off'\n",
    )
    inner = tmp_path / "tests" / "unit"
    inner.mkdir(parents=True)
    policy = Policy.load(inner)
    assert policy.severity("unit") is Severity.NOTE
    assert policy.severity("figure") is None
    assert policy.baseline == tmp_path / "known.json"
    assert not policy.fails(Severity.WARNING)


def test_a_rule_of_somebody_elses_is_a_warning() -> None:
    assert Policy().severity("a-rule-of-mine") is Severity.WARNING


def test_never_fails_never() -> None:
    assert not any(Policy(fail_on=None).fails(severity) for severity in Severity)


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        ("severity.rotation-sgin = 'note'", "no rule 'rotation-sgin': did you mean rotation-sign"),
        ("severity.unit = 'fatal'", "severity.unit: 'fatal' must be error, warning, note or off"),
        ("severity.unit = 3", "severity.unit: 3 must be"),
        ("severity = 'note'", "severity: must be a table"),
        ("fail_on = 'often'", "fail_on 'often': must be error, warning, note or never"),
        ("fail_on = 1", "fail_on: must be a text"),
        ("colour = 'red'", "no key 'colour': there are baseline, fail_on and severity"),
        ("baseline = [", "pyproject.toml:2: not TOML"),
    ],
)
def test_what_it_does_not_know_is_one_line_with_file_and_key(tmp_path: Path, table: str, expected: str) -> None:
    project(tmp_path, f"[tool.c2000-hil]\n{table}\n")
    with pytest.raises(ValueError, match=r"pyproject\.toml") as caught:
        Policy.load(tmp_path)
    assert expected in str(caught.value)
    assert "\n" not in str(caught.value)
