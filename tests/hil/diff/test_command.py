"""``hil diff`` as a user calls it."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from hil.cli import invoke
from tests.hil.diff.test_whole import BUMPER
from tests.hil.reports.test_same_place import of_json

SHORT = ("--for", "0.3", "--seed", "1")


def test_a_folder_without_a_file_of_the_robot_is_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["diff", str(tmp_path)]) == 2
    assert f"hil: error: {tmp_path}: no C file of the robot in this folder" in capsys.readouterr().err


@pytest.mark.slow
def test_findings_stand_in_the_table_that_every_command_prints(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    """What the C alone shows is a difference; what both show stands where the C has it, or its library."""
    wrong = BUMPER.replace("char Read_Bumper(void)\n{\n", "char Read_Bumper(void)\n{\n    int n, m;\n    m = n;\n")
    (tmp_path / "bumper.c").write_text(wrong, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    asked = ["diff", ".", *SHORT, "--calls", "3"]
    assert invoke(asked) == 1
    lines = capsys.readouterr().out.splitlines()
    head = next(number for number, line in enumerate(lines) if re.match(r" ?severity +rule +what +where", line))
    assert re.fullmatch(r"\d+ errors?, \d+ warnings?(, \d+ notes?)?", lines[head - 2])
    row = next(number for number, line in enumerate(lines) if "bumper.Read_Bumper.n is read" in line)
    assert re.match(r" ?error +uninitialised .*bumper\.c:19:9 ", lines[row])
    assert any("shown by the C alone" in line for line in lines[row : row + 3])
    assert lines[-1].startswith("different: ")

    assert invoke([*asked, "--json"]) == 1
    told = json.loads(capsys.readouterr().out)["findings"]
    by = {(one["rule"], one["object"]): one["shown_by"] for one in told}
    assert invoke(["run", "--no-port", "--pace", "max", "--firmware", ".", *SHORT, "--order", "mission", "--json"]) == 0
    in_run = of_json(json.loads(capsys.readouterr().out)["findings"])
    assert of_json(one for one in told if one["how"] == "dynamic") == in_run
    assert by[("uninitialised", "bumper.Read_Bumper.n")] == ["the C alone"]
    assert by[("uninitialised", "us.Read_Distance.resultF")] == ["both"]
