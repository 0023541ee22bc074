"""encoder.c: the wheels' encoders on two eQEP modules, four edges a line, 720 edges a turn.

CHOICE: the left wheel on eQEP1 (GPIO10, GPIO11), the right one on eQEP3 (GPIO62, GPIO63), multiplexer 5; forward
counts up on both, because A and B of the motor that is mounted mirrored are exchanged in its cable.  The counters run
through all 32 bits, so a difference of two readings is right across the wrap.
Sources: TRM eQEP chapter, NXT (180 lines a turn).
"""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, CpuSysRegs, EQep1Regs, EQep3Regs, GpioCtrlRegs

EDGES_PER_TURN = 720
QPOS_ALL = 0xFFFFFFFF


# encoder.c: Init_Encoder_left
def Init_Encoder_left() -> void:

    EALLOW()
    CpuSysRegs.PCLKCR4.bit.EQEP1 = 1
    GpioCtrlRegs.GPAMUX1.bit.GPIO10 = 0
    GpioCtrlRegs.GPAMUX1.bit.GPIO11 = 0
    GpioCtrlRegs.GPAGMUX1.bit.GPIO10 = 1
    GpioCtrlRegs.GPAGMUX1.bit.GPIO11 = 1
    GpioCtrlRegs.GPAMUX1.bit.GPIO10 = 1
    GpioCtrlRegs.GPAMUX1.bit.GPIO11 = 1
    GpioCtrlRegs.GPAPUD.bit.GPIO10 = 0
    GpioCtrlRegs.GPAPUD.bit.GPIO11 = 0
    GpioCtrlRegs.GPAQSEL1.bit.GPIO10 = 2
    GpioCtrlRegs.GPAQSEL1.bit.GPIO11 = 2
    EDIS()

    EQep1Regs.QEPCTL.bit.QPEN = 0
    EQep1Regs.QDECCTL.bit.QSRC = 0
    EQep1Regs.QPOSMAX = QPOS_ALL
    EQep1Regs.QPOSCNT = 0
    EQep1Regs.QEPCTL.bit.PCRM = 1
    EQep1Regs.QEPCTL.bit.QPEN = 1


# encoder.c: Init_Encoder_right
def Init_Encoder_right() -> void:

    EALLOW()
    CpuSysRegs.PCLKCR4.bit.EQEP3 = 1
    GpioCtrlRegs.GPBMUX2.bit.GPIO62 = 0
    GpioCtrlRegs.GPBMUX2.bit.GPIO63 = 0
    GpioCtrlRegs.GPBGMUX2.bit.GPIO62 = 1
    GpioCtrlRegs.GPBGMUX2.bit.GPIO63 = 1
    GpioCtrlRegs.GPBMUX2.bit.GPIO62 = 1
    GpioCtrlRegs.GPBMUX2.bit.GPIO63 = 1
    GpioCtrlRegs.GPBPUD.bit.GPIO62 = 0
    GpioCtrlRegs.GPBPUD.bit.GPIO63 = 0
    GpioCtrlRegs.GPBQSEL2.bit.GPIO62 = 2
    GpioCtrlRegs.GPBQSEL2.bit.GPIO63 = 2
    EDIS()

    EQep3Regs.QEPCTL.bit.QPEN = 0
    EQep3Regs.QDECCTL.bit.QSRC = 0
    EQep3Regs.QPOSMAX = QPOS_ALL
    EQep3Regs.QPOSCNT = 0
    EQep3Regs.QEPCTL.bit.PCRM = 1
    EQep3Regs.QEPCTL.bit.QPEN = 1


# encoder.c: Encoder_left
def Encoder_left() -> int32:
    return int32(EQep1Regs.QPOSCNT)


# encoder.c: Encoder_right
def Encoder_right() -> int32:
    return int32(EQep3Regs.QPOSCNT)
