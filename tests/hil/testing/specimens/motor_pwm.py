"""motor_pwm.c: duty of ePWM2 A on GPIO2, 20 kHz, limited to what the bridge stands."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, CpuSysRegs, EPwm2Regs, GpioCtrlRegs

PERIOD = 5000


# motor_pwm.c: Init_Motor
def Init_Motor() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR2.bit.EPWM2 = 1
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0
    GpioCtrlRegs.GPAGMUX1.bit.GPIO2 = 0
    GpioCtrlRegs.GPAMUX1.bit.GPIO2 = 1
    EDIS()
    EPwm2Regs.TBCTL.bit.CTRMODE = 3
    EPwm2Regs.TBCTL.bit.HSPCLKDIV = 0
    EPwm2Regs.TBCTL.bit.CLKDIV = 0
    EPwm2Regs.TBCTL.bit.PRDLD = 1
    EPwm2Regs.TBPRD = PERIOD - 1
    EPwm2Regs.TBCTR = 0
    EPwm2Regs.CMPCTL.bit.SHDWAMODE = 0
    EPwm2Regs.CMPCTL.bit.LOADAMODE = 0
    EPwm2Regs.CMPA.bit.CMPA = 0
    EPwm2Regs.AQCTLA.bit.ZRO = 2
    EPwm2Regs.AQCTLA.bit.CAU = 1
    EPwm2Regs.TBCTL.bit.CTRMODE = 0
    EALLOW()
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1
    EDIS()


# motor_pwm.c: Set_Duty
def Set_Duty(duty: float32) -> void:
    if duty < 0.0:
        duty = 0.0
    if duty > 0.9:
        duty = 0.9
    EPwm2Regs.CMPA.bit.CMPA = uint16(duty * PERIOD)


# motor_pwm.c: Set_Speed
def Set_Speed(wanted: float32, full: float32) -> void:
    if full == 0.0:
        return
    Set_Duty(wanted / full)
