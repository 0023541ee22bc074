"""Findings about an interrupt's routine are reported at the routine, also when the kernel dispatches it."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.drivers.check import DriverFiles, check_files

PROGRAM = """#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include "F28x_Project.h"

static volatile Uint16 Periods = 0;

static void On_Period(UArg unused)
{
    Periods++;
    BODY
}

Int main(void)
{
    InitSysCtrl();
    EALLOW;
    CpuSysRegs.PCLKCR2.bit.EPWM1 = 1;
    EDIS;
    EPwm1Regs.TBPRD = 10000;
    EPwm1Regs.TBCTL.bit.CTRMODE = 0;
    EPwm1Regs.ETSEL.bit.INTSEL = 1;
    EPwm1Regs.ETPS.bit.INTPRD = 1;
    EPwm1Regs.ETSEL.bit.INTEN = 1;
    Hwi_create(48, On_Period, NULL, NULL);
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    BIOS_start();
    return 0;
}
"""


@pytest.mark.parametrize(
    ("body", "rules"),
    [
        ("EPwm1Regs.ETCLR.bit.INT = 1;", []),
        (";", ["flag-not-cleared"]),
        ("EPwm1Regs.ETCLR.bit.INT = 1;\n    PieCtrlRegs.PIEIFR3.bit.INTx1 = 1;", ["interrupt-storm"]),
    ],
)
def test_a_finding_about_a_hwi_is_at_its_function(body: str, rules: list[str], tmp_path: Path) -> None:
    file = tmp_path / "periods.c"
    file.write_text(PROGRAM.replace("BODY", body), encoding="utf-8")
    findings = [f for f in check_files(DriverFiles([file], seconds=0.3)).findings if f.rule != "unmodelled"]
    assert [f.rule for f in findings] == rules
    for finding in findings:
        assert finding.place is not None
        assert finding.place.function == "On_Period"
        assert finding.task == "Hwi:On_Period"


def test_an_interrupt_without_a_function_is_told_where_its_line_is_enabled(tmp_path: Path) -> None:
    text = PROGRAM.replace("BODY", ";").replace(
        "Hwi_create(48, ", "PieCtrlRegs.PIEIER3.bit.INTx1 = 1;\n    Hwi_create(49, "
    )
    file = tmp_path / "periods.c"
    file.write_text(text, encoding="utf-8")
    (finding,) = (
        f for f in check_files(DriverFiles([file], seconds=0.1)).findings if f.rule == "interrupt-without-handler"
    )
    assert finding.place is not None
    assert "PIEIER3.bit.INTx1" in text.splitlines()[finding.place.line - 1]


LATE = """#include <xdc/std.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include "F28x_Project.h"
static volatile Uint16 Value;
static void On_Result(UArg unused)
{
    DELAY_US(WAIT);
    Value = AdcaResultRegs.ADCRESULT0;
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
}
Int main(void)
{
    InitSysCtrl();
    EALLOW;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcSetMode(ADC_ADCA, ADC_RESOLUTION_12BIT, ADC_SIGNALMODE_SINGLE);
    EALLOW;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 19;
    AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 2;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    EDIS;
    Hwi_create(32, On_Result, NULL, NULL);
    CpuTimer1Regs.PRD.all = 20000 - 1;
    CpuTimer1Regs.TCR.all = 0x4020;
    BIOS_start();
    return 0;
}
"""


@pytest.mark.parametrize(("wait_us", "late"), [("20", False), ("150", True)])
def test_a_routine_that_lasts_longer_than_its_period_is_named(wait_us: str, late: bool, tmp_path: Path) -> None:
    file = tmp_path / "late.c"
    file.write_text(LATE.replace("WAIT", wait_us), encoding="utf-8")
    found = [f for f in check_files(DriverFiles([file], seconds=0.02)).findings if f.rule == "flag-not-cleared"]
    assert ["Hwi:On_Result had not come to its clear" in finding.message for finding in found] == [True] * late
