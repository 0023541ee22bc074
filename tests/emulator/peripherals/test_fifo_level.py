"""The level of a receive FIFO, what its interrupt routine takes (`fifo-level`), and the flag that it leaves."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.board import load
from hil.drivers.check import DriverFiles, check_files

#: A module in loopback sends blocks of six characters; its routine takes COUNT at each interrupt of LEVEL.
PROGRAM = """#include "F28x_Project.h"
#define LEVEL %d
Uint16 Taken[16];
volatile Uint16 Left;
interrupt void rx(void)
{
    Uint16 k = 0;
    for (k = 0; k < 16 && (%s); k++)
        Taken[k] = %s;
    %s.bit.RXFFINTCLR = 1;
    Left = %s.bit.RXFFST;
    PieCtrlRegs.PIEACK.all = %s;
}
void main(void)
{
    Uint16 k;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.%s = &rx;
    EDIS;
    %s
    IER |= M_INT6 | M_INT9;
    EINT;
    for (;;) {
        for (k = 0; k < 6; k++)
            %s = k;
        DELAY_US(1000);
    }
}
"""
SPI = ("SpiaRegs.SPIRXBUF", "SpiaRegs.SPIFFRX", "PIEACK_GROUP6", "SPIA_RX_INT", """SpiaRegs.SPICCR.all = 0x001F;
    SpiaRegs.SPICTL.all = 0x0006;
    SpiaRegs.SPIBRR.bit.SPI_BIT_RATE = 49;
    SpiaRegs.SPIFFTX.all = 0xE040;
    SpiaRegs.SPIFFRX.all = 0x6060 | LEVEL;
    SpiaRegs.SPICCR.bit.SPISWRESET = 1;
    PieCtrlRegs.PIEIER6.bit.INTx1 = 1;""", "SpiaRegs.SPITXBUF")
SCI = ("SciaRegs.SCIRXBUF.all", "SciaRegs.SCIFFRX", "PIEACK_GROUP9", "SCIA_RX_INT", """SciaRegs.SCICCR.all = 0x0017;
    SciaRegs.SCILBAUD.all = 53;
    SciaRegs.SCIFFTX.all = 0xE040;
    SciaRegs.SCIFFRX.all = 0x6060 | LEVEL;
    SciaRegs.SCICTL1.all = 0x0023;
    PieCtrlRegs.PIEIER9.bit.INTx1 = 1;""", "SciaRegs.SCITXBUF.all")


@pytest.mark.parametrize("module", [SPI, SCI], ids=["SPI", "SCI"])
@pytest.mark.parametrize(("level", "count", "short"), [
    (6, "k < 6", False),
    # A block is taken in two halves; all that is there is taken.
    (3, "k < 3", False),
    (4, "{fifo}.bit.RXFFST != 0", False),
    # The level is that of two blocks, or of one and a half, and a block is taken.
    (12, "k < 6", True),
    (9, "k < 6", True),
    (6, "k < 5", True),
])  # fmt: skip
def test_a_routine_that_leaves_words_to_the_next_interrupt(
    tmp_path: Path, module: tuple[str, ...], level: int, count: str, short: bool
) -> None:
    buffer, fifo, group, vector, setting, output = module
    while_ = count.format(fifo=fifo)
    text = PROGRAM % (level, while_, buffer, fifo, fifo, group, vector, setting, output)
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    checked = check_files(DriverFiles([tmp_path / "drv.c"], calls=1, board=load("bare"), seconds=0.03))
    findings = [f for f in checked.findings if f.rule == "fifo-level"]
    assert [f.object for f in findings] == [fifo] * short
    assert all(f.place is not None and f"= {buffer}" in text.splitlines()[f.place.line - 1] for f in findings)


@pytest.mark.parametrize("module", [SPI, SCI], ids=["SPI", "SCI"])
@pytest.mark.parametrize("clears", [True, False])
def test_a_flag_that_the_routine_leaves_is_told_where_it_begins(
    tmp_path: Path, module: tuple[str, ...], clears: bool
) -> None:
    buffer, fifo, group, vector, setting, output = module
    text = PROGRAM % (6, "k < 6", buffer, fifo, fifo, group, vector, setting, output)
    if not clears:
        text = text.replace(f"    {fifo}.bit.RXFFINTCLR = 1;\n", "")
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    checked = check_files(DriverFiles([tmp_path / "drv.c"], calls=1, board=load("bare"), seconds=0.06))
    findings = [f for f in checked.findings if f.rule == "flag-not-cleared"]
    assert [f.object for f in findings] == ([] if clears else [f"{fifo}.RXFFINT"])
    assert all(f.place is not None and f.place.function == "rx" for f in findings)
