"""What is configured and can bring nothing: a right program, and the same with one link of a chain missing."""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path

import pytest

from emulator.c28x.findings import Finding
from emulator.clock import CYCLES_PER_MS
from hil.board import Board, load
from hil.drivers.check import DriverFiles, check_files
from tests.corpus.corpus import chosen, measured
from tests.emulator.drivers import START_UP

#: ePWM1 triggers a conversion and interrupts, ePWM2 drives a pin, a pin interrupts, timer 0 and eQEP1 tick.
RIGHT = """#include "F28x_Project.h"
volatile Uint16 Count, Order;
void Put(Uint16 c)
{
    if (SciaRegs.SCIFFTX.bit.TXFFST < 16)
        SciaRegs.SCITXBUF.all = c;
}
interrupt void converted(void) { AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; }
interrupt void edge(void) { Count++; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; }
interrupt void tick(void) { Count++; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; }
interrupt void period(void) { EPwm1Regs.ETCLR.bit.INT = 1; PieCtrlRegs.PIEACK.all = PIEACK_GROUP3; }
interrupt void unit(void)
{
    EQep1Regs.QCLR.bit.UTO = 1;
    EQep1Regs.QCLR.bit.INT = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP5;
}
void main(void)
{
""" + START_UP + """    EALLOW;
    PieVectTable.ADCA1_INT = &converted;
    PieVectTable.XINT1_INT = &edge;
    PieVectTable.TIMER0_INT = &tick;
    PieVectTable.EPWM1_INT = &period;
    PieVectTable.EQEP1_INT = &unit;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0;
    InputXbarRegs.INPUT4SELECT = 7;
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 14;
    AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 5;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    EDIS;
    EPwm1Regs.TBPRD = 20000;
    EPwm1Regs.CMPA.bit.CMPA = 500;
    EPwm1Regs.ETSEL.bit.SOCASEL = 4;
    EPwm1Regs.ETSEL.bit.SOCAEN = 1;
    EPwm1Regs.ETPS.bit.SOCAPRD = 1;
    EPwm1Regs.ETSEL.bit.INTSEL = 1;
    EPwm1Regs.ETSEL.bit.INTEN = 1;
    EPwm1Regs.ETPS.bit.INTPRD = 1;
    EPwm1Regs.TBCTL.bit.CTRMODE = 0;
    EPwm2Regs.TBPRD = 20000;
    EPwm2Regs.CMPA.bit.CMPA = 20001;
    EPwm2Regs.CMPCTL.bit.LOADAMODE = 0;
    EPwm2Regs.AQCTLA.bit.ZRO = 2;
    EPwm2Regs.AQCTLA.bit.CAU = 1;
    EPwm2Regs.TBCTL.bit.CTRMODE = 0;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    XintRegs.XINT1CR.bit.ENABLE = 1;
    CpuTimer0Regs.PRD.all = 200000;
    CpuTimer0Regs.TCR.all = 0x4020;
    EQep1Regs.QPOSMAX = 0xFFFFFFFF;
    EQep1Regs.QUPRD = 200000;
    EQep1Regs.QEPCTL.bit.UTE = 1;
    EQep1Regs.QEPCTL.bit.QPEN = 1;
    EQep1Regs.QEINT.bit.UTO = 1;
    PieCtrlRegs.PIEIER1.bit.INTx1 = 1;
    PieCtrlRegs.PIEIER1.bit.INTx4 = 1;
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    PieCtrlRegs.PIEIER3.bit.INTx1 = 1;
    PieCtrlRegs.PIEIER5.bit.INTx1 = 1;
    IER |= M_INT1 | M_INT3 | M_INT5;
    EINT;
    SciaRegs.SCICCR.all = 0x0017;
    SciaRegs.SCILBAUD.all = 53;
    SciaRegs.SCIFFTX.all = 0xE040;
    SciaRegs.SCICTL1.all = 0x0022;
    for (;;) { Count = 0; Put('x'); }
}
"""

GATE = "CpuSysRegs.PCLKCR8.bit.SPI_A = 1;"


def told(tmp_path: Path, text: str, rule: str = "not-connected", seconds: float = 0.004) -> list[Finding]:
    """What the check of a program says by one rule."""
    (tmp_path / "drv.c").write_text(text, encoding="utf-8")
    wanted = DriverFiles([tmp_path / "drv.c"], calls=1, board=load("bare"), seconds=seconds)
    return [finding for finding in check_files(wanted).findings if finding.rule == rule]


@pytest.mark.parametrize(("was", "now", "at", "why"), [
    ("TBCLKSYNC = 1", "TBCLKSYNC = 0", "TBCLKSYNC = 0", "TBCLKSYNC = 0"),
    ("EPwm1Regs.TBCTL.bit.CTRMODE = 0;", "", "TRIGSEL = 5", "EPwm1Regs.TBCTL.CTRMODE = 3"),
    ("EPwm1Regs.TBPRD = 20000;", "", "TRIGSEL = 5", "EPwm1Regs.TBPRD = 0"),
    ("EPwm1Regs.ETSEL.bit.SOCAEN = 1;", "", "ETSEL.bit.INTEN", "EPwm1Regs.ETSEL.SOCAEN = 0"),
    ("EPwm1Regs.ETPS.bit.SOCAPRD = 1;", "", "ETPS.bit.INTPRD", "EPwm1Regs.ETPS.SOCAPRD = 0"),
    ("CMPA = 500", "CMPA = 30000", "CMPA = 30000", "EPwm1Regs.CMPA = 30000 is above TBPRD = 20000"),
    ("SOCASEL = 4", "SOCASEL = 5", "SOCASEL = 5", "the counter only counts up"),
    ("TRIGSEL = 5", "TRIGSEL = 7", "TRIGSEL = 7", "EPwm2Regs.ETSEL.SOCAEN = 0"),
    ("TRIGSEL = 5", "TRIGSEL = 3", "TRIGSEL = 3", "CpuTimer2Regs.TCR.TIE = 0"),
    ("CMPA = 20001", "CMPA = 20002", "CMPA = 20002", "above TBPRD = 20000"),
    ("LOADAMODE = 0", "LOADAMODE = 3", "LOADAMODE = 3", "is never loaded from its shadow"),
    ("InputXbarRegs.INPUT4SELECT = 7;", "", "XINT1CR.bit.ENABLE", "INPUT4SELECT was never set"),
    ("XintRegs.XINT1CR.bit.ENABLE = 1;", "", "PIEIER1.bit.INTx4", "XINT1CR.ENABLE = 0"),
    ("AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;", "", "TRIGSEL = 5", "ADCINTSEL1N2.INT1E = 0"),
    ("0x4020", "0x4030", "0x4030", "CpuTimer0Regs.TCR.TSS = 1"),
    ("0x4020", "0x0020", "0x0020", "CpuTimer0Regs.TCR.TIE = 0"),
    ("PIEIER1.bit.INTx7", "PIEIER1.bit.INTx6", "PIEIER1.bit.INTx6", "tick is that of interrupt 1.7"),
    ("EPwm1Regs.ETSEL.bit.INTEN = 1;", "", "ETSEL.bit.INTSEL", "EPwm1Regs.ETSEL.INTEN = 0"),
    ("EQep1Regs.QUPRD = 200000;", "", "QEPCTL.bit.UTE", "EQep1Regs.QUPRD = 0"),
    ("EQep1Regs.QEPCTL.bit.UTE = 1;", "", "QEPCTL.bit.QPEN", "EQep1Regs.QEPCTL.UTE = 0"),
    ("EQep1Regs.QEINT.bit.UTO = 1;", "", "QEPCTL.bit.QPEN", "EQep1Regs.QEINT = 0"),
    ("EQep1Regs.QEPCTL.bit.QPEN = 1;", "", "QEPCTL.bit.UTE", "EQep1Regs.QEPCTL.QPEN = 0"),
    ("    AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 5;\n", "    AdcaRegs.ADCSOC1CTL.bit.TRIGSEL = 5;\n", "INT1E = 1",
     "INT1SEL = 0: SOC0 of ADC-A has no trigger"),
    ("INT1E = 1;", "INT1E = 1; AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 9;", "INT1SEL = 9", "SOC9 of ADC-A has no trigger"),
    (" | M_INT5", "", "PIEIER5.bit.INTx1", "M_INT5"),
    ("    EINT;\n", "    IER = M_INT1 | M_INT3;\n    EINT;\n", "PIEIER5.bit.INTx1", "M_INT5"),
    ("    EINT;\n", "", "IER |= M_INT1", "no statement executes EINT: "),
    ("    EINT;\n", "    DINT;\n", "IER |= M_INT1", "converted and edge and tick and period and unit never run, "),
    ("SCICTL1.all = 0x0022", "SCICTL1.all = 0x0002", "SCICTL1.all = 0x0002", "SciaRegs.SCICTL1.SWRESET = 0"),
])  # fmt: skip
def test_a_link_that_is_missing_is_named_where_its_register_is_set_or_the_event_is_wanted(
    tmp_path: Path, was: str, now: str, at: str, why: str
) -> None:
    assert RIGHT.count(was) == 1
    text = RIGHT.replace(was, now)
    lines = text.splitlines()
    findings = [f for f in told(tmp_path, text) if f.place is not None and at in lines[f.place.line - 1]]
    assert findings, told(tmp_path, text)
    assert all(why in finding.message for finding in findings)


@pytest.mark.parametrize("now", [
    "    if (Count == 9) EINT;\n",  # on an order that did not come
    "    __enable_interrupts();\n",
    "    while ((IFR & M_INT1) == 0) ;\n",  # it polls
    "    while (Order != 9) asm(\" IDLE\");\n",  # an interrupt that IER lets through ends IDLE, whatever INTM is
])  # fmt: skip
def test_interrupts_that_some_statement_lets_through_are_not_told(tmp_path: Path, now: str) -> None:
    assert told(tmp_path, RIGHT.replace("    EINT;\n", now)) == []


def test_a_timer_that_is_polled_while_ier_is_0_is_not_told(tmp_path: Path) -> None:
    text = RIGHT.replace("    EINT;\n", "").replace("    IER |= M_INT1 | M_INT3 | M_INT5;\n", "")
    assert [f for f in told(tmp_path, text) if "EINT" in f.message] == []


@pytest.mark.parametrize(("damage", "why"), [
    ("dma-trigger-not-enabled", "CH1.MODE.PERINTE = 0"),
    ("dma-trigger-of-another-adc", "it listens to ADCAINT1: AdcaRegs.ADCINTSEL1N2.INT1E = 0"),
    ("dma-never-started", "CH1.CONTROL.RUN is never set"),
    ("dma-timer-never-started", "CpuTimer1Regs.TCR.TSS = 1"),
    ("capture-not-enabled", "ECap1Regs.ECCTL1.CAPLDEN = 0"),
    ("capture-counter-stands", "ECap1Regs.ECCTL2.TSCTRSTOP = 0"),
    ("capture-event-never-reached", "ECap1Regs.ECCTL2.STOP_WRAP = 1: event 2 is the last"),
    ("capture-never-rearmed", "ECap1Regs.ECCTL2.REARM is not set again"),
    ("capture-qualification-swallows", "its qualification needs 6 equal samples"),
    ("pulses-timer-not-in-ier", "bit 12 of IER (M_INT13) is 0"),
    ("overcurrent-comparator-off", "comparator 2 is off"),
    ("overcurrent-threshold-above-window", "samples, but the window has"),
    ("overcurrent-event-does-not-trip", "no statement uses it"),
    ("overcurrent-no-condition", "names no condition"),
    ("wheel-latched-by-reading", "EQep1Regs.QEPCTL.QCLM = 0"),
    ("link-receive-level-of-31", "the FIFO holds 16"),
    ("i2c-module-held-in-reset", "IRS = 0"),
    ("chain-hwi-of-another-line", "AdcdRegs.ADCINTSEL1N2.INT1E = 0"),
])  # fmt: skip
@pytest.mark.slow
def test_a_damage_of_the_corpus_is_told_with_the_link(damage: str, why: str) -> None:
    ((_, _, lines, result),) = measured(chosen(damage))
    assert any(line in lines and rule == "not-connected" and why in text for line, rule, text in result.told)


@pytest.mark.parametrize("later", [
    "",
    # Each brings the missing link later, on an order that does not come in this run.
    "EPwm1Regs.TBCTL.bit.CTRMODE = 0;", "EPwm1Regs.ETSEL.bit.SOCAEN = 1;", "EPwm1Regs.TBPRD = 20000;",
    "SciaRegs.SCICTL1.all = 0x0022;", "XintRegs.XINT1CR.bit.ENABLE = 1;", "EQep1Regs.QUPRD = 200000;",
    "AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;", "AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 5;",
])  # fmt: skip
def test_a_right_program_is_told_nothing(tmp_path: Path, later: str) -> None:
    text = RIGHT
    if later:
        assert text.count(later) == 1
        text = text.replace(later, "").replace("Count = 0;", f"if (Order) {{ {later} }}")
    assert not told(tmp_path, text)


#: ePWM2 blinks at GPIO2 by itself.
BLINKS = """#include "F28x_Project.h"
void main(void)
{
""" + START_UP + """    GPIO_SetupPinMux(2, GPIO_MUX_CPU1, 1);
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0;
    EDIS;
    EPwm2Regs.TBPRD = 20000;
    EPwm2Regs.CMPA.bit.CMPA = 5000;
    EPwm2Regs.AQCTLA.bit.ZRO = 2;
    EPwm2Regs.AQCTLA.bit.CAU = 1;
    EPwm2Regs.TBCTL.bit.CTRMODE = 0;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    for (;;) ;
}
"""


