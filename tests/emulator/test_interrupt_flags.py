"""Interrupts whose flag no statement clears, of events that do not come in the run, and the same programs with it."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.c28x.findings import Finding
from hil.board import load
from hil.drivers.check import DriverFiles, check_files
from tests.emulator.drivers import START_UP

#: Each module interrupts at what nobody sends.
PROGRAM = """#include "F28x_Project.h"
volatile Uint32 Width;
volatile Uint16 Ready, Turns, Seen, Order;
static void Done(void) { ECap1Regs.ECCLR.bit.INT = 1; }
interrupt void Captured(void)
{
    Width = ECap1Regs.CAP2 - ECap1Regs.CAP1;
    Done();
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP4;
}
interrupt void Index(void)
{
    Turns++;
    EQep1Regs.QCLR.bit.IEL = 1;
    EQep1Regs.QCLR.bit.INT = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP5;
}
interrupt void Received(void)
{
    while (SciaRegs.SCIFFRX.bit.RXFFST)
        Seen = SciaRegs.SCIRXBUF.all;
    SciaRegs.SCIFFRX.bit.RXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}
interrupt void Words(void)
{
    while (SpiaRegs.SPIFFRX.bit.RXFFST)
        Seen = SpiaRegs.SPIRXBUF;
    SpiaRegs.SPIFFRX.bit.RXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP6;
}
interrupt void Converted(void)
{
    Ready = 1;
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}
interrupt void Edge(void)
{
    Turns = 0;
    GpioDataRegs.GPATOGGLE.bit.GPIO31 = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP12;
}
void main(void)
{
""" + START_UP + """    EALLOW;
    PieVectTable.ECAP1_INT = &Captured;
    PieVectTable.EQEP1_INT = &Index;
    PieVectTable.SCIA_RX_INT = &Received;
    PieVectTable.SPIA_RX_INT = &Words;
    PieVectTable.ADCA1_INT = &Converted;
    PieVectTable.XINT3_INT = &Edge;
    InputXbarRegs.INPUT7SELECT = 24;
    InputXbarRegs.INPUT5SELECT = 25;
    InputXbarRegs.INPUT6SELECT = 26;
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1;
    CpuSysRegs.PCLKCR8.bit.SPI_A = 1;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 14;
    AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 4;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    EDIS;
    ECap1Regs.ECCLR.all = 0xFFFF;
    ECap1Regs.ECCTL2.bit.STOP_WRAP = 1;
    ECap1Regs.ECCTL1.bit.CAPLDEN = 1;
    ECap1Regs.ECCTL2.bit.TSCTRSTOP = 1;
    ECap1Regs.ECEINT.bit.CEVT2 = 1;
    EQep1Regs.QPOSMAX = 0xFFFFFFFF;
    EQep1Regs.QEPCTL.bit.IEL = 1;
    EQep1Regs.QEPCTL.bit.QPEN = 1;
    EQep1Regs.QEINT.bit.IEL = 1;
    SciaRegs.SCICCR.all = 0x0007;
    SciaRegs.SCICTL1.all = 0x0003;
    SciaRegs.SCILBAUD.all = 53;
    SciaRegs.SCIFFTX.all = 0xE040;
    SciaRegs.SCIFFRX.all = 0x2061;
    SciaRegs.SCICTL1.all = 0x0023;
    SpiaRegs.SPICCR.all = 0x000F;
    SpiaRegs.SPICTL.all = 0x0002;
    SpiaRegs.SPIFFTX.all = 0xE040;
    SpiaRegs.SPIFFRX.all = 0x2061;
    SpiaRegs.SPICCR.all = 0x008F;
    XintRegs.XINT3CR.bit.ENABLE = 1;
    PieCtrlRegs.PIEIER1.bit.INTx1 = 1;
    PieCtrlRegs.PIEIER4.bit.INTx1 = 1;
    PieCtrlRegs.PIEIER5.bit.INTx1 = 1;
    PieCtrlRegs.PIEIER6.bit.INTx1 = 1;
    PieCtrlRegs.PIEIER9.bit.INTx1 = 1;
    PieCtrlRegs.PIEIER12.bit.INTx1 = 1;
    IER |= M_INT1 | M_INT4 | M_INT5 | M_INT6 | M_INT9 | M_INT12;
    EINT;
    for (;;) {
        if (Ready) { Ready = 0; Seen = AdcaResultRegs.ADCRESULT0; }
    }
}
"""


def told(tmp_path: Path, text: str) -> list[Finding]:
    """What the check of a program says of flags."""
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    wanted = DriverFiles([tmp_path / "drv.c"], calls=1, board=load("bare"), seconds=0.01)
    return [finding for finding in check_files(wanted).findings if finding.rule == "flag-not-cleared"]


@pytest.mark.parametrize(("was", "now", "routine", "flag"), [
    ("ECap1Regs.ECCLR.bit.INT = 1;", "ECap1Regs.ECCLR.bit.CEVT2 = 1;", "Captured", "ECap1Regs.ECFLG.INT"),
    ("ECap1Regs.ECCLR.bit.INT = 1;", "ECap1Regs.ECCLR.all = 4;", "Captured", "ECap1Regs.ECFLG.INT"),
    ("ECap1Regs.ECCLR.bit.INT = 1;", "ECap2Regs.ECCLR.bit.INT = 1;", "Captured", "ECap1Regs.ECFLG.INT"),
    ("    EQep1Regs.QCLR.bit.INT = 1;\n", "", "Index", "EQep1Regs.QFLG.INT"),
    ("    SciaRegs.SCIFFRX.bit.RXFFINTCLR = 1;\n", "", "Received", "SciaRegs.SCIFFRX.RXFFINT"),
    ("    SpiaRegs.SPIFFRX.bit.RXFFINTCLR = 1;\n", "", "Words", "SpiaRegs.SPIFFRX.RXFFINT"),
    # It does nothing but set an object, which main takes back.
    ("    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;\n", "", "Converted", "AdcaRegs.ADCINTFLG.ADCINT1"),
    ("ADCINTFLGCLR.bit.ADCINT1", "ADCINTFLGCLR.bit.ADCINT2", "Converted", "AdcaRegs.ADCINTFLG.ADCINT1"),
    ("    PieCtrlRegs.PIEACK.all = PIEACK_GROUP12;\n", "", "Edge", "PieCtrlRegs.PIEACK.ACK12"),
])  # fmt: skip
def test_a_flag_that_no_statement_clears_is_told_at_its_routine(
    tmp_path: Path, was: str, now: str, routine: str, flag: str
) -> None:
    assert PROGRAM.count(was) == 1
    (finding,) = told(tmp_path, PROGRAM.replace(was, now))
    assert finding.object == flag
    assert finding.place is not None
    assert finding.place.function == routine
    assert "comes once only" in finding.message


@pytest.mark.parametrize(("was", "now"), [
    ("", ""),
    # By a mask, by the flags that are set, through a pointer, in main's loop, and behind an order.
    ("ECap1Regs.ECCLR.bit.INT = 1;", "ECap1Regs.ECCLR.all = 0xFF;"),
    ("ECap1Regs.ECCLR.bit.INT = 1;", "ECap1Regs.ECCLR.all = ECap1Regs.ECFLG.all;"),
    ("ECap1Regs.ECCLR.bit.INT = 1;", "volatile struct ECAP_REGS *module = &ECap1Regs; module->ECCLR.bit.INT = 1;"),
    ("ECap1Regs.ECCLR.bit.INT = 1; }", "} // all in main\n#define TAKEN ECap1Regs.ECCLR.bit.INT = 1;"),
    ("ECap1Regs.ECCLR.bit.INT = 1;", "if (Order == 9) ECap1Regs.ECCLR.bit.INT = 1;"),
    ("ECap1Regs.ECCLR.bit.INT = 1;", "*(volatile Uint16 *)(0x5000 + 0x18) = 1;"),
    # The interrupt is wanted once: it disables itself, or is disabled elsewhere.
    ("ECap1Regs.ECCLR.bit.INT = 1;", "ECap1Regs.ECEINT.all = 0;"),
    ("ECap1Regs.ECCLR.bit.INT = 1;", "PieCtrlRegs.PIEIER4.bit.INTx1 = 0;"),
    ("ECap1Regs.ECCLR.bit.INT = 1;", "IER &= ~M_INT4;"),
    # It stops the program, or stores what nothing takes back.
    ("ECap1Regs.ECCLR.bit.INT = 1;", "for (;;) { Width = 0; }"),
    ("    Turns++;\n    EQep1Regs.QCLR.bit.IEL = 1;\n    EQep1Regs.QCLR.bit.INT = 1;\n", "    Order = 1;\n"),
    # The hardware needs none: pulses go on, the FIFO is off, the line is off.
    ("    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;\n", "//CONT\n"),
    ("    SciaRegs.SCIFFRX.bit.RXFFINTCLR = 1;\n", "    SciaRegs.SCIFFRX.bit.RXFIFORESET = 0;\n"),
    ("    EQep1Regs.QCLR.bit.INT = 1;\n", "//OFF\n"),
])  # fmt: skip
def test_a_flag_that_can_be_cleared_is_not_told(tmp_path: Path, was: str, now: str) -> None:
    text = PROGRAM
    if was:
        assert text.count(was) == 1
        text = text.replace(was, now)
    if "TAKEN" in now:
        text = text.replace("for (;;) {\n        if", "for (;;) {\n        if (Width) { TAKEN Width = 0; }\n        if")
    if "CONT" in now:
        text = text.replace("INT1E = 1;", "INT1E = 1; AdcaRegs.ADCINTSEL1N2.bit.INT1CONT = 1;")
    if "OFF" in now:
        text = text.replace("    PieCtrlRegs.PIEIER5.bit.INTx1 = 1;\n", "")
    assert not told(tmp_path, text)


#: Functions as those of TI's driverlib, which reach the registers by address.
LIBRARY = """#include <stdint.h>
#define HWREGH(x) (*((volatile uint16_t *)(x)))
#define ECAP1_BASE 0x00005000U
#define PIECTRL_BASE 0x00000CE0U
static inline void ECAP_clearGlobalInterrupt(uint32_t base) { HWREGH(base + 0x18U) |= 0x1U; }
static inline void ECAP_clearInterrupt(uint32_t base, uint16_t flags) { HWREGH(base + 0x18U) |= flags; }
static inline void Interrupt_clearACKGroup(uint16_t group) { HWREGH(PIECTRL_BASE + 1U) = group; }
"""


@pytest.mark.parametrize(("call", "flags"), [
    ("ECAP_clearGlobalInterrupt(ECAP1_BASE);", []),
    ("ECAP_clearInterrupt(ECAP1_BASE, 1);", []),
    ("ECAP_clearInterrupt(ECAP1_BASE, 4);", ["ECap1Regs.ECFLG.INT"]),
    ("ECAP_clearGlobalInterrupt(ECAP1_BASE + 0x20U);", ["ECap1Regs.ECFLG.INT"]),
])  # fmt: skip
def test_driverlib_clears_a_flag(tmp_path: Path, call: str, flags: list[str]) -> None:
    (tmp_path / "ecap.h").write_text(LIBRARY, encoding="utf-8")
    text = PROGRAM.replace("ECap1Regs.ECCLR.bit.INT = 1;", call).replace("PieCtrlRegs.PIEACK.all = PIEACK_GROUP4", (
        "Interrupt_clearACKGroup(0x8U)"
    ))  # fmt: skip
    text = text.replace('"F28x_Project.h"', '"F28x_Project.h"\n#include "ecap.h"')
    assert [f.object for f in told(tmp_path, text)] == flags


#: A second routine of group 9, which acknowledges it.
FELLOW = """interrupt void Sent(void)
{
    Order++;
    SciaRegs.SCIFFTX.bit.TXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}
