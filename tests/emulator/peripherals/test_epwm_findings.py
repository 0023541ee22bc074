"""What a driver does wrong with an ePWM: one driver with the defect, one without, for each rule."""

from __future__ import annotations

import pytest

from tests.emulator.drivers import Driver

PWM = """
# drv.c: start
def start() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR2.bit.EPWM2 = 1
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0
    GpioCtrlRegs.GPAMUX1.bit.GPIO2 = {mux}
    EDIS()
    EPwm2Regs.TBPRD = {period}
    EPwm2Regs.CMPA.bit.CMPA = 0
    EPwm2Regs.AQCTLA.bit.ZRO = 2
    EPwm2Regs.AQCTLA.bit.CAU = 1
    EPwm2Regs.TBCTL.bit.CTRMODE = {mode}
    EALLOW()
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = {sync}
    EDIS()


# drv.c: duty
def duty(counts: uint16) -> void:
    EPwm2Regs.CMPA.bit.CMPA = counts  #!
"""


@pytest.mark.parametrize(("setting", "name"), [
    ({"sync": 0}, "CpuSysRegs.PCLKCR0.TBCLKSYNC"), ({"mode": 3}, "EPwm2Regs.TBCTL.CTRMODE"),
    ({"period": 0}, "EPwm2Regs.TBPRD"), ({"mux": 0}, "EPWM2A"), ({}, ""),
])  # fmt: skip
def test_a_duty_that_reaches_no_pin(setting: dict[str, int], name: str) -> None:
    driver = Driver(PWM.format(**{"mux": 1, "mode": 0, "sync": 1, "period": 4999} | setting))
    driver.start()
    driver.duty(100)  # start-up code may still be at work
    assert not driver.rules()
    driver.wait_ms(20)
    driver.duty(200)
    if name:
        assert driver.only("not-configured").object == name
    else:
        assert not driver.rules()
