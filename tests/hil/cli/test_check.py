"""``hil check``: what it writes, what counts, and how it ends."""

from __future__ import annotations

import json
import os
import pty
import subprocess
import sys
from pathlib import Path

import pytest

from hil.cli import invoke
from hil.scenarios.scenario import Scenario

#: us.c reads three accumulators that nobody initialised: the first finding comes at 10 ms.
SHORT = ["check", "--for", "0.1", "--order", "stop"]
RULE = "uninitialised"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A directory of the user's own."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def report(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, dict[str, object]]:
    capsys.readouterr()
    status = invoke([*SHORT, "--json", *arguments])
    return status, json.loads(capsys.readouterr().out)


def test_options_of_the_board_reach_the_bench_and_go_before_those_of_the_scenario(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def told(self: Scenario, coverage: object = None) -> None:
        raise ValueError(f"made with {self.setup.options}")

    monkeypatch.setattr(Scenario, "bench", told)
    (folder / "s.toml").write_text('options = ["accelerometer"]\n', encoding="utf-8")
    for arguments in ([], ["s.toml"]):
        assert invoke(["check", *arguments, "--option", "lidar"]) == 2
        assert "made with ('lidar',)" in capsys.readouterr().err
    assert invoke(["check", "s.toml"]) == 2
    assert "made with ('accelerometer',)" in capsys.readouterr().err


def test_findings_fail_the_check_and_every_report_is_written(folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert invoke([*SHORT, "--sarif", "a.sarif", "--html", "a.html", "--junit", "a.xml", "--details"]) == 1
    out = capfd.readouterr().out
    assert "us.Read_Distance.result" in out
    assert "called from TaskUS (firmware_model/main_robot.py:" in out
    assert " the check" in out.splitlines()[-1]
    results = json.loads((folder / "a.sarif").read_text())["runs"][0]["results"]
    assert any(one["ruleId"] == RULE for one in results)
    assert any(one["ruleId"] == "gate-unused" for one in results), "what only the end of a run shows"
    uris = {loc["physicalLocation"]["artifactLocation"]["uri"] for one in results for loc in one.get("locations", [])}
    assert "firmware_model/us.py" in uris
    assert all(not uri.startswith("/") for uri in uris)
    assert str(Path(__file__).parents[3]) not in (folder / "a.sarif").read_text() + (folder / "a.xml").read_text()
    assert "us.Read_Distance.result" in (folder / "a.html").read_text()


def test_the_same_check_is_the_same_report(capsys: pytest.CaptureFixture[str]) -> None:
    assert report(capsys) == report(capsys)


def test_a_baseline_makes_known_findings_pass_and_lists_those_that_went(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert invoke([*SHORT, "--baseline", "known.json", "--update-baseline"]) == 0
    status, data = report(capsys, "--baseline", "known.json")
    assert (status, data["counted"], data["failed"]) == (0, 0, False)
    known = json.loads((folder / "known.json").read_text())
    invented = {**known["findings"][0], "fingerprint": "0", "object": "an object that went"}
    taken = known["findings"].pop()
    known["findings"].append(invented)
    (folder / "known.json").write_text(json.dumps(known))
    capsys.readouterr()
    assert invoke([*SHORT, "--baseline", "known.json", "--fail-on", "note"]) == 1
    out = capsys.readouterr().out
    assert "an object that went" in out
    assert "1 gone; 1 fails the check" in out
    _, data = report(capsys, "--baseline", "known.json")
    findings = data["findings"]
    assert isinstance(findings, list)
    assert [one["fingerprint"] for one in findings if one["state"] == "new"] == [taken["fingerprint"]]


def test_the_projects_policy_is_used(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, data = report(capsys)
    rules = data["rules"]
    assert isinstance(rules, dict)
    table = "\n".join(f'{rule} = "note"' for rule in rules if rule != RULE)
    (folder / "pyproject.toml").write_text(f'[tool.c2000-hil.severity]\n{RULE} = "off"\n{table}\n')
    status, data = report(capsys)
    assert status == 0
    assert data["turned_off"]
    status, _ = report(capsys, "--fail-on", "note")
    assert status == (1 if table else 0)


def test_a_scenario_file_and_an_option_over_it(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "still.toml").write_text('seconds = 0.05\norders = ["stop"]\nseed = 5\nfail_on = "never"\n')
    assert invoke(["check", "still.toml", "--json", "--world", "box"]) == 0
    run = json.loads(capsys.readouterr().out)["run"]
    assert (run["name"], run["setup"]["seed"], run["setup"]["world"], run["orders"]) == ("still", 5, "box", ["stop"])
    # 2.2 s of start-up.
    assert run["virtual_s"] == pytest.approx(2.25)


def test_the_proof_says_what_a_finding_reaches(capsys: pytest.CaptureFixture[str]) -> None:
    _, data = report(capsys, "--proof", "--proof-for", "0.1")
    findings = data["findings"]
    assert isinstance(findings, list)
    (one,) = [one for one in findings if (one["rule"], one["object"]) == (RULE, "us.Read_Distance.result")]
    assert list(one["reaches"]["frames"]["fields"]) == ["dL"]


def test_a_firmware_that_stops_fails_with_its_findings(capfd: pytest.CaptureFixture[str]) -> None:
    assert invoke([*SHORT, "--fill", "trap", "--fail-on", "never"]) == 1
    out, err = capfd.readouterr()
    assert "us.Read_Distance" in out
    assert err.startswith("hil: error: the firmware stopped: us.Read_Distance")
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["--fail-on", "often"], "fail_on 'often': must be error, warning, note or never"),
        (["--baseline", "none.json"], "none.json: there is no such baseline"),
        (["--update-baseline"], "--update-baseline: no file given"),
        (["--html", "no/where.html"], "no/where.html: there is no folder"),
        (["--order", "jump"], "no order 'jump'"),
        (["--world", "moon"], "moon"),
        (["--fill", "heap"], "unknown fill policy 'heap'"),
        (["--fix", "no-such-fix"], "no-such-fix"),
        (["--proof", "--against", "zero"], "two fills"),
        (["--proof", "--against", "heap"], "unknown fill policy 'heap'"),
        (["--for", "0"], "seconds 0.0: must be more than 0"),
        (["none.toml"], "none.toml"),
    ],
)
def test_bad_input_is_one_line_before_anything_runs(
    arguments: list[str], expected: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("hil.scenarios.scenario.Scenario.run", None)
    assert invoke([*SHORT, *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("hil: error: ")
    assert expected in err
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    "command", ["run --no-port --pace max", "soak", "campaign", "scenario --shipped", "run --view --no-open"]
)
def test_no_run_begins_with_a_wrong_policy(
    command: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    (folder / "pyproject.toml").write_text('[tool.c2000-hil]\nfail_on = "heavy"\n')
    assert invoke(command.split()) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert "fail_on 'heavy'" in err


def test_a_wrong_policy_is_one_line(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "pyproject.toml").write_text('[tool.c2000-hil.severity]\nuninitialized = "note"\n')
    assert invoke(SHORT) == 2
    assert "[tool.c2000-hil]: severity: no rule 'uninitialized'" in capsys.readouterr().err


def test_it_explains_itself_with_examples_and_exit_codes(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["check", "--help"]) == 0
    out = capsys.readouterr().out
    for part in ("hil check", "Examples", "Exit status", "--update-baseline"):
        assert part in out


def test_a_terminal_gets_colour_and_no_line_wider_than_it(folder: Path) -> None:
    leader, follower = pty.openpty()
    with subprocess.Popen(
        [sys.executable, "-m", "hil", *SHORT], stdout=follower, stderr=follower, cwd=folder,
        env={**os.environ, "COLUMNS": "100", "TERM": "xterm"},
    ) as process:  # fmt: skip
        os.close(follower)
        out = b""
        try:
            while piece := os.read(leader, 65536):
                out += piece
        except OSError:  # the other end is closed
            pass
    os.close(leader)
    assert process.returncode == 1
    assert b"\x1b[3" in out
