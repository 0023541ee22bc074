"""Numbers that are computed for a field of a register: told where the field does not hold them, before any cast."""

from __future__ import annotations

import pytest

from tests.emulator.drivers import Driver

SOURCE = """
# drv.c: start
def start() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR16.bit.DAC_A = 1
    CpuSysRegs.PCLKCR13.bit.ADC_B = 1
    CpuSysRegs.PCLKCR2.bit.EPWM5 = 1
    CpuSysRegs.PCLKCR7.bit.SCI_B = 1


# drv.c: set
def set(number: int32) -> void:
    {statement}  #!
"""


@pytest.mark.parametrize(("statement", "fits", "beyond"), [
    ("DacaRegs.DACVALS.bit.DACVALS = uint16(2048 + number)", -2048, -2049),
    ("DacaRegs.DACVALS.bit.DACVALS = uint16(2048 + number)", 2047, 2048),
    ("EPwm5Regs.CMPA.bit.CMPA = int16(number)", 0, -1),
    ("EPwm5Regs.CMPB.bit.CMPB = number", 65535, 65536),
    ("EPwm5Regs.TBPRD = uint16(number * 10)", 6553, 6554),
    ("EPwm5Regs.TBPHS.bit.TBPHS = uint16(number)", -3, None),
    ("AdcbRegs.ADCSOC0CTL.bit.ACQPS = uint16(number)", 511, 512),
    ("AdcbRegs.ADCSOC0CTL.bit.ACQPS = uint16(number) & 0x1FF", 700, None),
    ("ScibRegs.SCIHBAUD.bit.BAUD = uint16(number)", 325, None),
    ("EPwm5Regs.AQCSFRC.bit.CSFA = uint16(number)", 4, None),
])  # fmt: skip
def test_a_number_beyond_its_field_is_told(statement: str, fits: int, beyond: int | None) -> None:
    driver = Driver(SOURCE.format(statement=statement))
    driver.start()
    driver.set(fits)
    assert not driver.rules()
    if beyond is not None:
        driver.set(beyond)
        assert f"is {driver.only('register-value').value}, and" in driver.only("register-value").message
