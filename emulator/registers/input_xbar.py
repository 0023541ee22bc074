"""Input X-BAR registers at 0x7900 (protected): which pin is INPUT1 to INPUT14.

Offsets and fields: HDR F2837xS_input_xbar.h; write protection: TRM, INPUT_XBAR_REGS; destinations: DS, Input X-BAR.
CHOICE: INPUTxSELECT is 0 (GPIO0) after reset.
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import RW, W1S, At, Block, F, Register, Word


class INPUTSELECTLOCK(Register, bits=32, eallow=True):
    """Locks of INPUTxSELECT, set until reset.  TRM Input X-BAR registers; HDR INPUTSELECTLOCK_BITS."""
    INPUT16SELECT = F(15, W1S, 0, "INPUT16SELECT is locked")
    INPUT15SELECT = F(14, W1S, 0, "INPUT15SELECT is locked")
    INPUT14SELECT = F(13, W1S, 0, "INPUT14SELECT is locked")
    INPUT13SELECT = F(12, W1S, 0, "INPUT13SELECT is locked")
    INPUT12SELECT = F(11, W1S, 0, "INPUT12SELECT is locked")
    INPUT11SELECT = F(10, W1S, 0, "INPUT11SELECT is locked")
    INPUT10SELECT = F( 9, W1S, 0, "INPUT10SELECT is locked")
    INPUT9SELECT  = F( 8, W1S, 0, "INPUT9SELECT is locked")
    INPUT8SELECT  = F( 7, W1S, 0, "INPUT8SELECT is locked")
    INPUT7SELECT  = F( 6, W1S, 0, "INPUT7SELECT is locked")
    INPUT6SELECT  = F( 5, W1S, 0, "INPUT6SELECT is locked")
    INPUT5SELECT  = F( 4, W1S, 0, "INPUT5SELECT is locked")
    INPUT4SELECT  = F( 3, W1S, 0, "INPUT4SELECT is locked")
    INPUT3SELECT  = F( 2, W1S, 0, "INPUT3SELECT is locked")
    INPUT2SELECT  = F( 1, W1S, 0, "INPUT2SELECT is locked")
    INPUT1SELECT  = F( 0, W1S, 0, "INPUT1SELECT is locked")


class InputXbarRegs(Block, struct="INPUT_XBAR_REGS"):
    """Input X-BAR.  HDR struct INPUT_XBAR_REGS."""
    INPUT1SELECT    = Word(0x00, RW, 0, eallow=True, text="pin of TZ1 and TRIP1 of the ePWM modules")
    INPUT2SELECT    = Word(0x01, RW, 0, eallow=True, text="pin of TZ2 and TRIP2 of the ePWM modules")
    INPUT3SELECT    = Word(0x02, RW, 0, eallow=True, text="pin of TZ3 and TRIP3 of the ePWM modules")
    INPUT4SELECT    = Word(0x03, RW, 0, eallow=True, text="pin of XINT1")
    INPUT5SELECT    = Word(0x04, RW, 0, eallow=True, text="pin of XINT2 (and ADCEXTSOC, EXTSYNCIN1)")
    INPUT6SELECT    = Word(0x05, RW, 0, eallow=True, text="pin of XINT3 (and TRIP6, EXTSYNCIN2)")
    INPUT7SELECT    = Word(0x06, RW, 0, eallow=True, text="pin of eCAP1")
    INPUT8SELECT    = Word(0x07, RW, 0, eallow=True, text="pin of eCAP2")
    INPUT9SELECT    = Word(0x08, RW, 0, eallow=True, text="pin of eCAP3")
    INPUT10SELECT   = Word(0x09, RW, 0, eallow=True, text="pin of eCAP4")
    INPUT11SELECT   = Word(0x0A, RW, 0, eallow=True, text="pin of eCAP5")
    INPUT12SELECT   = Word(0x0B, RW, 0, eallow=True, text="pin of eCAP6")
    INPUT13SELECT   = Word(0x0C, RW, 0, eallow=True, text="pin of XINT4")
    INPUT14SELECT   = Word(0x0D, RW, 0, eallow=True, text="pin of XINT5")
    INPUTSELECTLOCK = At(0x1E, INPUTSELECTLOCK)
