"""A message interface of a CAN that `main` and an interrupt routine use, in programs without a kernel."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.drivers.check import DriverFiles, check_files

PROGRAM = """#include "F28x_Project.h"
#define CONFIGURE 0x00F00000UL
volatile Uint16 Sent = 0, Free = 1, Ticks = 0, Head = 0, Tail = 0;
static Uint16 Number = 0;
static void Busy1(void) { while (CanaRegs.CAN_IF1CMD.bit.Busy) ; }
static void Send(void)
{
    CanaRegs.CAN_IF1DATA.all = Number++;
    CanaRegs.CAN_IF1CMD.all = 0x00860000UL | 1;
    Busy1();
}
static void Answer(void) { if (Free) { Free = 0; Send(); } }
__interrupt void Ended(void)
{
    @routine
    Sent++;
    CanaRegs.CAN_GLB_INT_CLR.bit.INT0_FLG_CLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}
__interrupt void Tick(void)
{
    Ticks++;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}
void main(void)
{
    InitSysCtrl();
    InitPieCtrl();
    IER = 0;
    IFR = 0;
    InitPieVectTable();
    EALLOW;
    CpuSysRegs.PCLKCR10.bit.CAN_A = 1;
    PieVectTable.CANA0_INT = &Ended;
    PieVectTable.TIMER0_INT = &Tick;
    GPIO_SetupPinMux(70, GPIO_MUX_CPU1, 5);
    GPIO_SetupPinMux(71, GPIO_MUX_CPU1, 5);
    EALLOW;
    CanaRegs.CAN_CTL.all = 1;
    CanaRegs.CAN_CTL.all |= 1UL << 6 | 1UL << 7;
    CanaRegs.CAN_BTR.all = 19 | 2UL << 6 | 12UL << 8 | 5UL << 12;
    CanaRegs.CAN_TEST.bit.LBACK = 1;
    CanaRegs.CAN_IF1MSK.all = 0;
    CanaRegs.CAN_IF1ARB.all = 0xA0000000UL | 0x123UL << 18;
    CanaRegs.CAN_IF1MCTL.all = 0x0880 | 2;
    CanaRegs.CAN_IF1CMD.all = CONFIGURE | 1;
    Busy1();
    CanaRegs.CAN_GLB_INT_EN.bit.GLBINT0_EN = 1;
    CanaRegs.CAN_CTL.all = 1UL << 7 | 2;
    EDIS;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 500);
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    PieCtrlRegs.PIEIER9.bit.INTx5 = 1;
    IER |= M_INT1 | M_INT9;
    EINT;
    StartCpuTimer0();
    for (;;) {
        DELAY_US(300);
        @turn
    }
}
"""
#: What the routine does for each message that was sent.
CLEAR = "CanaRegs.CAN_IF1CMD.all = 0x00080000UL | 1;"
CLEAR_2 = CLEAR.replace("IF1", "IF2")
#: What `main` does each 300 us.
SEND = "CanaRegs.CAN_IF1DATA.all = Number++; CanaRegs.CAN_IF1CMD.all = 0x00860000UL | 1; Busy1();"


def told(routine: str, turn: str, folder: Path) -> list[str]:
    """The lines of `transaction-cut`, from the statement on."""
    file = folder / "sender.c"
    file.write_text(PROGRAM.replace("@routine", routine).replace("@turn", turn), encoding="utf-8")
    lines = file.read_text(encoding="utf-8").splitlines()
    found = check_files(DriverFiles([file], seconds=0.01)).findings
    assert not [f for f in found if f.rule in ("not-connected", "endless-poll")]
    return [lines[f.place.line - 1].strip() for f in found if f.rule == "transaction-cut" and f.place is not None]


@pytest.mark.parametrize(
    ("routine", "turn", "line"),
    [
        (CLEAR, f"\n{SEND}", SEND),
        (CLEAR, "\nCanaRegs.CAN_IF1DATA.all = Number++;\nDINT; CanaRegs.CAN_IF1CMD.all = 0x00860000UL | 1; EINT;",
         "CanaRegs.CAN_IF1DATA.all = Number++;"),
        (CLEAR, f"if (Ticks & 1)\n{SEND}", SEND),  # what another routine says keeps this one off by nothing
        (CLEAR, f"Busy1(); if (CanaRegs.CAN_IF1CMD.bit.Busy) continue;\n{SEND}", SEND),
        (f"if (Sent < 60000) {{ {CLEAR} }} else {{ {CLEAR_2} }}", f"\n{SEND}", SEND),
        # One of two calls waits for the routine; the index of a queue holds nobody off.
        (f"{CLEAR} Free = 1;", "Answer(); Send();", "CanaRegs.CAN_IF1DATA.all = Number++;"),
        (f"{CLEAR} Head = (Head + 1) % 8;", f"if (Ticks < 3 && Head == Tail) continue; Tail = (Tail + 1) % 8;\n{SEND}",
         SEND),
    ],
)
def test_an_interface_that_the_routine_can_change_is_told(routine: str, turn: str, line: str, tmp_path: Path) -> None:
    assert told(routine, turn, tmp_path) == [line]


@pytest.mark.parametrize(
    ("routine", "turn"),
    [
        (CLEAR_2, SEND),
        (CLEAR, f"DINT; {SEND} EINT;"),
        (CLEAR, f"IER &= ~M_INT9; {SEND} IER |= M_INT9;"),
        (CLEAR, f"PieCtrlRegs.PIEIER9.bit.INTx5 = 0; {SEND} PieCtrlRegs.PIEIER9.bit.INTx5 = 1;"),
        (CLEAR, f"EALLOW; CanaRegs.CAN_CTL.bit.IE0 = 0; {SEND} CanaRegs.CAN_CTL.bit.IE0 = 1; EDIS;"),
        (CLEAR, f"CanaRegs.CAN_GLB_INT_EN.bit.GLBINT0_EN = 0; {SEND} CanaRegs.CAN_GLB_INT_EN.bit.GLBINT0_EN = 1;"),
        # The routine comes only when a message has been sent, and says so.
        (f"{CLEAR} Free = 1;", f"if (Free) {{ Free = 0; {SEND} }}"),
        (f"{CLEAR} Free = 1;", f"while (!Free) ; Free = 0; {SEND}"),
        (CLEAR, f"static Uint16 before = 1; Uint16 now = Sent; if (now != before) {{ before = now; {SEND} }}"),
        (CLEAR, f"if (CanaRegs.CAN_TXRQ_21 & 1) continue; {SEND}"),
        (f"{CLEAR} Free = 1;", "Answer(); DINT; Send(); EINT;"),
    ],
)
def test_an_interface_that_is_kept_apart_is_not_told(routine: str, turn: str, tmp_path: Path) -> None:
    assert told(routine, turn, tmp_path) == []


#: A library that reaches the interfaces by numbers: a word of a byte peripheral is at twice its offset (TRM, CAN).
LIBRARY = """#ifndef WIRE_H
#define WIRE_H
#include "F28x_Project.h"
#define LONG(x) (*((volatile unsigned long *)(unsigned long)(x)))
#define WIRE_A 0x48000ul
void Wire_send(unsigned long base, unsigned int object, unsigned int data);
void Wire_clear(unsigned long base, unsigned int object, unsigned int interface);
unsigned long Wire_pending(unsigned long base);
#endif
"""
SOURCE = """#include "wire.h"
void Wire_send(unsigned long base, unsigned int object, unsigned int data)
{
    LONG(base + 0x110) = data;
    LONG(base + 0x100) = 0x00860000ul | object;
    while (LONG(base + 0x100) & 0x8000ul)
        ;
}

