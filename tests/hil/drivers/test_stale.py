"""Outputs that follow a value whose source is silent: a program that looks at the age, and one that does not."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from emulator.c28x.findings import Finding
from hil.board import load
from hil.cli import invoke
from hil.drivers.check import DriverFiles, check_files

#: A duty comes over the line every 10 ms, from the program itself by the SCI's loopback, for 0.1 s.
RIGHT = """#include "F28x_Project.h"
volatile Uint16 Now_Ms, Last_Ms, Duty;
interrupt void Tick(void) { Now_Ms++; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; }
interrupt void Received(void)
{
    while (SciaRegs.SCIFFRX.bit.RXFFST > 0) {
        Duty = SciaRegs.SCIRXBUF.bit.SAR;
        Last_Ms = Now_Ms;
    }
    SciaRegs.SCIFFRX.bit.RXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}
void Drive(void)
{
    Uint16 duty = Duty;
    if ((Uint16)(Now_Ms - Last_Ms) > 30)
        duty = 0;
    EPwm1Regs.CMPA.bit.CMPA = duty * 100;
}
void main(void)
{
    Uint16 next = 10, value = 20;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.TIMER0_INT = &Tick;
    PieVectTable.SCIA_RX_INT = &Received;
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1;
    CpuSysRegs.PCLKCR2.bit.EPWM1 = 1;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    SciaRegs.SCICCR.all = 0x0017;
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
    for (;;) {
        if (Now_Ms < 100 && Now_Ms >= next) {
            SciaRegs.SCITXBUF.all = value;
            value = value < 60 ? value + 5 : 20;
            next += 10;
        }
        Drive();
        DELAY_US(500);
    }
}
"""
AGE = """    if ((Uint16)(Now_Ms - Last_Ms) > 30)
        duty = 0;
"""


def stale(folder: Path, text: str, *, silence: bool = True) -> list[Finding]:
    (folder / "drv.c").write_text(text, encoding="utf-8")
    wanted = DriverFiles([folder / "drv.c"], calls=1, board=load("bare"), seconds=0.2, silence=silence)
    return [finding for finding in check_files(wanted).findings if finding.rule == "stale-value"]


def test_a_program_that_looks_at_the_age_is_told_nothing(tmp_path: Path) -> None:
    assert not stale(tmp_path, RIGHT)


def test_one_that_does_not_is_told_where_it_drives_on(tmp_path: Path) -> None:
    assert RIGHT.count(AGE) == 1
    text = RIGHT.replace(AGE, "")
    (finding,) = stale(tmp_path, text)
    assert finding.place is not None
    assert "EPwm1Regs.CMPA" in text.splitlines()[finding.place.line - 1]
    assert finding.object == "SciaRegs.SCIRXBUF"
    # Orders end at 100 ms; before they come every 10 ms.
    assert "at least every 1" in finding.message


@pytest.mark.parametrize("text", [
    # The loss is seen too late to be of use, but it is seen: the age decides.
    RIGHT.replace("> 30)", "> 60)"),
    # What is written is a constant.
    RIGHT.replace(AGE, "").replace("duty * 100", "500"),
])  # fmt: skip
def test_what_does_not_follow_the_old_value_is_right(tmp_path: Path, text: str) -> None:
    assert not stale(tmp_path, text)


def test_a_function_that_only_hands_the_value_on_is_not_the_place(tmp_path: Path) -> None:
    text = RIGHT.replace(AGE, "").replace("    EPwm1Regs.CMPA.bit.CMPA = duty * 100;", "    Put(duty * 100);")
    put = "static void Put(Uint16 counts)\n{\n    EPwm1Regs.CMPA.bit.CMPA = counts;\n}\n"
    text = text.replace("void Drive(void)", put + "void Drive(void)")
    (finding,) = stale(tmp_path, text)
    assert finding.place is not None
    assert text.splitlines()[finding.place.line - 1].strip() == "Put(duty * 100);"
    assert any("Put" in detail for detail in finding.details)


def test_a_lamp_that_follows_what_came_through_a_pointer_is_told(tmp_path: Path) -> None:
    text = RIGHT.replace("        Duty = SciaRegs.SCIRXBUF.bit.SAR;", "        Take((Uint16 *)&Duty);")
    take = "static void Take(Uint16 *to)\n{\n    *to = SciaRegs.SCIRXBUF.bit.SAR;\n}\n"
    text = text.replace("interrupt void Received", take + "interrupt void Received")
    text = text.replace("EPwm1Regs.CMPA.bit.CMPA = duty * 100;", "GPIO_WritePin(31, duty > 5);")
    assert not stale(tmp_path, text)
    (finding,) = stale(tmp_path, text.replace(AGE, ""))
    assert finding.place is not None
    assert "GPIO_WritePin(31" in text.replace(AGE, "").splitlines()[finding.place.line - 1]
    assert finding.object == "SciaRegs.SCIRXBUF"


#: A task orders a duty every 10 ms, for 0.1 s, and another one drives with it.
ORDERED = """#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Task.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Mailbox.h>
#include "F28x_Project.h"
Mailbox_Handle Orders;
void Order(UArg a0, UArg a1)
{
    Uint16 duty, i;
    for (i = 0; i < 10; i++) {
        duty = 20 + i;
        Mailbox_post(Orders, &duty, BIOS_WAIT_FOREVER);
        Task_sleep(10);
    }
    for (;;)
        Task_sleep(1000);
}
void Drive(UArg a0, UArg a1)
{
    Uint16 duty = 0;
    Uint32 came = 0;
    for (;;) {
        if (Mailbox_pend(Orders, &duty, 5))
            came = Clock_getTicks();
        if (Clock_getTicks() - came > 30)
            EPwm1Regs.CMPA.bit.CMPA = 0;
        else
            EPwm1Regs.CMPA.bit.CMPA = duty * 100;
    }
}
int main(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR2.bit.EPWM1 = 1;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    EPwm1Regs.TBPRD = 20000;
    EPwm1Regs.AQCTLA.bit.ZRO = AQ_SET;
    EPwm1Regs.AQCTLA.bit.CAU = AQ_CLEAR;
    EPwm1Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    Orders = Mailbox_create(sizeof(Uint16), 2, NULL, NULL);
    Task_create(Order, NULL, NULL);
    Task_create(Drive, NULL, NULL);
    BIOS_start();
    return 0;
}
"""


def through_a_pointer(limit: str) -> str:
    """Drive gets a pointer to a copy of the order, passes it on, and limits what it reads there."""
    head = "void Drive(void)\n{\n    Uint16 duty = Duty;\n"
    text = RIGHT.replace(head, """struct ORDER { Uint16 number; Uint16 duty; };
