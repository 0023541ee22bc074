"""Driver files without a `main`: interrupt routines run between the calls, and settings that contradict each other."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.drivers.check import DriverFiles, check_files

DRIVER = """#include "F28x_Project.h"
#include "sampler.h"
static volatile Uint32 Sum = 0;
static volatile Uint16 Count = 0;
static __interrupt void Sample(void)
{
    if (Count < 1000) {
        Sum += AdcaResultRegs.ADCRESULT0;
        Count++;
    }
    @clear
    @acknowledge
}
void Sampler_Init(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR13.bit.ADC_A = 1;
    CpuSysRegs.PCLKCR2.bit.EPWM4 = 1;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcSetMode(ADC_ADCA, ADC_RESOLUTION_12BIT, ADC_SIGNALMODE_SINGLE);
    EALLOW;
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 3;
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 139;
    AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 11;
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    PieVectTable.ADCA1_INT = &Sample;
    EDIS;
    EPwm4Regs.TBPRD = 4999;
    EPwm4Regs.TBCTR = 0;
    EPwm4Regs.TBCTL.bit.HSPCLKDIV = 0;
    EPwm4Regs.TBCTL.bit.CLKDIV = 0;
    EPwm4Regs.ETSEL.bit.SOCASEL = 2;
    EPwm4Regs.ETPS.bit.SOCAPRD = 1;
    EPwm4Regs.ETSEL.bit.SOCAEN = 1;
    EPwm4Regs.TBCTL.bit.CTRMODE = 0;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    PieCtrlRegs.PIEIER1.bit.INTx1 = 1;
    IER |= M_INT1;
}
Uint16 Sampler_Mean(void)
{
    Uint32 sum;
    Uint16 n;

    DINT;
    sum = Sum;
    n = Count;
    Sum = 0;
    Count = 0;
    EINT;
    return n == 0 ? 0 : (Uint16)(sum / n);
}
"""
CLEAR = "AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;"
ACKNOWLEDGE = "PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;"
ENABLED = "PieCtrlRegs.PIEIER1.bit.INTx1 = 1;"


def told(
    tmp_path: Path, *, clear: str = CLEAR, acknowledge: str = ACKNOWLEDGE, enabled: str = ENABLED, more: str = ""
) -> list[tuple[str, str]]:
    """The rules of errors and warnings, each with the function in which it was found."""
    file = tmp_path / "sampler.c"
    text = DRIVER.replace("@clear", clear).replace("@acknowledge", acknowledge).replace(ENABLED, enabled)
    file.write_text(text + more)
    (tmp_path / "sampler.h").write_text("void Sampler_Init(void);\nUint16 Sampler_Mean(void);\n")
    report = check_files(DriverFiles([file]))
    return [
        (each.rule, each.place.function if each.place else "") for each in report.findings if each.how != "generated"
    ]  # fmt: skip


def test_the_routine_of_a_driver_is_let_in_after_its_initialisation(tmp_path: Path) -> None:
    """Its own Init leaves INTM and ENPIE to the application: until then conversions end, and nobody clears the flag."""
    assert told(tmp_path) == []


@pytest.mark.parametrize("wrong", ["clear", "acknowledge"])
def test_a_flag_that_the_routine_leaves_is_told_at_the_routine(tmp_path: Path, wrong: str) -> None:
    assert ("flag-not-cleared", "Sample") in told(tmp_path, **{wrong: ""})


OTHER = "PieCtrlRegs.PIEIER1.bit.INTx2 = 1;"
GIVEN = """
void Sampler_Attach(void (*routine)(void))
{
    EALLOW;
    PieVectTable.ADCB1_INT = (PINT)routine;
    EDIS;
}
"""


def test_another_line_of_the_group_is_told(tmp_path: Path) -> None:
    """HDR F2837xS_pievect.h: 1.1 is ADCA1, 1.2 is ADCB1."""
    assert told(tmp_path, enabled=OTHER) == [("not-connected", "Sampler_Init")]


@pytest.mark.parametrize(
    ("enabled", "more"), [("", ""), (f"{ENABLED} {OTHER}", ""), (OTHER, GIVEN)], ids=["by-others", "both", "attached"]
)
def test_what_an_application_may_do_besides_is_not_told(tmp_path: Path, enabled: str, more: str) -> None:
    """It may enable the line itself, have a routine of its own for the other one, or attach it."""
    assert ("not-connected", "Sampler_Init") not in told(tmp_path, enabled=enabled, more=more)


DUTY = """
void Sampler_InitDuty(void)
{
    EPwm4Regs.CMPCTL.bit.SHDWAMODE = @shadow;
    EPwm4Regs.CMPCTL.bit.LOADAMODE = @load;
    EPwm4Regs.AQCTLA.bit.ZRO = 2;
    EPwm4Regs.AQCTLA.bit.CAU = 1;
}
void Sampler_Duty(Uint16 duty)
{
    EPwm4Regs.CMPA.bit.CMPA = duty;
}
"""


@pytest.mark.parametrize(
    ("shadow", "load", "loads"), [(0, 3, False), (0, 0, True), (0, 2, True), (1, 3, True)],
    ids=["frozen", "at-zero", "at-both", "immediate"],
)  # fmt: skip
def test_a_compare_that_is_never_loaded_is_told(tmp_path: Path, shadow: int, load: int, *, loads: bool) -> None:
    """TRM, CMPCTL: LOADAMODE = 3 freezes the active register, unless SHDWAMODE = 1 writes it directly."""
    more = DUTY.replace("@shadow", str(shadow)).replace("@load", str(load))
    assert (("not-connected", "Sampler_InitDuty") in told(tmp_path, more=more)) is not loads


ECHO = """
static volatile Uint32 Width = 0;
void Sampler_InitEcho(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR3.bit.ECAP1 = 1;
    @inputs
    EDIS;
    GPIO_SetupPinOptions(9, GPIO_INPUT, GPIO_ASYNC);
    ECap1Regs.ECCTL1.bit.CAP1POL = 0;
    ECap1Regs.ECCTL1.bit.CTRRST1 = 1;
    ECap1Regs.ECCTL1.bit.CAP2POL = 1;
    ECap1Regs.ECCTL1.bit.CAPLDEN = 1;
    ECap1Regs.ECCTL2.bit.CAP_APWM = 0;
    ECap1Regs.ECCTL2.bit.SYNCI_EN = 0;
    ECap1Regs.ECCTL2.bit.TSCTRSTOP = 1;
}
Uint32 Sampler_Echo(void)
{
    Width = ECap1Regs.CAP2;
    return Width;
}
"""
#: Of an external interrupt; of a trip zone.
BUTTON = "XintRegs.XINT{}CR.bit.POLARITY = 1; XintRegs.XINT{}CR.bit.ENABLE = 1;"
TRIP = "EPwm4Regs.TZSEL.bit.OSHT{} = 1;"


@pytest.mark.parametrize("inputs", [
    "InputXbarRegs.INPUT6SELECT = 9;",
    "InputXbarRegs.INPUT8SELECT = 9;",
    "InitECap2Gpio(9); EALLOW;",
    # Another one has its own.
    "InputXbarRegs.INPUT1SELECT = 9; InputXbarRegs.INPUT4SELECT = 10; " + BUTTON.format(1, 1),
    # The echo has its own, and another one has not.
    "InputXbarRegs.INPUT7SELECT = 9; InputXbarRegs.INPUT5SELECT = 10; " + BUTTON.format(1, 1),
    "InputXbarRegs.INPUT7SELECT = 9; GPIO_SetupXINT3Gpio(10); EALLOW; " + BUTTON.format(1, 1),
    "InputXbarRegs.INPUT7SELECT = 9; InputXbarRegs.INPUT1SELECT = 12; " + TRIP.format(2),
])  # fmt: skip
def test_an_input_that_is_chosen_for_somebody_else_is_told(tmp_path: Path, inputs: str) -> None:
    """DS, Input X-BAR: eCAP1 is INPUT7, XINT1 INPUT4, TZ2 INPUT2."""
    assert ("not-connected", "Sampler_InitEcho") in told(tmp_path, more=ECHO.replace("@inputs", inputs))


@pytest.mark.parametrize("inputs", [
    "InputXbarRegs.INPUT7SELECT = 9;",
    "InitECap1Gpio(9); EALLOW;",
    # The application chooses it, also where the driver chooses that of another part, or of several.
    "",
    "InputXbarRegs.INPUT4SELECT = 10; " + BUTTON.format(1, 1),
    "InputXbarRegs.INPUT6SELECT = 10; " + BUTTON.format(3, 3),
    "InputXbarRegs.INPUT6SELECT = 10; OutputXbarRegs.OUTPUT3MUXENABLE.bit.MUX11 = 1;",
    "InputXbarRegs.INPUT6SELECT = 10; EPwm4Regs.DCTRIPSEL.bit.DCAHCOMPSEL = 5;",
    "InputXbarRegs.INPUT5SELECT = 10; AdcaRegs.ADCSOC1CTL.bit.TRIGSEL = 4;",
    "InputXbarRegs.INPUT6SELECT = 10; EPwm4Regs.TBCTL.bit.PHSEN = 1;",
    "InputXbarRegs.INPUT1SELECT = 12; " + TRIP.format(1),
    "InputXbarRegs.INPUT4SELECT = 12; InputXbarRegs.INPUT8SELECT = 13;",
    "InputXbarRegs.INPUT7SELECT = 9; InputXbarRegs.INPUT8SELECT = 13;",
    # On GPIO0, as the reset leaves it.
    "InputXbarRegs.INPUT7SELECT = 0; InputXbarRegs.INPUT8SELECT = 13;",
])  # fmt: skip
def test_an_input_that_somebody_may_use_is_not_told(tmp_path: Path, inputs: str) -> None:
    assert ("not-connected", "Sampler_InitEcho") not in told(tmp_path, more=ECHO.replace("@inputs", inputs))


def test_a_pin_that_the_application_gives_is_not_told(tmp_path: Path) -> None:
    """The application gives the pin of the echo to a function of the driver."""
    route = "\nvoid Sampler_Route(Uint16 pin)\n{\n    EALLOW; InputXbarRegs.INPUT7SELECT = pin; EDIS;\n}\n"
    text = ECHO.replace("@inputs", "InputXbarRegs.INPUT6SELECT = 9;") + route
    assert ("not-connected", "Sampler_InitEcho") not in told(tmp_path, more=text)
