"""Own C files in the place of modules of the port: which are meant, what is refused, and that they run."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.c28x.symbols import SourceError
from firmware_model.c_files import FILES, module_of, own
from firmware_model.image import link
from hil.robot.board import RobotBoard

pytest.importorskip("pycparser")

#: Odometry.c of our own: it only counts how often it was called, in the member that holds the angle.
ODOMETRY = """\
#include "ROBOT_types.h"
#include "Odometry.h"

static int calls = 0;

void Odom_Trayect(ODOMETRY_Trayect *at, float V, float W, float df, float dr, float dl, float Tcontrol)
{
    calls++;
    at->tita = calls;
    at->X = STEPS * V;
}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with ODOMETRY.C: names are known in any case."""
    (tmp_path / "ODOMETRY.C").write_text(ODOMETRY, encoding="utf-8")
    return tmp_path


def test_a_file_is_known_by_its_name_in_any_case() -> None:
    assert module_of("x/gyro.C") == "firmware_model.gyro"
    assert module_of("MAIN_ROBOT.c") == "firmware_model.main_robot"
    assert module_of("xbee.c") == "firmware_model.board_support.xbee"
    assert module_of("ROBOT_types.c") is None
    assert module_of("firmware_model.us") is None
    assert {"us.c", "GYRO.c", "Odometry.c", "protocol.c", "servidores.c", "main_Robot.c", "spi.c"} <= set(FILES)


def test_the_files_of_a_folder_are_those_of_the_robot_and_others_are_left_out(folder: Path) -> None:
    (folder / "filter.c").write_text("int f(void) { return 1; }\n", encoding="utf-8")
    found = own([folder])
    assert found.instead == {"firmware_model.odometry": str(folder / "ODOMETRY.C")}
    assert found.left_out == (str(folder / "filter.c"),)
    assert own([folder, folder / "filter.c"]).besides == (str(folder / "filter.c"),)


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (["nowhere"], "nowhere: there is no such file or folder"),
        (["empty"], "no C file of the robot in this folder: looked for main_Robot.c, us.c"),
        (["notes.txt"], "notes.txt: expected a C file"),
        (["filter.c"], "filter.c: no C file of the robot: looked for"),
        ([".", "twice/Odometry.c"], "are the same file of the robot"),
    ],
)
def test_what_means_no_file_of_the_robot_is_refused(folder: Path, names: list[str], message: str) -> None:
    (folder / "empty").mkdir()
    (folder / "twice").mkdir()
    for name in ("notes.txt", "filter.c", "twice/Odometry.c"):
        (folder / name).write_text("", encoding="utf-8")
    with pytest.raises(ValueError, match=message):
        own([folder / name for name in names])


def test_the_c_file_runs_in_the_place_of_its_module(folder: Path) -> None:
    fw = link(RobotBoard(), firmware=[folder], defines=["STEPS=4"])
    at = fw.new("ODOMETRY_Trayect", X=0.0, tita=0.0)
    fw.odometry.Odom_Trayect(at, 0.5, 0.0, 0.0, 0.0, 0.0, 0.25)
    fw.odometry.Odom_Trayect(at, 0.5, 0.0, 0.0, 0.0, 0.0, 0.25)
    # Two calls; 4 * 0.5 = 2.
    assert at.tita == 2.0
    assert at.X == 2.0
    assert fw.linked.program.module("firmware_model.odometry").file == str(folder / "ODOMETRY.C")
    assert fw.linked.program.module("firmware_model.us").file.endswith("us.py")


def test_a_file_that_does_not_translate_names_its_line_and_column(folder: Path) -> None:
    with pytest.raises(SourceError, match=r"ODOMETRY.C:10:13: .*STEPS"):
        link(RobotBoard(), firmware=[folder])


def test_a_correction_of_a_module_that_a_c_file_stands_for_is_refused(folder: Path) -> None:
    (folder / "us.c").write_text('#include "us.h"\n', encoding="utf-8")
    with pytest.raises(ValueError, match=r"us.c: the correction US-\S+ is for the port"):
        link(RobotBoard(), firmware=[folder / "us.c"], fixes=["US-accumulator"])


def test_latin_1_is_read_as_editors_on_windows_write_it(folder: Path) -> None:
    file = folder / "ODOMETRY.C"
    file.write_bytes("/* posici\xf3n */\n".encode("latin-1") + ODOMETRY.encode())
    link(RobotBoard(), firmware=[file], defines=["STEPS=1"])
