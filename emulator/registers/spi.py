"""SPI-A/B/C registers.  TRM chapter SPI; HDR F2837xS_spi.h.  Nothing here is EALLOW protected.

Bases: SpiaRegs 0x6100, SpibRegs 0x6110, SpicRegs 0x6120.
"""

from __future__ import annotations

from emulator.registers.core import R0W1, RW, W1C, At, Block, F, R, Register, Word


class SPICCR(Register):
    """SPI configuration control."""

    #                  bits    type  reset  description
    SPISWRESET  = F(  7,       RW,   0,     "software reset: 0 holds the state machine and clears the flags")
    CLKPOLARITY = F(  6,       RW,   0,     "shift clock polarity: level of the idle clock")
    HS_MODE     = F(  5,       RW,   0,     "high speed mode: pin timing only")
    SPILBK      = F(  4,       RW,   0,     "loopback: SIMO joined to SOMI inside")
    SPICHAR     = F(  3, 0,    RW,   0,     "character length minus 1")


class SPICTL(Register):
    """SPI operation control."""

    #                    bits  type  reset  description
    OVERRUNINTENA = F(  4,     RW,   0,     "overrun interrupt enable")
    CLK_PHASE     = F(  3,     RW,   0,     "clock phase: 1 = data half a cycle early")
    MASTER_SLAVE  = F(  2,     RW,   0,     "network mode: 1 = master")
    TALK          = F(  1,     RW,   0,     "transmit enable: 0 = output in high impedance")
    SPIINTENA     = F(  0,     RW,   0,     "SPI interrupt enable")


class SPISTS(Register):
    """SPI status."""

    #                   bits   type  reset  description
    OVERRUN_FLAG = F(  7,      W1C,  0,     "a character came before the last one was read")
    INT_FLAG     = F(  6,      R,    0,     "character complete; cleared by reading SPIRXBUF")
    BUFFULL_FLAG = F(  5,      R,    0,     "SPITXBUF holds a waiting character")


class SPIBRR(Register):
    """SPI baud rate."""

    SPI_BIT_RATE = F(  6, 0,   RW,   0,     "LSPCLK/(n+1) for n = 3..127, LSPCLK/4 below")


class SPIFFTX(Register):
    """SPI FIFO transmit."""

    #                 bits     type  reset  description
    SPIRST     = F( 15,        RW,   1,     "0 resets the FIFO channels")
    SPIFFENA   = F( 14,        RW,   0,     "FIFO enhancements enable")
    TXFIFO     = F( 13,        RW,   1,     "0 holds the transmit FIFO empty")
    TXFFST     = F( 12, 8,     R,    0,     "words in the transmit FIFO")
    TXFFINT    = F(  7,        R,    0,     "transmit FIFO interrupt flag")
    TXFFINTCLR = F(  6,        R0W1, 0,     "clear TXFFINT")
    TXFFIENA   = F(  5,        RW,   0,     "transmit FIFO interrupt enable")
    TXFFIL     = F(  4, 0,     RW,   0,     "interrupt when TXFFST <= TXFFIL")


class SPIFFRX(Register):
    """SPI FIFO receive."""

    #                  bits    type  reset  description
    RXFFOVF     = F( 15,       R,    0,     "receive FIFO overflow")
    RXFFOVFCLR  = F( 14,       R0W1, 0,     "clear RXFFOVF")
    RXFIFORESET = F( 13,       RW,   1,     "0 holds the receive FIFO empty")
    RXFFST      = F( 12, 8,    R,    0,     "words in the receive FIFO")
    RXFFINT     = F(  7,       R,    0,     "receive FIFO interrupt flag")
    RXFFINTCLR  = F(  6,       R0W1, 0,     "clear RXFFINT")
    RXFFIENA    = F(  5,       RW,   0,     "receive FIFO interrupt enable")
    RXFFIL      = F(  4, 0,    RW,   0x1F,  "interrupt when RXFFST >= RXFFIL")


class SPIFFCT(Register):
    """SPI FIFO control."""

    TXDLY = F(  7, 0,          RW,   0,     "SPICLK cycles between two FIFO words")


class SPIPRI(Register):
    """SPI priority control."""

    #              bits        type  reset  description
    SOFT    = F(  5,           RW,   0,     "soft emulation mode")
    FREE    = F(  4,           RW,   0,     "free emulation mode")
    STEINV  = F(  1,           RW,   0,     "SPISTE inversion", modelled=False)
    TRIWIRE = F(  0,           RW,   0,     "3-wire mode", modelled=False)


class SpiRegs(Block, struct="SPI_REGS"):
    """One SPI module."""

    SPICCR   = At(0x00, SPICCR)
    SPICTL   = At(0x01, SPICTL)
    SPISTS   = At(0x02, SPISTS)
    SPIBRR   = At(0x04, SPIBRR)
    SPIRXEMU = Word(0x06, R, text="receive buffer without side effect")
    SPIRXBUF = Word(0x07, R, text="receive buffer, right-justified; a read clears INT_FLAG")
    SPITXBUF = Word(0x08, RW, text="transmit buffer, left-justified")
    SPIDAT   = Word(0x09, RW, text="shift register")
    SPIFFTX  = At(0x0A, SPIFFTX)
    SPIFFRX  = At(0x0B, SPIFFRX)
    SPIFFCT  = At(0x0C, SPIFFCT)
    SPIPRI   = At(0x0F, SPIPRI)