void main(void)
"""
RECEIVED = "    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;\n}\ninterrupt void Words"


def with_fellow(acknowledge: str, more: str = "") -> str:
    """The program with two routines of group 9, of which the first one acknowledges so."""
    text = PROGRAM.replace(RECEIVED, f"    {acknowledge}\n}}\ninterrupt void Words")
    text = text.replace("void main(void)\n", FELLOW).replace("    PieCtrlRegs.PIEIER9.bit.INTx1 = 1;\n", (
        "    PieCtrlRegs.PIEIER9.all = 3;\n    EALLOW;\n    PieVectTable.SCIA_TX_INT = &Sent;\n    EDIS;\n"
    ))  # fmt: skip
    return text.replace("for (;;) {\n        if", f"for (;;) {{\n        {more}\n        if")


@pytest.mark.parametrize(("acknowledge", "group"), [
    ("PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;", 1),
    ("PieCtrlRegs.PIEACK.all = M_INT8;", 8),
    ("PieCtrlRegs.PIEACK.all = 9;", 1),
    ("PieCtrlRegs.PIEACK.all = Order ? PIEACK_GROUP8 : PIEACK_GROUP10;", 8),
])  # fmt: skip
def test_another_group_is_acknowledged(tmp_path: Path, acknowledge: str, group: int) -> None:
    """The group's other routine, which acknowledges the right one, cannot run meanwhile."""
    text = with_fellow(acknowledge)
    (finding,) = told(tmp_path, text)
    assert finding.object == "PieCtrlRegs.PIEACK.ACK9"
    assert f"acknowledges group {group}" in finding.message
    assert finding.place is not None
    assert acknowledge in text.split("\n")[finding.place.line - 1]


