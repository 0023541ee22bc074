"""Scenarios run and judged: verdicts, processes, JUnit, pytest, live."""

from __future__ import annotations

import json
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from emulator.rules import Severity
from firmware_model.catalogue import CATALOGUE
from firmware_model.corrections import resolve
from hil.cli import invoke
from hil.reports.policy import Policy
from hil.scenarios.running import run, run_file, shipped
from hil.scenarios.scenario import load_scenario

pytest_plugins = ["pytester"]

SHORT = """
realistic = false
seconds = 1
orders = ["mission"]
fixes = ["MAIN-us-first-read"]
faithful_fails = ["sonars are ready"]

[[expect]]
name = "it drives"
quantity = "x_m"
least = 0.42

[[expect]]
name = "it stands at first"
quantity = "travelled_m"
during = [0, 0.05]
most = 0.001

[[expect]]
name = "sonars are ready"
finding = "startup-read"
place = "sonar"
absent = true

[[expect]]
name = "frames come"
frame = "^#ODO "
during = [0, 0.9]
least = 3
most = 4

[[expect]]
name = "it is on its mission"
state = "MISSION"
at = 0.5
"""


def written(folder: Path, text: str, name: str = "short") -> Path:
    path = folder / f"{name}.scenario.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_scenario_is_run_with_and_without_its_corrections(tmp_path: Path) -> None:
    outcome = run_file(written(tmp_path, SHORT))
    assert outcome.failures == []
    assert [leg.fixes for leg in outcome.legs] == [("MAIN-us-first-read",), ()]
    assert [[check.ok for check in leg.checks] for leg in outcome.legs] == [
        [True] * 5, [True, True, False, True, True],
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("least = 0.42", "least = 9"), "it drives: x_m"),
        (("most = 0.001", "least = 0.5"), "it stands at first: travelled_m 0 at 0.00 s"),
        (("most = 4", "most = 3.5\nleast = 3.4"), "frames come"),
        (('"MISSION"\nat', '"STOP"\nat'), "it is on its mission: state MISSION at 0.50 s; expected STOP"),
        (("absent = true", ""), "sonars are ready: no finding startup-read"),
        (('faithful_fails = ["sonars', 'faithful_fails = ["it drives", "sonars'), "came true without the corrections"),
        (('faithful_fails = ["sonars are ready"]', 'faithful_fails = ["it drives"]'), "which the file does not say"),
    ],
)
def test_what_is_not_as_the_file_says_fails_it(tmp_path: Path, change: tuple[str, str], said: str) -> None:
    text = SHORT.replace("least = 3\nmost = 4", "most = 4") if "frames" in said else SHORT
    assert change[0] in text
    failures = run_file(written(tmp_path, text.replace(*change))).failures
    assert any(said in failure for failure in failures), failures


def test_looking_changes_nothing(tmp_path: Path) -> None:
    blind = SHORT.partition("[[expect]]")[0].replace("faithful_fails", "# faithful_fails")
    seen, unseen = (run_file(written(tmp_path, text)).legs[0].uart_sha256 for text in (SHORT, blind))
    assert seen == unseen


def test_a_fault_that_never_fires_fails_it(tmp_path: Path) -> None:
    fault = '[[faults]]\nkind = "gyro-reset"\nat = {at}\n'
    base = "realistic = false\nseconds = 0.2\n"
    assert run_file(written(tmp_path, base + fault.format(at=0.1))).passed
    (failure,) = run_file(written(tmp_path, base + fault.format(at=5))).failures
    assert failure == "the fault gyro-reset fires: gyro-reset:at=5: it never fired"


def test_an_order_waits_for_what_happens(tmp_path: Path) -> None:
    text = """
realistic = false
seconds = 2
orders = ["mission"]
[[order]]
send = "stop"
when = "pose x>450"
[[expect]]
name = "it stops"
state = "STOP"
[[expect]]
name = "near there"
quantity = "x_m"
least = 0.45
most = 0.5
"""
    assert run_file(written(tmp_path, text)).failures == []


