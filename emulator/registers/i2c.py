"""I2C-A/B registers.  TRM chapter I2C; HDR F2837xS_i2c.h.  Nothing here is EALLOW protected.

Bases: I2caRegs 0x7300, I2cbRegs 0x7340.
"""

from __future__ import annotations

from emulator.registers.core import R0W1, RW, W1C, At, Block, F, R, Register, Word


class I2COAR(Register):
    """Own address: the module's as a target."""

    OAR = F(  9, 0,           RW,   0,     "own address, 7 or 10 bits", modelled=False)


class I2CIER(Register):
    """Interrupt enable; the bits stand as their flags in I2CSTR, but for AAS."""

    #           bits          type  reset  description
    AAS  = F(  6,             RW,   0,     "addressed as target", modelled=False)
    SCD  = F(  5,             RW,   0,     "STOP condition detected")
    XRDY = F(  4,             RW,   0,     "I2CDXR takes data; not in FIFO mode")
    RRDY = F(  3,             RW,   0,     "I2CDRR holds data; not in FIFO mode")
    ARDY = F(  2,             RW,   0,     "registers ready to be accessed")
    NACK = F(  1,             RW,   0,     "no acknowledgment received")
    ARBL = F(  0,             RW,   0,     "arbitration lost")


class I2CSTR(Register):
    """Status."""

    #              bits       type  reset  description
    SDIR    = F( 14,          W1C,  0,     "addressed as a transmitting target")
    NACKSNT = F( 13,          W1C,  0,     "a no-acknowledge bit was sent")
    BB      = F( 12,          R,    0,     "bus busy: from a START to the STOP")
    RSFULL  = F( 11,          R,    0,     "overrun: the receive shift register is full, and I2CDRR was not read")
    XSMT    = F( 10,          R,    1,     "0 = underflow: the transmit shift register is empty, and so is I2CDXR")
    AAS     = F(  9,          R,    0,     "addressed as target")
    AD0     = F(  8,          R,    0,     "a general call was received")
    SCD     = F(  5,          W1C,  0,     "STOP condition detected")
    XRDY    = F(  4,          R,    1,     "I2CDXR takes data")
    RRDY    = F(  3,          W1C,  0,     "I2CDRR holds data; cleared by its read too")
    ARDY    = F(  2,          W1C,  0,     "the command has been carried out: registers may be written")
    NACK    = F(  1,          W1C,  0,     "no acknowledgment received")
    ARBL    = F(  0,          W1C,  0,     "arbitration lost")


class I2CDRR(Register):
    """Receive data."""

    DATA = F(  7, 0,          R,    0,     "byte received")


class I2CSAR(Register):
    """Address of the target that the next START is for."""

    SAR = F(  9, 0,           RW,   0x3FF, "target address: bits 6 to 0 with 7-bit addressing")


class I2CDXR(Register, data=True):
    """Transmit data."""

    DATA = F(  7, 0,          RW,   0,     "byte to send")


class I2CMDR(Register):
    """Mode."""

    #              bits       type  reset  description
    NACKMOD = F( 15,          RW,   0,     "receiver: no acknowledgment in the next acknowledge cycle")
    FREE    = F( 14,          RW,   0,     "goes on while a debugger halts the CPU")
    STT     = F( 13,          RW,   0,     "make a START; cleared when it is made")
    STP     = F( 11,          RW,   0,     "make a STOP when the data counter is 0; cleared when it is made")
    MST     = F( 10,          RW,   0,     "1 = controller; cleared by its STOP")
    TRX     = F(  9,          RW,   0,     "1 = transmitter")
    XA      = F(  8,          RW,   0,     "1 = 10-bit addressing")
    RM      = F(  7,          RW,   0,     "repeat mode: I2CCNT does not count")
    DLB     = F(  6,          RW,   0,     "digital loopback")
    IRS     = F(  5,          RW,   0,     "0 holds the module in reset")
    STB     = F(  4,          RW,   0,     "START byte mode", modelled=False)
    FDF     = F(  3,          RW,   0,     "free data format", modelled=False)
    BC      = F(  2, 0,       RW,   0,     "bits in a data byte, 0 = 8", modelled=False)


class I2CISRC(Register):
    """Interrupt source; a read of it clears it."""

    WRITE_ZEROS = F( 11, 8,   RW,   0,     "write 0")
    INTCODE     = F(  2, 0,   R,    0,     "1 ARBL, 2 NACK, 3 ARDY, 4 RRDY, 5 XRDY, 6 SCD, 7 AAS, 0 none")


class I2CEMDR(Register):
    """Extended mode."""

    BC = F(  0,               RW,   1,     "XRDY and XSMT of a transmitting target as in earlier devices", modelled=False)


class I2CPSC(Register):
    """Prescaler."""

    IPSC = F(  7, 0,          RW,   0,     "the module's clock is SYSCLK/(IPSC + 1)")


class I2CFFTX(Register):
    """FIFO transmit."""

    #                 bits    type  reset  description
    I2CFFEN    = F( 14,       RW,   0,     "FIFO mode, of both directions")
    TXFFRST    = F( 13,       RW,   0,     "0 holds the transmit FIFO empty")
    TXFFST     = F( 12, 8,    R,    0,     "bytes in the transmit FIFO")
    TXFFINT    = F(  7,       R,    0,     "transmit FIFO interrupt flag")
    TXFFINTCLR = F(  6,       R0W1, 0,     "clear TXFFINT")
    TXFFIENA   = F(  5,       RW,   0,     "transmit FIFO interrupt enable")
    TXFFIL     = F(  4, 0,    RW,   0,     "interrupt when TXFFST <= TXFFIL")


class I2CFFRX(Register):
    """FIFO receive."""

    #                 bits    type  reset  description
    RXFFRST    = F( 13,       RW,   0,     "0 holds the receive FIFO empty")
    RXFFST     = F( 12, 8,    R,    0,     "bytes in the receive FIFO")
    RXFFINT    = F(  7,       R,    0,     "receive FIFO interrupt flag")
    RXFFINTCLR = F(  6,       R0W1, 0,     "clear RXFFINT")
    RXFFIENA   = F(  5,       RW,   0,     "receive FIFO interrupt enable")
    RXFFIL     = F(  4, 0,    RW,   0,     "interrupt when RXFFST >= RXFFIL")


class I2cRegs(Block, struct="I2C_REGS"):
    """One I2C module."""

    I2COAR  = At(0x00, I2COAR)
    I2CIER  = At(0x01, I2CIER)
    I2CSTR  = At(0x02, I2CSTR)
    I2CCLKL = Word(0x03, RW, text="module clocks that SCL is low, less d")
    I2CCLKH = Word(0x04, RW, text="module clocks that SCL is high, less d")
    I2CCNT  = Word(0x05, RW, text="data bytes from START to STOP, 0 = 65536")
    I2CDRR  = At(0x06, I2CDRR)
    I2CSAR  = At(0x07, I2CSAR)
    I2CDXR  = At(0x08, I2CDXR)
    I2CMDR  = At(0x09, I2CMDR)
    I2CISRC = At(0x0A, I2CISRC)
    I2CEMDR = At(0x0B, I2CEMDR)
    I2CPSC  = At(0x0C, I2CPSC)
    I2CFFTX = At(0x20, I2CFFTX)
    I2CFFRX = At(0x21, I2CFFRX)