@pytest.mark.parametrize(("was", "now", "at"), [
    ("", "", ""),
    ("TBCLKSYNC = 1", "TBCLKSYNC = 0", "TBCLKSYNC = 0"),
    ("EPwm2Regs.TBPRD = 20000;", "", "CTRMODE = 0"),
    # TI's start-up has set TBCLKSYNC.
    ("    EALLOW;\n    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0;\n    EDIS;\n", "", ""),
    # The counter is meant to stand still, or the program forces the level.
    ("CTRMODE = 0", "CTRMODE = 3", ""),
    ("TBCLKSYNC = 1", "TBCLKSYNC = 0; EPwm2Regs.AQCSFRC.bit.CSFA = 2", ""),
    # No pin has the output.
    ("GPIO_SetupPinMux(2, GPIO_MUX_CPU1, 1);\n    EALLOW;\n    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0",
     "EALLOW;\n    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0", ""),
])  # fmt: skip
def test_an_output_that_no_counter_switches(tmp_path: Path, was: str, now: str, at: str) -> None:
    assert not was or BLINKS.count(was) == 1
    text = BLINKS.replace(was, now) if was else BLINKS
    places = [finding.place for finding in told(tmp_path, text)]
    lines = text.splitlines()
    assert [at in lines[place.line - 1] for place in places if place is not None] == [True] * bool(at)


TAKEN_AWAY = "CpuTimer0Regs.TCR.all = 0x4020;\n    CpuTimer0Regs.TCR.bit.TIE = 0;"


@pytest.mark.parametrize(("loop", "before", "told_it"), [
    ("Count = 0;", "", True),
    ("if (Order) CpuTimer0Regs.TCR.bit.TIE = 1;", "", False),
    # The run ends before that statement: it may yet come.
    ("Count = 0;", "DELAY_US(100000);", False),
])  # fmt: skip
def test_what_the_start_up_gives_and_takes_away_again_is_missing(
    tmp_path: Path, loop: str, before: str, told_it: bool
) -> None:
    text = RIGHT.replace("CpuTimer0Regs.TCR.all = 0x4020;", TAKEN_AWAY + before).replace("Count = 0;", loop)
    lines = text.splitlines()
    findings = [f for f in told(tmp_path, text) if "CpuTimer0Regs.TCR.TIE = 0" in f.message]
    assert [lines[f.place.line - 1].split("DELAY")[0].strip() for f in findings if f.place is not None] == [
        "CpuTimer0Regs.TCR.bit.TIE = 0;"
    ] * told_it  # fmt: skip


@pytest.mark.parametrize(("trigger", "at"), [
    # SOCA comes and starts nothing: the trigger is the mistake.
    (6, "TRIGSEL = 6"),
    # ePWM2 gives no SOC at all, and another one was meant or is missing: its ETSEL was never set.
    (8, "TRIGSEL = 8"),
])  # fmt: skip
def test_the_soc_of_an_epwm_that_nobody_enables(tmp_path: Path, trigger: int, at: str) -> None:
    text = RIGHT.replace("TRIGSEL = 5", f"TRIGSEL = {trigger}")
    lines = text.splitlines()
    (finding,) = told(tmp_path, text)
    assert finding.place is not None
    assert at in lines[finding.place.line - 1]
    assert ("SOCA occurs and starts nothing" in finding.message) == (trigger == 6)


def test_the_soc_is_missing_where_the_other_one_is_heard(tmp_path: Path) -> None:
    text = RIGHT.replace("TRIGSEL = 5;", "TRIGSEL = 5; AdcaRegs.ADCSOC1CTL.bit.TRIGSEL = 6;")
    lines = text.splitlines()
    (finding,) = told(tmp_path, text)
    assert finding.place is not None
    assert "ETSEL" in lines[finding.place.line - 1]


@pytest.mark.parametrize(("priority", "size", "socs", "why"), [
    (14, 2, (14, 15), ""), (12, 2, (12, 13, 14, 15), ""),
    # Three SOCs and bursts of two: the second burst begins at SOC15.
    (13, 2, (13, 14, 15), "3 are no multiple of 2"),
    # The round robin goes on with SOC2 to SOC15.
    (0, 2, (0, 1), "SOC2 is one of them"),
])  # fmt: skip
def test_a_burst_that_does_not_come_back(
    tmp_path: Path, priority: int, size: int, socs: tuple[int, ...], why: str
) -> None:
    setting = "".join(f"AdcbRegs.ADCSOC{n}CTL.bit.ACQPS = 14;\n" for n in socs)
    setting += f"AdcbRegs.ADCSOCPRICTL.bit.SOCPRIORITY = {priority};\n"
    setting += f"AdcbRegs.ADCBURSTCTL.bit.BURSTSIZE = {size - 1};\nAdcbRegs.ADCBURSTCTL.bit.BURSTTRIGSEL = 5;\n"
    setting += "AdcbRegs.ADCBURSTCTL.bit.BURSTEN = 1;\n"
    text = RIGHT.replace("    AdcaRegs.ADCSOC0CTL.bit.ACQPS", setting + "    AdcaRegs.ADCSOC0CTL.bit.ACQPS")
    lines = text.splitlines()
    findings = told(tmp_path, text, "adc-burst")
    assert [why in f.message for f in findings] == [True] * bool(why)
    assert all(f.place is not None and "BURSTSIZE" in lines[f.place.line - 1] for f in findings)


def test_a_trigger_that_nobody_looks_at_is_not_waited_for(tmp_path: Path) -> None:
    """An ADCINT triggers the SOC instead of its TRIGSEL, whose ePWM gives nothing."""
    text = RIGHT.replace("TRIGSEL = 5;", "TRIGSEL = 7;")
    assert told(tmp_path, text)
    assert not told(tmp_path, text.replace("TRIGSEL = 7;", "TRIGSEL = 7; AdcaRegs.ADCINTSOCSEL1.bit.SOC0 = 1;"))


def test_the_acknowledge_that_is_missing_is_named_not_the_flag_that_it_holds(tmp_path: Path) -> None:
    text = RIGHT.replace("ADCINT1 = 1; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;", "ADCINT1 = 1;")
    assert text != RIGHT
    (finding,) = told(tmp_path, text, "flag-not-cleared")
    assert finding.object == "PieCtrlRegs.PIEACK.ACK1"
    assert finding.place is not None
    assert finding.place.function == "converted"


def test_the_flag_of_an_eqep_is_told_where_its_routine_begins(tmp_path: Path) -> None:
    text = RIGHT.replace("    EQep1Regs.QCLR.bit.INT = 1;\n", "")
    assert text != RIGHT
    (finding,) = told(tmp_path, text, "flag-not-cleared", seconds=0.02)
    assert finding.object == "EQep1Regs.QFLG.INT"
    assert finding.place is not None
    assert finding.place.function == "unit"


def test_a_part_of_a_program_is_told_nothing(tmp_path: Path) -> None:
    """What starts the counter may stand in another file."""
    text = RIGHT.replace("EPwm1Regs.TBCTL.bit.CTRMODE = 0;", "").replace("for (;;)", "")
    assert not told(tmp_path, text.replace("void main", "void Init"))


#: ePWM4 drives a pair of pins with a dead band; software trips it once, and again when that is over.
TRIPPED = """#include "F28x_Project.h"
volatile Uint16 Trips, Order;
interrupt void tripped(void)
{
    Trips++;
    EALLOW;
    EPwm4Regs.TZCLR.bit.OST = 1;
    EPwm4Regs.TZCLR.bit.INT = 1;
    EDIS;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP2;
}
void main(void)
{
""" + START_UP + """    EALLOW;
    PieVectTable.EPWM4_TZ_INT = &tripped;
    GpioCtrlRegs.GPAMUX1.bit.GPIO6 = 1;
    GpioCtrlRegs.GPAMUX1.bit.GPIO7 = 1;
    EPwm4Regs.TZCTL.bit.TZA = TZ_FORCE_LO;
    EPwm4Regs.TZCTL.bit.TZB = TZ_FORCE_LO;
    EPwm4Regs.TZSEL.bit.CBC1 = 1;
    EPwm4Regs.TZEINT.bit.OST = 1;
    InputXbarRegs.INPUT1SELECT = 40;
    GpioCtrlRegs.GPBPUD.bit.GPIO40 = 0;
    EDIS;
    EPwm4Regs.TBPRD = 2000;
    EPwm4Regs.CMPA.bit.CMPA = 500;
    EPwm4Regs.AQCTLA.bit.ZRO = AQ_SET;
    EPwm4Regs.AQCTLA.bit.CAU = AQ_CLEAR;
    EPwm4Regs.DBRED.bit.DBRED = 20;
    EPwm4Regs.DBFED.bit.DBFED = 20;
    EPwm4Regs.DBCTL.bit.POLSEL = DB_ACTV_HIC;
    EPwm4Regs.DBCTL.bit.OUT_MODE = DB_FULL_ENABLE;
    EPwm4Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    PieCtrlRegs.PIEIER2.bit.INTx4 = 1;
    IER |= M_INT2;
    EINT;
    for (;;) {
        EALLOW;
        EPwm4Regs.TZFRC.bit.OST = 1;
        EDIS;
        DELAY_US(200);
    }
}
"""


@pytest.mark.parametrize(("was", "now", "rule", "at", "why"), [
    ("GpioCtrlRegs.GPAMUX1.bit.GPIO7 = 1;", "", "not-connected", "OUT_MODE", "EPWM4B has no pin"),
    ("EPwm4Regs.TZCTL.bit.TZA = TZ_FORCE_LO;", "", "trip-open", "TZSEL", "TZA: 0 is high impedance"),
    (" = &tripped;", " = &tripped; GpioCtrlRegs.GPAMUX1.bit.GPIO0 = 1; InputXbarRegs.INPUT2SELECT = 40;\n//",
     "not-connected", "INPUT2SELECT", "INPUT1SELECT was never set, so its input is GPIO0, the output of EPWM1A"),
    ("EPwm4Regs.TZCLR.bit.OST = 1;", "", "flag-not-cleared", "TZCLR.bit.INT = 1", "TZFLG.OST is still set"),
    ("EPwm4Regs.TZCLR.bit.INT = 1;", "", "flag-not-cleared", "interrupt void tripped", "TZFLG.INT is still set"),
])  # fmt: skip
def test_a_trip_that_is_not_set_up_whole(tmp_path: Path, was: str, now: str, rule: str, at: str, why: str) -> None:
    assert TRIPPED.count(was) == 1
    text = TRIPPED.replace(was, now)
    lines = text.splitlines()
    if "INPUT2" in now:
        text = text.replace("    InputXbarRegs.INPUT1SELECT = 40;\n", "")
        lines = text.splitlines()
    (finding,) = told(tmp_path, text, rule, seconds=0.06)
    assert finding.place is not None
    assert at in lines[finding.place.line - 1]
    assert why in finding.message


@pytest.mark.parametrize(("was", "now"), [
    ("", ""),
    # A trip zone of its own pin, and one whose input is GPIO0, a pin that stays an input.
    ("InputXbarRegs.INPUT1SELECT = 40;", "InputXbarRegs.INPUT1SELECT = 0;"),
    ("InputXbarRegs.INPUT1SELECT = 40;", "InputXbarRegs.INPUT2SELECT = 40;"),
    # High impedance is chosen.
    ("EPwm4Regs.TZCTL.bit.TZA = TZ_FORCE_LO;", "EPwm4Regs.TZCTL.bit.TZA = TZ_HIZ;"),
    # Only one output is delayed: no pair.
    ("GpioCtrlRegs.GPAMUX1.bit.GPIO7 = 1;", "EPwm4Regs.DBCTL.bit.OUT_MODE = DBA_ENABLE; Trips = 0;"),
])  # fmt: skip
def test_a_trip_that_is_right_is_told_nothing(tmp_path: Path, was: str, now: str) -> None:
    text = TRIPPED.replace(was, now) if was else TRIPPED
    if "DBA_ENABLE" in now:
        text = text.replace("EPwm4Regs.DBCTL.bit.OUT_MODE = DB_FULL_ENABLE;", "")
    for rule in ("not-connected", "trip-open", "flag-not-cleared"):
        assert not told(tmp_path, text, rule, seconds=0.06)


#: The input of a one-shot trip: chosen before its pin is, which is GPIO0 out of reset, and low.
AT_ONCE = TRIPPED.replace("TZSEL.bit.CBC1", "TZSEL.bit.OSHT1").replace("    EPwm4Regs.TZEINT.bit.OST = 1;\n", "")
AT_ONCE = AT_ONCE.replace("    EPwm4Regs.TZCLR.bit.OST = 1;\n", "").replace("EPwm4Regs.TZFRC.bit.OST = 1;", "")
PIN = "    InputXbarRegs.INPUT1SELECT = 40;\n    GpioCtrlRegs.GPBPUD.bit.GPIO40 = 0;\n"


@pytest.mark.parametrize(("was", "now", "found"), [
    ("", "", 1),
    # The pin is chosen before; its pull-up comes too late; the flag is cleared, at the end of the set-up or later.
    ("    EPwm4Regs.TZSEL", f"{PIN}    DELAY_US(5);\n    EPwm4Regs.TZSEL", 0),
    ("    EPwm4Regs.TZSEL", "    InputXbarRegs.INPUT1SELECT = 40;\n    EPwm4Regs.TZSEL", 1),
    ("    EINT;", "    EALLOW; EPwm4Regs.TZCLR.bit.OST = 1; EDIS;\n    EINT;", 0),
    ("    for (;;) {", "    for (;;) {\n        if (Order) { EALLOW; EPwm4Regs.TZCLR.bit.OST = 1; EDIS; }", 0),
    ("    EPwm4Regs.TZSEL.bit.OSHT1 = 1;", "", 0),
])  # fmt: skip
def test_a_trip_that_comes_with_its_set_up_and_stays(tmp_path: Path, was: str, now: str, found: int) -> None:
    text = AT_ONCE.replace(was, now, 1) if was else AT_ONCE
    assert was in AT_ONCE
    findings = [f for f in told(tmp_path, text, seconds=0.06) if f.object == "EPwm4Regs.TZSEL"]
    assert len(findings) == found
    for finding in findings:
        assert finding.place is not None
        assert "TZSEL.bit.OSHT1" in text.splitlines()[finding.place.line - 1]
        assert "is tripped from its set-up on" in finding.message


