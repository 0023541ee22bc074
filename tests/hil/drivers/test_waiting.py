"""Loops that nothing can end, and a watchdog that is serviced in spite of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from emulator.c28x.findings import Finding
from emulator.rules import Severity
from hil.board import load
from hil.drivers.check import DriverFiles, check_files
from hil.reports.policy import Policy

#: `main` works, and services the watchdog in its loop; the tick counts.
PROGRAM = """#include "F28x_Project.h"
volatile Uint16 Now_Ms, Alive, Rounds;
static void Serve(void)
{
    EALLOW;
    WdRegs.WDKEY.bit.WDKEY = 0x55;
    WdRegs.WDKEY.bit.WDKEY = 0xAA;
    EDIS;
}
interrupt void Tick(void)
{
    Now_Ms++;
    /*tick*/
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
    EALLOW;
    PieVectTable.TIMER0_INT = &Tick;
    EDIS;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1;
    EINT;
    StartCpuTimer0();
    EALLOW;
    WdRegs.WDCR.all = 0x0028;
    EDIS;
    for (;;) {
        Rounds++;
        Alive = Rounds < 20;
        /*wait*/
        DELAY_US(500);
        /*loop*/
    }
}
"""
HANG = "while (Alive == 0)\n            ;"


def program(**parts: str) -> str:
    text = PROGRAM
    for name, part in parts.items():
        assert text.count(f"/*{name}*/") == 1
        text = text.replace(f"/*{name}*/", part)
    return text


def told(folder: Path, text: str) -> list[Finding]:
    """The errors and warnings about waits."""
    (folder / "drv.c").write_text(text, encoding="utf-8")
    wanted = DriverFiles([folder / "drv.c"], calls=1, board=load("bare"), seconds=0.05)
    policy, rules = Policy(), ("endless-poll", "endless-loop", "watchdog-in-vain", "watchdog-reset")
    return [
        finding for finding in check_files(wanted).findings
        if finding.rule in rules and policy.severity_of(finding) is not Severity.NOTE
    ]  # fmt: skip


def test_the_loop_that_works_and_services_the_watchdog_is_right(tmp_path: Path) -> None:
    assert not told(tmp_path, program(loop="Serve();"))


def test_a_wait_for_what_only_main_itself_writes_never_ends(tmp_path: Path) -> None:
    text = program(wait=HANG, loop="Serve();")
    findings = told(tmp_path, text)
    assert {finding.rule for finding in findings} == {"endless-poll", "watchdog-reset"}
    (hung,) = (finding for finding in findings if finding.rule == "endless-poll")
    assert hung.place is not None
    assert "while (Alive == 0)" in text.splitlines()[hung.place.line - 1]


def test_a_service_by_the_tick_hides_it_and_is_told(tmp_path: Path) -> None:
    text = program(wait=HANG, tick="Serve();")
    findings = told(tmp_path, text)
    assert {finding.rule for finding in findings} == {"endless-poll", "watchdog-in-vain"}
    (vain,) = (finding for finding in findings if finding.rule == "watchdog-in-vain")
    assert vain.task == "Isr:Tick"
    assert vain.place is not None
    assert "0x55" in text.splitlines()[vain.place.line - 1]


@pytest.mark.parametrize("ends", [
    "if (Now_Ms > 20000)\n        Alive = 1;",  # an interrupt can end it, late as it may be
    "Later(&Alive);",  # somebody has its address
])  # fmt: skip
def test_a_wait_that_somebody_else_can_end_is_right(tmp_path: Path, ends: str) -> None:
    later = "static void Later(volatile Uint16 *flag)\n{\n    *flag = Now_Ms > 20000;\n}\ninterrupt void Tick"
    text = program(wait=HANG, tick=f"Serve();\n    {ends}").replace("interrupt void Tick", later)
    assert not told(tmp_path, text)


def test_a_loop_that_waits_for_many_ticks_is_right(tmp_path: Path) -> None:
    wait = (
        "while (Alive < 300) {\n            Uint16 seen = Now_Ms;\n"
        "            while (seen == Now_Ms)\n                ;\n            Alive += Rounds;\n        }"
    )
    (tmp_path / "drv.c").write_text(program(wait=wait, tick="Serve();"), encoding="utf-8")
    report = check_files(DriverFiles([tmp_path / "drv.c"], calls=1, board=load("bare"), seconds=0.5))
    assert "endless-loop" not in {finding.rule for finding in report.findings}
    assert any("the program ran for 0.5 s" in function.note for function in report.functions)


@pytest.mark.parametrize(("was", "hangs"), [
    ("", False),  # the tick ends it, late as it may be
    ("    StartCpuTimer0();\n", True),
    ("    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;\n", False),  # nobody says that the tick was meant to come
])  # fmt: skip
@pytest.mark.parametrize("wait", [
    "while (Now_Ms < 20000)\n            DELAY_US(50);", "while (Now_Ms == 0)\n            ;",
])  # fmt: skip
def test_a_wait_for_an_interrupt_that_never_occurs_never_ends(
    tmp_path: Path, wait: str, was: str, hangs: bool
) -> None:
    text = program(wait=wait).replace(was, "")
    findings = [f for f in told(tmp_path, text) if f.rule != "watchdog-reset"]
    assert [f.rule for f in findings] == ["endless-poll"] * hangs
    assert all(f.place is not None and "while (Now_Ms" in text.splitlines()[f.place.line - 1] for f in findings)


#: A message to a part that is not there; `main` waits for its end.
REFUSED = """#include "F28x_Project.h"
volatile Uint16 Refusals;
void main(void)
{
    InitSysCtrl();
    EALLOW;
    CpuSysRegs.PCLKCR9.bit.I2C_A = 1;
    GpioCtrlRegs.GPAGMUX1.bit.GPIO0 = 1;
    GpioCtrlRegs.GPAMUX1.bit.GPIO0 = 2;
    GpioCtrlRegs.GPAGMUX1.bit.GPIO1 = 1;
    GpioCtrlRegs.GPAMUX1.bit.GPIO1 = 2;
    GpioCtrlRegs.GPAPUD.bit.GPIO0 = 0;
    GpioCtrlRegs.GPAPUD.bit.GPIO1 = 0;
    EDIS;
    I2caRegs.I2CPSC.bit.IPSC = 19;
    I2caRegs.I2CCLKL = 45;
    I2caRegs.I2CCLKH = 45;
    I2caRegs.I2CSAR.bit.SAR = 0x50;
    I2caRegs.I2CMDR.bit.IRS = 1;
    I2caRegs.I2CCNT = 1;
    I2caRegs.I2CDXR.bit.DATA = 7;
    I2caRegs.I2CMDR.all = 0x6E20;
    while (TEST)
        ;
    for (;;) {
        Refusals++;
        DELAY_US(100);
    }
}
"""


@pytest.mark.parametrize(("test", "hangs"), [
    ("!I2caRegs.I2CSTR.bit.SCD", True),
    ("!I2caRegs.I2CSTR.bit.SCD && !I2caRegs.I2CSTR.bit.NACK", False),
])  # fmt: skip
def test_a_wait_behind_a_refusal_that_nobody_looks_at_never_ends(tmp_path: Path, test: str, hangs: bool) -> None:
    findings = told(tmp_path, REFUSED.replace("TEST", test))
    assert [f.rule for f in findings] == ["endless-poll"] * hangs


#: As `REFUSED`, but each attempt ends.
ATTEMPT = """static Uint16 Try(void)
{
    Uint16 n;
    I2caRegs.I2CSTR.bit.SCD = 1;
    I2caRegs.I2CCNT = 1;
    I2caRegs.I2CDXR.bit.DATA = 7;
    I2caRegs.I2CMDR.all = 0x6E20;
    for (n = 0; n < 500; n++) {
        if (I2caRegs.I2CSTR.bit.NACK) {
            I2caRegs.I2CMDR.bit.STP = 1;
            I2caRegs.I2CSTR.bit.NACK = 1;
            DELAY_US(100);
            return 0;
        }
        if (I2caRegs.I2CSTR.bit.SCD)
            return 1;
        DELAY_US(1);
    }
    return 0;
}
void main(void)"""


@pytest.mark.parametrize(("loop", "told_it"), [
    ("while (!Try())\n        Refusals++;", True),
    ("while (Refusals == 0)\n        Refusals = Try();", True),
    ("for (tries = 0; tries < 100 && !Try(); tries++)\n        DELAY_US(10);", False),
    ("while (!Try())\n        if (++tries > 20000)\n            break;", False),
    ("Try();\n    while (GpioDataRegs.GPADAT.bit.GPIO19 == 0)\n        DELAY_US(10);", False),  # for a button
])  # fmt: skip
def test_a_transaction_is_repeated_without_a_limit(tmp_path: Path, loop: str, told_it: bool) -> None:
    found = retries(tmp_path, loop, "", 0.05)
    assert [line.strip() for line in found] == [loop.splitlines()[0]] * told_it


@pytest.mark.parametrize(("begins", "told_it"), [(0.33, True), (0.5, False)])
def test_it_is_known_after_a_while_whenever_it_begins(tmp_path: Path, begins: float, told_it: bool) -> None:
    waits = f"for (tries = 0; tries < {begins * 1000:.0f}; tries++)\n        DELAY_US(1000);\n    "
    assert bool(retries(tmp_path, "while (!Try())\n        ;", waits, 0.6)) == told_it


def retries(tmp_path: Path, loop: str, before: str, seconds: float) -> list[str]:
    """The lines with an `endless-retry`, of a program with `loop` around `Try()`."""
    begin = REFUSED.index("    I2caRegs.I2CCNT = 1;")
    end = REFUSED.index("    for (;;) {")
    text = f"{REFUSED[:begin]}    {before}{loop}\n{REFUSED[end:]}".replace("void main(void)", ATTEMPT)
    text = text.replace("InitSysCtrl();", "Uint16 tries = 0;\n    InitSysCtrl();")
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    wanted = DriverFiles([tmp_path / "drv.c"], calls=1, board=load("bare"), seconds=seconds)
    findings = [f for f in check_files(wanted).findings if f.rule == "endless-retry"]
    return [text.splitlines()[f.place.line - 1] for f in findings if f.place is not None]


#: A node that sends 0x123 each millisecond, and acknowledges.
MASTER = """
from emulator.can_bus import CanFrame, CanPart
from emulator.clock import CYCLES_PER_MS
from hil.board import Board


