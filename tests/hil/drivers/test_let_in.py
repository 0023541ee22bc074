"""`race` of a routine that is let through before what it depends on is set, in programs without a kernel."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.drivers.check import DriverFiles, check_files

PROGRAM = """#include "F28x_Project.h"
static volatile Uint16 Next = 0, Count = 0;
static Uint16 Text[16];
#define ON SciaRegs.SCIFFTX.bit.TXFFIENA = 1;
__interrupt void More(void)
{
    while (Next < Count && SciaRegs.SCIFFTX.bit.TXFFST < 16)
        SciaRegs.SCITXBUF.all = Text[Next++];
    if (Next >= Count)
        SciaRegs.SCIFFTX.bit.TXFFIENA = 0;
    SciaRegs.SCIFFTX.bit.TXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}
static void Say(Uint16 n)
{
    @say
}
void main(void)
{
    Uint16 i;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0;
    IFR = 0;
    InitPieVectTable();
    EALLOW;
    PieVectTable.SCIA_TX_INT = &More;
    EDIS;
    GPIO_SetupPinMux(84, GPIO_MUX_CPU1, 5);
    SciaRegs.SCICCR.all = 7;
    SciaRegs.SCICTL1.all = 3;
    SciaRegs.SCIHBAUD.all = 0;
    SciaRegs.SCILBAUD.all = 53;
    SciaRegs.SCIFFTX.all = 0xC000;
    SciaRegs.SCIFFTX.bit.TXFIFORESET = 1;
    SciaRegs.SCICTL1.all = 0x23;
    PieCtrlRegs.PIEIER9.bit.INTx2 = 1;
    IER |= M_INT9;
    EINT;
    for (i = 0; i < 16; i++)
        Text[i] = 'a' + i;
    for (;;) {
        Say(5);
        DELAY_US(2000);
        @turn
    }
}
"""
SET = "Next = 0;\n    Count = n;"


def told(say: str, folder: Path, turn: str = "") -> list[str]:
    """The lines of `race`."""
    file = folder / "sender.c"
    file.write_text(PROGRAM.replace("@say", say).replace("@turn", turn), encoding="utf-8")
    found = check_files(DriverFiles([file], seconds=0.01)).findings
    lines = file.read_text(encoding="utf-8").splitlines()
    return [lines[f.place.line - 1].strip() for f in found if f.rule == "race" and f.place is not None]


@pytest.mark.parametrize("say", [f"ON\n    {SET}", "SciaRegs.SCIFFTX.all |= 0x20;\n    Count = n;\n    Next = 0;"])
def test_what_is_set_after_the_enable_comes_too_late(say: str, tmp_path: Path) -> None:
    assert told(say, tmp_path) == [say.splitlines()[0]]


@pytest.mark.parametrize(
    ("say", "turn"),
    [
        (f"{SET}\n    ON", ""),
        (f"DINT;\n    ON\n    {SET}\n    EINT;", ""),
        (f"ON\n    {SET}\n    ON", ""),  # let in again
        (f"ON\n    {SET}", "if (Next < Count) ON"),
    ],
)
def test_a_routine_that_finds_what_is_set_is_told_nothing(say: str, turn: str, tmp_path: Path) -> None:
    assert told(say, tmp_path, turn) == []