#: CAN-A sends to itself, and takes what comes.
CAN = """#include "F28x_Project.h"
volatile Uint16 Seen;
static void Wait(void)
{
    while (CanaRegs.CAN_IF1CMD.bit.Busy || CanaRegs.CAN_IF2CMD.bit.Busy)
        ;
}
void main(void)
{
    InitSysCtrl();
    CanaRegs.CAN_CTL.bit.Init = 1;
    CanaRegs.CAN_CTL.bit.CCE = 1;
    CanaRegs.CAN_BTR.all = 19uL | (13uL << 8) | (4uL << 12);
    CanaRegs.CAN_CTL.bit.CCE = 0;
    CanaRegs.CAN_IF1ARB.all = 0xA0000000uL | (0x55uL << 18);
    CanaRegs.CAN_IF1MCTL.all = 0x0088uL;
    CanaRegs.CAN_IF1CMD.all = 0x00B00003uL;
    CanaRegs.CAN_IF2ARB.all = 0x80000000uL | (0x55uL << 18);
    CanaRegs.CAN_IF2MCTL.all = 0x0088uL;
    CanaRegs.CAN_IF2CMD.all = 0x00B00004uL;
    Wait();
    CanaRegs.CAN_CTL.bit.Test = 1;
    CanaRegs.CAN_TEST.bit.LBACK = 1;
    CanaRegs.CAN_CTL.bit.Init = 0;
    for (;;) {
        if (Seen < 3) {
            CanaRegs.CAN_IF1DATA.all = Seen + 1;
            CanaRegs.CAN_IF1CMD.all = 0x00870003uL;
            Wait();
        }
        DELAY_US(400);
        if (CanaRegs.CAN_NDAT_21 & 8uL) {
            CanaRegs.CAN_IF2CMD.all = 0x00070004uL;
            Wait();
            Seen++;
        }
    }
}
"""
#: Line 0 of the controller is let through to a routine, which the program may enable in two places.
GOT = """    EALLOW;
    PieVectTable.CANA0_INT = &got;
    EDIS;
    CanaRegs.{};
    CanaRegs.{};
    PieCtrlRegs.PIEIER9.bit.INTx5 = 1;
    IER |= M_INT9;
    EINT;
    for (;;) {{
"""


@pytest.mark.parametrize(("was", "now", "rule", "why"), [
    ("", "", "", ""),
    ("    CanaRegs.CAN_CTL.bit.Init = 0;\n", "", "not-connected", "CanaRegs.CAN_CTL.Init = 1"),
    ("0x80000000uL | (0x55uL << 18)", "(0x55uL << 18)", "not-connected", "sets CanaRegs.CAN_IF2ARB.MsgVal"),
    ("0x00870003uL", "0x00830003uL", "not-connected", "no statement sets TxRqst"),
    ("0x00070004uL", "0x00030004uL", "flag-not-cleared", "NewDat of object 4"),
    ("0x80000000uL | (0x55uL << 18)", "0x80000000uL | (0x55uL << 17)", "not-connected", "for identifier 0x2a"),
    ("0x80000000uL | (0x55uL << 18)", "0x80000000uL | 0x55uL", "not-connected", "0x55 is below bits 28 to 18"),
    ("if (CanaRegs.CAN_NDAT_21 & 8uL) {", "if (CanaRegs.CAN_NDAT_21 & 16uL) {", "not-connected", "never reads"),
    # Bits below an identifier of 11 bits that is where it belongs are ignored, as those of an extended one are used.
    ("0x80000000uL | (0x55uL << 18)", "0x80000000uL | (0x55uL << 18) | 1", "", ""),
    ("0xA0000000uL | (0x55uL << 18)", "0xE0000000uL | 0x55uL", "not-connected", "for identifier 0x55"),
    ("0xA0000000uL | (0x55uL << 18)", "0x80000000uL | (0x55uL << 18)", "not-connected", "TxRqst sends a remote frame"),
    # Another object takes what this one does not want.
    ("    CanaRegs.CAN_IF2MCTL.all = 0x0088uL;\n    CanaRegs.CAN_IF2CMD.all = 0x00B00004uL;\n",
     "    CanaRegs.CAN_IF2MCTL.all = 0x0088uL;\n    CanaRegs.CAN_IF2CMD.all = 0x00B00004uL;\n    Wait();\n"
     "    CanaRegs.CAN_IF2ARB.all = 0x80000000uL | (0x77uL << 18);\n    CanaRegs.CAN_IF2CMD.all = 0x00B00005uL;\n",
     "", ""),
    # Its interrupt goes nowhere.
    ("    for (;;) {\n", GOT.format("CAN_GLB_INT_EN.bit.GLBINT0_EN = 1", "CAN_CTL.bit.IE0 = 1"), "", ""),
    ("    for (;;) {\n", GOT.format("CAN_CTL.bit.IE0 = 1", "CAN_CTL.bit.IE0 = 1"), "not-connected", "GLBINT0_EN = 0"),
    ("    for (;;) {\n", GOT.format("CAN_GLB_INT_EN.bit.GLBINT0_EN = 1", "CAN_GLB_INT_EN.bit.GLBINT0_EN = 1"),
     "not-connected", "CAN_CTL.IE0 = 0"),
    # Whether its data are new is not asked.
    ("if (CanaRegs.CAN_NDAT_21 & 8uL) {\n            CanaRegs.CAN_IF2CMD.all = 0x00070004uL",
     "{\n            CanaRegs.CAN_IF2CMD.all = 0x00030004uL", "", ""),
])  # fmt: skip
def test_a_can_controller_that_is_not_set_up_whole(tmp_path: Path, was: str, now: str, rule: str, why: str) -> None:
    assert not was or CAN.count(was) == 1
    text = CAN.replace(was, now) if was else CAN
    if "&got" in now:
        got = "interrupt void got(void) { PieCtrlRegs.PIEACK.all = PIEACK_GROUP9; }\n"
        text = text.replace("void main", f"{got}void main")
    found = [f for name in ("not-connected", "flag-not-cleared") for f in told(tmp_path, text, name, seconds=0.01)]
    assert [f.rule for f in found] == [rule] * bool(rule)
    assert all(why in f.message and f.place is not None for f in found)
    if "GLBINT0_EN = 0" in why:  # no statement writes that register: the other enable of the line is the place
        assert [f.place and "IE0 = 1" in text.splitlines()[f.place.line - 1] for f in found] == [True]


#: Object 4 has a mask, and there are objects behind it, one of which has no mask.
MASKED = """    CanaRegs.CAN_IF2MSK.all = {};
    CanaRegs.CAN_IF2MCTL.all = 0x1088uL;
    CanaRegs.CAN_IF2CMD.all = 0x00F00004uL;
    Wait();
    CanaRegs.CAN_IF2ARB.all = {};
    CanaRegs.CAN_IF2MCTL.all = {};
    CanaRegs.CAN_IF2CMD.all = 0x00F00005uL;
"""
OWN = "0x80000000uL | (0x77uL << 18)"


@pytest.mark.parametrize(("mask", "behind", "control", "why"), [
    ("0x1FFC0000uL", OWN, "0x0088uL", ""),
    ("0x7FFuL", OWN, "0x0088uL", "its mask 0x7ff has none of bits 28 to 18"),
    ("0x7FFuL", "0", "0x0088uL", "its mask 0x7ff has none of bits 28 to 18"),
    # One object may take every frame, if the others come first, or take every one too.
    ("0uL", OWN, "0x0088uL", "its mask is 0, so object 5 never gets one"),
    ("0uL", "0", "0x0088uL", ""),
    ("0uL", OWN, "0x1088uL", ""),
    ("0uL", "0xA0000000uL | (0x77uL << 18)", "0x0088uL", ""),
    # Without UMask the mask is not used.
    ("0x7FFuL", OWN, "", ""),
])  # fmt: skip
def test_a_message_object_whose_mask_asks_for_nothing(
    tmp_path: Path, mask: str, behind: str, control: str, why: str
) -> None:
    text = MASKED.format(mask, behind, control or "0x0088uL")
    if not control:
        text = text.replace("0x1088uL", "0x0088uL")
    lines = "    CanaRegs.CAN_IF2MCTL.all = 0x0088uL;\n    CanaRegs.CAN_IF2CMD.all = 0x00B00004uL;\n"
    assert CAN.count(lines) == 1
    text = CAN.replace(lines, text)
    findings = [f for f in told(tmp_path, text, seconds=0.01) if "takes every frame" in f.message]
    assert [why in f.message for f in findings] == [True] * bool(why)
    assert all(f.place and "IF2MSK" in text.splitlines()[f.place.line - 1] for f in findings)


@pytest.mark.parametrize(("control", "told_"), [("0x0088uL", True), ("0x0288uL", False)])
def test_a_message_object_may_wait_for_a_remote_frame(tmp_path: Path, control: str, told_: bool) -> None:
    text = CAN.replace("0x00870003uL", "0x00830003uL").replace("IF1MCTL.all = 0x0088uL", f"IF1MCTL.all = {control}")
    found = told(tmp_path, text, "not-connected", seconds=0.01)
    assert any("no statement sets TxRqst" in f.message for f in found) == told_


#: A node that sends 0x123 each millisecond, with 500 kbit/s.
MASTER = """
from emulator.can_bus import CanFrame, CanPart
from emulator.clock import CYCLES_PER_MS
from hil.board import Board


class Master(Board):
    def solder(self):
        node = self.on_can("master", CanPart(500_000), bus="A")
        for ms in range(1, 9):
            self.clock.schedule(ms * CYCLES_PER_MS, lambda: node.send(CanFrame(0x123, b"12")))
"""


@pytest.mark.parametrize(("prescaler", "rates"), [(20, ""), (10, "1000000 bits a second, and the bus has 500000")])
def test_a_can_controller_of_another_bit_rate(tmp_path: Path, prescaler: int, rates: str) -> None:
    board = tmp_path / "master.py"
    board.write_text(MASTER, encoding="utf-8")
    text = CAN.replace("    CanaRegs.CAN_CTL.bit.Test = 1;\n    CanaRegs.CAN_TEST.bit.LBACK = 1;\n", """    EALLOW;
    GpioCtrlRegs.GPBGMUX1.bit.GPIO36 = 1;
    GpioCtrlRegs.GPBMUX1.bit.GPIO36 = 2;
    GpioCtrlRegs.GPBGMUX1.bit.GPIO37 = 1;
    GpioCtrlRegs.GPBMUX1.bit.GPIO37 = 2;
    EDIS;
""")
    file = tmp_path / "drv.c"
    file.write_text(text.replace("19uL |", f"{prescaler - 1}uL |"), encoding="utf-8")
    wanted = DriverFiles([file], seconds=0.01, board=load(str(board)), board_named=True)
    found = [f for f in check_files(wanted).findings if f.rule == "serial-rate"]
    assert [rates in f.message for f in found] == [True] * bool(rates)
    for finding in found:
        assert finding.place is not None
        assert "CAN_BTR" in file.read_text().splitlines()[finding.place.line - 1]


#: CAN-A takes 0x123 from the node, with its pins GPIO36 and GPIO37.
_SET_UP = CAN.index("    CanaRegs.CAN_IF1ARB")
LISTENER = CAN[:_SET_UP] + """    CanaRegs.CAN_IF2ARB.all = 0x80000000uL | (0x123uL << 18);
    CanaRegs.CAN_IF2MCTL.all = 0x0082uL;
    CanaRegs.CAN_IF2CMD.all = 0x00B00004uL;
    Wait();
    GPIO_SetupPinMux(36, GPIO_MUX_CPU1, 6);
    GPIO_SetupPinMux(37, GPIO_MUX_CPU1, 6);
    CanaRegs.CAN_CTL.bit.Init = 0;
""" + CAN[CAN.index("    for (;;) {") :].replace("Seen < 3", "0")
SENDING = ("CAN_IF2MCTL.all = 0x0082uL;", """CAN_IF2MCTL.all = 0x0082uL;
    CanaRegs.CAN_IF1ARB.all = 0xA0000000uL | (0x55uL << 18);
    CanaRegs.CAN_IF1MCTL.all = 0x0088uL;
    CanaRegs.CAN_IF1CMD.all = 0x00B00003uL;""")


@pytest.mark.parametrize("sends", [False, True])
@pytest.mark.parametrize(("was", "told_at"), [
    ("", ""), ("    GPIO_SetupPinMux(36, GPIO_MUX_CPU1, 6);\n", "Init = 0"),
    ("    GPIO_SetupPinMux(37, GPIO_MUX_CPU1, 6);\n", "Init = 0"),
])  # fmt: skip
def test_a_can_controller_without_a_pin_is_told_where_it_joins_the_bus(
    tmp_path: Path, was: str, told_at: str, sends: bool
) -> None:
    board = tmp_path / "master.py"
    board.write_text(MASTER, encoding="utf-8")
    text = LISTENER.replace(was, "") if was else LISTENER
    if sends:
        text = text.replace(*SENDING).replace("if (0)", "if (Seen < 3)")
    file = tmp_path / "drv.c"
    file.write_text(text, encoding="utf-8")
    wanted = DriverFiles([file], seconds=0.01, board=load(str(board)), board_named=True)
    found = [f for f in check_files(wanted).findings if f.rule in ("not-configured", "not-connected")]
    assert [f.object for f in found] == ["CANA"] * bool(told_at)
    assert all(f.place is not None and told_at in text.splitlines()[f.place.line - 1] for f in found)


