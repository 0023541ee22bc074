"""The three steps of `hil diff` on the whole robot, with bumper.c of our own in the place of the port's."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.diff.compare import ComparisonOptions, Result, compare_firmware

pytest.importorskip("pycparser")

#: What bumper.py does, in C; lines count from 1.
BUMPER = """\
#include "F28x_Project.h"
#include "bumper.h"

void Init_Bumper(void)
{
    EALLOW;
    GpioCtrlRegs.GPBMUX1.bit.GPIO43 = 0;
    GpioCtrlRegs.GPBGMUX1.bit.GPIO43 = 0;
    GpioCtrlRegs.GPBDIR.bit.GPIO43 = 0;
    GpioCtrlRegs.GPBPUD.bit.GPIO43 = 0;
    GpioCtrlRegs.GPBCTRL.bit.QUALPRD1 = 255;
    GpioCtrlRegs.GPBQSEL1.bit.GPIO43 = 2;
    EDIS;
}

char Read_Bumper(void)
{
    return GpioDataRegs.GPBDAT.bit.GPIO43;
}
"""


def compared(folder: Path, text: str) -> Result:
    (folder / "bumper.c").write_text(text, encoding="utf-8")
    return compare_firmware(ComparisonOptions([str(folder)], seconds=1.0))


@pytest.mark.slow
def test_the_same_in_c_is_equal_in_trees_and_in_the_whole_run(tmp_path: Path) -> None:
    result = compared(tmp_path, BUMPER)
    assert sorted(result.trees.equal) == ["bumper.Init_Bumper", "bumper.Read_Bumper"]
    assert (result.trees.differences, result.observed, result.unproven) == ([], [], [])
    assert not result.skewed
    assert result.verdict == "equal"
    assert result.runs is not None
    assert {"Init_Bumper", "TaskODO"} <= result.runs.functions


@pytest.mark.slow
def test_one_other_constant_is_told_by_trees_calls_and_runs(tmp_path: Path) -> None:
    # Three samples qualify the level instead of six: GPBQSEL1 is written once, in the start-up.  The statement begins
    # at column 5, its constant stands at column 40.
    result = compared(tmp_path, BUMPER.replace("GPBQSEL1.bit.GPIO43 = 2", "GPBQSEL1.bit.GPIO43 = 1"))
    assert result.trees.equal == ["bumper.Read_Bumper"]
    (tree,) = result.trees.functions["bumper.Init_Bumper"]
    assert (tree.port, tree.own) == ("bumper.py:23", "bumper.c:12:40")
    assert tree.cause == "other constant: 2 in the port, 1 in the C"
    called = result.calls["bumper.Init_Bumper"]
    assert called.calls > 0
    assert [(d.port, d.own) for d in called.differences] == [("bumper.py:23", "bumper.c:12:5")]
    assert result.runs is not None
    assert [(d.port, d.own) for d in result.runs.differences] == [("bumper.py:23", "bumper.c:12:5")]
    assert result.different
    assert result.verdict == "different: 2 differences in what a program can observe"
