"""A flag that is cleared behind the start of what it announces, in a program without the kernel."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.drivers.check import DriverFiles, check_files

PROGRAM = """#include "F28x_Project.h"
volatile Uint16 Done, Count;
Uint16 Lost;
__interrupt void Ended(void)
{
    Done = SpibRegs.SPIRXBUF | 1;
    SpibRegs.SPIFFRX.bit.RXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP6;
}
__interrupt void Tick(void)
{
    Count++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}
void main(void)
{
    Uint16 patience;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0;
    IFR = 0;
    InitPieVectTable();
    EALLOW;
    PieVectTable.SPIB_RX_INT = &Ended;
    PieVectTable.TIMER0_INT = &Tick;
    CpuSysRegs.PCLKCR8.bit.SPI_B = 1;
    EDIS;
    SpibRegs.SPICCR.bit.SPICHAR = 15;
    SpibRegs.SPICCR.bit.SPILBK = 1;
    SpibRegs.SPICTL.bit.MASTER_SLAVE = 1;
    SpibRegs.SPICTL.bit.TALK = 1;
    SpibRegs.SPIBRR.bit.SPI_BIT_RATE = 49;
    SpibRegs.SPIFFTX.all = 0xE000;
    SpibRegs.SPIFFRX.all = 0x6061;
    SpibRegs.SPICCR.bit.SPISWRESET = 1;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 100);
    StartCpuTimer0();
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    PieCtrlRegs.PIEIER6.bit.INTx3 = 1;
    IER |= M_INT1 | M_INT6;
    EINT;
    for (;;) {
        TURN
    }
}
"""
WAIT = "for (patience = 0; patience < 100 && !Done; patience++) DELAY_US(1);"


@pytest.mark.parametrize(("turn", "lost"), [
    ("Done = 0; SpibRegs.SPITXBUF = 1; {wait} if (!Done) Lost++;", False),
    ("SpibRegs.SPITXBUF = 1; DELAY_US(50);\nDone = 0;\n{wait}", True),
    ("SpibRegs.SPITXBUF = 1;\nDone = 0;\n{wait}", False),  # in time
    ("SpibRegs.SPITXBUF = 1; {wait}\nDone = 0;\n{wait}", False),  # looked at
    ("SpibRegs.SPITXBUF = 1; DELAY_US(50);\nDone = 0;\nSpibRegs.SPITXBUF = 1; {wait}", False),  # thrown away
    ("SpibRegs.SPITXBUF = 1; DELAY_US(50);\nDone = 0;\nDELAY_US(50);", False),  # nobody waits
    # A late answer of the turn before is thrown away.
    ("Done = 0; SpibRegs.SPITXBUF = 1; if (!Done) Lost++; DELAY_US(50);\nDone = 0;\nif (!Done) Lost++;", False),
    ("DELAY_US(150);\nCount = 0;\nwhile (!Count) ;", False),  # the next tick comes
])  # fmt: skip
def test_an_event_that_is_cleared_before_anybody_looked(turn: str, lost: bool, tmp_path: Path) -> None:
    text = PROGRAM.replace("TURN", turn.format(wait=WAIT))
    file = tmp_path / "flag.c"
    file.write_text(text, encoding="utf-8")
    found = [f for f in check_files(DriverFiles([file], seconds=0.005)).findings if f.rule == "event-lost"]
    assert [text.splitlines()[f.place.line - 1] for f in found if f.place] == ["Done = 0;"] * lost


@pytest.mark.parametrize("begins", ["SpibRegs.SPITXBUF = 1; DELAY_US(50);\n", ""])
def test_a_member_behind_a_pointer_is_cleared_late(begins: str, tmp_path: Path) -> None:
    text = PROGRAM.replace("volatile Uint16 Done, Count;", "struct { volatile Uint16 got, done; } Link;\nUint16 Count;")
    text = text.replace("Done = Spib", "Link.done = Spib").replace("Uint16 patience;", "Uint16 patience, *p;")
    late = f"p = &Link.done; {begins}*p = 0;\n{'' if begins else 'SpibRegs.SPITXBUF = 1;'} {WAIT}"
    file = tmp_path / "flag.c"
    file.write_text(text.replace("TURN", late.replace("!Done", "!*p")), encoding="utf-8")
    found = [f for f in check_files(DriverFiles([file], seconds=0.005)).findings if f.rule == "event-lost"]
    assert [f.object for f in found] == ["flag.Link.done"] * bool(begins)
