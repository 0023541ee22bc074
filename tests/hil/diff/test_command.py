"""``hil diff`` as a user calls it."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.cli import invoke


def test_a_folder_without_a_file_of_the_robot_is_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["diff", str(tmp_path)]) == 2
    assert f"hil: error: {tmp_path}: no C file of the robot in this folder" in capsys.readouterr().err
