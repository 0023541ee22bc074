"""pwm.c: the four inputs of the motor bridge.

CHOICE: ePWM2 A and B (GPIO2, GPIO3) drive IN1 and IN2 of the left half of the LB1836M, ePWM7 A and B (GPIO12, GPIO13)
those of the right half, multiplexer 1; 20 kHz, above hearing: TBCLK 100 MHz / (4999 + 1), counting up, set at zero,
cleared at compare.  A compare of 5000 never comes, which is a duty of 1.  Sources: TRM ePWM chapter, LB truth table.
"""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, CpuSysRegs, EPwm2Regs, EPwm7Regs, GpioCtrlRegs

PWM_PERIOD = 5000

TB_COUNT_UP = 0
TB_FREEZE = 3
TB_IMMEDIATE = 1
CC_SHADOW = 0
CC_CTR_ZERO = 0
AQ_CLEAR = 1
AQ_SET = 2


# pwm.c: Init_EPWM2
def Init_EPWM2() -> void:

    EALLOW()
    CpuSysRegs.PCLKCR2.bit.EPWM2 = 1
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0
    GpioCtrlRegs.GPAMUX1.bit.GPIO2 = 0
    GpioCtrlRegs.GPAMUX1.bit.GPIO3 = 0
    GpioCtrlRegs.GPAGMUX1.bit.GPIO2 = 0
    GpioCtrlRegs.GPAGMUX1.bit.GPIO3 = 0
    GpioCtrlRegs.GPAMUX1.bit.GPIO2 = 1
    GpioCtrlRegs.GPAMUX1.bit.GPIO3 = 1
    EDIS()

    EPwm2Regs.TBCTL.bit.CTRMODE = TB_FREEZE
    EPwm2Regs.TBCTL.bit.HSPCLKDIV = 0
    EPwm2Regs.TBCTL.bit.CLKDIV = 0
    EPwm2Regs.TBCTL.bit.PRDLD = TB_IMMEDIATE
    EPwm2Regs.TBPRD = PWM_PERIOD - 1
    EPwm2Regs.TBCTR = 0
    EPwm2Regs.CMPCTL.bit.SHDWAMODE = CC_SHADOW
    EPwm2Regs.CMPCTL.bit.SHDWBMODE = CC_SHADOW
    EPwm2Regs.CMPCTL.bit.LOADAMODE = CC_CTR_ZERO
    EPwm2Regs.CMPCTL.bit.LOADBMODE = CC_CTR_ZERO
    EPwm2Regs.CMPA.bit.CMPA = 0
    EPwm2Regs.CMPB.bit.CMPB = 0
    EPwm2Regs.AQCTLA.bit.ZRO = AQ_SET
    EPwm2Regs.AQCTLA.bit.CAU = AQ_CLEAR
    EPwm2Regs.AQCTLB.bit.ZRO = AQ_SET
    EPwm2Regs.AQCTLB.bit.CBU = AQ_CLEAR
    EPwm2Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP

    EALLOW()
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1
    EDIS()


# pwm.c: Init_EPWM7
def Init_EPWM7() -> void:

    EALLOW()
    CpuSysRegs.PCLKCR2.bit.EPWM7 = 1
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0
    GpioCtrlRegs.GPAMUX1.bit.GPIO12 = 0
    GpioCtrlRegs.GPAMUX1.bit.GPIO13 = 0
    GpioCtrlRegs.GPAGMUX1.bit.GPIO12 = 0
    GpioCtrlRegs.GPAGMUX1.bit.GPIO13 = 0
    GpioCtrlRegs.GPAMUX1.bit.GPIO12 = 1
    GpioCtrlRegs.GPAMUX1.bit.GPIO13 = 1
    EDIS()

    EPwm7Regs.TBCTL.bit.CTRMODE = TB_FREEZE
    EPwm7Regs.TBCTL.bit.HSPCLKDIV = 0
    EPwm7Regs.TBCTL.bit.CLKDIV = 0
    EPwm7Regs.TBCTL.bit.PRDLD = TB_IMMEDIATE
    EPwm7Regs.TBPRD = PWM_PERIOD - 1
    EPwm7Regs.TBCTR = 0
    EPwm7Regs.CMPCTL.bit.SHDWAMODE = CC_SHADOW
    EPwm7Regs.CMPCTL.bit.SHDWBMODE = CC_SHADOW
    EPwm7Regs.CMPCTL.bit.LOADAMODE = CC_CTR_ZERO
    EPwm7Regs.CMPCTL.bit.LOADBMODE = CC_CTR_ZERO
    EPwm7Regs.CMPA.bit.CMPA = 0
    EPwm7Regs.CMPB.bit.CMPB = 0
    EPwm7Regs.AQCTLA.bit.ZRO = AQ_SET
    EPwm7Regs.AQCTLA.bit.CAU = AQ_CLEAR
    EPwm7Regs.AQCTLB.bit.ZRO = AQ_SET
    EPwm7Regs.AQCTLB.bit.CBU = AQ_CLEAR
    EPwm7Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP

    EALLOW()
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1
    EDIS()


# pwm.c: Duty_EPWM2
def Duty_EPWM2(duty_a: float32, duty_b: float32) -> void:
    EPwm2Regs.CMPA.bit.CMPA = uint16(duty_a * PWM_PERIOD)
    EPwm2Regs.CMPB.bit.CMPB = uint16(duty_b * PWM_PERIOD)


# pwm.c: Duty_EPWM7
def Duty_EPWM7(duty_a: float32, duty_b: float32) -> void:
    EPwm7Regs.CMPA.bit.CMPA = uint16(duty_a * PWM_PERIOD)
    EPwm7Regs.CMPB.bit.CMPB = uint16(duty_b * PWM_PERIOD)
