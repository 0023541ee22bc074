"""What a driver does wrong with an eQEP: one driver with the defect, one without, for each rule."""

from __future__ import annotations

import pytest

from tests.emulator.drivers import Driver

EQEP = """
# drv.c: start
def start() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR4.bit.EQEP1 = 1
    GpioCtrlRegs.GPAGMUX1.bit.GPIO10 = 1
    GpioCtrlRegs.GPAGMUX1.bit.GPIO11 = {gmux}
    GpioCtrlRegs.GPAMUX1.bit.GPIO10 = 1
    GpioCtrlRegs.GPAMUX1.bit.GPIO11 = 1
    EDIS()
    EQep1Regs.QPOSMAX = {maximum}
    EQep1Regs.QUPRD = {period}
    EQep1Regs.QEPCTL.bit.UTE = {unit}
    EQep1Regs.QEPCTL.bit.QPEN = {on}


# drv.c: position
def position() -> int32:
    return int32(EQep1Regs.QPOSCNT)  #!


# drv.c: latched
def latched() -> int32:
    return int32(EQep1Regs.QPOSLAT)  #!


# drv.c: unit
def unit() -> int32:
    while EQep1Regs.QFLG.bit.UTO == 0:
        pass
    EQep1Regs.QCLR.bit.UTO = 1
    return int32(EQep1Regs.QPOSLAT)
"""


def eqep(
    source: str = "", *, gmux: int = 1, maximum: str = "0xFFFFFFFF", unit: int = 1, on: int = 1, period: int = 200_000
) -> Driver:
    driver = Driver(EQEP.format(gmux=gmux, maximum=maximum, unit=unit, on=on, period=period) + source)
    driver.start()
    return driver


def test_an_encoder_that_counts_is_silent() -> None:
    driver = eqep()
    for _ in range(4):
        driver.position()
        driver.unit()
    assert not driver.rules()


@pytest.mark.parametrize(("setting", "name"), [
    ({"on": 0}, "EQep1Regs.QEPCTL.QPEN"), ({"maximum": "0"}, "EQep1Regs.QPOSMAX"), ({"gmux": 0}, "EQEP1"),
])  # fmt: skip
def test_a_position_that_cannot_count(setting: dict[str, object], name: str) -> None:
    driver = eqep(**setting)  # type: ignore[arg-type]
    driver.position()
    assert driver.only("not-configured").object == name


@pytest.mark.parametrize(("source", "swap", "told"), [
    (0, 0, True), (1, 0, True), (2, 0, False), (3, 0, False), (2, 1, True),
])  # fmt: skip
def test_a_direction_that_is_fixed_needs_no_pin(source: int, swap: int, told: bool) -> None:
    # GPIO11, the only pin of B here, has another function.
    driver = eqep(f"""
# drv.c: mode
def mode() -> void:
    EQep1Regs.QDECCTL.bit.QSRC = {source}
    EQep1Regs.QDECCTL.bit.SWAP = {swap}
""", gmux=0)
    driver.mode()
    driver.position()
    assert [str(rule) for rule in driver.rules()] == ["not-configured"] * told


@pytest.mark.parametrize(("setting", "name"), [
    ({"on": 0}, "EQep1Regs.QEPCTL.QPEN"), ({"unit": 0}, "EQep1Regs.QEPCTL.UTE"), ({"period": 0}, "EQep1Regs.QUPRD"),
    ({"maximum": "0"}, "EQep1Regs.QPOSMAX"),
])  # fmt: skip
def test_a_latch_that_nothing_fills(setting: dict[str, object], name: str) -> None:
    driver = eqep(**setting)  # type: ignore[arg-type]
    driver.latched()
    assert driver.only("not-configured").object == name


def test_a_unit_time_out_that_is_never_cleared() -> None:
    driver = eqep("""
# drv.c: forgetful
def forgetful() -> void:
    while EQep1Regs.QFLG.bit.UTO == 0:  #!
        pass
    DelayUs(1500)
""")
    driver.forgetful()
    assert not driver.rules(), "the first wait is right"
    driver.forgetful()
    assert driver.only("flag-not-cleared").object == "EQep1Regs.QFLG.UTO"