class Master(Board):
    def solder(self):
        node = self.on_can("master", CanPart(500_000), bus="A")
        for ms in range(1, 60):
            self.clock.schedule(ms * CYCLES_PER_MS, lambda: node.send(CanFrame(0x123, b"12")))
"""
#: A frame a millisecond; SENT is done until it is sent.  What comes drives ePWM1.
SENDER = """#include "F28x_Project.h"
volatile Uint16 Order, Age, Lost;
void main(void)
{
    Uint16 n;
    InitSysCtrl();
    EALLOW;
    CpuSysRegs.PCLKCR10.bit.CAN_A = 1;
    CpuSysRegs.PCLKCR2.bit.EPWM1 = 1;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    GPIO_SetupPinMux(36, GPIO_MUX_CPU1, 6);
    GPIO_SetupPinMux(37, GPIO_MUX_CPU1, 6);
    EPwm1Regs.TBPRD = 20000;
    EPwm1Regs.AQCTLA.bit.ZRO = AQ_SET;
    EPwm1Regs.AQCTLA.bit.CAU = AQ_CLEAR;
    EPwm1Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    CanaRegs.CAN_CTL.bit.Init = 1;
    CanaRegs.CAN_CTL.bit.CCE = 1;
    CanaRegs.CAN_BTR.all = 19uL | (13uL << 8) | (4uL << 12);
    CanaRegs.CAN_CTL.bit.CCE = 0;
    CanaRegs.CAN_IF1ARB.all = 0xA0000000uL | (0x55uL << 18);
    CanaRegs.CAN_IF1MCTL.all = 0x0082uL;
    CanaRegs.CAN_IF1CMD.all = 0x00B00003uL;
    CanaRegs.CAN_IF2ARB.all = 0x80000000uL | (0x123uL << 18);
    CanaRegs.CAN_IF2MCTL.all = 0x0082uL;
    CanaRegs.CAN_IF2CMD.all = 0x00B00004uL;
    DELAY_US(10);
    CanaRegs.CAN_CTL.bit.Init = 0;
    Order = 0;
    Age = 100;
    for (;;) {
        CanaRegs.CAN_IF1DATA.all = Order;
        CanaRegs.CAN_IF1CMD.all = 0x00870003uL;
        SENT
        DELAY_US(1000);
        if (Age < 100)
            Age++;
        if (CanaRegs.CAN_NDAT_21 & 8uL) {
            CanaRegs.CAN_IF2CMD.all = 0x00070004uL;
            while (CanaRegs.CAN_IF2CMD.bit.Busy)
                ;
            Order = CanaRegs.CAN_IF2DATA.bit.Data_0;
            Age = 0;
        }
        AGED
        EPwm1Regs.CMPA.bit.CMPA = Order * 100;
    }
}
"""
LIMITED = "for (n = 0; n < 1000 && (CanaRegs.CAN_TXRQ_21 & 4uL); n++) ;"
AGED = "if (Age > 5) Order = 0;"


def silent(tmp_path: Path, text: str, *, silence: bool = True) -> list[tuple[str, str]]:
    """The findings about waits and old values: rule, and the line."""
    (tmp_path / "master.py").write_text(MASTER, encoding="utf-8")
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    board = load(str(tmp_path / "master.py"))
    wanted = DriverFiles([tmp_path / "drv.c"], calls=1, board=board, board_named=True, seconds=0.05, silence=silence)
    findings = [f for f in check_files(wanted).findings if f.rule in ("endless-poll", "stale-value")]
    assert all(f.how == "dynamic" for f in findings)
    return [(f.rule, text.splitlines()[f.place.line - 1].strip()) for f in findings if f.place is not None]


@pytest.mark.parametrize(("sent", "hangs"), [
    (LIMITED, False),
    ("while (CanaRegs.CAN_TXRQ_21 & 4uL) ;", True),
    ("while (!CanaRegs.CAN_ES.bit.TxOk) ;", True),
    # It looks at what the controller says of a bus without other nodes.
    ("while ((CanaRegs.CAN_TXRQ_21 & 4uL) && !CanaRegs.CAN_ES.bit.EPass) ;", False),
])  # fmt: skip
def test_a_wait_for_a_frame_that_nobody_acknowledges_any_more(tmp_path: Path, sent: str, hangs: bool) -> None:
    text = SENDER.replace("SENT", sent).replace("AGED", AGED)
    assert silent(tmp_path, text) == [("endless-poll", sent)] * hangs


def test_a_wait_for_an_acknowledge_that_comes_is_right(tmp_path: Path) -> None:
    text = SENDER.replace("SENT", "while (CanaRegs.CAN_TXRQ_21 & 4uL) ;").replace("AGED", AGED)
    assert not silent(tmp_path, text, silence=False)


@pytest.mark.parametrize("aged", [AGED, ""])
def test_an_output_that_follows_what_a_can_node_said_last(tmp_path: Path, aged: str) -> None:
    text = SENDER.replace("SENT", LIMITED).replace("AGED", aged)
    assert silent(tmp_path, text) == [("stale-value", "EPwm1Regs.CMPA.bit.CMPA = Order * 100;")] * (not aged)


def test_a_wait_for_the_next_order_is_no_wait_for_an_acknowledge(tmp_path: Path) -> None:
    text = SENDER.replace("SENT", LIMITED).replace("AGED", AGED)
    text = text.replace("if (CanaRegs.CAN_NDAT_21 & 8uL) {", "while (!(CanaRegs.CAN_NDAT_21 & 8uL)) ;\n        {")
    (tmp_path / "master.py").write_text(MASTER, encoding="utf-8")
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    wanted = DriverFiles(
        [tmp_path / "drv.c"], calls=1, board=load(str(tmp_path / "master.py")), board_named=True, seconds=0.05,
        silence=True,
    )  # fmt: skip
    assert {f.how for f in check_files(wanted).findings if f.rule == "endless-poll"} <= {"generated"}


#: The master is away for 60 ms, and comes back.
PAUSES = MASTER.replace("range(1, 60)", "(*range(1, 120), *range(180, 215))")
#: What it says goes out in a message of the program's own, which a helper sends.
GATEWAY = (
    SENDER.replace("void main(void)\n{\n", """static void Send(const Uint16 *words)
{
    CanaRegs.CAN_IF1DATA.bit.Data_0 = words[0];
    CanaRegs.CAN_IF1CMD.all = 0x00870003uL;
}
void main(void)
{
    Uint16 words[2];
""", 1)
    .replace("        CanaRegs.CAN_IF1DATA.all = Order;\n        CanaRegs.CAN_IF1CMD.all = 0x00870003uL;\n", "")
    .replace("        EPwm1Regs.CMPA.bit.CMPA = Order * 100;", "        words[0] = Order;\n        Send(words);")
    .replace("SENT", LIMITED)
)  # fmt: skip


@pytest.mark.parametrize("aged", [AGED, ""])
def test_a_message_that_repeats_what_a_silent_node_said(tmp_path: Path, aged: str) -> None:
    (tmp_path / "master.py").write_text(PAUSES, encoding="utf-8")
    text = GATEWAY.replace("AGED", aged)
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    board = load(str(tmp_path / "master.py"))
    wanted = DriverFiles([tmp_path / "drv.c"], calls=1, board=board, board_named=True, seconds=0.21)
    findings = [f for f in check_files(wanted).findings if f.rule == "stale-value"]
    lines = [text.splitlines()[f.place.line - 1].strip() for f in findings if f.place is not None]
    assert lines == ["Send(words);"] * (not aged)


SLEEPERS = """#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Task.h>
#include "F28x_Project.h"
Int Alive;
Void watch(UArg a, UArg b)
{
    for (;;) {
        Task_sleep(5);
        if (Alive)
            ServiceDog();
    }
}
Int main(Void)
{
    Task_create(watch, NULL, NULL);
    /*served*/
    EALLOW;
    WdRegs.WDCR.all = 0x0028;
    EDIS;
    BIOS_start();
    return 0;
}
"""


@pytest.mark.parametrize(("served", "at", "why"), [
    ("", "WdRegs.WDCR.all = 0x0028;", "never serviced"), ("ServiceDog();", "ServiceDog();", "last serviced 13"),
])  # fmt: skip
def test_a_reset_while_all_tasks_sleep_has_a_place(tmp_path: Path, served: str, at: str, why: str) -> None:
    text = SLEEPERS.replace("/*served*/", served)
    (finding,) = told(tmp_path, text)
    assert finding.rule == "watchdog-reset"
    assert finding.place is not None
    assert text.splitlines()[finding.place.line - 1].strip() == at
    assert why in finding.message
