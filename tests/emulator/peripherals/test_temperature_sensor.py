"""The temperature sensor: a voltage that TI's conversion takes back to degrees."""

from __future__ import annotations

from random import Random

import pytest

from emulator.chip import Chip
from emulator.registers.core import ALL
from tests.emulator.adc_a_in_c import set_up
from tests.emulator.drivers import CChip

PROGRAM = """
Uint16 sample;

void set_up(void)
{
    start();
    EALLOW;
    SET_UP
    EDIS;
    InitTempSensor(3.0);
}

int16 measured(Uint16 kelvin)
{
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    AdcaRegs.ADCSOCFRC1.bit.SOC0 = 1;
    while (AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0);
    sample = AdcaResultRegs.ADCRESULT0;
    return kelvin ? GetTemperatureK(sample) : GetTemperatureC(sample);
}
""".replace("SET_UP", set_up(13, 139))


@pytest.mark.parametrize(("degrees", "code"), [(25.0, 1621), (0.0, 1490), (-40.0, 1279), (125.0, 2146)])
def test_a_program_measures_the_temperature_of_the_chip(degrees: float, code: int) -> None:
    # A code of 2.5 V is 5196 / 32768 C: 25 C are 157.66 codes above 1788, or 1.18753 V; of 3.0 V that is code 1621.4.
    chip = CChip(PROGRAM)
    chip.chip.temperature_sensor.temperature_c = degrees
    chip.call("set_up")
    assert chip.call("measured", 0) == pytest.approx(degrees, abs=1)
    assert chip.data("sample") == [code]
    assert chip.call("measured", 1) == pytest.approx(degrees + 273, abs=1)
    assert chip.found() == []


def test_the_sensor_is_off_until_it_is_switched_on() -> None:
    chip = Chip(rng=Random(0))
    chip.cpu.eallow = True
    wire, register = chip.analog["A"][13], chip.register("AnalogSubsysRegs", "TSNSCTL")
    assert wire.volts(0) == 0.0
    register.write(1, ALL)
    assert wire.volts(0) == pytest.approx((1788 + 25 * 32768 / 5196) * 2.5 / 4096)
    register.write(0, ALL)
    assert wire.volts(0) == 0.0


def test_conversion_of_results_by_hand() -> None:
    # At 2.5 V: (1788 - 1788) is 0 C, and half a degree is added; (2000 - 1788) * 5196 / 32768 = 33.6; 1500 is
    # -45.67, with the half -45.17, which is truncated towards 0.
    program = """
    int16 celsius(int16 code) { return GetTemperatureC(code); }
    int16 kelvin(int16 code) { return GetTemperatureK(code); }
    void with(float volts) { start(); InitTempSensor(volts); }
    """
    chip = CChip(program)
    chip.call("with", 2.5)
    assert [chip.call("celsius", code) for code in (1788, 2000, 1500)] == [0, 34, -45]
    assert [chip.call("kelvin", code) for code in (1788, 2000, 1500)] == [273, 307, 227]
    chip.call("with", 3.0)
    # 1667 * 3 / 2.5 = 2000.4, truncated
    assert chip.call("celsius", 1667) == 34
