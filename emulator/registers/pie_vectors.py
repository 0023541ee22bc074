"""The PIE vector table at 0x0D00, EALLOW protected: one entry an interrupt, which holds the routine to run.

Entry `id` is the 32-bit word at 0x0D00 + 2 * id; ids: HDR F2837xS_pievect.h, hw_ints.h (INTx.1-8 from 0x20, INTx.9-16
from 0x80).  Not modelled: entries of interrupts that no modelled module raises, reserved and user entries; the table as
words of memory.
"""

# fmt: off
from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from emulator.registers.core import RW, Block, Word


class Vector(Word):
    """The entry of vector `id`: a function without parameters and result (`PINT`)."""

    #: Tells the translator that no number stands here.
    routine = True

    def __init__(self, id: int, text: str) -> None:
        super().__init__(2 * id, RW, 0, 32, eallow=True, text=f"routine of {text}")
        self.id = id

    if TYPE_CHECKING:
        def __set__(self, block: Block, value: Callable[[], None] | int) -> None: ...


class PieVectTable(Block):
    """Interrupt vectors.  HDR struct PIE_VECT_TABLE."""
    TIMER1_INT    = Vector(0x0D, "CPU INT13")
    TIMER2_INT    = Vector(0x0E, "CPU INT14")
    ADCA1_INT     = Vector(0x20, "INT1.1")
    XINT1_INT     = Vector(0x23, "INT1.4")
    XINT2_INT     = Vector(0x24, "INT1.5")
    TIMER0_INT    = Vector(0x26, "INT1.7")
    WAKE_INT      = Vector(0x27, "INT1.8")
    EPWM1_TZ_INT  = Vector(0x28, "INT2.1")
    EPWM2_TZ_INT  = Vector(0x29, "INT2.2")
    EPWM3_TZ_INT  = Vector(0x2A, "INT2.3")
    EPWM4_TZ_INT  = Vector(0x2B, "INT2.4")
    EPWM5_TZ_INT  = Vector(0x2C, "INT2.5")
    EPWM6_TZ_INT  = Vector(0x2D, "INT2.6")
    EPWM7_TZ_INT  = Vector(0x2E, "INT2.7")
    EPWM8_TZ_INT  = Vector(0x2F, "INT2.8")
    EPWM9_TZ_INT  = Vector(0x88, "INT2.9")
    EPWM10_TZ_INT = Vector(0x89, "INT2.10")
    EPWM11_TZ_INT = Vector(0x8A, "INT2.11")
    EPWM12_TZ_INT = Vector(0x8B, "INT2.12")
    EPWM1_INT     = Vector(0x30, "INT3.1")
    EPWM2_INT     = Vector(0x31, "INT3.2")
    EPWM3_INT     = Vector(0x32, "INT3.3")
    EPWM4_INT     = Vector(0x33, "INT3.4")
    EPWM5_INT     = Vector(0x34, "INT3.5")
    EPWM6_INT     = Vector(0x35, "INT3.6")
    EPWM7_INT     = Vector(0x36, "INT3.7")
    EPWM8_INT     = Vector(0x37, "INT3.8")
    EPWM9_INT     = Vector(0x90, "INT3.9")
    EPWM10_INT    = Vector(0x91, "INT3.10")
    EPWM11_INT    = Vector(0x92, "INT3.11")
    EPWM12_INT    = Vector(0x93, "INT3.12")
    EQEP1_INT     = Vector(0x40, "INT5.1")
    EQEP2_INT     = Vector(0x41, "INT5.2")
    EQEP3_INT     = Vector(0x42, "INT5.3")
    SPIA_RX_INT   = Vector(0x48, "INT6.1")
    SPIA_TX_INT   = Vector(0x49, "INT6.2")
    SCIC_RX_INT   = Vector(0x5C, "INT8.5")
    SCIC_TX_INT   = Vector(0x5D, "INT8.6")
    SCIA_RX_INT   = Vector(0x60, "INT9.1")
    SCIA_TX_INT   = Vector(0x61, "INT9.2")
    SCIB_RX_INT   = Vector(0x62, "INT9.3")
    SCIB_TX_INT   = Vector(0x63, "INT9.4")
    ADCA_EVT_INT  = Vector(0x68, "INT10.1")
    ADCA2_INT     = Vector(0x69, "INT10.2")
    ADCA3_INT     = Vector(0x6A, "INT10.3")
    ADCA4_INT     = Vector(0x6B, "INT10.4")
    XINT3_INT     = Vector(0x78, "INT12.1")
    XINT4_INT     = Vector(0x79, "INT12.2")
    XINT5_INT     = Vector(0x7A, "INT12.3")
