"""Watchdog registers (block at 0x7000; protected).

Offsets and fields: HDR F2837xS_sysctrl.h, struct WD_REGS; reset values: TRM, watchdog registers.
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import RW, W1C, At, Block, F, R, Register, W


class SCSR(Register, eallow=True):
    """System control and status.  TRM watchdog registers; HDR SCSR_BITS."""
    WDINTS     = F(2, R,   1, "state of the WDINT signal, active low")
    WDENINT    = F(1, RW,  0, "expiry raises WDINT instead of resetting")
    WDOVERRIDE = F(0, W1C, 1, "1 = WDDIS may be changed; writing 1 forbids it until reset")


class WDCNTR(Register):
    """Counter.  TRM watchdog registers; HDR WDCNTR_BITS."""
    WDCNTR = F(7, 0, R, 0, "counts of WDCLK")


class WDKEY(Register, eallow=True):
    """Service key.  TRM watchdog registers; HDR WDKEY_BITS."""
    WDKEY = F(7, 0, W, 0, "0x55 then 0xAA restart the counter")


class WDCR(Register, eallow=True):
    """Control.  TRM watchdog registers; HDR WDCR_BITS."""
    WDDIS = F(6,    RW, 0, "1 = watchdog off")
    WDCHK = F(5, 3, W,  0, "every write must carry 101b")
    WDPS  = F(2, 0, RW, 0, "prescaler: 0, 1 = /1, n = /2^(n-1)")


class WDWCR(Register, eallow=True):
    """Window.  TRM watchdog registers; HDR WDWCR_BITS."""
    FIRSTKEY = F(8,    R,  0, "a service was seen since MIN was set")
    MIN      = F(7, 0, RW, 0, "a service before this count expires the watchdog")


class WdRegs(Block, struct="WD_REGS"):
    """Watchdog.  HDR struct WD_REGS."""
    SCSR   = At(0x22, SCSR)
    WDCNTR = At(0x23, WDCNTR)
    WDKEY  = At(0x25, WDKEY)
    WDCR   = At(0x29, WDCR)
    WDWCR  = At(0x2A, WDWCR)
