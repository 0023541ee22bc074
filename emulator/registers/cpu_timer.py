"""CPU timer registers (timers 0, 1, 2 at 0x0C00, 0x0C08, 0x0C10; unprotected).

Offsets and fields: HDR F2837xS_cputimer.h; reset values: TRM, CPU timer registers (PRD and TCR unconfirmed).
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import R0W1, RSV, RW, W1C, At, Block, F, R, Register


class TIM(Register, bits=32):
    """Down counter.  TRM CPU timers; HDR TIM_BITS."""
    MSW = F(31, 16, RW, 0,      "high word")
    LSW = F(15,  0, RW, 0xFFFF, "low word")


class PRD(Register, bits=32):
    """Period less one.  TRM CPU timers; HDR PRD_BITS."""
    # CHOICE: reset 0x0000FFFF, unconfirmed.
    MSW = F(31, 16, RW, 0,      "high word")
    LSW = F(15,  0, RW, 0xFFFF, "low word")


class TCR(Register):
    """Control.  TRM CPU timers; HDR TCR_BITS."""
    TIF   = F(15,    W1C,  0, "interrupt flag")
    TIE   = F(14,    RW,   0, "interrupt enable")
    FREE  = F(11,    RW,   0, "keep running under debug halt: nothing halts here")
    SOFT  = F(10,    RW,   0, "finish the count under debug halt: nothing halts here")
    TRB   = F( 5,    R0W1, 0, "reload TIM from PRD and the prescaler from TDDR")
    TSS   = F( 4,    RW,   0, "1 = stop, 0 = run")
    # CHOICE: the reset word is 0x0001, unconfirmed: one of the reserved bits.
    RESERVED = F(3, 0, RSV, 1, "reserved")


class TPR(Register):
    """Prescaler, low bytes.  TRM CPU timers; HDR TPR_BITS."""
    PSC  = F(15, 8, R,  0, "prescale counter, low byte")
    TDDR = F( 7, 0, RW, 0, "divide-down, low byte")


class TPRH(Register):
    """Prescaler, high bytes.  TRM CPU timers; HDR TPRH_BITS."""
    PSCH  = F(15, 8, R,  0, "prescale counter, high byte")
    TDDRH = F( 7, 0, RW, 0, "divide-down, high byte")


class CpuTimerRegs(Block, struct="CPUTIMER_REGS"):
    """One CPU timer.  HDR struct CPUTIMER_REGS."""
    TIM  = At(0x00, TIM)
    PRD  = At(0x02, PRD)
    TCR  = At(0x04, TCR)
    TPR  = At(0x06, TPR)
    TPRH = At(0x07, TPRH)