@pytest.mark.parametrize(("statement", "silent"), [
    ("EPwm2Regs.CMPA.bit.CMPA = 20002 + (Count & 1);", False),
    ("EPwm2Regs.CMPA.bit.CMPA = 20000 + (Count & 1);", True),  # one above is 100 %
    # All values are known: 20 % and 80 % of a period that is twice as long, or of this one.
    ("{ static Uint16 pct; pct = Count & 1 ? 80 : 20; EPwm2Regs.CMPA.bit.CMPA = (Uint32)pct * 40000 / 100; }", False),
    ("{ static Uint16 pct; pct = Count & 1 ? 80 : 20; EPwm2Regs.CMPA.bit.CMPA = (Uint32)pct * 20000 / 100; }", True),
    ("EPwm2Regs.CMPA.bit.CMPA = Count & 1 ? 0xFFFF : 5;", True),
    ("EPwm2Regs.CMPA.bit.CMPA = 0xFFFF;", True),
    ("EPwm2Regs.CMPA.bit.CMPA = 30000 + Count; EPwm2Regs.TBPRD = 60000;", True),  # for a longer period
    ("EPwm2Regs.TBPRD = 60000; EPwm2Regs.CMPA.bit.CMPA = 30000 + Count;", True),
])  # fmt: skip
def test_a_compare_value_that_is_computed_beyond_the_period(tmp_path: Path, statement: str, silent: bool) -> None:
    tick = "interrupt void tick(void) { Count++; "
    text = RIGHT.replace(tick, f"{tick}\n{statement}\n")
    found = told(tmp_path, text, "compare-above-period", seconds=0.006)
    assert [f.place.line for f in found if f.place] == ([] if silent else [text.splitlines().index(statement) + 1])


def test_a_constant_beyond_the_period_does_not_hide_a_computed_one(tmp_path: Path) -> None:
    statement = "EPwm2Regs.CMPA.bit.CMPA = 20100 + (Count & 1);"
    tick = "interrupt void tick(void) { Count++; "
    constant = "EPwm2Regs.CMPA.bit.CMPA = 20050; "
    text = RIGHT.replace(tick, f"{tick}{constant}\n{statement}\n")
    found = told(tmp_path, text, "compare-above-period", seconds=0.02)
    assert [f.place.line for f in found if f.place] == [text.splitlines().index(statement) + 1]


@pytest.mark.parametrize("runs", [True, False])
def test_a_latch_that_is_read_behind_the_flag_of_a_unit_that_never_ends(tmp_path: Path, runs: bool) -> None:
    text = RIGHT.replace("Count = 0; Put", "if (EQep1Regs.QFLG.bit.UTO) Count = EQep1Regs.QPOSLAT; Put")
    text = text.replace("    EQep1Regs.QEINT.bit.UTO = 1;\n", "").replace(
        "    PieCtrlRegs.PIEIER5.bit.INTx1 = 1;\n", ""
    )
    text = text.replace("    EQep1Regs.QUPRD", "    EQep1Regs.QEPCTL.bit.QCLM = 1;\n    EQep1Regs.QUPRD")
    if not runs:
        text = text.replace("EQep1Regs.QEPCTL.bit.UTE = 1;", "")
    found = [f for f in told(tmp_path, text) if "QPOSLAT" in f.message]
    assert ["QEPCTL.UTE = 0" in f.message for f in found] == [True] * (not runs)


@pytest.mark.parametrize(("line", "setting", "why"), [
    (1, "SpiaRegs.SPIFFTX.all = 0xE040; SpiaRegs.SPIFFRX.all = 0x6061;", ""),
    (1, "SpiaRegs.SPIFFTX.all = 0xE040; SpiaRegs.SPIFFRX.all = 0x6041;", "SPIFFRX.RXFFIENA = 0"),
    (1, "SpiaRegs.SPIFFTX.all = 0xE040; SpiaRegs.SPIFFRX.all = 0x6041; SpiaRegs.SPICTL.bit.OVERRUNINTENA = 1;", ""),
    (1, "SpiaRegs.SPIFFTX.all = 0xE040; if (Order) SpiaRegs.SPIFFRX.bit.RXFFIENA = 1;", ""),
    (1, "SpiaRegs.SPICTL.bit.SPIINTENA = 1;", ""),
    (1, "SpiaRegs.SPICTL.bit.TALK = 1;", "SPICTL.SPIINTENA = 0"),
    (2, "SpiaRegs.SPIFFTX.all = 0xE060;", ""),
    (2, "SpiaRegs.SPIFFTX.all = 0xE040;", "SPIFFTX.TXFFIENA = 0"),
    (2, "SpiaRegs.SPICTL.bit.SPIINTENA = 1;", "SPIFFTX.SPIFFENA = 0"),
])  # fmt: skip
def test_an_interrupt_of_the_spi_is_enabled_there_too(tmp_path: Path, line: int, setting: str, why: str) -> None:
    vector = "SPIA_RX_INT" if line == 1 else "SPIA_TX_INT"
    text = RIGHT.replace("    EALLOW;\n", f"    EALLOW;\n    PieVectTable.{vector} = &edge;\n    {GATE}\n", 1)
    setting += f"\n    PieCtrlRegs.PIEIER6.bit.INTx{line} = 1;"
    text = text.replace("    IER |=", f"    {setting}\n    IER |= M_INT6 |")
    assert [why in finding.message for finding in told(tmp_path, text)] == [True] * bool(why)


@pytest.mark.parametrize(("vector", "setting", "why"), [
    ("SCIB_RX_INT", "ScibRegs.SCICTL2.all = 2;", ""),
    ("SCIB_RX_INT", "ScibRegs.SCICTL2.all = 1;", "SCICTL2.RXBKINTENA = 0"),
    ("SCIB_RX_INT", "ScibRegs.SCICTL1.bit.RXERRINTENA = 1;", ""),
    ("SCIB_RX_INT", "ScibRegs.SCIFFTX.all = 0xE040; ScibRegs.SCIFFRX.all = 0x2061;", ""),
    ("SCIB_RX_INT", "ScibRegs.SCIFFTX.all = 0xE040; ScibRegs.SCIFFRX.all = 0x2041;", "SCIFFRX.RXFFIENA = 0"),
    ("SCIB_TX_INT", "if (Order) ScibRegs.SCICTL2.bit.TXINTENA = 1;", ""),
    ("SCIB_TX_INT", "ScibRegs.SCICTL2.all = 2;", "SCICTL2.TXINTENA = 0"),
    ("SCIB_TX_INT", "ScibRegs.SCIFFTX.all = 0xE040;", "SCIFFTX.TXFFIENA = 0"),
    ("I2CA_INT", "I2caRegs.I2CIER.all = 0x20;", ""),
    ("I2CA_INT", "I2caRegs.I2CMDR.all = 0x20;", "I2CIER = 0"),
    ("DMA_CH2_INT", "EALLOW; DmaRegs.CH2.MODE.bit.CHINTE = 0; EDIS;", "MODE.CHINTE = 0"),
])  # fmt: skip
def test_an_interrupt_of_a_serial_module_or_the_dma_is_enabled_there_too(
    tmp_path: Path, vector: str, setting: str, why: str
) -> None:
    group, line = {"SCIB_RX_INT": (9, 3), "SCIB_TX_INT": (9, 4), "I2CA_INT": (8, 1), "DMA_CH2_INT": (7, 2)}[vector]
    text = RIGHT.replace("    EALLOW;\n", f"    EALLOW;\n    PieVectTable.{vector} = &edge;\n", 1)
    setting = f"{setting}\n    PieCtrlRegs.PIEIER{group}.bit.INTx{line} = 1;"
    text = text.replace("    IER |=", f"    {setting}\n    IER |= M_INT{group} |")
    assert [why in finding.message for finding in told(tmp_path, text)] == [True] * bool(why)


#: A module is set up through a pointer; its trip comes from comparator 1 by TRIP4 of the X-BAR.
POINTED = TRIPPED.replace("void main(void)", """static void Set_Up(volatile struct EPWM_REGS *pwm)
{
    EALLOW;
    pwm->TZCTL.bit.TZA = TZ_FORCE_LO;
    pwm->TZCTL.bit.TZB = TZ_FORCE_LO;
    pwm->DCTRIPSEL.bit.DCAHCOMPSEL = 3;
    pwm->TZDCSEL.bit.DCAEVT1 = TZ_DCAH_HI;
    pwm->TZSEL.bit.DCAEVT1 = 1;
    EDIS;
    pwm->DBCTL.bit.POLSEL = DB_ACTV_HIC;
    pwm->DBCTL.bit.OUT_MODE = DB_FULL_ENABLE;
    pwm->DBRED.bit.DBRED = 20;
}
void main(void)""").replace("    InputXbarRegs.INPUT1SELECT = 40;", """    CpuSysRegs.PCLKCR14.bit.CMPSS1 = 1;
    Cmpss1Regs.COMPCTL.bit.COMPDACE = 1;
    Cmpss1Regs.DACHVALS.bit.DACVAL = 4000;
    EPwmXbarRegs.TRIP4MUXENABLE.bit.MUX0 = 1;
    Set_Up(&EPwm4Regs);
    EALLOW;
    InputXbarRegs.INPUT1SELECT = 40;""")
for line in ("TZCTL.bit.TZA = TZ_FORCE_LO", "TZCTL.bit.TZB = TZ_FORCE_LO", "DBCTL.bit.POLSEL = DB_ACTV_HIC",
             "DBCTL.bit.OUT_MODE = DB_FULL_ENABLE", "DBRED.bit.DBRED = 20"):  # fmt: skip
    POINTED = POINTED.replace(f"    EPwm4Regs.{line};\n", "")


@pytest.mark.parametrize(("was", "at", "why"), [
    ("Cmpss1Regs.COMPCTL.bit.COMPDACE = 1;", "DCAHCOMPSEL = 3", "comparator 1 is off"),
    ("EPwmXbarRegs.TRIP4MUXENABLE.bit.MUX0 = 1;", "DCAHCOMPSEL = 3", "no mux of it is enabled"),
    ("pwm->TZDCSEL.bit.DCAEVT1 = TZ_DCAH_HI;", "TZSEL.bit.DCAEVT1 = 1", "names no condition"),
    ("pwm->DBCTL.bit.OUT_MODE = DB_FULL_ENABLE;", "POLSEL", "the dead band is bypassed"),
    ("", "", ""),
])  # fmt: skip
def test_a_block_that_only_a_pointer_names(tmp_path: Path, was: str, at: str, why: str) -> None:
    assert POINTED.count(was) == 1 or not was
    text = POINTED.replace(was, "") if was else POINTED
    findings = told(tmp_path, text, "not-connected", seconds=0.01)
    assert [why in f.message for f in findings] == [True] * bool(was)
    assert all(f.place is not None and at in text.splitlines()[f.place.line - 1] for f in findings)


@pytest.mark.parametrize("by", [
    "for (i = 0; i < 1; i++) Set_Up(Modules[i]);", "Set_Up(Rows[i].regs);",
    "volatile struct EPWM_REGS *p = &EPwm4Regs; Set_Up(p);",
])  # fmt: skip
def test_a_block_that_a_table_or_a_local_names(tmp_path: Path, by: str) -> None:
    text = POINTED.replace("Set_Up(&EPwm4Regs);", f"{{ Uint16 i = 0; {by} (void)i; }}")
    text = text.replace("static void Set_Up", """static volatile struct EPWM_REGS * const Modules[1] = {&EPwm4Regs};
static const struct { Uint16 pin; volatile struct EPWM_REGS *regs; } Rows[1] = {{6, &EPwm4Regs}};
static void Set_Up""")
    assert told(tmp_path, text, seconds=0.01) == []
    (finding,) = told(tmp_path, text.replace("pwm->TZDCSEL.bit.DCAEVT1 = TZ_DCAH_HI;", ""), seconds=0.01)
    assert "names no condition" in finding.message


#: A timer, and a pin whose edges are an external interrupt; LINES enables their lines, LATER is done in each turn.
TWO_LINES = """#include "F28x_Project.h"
volatile Uint16 Ticks = 0, Edges = 0;
__interrupt void Tick(void) { Ticks++; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; }
__interrupt void Edge(void) { Edges++; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; }
void main(void)
{
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0; IFR = 0;
    InitPieVectTable();
    EALLOW;
    PieVectTable.TIMER0_INT = &Tick;
    PieVectTable.XINT1_INT = &Edge;
    InputXbarRegs.INPUT4SELECT = 5;
    EDIS;
    GPIO_SetupPinMux(5, GPIO_MUX_CPU1, 0);
    GPIO_SetupPinOptions(5, GPIO_OUTPUT, GPIO_PUSHPULL);
    XintRegs.XINT1CR.bit.POLARITY = 3;
    XintRegs.XINT1CR.bit.ENABLE = 1;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    CpuTimer0Regs.TCR.all = 0x4000;
    LINES
    IER |= M_INT1;
    EINT;
    for (;;) { DELAY_US(500); GpioDataRegs.GPATOGGLE.bit.GPIO5 = 1; LATER }
}
"""
TIMER_LINE, EDGE_LINE = "PieCtrlRegs.PIEIER1.bit.INTx7 = 1;", "PieCtrlRegs.PIEIER1.bit.INTx4 = 1;"


