"""Ones written to reserved bits: told for a register that is set, not for one that is cleared or filled."""

from __future__ import annotations

import pytest

from tests.emulator.drivers import Driver


@pytest.mark.parametrize(("word", "reserved"), [("0x028A", True), ("0x008A", False), ("0xFFFF", False)])
def test_ones_in_reserved_bits(word: str, reserved: bool) -> None:
    driver = Driver(f"""
# drv.c: baud
def baud() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR7.bit.SCI_C = 1
    EDIS()
    ScicRegs.SCILBAUD.all = {word}  #!
""")
    driver.baud()
    if reserved:
        assert driver.only("reserved-field").object == "ScicRegs.SCILBAUD"
    else:
        assert not driver.rules()


@pytest.mark.parametrize(("word", "reserved"), [("0xFFFFFE00", False), ("0xFFFFFFF0", False), ("0x00000200", True)])
def test_a_complement_fills_the_reserved_bits_of_a_register_that_has_little_else(word: str, reserved: bool) -> None:
    # Port F ends at GPIO168: bits 31 to 9 of GPFPUD are reserved.  ~0x1FF is 0xFFFFFE00.
    driver = Driver(f"""
# drv.c: pulls
def pulls() -> void:
    EALLOW()
    GpioCtrlRegs.GPFPUD.all = {word}
    EDIS()
""")
    driver.pulls()
    assert ("reserved-field" in driver.rules()) == reserved


def test_flag_registers_may_be_cleared_whole() -> None:
    driver = Driver("""
# drv.c: clear
def clear() -> void:
    PieCtrlRegs.PIEACK.all = 0x8FFF
""")
    driver.clear()
    assert not driver.rules()
