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


#: A PC sends messages to SCI-B, 115200 baud, with pauses between them.
PC = """from hil.board import Board
from emulator.clock import CYCLES_PER_MS

class Own(Board):
    def solder(self):
        line = self.to_pc(tx_gpio=18, rx_gpio=19, baud=115200)
        for n, length in enumerate({lengths}):
            self.clock.schedule((5 + n * {pause_ms}) * CYCLES_PER_MS, lambda length=length: line.feed(bytes(length)))
"""
#: Its routine takes all that is there; MAIN is done each millisecond.
LISTENER = """#include "F28x_Project.h"
volatile Uint16 Got;
interrupt void rx(void)
{
    while (ScibRegs.SCIFFRX.bit.RXFFST != 0)
        Got += ScibRegs.SCIRXBUF.bit.SAR + 1;
    ScibRegs.SCIFFRX.bit.RXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}
void main(void)
{
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.SCIB_RX_INT = &rx;
    EDIS;
    GPIO_SetupPinMux(19, GPIO_MUX_CPU1, 2);
    GPIO_SetupPinOptions(19, GPIO_INPUT, GPIO_ASYNC);
    ScibRegs.SCICCR.all = 0x0007;
    ScibRegs.SCIHBAUD.all = 0;
    ScibRegs.SCILBAUD.all = 53;
    ScibRegs.SCIFFTX.all = 0xE040;
    ScibRegs.SCIFFRX.all = 0x2040 | INTERRUPT | LEVEL;
    ScibRegs.SCICTL1.all = 0x0021;
    PieCtrlRegs.PIEIER9.bit.INTx3 = 1;
    IER |= M_INT9;
    EINT;
    for (;;) {
        DELAY_US(1000);
        MAIN
    }
}
"""
POLLED = "while (ScibRegs.SCIFFRX.bit.RXFFST != 0) Got += ScibRegs.SCIRXBUF.bit.SAR;"


@pytest.mark.parametrize(("level", "lengths", "pause_ms", "main", "told"), [
    (16, (6, 9, 6, 7, 6), 20, "", True),
    (4, (6, 9, 6, 7, 6), 20, "", True),
    (1, (6, 9, 6, 7, 6), 20, "", False),
    # Each message is as long as the level, or twice as long.
    (6, (6, 12, 6, 6, 12), 20, "", False),
    # What is left is taken after a while.
    (16, (6, 9, 6, 7, 6), 20, POLLED, False),
    # Characters that come one by one, each at its own time, are no messages; nor is a stream that only pauses shortly.
    (4, (1, 1, 1, 1, 1, 1, 1, 1), 20, "", False),
    (16, (6, 9, 6, 7, 6), 4, "", False),
    # Two messages that were cut off.
    (6, (6, 3, 3, 6, 5, 1, 6), 20, "", False),
])  # fmt: skip
def test_the_end_of_a_message_that_waits_for_the_next_message(
    tmp_path: Path, level: int, lengths: tuple[int, ...], pause_ms: int, main: str, told: bool
) -> None:
    (tmp_path / "pc.py").write_text(PC.format(lengths=lengths, pause_ms=pause_ms), encoding="utf-8")
    text = LISTENER.replace("LEVEL", str(level)).replace("INTERRUPT", "0x0020").replace("MAIN", main)
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    board = load(str(tmp_path / "pc.py"))
    wanted = DriverFiles([tmp_path / "drv.c"], calls=1, board=board, board_named=True, seconds=0.2)
    findings = [f for f in check_files(wanted).findings if f.rule == "fifo-level"]
    assert [f.object for f in findings] == ["ScibRegs.SCIFFRX"] * told
    assert all(f.place is not None and "SCIFFRX.all" in text.splitlines()[f.place.line - 1] for f in findings)