static struct ORDER Order;
static void Move(const struct ORDER *order)
{
    Uint16 duty = order->duty;
""")
    text = text.replace("    EPwm1Regs.CMPA.bit.CMPA", f"    {limit}\n    EPwm1Regs.CMPA.bit.CMPA")
    drive = """static void Drive(const struct ORDER *order)
{
    Move(order);
}
void main(void)"""
    text = text.replace("void main(void)", drive)
    return text.replace("        Drive();", "        Order.duty = Duty;\n        Drive(&Order);")


@pytest.mark.parametrize(("limit", "found"), [
    ("if (duty > 90) duty = 90;", 1),
    ("if (90 < duty) duty = 90; if (duty <= 20) duty = 20;", 1),
    ("if (Now_Ms > 120) duty = 90;", 0),  # no limit of its own: another source
])  # fmt: skip
def test_a_value_that_is_read_through_a_pointer_and_limited_grows_old(tmp_path: Path, limit: str, found: int) -> None:
    text = through_a_pointer(limit)
    assert not stale(tmp_path, text)
    findings = stale(tmp_path, text.replace(AGE, ""))
    assert len(findings) == found
    for finding in findings:
        assert finding.place is not None
        assert "EPwm1Regs.CMPA" in text.replace(AGE, "").splitlines()[finding.place.line - 1]


def test_an_order_of_another_task_grows_old_too(tmp_path: Path) -> None:
    assert not stale(tmp_path, ORDERED)
    text = ORDERED.replace("Clock_getTicks() - came > 30", "came == 0")
    (finding,) = stale(tmp_path, text)
    assert finding.place is not None
    assert "duty * 100" in text.splitlines()[finding.place.line - 1]
    assert finding.object.startswith("mailbox ")


def test_what_could_fall_silent_is_named_when_it_was_not_tried(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("link.c").write_text(RIGHT, encoding="utf-8")
    said = "could fall silent, which was not tried (--silence): SCIA"
    for option, expected in ((), True), (("--silence",), False):
        invoke(["check", "link.c", "--for", "0.01", "--calls", "1", *option])
        assert (said in capsys.readouterr().out) is expected
        invoke(["check", "link.c", "--for", "0.01", "--calls", "1", "--json", *option])
        assert json.loads(capsys.readouterr().out)["run"]["not_silenced"] == (["SCIA"] if expected else [])
    Path("link.c").write_text(RIGHT.replace("CMPA = duty * 100", "CMPA = 100"), encoding="utf-8")  # nothing follows it
    invoke(["check", "link.c", "--for", "0.01", "--calls", "1"])
    assert "could fall silent" not in capsys.readouterr().out


def test_it_is_looked_for_on_demand(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = RIGHT.replace(AGE, "")
    assert not stale(tmp_path, text, silence=False)
    assert invoke(["check", str(tmp_path / "drv.c"), "--board", "bare", "--for", "0.2", "--silence", "--json"]) == 1
    told = json.loads(capsys.readouterr().out)["findings"]
    assert "stale-value" in [finding["rule"] for finding in told]
    assert invoke(["check", "--silence"]) == 2
    assert capsys.readouterr().err.count("\n") == 1