@pytest.mark.parametrize(("lines", "later", "at"), [
    (TIMER_LINE, "", "PieVectTable.XINT1_INT"),
    (EDGE_LINE, "", "PieVectTable.TIMER0_INT"),
    (TIMER_LINE + EDGE_LINE, "", ""),
    ("PieCtrlRegs.PIEIER1.all = 0x48;", "", ""),
    (TIMER_LINE, f"if (Ticks > 9999) {EDGE_LINE}", ""),
    (TIMER_LINE, "if (PieCtrlRegs.PIEIFR1.bit.INTx4) Edges++;", ""),
    (TIMER_LINE, "PieCtrlRegs.PIEIFR1.bit.INTx4 = 0;", ""),
])  # fmt: skip
def test_a_routine_whose_line_is_never_enabled(tmp_path: Path, lines: str, later: str, at: str) -> None:
    text = TWO_LINES.replace("LINES", lines).replace("LATER", later)
    findings = told(tmp_path, text, seconds=0.005)
    assert [f.object for f in findings] == [at] * bool(at)
    assert all(f.place is not None and f"{at} =" in text.splitlines()[f.place.line - 1] for f in findings)


@pytest.mark.parametrize("starts", [
    "AdcaRegs.ADCSOCFRC1.bit.SOC9 = 1;", "AdcaRegs.ADCSOCFRC1.all = 0x0200;",
    "EALLOW; AdcaRegs.ADCINTSOCSEL2.bit.SOC9 = 1; EDIS;", "EALLOW; AdcaRegs.ADCBURSTCTL.bit.BURSTEN = 1; EDIS;",
    "EALLOW; AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0; EDIS;",
])  # fmt: skip
def test_a_soc_that_a_statement_may_start_is_no_missing_trigger(tmp_path: Path, starts: str) -> None:
    text = RIGHT.replace("INT1E = 1;", "INT1E = 1; AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 9;")
    assert len(told(tmp_path, text)) == 1
    assert told(tmp_path, text.replace("Count = 0;", f"if (Order) {{ {starts} }}")) == []


#: Timer N counts the turns of a stirrer, which `main` stops after 3 ms; GIVE lets the interrupts through.
STIRRER = """#include "F28x_Project.h"
volatile Uint16 Ticks = 0, Turns = 0, Stirs = 1;
__interrupt void Tick(void) { Ticks++; PieCtrlRegs.PIEACK.all = PIEACK_GROUP1; }
__interrupt void Turn(void) { if (Stirs) Turns++; }
void main(void)
{
""" + START_UP + """    EALLOW;
    PieVectTable.TIMER0_INT = &Tick;
    PieVectTable.TIMER1_INT = &Turn;
    EDIS;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    ConfigCpuTimer(&CpuTimer1, 200, 700);
    StartCpuTimer0();
    StartCpuTimer1();
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    GIVE
    EINT;
    for (;;)
        if (Ticks > 3 && Stirs)
        {
            StopCpuTimer1();
            Stirs = 0;
        }
}
"""


@pytest.mark.parametrize(("give", "at"), [
    ("IER |= M_INT1 | M_INT13;", ""),
    ("IER |= M_INT13; IER |= M_INT1;", ""),
    ("IER = M_INT13 | M_INT1; DELAY_US(10); IER = M_INT1;", "Turn"),  # before the interrupt can come
    ("IER = M_INT13; EINT; DELAY_US(2000); IER = M_INT1;", ""),  # it has come
    ("IER |= M_INT1;", "Turn"),
    ("IER |= M_INT1 | M_INT14;", "Turn"),
    ("IER |= M_INT1; while ((IFR & M_INT13) == 0) {}", ""),  # it asks for it itself
])  # fmt: skip
@pytest.mark.parametrize("timer", [1, 2])
def test_a_timer_that_the_program_has_stopped_has_asked_before(
    tmp_path: Path, give: str, at: str, timer: int
) -> None:
    text = STIRRER.replace("GIVE", give)
    if timer == 2:
        both = {"M_INT13": "M_INT14", "M_INT14": "M_INT13"}
        text = re.sub("M_INT1[34]", lambda bit: both[bit.group()], text)
        text = text.replace("TIMER1", "TIMER2").replace("Timer1", "Timer2")
    findings = told(tmp_path, text, seconds=0.008)
    assert [f.message.split()[0] for f in findings] == [at] * bool(at)
    assert all(f"waits for CPU timer {timer}, which has run out" in f.message for f in findings)
    lines = text.splitlines()
    assert all(f.place is not None and "IER " in lines[f.place.line - 1] for f in findings)


@pytest.mark.parametrize(("others", "count"), [("", 1), ("XINT1_INT", 1), ("XINT1_INT XINT2_INT XINT3_INT", 0)])
def test_a_handler_of_all_vectors_waits_for_no_timer(tmp_path: Path, others: str, count: int) -> None:
    entered = "".join(f"PieVectTable.{entry} = &{'Turn' if count == 0 else 'Tick'}; " for entry in others.split())
    text = STIRRER.replace("GIVE", "IER |= M_INT1;").replace("EDIS;\n    InitCpu", f"{entered}EDIS;\n    InitCpu")
    findings = told(tmp_path, text, seconds=0.008)
    assert ["waits for CPU timer 1" in f.message for f in findings] == [True] * count


@pytest.mark.parametrize(("bits", "count"), [("M_INT9", 1), ("M_INT1 | M_INT9", 0)])
def test_a_line_that_is_enabled_for_a_while_is_let_through_by_ier_too(tmp_path: Path, bits: str, count: int) -> None:
    # The program takes the line away for good after half of the time.
    text = TWO_LINES.replace("LINES", TIMER_LINE + EDGE_LINE).replace("IER |= M_INT1;", f"IER |= {bits};")
    text = text.replace("LATER", "if (++Turns == 4) PieCtrlRegs.PIEIER1.all = 0;")
    text = text.replace("Edges = 0;", "Edges = 0, Turns = 0;")
    findings = told(tmp_path, text, seconds=0.005)
    assert len(findings) == 2 * count
    assert all("is enabled at times, has come and never occurs: bit 0 of IER" in f.message for f in findings)


#: A fan: the demand of an order goes to the duty of ePWM3, in the mode COUNTING, with ACTIONS.
FAN = """#include "F28x_Project.h"
volatile Uint16 Demand = 0;
void Blow(Uint16 permille) { EPwm3Regs.CMPA.bit.CMPA = (Uint16)((Uint32)permille * 2500 / 1000); LATER }
void main(void)
{
""" + START_UP + """    GPIO_SetupPinMux(4, GPIO_MUX_CPU1, 1);
    EPwm3Regs.TBPRD = 2500;
    EPwm3Regs.CMPCTL.bit.LOADAMODE = 0;
    EPwm3Regs.CMPA.bit.CMPA = 0;
    ACTIONS
    EPwm3Regs.TBCTL.bit.CTRMODE = COUNTING;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    for (;;)
    {
        DELAY_US(200);
        if (Demand < MOST)
            Demand += 100;
        Blow(Demand);
    }
}
"""
RISES = "EPwm3Regs.AQCTLA.bit.ZRO = AQ_SET; EPwm3Regs.AQCTLA.bit.CAU = AQ_CLEAR;"
FALLS = "EPwm3Regs.AQCTLA.all = 1 | 2 << 4;"


@pytest.mark.parametrize(("actions", "mode", "most", "later", "told_"), [
    (RISES, "TB_COUNT_UPDOWN", 900, "", "set at zero and cleared at CMPA on the way up only, so that CMPA = 2250"),
    (FALLS, "TB_COUNT_UPDOWN", 900, "", "cleared at zero and set at CMPA on the way up only"),
    (RISES, "TB_COUNT_UP", 900, "", ""),
    (RISES, "TB_COUNT_UPDOWN", 400, "", ""),  # at most half was wanted in this run
    (RISES + " EPwm3Regs.AQCTLA.bit.CAD = AQ_SET;", "TB_COUNT_UPDOWN", 900, "", ""),
    ("EPwm3Regs.AQCTLA.bit.CAU = AQ_CLEAR; EPwm3Regs.AQCTLA.bit.CAD = AQ_SET;", "TB_COUNT_UPDOWN", 900, "", ""),
    (RISES, "TB_COUNT_UPDOWN", 900, "if (Demand > 5000) EPwm3Regs.AQCTLA.bit.CAD = AQ_SET;", ""),
    (RISES, "TB_COUNT_UPDOWN", 900, "if (Demand > 5000) EPwm3Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;", ""),
])  # fmt: skip
def test_an_output_that_changes_on_the_way_up_only(
    tmp_path: Path, actions: str, mode: str, most: int, later: str, told_: str
) -> None:
    text = FAN.replace("ACTIONS", actions).replace("COUNTING", mode).replace("MOST", str(most)).replace("LATER", later)
    findings = told(tmp_path, text, "half-duty", seconds=0.005)
    assert len(findings) == bool(told_)
    assert all(told_ in f.message for f in findings)
    lines = text.splitlines()
    assert all(f.place is not None and "CTRMODE = TB" in lines[f.place.line - 1] for f in findings)


#: Three bridges by a table; `ACTION` is what clears their outputs.
BRIDGES = """#include "F28x_Project.h"
static volatile struct EPWM_REGS * const Bridge[3] = {&EPwm1Regs, &EPwm2Regs, &EPwm3Regs};
volatile Uint16 Duty = 0;
void main(void)
{
    Uint16 i;
    InitSysCtrl();
    EALLOW;
    CpuSysRegs.PCLKCR2.bit.EPWM1 = 1;
    CpuSysRegs.PCLKCR2.bit.EPWM2 = 1;
    CpuSysRegs.PCLKCR2.bit.EPWM3 = 1;
    EDIS;
    InitEPwm1Gpio();
    InitEPwm2Gpio();
    InitEPwm3Gpio();
    for (i = 0; i < 3; i++) {
        Bridge[i]->TBPRD = 2000;
        Bridge[i]->AQCTLA.bit.CAU = AQ_SET;
        ACTION
        Bridge[i]->TBCTL.bit.CTRMODE = TB_COUNT_UPDOWN;
    }
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    for (;;) {
        DELAY_US(100);
        Duty = Duty < 1900 ? Duty + 10 : 0;
        for (i = 0; i < 3; i++)
            Bridge[i]->CMPA.bit.CMPA = Duty;
    }
}
"""


@pytest.mark.parametrize(("action", "count"), [
    ("", 3), ("Bridge[i]->AQCTLA.bit.CAD = AQ_SET;", 3), ("Bridge[i]->AQCTLA.bit.CAD = AQ_CLEAR;", 0),
    ("Bridge[i]->AQCTLA.bit.ZRO = AQ_CLEAR;", 0), ("Bridge[i]->AQCTLA.bit.CAU = AQ_TOGGLE;", 0),
])  # fmt: skip
def test_a_compare_that_only_sets_its_output(tmp_path: Path, action: str, count: int) -> None:
    findings = told(tmp_path, BRIDGES.replace("ACTION", action), "not-connected", seconds=0.002)
    assert [f.object for f in findings] == [f"EPwm{n}Regs.AQCTLA" for n in range(1, count + 1)]
    assert all("only sets output A" in f.message for f in findings)


@pytest.mark.parametrize(("cleared", "later", "told_"), [
    ("AQCTLA.bit.CAD = AQ_CLEAR", "", False),
    ("AQCTLA.bit.CBD = AQ_CLEAR", "", True),
    ("AQCTLA.bit.CBD = AQ_CLEAR", "Bridge[i]->CMPB.bit.CMPB = Duty / 2;", False),
    ("AQCTLA.bit.CBD = AQ_CLEAR", "Bridge[i]->CMPB.all = 0;", False),
    ("AQCTLA.bit.CBD = AQ_CLEAR", "if (Duty > 9000) EPwm2Regs.CMPB.bit.CMPB = Duty;", True),
])  # fmt: skip
def test_a_compare_that_switches_and_that_nobody_sets(tmp_path: Path, cleared: str, later: str, told_: bool) -> None:
    sets = "Bridge[i]->CMPA.bit.CMPA = Duty;"
    text = BRIDGES.replace("ACTION", f"Bridge[i]->{cleared};").replace(sets, f"{{ {sets} {later} }}")
    findings = [f for f in told(tmp_path, text, "not-connected", seconds=0.002) if "CMPB, which stays 0" in f.message]
    ours = [1, 3] if "EPwm2Regs" in later else [1, 2, 3]
    assert [f.object for f in findings] == [f"EPwm{n}Regs.AQCTLA.CBD" for n in (ours if told_ else [])]
    assert all(f.place and "CBD" in text.splitlines()[f.place.line - 1] for f in findings)


#: Two outputs by numbers, whose blocks stand in a table.
NUMBERED = """#include "F28x_Project.h"
#define HALF 0x6AUL
static const Uint32 Block[2] = {0x4000UL, 0x4100UL};
static Uint16 Duty;
static void Put(Uint32 base, Uint32 offset, Uint16 value) { *(volatile Uint16 *)(base + offset) = value; }
static void Set(Uint32 base, Uint32 which, Uint16 value)
{
    Uint32 at = HALF + which;
    *(volatile Uint16 *)(base + at + 1UL) = value;
}
void main(void)
{
    Uint16 i;
    InitSysCtrl();
    EALLOW;
    CpuSysRegs.PCLKCR2.bit.EPWM1 = 1;
    CpuSysRegs.PCLKCR2.bit.EPWM2 = 1;
    EDIS;
    InitEPwm1Gpio();
    InitEPwm2Gpio();
    for (i = 0; i < 2; i++) {
        Uint32 base = Block[i];

        Put(base, 0x63, 2000);
        Set(base, 0, 100);
        Put(base, 0x40, ACTIONS);
        Put(base, 0x00, 0x0002);
    }
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    for (;;) {
        DELAY_US(100);
        Duty = Duty < 1900 ? Duty + 10 : 0;
        for (i = 0; i < 2; i++)
            Set(Block[i], WHICH, Duty);
    }
}
"""


