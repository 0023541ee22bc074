"""Inputs that nothing drives move in a run of their own: what that shows, and that right programs are told nothing."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from hil.board import load
from hil.cli import invoke
from hil.drivers.check import DriverFiles, check_files
from hil.drivers.made_inputs import Uses, uses
from hil.image import Build
from hil.reports.model import rule_of

HEAD = """#include "F28x_Project.h"
volatile Uint16 Shown = 0, Marks[8], Next = 0;
"""
START = """    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0; IFR = 0;
    InitPieVectTable();
"""
BUTTON = HEAD + """
void main(void)
{{
    Uint16 before = 1;
{start}
    GPIO_SetupPinMux(40, GPIO_MUX_CPU1, 0);
    GPIO_SetupPinOptions(40, GPIO_INPUT, GPIO_PULLUP);
    for (;;)
    {{
        Uint16 now = GPIO_ReadPin(40);
        if (before && !now) {{ {press} }}
        before = now;
    }}
}}
"""
VOLTAGE = HEAD + """
{kind} Sum = 0;
void main(void)
{{
{start}
    EALLOW;
    CpuSysRegs.PCLKCR13.bit.ADC_A = 1;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    EDIS;
    DELAY_US(1000);
    EALLOW;
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 2;
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 19;
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    EDIS;
    for (;;)
    {{
        AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
        AdcaRegs.ADCSOCFRC1.all = 1;
        while (AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0);
        Sum = Sum - Sum / 16 + AdcaResultRegs.ADCRESULT0;
        Shown = Sum / 16;
        DELAY_US(500);
    }}
}}
"""
CHARACTERS = HEAD + """
char Ring[16];
volatile Uint16 Head = 0, Tail = 0;
__interrupt void receive(void)
{{
    while (SciaRegs.SCIFFRX.bit.RXFFST > 0)
    {{
        char c = SciaRegs.SCIRXBUF.bit.SAR;
        {store}
    }}
    SciaRegs.SCIFFRX.bit.RXFFOVRCLR = 1;
    SciaRegs.SCIFFRX.bit.RXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}}