void Wire_clear(unsigned long base, unsigned int object, unsigned int interface)
{
    LONG(base + 0x100 + 0x20 * (interface - 1)) = 0x00080000ul | object;
}

unsigned long Wire_pending(unsigned long base) { return LONG(base + 0x88); }
"""
SENDS = "Wire_send(WIRE_A, 1, Number++);"


@pytest.mark.parametrize(
    ("routine", "turn", "lines"),
    [
        ("Wire_clear(WIRE_A, 1, 1);", f"\n{SENDS}", [SENDS]),
        ("Wire_clear(WIRE_A, 1, 1);", f"if (Ticks & 1)\n{SENDS}", [SENDS]),
        ("Wire_clear(WIRE_A, 1, 1);", f"DINT; {SENDS} EINT;", []),
        ("Wire_clear(WIRE_A, 1, 2);", SENDS, []),
        ("Wire_clear(WIRE_A, 1, 1); Free = 1;", f"if (Free) {{ Free = 0; {SENDS} }}", []),
        ("Wire_clear(WIRE_A, 1, 1);", f"if (Wire_pending(WIRE_A) & 1) continue; {SENDS}", []),
    ],
)
def test_an_interface_that_a_library_uses_by_numbers(
    routine: str, turn: str, lines: list[str], tmp_path: Path
) -> None:
    folder = tmp_path / "library"
    folder.mkdir()
    (folder / "wire.h").write_text(LIBRARY, encoding="utf-8")
    (folder / "wire.c").write_text(SOURCE, encoding="utf-8")
    file = tmp_path / "sender.c"
    text = PROGRAM.replace("@routine", routine).replace("@turn", turn).replace("F28x_Project.h", "wire.h")
    file.write_text(text, encoding="utf-8")
    found = check_files(DriverFiles([file], include=[folder], seconds=0.01)).findings
    cut = [f.place for f in found if f.rule == "transaction-cut" and f.place is not None]
    assert [text.splitlines()[place.line - 1].strip() for place in cut] == lines
