"""Rates that stand beside a setting and that the hardware does not have: wrong programs, and their right twins."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files

PROGRAM = """#include "F28x_Project.h"
#define TBCLK_HZ    {clock}
#define CARRIER_HZ  20000UL
#define SAMPLE_US   100
#define BLINK_HZ    5UL
{define}
void main(void)
{{
    InitSysCtrl();
    DINT;
    InitCpuTimers();
    EALLOW;
    CpuSysRegs.PCLKCR2.bit.EPWM1 = 1;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    EPwm1Regs.TBCTL.bit.CLKDIV = 0;
    EPwm1Regs.TBCTL.bit.HSPCLKDIV = 0;
    {set}
    EPwm1Regs.TBCTL.bit.CTRMODE = {mode};
    {then}
    for (;;) {{ }}
}}
"""
START = "CpuTimer0Regs.TCR.bit.TSS = 0;"


def told(
    folder: Path, set_: str, *, define: str = "", then: str = START, mode: str = "TB_COUNT_UP",
    clock: str = "200000000UL",
) -> list[tuple[str, str]]:  # fmt: skip
    """Statement and message of each `stated-rate`."""
    file = folder / "carrier.c"
    text = PROGRAM.format(set=set_, define=define, then=then, mode=mode, clock=clock)
    file.write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([file], calls=1, board=load("bare"), seconds=0.01)).findings
    lines = text.splitlines()
    return [
        (lines[f.place.line - 1].strip(), f.message) for f in found if f.rule == "stated-rate" and f.place is not None
    ]  # fmt: skip


@pytest.mark.parametrize(("set_", "given", "message"), [
    ("EPwm1Regs.TBPRD = 9999;   // 200 MHz / 10000 = 20 kHz", {},
     "the comment '200 MHz / 10000 = 20 kHz' states 20 kHz, and EPwm1 counts its period 10 kHz"),
    ("EPwm1Regs.TBPRD = CARRIER;", {"define": "#define CARRIER 4999  /* 20 kHz */", "mode": "TB_COUNT_UPDOWN"},
     "the comment '20 kHz' states 20 kHz, and EPwm1 counts its period 10 kHz"),
    ("EPwm1Regs.TBPRD = TBCLK_HZ / CARRIER_HZ - 1;", {},
     "CARRIER_HZ states 20 kHz, and EPwm1 counts its period 10 kHz"),
    ("EPwm1Regs.TBPRD = 200 * SAMPLE_US - 1;", {}, "SAMPLE_US states 10 kHz, and EPwm1 counts its period 5 kHz"),
    ("ConfigCpuTimer(&CpuTimer0, 200, 1000);  // 0.1 ms", {},
     "the comment '0.1 ms' states 10 kHz, and CpuTimer0 counts its period 1 kHz"),
    ("CpuTimer0Regs.PRD.all = 19999; CpuTimer0Regs.TCR.bit.TRB = 1;  // 1 ms", {},
     "the comment '1 ms' states 1 kHz, and CpuTimer0 counts its period 10 kHz"),
    ("SciaRegs.SCIHBAUD.all = 0; SciaRegs.SCILBAUD.all = 40;  // 115,200 bits/s of 100 MHz", {},
     "the comment '115,200 bits/s of 100 MHz' states 115200 baud, and SciaRegs sends and receives 152439"),
    ("DELAY_US(SETTLE);", {"define": "#define SETTLE 500  /* 5 ms */"},
     "the comment '5 ms' states another time than DELAY_US gets: 0.0005 s"),
])  # fmt: skip
def test_a_rate_that_the_hardware_does_not_have_is_told(
    tmp_path: Path, set_: str, given: dict[str, str], message: str
) -> None:
    assert told(tmp_path, set_, **given) == [(set_, message)]


@pytest.mark.parametrize(("set_", "given"), [
    ("EPwm1Regs.TBPRD = 4999;   // 100 MHz / 5000 = 20 kHz", {}),
    ("EPwm1Regs.TBPRD = TBCLK_HZ / CARRIER_HZ - 1;", {"clock": "100000000UL"}),
    ("EPwm1Regs.TBPRD = TBCLK_HZ / CARRIER_HZ / 2;", {"clock": "100000000UL", "mode": "TB_COUNT_UPDOWN"}),
    ("ConfigCpuTimer(&CpuTimer0, 200, 10 * SAMPLE_US);  // 1 ms", {}),
    # One trigger for three periods, two for one, a pin that toggles.
    ("EPwm1Regs.TBPRD = 4999; EPwm1Regs.ETPS.bit.SOCAPRD = 2;  // 10 kHz", {}),
    ("EPwm1Regs.TBPRD = 4999; EPwm1Regs.ETSEL.bit.SOCASEL = 3;  // 20 kHz", {"mode": "TB_COUNT_UPDOWN"}),
    ("EPwm1Regs.TBPRD = 4999; EPwm1Regs.AQCTLA.bit.ZRO = AQ_TOGGLE;  // 10 kHz", {}),
    # A factor of its own; the clock alone; a part of the period; another amount; none of the usual slips.
    ("CpuTimer0Regs.PRD.all = TBCLK_HZ / (2 * BLINK_HZ); CpuTimer0Regs.TCR.bit.TRB = 1;", {}),
    ("EPwm1Regs.TBPRD = 9999;   // of 100 MHz", {}),
    ("EPwm1Regs.TBPRD = 9999;   // 5 us at most for the pulse", {}),
    ("EPwm1Regs.TBPRD = 9999;   // 15 kHz", {}),
    ("CpuTimer0Regs.PRD.all = 499999; CpuTimer0Regs.TCR.bit.TRB = 1;  // 2,5 ms", {}),
    # A usual rate may be meant, and so may one of two; it was another one; the time of all turns, or of two waits.
    ("SciaRegs.SCIHBAUD.all = 0; SciaRegs.SCILBAUD.all = 107;  // 115200", {}),
    ("SciaRegs.SCIHBAUD.all = 0; SciaRegs.SCILBAUD.all = 40;  // 9600 baud, 115200 baud", {}),
    ("SciaRegs.SCIHBAUD.all = 0; SciaRegs.SCILBAUD.all = 40;  // was 9600 baud", {}),
    ("SciaRegs.SCIHBAUD.all = 0; SciaRegs.SCILBAUD.all = 53;  // 115200 baud", {}),
    ("{ int i; for (i = 0; i < 10; i++) DELAY_US(10);  // 100 us\n    }", {}),
    ("DELAY_US(500);  // 1 kHz", {}),
    # It stands; another statement sets it, too.
    ("CpuTimer0Regs.PRD.all = 19999; CpuTimer0Regs.TCR.bit.TRB = 1;  // 1 ms", {"then": ""}),
    ("EPwm1Regs.TBPRD = 9999;   // 20 kHz", {"then": "EPwm1Regs.TBPRD = 4999;"}),
])  # fmt: skip
def test_a_rate_that_the_hardware_has_is_not_told(tmp_path: Path, set_: str, given: dict[str, str]) -> None:
    assert told(tmp_path, set_, **given) == []
