"""Steps of an eQEP that lose their sign, and programs that keep it."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files

PROGRAM = """#include "F28x_Project.h"
#define PULSES 2000UL
volatile float speed = 0;
volatile Uint32 way = 0, turns = 0, Ticks = 0, lastTicks = 0;
Uint32 last = 0, kept = 0;
void main(void)
{{
    InitSysCtrl();
    DINT;
    EQep1Regs.QDECCTL.bit.QSRC = {source};
    EQep1Regs.QPOSMAX = 0xFFFFFFFF;
    EQep1Regs.QEPCTL.bit.QPEN = 1;
    for (;;) {{
        Uint32 position = EQep1Regs.QPOSCNT;
        {use}
        last = position;
        DELAY_US(1000);
    }}
}}
"""


def told(folder: Path, use: str, source: int = 0) -> list[str]:
    """The messages of `unsigned-wrap`."""
    file = folder / "wheel.c"
    file.write_text(PROGRAM.format(use=use, source=source), encoding="utf-8")
    found = check_files(DriverFiles([file], calls=1, board=load("bare"), seconds=0.01)).findings
    return [f.message for f in found if f.rule == "unsigned-wrap"]


@pytest.mark.parametrize(("use", "text", "then"), [
    ("Uint32 steps = position - last; speed = steps * (60.0f / PULSES);", "steps", "becomes a float"),
    ("speed = (float)(position - last);", "position - last", "becomes a float"),
    ("kept = EQep1Regs.QPOSLAT - last; speed = kept; last = position;", "kept", "becomes a float"),
    ("turns = (position - last) * 60 / PULSES;", "position - last", "is divided"),
    ("if (position != last) speed = position - last;", "position - last", "becomes a float"),
])  # fmt: skip
def test_a_step_without_a_sign_is_told(tmp_path: Path, use: str, text: str, then: str) -> None:
    message = f"{text} has no sign, and {then}: a step back of EQep1 is not -1, but 4294967295"
    assert told(tmp_path, use) == [message]


@pytest.mark.parametrize(("use", "source"), [
    # A sign; a sum without one; a position.
    ("int32 steps = (int32)(position - last); speed = steps * 0.3f;", 0),
    ("speed = (int32)(position - last) * 0.3f;", 0), ("speed = (int32)position - (int32)last;", 0),
    ("way += position - last;", 0), ("speed = position * 0.3f; turns = position / PULSES;", 0),
    # It counts up only; the program takes care of the direction; times are no positions.
    ("speed = position - last;", 2),
    ("Uint32 steps = position - last; if (steps < 0x80000000) speed = steps; else speed = -(float)(0 - steps);", 0),
    ("if (position >= last) speed = position - last; else speed = -(float)(last - position);", 0),
    ("if (EQep1Regs.QEPSTS.bit.QDF) speed = position - last; else speed = -(float)(last - position);", 0),
    ("Ticks = ~CpuTimer0Regs.TIM.all; speed = Ticks - lastTicks; lastTicks = Ticks;", 0),
])  # fmt: skip
def test_a_step_that_keeps_its_sign_is_not_told(tmp_path: Path, use: str, source: int) -> None:
    assert told(tmp_path, use, source) == []


BY_FUNCTIONS = """
volatile Uint32 Seen = 0;
Uint32 EQEP_getPosition(Uint32 base) {{ return Seen + base; }}
Uint16 EQEP_getDirection(Uint32 base) {{ return Seen == base; }}
void main(void)
{{"""


@pytest.mark.parametrize(("use", "found"), [
    ("speed = position - last;", True), ("speed = (int32)(position - last);", False),
    ("if (EQEP_getDirection(0x5100)) speed = position - last;", False),
])  # fmt: skip
def test_positions_by_functions_of_driverlib(tmp_path: Path, use: str, found: bool) -> None:
    """The functions are known by their names, and the eQEP by its address."""
    text = PROGRAM.replace("\nvoid main(void)\n{{", BY_FUNCTIONS)
    text = text.replace("EQep1Regs.QPOSCNT", "EQEP_getPosition(0x5100)")
    file = tmp_path / "wheel.c"
    file.write_text(text.format(use=use, source=0), encoding="utf-8")
    findings = check_files(DriverFiles([file], calls=1, board=load("bare"), seconds=0.01)).findings
    messages = [f.message for f in findings if f.rule == "unsigned-wrap"]
    assert [m.split(":")[0] for m in messages] == ["position - last has no sign, and becomes a float"] * found