def test_a_script_drives_and_its_assertion_judges(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "drive.py").write_text(
        "from hil.scenarios.script import timeline, when\n"
        "def scenario(bench):\n"
        "    timeline(bench).until(when(bench).holds(lambda: bench.world.pose.x_m > 0.42), within_s=2)\n"
        "    bench.feed(b'#STOP\\r')\n"
        "    bench.run_for(0.5)\n"
        "    assert bench.status().state == 'STOP', bench.status().state\n"
        "    assert bench.world.pose.x_m > LIMIT, 'not far enough'\n"
        "LIMIT = 0.4\n"
    )
    path = written(tmp_path, 'realistic = false\nseconds = 3\nscript = "drive.py"\noutputs = {json = "out.json"}\n')
    monkeypatch.chdir(tmp_path)
    assert run_file(path).failures == []
    # The same live, in slices: the script waits for the same moments.
    live = ["run", "--scenario", str(path), "--no-port", "--pace", "max", "--json"]
    assert invoke(live) == 0
    shown = json.loads(capsys.readouterr().out)
    assert shown["uart_sha256"] == json.loads((tmp_path / "out.json").read_text())["runs"][0]["uart_sha256"]
    (tmp_path / "drive.py").write_text((tmp_path / "drive.py").read_text().replace("LIMIT = 0.4", "LIMIT = 4"))
    assert run_file(path).failures == ["script: not far enough"]
    assert invoke(live) == 1
    assert "script: not far enough" in capsys.readouterr().err
    assert invoke([*live[:-1], "--view"]) == 2
    (tmp_path / "drive.py").write_text("def scenario(bench):\n    bench.no_such_thing\n")
    (failure,) = run_file(path).failures
    assert failure.startswith(f"script: {tmp_path / 'drive.py'}:2: AttributeError: ")
    (tmp_path / "drive.py").write_text("x = 1\n")
    with pytest.raises(ValueError, match=r"drive\.py: there is no function"):
        run_file(path)


def test_start_and_floor_are_those_of_the_file(tmp_path: Path) -> None:
    text = "[start]\nx_m = 1.0\ny_m = 0.7\nheading_deg = 90\n[floor]\ngrip = 0.3\nslip_right = 0.2\n"
    scenario, _ = load_scenario(written(tmp_path, text), Policy())
    bench = scenario.bench()
    pose = bench.world.pose
    bench.close()
    assert (pose.x_m, pose.y_m, round(pose.heading_rad, 4)) == (1.0, 0.7, 1.5708)
    assert (bench.world.map.grip, bench.world.map.slip) == (0.3, (0.0, 0.2))


def test_outputs_are_written(tmp_path: Path) -> None:
    text = f"""realistic = false
seconds = 0.3
[outputs]
json = "{tmp_path}/out.json"
path = "{tmp_path}/path.csv"
plot = "{tmp_path}/drive.svg"
"""
    outcome = run(load_scenario(written(tmp_path, text), Policy())[0])
    assert json.loads((tmp_path / "out.json").read_text()) == outcome.as_dict()
    assert (tmp_path / "path.csv").read_text().startswith("time_s,x_m,y_m,heading_rad\n")
    assert "<svg" in (tmp_path / "drive.svg").read_text()


