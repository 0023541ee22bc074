"""Receivers that do, and that do not, understand the message after one that was cut off."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import pytest

from emulator.c28x.findings import Finding
from emulator.clock import CYCLES_PER_MS
from emulator.devices.serial_pacing import LinePacer
from hil.board import Board
from hil.drivers.check import DriverFiles, check_files

#: A dimmer that gets a level at SCI-A.  RECEIVE takes a character, IDLE runs each millisecond.
PROGRAM: Final = """#include "F28x_Project.h"
static volatile Uint16 Ticks = 0, Came = 0, Filled = 0, Wanted = 0, Bad = 0;
static Uint16 Frame[8];
static volatile Uint16 Level = 0;
static void Apply(Uint16 level)
{
    Level = level;
    EPwm1Regs.CMPA.bit.CMPA = level;
}
RECEIVE
interrupt void Received(void)
{
    while (SciaRegs.SCIFFRX.bit.RXFFST > 0) {
        Take(SciaRegs.SCIRXBUF.all & 0xFF);
        Came = Ticks;
    }
    SciaRegs.SCIFFRX.bit.RXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}
interrupt void Tick(void)
{
    Ticks++;
    IDLE
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}
void main(void)
{
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    GPIO_SetupPinMux(0, GPIO_MUX_CPU1, 1);
    GPIO_SetupPinMux(85, GPIO_MUX_CPU1, 5);
    GPIO_SetupPinOptions(85, GPIO_INPUT, GPIO_PULLUP | GPIO_ASYNC);
    EALLOW;
    PieVectTable.TIMER0_INT = &Tick;
    PieVectTable.SCIA_RX_INT = &Received;
    EDIS;
    SciaRegs.SCICCR.all = 0x0007;
    SciaRegs.SCILBAUD.all = 53;
    SciaRegs.SCIFFTX.all = 0xE040;
    SciaRegs.SCIFFRX.all = 0x6061;
    SciaRegs.SCICTL1.all = 0x0023;
    EPwm1Regs.TBPRD = 20000;
    EPwm1Regs.AQCTLA.bit.ZRO = AQ_SET;
    EPwm1Regs.AQCTLA.bit.CAU = AQ_CLEAR;
    EPwm1Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    PieCtrlRegs.PIEIER9.bit.INTx1 = 1;
    IER |= M_INT1 | M_INT9;
    EINT;
    StartCpuTimer0();
    for (;;)
        ;
}
"""
#: Four characters: A5, the level, and their sum.
COUNTED: Final = """static void Take(Uint16 c)
{
    BEFORE
    if (Filled == 0 && c != 0xA5)
        return;
    Frame[Filled++] = c;
    if (Filled < 4)
        return;
    Filled = 0;
    if (Frame[3] != ((Frame[0] + Frame[1] + Frame[2]) & 0xFF)) {
        Bad++;
        return;
    }
    Apply(Frame[1] << 8 | Frame[2]);
}
"""
#: Digits, and a CR.
LINE: Final = """static void Take(Uint16 c)
{
    if (c != 13) {
        if (Filled < 8)
            Frame[Filled++] = c;
        LONG
        return;
    }
    if (Filled == 3)
        Apply(Frame[0] * 100 + Frame[1] * 10 + Frame[2] - 48 * 111);
    else
        Bad++;
    END
}
"""
LAPSED: Final = "if (Filled != 0 && (Uint16)(Ticks - Came) > 5) Filled = 0;"


class Dimmer(Board):
    """Whoever orders the level, each 50 ms."""

    text = False

    def solder(self) -> None:
        """Send the orders."""
        pacer = LinePacer(self.clock, self.serial_pins[85], 115200)
        for n in range(1, 8):
            level = 100 * n + 27
            frame = bytes([0xA5, level >> 8, level & 0xFF])
            frame = b"%03d\r" % level if self.text else frame + bytes([sum(frame) & 0xFF])
            self.clock.after(50 * n * CYCLES_PER_MS, lambda frame=frame: pacer.send(frame))


class Console(Dimmer):
    """The same as lines of text."""

    text = True


class Abandoned(Console):
    """The same, by somebody who leaves one line unfinished."""

    def solder(self) -> None:
        """Send the orders, and part of one between two of them."""
        super().solder()
        pacer = LinePacer(self.clock, self.serial_pins[85], 115200)
        self.clock.after(365 * CYCLES_PER_MS, lambda: pacer.send(b"9"))
        self.clock.after(385 * CYCLES_PER_MS, lambda: pacer.send(b"627\r"))


def told(folder: Path, text: str, board: type[Board] = Dimmer, *, silence: bool = True) -> list[Finding]:
    (folder / "drv.c").write_text(text, encoding="utf-8")
    wanted = DriverFiles([folder / "drv.c"], calls=1, board=board, seconds=0.4, silence=silence, board_named=True)
    return [finding for finding in check_files(wanted).findings if finding.rule == "cut-message"]


def counted(before: str, idle: str) -> str:
    return PROGRAM.replace("RECEIVE", COUNTED).replace("BEFORE", before).replace("IDLE", idle)


def test_a_receiver_that_only_counts_is_told_where_it_takes_the_new_message_for_the_rest(tmp_path: Path) -> None:
    text = counted("", "")
    (finding,) = told(tmp_path, text)
    assert finding.place is not None
    assert finding.place.function == "Take"
    assert text.splitlines()[finding.place.line - 1].strip() == "Filled = 0;"
    assert finding.object == "SciaRegs.SCIRXBUF"
    assert "2 of 4 characters, and 600 ms of silence, the next whole one is not understood" in finding.message
    assert finding.details[0].startswith("tried after the usual time, with the message a5 02 d7 7e")
    assert not told(tmp_path, text, silence=False)


@pytest.mark.parametrize(("before", "idle"), [
    (LAPSED, ""),
    ("", LAPSED),
    ("if (c == 0xA5) Filled = 0;", ""),
    ("", "if (Filled == 0) Wanted = 0; else if (++Wanted > 20) { Filled = 0; Bad++; }"),
])  # fmt: skip
def test_one_that_gives_up_is_not(tmp_path: Path, before: str, idle: str) -> None:
    assert not told(tmp_path, counted(before, idle))


def test_a_line_may_lose_the_line_after_a_cut_one_but_no_more(tmp_path: Path) -> None:
    text = PROGRAM.replace("RECEIVE", LINE).replace("IDLE", "").replace("LONG", "")
    assert not told(tmp_path, text.replace("END", "Filled = 0;"), Console)
    stuck = text.replace("END", "if (Filled == 3) Filled = 0;")
    (finding,) = told(tmp_path, stuck, Console)
    assert "the next 3 whole ones are not understood" in finding.message


def test_behind_a_line_that_the_run_does_not_finish_the_next_one_has_to_be_understood(tmp_path: Path) -> None:
    text = PROGRAM.replace("RECEIVE", LINE).replace("LONG", "").replace("END", "Filled = 0;")
    (finding,) = told(tmp_path, text.replace("IDLE", ""), Abandoned)
    assert finding.message.startswith("after the line '9' that the run itself does not finish, and 600 ms of silence")
    assert finding.place is not None
    assert text.splitlines()[finding.place.line - 1].strip() == "if (Filled < 8)"
    assert not told(tmp_path, text.replace("IDLE", LAPSED), Abandoned)


def test_somebody_who_types_slowly_leaves_no_line_unfinished(tmp_path: Path) -> None:
    class Typist(Console):
        """Types two more orders, with 5 ms between the digits."""

        def solder(self) -> None:
            """Send the orders."""
            super().solder()
            pacer = LinePacer(self.clock, self.serial_pins[85], 115200)
            for n, key in enumerate(b"527\r627\r"):
                self.clock.after((358 + 5 * n) * CYCLES_PER_MS, lambda key=key: pacer.send(bytes([key])))

    text = PROGRAM.replace("RECEIVE", LINE).replace("LONG", "").replace("END", "Filled = 0;").replace("IDLE", "")
    assert not told(tmp_path, text, Typist)


def test_what_is_taken_only_once_shows_nothing(tmp_path: Path) -> None:
    once = counted("if (Level != 0) return;", "")
    assert not told(tmp_path, once)