@pytest.mark.parametrize(("actions", "which", "count"), [("0x0090", 0, 0), ("0x0810", 0, 2), ("0x0810", 2, 0)])
def test_a_compare_that_nobody_sets_by_a_number(tmp_path: Path, actions: str, which: int, count: int) -> None:
    text = NUMBERED.replace("ACTIONS", actions).replace("WHICH", str(which))
    findings = [f for f in told(tmp_path, text, "not-connected", seconds=0.002) if "CMPB, which stays 0" in f.message]
    assert [f.object for f in findings] == [f"EPwm{n}Regs.AQCTLA.CBD" for n in (1, 2)][:count]
    assert all(f.place and "ACTIONS" in NUMBERED.splitlines()[f.place.line - 1] for f in findings)


#: ePWM2 moves two outputs and is tripped on order; its counter starts SOC0, whose result is watched; eCAP1 measures
#: GPIO24, while GPIO0 is an output of ePWM1.
PARTS = """#include "F28x_Project.h"
volatile Uint16 Over, Order, Width;
interrupt void over(void)
{
    Over++;
    AdcaRegs.ADCEVTCLR.bit.PPB1TRIPHI = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP10;
}
interrupt void edge(void)
{
    Width = (Uint16)ECap1Regs.CAP1;
    ECap1Regs.ECCLR.bit.CEVT1 = 1;
    ECap1Regs.ECCLR.bit.INT = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP4;
}
void Put(Uint16 a, Uint16 b) { EPwm2Regs.CMPA.bit.CMPA = a; EPwm2Regs.CMPB.bit.CMPB = b; }
void main(void)
{
""" + START_UP + """    EALLOW;
    PieVectTable.ADCA_EVT_INT = &over;
    PieVectTable.ECAP1_INT = &edge;
    GpioCtrlRegs.GPAMUX1.bit.GPIO0 = 1;
    GpioCtrlRegs.GPAMUX1.bit.GPIO2 = 1;
    GpioCtrlRegs.GPAMUX1.bit.GPIO3 = 1;
    InputXbarRegs.INPUT7SELECT = 24;
    EPwm2Regs.TZCTL.bit.TZA = TZ_FORCE_LO;
    EPwm2Regs.TZCTL.bit.TZB = TZ_FORCE_LO;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 14;
    AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 7;
    AdcaRegs.ADCPPB1CONFIG.bit.CONFIG = 0;
    AdcaRegs.ADCPPB1TRIPHI.bit.LIMITHI = 0;
    AdcaRegs.ADCPPB4OFFCAL.bit.OFFCAL = 0x200;
    AdcaRegs.ADCEVTINTSEL.bit.PPB1TRIPHI = 1;
    EDIS;
    EPwm1Regs.TBPRD = 2000;
    EPwm1Regs.CMPA.bit.CMPA = 500;
    EPwm1Regs.AQCTLA.bit.ZRO = AQ_SET;
    EPwm1Regs.AQCTLA.bit.CAU = AQ_CLEAR;
    EPwm1Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    EPwm2Regs.TBPRD = 2000;
    EPwm2Regs.AQCTLA.bit.ZRO = AQ_SET;
    EPwm2Regs.AQCTLA.bit.CAU = AQ_CLEAR;
    EPwm2Regs.AQCTLB.bit.ZRO = AQ_SET;
    EPwm2Regs.AQCTLB.bit.CBU = AQ_CLEAR;
    EPwm2Regs.ETSEL.bit.SOCASEL = ET_CTR_ZERO;
    EPwm2Regs.ETSEL.bit.SOCAEN = 1;
    EPwm2Regs.ETPS.bit.SOCAPRD = ET_1ST;
    EPwm2Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    ECap1Regs.ECCTL1.bit.CAPLDEN = 1;
    ECap1Regs.ECCTL2.bit.TSCTRSTOP = 1;
    ECap1Regs.ECEINT.bit.CEVT1 = 1;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    PieCtrlRegs.PIEIER4.bit.INTx1 = 1;
    PieCtrlRegs.PIEIER10.bit.INTx1 = 1;
    IER |= M_INT4 | M_INT10;
    EINT;
    for (;;) {
        Put(Width + 10, Over + 20);
        if (Order) { EALLOW; EPwm2Regs.TZFRC.bit.OST = 1; EDIS; }
    }
}
"""


@pytest.mark.parametrize(("was", "now", "rule", "at", "why"), [
    ("CBU = AQ_CLEAR", "CAU = AQ_CLEAR", "not-connected", "AQCTLB.bit.CAU", "AQCTLB switches output B at CMPA"),
    ("    EPwm2Regs.AQCTLB.bit.CBU = AQ_CLEAR;\n", "", "not-connected", "AQCTLB.bit.ZRO = AQ_SET", "AQCTLB only sets"),
    ("    EPwm2Regs.AQCTLB.bit.CBU = AQ_CLEAR;\n", "    EPwm2Regs.AQCTLB.bit.PRD = AQ_SET;\n", "not-connected",
     "AQCTLB.bit.PRD = AQ_SET", "AQCTLB only sets output B"),
    ("INPUT7SELECT", "INPUT8SELECT", "not-connected", "INPUT8SELECT", "nothing uses that input"),
    ("TZA = TZ_FORCE_LO;\n    EPwm2Regs.TZCTL.bit.TZB = TZ_FORCE_LO", "TZA = TZ_NO_CHANGE;\n    "
     "EPwm2Regs.TZCTL.bit.TZB = TZ_NO_CHANGE", "not-connected", "TZA = TZ_NO_CHANGE", "go on switching"),
    ("CONFIG = 0", "CONFIG = 1", "not-connected", "CONFIG = 1", "nothing starts SOC1"),
    ("    AdcaRegs.ADCEVTCLR.bit.PPB1TRIPHI = 1;\n", "", "flag-not-cleared", "interrupt void over", "comes once only"),
])  # fmt: skip
def test_a_part_that_is_set_up_for_nobody(tmp_path: Path, was: str, now: str, rule: str, at: str, why: str) -> None:
    assert PARTS.count(was) == 1
    text = PARTS.replace(was, now)
    (finding,) = told(tmp_path, text, rule)
    assert finding.place is not None
    assert at in text.splitlines()[finding.place.line - 1]
    assert why in finding.message


@pytest.mark.parametrize(("was", "now"), [
    ("", ""),
    # The same value for both outputs, of which one has the other's complement.
    ("CBU = AQ_CLEAR", "CAU = AQ_CLEAR; EPwm2Regs.DBCTL.bit.OUT_MODE = DB_FULL_ENABLE"),
    # It toggles; the program clears the output itself, or on order.
    ("EPwm2Regs.AQCTLB.bit.ZRO = AQ_SET;\n    EPwm2Regs.AQCTLB.bit.CBU = AQ_CLEAR",
     "EPwm2Regs.AQCTLB.bit.ZRO = AQ_TOGGLE"),
    ("CBU = AQ_CLEAR", "ZRO = AQ_SET; EPwm2Regs.AQSFRC.bit.OTSFB = 1"),
    ("EPwm2Regs.AQCTLB.bit.CBU = AQ_CLEAR", "if (Order) EPwm2Regs.AQCTLB.bit.CBU = AQ_CLEAR"),
    # Compare B triggers the conversion.
    ("CBU = AQ_CLEAR", "CAU = AQ_CLEAR; EPwm2Regs.ETSEL.bit.SOCASEL = 6"),
    ("INPUT7SELECT", "INPUT8SELECT = 25; ECap2Regs.ECCTL1.bit.CAPLDEN = 1; InputXbarRegs.INPUT7SELECT"),
    # What a trip does stands in the other register; the forced trip is one of the digital compare.
    ("TZA = TZ_FORCE_LO;\n    EPwm2Regs.TZCTL.bit.TZB = TZ_FORCE_LO", "TZA = TZ_NO_CHANGE;\n    "
     "EPwm2Regs.TZCTL.bit.TZB = TZ_NO_CHANGE; EPwm2Regs.TZCTL2.bit.ETZE = 1"),
    ("TZA = TZ_FORCE_LO;\n    EPwm2Regs.TZCTL.bit.TZB = TZ_FORCE_LO", "TZA = TZ_NO_CHANGE;\n    "
     "EPwm2Regs.TZCTL.bit.TZB = TZ_NO_CHANGE;\n#define OST DCAEVT1\n"),
    # A trip that only interrupts.
    ("TZA = TZ_FORCE_LO;\n    EPwm2Regs.TZCTL.bit.TZB = TZ_FORCE_LO", "TZA = TZ_NO_CHANGE;\n    "
     "EPwm2Regs.TZCTL.bit.TZB = TZ_NO_CHANGE; EPwm2Regs.TZEINT.bit.OST = 1"),
    # The program starts SOC1 itself.
    ("CONFIG = 0", "CONFIG = 1; AdcaRegs.ADCSOCFRC1.bit.SOC1 = 1"),
    # The event is kept until an order takes it back.
    ("    AdcaRegs.ADCEVTCLR.bit.PPB1TRIPHI = 1;\n", "    if (Order) AdcaRegs.ADCEVTCLR.bit.PPB1TRIPHI = 1;\n"),
])  # fmt: skip
def test_parts_that_are_right_are_told_nothing(tmp_path: Path, was: str, now: str) -> None:
    text = PARTS.replace(was, now) if was else PARTS
    for rule in ("not-connected", "flag-not-cleared"):
        assert told(tmp_path, text, rule) == []


@pytest.mark.parametrize(("was", "now", "rule", "at"), [
    # Without a word PPB2 to PPB4 are blocks of SOC0, too, and the last one's offset counts.
    ("ADCPPB4OFFCAL", "ADCPPB1OFFCAL", "not-configured", "OFFCAL"),
    ("ADCPPB4OFFCAL.bit.OFFCAL = 0x200", "ADCPPB1OFFREF = 100", "adc-limit-signed", "OFFREF"),
    ("ADCPPB4OFFCAL.bit.OFFCAL = 0x200", "ADCPPB4OFFCAL.bit.OFFCAL = 0x200; AdcaRegs.ADCPPB1CONFIG.bit.TWOSCOMPEN = 1",
     "adc-limit-signed", "TWOSCOMPEN"),
])  # fmt: skip
def test_what_comes_of_a_setting_is_told_at_it(tmp_path: Path, was: str, now: str, rule: str, at: str) -> None:
    text = PARTS.replace(was, now)
    assert text != PARTS
    (finding,) = told(tmp_path, text, rule)
    assert finding.place is not None
    assert at in text.splitlines()[finding.place.line - 1]


#: SCI-A hears itself; each character interrupts.
HEARD = """#include "F28x_Project.h"
volatile Uint16 Heard;
interrupt void heard(void)
{
    while (SciaRegs.SCIFFRX.bit.RXFFST > 0)
        Heard = SciaRegs.SCIRXBUF.all;
    SciaRegs.SCIFFRX.bit.RXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}
void main(void)
{
""" + START_UP + """    EALLOW;
    PieVectTable.SCIA_RX_INT = &heard;
    EDIS;
    SciaRegs.SCICCR.all = 0x0017;
    SciaRegs.SCIHBAUD.all = 0;
    SciaRegs.SCILBAUD.all = 53;
    SciaRegs.SCIFFTX.all = 0xE040;
    SciaRegs.SCIFFRX.all = 0x2061;
    SciaRegs.SCICTL1.all = 0x0023;
    PieCtrlRegs.PIEIER9.bit.INTx1 = 1;
    IER |= M_INT9;
    EINT;
    for (;;) {
        SciaRegs.SCITXBUF.all = 'x';
        DELAY_US(300);
    }
}
"""
CLEARED = "    SciaRegs.SCIFFRX.bit.RXFFINTCLR = 1;\n"


@pytest.mark.parametrize(("was", "now", "at"), [
    ("", "", None),
    # The start-up clears it, once.
    (CLEARED, "", "interrupt void heard"),
    # The enable is taken away and given again, which brings the interrupt as well.
    (CLEARED, CLEARED.replace("RXFFINTCLR = 1", "RXFFIENA = 0; SciaRegs.SCIFFRX.bit.RXFFIENA = 1"), None),
])  # fmt: skip
def test_a_flag_that_only_the_start_up_clears_gives_one_interrupt(
    tmp_path: Path, was: str, now: str, at: str | None
) -> None:
    text = HEARD.replace(was, now) if was else HEARD
    places = [f.place for f in told(tmp_path, text, "flag-not-cleared", seconds=0.06)]
    assert [place and at and at in text.splitlines()[place.line - 1] for place in places] == [True] * (at is not None)


