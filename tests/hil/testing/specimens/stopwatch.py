"""stopwatch.c: CPU timer 0 as a stopwatch in microseconds, and what fits in between."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, CpuSysRegs, CpuTimer0Regs

TICKS_PER_US = 200


# stopwatch.c: Init_Stopwatch
def Init_Stopwatch() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR0.bit.CPUTIMER0 = 1
    EDIS()
    CpuTimer0Regs.TCR.bit.TSS = 1
    CpuTimer0Regs.PRD.all = 0xFFFFFFFF
    CpuTimer0Regs.TPR.all = 0
    CpuTimer0Regs.TPRH.all = 0
    CpuTimer0Regs.TCR.bit.TRB = 1
    CpuTimer0Regs.TCR.bit.TSS = 0


# stopwatch.c: Now
def Now() -> uint32:
    return 0xFFFFFFFF - CpuTimer0Regs.TIM.all


# stopwatch.c: Elapsed_us
def Elapsed_us(since: uint32) -> uint32:
    return (Now() - since) / TICKS_PER_US


# stopwatch.c: Per_Second
def Per_Second(since: uint32, events: uint16) -> uint32:
    us: uint32
    us = Elapsed_us(since)
    if us == 0:
        return 0
    return uint32(events) * 1000000 / us