void main(void)
{{
{start}
    EALLOW;
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1;
    PieVectTable.SCIA_RX_INT = &receive;
    EDIS;
    GPIO_SetupPinMux(28, GPIO_MUX_CPU1, 1);
    GPIO_SetupPinOptions(28, GPIO_INPUT, GPIO_PUSHPULL);
    SciaRegs.SCICCR.all = 7;
    SciaRegs.SCICTL1.all = 3;
    SciaRegs.SCIHBAUD.all = 0;
    SciaRegs.SCILBAUD.all = 53;
    SciaRegs.SCIFFTX.all = 0xE040;
    SciaRegs.SCIFFRX.all = 0x2061;
    SciaRegs.SCICTL1.all = 0x23;
    PieCtrlRegs.PIEIER9.bit.INTx1 = 1;
    IER |= M_INT9;
    EINT;
    for (;;)
    {{
        if (Tail != Head) {{ Shown = Ring[Tail % 16]; Tail = (Tail + 1) % 16; }}
    }}
}}
"""
STORE = "Uint16 next = Head + 1; if (next {}) next = 0; if (next != Tail) { Ring[Head] = c; Head = next; }"
SHAFT = HEAD + """
void main(void)
{{
{start}
    EALLOW;
    CpuSysRegs.PCLKCR4.bit.EQEP1 = 1;
    EDIS;
    GPIO_SetupPinMux(20, GPIO_MUX_CPU1, 1);
    GPIO_SetupPinMux(21, GPIO_MUX_CPU1, 1);
    EQep1Regs.QPOSMAX = 0xFFFFFFFF;
    EQep1Regs.QEPCTL.bit.PCRM = 1;
    EQep1Regs.QEPCTL.bit.QPEN = 1;
    for (;;)
    {{
        long at = (long)EQep1Regs.QPOSCNT / 100;
        Marks[{index}] = 1;
    }}
}}
"""
PULSES = HEAD + """
__interrupt void captured(void)
{{
    {take}
    ECap1Regs.ECCLR.all = 0xFFFF;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP4;
}}
void main(void)
{{
{start}
    EALLOW;
    CpuSysRegs.PCLKCR3.bit.ECAP1 = 1;
    InputXbarRegs.INPUT7SELECT = 24;
    PieVectTable.ECAP1_INT = &captured;
    EDIS;
    GPIO_SetupPinMux(24, GPIO_MUX_CPU1, 0);
    GPIO_SetupPinOptions(24, GPIO_INPUT, GPIO_PUSHPULL);
    ECap1Regs.ECCTL1.bit.CAP1POL = 0;
    ECap1Regs.ECCTL1.bit.CTRRST1 = 1;
    ECap1Regs.ECCTL1.bit.CAP2POL = 1;
    ECap1Regs.ECCTL1.bit.CAPLDEN = 1;
    ECap1Regs.ECCTL2.bit.STOP_WRAP = 1;
    ECap1Regs.ECCTL2.bit.SYNCO_SEL = 2;
    ECap1Regs.ECCTL2.bit.TSCTRSTOP = 1;
    ECap1Regs.ECEINT.bit.CEVT2 = 1;
    PieCtrlRegs.PIEIER4.bit.INTx1 = 1;
    IER |= M_INT4;
    EINT;
    for (;;);
}}
"""


def told(folder: Path, text: str, seconds: float) -> tuple[list[tuple[str, str]], tuple[str, ...]]:
    """What counts, rules with their statements; and what moved."""
    (folder / "lab.c").write_text(text, encoding="utf-8")
    checked = check_files(DriverFiles([folder / "lab.c"], calls=1, board=load("bare"), seconds=seconds))
    lines = text.splitlines()
    found = [
        (f.rule, lines[f.place.line - 1].strip()) for f in checked.findings
        if f.place is not None and f.how == "dynamic" and rule_of(f.rule).severity.value != "note"
    ]  # fmt: skip
    return found, checked.ran.moved if checked.ran is not None else ()


@pytest.mark.parametrize(("text", "wrong", "right", "rule", "at", "moved", "seconds"), [
    (BUTTON.format(start=START, press="Marks[Shown] = 1; Shown++; if (Shown {}) Shown = 0;"), "> 8", "> 7", "index",
     "if (before", "GPIO40", 1.0),
    (VOLTAGE.format(start=START, kind="{}"), "int16", "Uint32", "narrowed", "Sum = Sum", "the ADCs", 0.6),
    (CHARACTERS.format(start=START, store=STORE), "> 16", ">= 16", "index", "Uint16 next", "the receiver of SCIA", 0.3),
    (SHAFT.format(start=START, index="at {}"), "% 8", "& 7", "index", "Marks[at", "the eQEPs", 0.8),
    (PULSES.format(start=START, take="Marks[Next] = 1; Next++; if (Next {}) Next = 0;"), "> 8", "> 7", "index",
     "Marks[Next]", "GPIO24", 1.0),
])  # fmt: skip
def test_what_only_inputs_show_is_told(
    tmp_path: Path, text: str, wrong: str, right: str, rule: str, at: str, moved: str, seconds: float
) -> None:
    found, inputs = told(tmp_path, text.replace("{}", wrong), seconds)
    statements = [statement for name, statement in found if name == rule]
    assert len(statements) == 1
    assert statements[0].startswith(at)
    assert inputs == (moved,)
    assert told(tmp_path, text.replace("{}", right), seconds) == ([], (moved,))


def test_the_report_says_what_moved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = CHARACTERS.format(start=START, store=STORE.replace("{}", "> 16"))
    (tmp_path / "lab.c").write_text(text, encoding="utf-8")
    command = ["check", str(tmp_path / "lab.c"), "--for", "0.3", "--board", "bare", "--calls", "1"]
    invoke(command)
    assert "drives, moved in a further run: the receiver of SCIA" in " ".join(capsys.readouterr().out.split())
    reports = []
    for _ in range(2):
        invoke([*command, "--json"])
        reports.append(json.loads(capsys.readouterr().out))
    assert reports[0] == reports[1]
    assert reports[0]["run"]["moved_inputs"] == ["the receiver of SCIA"]
    (index,) = [finding for finding in reports[0]["findings"] if finding["rule"] == "index"]
    assert "a further run moved what the program reads" in " ".join(index["details"])


def test_a_program_without_such_inputs_runs_once(tmp_path: Path) -> None:
    output = BUTTON.replace("GPIO_INPUT, GPIO_PULLUP", "GPIO_OUTPUT, GPIO_PUSHPULL")
    for text in (
        output.format(start=START, press="Shown++;"),
        HEAD + "void main(void) { InitSysCtrl(); for (;;) Shown ^= 1; }",
        BUTTON.format(start=START, press="Shown++;").replace("void main(void)", "void Start(void)"),
    ):
        assert told(tmp_path, text, 0.3)[1] == ()


@pytest.mark.parametrize(("statement", "used"), [
    ("InputXbarRegs.INPUT7SELECT = 24;", True), ("GPIO_SetupXINT1Gpio(24);", True), ("Shown = GPIO_ReadPin(24);", True),
    ("Shown = GpioDataRegs.GPADAT.bit.GPIO24;", True), ("Shown = SciaRegs.SCIRXBUF.bit.SAR;", True),
    # An eCAP that makes a PWM; an output.
    ("ECap1Regs.ECCTL2.bit.CAP_APWM = 1; ECap1Regs.CAP2 = 500;", False), ("GpioDataRegs.GPASET.bit.GPIO24 = 1;", False),
])  # fmt: skip
def test_what_a_program_uses(tmp_path: Path, statement: str, used: bool) -> None:
    (tmp_path / "lab.c").write_text(f"{HEAD}void main(void) {{ {statement} for (;;); }}", encoding="utf-8")
    assert bool(uses(Build([str(tmp_path / "lab.c")]).modules)) is used


STUBS = """
Uint16 ADC_readResult(Uint32 base, Uint16 soc) { return 0; }
void ADC_setupSOC(Uint32 base, Uint16 soc) { }
Uint32 EQEP_getPosition(Uint32 base) { return 0; }
Uint16 SCI_readCharNonBlocking(Uint32 base) { return 0; }
static const Uint16 Buttons[2] = { 24, 31 };
static Uint16 Chosen = 24;
"""


@pytest.mark.parametrize(("statement", "used"), [
    ("Shown = ADC_readResult(0, 0);", Uses(analog=True)),
    ("ADC_setupSOC(0, 0);", Uses(analog=True)),  # a DMA may read it
    ("Shown = EQEP_getPosition(0);", Uses(shafts=True)),
    ("Shown = SCI_readCharNonBlocking(0);", Uses(characters=True)),
    ("Uint16 i; for (i = 0; i < 2; i++) Shown += GPIO_ReadPin(Buttons[i]);", Uses(pins={24, 31})),
    ("Shown = GPIO_ReadPin(Chosen);", Uses(pins=set(range(192)))),
])  # fmt: skip
def test_what_a_program_uses_by_functions(tmp_path: Path, statement: str, used: Uses) -> None:
    """Functions with the names of driverlib's read the same as registers; a table says which pins."""
    (tmp_path / "lab.c").write_text(f"{HEAD}{STUBS}void main(void) {{ {statement} for (;;); }}", encoding="utf-8")
    assert uses(Build([str(tmp_path / "lab.c")]).modules) == used
