"""Programs that do, and that do not, go wrong with other messages than those of their run."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import Board
from hil.drivers.check import DriverFiles, check_files
from tests.hil.drivers.test_cut_messages import COUNTED, LAPSED, LINE, PROGRAM, Console, Dimmer

FRAMES = PROGRAM.replace("RECEIVE", COUNTED).replace("BEFORE", LAPSED).replace("IDLE", "").replace("[8]", "[4]")
LINES = PROGRAM.replace("RECEIVE", LINE).replace("IDLE", "").replace("LONG", "").replace("END", "Filled = 0;")
INSIDE = "static int Inside(Uint16 v, Uint16 low, Uint16 high) { return v >= low && v <= high; }\nstatic void Apply"
TESTED = "    if (!Inside(level, 20, MOST)) { Bad++; return; }\n    COMPUTE;"
#: It computes with levels that it takes; the run has 127 to 727.
LIMITED = FRAMES.replace("    Level = level;", TESTED).replace("static void Apply", INSIDE)


def told(folder: Path, text: str, board: type[Board]) -> set[tuple[str, str, bool]]:
    """The rules of what other messages show, each with the statement and whether it is certain."""
    (folder / "drv.c").write_text(text, encoding="utf-8")
    wanted = DriverFiles([folder / "drv.c"], calls=1, board=board, seconds=0.4, silence=True, board_named=True)
    return {
        (f.rule, text.splitlines()[f.place.line - 1].strip(), f.how == "dynamic")
        for f in check_files(wanted).findings if f.place and any("after the usual" in each for each in f.details)
    }  # fmt: skip


@pytest.mark.parametrize(
    ("text", "board", "wanted"),
    [
        # The run has a pause behind each message, so the fifth character never comes.
        (FRAMES.replace("Filled < 4", "Filled <= 4"), Dimmer, {("index", "Frame[Filled++] = c;", True)}),
        (LINES, Console, set()),
        (LINES.replace("Filled < 8", "Filled <= 8"), Console, {("index", "Frame[Filled++] = c;", True)}),
        # It takes 2000, which the run does not have.
        (
            LIMITED.replace("MOST", "2000").replace("COMPUTE", "Level = level * 50 / 3"), Dimmer,
            {("unsigned-wrap", "Level = level * 50 / 3;", True)},
        ),
        (LIMITED.replace("MOST", "1300").replace("COMPUTE", "Level = level * 50 / 3"), Dimmer, set()),
        (LIMITED.replace("MOST", "2000").replace("COMPUTE", "Level = Curve[level / 200]").replace(
            "Bad = 0;", "Bad = 0;\nstatic const Uint16 Curve[10] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};", 1
        ), Dimmer, {("index", "Level = Curve[level / 200];", True)}),
        # It takes all of them: whether 65535 ever comes is not known.
        (
            FRAMES.replace("    Level = level;", "    Level = level * 50 / 3;"), Dimmer,
            {("unsigned-wrap", "Level = level * 50 / 3;", False)},
        ),
    ],
)  # fmt: skip
def test_other_messages(tmp_path: Path, text: str, board: type[Board], wanted: set[tuple[str, str, bool]]) -> None:
    assert told(tmp_path, text, board) == wanted
