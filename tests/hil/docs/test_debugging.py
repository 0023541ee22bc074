"""The page about debugging tells the truth: breakpoints, stacks, locals, steps in C and in Python, tests and tasks."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

import firmware_model.main_robot
import firmware_model.us
from hil.cli import invoke
from hil.docs import PAGES
from hil.project import LANGUAGES, make

pytest.importorskip("debugpy", reason="needs the extra test (debugpy)")
pytest.importorskip("pycparser", reason="needs the extra c (pycparser)")

from tests.hil.docs.dap import Debugged

US = Path(firmware_model.us.__file__)
MAIN = Path(firmware_model.main_robot.__file__)


def line_of(file: Path, pattern: str) -> int:
    """The line in which a pattern ends for the first time."""
    text = file.read_text(encoding="utf-8")
    match = re.search(pattern, text, re.DOTALL)
    assert match is not None
    return text.count("\n", 0, match.end()) + 1


def configurations(text: str) -> dict[str, dict[str, Any]]:
    return {each["name"]: each for each in json.loads(text)["configurations"]}


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_driver_under_pytest_with_the_configuration_of_a_new_project(language: str, tmp_path: Path) -> None:
    folder = tmp_path / "lidar"
    make(folder, language)
    editor = folder / ".vscode"
    driver = folder / ("lidar.c" if language == "c" else "lidar.py")
    assert json.loads((editor / "settings.json").read_text())["debug.allowBreakpointsEverywhere"] is True
    tests = folder / "test_lidar.py"
    launch = (editor / "launch.json").read_text().replace("${file}", tests.as_posix())
    both = configurations(launch)
    assert both["All tests"] == {
        key: value for key, value in both["Tests of this file"].items() if key not in ("args", "purpose")
    } | {"name": "All tests"}
    # One of them for each language.
    one = both["All tests" if language == "python" else "Tests of this file"]
    adds = line_of(driver, r"sum \+= _?Samples")
    with Debugged(one, folder) as program:
        program.start({driver: [adds]})
        stack = program.stopped()
        assert [frame.function for frame in stack[:2]] == ["Lidar_Mean", "Lidar_Distance_Mm"]
        (test,) = (frame for frame in stack if frame.function == "test_distance")
        samples = "Samples" if language == "c" else "_Samples"
        assert int(program.value(f"firmware.lidar.{samples}[0]", test)) > 0
        assert (Path(stack[0].file), stack[0].line) == (driver, adds)
        local = program.local(stack[0])
        assert (local["i"], local["sum"]) == ("0", "0")
        # A step is a line of the source, and what it did is seen.
        program.go_on("next")
        assert program.stopped()[0].line == adds - 1, "the loop"
        program.go_on("next")
        stack = program.stopped()
        local = program.local(stack[0])
        assert (Path(stack[0].file), stack[0].line, local["i"]) == (driver, adds, "1")
        assert int(local["sum"]) == int(program.value("_v", stack[0])) > 0
        program.breakpoints(driver, [])
        program.go_on()
        assert program.ended() == 0, program.output
    assert "4 passed" in program.output


def test_tasks_of_the_whole_robot_and_time_stands_still(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    (block,) = re.findall(r"^```json\n(.*?)^```$", PAGES["debugging"].text(), re.MULTILINE | re.DOTALL)
    (robot,) = configurations(block).values()
    assert robot["module"] == "hil"
    arguments = [*robot["args"], "--json"]
    assert invoke(arguments) == 0
    without = json.loads(capsys.readouterr().out)
    reads, looks = line_of(US, r"def Read_Channel.*?EDIS"), line_of(MAIN, r"def TaskNAVIGATION\(.*?df =")
    with Debugged({**robot, "args": arguments}, tmp_path) as program:
        program.start({US: [reads]})
        stack = program.stopped()
        assert [frame.function for frame in stack[:3]] == ["Read_Channel", "Read_Distance", "TaskUS"]
        assert (Path(stack[0].file), stack[0].line) == (US, reads)
        assert program.local(stack[0])["CH"] == "0"
        now = program.value("_k.now", stack[0])
        program.breakpoints(US, [])
        program.breakpoints(MAIN, [looks])
        assert program.value("_k.now", stack[0]) == now
        program.go_on()
        # Another task, in a greenlet of its own.
        stack = program.stopped()
        assert (stack[0].function, stack[0].line) == ("TaskNAVIGATION", looks)
        assert int(program.value("_k.now", stack[0])) > int(now)
        program.breakpoints(MAIN, [])
        program.go_on()
        assert program.ended() == 0, program.output
    # Not a byte and no switch of a task is another one because of the stops.
    debugged = json.loads(program.output)
    for name in ("virtual_s", "uart_sha256", "trace_sha256"):
        assert debugged[name] == without[name] != ""
