"""Captures of which 16 bits are kept though a test wants more, and programs for which 16 bits are enough."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files

PROGRAM = """#include "F28x_Project.h"
volatile {type} width = 0;
Uint16 last = 0, distance_mm = 0, near_ = 0, n;
Uint32 more = 0;
static Uint16 millimetres(Uint32 counts)
{{
    Uint32 us = counts / 200;
    return (Uint16)(us * 343 / 2 / 1000);
}}
__interrupt void captured(void)
{{
    {set}
    ECap1Regs.ECCLR.bit.CEVT2 = 1;
    ECap1Regs.ECCLR.bit.INT = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP4;
}}
void main(void)
{{
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    EALLOW;
    PieVectTable.ECAP1_INT = &captured;
    EDIS;
    PieCtrlRegs.PIEIER4.bit.INTx1 = 1;
    IER |= M_INT4;
    EINT;
    for (;;) {{
        {use}
        DELAY_US(1000);
    }}
}}
"""
SET = "width = ECap1Regs.CAP2;"
NEAR = "distance_mm = millimetres(width); if (distance_mm < 200) near_ = 1;"


def told(folder: Path, use: str = NEAR, *, set_: str = SET, type_: str = "Uint16") -> list[tuple[str, str]]:
    """Statement and message of each `narrowed` that the source shows."""
    file = folder / "sonar.c"
    text = PROGRAM.format(use=use, set=set_, type=type_)
    file.write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([file], calls=1, board=load("bare"), seconds=0.01)).findings
    lines = text.splitlines()
    return [
        (lines[f.place.line - 1].strip(), f.message) for f in found
        if f.rule == "narrowed" and f.how == "static" and f.place
    ]  # fmt: skip


@pytest.mark.parametrize(("use", "set_", "test"), [
    (NEAR, SET, "distance_mm < 200 in line 29 is always true then"),
    ("if (width / 200UL >= 400) near_ = 0;", SET, "width / 200 >= 400 in line 29 is always false then"),
    ("if (70000UL > width) near_ = 1;", SET, "70000 > width in line 29 is always true then"),
    ("more = width; if (more > 65535) near_ = 0;", SET, "more > 65535 in line 29 is always false then"),
    (NEAR, "width = ECap1Regs.TSCTR;", "distance_mm < 200 in line 29 is always true then"),
    (NEAR, "width = 0; width = ECap1Regs.CAP2;", "distance_mm < 200 in line 29 is always true then"),
])  # fmt: skip
def test_a_test_that_16_bits_decide_is_told(tmp_path: Path, use: str, set_: str, test: str) -> None:
    register = "TSCTR" if "TSCTR" in set_ else "CAP2"
    message = f"width keeps 16 bits of ECap1Regs.{register}, up to 65535: {test}"
    assert told(tmp_path, use, set_=set_) == [(set_, message)]


@pytest.mark.parametrize(("use", "given"), [
    # 32 bits; a cast; a register of 16 bits; a difference of stamps that stays in 16 bits.
    (NEAR, {"type_": "Uint32"}), (NEAR, {"set_": "width = (Uint16)ECap1Regs.CAP2;"}),
    (NEAR, {"set_": "width = EPwm1Regs.TBCTR;"}),
    ("near_ = (Uint16)(width - last) > 60000u; last = width;", {}),
    # Short pulses: nothing that is compared is beyond them, or only used in 32 bits.
    ("if (millimetres(width) < 50) near_ = 1;", {}), ("distance_mm = millimetres(width);", {}),
    ("more = width * 1000UL / 10000; if (more > 500) near_ = 1;", {}), ("if (width > 60000u) near_ = 0;", {}),
    # What is compared can come from elsewhere too, or is always so without the object.
    (f"{NEAR} distance_mm = AdcaResultRegs.ADCRESULT0;", {}),
    ("more = width; more++; if (more > 65535) near_ = 0;", {}),
    ("for (n = 0; n < 10; n++) last = width; if (n < 200) near_ = 1;", {}),
    (f"{NEAR} near_ = millimetres(more); more = ECap1Regs.CAP1;", {}),
    (NEAR, {"set_": f"{SET} if (last) width = last;"}),
])  # fmt: skip
def test_16_bits_that_are_enough_are_not_told(tmp_path: Path, use: str, given: dict[str, str]) -> None:
    assert told(tmp_path, use, **given) == []