@pytest.mark.slow
def test_two_at_a_time_are_the_same_as_one_after_the_other(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = [str(written(tmp_path, SHORT, name)) for name in ("b", "a")]
    (tmp_path / "a.scenario.toml").write_text(SHORT.replace("least = 0.42", "least = 9"))
    told = []
    for jobs in ("1", "2"):
        assert invoke(["scenario", *files, "-j", jobs, "--json", "--junit", str(tmp_path / f"{jobs}.xml")]) == 1
        told.append(json.loads(capsys.readouterr().out))
    assert told[0] == told[1]
    found = told[0]["findings"]
    assert {"rule", "severity", "file", "line", "fingerprint", "shown_by"} <= found[0].keys()
    told = [each["scenarios"] for each in told]
    here = {each["fingerprint"] for one in told[0] for each in one["runs"][0]["findings"]}
    assert here == {each["fingerprint"] for each in found}
    assert invoke(["scenario", *files, "-j", "2"]) == 1
    told_last = capsys.readouterr().out
    # What was found is the table that every command has, before the verdicts.
    assert re.search(r"^\d+ errors?, \d+ warnings?.*Scenarios: 2", told_last, re.MULTILINE | re.DOTALL)
    assert [(one["name"], one["passed"]) for one in told[0]] == [("b", True), ("a", False)]
    assert (tmp_path / "1.xml").read_text() == (tmp_path / "2.xml").read_text()
    suites = ElementTree.parse(tmp_path / "1.xml").getroot()
    assert [(suite.get("name"), suite.get("failures"), suite.get("tests")) for suite in suites] == [
        ("b", "0", "12"), ("a", "2", "12"),
    ]  # fmt: skip


def test_bad_input_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    good, bad = written(tmp_path, SHORT), written(tmp_path, "seed = 1\nsede = 2\n", "bad")
    assert invoke(["scenario", str(good), str(bad)]) == 2
    assert capsys.readouterr().err.startswith(f"hil: error: {bad}:2: sede: no key 'sede'")
    assert invoke(["scenario"]) == 2
    assert invoke(["scenario", str(tmp_path / "none.toml")]) == 2


def test_it_is_live_and_judged(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = str(written(tmp_path, SHORT.replace("faithful_fails", "# faithful_fails")))
    live = ["run", "--scenario", path, "--no-port", "--pace", "max"]
    assert invoke(live) == 0
    assert "ok     it drives: x_m" in capsys.readouterr().out
    assert invoke([*live, "--for", "0.1"]) == 1
    assert "it drives: x_m" in capsys.readouterr().err
    assert invoke([*live, "--world", "room"]) == 2


def test_pytest_collects_them(pytester: pytest.Pytester) -> None:
    written(pytester.path, SHORT.replace("faithful_fails", "# faithful_fails"), "good")
    written(pytester.path, SHORT.replace("least = 0.42", "least = 9"), "wrong")
    written(pytester.path, "sede = 2\n", "bad")
    result = pytester.runpytest_inprocess("-p", "no:cacheprovider")
    result.assert_outcomes(passed=1, failed=2)
    result.stdout.fnmatch_lines(["*bad.scenario.toml:1: sede: no key*", "*it drives: x_m * expected at least 9*"])


@pytest.mark.slow
@pytest.mark.parametrize("path", shipped(), ids=lambda path: path.name.partition(".")[0])
def test_shipped_scenarios_come_true(path: Path) -> None:
    outcome = run_file(path)
    assert outcome.failures == []
    assert outcome.thesis
    assert outcome.description


def test_every_grave_defect_is_shown_by_a_shipped_scenario() -> None:
    scenarios = [load_scenario(path, Policy())[0] for path in shipped()]
    grave = {d.id for d in CATALOGUE.values() if d.severity is Severity.ERROR and d.in_firmware}
    assert grave
    assert grave - {name for scenario in scenarios for name in scenario.defects} == set()
    for scenario in scenarios:
        if scenario.defects:
            assert set(scenario.defects) <= resolve(scenario.setup.fixes), scenario.name
            assert scenario.faithful_fails, scenario.name


def test_the_second_run_is_without_the_corrections_of_the_defects_that_it_shows(tmp_path: Path) -> None:
    def second(fixes: str, defects: str) -> tuple[str, ...]:
        text = SHORT.replace('fixes = ["MAIN-us-first-read"]', f"fixes = {fixes}\ndefects = {defects}")
        return load_scenario(written(tmp_path, text), Policy())[0].uncorrected().setup.fixes

    corrections = resolve(["all"])
    assert second('["all"]', '["GYRO-scale", "US-accumulator"]') == tuple(
        sorted(corrections - {"GYRO-scale", "US-accumulator"})
    )
    assert second('["US-accumulator", "GYRO-scale", "GYRO-radians"]', '["GYRO-scale"]') == (
        "GYRO-radians", "US-accumulator",
    )  # fmt: skip
    assert second('["GYRO-scale"]', '["GYRO-scale"]') == ()
    assert second('["all"]', "[]") == (), "no defect is named: the faithful firmware"


def test_the_page_lists_the_shipped_scenarios() -> None:
    page = (Path(__file__).parents[3] / "hil" / "scenarios" / "README.md").read_text(encoding="utf-8")
    listed = page.partition("<!-- shipped -->")[2].partition("<!-- /shipped -->")[0]
    rows = []
    for path in shipped():
        scenario, _ = load_scenario(path, Policy())
        rows.append(
            f"| `{scenario.name}` | {scenario.thesis} | {scenario.description} | {', '.join(scenario.defects)} "
            f"| {', '.join(scenario.setup.fixes)} | {'; '.join(scenario.faithful_fails)} |"
        )
    assert [line for line in listed.splitlines() if line.startswith("| `")] == rows
