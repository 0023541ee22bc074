"""SCI-A/B/C/D registers.  TRM chapter SCI; HDR F2837xS_sci.h.  Nothing here is EALLOW protected.

Bases: SciaRegs 0x7200, ScibRegs 0x7210, ScicRegs 0x7220, ScidRegs 0x7230.  Most registers are 8 bits wide: the
upper byte reads 0.
"""

from __future__ import annotations

from emulator.registers.core import R0W1, RW, At, Block, F, R, Register


class SCICCR(Register):
    """SCI communications control."""

    #                    bits  type  reset  description
    STOPBITS      = F(  7,     RW,   0,     "1 = two stop bits")
    PARITY        = F(  6,     RW,   0,     "1 = even, 0 = odd")
    PARITYENA     = F(  5,     RW,   0,     "parity enable")
    LOOPBKENA     = F(  4,     RW,   0,     "loopback: TX joined to RX inside")
    ADDRIDLE_MODE = F(  3,     RW,   0,     "address-bit multiprocessor mode", modelled=False)
    SCICHAR       = F(  2, 0,  RW,   0,     "character length minus 1")


class SCICTL1(Register):
    """SCI control 1."""

    #                  bits    type  reset  description
    RXERRINTENA = F(  6,       RW,   0,     "receive error interrupt enable")
    SWRESET     = F(  5,       RW,   0,     "software reset: 0 holds the state machines and clears the flags")
    TXWAKE      = F(  3,       RW,   0,     "transmitter wake-up method", modelled=False)
    SLEEP       = F(  2,       RW,   0,     "receiver sleep", modelled=False)
    TXENA       = F(  1,       RW,   0,     "transmitter enable")
    RXENA       = F(  0,       RW,   0,     "receiver enable")


class SCIHBAUD(Register):
    """SCI baud rate, high byte."""

    BAUD = F(  7, 0,           RW,   0,     "BRR bits 15:8")


class SCILBAUD(Register):
    """SCI baud rate, low byte."""

    BAUD = F(  7, 0,           RW,   0,     "BRR bits 7:0")


class SCICTL2(Register):
    """SCI control 2."""

    #                 bits     type  reset  description
    TXRDY      = F(  7,        R,    1,     "SCITXBUF can take a character")
    TXEMPTY    = F(  6,        R,    1,     "buffer and shift register are empty")
    RXBKINTENA = F(  1,        RW,   0,     "receive buffer and break interrupt enable")
    TXINTENA   = F(  0,        RW,   0,     "transmit interrupt enable")


class SCIRXST(Register):
    """SCI receiver status: flags stay until SWRESET."""

    #              bits        type  reset  description
    RXERROR = F(  7,           R,    0,     "OR of BRKDT, FE, OE, PE")
    RXRDY   = F(  6,           R,    0,     "a character waits in SCIRXBUF")
    BRKDT   = F(  5,           R,    0,     "break detected")
    FE      = F(  4,           R,    0,     "framing error")
    OE      = F(  3,           R,    0,     "overrun error")
    PE      = F(  2,           R,    0,     "parity error")
    RXWAKE  = F(  1,           R,    0,     "receiver wake-up")


class SCIRXEMU(Register):
    """SCI receive emulation buffer: the character, without side effect."""

    ERXDT = F(  7, 0,          R,    0,     "received character")


class SCIRXBUF(Register):
    """SCI receive buffer: a read takes the character."""

    #              bits        type  reset  description
    SCIFFFE = F( 15,           R,    0,     "framing error of the character at the head of the FIFO")
    SCIFFPE = F( 14,           R,    0,     "parity error of the character at the head of the FIFO")
    SAR     = F(  7, 0,        R,    0,     "received character")


class SCITXBUF(Register, data=True):
    """SCI transmit buffer."""

    TXDT = F(  7, 0,           RW,   0,     "character to send")


class SCIFFTX(Register):
    """SCI FIFO transmit."""

    #                  bits    type  reset  description
    SCIRST      = F( 15,       RW,   1,     "0 resets the FIFO channels")
    SCIFFENA    = F( 14,       RW,   0,     "FIFO enhancements enable")
    TXFIFORESET = F( 13,       RW,   1,     "0 holds the transmit FIFO empty")
    TXFFST      = F( 12, 8,    R,    0,     "characters in the transmit FIFO")
    TXFFINT     = F(  7,       R,    0,     "transmit FIFO interrupt flag")
    TXFFINTCLR  = F(  6,       R0W1, 0,     "clear TXFFINT")
    TXFFIENA    = F(  5,       RW,   0,     "transmit FIFO interrupt enable")
    TXFFIL      = F(  4, 0,    RW,   0,     "interrupt when TXFFST <= TXFFIL")


class SCIFFRX(Register):
    """SCI FIFO receive."""

    #                  bits    type  reset  description
    RXFFOVF     = F( 15,       R,    0,     "receive FIFO overflow")
    RXFFOVRCLR  = F( 14,       R0W1, 0,     "clear RXFFOVF")
    RXFIFORESET = F( 13,       RW,   1,     "0 holds the receive FIFO empty")
    RXFFST      = F( 12, 8,    R,    0,     "characters in the receive FIFO")
    RXFFINT     = F(  7,       R,    0,     "receive FIFO interrupt flag")
    RXFFINTCLR  = F(  6,       R0W1, 0,     "clear RXFFINT")
    RXFFIENA    = F(  5,       RW,   0,     "receive FIFO interrupt enable")
    RXFFIL      = F(  4, 0,    RW,   0x1F,  "interrupt when RXFFST >= RXFFIL")


class SCIFFCT(Register):
    """SCI FIFO control."""

    #              bits        type  reset  description
    ABD     = F( 15,           R,    0,     "auto-baud detected")
    ABDCLR  = F( 14,           R0W1, 0,     "clear ABD")
    CDC     = F( 13,           RW,   0,     "auto-baud calibration", modelled=False)
    FFTXDLY = F(  7, 0,        RW,   0,     "bit times between two FIFO characters")


class SCIPRI(Register):
    """SCI priority control."""

    FREESOFT = F(  4, 3,       RW,   0,     "what an emulation halt does")


class SciRegs(Block, struct="SCI_REGS"):
    """One SCI module."""

    SCICCR   = At(0x00, SCICCR)
    SCICTL1  = At(0x01, SCICTL1)
    SCIHBAUD = At(0x02, SCIHBAUD)
    SCILBAUD = At(0x03, SCILBAUD)
    SCICTL2  = At(0x04, SCICTL2)
    SCIRXST  = At(0x05, SCIRXST)
    SCIRXEMU = At(0x06, SCIRXEMU)
    SCIRXBUF = At(0x07, SCIRXBUF)
    SCITXBUF = At(0x09, SCITXBUF)
    SCIFFTX  = At(0x0A, SCIFFTX)
    SCIFFRX  = At(0x0B, SCIFFRX)
    SCIFFCT  = At(0x0C, SCIFFCT)
    SCIPRI   = At(0x0F, SCIPRI)
