"""Inputs that a program sets up and never looks at, and those that it uses in any way."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.image import Build

PROGRAM = """#include "F28x_Project.h"
volatile Uint16 Out;
Uint16 Pins[2] = {{ 12, 13 }};
volatile Uint16 *Results;
void GPIO_setPinConfig(unsigned long config) {{ Out = (Uint16) config; }}
void GPIO_setDirectionMode(unsigned long pin, Uint16 mode) {{ Out = (Uint16) pin + mode; }}
void ADC_setupSOC(unsigned long base, Uint16 soc, Uint16 trigger) {{ Out = (Uint16) base + soc + trigger; }}
Uint16 ADC_readResult(unsigned long base, Uint16 soc) {{ return (Uint16) base + soc; }}
static int Pressed(Uint16 pin) {{ return GPIO_ReadPin(pin) == 0; }}
void main(void)
{{
    Uint16 i = 0;
    InitSysCtrl();
    EALLOW;
    {set_up}
    EDIS;
    for (;;) {{ i ^= 1; Out = Pressed(9); {use} }}
}}
"""


def told(folder: Path, set_up: str, use: str = "") -> list[str]:
    """The lines at which `input-unused` is told."""
    text = PROGRAM.format(set_up=set_up, use=use)
    file = folder / "a.c"
    file.write_text(text, encoding="utf-8")
    found = Build([str(file)]).compiled.findings
    return [text.splitlines()[f.place.line - 1].strip() for f in found if f.rule == "input-unused"]


PIN = "GPIO_SetupPinMux(12, GPIO_MUX_CPU1, 0); GPIO_SetupPinOptions(12, GPIO_INPUT, GPIO_PULLUP);"
CONVERSION = "AdcaRegs.ADCSOC2CTL.bit.CHSEL = 3;"


@pytest.mark.parametrize(("set_up", "use"), [
    (PIN, ""), (PIN, "Out = Pressed(13);"), (PIN, "Out = GpioDataRegs.GPADAT.bit.GPIO13;"),
    (PIN, "GPIO_WritePin(5, 1);"),
    ("GpioCtrlRegs.GPADIR.bit.GPIO12 = 0;", ""), ("GPIO_setDirectionMode(12, 0);", ""),
    # The function of another pin, of port A and of port B.
    ("GPIO_setDirectionMode(28, 0); GPIO_setPinConfig(0x00081A01ul);", ""),
    (CONVERSION, "Out = AdcaResultRegs.ADCRESULT1;"), (CONVERSION, "Out = AdcbResultRegs.ADCRESULT2;"),
    ("ADC_setupSOC(0x7480ul, 2, 5);", "Out = ADC_readResult(0x0B00ul, 2);"),
])  # fmt: skip
def test_an_input_that_nothing_looks_at_is_told(tmp_path: Path, set_up: str, use: str) -> None:
    assert told(tmp_path, set_up, use) == [set_up]


@pytest.mark.parametrize(("set_up", "use"), [
    (PIN, "Out = GPIO_ReadPin(12);"), (PIN, "Out = Pressed(12);"), (PIN, "Out = GpioDataRegs.GPADAT.bit.GPIO12;"),
    (PIN, "Out = GpioDataRegs.GPADAT.all >> 12 & 1;"), (PIN, "Out = GPIO_ReadPin(Pins[i]);"),
    (PIN + " InputXbarRegs.INPUT4SELECT = 12;", ""), (PIN + " GPIO_SetupXINT1Gpio(12);", ""),
    (PIN + " GPIO_SetupPinMux(12, GPIO_MUX_CPU1, 6);", ""), (PIN + " GpioCtrlRegs.GPAMUX1.bit.GPIO12 = 1;", ""),
    ("GPIO_setDirectionMode(28, 0); GPIO_setPinConfig(0x00081801ul);", ""),  # GPIO_28_SCIRXDA
    ("GPIO_setDirectionMode(43, 0); GPIO_setPinConfig(0x0046160Ful);", ""),  # GPIO_43_SCIRXDA
    (PIN + " CpuSysRegs.GPIOLPMSEL0.bit.GPIO12 = 1;", ""),
    # An output that is released.
    (PIN.replace("INPUT", "OUTPUT") + PIN, ""), ("GPIO_setDirectionMode(12, 0);", "GPIO_setDirectionMode(12, 1);"),
    ("GpioCtrlRegs.GPADIR.bit.GPIO12 = 1; GpioCtrlRegs.GPADIR.bit.GPIO12 = 0;", ""),
    (PIN, "GpioDataRegs.GPACLEAR.bit.GPIO12 = 1;"),
    ("GPIO_setDirectionMode(12, 1);", ""), ("GPIO_SetupPinOptions(12, GPIO_OUTPUT, GPIO_PUSHPULL);", ""),
    (CONVERSION, "Out = AdcaResultRegs.ADCRESULT2;"), (CONVERSION + " AdcaRegs.ADCPPB1CONFIG.bit.CONFIG = 2;", ""),
    (CONVERSION, "Results = (volatile Uint16 *) &AdcaResultRegs; Out = Results[2];"),
    ("ADC_setupSOC(0x7480ul, 2, 5);", "Out = ADC_readResult(0x0B20ul, 2);"),
    ("ADC_setupSOC(0x7400ul, 2, 5);", "Out = ADC_readResult(0x0B00ul, i);"),
])  # fmt: skip
def test_an_input_that_is_used_is_silent(tmp_path: Path, set_up: str, use: str) -> None:
    assert told(tmp_path, set_up, use) == []
