"""key_timer.c: the bumper on GPIO43, sampled every millisecond by CPU timer 0, five equal samples to believe."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import CpuSysRegs, CpuTimer0Regs, EALLOW, EDIS, GpioCtrlRegs, GpioDataRegs

STABLE = 5


class KEY(enum):
    UP = 0
    FALLING = 1
    DOWN = 2
    RISING = 3


State: KEY
Count: uint16
Presses: uint16
Pressed_ms: uint32


# key_timer.c: Key_Init
def Key_Init() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR0.bit.CPUTIMER0 = 1
    GpioCtrlRegs.GPBGMUX1.bit.GPIO43 = 0
    GpioCtrlRegs.GPBMUX1.bit.GPIO43 = 0
    GpioCtrlRegs.GPBDIR.bit.GPIO43 = 0
    GpioCtrlRegs.GPBPUD.bit.GPIO43 = 0
    EDIS()
    CpuTimer0Regs.TCR.bit.TSS = 1
    CpuTimer0Regs.PRD.all = 199999
    CpuTimer0Regs.TPR.all = 0
    CpuTimer0Regs.TPRH.all = 0
    CpuTimer0Regs.TCR.bit.TRB = 1
    CpuTimer0Regs.TCR.bit.TIF = 1
    CpuTimer0Regs.TCR.bit.TSS = 0
    State = KEY.UP
    Count = 0
    Presses = 0
    Pressed_ms = 0


# key_timer.c: Key_Step
def Key_Step(closed: uint16) -> void:
    match State:
        case KEY.UP:
            if closed:
                State = KEY.FALLING
                Count = 1
        case KEY.FALLING:
            if not closed:
                State = KEY.UP
            else:
                Count += 1
                if Count >= STABLE:
                    State = KEY.DOWN
                    Presses += 1
        case KEY.DOWN:
            Pressed_ms += 1
            if not closed:
                State = KEY.RISING
                Count = 1
        case _:
            if closed:
                State = KEY.DOWN
            else:
                Count += 1
                if Count >= STABLE:
                    State = KEY.UP


# key_timer.c: Key_Poll
def Key_Poll() -> uint16:
    if CpuTimer0Regs.TCR.bit.TIF == 0:
        return 0
    CpuTimer0Regs.TCR.bit.TIF = 1
    Key_Step(GpioDataRegs.GPBDAT.bit.GPIO43 == 0)
    return 1


# key_timer.c: Key_Wait
def Key_Wait() -> uint16:
    ticks: uint16 = 0
    before: uint16 = Presses
    while Presses == before:
        ticks += Key_Poll()
    return ticks