@pytest.mark.parametrize(("acknowledge", "more"), [
    ("PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;", ""),
    ("PieCtrlRegs.PIEACK.all = PIEACK_GROUP1 | PIEACK_GROUP9;", ""),
    ("PieCtrlRegs.PIEACK.all = 0xFFFF;", ""),
    ("PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;", ""),
    # What is read and written again has the bit of group 9 too.
    ("PieCtrlRegs.PIEACK.all |= PIEACK_GROUP1;", ""),
    ("PieCtrlRegs.PIEACK.bit.ACK1 = 1;", ""),
    # A number that the source does not tell.
    ("PieCtrlRegs.PIEACK.all = Order;", ""),
    # The loop acknowledges when it has taken what came, or an interrupt of another group does.
    ("PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;", "if (Seen) { Seen = 0; PieCtrlRegs.PIEACK.all = PIEACK_GROUP9; }"),
    ("PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;", "if (Seen) { Seen = 0; PieCtrlRegs.PIEACK.bit.ACK9 = 1; }"),
])  # fmt: skip
def test_the_own_group_is_acknowledged(tmp_path: Path, acknowledge: str, more: str) -> None:
    assert not [f for f in told(tmp_path, with_fellow(acknowledge, more)) if "acknowledges" in f.message]


def test_another_group_is_acknowledged_by_driverlib(tmp_path: Path) -> None:
    (tmp_path / "ecap.h").write_text(LIBRARY, encoding="utf-8")
    text = PROGRAM.replace("PieCtrlRegs.PIEACK.all = PIEACK_GROUP4", "Interrupt_clearACKGroup(0x10U)")
    text = text.replace('"F28x_Project.h"', '"F28x_Project.h"\n#include "ecap.h"')
    (finding,) = told(tmp_path, text)
    assert finding.object == "PieCtrlRegs.PIEACK.ACK4"
    assert "Captured is the routine of interrupt 4.1 and acknowledges group 5" in finding.message
