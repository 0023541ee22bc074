"""clock.c: the time since start-up, and a period timer.

CHOICE: CPU timer 1 runs free at 1 MHz and Get_Time gives its milliseconds in 16 bits, so it wraps after 65.5 s (and
jumps when the 1 MHz counter itself wraps, after 71.6 min); CPU timer 0 is the period timer of Set_Timer, without
interrupt.  CPU timer 2 belongs to the kernel's tick.
main_Robot.c calls the three functions once and uses nothing of what they give.  Sources: TRM CPU timer chapter.
"""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, CpuSysRegs, CpuTimer0Regs, CpuTimer1Regs

TIMER_DIVIDER_1MHZ = 199  # SYSCLK 200 MHz / (199 + 1)
TIMER_FREE = 0xFFFFFFFF
CYCLES_PER_MS = 200000


# clock.c: Init_Clock
def Init_Clock() -> void:

    EALLOW()
    CpuSysRegs.PCLKCR0.bit.CPUTIMER0 = 1
    CpuSysRegs.PCLKCR0.bit.CPUTIMER1 = 1
    EDIS()

    CpuTimer1Regs.TCR.bit.TSS = 1
    CpuTimer1Regs.TCR.bit.TIE = 0
    CpuTimer1Regs.PRD.all = TIMER_FREE
    CpuTimer1Regs.TPR.bit.TDDR = TIMER_DIVIDER_1MHZ
    CpuTimer1Regs.TPRH.bit.TDDRH = 0
    CpuTimer1Regs.TCR.bit.TRB = 1
    CpuTimer1Regs.TCR.bit.TSS = 0


# clock.c: Get_Time
def Get_Time() -> uint16:
    return (TIMER_FREE - CpuTimer1Regs.TIM.all) / 1000


# clock.c: Set_Timer
def Set_Timer(period_ms: uint16) -> void:

    CpuTimer0Regs.TCR.bit.TSS = 1
    CpuTimer0Regs.TCR.bit.TIE = 0
    CpuTimer0Regs.PRD.all = uint32(period_ms) * CYCLES_PER_MS - 1
    CpuTimer0Regs.TPR.bit.TDDR = 0
    CpuTimer0Regs.TPRH.bit.TDDRH = 0
    CpuTimer0Regs.TCR.bit.TRB = 1
    CpuTimer0Regs.TCR.bit.TSS = 0