#: SCI-A hears a PC at GPIO28 and 29.
HEARS_A_PC = """#include "F28x_Project.h"
volatile Uint16 Heard;
interrupt void heard(void)
{
    while (SciaRegs.SCIFFRX.bit.RXFFST > 0)
        Heard = SciaRegs.SCIRXBUF.all;
    SciaRegs.SCIFFRX.bit.RXFFINTCLR = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP9;
}
void Start(void)
{
    SciaRegs.SCICTL1.all = 0x0003;
    SciaRegs.SCICTL1.all = 0x0023;
}
void main(void)
{
""" + START_UP + """    EALLOW;
    PieVectTable.SCIA_RX_INT = &heard;
    EDIS;
    GPIO_SetupPinMux(28, GPIO_MUX_CPU1, 1);
    GPIO_SetupPinMux(29, GPIO_MUX_CPU1, 1);
    SciaRegs.SCICCR.all = 0x0007;
    SciaRegs.SCIHBAUD.all = 0;
    SciaRegs.SCILBAUD.all = 53;
    SciaRegs.SCIFFTX.all = 0xE040;
    SciaRegs.SCIFFRX.all = 0x6061;
    Start();
    PieCtrlRegs.PIEIER9.bit.INTx1 = 1;
    IER |= M_INT9;
    EINT;
    for (;;) {
        DELAY_US(300);
    }
}
"""
RESET = """        if (SciaRegs.SCIRXST.bit.RXERROR) {
            SciaRegs.SCICTL1.bit.SWRESET = 0;
            SciaRegs.SCICTL1.bit.SWRESET = 1;
        }
"""
LOOP = "        DELAY_US(300);\n"


class PcSwitchedOff(Board):
    """A PC sends a character each ms; its line is low from 2 to 4 ms, and nothing comes any more if it `stays_off`."""

    stays_off = False

    def solder(self) -> None:
        """Connect it."""
        pc = self.to_pc(tx_gpio=29, rx_gpio=28, baud=115200)
        for ms in range(1, 3 if self.stays_off else 12):
            self.clock.schedule(ms * CYCLES_PER_MS, partial(pc.feed, b"x"))
        for ms, low in (2, True), (4, False):
            self.clock.schedule(ms * CYCLES_PER_MS + 100_000, partial(self.serial_pins[28].hold_low, low))


class PcStaysOff(PcSwitchedOff):
    """The same, and nothing comes behind the break."""

    stays_off = True


@pytest.mark.parametrize(("was", "now", "board", "found"), [
    (LOOP, LOOP, PcSwitchedOff, True),
    (LOOP, LOOP, PcStaysOff, False),  # nothing is lost
    (LOOP, LOOP + RESET, PcSwitchedOff, False),
    # Started once more when nothing has come for a time that is longer than this run.
    (LOOP, LOOP + "        if (++Heard > 9999) Start();\n", PcSwitchedOff, False),
    # The errors are counted only; the FIFO is reset, which is not enough.
    (LOOP, LOOP + "        if (SciaRegs.SCIRXST.bit.BRKDT) Heard++;\n", PcSwitchedOff, True),
    (LOOP, LOOP + "        if (SciaRegs.SCIRXST.bit.RXERROR) { SciaRegs.SCIFFRX.bit.RXFIFORESET = 0;"
     " SciaRegs.SCIFFRX.bit.RXFIFORESET = 1; }\n", PcSwitchedOff, True),
])  # fmt: skip
def test_a_receiver_that_a_break_has_stopped_hears_again_only_after_a_reset(
    tmp_path: Path, was: str, now: str, board: type[Board], found: bool
) -> None:
    (tmp_path / "drv.c").write_text(HEARS_A_PC.replace(was, now), encoding="utf-8")
    checked = check_files(DriverFiles([tmp_path / "drv.c"], calls=1, board=board, board_named=True, seconds=0.012))
    assert ["a break at" in f.message for f in checked.findings if f.rule == "not-connected"] == [True] * found
    noted = [f.place.line for f in checked.findings if f.rule == "break-stops" and f.place is not None]
    assert noted == ([6] if board is PcStaysOff else [])


SKIPS = """        if (SciaRegs.SCIRXST.bit.RXERROR == 1) { Start_Again } else if (SciaRegs.SCIRXST.bit.RXRDY)
            Heard = SciaRegs.SCIRXBUF.all;
"""
HOLDS = "        if (EPwm1Regs.TZFLG.bit.OST) { Clears Heard++; State }\n"


@pytest.mark.parametrize(("text", "at"), [
    (SKIPS.replace("Start_Again", "Heard = 0;"), "RXERROR"),
    (SKIPS.replace("Start_Again", "Start();"), ""),
    (SKIPS.replace("Start_Again", "for (;;) ;"), ""),
    (HOLDS.replace("Clears", "").replace("State", ""), "OST"),
    (HOLDS.replace("Clears", "EALLOW; EPwm1Regs.TZCLR.bit.OST = 1; EDIS;").replace("State", ""), ""),
    (HOLDS.replace("Clears", "").replace("State", "Enter(3);"), ""),  # for good
    (HOLDS.replace("EPwm1Regs.TZFLG.bit.OST", "EQep1Regs.QEPSTS.bit.COEF && !Mode").replace("Clears", "Mode = Heard;")
     .replace("State", ""), ""),  # the first one only
    (HOLDS.replace("EPwm1Regs.TZFLG.bit.OST", "Mode && !EQep1Regs.QEPSTS.bit.COEF").replace("Clears", "Mode = Heard;")
     .replace("State", ""), "COEF"),
    (HOLDS.replace("EPwm1Regs.TZFLG.bit.OST", "EQep1Regs.QEPSTS.bit.CDEF == 0").replace("Clears", "")
     .replace("State", ""), "CDEF"),
    (HOLDS.replace("EPwm1Regs.TZFLG.bit.OST", "!EQep1Regs.QEPSTS.bit.COEF").replace("Clears", "").replace(
        "State", "EQep1Regs.QEPSTS.all = 0x88;"), ""),
    (HOLDS.replace("EPwm1Regs.TZFLG.bit.OST", "SciaRegs.SCIFFRX.bit.RXFFOVF").replace("Clears", "").replace(
        "State", "SciaRegs.SCIFFRX.bit.RXFIFORESET = 0; SciaRegs.SCIFFRX.bit.RXFIFORESET = 1;"), "RXFFOVF"),
    (HOLDS.replace("EPwm1Regs.TZFLG.bit.OST", "CanaRegs.CAN_ES.bit.BOff").replace("Clears", "").replace("State", ""),
     "BOff"),
])  # fmt: skip
def test_a_flag_that_stays_set_is_cleared_by_a_statement(tmp_path: Path, text: str, at: str) -> None:
    more = "Heard, Mode;\nvoid Enter(Uint16 mode) { Mode = mode; }"
    program = HEARS_A_PC.replace(LOOP, LOOP + text).replace("Heard;", more, 1)
    findings = told(tmp_path, program, "flag-not-cleared")
    assert [at in program.splitlines()[f.place.line - 1] for f in findings if f.place] == [True] * bool(at)


#: The DMA takes a result at each tick of timer 0; behind a buffer its interrupt names the other one.
BUFFERS = """#include "F28x_Project.h"
#pragma DATA_SECTION(Buffers, "ramgs0");
Uint16 Buffers[2][8];
volatile Uint16 Filled;
interrupt void full(void)
{
    Filled ^= 1;
    EALLOW;
    DmaRegs.CH1.DST_BEG_ADDR_SHADOW = (Uint32)&Buffers[Filled][0];
    DmaRegs.CH1.DST_ADDR_SHADOW = (Uint32)&Buffers[Filled][0];
    DmaRegs.CH1.CONTROL.bit.RUN = 1;
    EDIS;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP7;
}
void main(void)
{
""" + START_UP + """    EALLOW;
    PieVectTable.DMA_CH1_INT = &full;
    EDIS;
    Filled = 0;
    DMAInitialize();
    DMACH1AddrConfig(&Buffers[0][0], &AdcaResultRegs.ADCRESULT0);
    DMACH1BurstConfig(0, 0, 0);
    DMACH1TransferConfig(7, 0, 1);
    DMACH1WrapConfig(0xFFFF, 0, 0xFFFF, 0);
    DMACH1ModeConfig(DMA_TINT0, PERINT_ENABLE, ONESHOT_DISABLE, CONT_DISABLE, SYNC_DISABLE, SYNC_SRC,
                     OVRFLOW_DISABLE, SIXTEEN_BIT, CHINT_END, CHINT_ENABLE);
    StartDMACH1();
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 50);
    CpuTimer0Regs.TCR.all = 0x4000;
    PieCtrlRegs.PIEIER7.bit.INTx1 = 1;
    IER |= M_INT7;
    EINT;
    for (;;) { DELAY_US(10); }
}
"""


BY_BITS = ("""    DMACH1ModeConfig(DMA_TINT0, PERINT_ENABLE, ONESHOT_DISABLE, CONT_DISABLE, SYNC_DISABLE, SYNC_SRC,
                     OVRFLOW_DISABLE, SIXTEEN_BIT, CHINT_END, CHINT_ENABLE);
""", """    EALLOW;
    DmaClaSrcSelRegs.DMACHSRCSEL1.bit.CH1 = DMA_TINT0;
    DmaRegs.CH1.MODE.bit.PERINTSEL = 1;
    DmaRegs.CH1.MODE.bit.PERINTE = 1;
    DmaRegs.CH1.MODE.bit.CHINTMODE = 1;
    DmaRegs.CH1.MODE.bit.CHINTE = 1;
    EDIS;
""")
AGAIN = "    DmaRegs.CH1.CONTROL.bit.RUN = 1;\n"
NEXT_BUFFER = BUFFERS[BUFFERS.index("    Filled ^= 1;") : BUFFERS.index("    PieCtrlRegs.PIEACK")]


@pytest.mark.parametrize(("was", "now", "at"), [
    (AGAIN, AGAIN, None),
    (AGAIN, "", "MODE.bit.CHINTE = 1"),
    # One block is enough: its interrupt gives the channel no other addresses.
    (NEXT_BUFFER, "", None),
])  # fmt: skip
def test_a_channel_whose_mode_is_set_bit_by_bit_too(tmp_path: Path, was: str, now: str, at: str | None) -> None:
    assert BUFFERS.count(was) == 1
    assert BUFFERS.count(BY_BITS[0]) == 1
    text = BUFFERS.replace(was, now).replace(*BY_BITS)
    places = [finding.place for finding in told(tmp_path, text, seconds=0.01)]
    assert [place and at and at in text.splitlines()[place.line - 1] for place in places] == [True] * (at is not None)


@pytest.mark.parametrize(("was", "now", "at"), [
    ("", "", None),
    ("    DmaRegs.CH1.CONTROL.bit.RUN = 1;\n", "", "CONT_DISABLE"),
    # It runs on by itself, from the addresses that it then has.
    ("    DmaRegs.CH1.CONTROL.bit.RUN = 1;\n", "    DmaRegs.CH1.MODE.bit.CONTINUOUS = 1;\n", None),
])  # fmt: skip
def test_a_channel_that_gets_new_addresses_is_started(tmp_path: Path, was: str, now: str, at: str | None) -> None:
    text = BUFFERS.replace(was, now) if was else BUFFERS
    places = [finding.place for finding in told(tmp_path, text, seconds=0.01)]
    assert [place and at and at in text.splitlines()[place.line - 1] for place in places] == [True] * (at is not None)


#: A lamp blinks at GPIO34, in a loop.
LAMP = """#include "F28x_Project.h"
volatile Uint16 Order = 0;
void main(void)
{
    InitSysCtrl();
    EALLOW;
    GpioCtrlRegs.GPBDIR.bit.GPIO34 = 1;
    EDIS;
    for (;;) {
        GpioDataRegs.GPBSET.bit.GPIO34 = 1;
        DELAY_US(10);
        GpioDataRegs.GPBCLEAR.bit.GPIO34 = 1;
        DELAY_US(10);
    }
}
"""
_OUTPUT = "    GpioCtrlRegs.GPBDIR.bit.GPIO34 = 1;\n"
_CLEARED = "        GpioDataRegs.GPBCLEAR.bit.GPIO34 = 1;\n"


@pytest.mark.parametrize(("was", "now", "told_at"), [
    ("", "", []),
    (_OUTPUT, "    GpioCtrlRegs.GPBDIR.bit.GPIO35 = 1;\n", [_CLEARED]),
    (_OUTPUT, "    if (Order) GpioCtrlRegs.GPBDIR.all |= 4;\n", []),
    (_OUTPUT, "    GPIO_SetupPinOptions(34, GPIO_OUTPUT, GPIO_PUSHPULL);\n", []),
    # It keeps one level, which the pin may get later.
    (_OUTPUT + "|" + _CLEARED, "", []),
])  # fmt: skip
def test_a_pin_that_is_set_and_cleared_is_an_output(tmp_path: Path, was: str, now: str, told_at: list[str]) -> None:
    text = LAMP
    for part in was.split("|") if was else ():
        assert part in text
        text = text.replace(part, now)
    found = told(tmp_path, text, seconds=0.0005)
    assert [text.splitlines(keepends=True)[f.place.line - 1] for f in found if f.place] == told_at


#: Timer 0 starts SOC0, and the DMA moves its results.
MOVED = BUFFERS.replace("DMA_TINT0", "DMA_ADCAINT1").replace("    DMAInitialize();\n", """    EALLOW;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 14;
    AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 1;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    AdcaRegs.ADCINTSEL1N2.bit.INT1CONT = 1;
    EDIS;
    DMAInitialize();
""")


@pytest.mark.parametrize(("was", "now", "at"), [
    ("", "", None),
    ("    AdcaRegs.ADCINTSEL1N2.bit.INT1CONT = 1;\n", "", "DMACH1ModeConfig(DMA_ADCAINT1"),
    # The program clears the flag itself.
    ("    AdcaRegs.ADCINTSEL1N2.bit.INT1CONT = 1;\n",
     "#define DELAY_US(us) AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1\n", None),
])  # fmt: skip
def test_a_flag_that_only_the_dma_waits_for_is_told_where_it_is_given_to_it(
    tmp_path: Path, was: str, now: str, at: str | None
) -> None:
    assert not was or MOVED.count(was) == 1
    text = MOVED.replace(was, now) if was else MOVED
    places = [finding.place for finding in told(tmp_path, text, "flag-not-cleared", seconds=0.01)]
    assert [place and at and at in text.splitlines()[place.line - 1] for place in places] == [True] * (at is not None)


