"""Positions of an eQEP of which 16 bits are kept though all 32 are subtracted, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

PROGRAM = """#include "F28x_Project.h"
static Uint16 Last; static Uint32 Whole; static int32 Sum; static int16 Step;
static void f(void)
{{
    Uint32 position = EQep1Regs.QPOSLAT;
    int32 counts = 0;
    {body}
    Sum += counts;
}}
void main(void)
{{
    InitSysCtrl();
    EQep1Regs.QPOSMAX = 0xFFFFFFFF; EQep1Regs.QEPCTL.bit.PCRM = 1; EQep1Regs.QPOSCNT = 0;
    {start}
    for (;;)
        f();
}}
"""


def told(tmp_path: Path, body: str, start: str = "") -> bool:
    """Whether a program is told that it keeps 16 bits of a position."""
    file = tmp_path / "axis.c"
    file.write_text(PROGRAM.format(body=body, start=start), encoding="utf-8")
    return "narrowed" in {f.rule for f in Build([str(file)]).compiled.findings}


@pytest.mark.parametrize(
    "body",
    [
        "counts = (int32)(position - Last); Last = position;",
        "counts = position - Last; Last = (Uint16)position;",
        "counts = EQep1Regs.QPOSCNT - Last; Last = EQep1Regs.QPOSCNT;",
    ],
)
def test_a_position_of_which_16_bits_are_kept(tmp_path: Path, body: str) -> None:
    assert told(tmp_path, body)


@pytest.mark.parametrize(
    "body",
    [
        "counts = (int32)(position - Whole); Whole = position;",
        "counts = (int16)(position - Last); Last = position;",
        "counts = (int16)((Uint16)position - Last); Last = (Uint16)position;",
        "Step = position - Last; counts = Step; Last = position;",
        "counts = (position - Last) & 0xFFFF; Last = position;",
        "counts = (int32)(position - Last); Last = 0;",
    ],
)
def test_a_difference_that_is_right(tmp_path: Path, body: str) -> None:
    assert not told(tmp_path, body)


@pytest.mark.parametrize(
    "start",
    [
        "EQep1Regs.QPOSMAX = 2047;",
        "EQep1Regs.QPOSMAX = 0xFFFF;",
        "EQep1Regs.QEPCTL.bit.PCRM = 0;",
        "EQep1Regs.QEPCTL.all = 0x9200;",
        "EQep1Regs.QEPCTL.bit.IEI = 2;",
        "EQep1Regs.QPOSCNT = 0x8000;",
        "for (;;) { f(); if (Sum > 2000) Home(); }",
    ],
)
def test_a_position_that_stays_below_65536(tmp_path: Path, start: str) -> None:
    text = PROGRAM.replace("void main", "static void Home(void)\n{{\n    EQep1Regs.QPOSCNT = 0;\n}}\nvoid main")
    body = "counts = (int32)(position - Last); Last = position;"
    file = tmp_path / "axis.c"
    text = (text if "Home" in start else PROGRAM).format(body=body, start=start)
    file.write_text(text, encoding="utf-8")
    assert "narrowed" not in {f.rule for f in Build([str(file)]).compiled.findings}
