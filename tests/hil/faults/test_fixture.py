"""The fixture `fault`, as a project has it that tests a driver of its own."""

from __future__ import annotations

import pytest

DRIVER = """
#include "F28x_Project.h"

unsigned Convert(void)
{
    AdcaRegs.ADCSOCFRC1.bit.SOC0 = 1;
    while (AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0)
        ;
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    return AdcaResultRegs.ADCRESULT0;
}

void Init(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR13.bit.ADC_A = 1;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcSetMode(ADC_ADCA, ADC_RESOLUTION_12BIT, ADC_SIGNALMODE_SINGLE);
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 3;
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 14;
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    EDIS;
}
"""

TESTS = """
import pytest

pytestmark = [pytest.mark.board("bare"), pytest.mark.firmware("volts.c")]


def test_stuck(firmware, outside, fault):
    outside.adc_volts(3, 1.5)
    firmware.volts.Init()
    sound = firmware.volts.Convert()
    assert sound == 2048
    stuck = fault("adc-bit-stuck", input="A3", bit=4)
    assert firmware.volts.Convert() == 2048 + 16
    met = stuck.report().met
    assert met.function == "Convert"
    assert met.place.startswith("volts.c:10:")
    stuck.remove()
    assert firmware.volts.Convert() == 2048


def test_open_input(firmware, outside, fault, advance):
    outside.adc_volts(3, 1.5)
    firmware.volts.Init()
    opened = fault("adc-channel-open:input=A3,for=0.001")
    assert firmware.volts.Convert() == 0
    advance(0.002)
    assert firmware.volts.Convert() == 2048
    assert opened.report().count == 1


def test_silent(firmware, fault):
    fault("adc-bit-stuck", input="A5")


def test_wrong(firmware, fault):
    fault("gyro-reset")
"""


def test_fixture(pytester: pytest.Pytester) -> None:
    (pytester.path / "volts.c").write_text(DRIVER, encoding="utf-8")
    (pytester.path / "test_volts.py").write_text(TESTS, encoding="utf-8")
    result = pytester.runpytest_subprocess("-n0", "-p", "no:cacheprovider")
    result.stdout.fnmatch_lines(["*never fired: adc-bit-stuck:input=A5*", "*gyro-reset: Board must have one gyro*"])
    result.assert_outcomes(passed=3, failed=1, errors=1)
