"""The command line as a whole, ``hil conformance`` and ``hil tasks``."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import hil.conformance
from emulator.c28x.passes.costs import UNCALIBRATED_FACTOR
from hil.cli import commands, invoke, show
from hil.conformance import FileResult, Mismatch
from hil.machine import CpuUse, Setup, TaskTimes
from tests.hil.scripted_machine import ScriptedMachine
from tests.hil.waiting import eventually

REPOSITORY = Path(__file__).parents[3]
COMMANDS = sorted(commands.COMMANDS)


def test_python_m_hil_is_the_command() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "hil", "--help"], cwd=REPOSITORY, capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0
    for command in COMMANDS:
        assert command in done.stdout


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_explains_itself_with_examples(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke([command, "--help"]) == 0
    out = capsys.readouterr().out
    assert "Examples" in out
    assert f"hil {command}" in out


def test_a_place_of_a_table_stays_a_place(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "hundred.c").write_text("\n" * 99 + "int f(int i) { int a[2] = {1, 2}; return a[3 + 0 * i]; }\n")
    invoke(["check", str(tmp_path / "hundred.c")])
    assert "hundred.c:100:" in capsys.readouterr().out  # ":100:" is an emoji of rich


def test_an_unknown_command_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["fly"]) == 2
    err = capsys.readouterr().err
    assert err.startswith("hil: error: ")
    assert "fly" in err
    assert err.count("\n") == 1


def test_a_defect_of_ours_is_one_line_that_says_where_it_is(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def of_this_project(**_: object) -> None:
        hil.conformance.check("nothing", {}, None)  # type: ignore[arg-type]

    monkeypatch.delenv("HIL_TRACEBACK", raising=False)
    monkeypatch.setattr("hil.cli.app", of_this_project)
    assert invoke(["--flag", "conformance", "x"]) == show.EXIT_DEFECT
    told = capsys.readouterr().err
    begin = r"hil: error: an error of this tool in hil conformance, at hil/\S+\.py:\d+: [A-Z]\w+Error: "
    assert re.fullmatch(rf"{begin}.*; HIL_TRACEBACK=1 shows the traceback: report it with that\n", told)
    monkeypatch.setenv("HIL_TRACEBACK", "1")
    with pytest.raises((KeyError, AttributeError)):
        invoke(["conformance"])


def test_an_interrupt_that_python_wraps_is_one_all_the_same(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    class Named:
        def __set_name__(self, owner: type, name: str) -> None:
            raise KeyboardInterrupt

    monkeypatch.setattr("hil.cli.app", lambda **_: type("Owner", (), {"named": Named()}))
    assert invoke(["board"]) == 130
    assert capsys.readouterr().err == "hil: error: interrupted\n"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a file that is always full (/dev/full of Linux)")
@pytest.mark.parametrize("arguments", [["--version"], ["board"], ["explain"]])
def test_standard_output_that_is_full_is_one_line(arguments: list[str]) -> None:
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "hil", *arguments], cwd=REPOSITORY, stdout=full, stderr=subprocess.PIPE, text=True,
            timeout=60, check=False,
        )  # fmt: skip
    assert (done.returncode, done.stderr) == (2, "hil: error: standard output: No space left on device\n")


def test_completion_lists_the_commands() -> None:
    done = subprocess.run(
        [sys.executable, "-c", "from hil.__main__ import main; main()"],
        cwd=REPOSITORY,
        env={"_HIL_COMPLETE": "complete_bash", "COMP_WORDS": "hil ", "COMP_CWORD": "1", "PATH": ""},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert set(done.stdout.split()) == set(COMMANDS)


class TestConformance:
    """Exit status, table and last line; the vectors themselves are tested elsewhere."""

    @pytest.fixture
    def results(self, monkeypatch: pytest.MonkeyPatch) -> dict[str, FileResult]:
        known: dict[str, FileResult] = {}

        def run_file(path: str | Path, _bench: object) -> FileResult:
            if Path(path).name not in known:
                raise ValueError(f"{path}: not golden vectors")
            return known[Path(path).name]

        monkeypatch.setattr(hil.conformance, "run_file", run_file)
        return known

    def test_all_passed_is_status_0(self, results: dict[str, FileResult], capsys: pytest.CaptureFixture[str]) -> None:
        results["a.json"] = FileResult("average", 5, 0, [])
        results["m.json"] = FileResult("median", 7, 0, [])
        assert invoke(["conformance", "a.json", "m.json"]) == 0
        out = capsys.readouterr().out
        assert out.endswith("12 passed, 0 failed\n")
        assert "average" in out
        assert "median" in out

    def test_a_failure_is_status_1_and_its_difference_is_shown(
        self, results: dict[str, FileResult], capsys: pytest.CaptureFixture[str]
    ) -> None:
        results["a.json"] = FileResult("average", 4, 1, [Mismatch("avg-3", ".result", "3f800000", "40000000")])
        assert invoke(["conformance", "a.json"]) == 1
        out = capsys.readouterr().out
        assert out.endswith("4 passed, 1 failed\n")
        for part in ("avg-3", ".result", "3f800000", "40000000"):
            assert part in out

    def test_json_has_the_differences(self, results: dict[str, FileResult], capsys: pytest.CaptureFixture[str]) -> None:
        results["a.json"] = FileResult("average", 4, 1, [Mismatch("avg-3", ".result", "3f800000", "40000000")])
        assert invoke(["conformance", "--json", "a.json"]) == 1
        result = json.loads(capsys.readouterr().out)
        assert (result["passed"], result["failed"]) == (4, 1)
        assert result["files"][0]["failures"] == [
            {"id": "avg-3", "field": ".result", "expected": "3f800000", "actual": "40000000"}
        ]

    def test_bad_input_is_status_2(self, results: dict[str, FileResult], capsys: pytest.CaptureFixture[str]) -> None:
        assert invoke(["conformance", "b.json"]) == 2
        assert capsys.readouterr().err == "hil: error: b.json: not golden vectors\n"


class TestTasks:
    """Measured times beside the published ones."""

    @pytest.fixture(autouse=True)
    def scripted(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(show, "open_machine", ScriptedMachine)

    def test_the_table_names_task_and_load(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert invoke(["tasks", "--for", "0.5"]) == 0
        out = capsys.readouterr().out
        assert "TaskUS" in out
        assert "CPU load 4.000 % over 0.500 s (thesis, sum of C/T: 4.319 %)" in out

    def test_beside_a_calibrated_time_stands_what_is_left_of_it(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert invoke(["tasks", "--for", "0.5", "--json"]) == 0
        data = json.loads(capsys.readouterr().out)
        (task,) = data["tasks"]
        # 106.5 us against 107.28 and 105.26, the longest and the shortest of figures 37 and 39.
        assert task["residual_percent"] == pytest.approx([-0.727, 1.178], abs=0.001)
        assert task["uncalibrated_factor"] is None
        assert invoke(["tasks", "--for", "0.5"]) == 0
        out = capsys.readouterr().out
        assert out.splitlines()[-1] == data["off_by"]

    def test_beside_a_time_of_code_that_was_not_calibrated_stands_how_sure_it_is(
        self, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
    ) -> None:
        times = [TaskTimes(name, 1, 1, 9.0, 9.0, 9.0, 9.0) for name in ("TaskUS", "TaskORD", "TaskMine")]
        use = CpuUse(times, 0.04, of_own_c=frozenset({"TaskUS", "TaskMine"}))
        monkeypatch.setattr(ScriptedMachine, "task_statistics", lambda self: use)
        assert invoke(["tasks", "--for", "0.5", "--json"]) == 0
        # TaskUS runs C of the user's; TaskORD is the port's, but nothing was fitted to it.
        for task in json.loads(capsys.readouterr().out)["tasks"]:
            assert (task["uncalibrated_factor"], task["residual_percent"]) == (UNCALIBRATED_FACTOR, None)
        monkeypatch.setenv("COLUMNS", "200")
        assert invoke(["tasks", "--for", "0.5"]) == 0
        out = capsys.readouterr().out
        assert out.count(f"x {UNCALIBRATED_FACTOR:g} │") == 3

    def test_the_build_of_the_float_division_reaches_the_machine(self, monkeypatch: pytest.MonkeyPatch) -> None:
        setups: list[Setup] = []
        monkeypatch.setattr(show, "open_machine", lambda setup: setups.append(setup) or ScriptedMachine(setup))
        assert invoke(["tasks", "--for", "0.1", "--float-division", "tmu"]) == 0
        assert invoke(["tasks", "--for", "0.1"]) == 0
        assert invoke(["run", "--no-port", "--pace", "max", "--for", "0.1", "--float-division", "fast"]) == 0
        assert [setup.float_division for setup in setups] == ["tmu", "calibrated", "fast"]

    def test_json_has_measured_and_published(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert invoke(["tasks", "--for", "0.5", "--json"]) == 0
        (task,) = json.loads(capsys.readouterr().out)["tasks"]
        assert task["computation_mean_us"] == 106.5
        # Figures 37 and 39 of the thesis.
        assert task["thesis"] == {
            "figure37_min_us": 105.26, "figure37_max_us": 107.28, "figure39_us": 106.55, "deadline_ms": 5
        }  # fmt: skip

    def test_wrong_orders_are_one_line(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert invoke(["tasks", "--order", "jump"]) == 2
        assert capsys.readouterr().err.startswith("hil: error: no order 'jump'")


def test_a_wish_to_end_reaches_what_is_started_later() -> None:
    stop = show.StopRequest()
    stop()
    ended: list[str] = []
    stop.ends(lambda: ended.append("at once"))
    stop()
    assert ended == ["at once", "at once"]


def test_a_trapped_read_ends_the_run_in_one_line_with_the_place_and_the_time(capfd: pytest.CaptureFixture[str]) -> None:
    assert invoke(["run", "--no-port", "--pace", "max", "--for", "1", "--fill", "trap"]) == 1
    out, err = capfd.readouterr()
    assert "us.Read_Distance.result" in out
    assert err.startswith("hil: error: the firmware stopped: us.Read_Distance.result is read before")
    assert "in TaskUS at" in err
    assert err.count("\n") == 1


def test_an_index_in_a_finding_is_not_taken_for_markup(capfd: pytest.CaptureFixture[str]) -> None:
    # [i] is a tag of the terminal library.
    assert invoke(["run", "--no-port", "--pace", "max", "--for", "0.1", "--fill", "ones"]) == 0
    assert "aux + buff[i]" in capfd.readouterr().out


def test_two_interrupts_at_once_still_end_with_the_summary(tmp_path: Path) -> None:
    out = tmp_path / "out"
    with out.open("w") as stdout:
        process = subprocess.Popen(
            [sys.executable, "-m", "hil", "run", "--link", str(tmp_path / "S0")], stdout=stdout, stderr=stdout
        )
        eventually(lambda: (tmp_path / "S0").is_symlink() or process.poll() is not None)
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=60) == 0
    assert "virtual time" in out.read_text()
    assert not (tmp_path / "S0").is_symlink()


def test_version_is_that_of_the_package(capfd: pytest.CaptureFixture[str]) -> None:
    assert invoke(["--version"]) == 0
    assert capfd.readouterr().out.startswith("hil 0.")
