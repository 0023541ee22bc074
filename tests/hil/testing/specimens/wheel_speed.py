"""wheel_speed.c: speed of the left wheel from eQEP1, the position latched by the unit timer every 10 ms."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, CpuSysRegs, EQep1Regs, GpioCtrlRegs

UNIT_PERIOD = 2000000
RAD_PER_EDGE = 0.00872664626

Last_Position: int32 = 0
Speed: float32 = 0.0


# wheel_speed.c: Init_Speed
def Init_Speed() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR4.bit.EQEP1 = 1
    GpioCtrlRegs.GPAGMUX1.bit.GPIO10 = 1
    GpioCtrlRegs.GPAGMUX1.bit.GPIO11 = 1
    GpioCtrlRegs.GPAMUX1.bit.GPIO10 = 1
    GpioCtrlRegs.GPAMUX1.bit.GPIO11 = 1
    EDIS()
    EQep1Regs.QPOSMAX = 0xFFFFFFFF
    EQep1Regs.QEPCTL.bit.PCRM = 1
    EQep1Regs.QUPRD = UNIT_PERIOD
    EQep1Regs.QEPCTL.bit.QCLM = 1
    EQep1Regs.QEPCTL.bit.UTE = 1
    EQep1Regs.QEPCTL.bit.QPEN = 1
    Last_Position = 0


# wheel_speed.c: Update_Speed
def Update_Speed() -> int16:
    position: int32
    edges: int32
    if EQep1Regs.QFLG.bit.UTO == 0:
        return 0
    EQep1Regs.QCLR.bit.UTO = 1
    position = int32(EQep1Regs.QPOSLAT)
    edges = position - Last_Position
    Last_Position = position
    Speed = float32(edges) * RAD_PER_EDGE * 100.0
    return 1


# wheel_speed.c: Millirad
def Millirad() -> int16:
    return int16(Speed * 1000.0)