#: Timer 0 asks for the width of a pulse at GPIO24, which ePWM1 gives at GPIO0; a one-shot of eCAP1 takes it.
ONE_SHOT = """#include "F28x_Project.h"
volatile Uint16 Ticks, Order;
volatile Uint32 Width;
interrupt void tick(void)
{
    Ticks++;
    if (ECap1Regs.ECFLG.bit.CEVT2)
        Width = ECap1Regs.CAP2;
    ECap1Regs.ECCLR.all = 0xFFFF;
    ECap1Regs.ECCTL2.bit.REARM = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}
void main(void)
{
""" + START_UP + """    EALLOW;
    PieVectTable.TIMER0_INT = &tick;
    GpioCtrlRegs.GPAMUX1.bit.GPIO0 = 1;
    InputXbarRegs.INPUT7SELECT = 0;
    EDIS;
    EPwm1Regs.TBPRD = 20000;
    EPwm1Regs.CMPA.bit.CMPA = 500;
    EPwm1Regs.AQCTLA.bit.ZRO = AQ_SET;
    EPwm1Regs.AQCTLA.bit.CAU = AQ_CLEAR;
    EPwm1Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    ECap1Regs.ECCTL1.bit.CAP2POL = 1;
    ECap1Regs.ECCTL1.bit.CTRRST1 = 1;
    ECap1Regs.ECCTL2.bit.CONT_ONESHT = 1;
    ECap1Regs.ECCTL2.bit.STOP_WRAP = 1;
    ECap1Regs.ECCTL1.bit.CAPLDEN = 1;
    ECap1Regs.ECCTL2.bit.TSCTRSTOP = 1;
    ECap1Regs.ECCTL2.bit.REARM = 1;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer0, 200, 1000);
    CpuTimer0Regs.TCR.all = 0x4000;
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1;
    IER |= M_INT1;
    EINT;
    for (;;) { DELAY_US(10); }
}
"""
REARM = "    ECap1Regs.ECCTL2.bit.REARM = 1;\n    PieCtrlRegs"


@pytest.mark.parametrize(("was", "now", "at"), [
    ("", "", None),
    (REARM, "    PieCtrlRegs", "CONT_ONESHT = 1"),
    (REARM, "    if (Order) ECap1Regs.ECCTL2.bit.REARM = 1;\n    PieCtrlRegs", None),
    (REARM, "    ECap1Regs.ECCTL2.bit.CONT_ONESHT = 0;\n    PieCtrlRegs", None),
    # It is measured once, and kept.
    ("    ECap1Regs.ECCLR.all = 0xFFFF;\n" + REARM, "    PieCtrlRegs", None),
])  # fmt: skip
def test_a_one_shot_whose_flags_are_cleared_for_the_next_capture_is_armed_again(
    tmp_path: Path, was: str, now: str, at: str | None
) -> None:
    assert not was or ONE_SHOT.count(was) == 1
    text = ONE_SHOT.replace(was, now) if was else ONE_SHOT
    places = [finding.place for finding in told(tmp_path, text, seconds=0.02)]
    assert [place and at and at in text.splitlines()[place.line - 1] for place in places] == [True] * (at is not None)


MEASURED = """#include "F28x_Project.h"
#define TCR CpuTimer1Regs.TCR
Uint32 Began, Took, Order;
static void Work(void) { Uint16 n; for (n = 0; n < 1000; n++) { Began++; } }
void main(void)
{
    InitSysCtrl();
    CpuTimer1Regs.PRD.all = 0xFFFFFFFF;
    TCR.bit.TRB = 1;
    TCR.bit.TSS = 0;
    for (;;) {
        Began = CpuTimer1Regs.TIM.all;
        Work();
        Took = Began - CpuTimer1Regs.TIM.all;
    }
}
"""


@pytest.mark.parametrize(("was", "now", "told_at"), [
    ("TCR.bit.TSS = 0;", "TCR.bit.TSS = 0;", []),
    ("TCR.bit.TSS = 0;", "TCR.bit.TSS = 1;", ["TCR.bit.TSS = 1;"]),
    # It may be started on an order; it runs while the program reads it; it has measured, and stands now.
    ("TCR.bit.TSS = 0;", "TCR.bit.TSS = 1; if (Order) TCR.bit.TSS = 0;", []),
    ("for (;;) {", "TCR.bit.TSS = 1; for (;;) { if (Order) TCR.bit.TSS = 0;", []),
    ("for (;;) {", "Work(); TCR.bit.TSS = 1; for (;;) {", []),
    ("for (;;) {", "TCR.bit.TSS = 1; for (;;) { TCR.bit.TSS = 0; TCR.bit.TSS = 1;", []),
])  # fmt: skip
def test_a_time_base_that_stands_is_told(tmp_path: Path, was: str, now: str, told_at: list[str]) -> None:
    text = MEASURED.replace(was, now, 1)
    found = [f for f in told(tmp_path, text) if "TIM again and again" in f.message]
    assert [text.splitlines()[f.place.line - 1].strip() for f in found if f.place is not None] == told_at


#: A task sends a character now and then.  Nobody services the watchdog, which bites after 13 ms.
BITTEN = """#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Task.h>
#include "F28x_Project.h"
static Void Send(UArg a, UArg b)
{
    for (;;) {
        SciaRegs.SCITXBUF.all = 'x';
        Task_sleep(10);
    }
}
Int main(Void)
{
    InitSysCtrl();
    EALLOW;
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1;
    GpioCtrlRegs.GPBGMUX1.bit.GPIO43 = 3;
    GpioCtrlRegs.GPBMUX1.bit.GPIO43 = 3;
    EDIS;
    SciaRegs.SCICCR.all = 0x0007;
    SciaRegs.SCILBAUD.all = 53;
    SciaRegs.SCICTL1.all = 0x0002;
    SciaRegs.SCICTL1.bit.SWRESET = 1;
    Task_create(Send, NULL, NULL);
    EALLOW;
    WdRegs.WDCR.all = 0x0028;
    EDIS;
    BIOS_start();
    return 0;
}
"""


@pytest.mark.parametrize(("was", "now", "rules"), [
    ("", "", ["watchdog-reset"]),
    ("    SciaRegs.SCICTL1.bit.SWRESET = 1;\n", "", ["not-connected", "watchdog-reset"]),
])  # fmt: skip
def test_after_a_reset_by_the_watchdog_the_registers_before_it_are_judged(
    tmp_path: Path, was: str, now: str, rules: list[str]
) -> None:
    (tmp_path / "drv.c").write_text(BITTEN.replace(was, now), encoding="utf-8")
    checked = check_files(DriverFiles([tmp_path / "drv.c"], calls=1, board=load("bare"), seconds=0.05))
    assert sorted(f.rule for f in checked.findings if f.rule in ("not-connected", "watchdog-reset")) == rules


#: The loop of `main` services the watchdog, and the start-up has switched it off.
UNGUARDED = """#include "F28x_Project.h"
volatile Uint16 Count, Order;
static void SetUp(Uint16 word)
{
    EALLOW;
    WdRegs.WDCR.all = word;
    EDIS;
}
void main(void)
{
    Count = 0;
    Order = 0;
    InitSysCtrl();
    ServiceDog();
    EALLOW;
    WdRegs.WDCR.all = 0x006F;
    EDIS;
    for (;;) {
        Count++;
        DELAY_US(500);
        ServiceDog();
    }
}
"""
OFF = "WdRegs.WDCR.all = 0x006F;"


@pytest.mark.parametrize(("was", "now", "at"), [
    ("", "", OFF),
    ("0x006F", "0x0028 | 0x40", "WdRegs.WDCR.all = 0x0028 | 0x40;"),
    ("0x006F", "0x0068", "WdRegs.WDCR.all = 0x0068;"),
    (OFF, OFF + "    // watchdog on, 839 ms", OFF + "    // watchdog on, 839 ms"),
    (OFF, OFF + "    // WDDIS = 0", OFF + "    // WDDIS = 0"),
    (OFF, "SetUp(0x006F);", "WdRegs.WDCR.all = word;"),
    # A write without the check bits resets the device, and does not switch the watchdog on.
    ("Count++;", "Count++; if (Order == 9) WdRegs.WDCR.all = 0;", OFF),
    ("        ServiceDog();", "        EALLOW; WdRegs.WDKEY.all = 0x55; WdRegs.WDKEY.all = 0xAA; EDIS;", OFF),
])  # fmt: skip
def test_a_watchdog_that_is_set_up_and_stays_off_is_told(tmp_path: Path, was: str, now: str, at: str) -> None:
    text = UNGUARDED.replace(was, now, 1)
    (finding,) = told(tmp_path, text)
    assert "the watchdog is off during the whole run" in finding.message
    assert finding.place is not None
    assert text.splitlines()[finding.place.line - 1].strip() == at


@pytest.mark.parametrize(("was", "now"), [
    ("0x006F", "0x002F"),
    # The start-up alone has switched it off.
    (OFF, ""),
    ("    InitSysCtrl();\n    ServiceDog();\n", "    InitSysCtrl();\n    EALLOW; WdRegs.WDCR.all = 0x002F; EDIS;\n"),
    ("InitSysCtrl();", ""),
    # The program says that it is to be off.
    (OFF, "DisableDog();"),
    (OFF, OFF + " DisableDog();"),
    (OFF, OFF + "    // the watchdog is off"),
    ("    EALLOW;\n    " + OFF, "    // Watchdog aus\n    EALLOW;\n    " + OFF),
    ("0x006F", "WD_DISABLE"),
    ("0x006F", "0x002F | WDDIS"),
    (OFF, "WatchdogOff(0x006F);"),
    ("    EALLOW;\n    " + OFF, "#ifdef GUARDED\n    SetUp(0x0028);\n#else\n    EALLOW;\n    " + OFF + "\n#endif"),
    # It is on at times, or could be.
    ("Count++;", "Count++; if (Order == 9) SetUp(0x0028);"),
    ("Count++;", "Count++; if (Order == 9) SetUp(Count);"),
    ("Count++;", "SetUp(0x0028); Count++; SetUp(0x0068);"),
    # It is serviced at the start only.
    ("        ServiceDog();\n", ""),
    ("        ServiceDog();\n", "        if (Order == 9) ServiceDog();\n"),
    ("    for (;;) {", "    for (Order = 0; Order < 20; Order++) ServiceDog();\n    for (;;) {"),
])  # fmt: skip
def test_a_watchdog_that_is_on_or_meant_to_be_off_is_not_told(tmp_path: Path, was: str, now: str) -> None:
    text = UNGUARDED.replace(was, now, 1)
    assert text != UNGUARDED
    if "Order < 20" in now:
        text = text.replace("        ServiceDog();\n", "")
    if "Off(" in now:
        text = text.replace("void SetUp", "void WatchdogOff")
    text = text.replace("volatile Uint16", "#define WD_DISABLE 0x0068\n#define WDDIS 0x40\nvolatile Uint16")
    assert not told(tmp_path, text)


#: As UNGUARDED, with functions that write registers by numbers.  The set-up of the clock has the watchdog on meanwhile.
UNGUARDED_BY_NUMBERS = """#include "F28x_Project.h"
#define WORD(x) (*((volatile Uint16 *)(Uint32)(x)))
#define WD_CR 0x7029ul
#define WD_KEY 0x7025ul
volatile Uint16 Count;
static void SysCtl_disableWatchdog(void) { EALLOW; WORD(WD_CR) |= 0x68; EDIS; }
static void SysCtl_enableWatchdog(void) { EALLOW; WORD(WD_CR) = (WORD(WD_CR) & ~0x40u) | 0x28; EDIS; }
static void SysCtl_serviceWatchdog(void) { EALLOW; WORD(WD_KEY) = 0x55; WORD(WD_KEY) = 0xAA; EDIS; }
static void SysCtl_setWatchdogPrescaler(Uint16 scale)
{
    EALLOW;
    WORD(WD_CR) = (WORD(WD_CR) & ~7u) | 0x28 | scale;
    EDIS;
}
static void SysCtl_setClock(void)
{
    Uint16 before = WORD(WD_CR);
    EALLOW;
    WORD(WD_CR) = 0x28;
    WORD(WD_CR) = before | 0x28;
    EDIS;
}
static void Device_init(void) { SysCtl_disableWatchdog(); SysCtl_setClock(); }
void main(void)
{
    Count = 0;
    Device_init();
    SysCtl_setWatchdogPrescaler(7);
    for (;;) {
        Count++;
        DELAY_US(500);
        SysCtl_serviceWatchdog();
    }
}
"""


@pytest.mark.parametrize(("also", "found"), [
    ("", True), ("SysCtl_enableWatchdog();", False), ("SysCtl_disableWatchdog();", False),
    ("if (Count == 9) SysCtl_enableWatchdog();", False),
])  # fmt: skip
def test_a_watchdog_that_a_library_sets_up_and_nothing_enables_is_told(tmp_path: Path, also: str, found: bool) -> None:
    text = UNGUARDED_BY_NUMBERS.replace("Prescaler(7);", f"Prescaler(7); {also}")
    lines = text.splitlines()
    at = [lines[f.place.line - 1].strip() for f in told(tmp_path, text) if f.place is not None]
    assert at == ["WORD(WD_CR) = (WORD(WD_CR) & ~7u) | 0x28 | scale;"] * found
