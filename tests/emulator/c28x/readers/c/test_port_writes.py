"""Ports that `main` reads and writes back while an interrupt routine sets other pins, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

PROGRAM = """#include "F28x_Project.h"
interrupt void Converted(void)
{{
    {routine}
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}}
static void Brake(int on)
{{
    {brake}
}}
void main(void)
{{
    {first}
    for (;;)
    {{
        {turn}
    }}
}}
"""
GIVEN = {"routine": "GpioDataRegs.GPASET.all = 0x100;", "first": "", "turn": "Brake(1);"}
BACK = "GpioDataRegs.GPADAT.all |= 0x200;"


def told(folder: Path, brake: str, **given: str) -> list[str]:
    """The lines at which `race` is told before the program runs."""
    file = folder / "a.c"
    text = PROGRAM.format(**{**GIVEN, "brake": brake, **given})
    file.write_text(text, encoding="utf-8")
    found = Build([str(file)]).compiled.findings
    return [text.splitlines()[f.place.line - 1].strip() for f in found if f.rule == "race"]


@pytest.mark.parametrize(
    ("brake", "given"),
    [
        (BACK, {}),
        ("GpioDataRegs.GPADAT.all = GpioDataRegs.GPADAT.all & ~0x200UL;", {}),
        (BACK, {"routine": "GpioDataRegs.GPATOGGLE.bit.GPIO8 = 1;"}),
        (BACK, {"routine": "GpioDataRegs.GPADAT.bit.GPIO8 = 0;"}),
    ],
)
def test_a_port_that_is_written_back_is_told(tmp_path: Path, brake: str, given: dict[str, str]) -> None:
    assert told(tmp_path, brake, **given) == [brake]


@pytest.mark.parametrize(
    ("brake", "given"),
    [
        ("GpioDataRegs.GPASET.all = 0x200;", {}),
        ("GpioDataRegs.GPADAT.bit.GPIO9 = 1;", {}),  # one instruction
        (BACK, {"routine": "GpioDataRegs.GPBSET.all = 0x100;"}),
        (BACK, {"routine": "if (GpioDataRegs.GPADAT.bit.GPIO8) EPwm1Regs.CMPA.bit.CMPA = 0;"}),
        (f"DINT; {BACK} EINT;", {}),
        (BACK, {"turn": "DINT; Brake(1); EINT;"}),
        (BACK, {"first": "Brake(0);", "turn": ";"}),  # before the interrupts
        ("GpioDataRegs.GPADAT.all = on ? 0x200 : 0;", {}),  # sets all pins
    ],
)
def test_pins_that_are_set_alone_or_under_a_mask_are_silent(tmp_path: Path, brake: str, given: dict[str, str]) -> None:
    assert told(tmp_path, brake, **given) == []
