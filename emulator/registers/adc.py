"""ADC control and result registers (ADC-A at 0x7400 / 0x0B00; B, C and D alike).

Offsets, widths and fields: HDR F2837xS_adc.h; protection and reset values: TRM, ADC registers.
Open/short detection, trims and the events of post-processing blocks to the trip zones are declared but not modelled.
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import R0W1, RW, At, Block, F, R, Register, Word


class ADCCTL1(Register, eallow=True):
    """ADC control 1.  TRM ADC registers; HDR ADCCTL1_BITS."""
    #               bits    type  reset  description
    ADCBSY      = F(13,     R,    0,     "ADC busy")
    ADCBSYCHN   = F(11, 8,  R,    0,     "SOC being converted, or converted last")
    ADCPWDNZ    = F( 7,     RW,   0,     "1 = analog core powered")
    INTPULSEPOS = F( 2,     RW,   0,     "interrupt pulse: 0 end of window, 1 end of conversion")


class ADCCTL2(Register, eallow=True):
    """ADC control 2.  TRM ADC registers; HDR ADCCTL2_BITS."""
    SIGNALMODE = F( 7,    RW, 0, "0 single-ended, 1 differential")
    RESOLUTION = F( 6,    RW, 0, "0 = 12 bits, 1 = 16 bits")
    PRESCALE   = F( 3, 0, RW, 0, "ADC clock prescaler")


class ADCBURSTCTL(Register, eallow=True):
    """Burst control.  TRM ADC registers; HDR ADCBURSTCTL_BITS."""
    BURSTEN      = F(15,    RW, 0, "burst mode enable")
    BURSTSIZE    = F(11, 8, RW, 0, "SOCs per burst, less one")
    BURSTTRIGSEL = F( 5, 0, RW, 0, "burst trigger source")


class ADCINTFLG(Register):
    """Interrupt flags, sticky.  TRM ADC registers; HDR ADCINTFLG_BITS."""
    ADCINT4 = F(3, R, 0, "ADCINT4 flag")
    ADCINT3 = F(2, R, 0, "ADCINT3 flag")
    ADCINT2 = F(1, R, 0, "ADCINT2 flag")
    ADCINT1 = F(0, R, 0, "ADCINT1 flag")


class ADCINTFLGCLR(Register, clears="ADCINTFLG"):
    """Clears ADCINTFLG.  TRM ADC registers; HDR ADCINTFLGCLR_BITS."""
    ADCINT4 = F(3, R0W1, 0, "clear ADCINT4 flag")
    ADCINT3 = F(2, R0W1, 0, "clear ADCINT3 flag")
    ADCINT2 = F(1, R0W1, 0, "clear ADCINT2 flag")
    ADCINT1 = F(0, R0W1, 0, "clear ADCINT1 flag")


class ADCINTOVF(Register):
    """Interrupt overflow.  TRM ADC registers; HDR ADCINTOVF_BITS."""
    ADCINT4 = F(3, R, 0, "ADCINT4 overflow")
    ADCINT3 = F(2, R, 0, "ADCINT3 overflow")
    ADCINT2 = F(1, R, 0, "ADCINT2 overflow")
    ADCINT1 = F(0, R, 0, "ADCINT1 overflow")


class ADCINTOVFCLR(Register):
    """Clears ADCINTOVF.  TRM ADC registers; HDR ADCINTOVFCLR_BITS."""
    ADCINT4 = F(3, R0W1, 0, "clear ADCINT4 overflow")
    ADCINT3 = F(2, R0W1, 0, "clear ADCINT3 overflow")
    ADCINT2 = F(1, R0W1, 0, "clear ADCINT2 overflow")
    ADCINT1 = F(0, R0W1, 0, "clear ADCINT1 overflow")


class ADCINTSEL1N2(Register, eallow=True):
    """Sources of ADCINT1 and ADCINT2.  TRM ADC registers; HDR ADCINTSEL1N2_BITS."""
    INT2CONT = F(14,    RW, 0, "ADCINT2 pulses even while its flag is set")
    INT2E    = F(13,    RW, 0, "ADCINT2 enable")
    INT2SEL  = F(11, 8, RW, 0, "EOC that raises ADCINT2")
    INT1CONT = F( 6,    RW, 0, "ADCINT1 pulses even while its flag is set")
    INT1E    = F( 5,    RW, 0, "ADCINT1 enable")
    INT1SEL  = F( 3, 0, RW, 0, "EOC that raises ADCINT1")


class ADCINTSEL3N4(Register, eallow=True):
    """Sources of ADCINT3 and ADCINT4.  TRM ADC registers; HDR ADCINTSEL3N4_BITS."""
    INT4CONT = F(14,    RW, 0, "ADCINT4 pulses even while its flag is set")
    INT4E    = F(13,    RW, 0, "ADCINT4 enable")
    INT4SEL  = F(11, 8, RW, 0, "EOC that raises ADCINT4")
    INT3CONT = F( 6,    RW, 0, "ADCINT3 pulses even while its flag is set")
    INT3E    = F( 5,    RW, 0, "ADCINT3 enable")
    INT3SEL  = F( 3, 0, RW, 0, "EOC that raises ADCINT3")


class ADCSOCPRICTL(Register, eallow=True):
    """SOC priority.  TRM ADC registers; HDR ADCSOCPRICTL_BITS."""
    RRPOINTER   = F( 9, 5, R,  16, "last round-robin SOC converted; 16 = none")
    SOCPRIORITY = F( 4, 0, RW, 0,  "SOC0..SOC(n-1) have high priority")


class ADCINTSOCSEL1(Register, eallow=True):
    """ADCINT re-triggers of SOC0..7: 0 none, 1 ADCINT1, 2 ADCINT2.  TRM ADC registers; HDR ADCINTSOCSEL1_BITS."""
    SOC7 = F(15, 14, RW, 0, "re-trigger of SOC7")
    SOC6 = F(13, 12, RW, 0, "re-trigger of SOC6")
    SOC5 = F(11, 10, RW, 0, "re-trigger of SOC5")
    SOC4 = F( 9,  8, RW, 0, "re-trigger of SOC4")
    SOC3 = F( 7,  6, RW, 0, "re-trigger of SOC3")
    SOC2 = F( 5,  4, RW, 0, "re-trigger of SOC2")
    SOC1 = F( 3,  2, RW, 0, "re-trigger of SOC1")
    SOC0 = F( 1,  0, RW, 0, "re-trigger of SOC0")


class ADCINTSOCSEL2(Register, eallow=True):
    """ADCINT re-triggers of SOC8..15.  TRM ADC registers; HDR ADCINTSOCSEL2_BITS."""
    SOC15 = F(15, 14, RW, 0, "re-trigger of SOC15")
    SOC14 = F(13, 12, RW, 0, "re-trigger of SOC14")
    SOC13 = F(11, 10, RW, 0, "re-trigger of SOC13")
    SOC12 = F( 9,  8, RW, 0, "re-trigger of SOC12")
    SOC11 = F( 7,  6, RW, 0, "re-trigger of SOC11")
    SOC10 = F( 5,  4, RW, 0, "re-trigger of SOC10")
    SOC9  = F( 3,  2, RW, 0, "re-trigger of SOC9")
    SOC8  = F( 1,  0, RW, 0, "re-trigger of SOC8")


class ADCSOCFLG1(Register):
    """SOC pending, cleared when sampling starts.  TRM ADC registers; HDR ADCSOCFLG1_BITS."""
    SOC15 = F(15, R, 0, "SOC15 pending")
    SOC14 = F(14, R, 0, "SOC14 pending")
    SOC13 = F(13, R, 0, "SOC13 pending")
    SOC12 = F(12, R, 0, "SOC12 pending")
    SOC11 = F(11, R, 0, "SOC11 pending")
    SOC10 = F(10, R, 0, "SOC10 pending")
    SOC9  = F( 9, R, 0, "SOC9 pending")
    SOC8  = F( 8, R, 0, "SOC8 pending")
    SOC7  = F( 7, R, 0, "SOC7 pending")
    SOC6  = F( 6, R, 0, "SOC6 pending")
    SOC5  = F( 5, R, 0, "SOC5 pending")
    SOC4  = F( 4, R, 0, "SOC4 pending")
    SOC3  = F( 3, R, 0, "SOC3 pending")
    SOC2  = F( 2, R, 0, "SOC2 pending")
    SOC1  = F( 1, R, 0, "SOC1 pending")
    SOC0  = F( 0, R, 0, "SOC0 pending")


class ADCSOCFRC1(Register):
    """Forces SOCs.  TRM ADC registers; HDR ADCSOCFRC1_BITS."""
    SOC15 = F(15, R0W1, 0, "force SOC15")
    SOC14 = F(14, R0W1, 0, "force SOC14")
    SOC13 = F(13, R0W1, 0, "force SOC13")
    SOC12 = F(12, R0W1, 0, "force SOC12")
    SOC11 = F(11, R0W1, 0, "force SOC11")
    SOC10 = F(10, R0W1, 0, "force SOC10")
    SOC9  = F( 9, R0W1, 0, "force SOC9")
    SOC8  = F( 8, R0W1, 0, "force SOC8")
    SOC7  = F( 7, R0W1, 0, "force SOC7")
    SOC6  = F( 6, R0W1, 0, "force SOC6")
    SOC5  = F( 5, R0W1, 0, "force SOC5")
    SOC4  = F( 4, R0W1, 0, "force SOC4")
    SOC3  = F( 3, R0W1, 0, "force SOC3")
    SOC2  = F( 2, R0W1, 0, "force SOC2")
    SOC1  = F( 1, R0W1, 0, "force SOC1")
    SOC0  = F( 0, R0W1, 0, "force SOC0")


class ADCSOCOVF1(Register):
    """SOC triggered while it was pending.  TRM ADC registers; HDR ADCSOCOVF1_BITS."""
    SOC15 = F(15, R, 0, "SOC15 overflow")
    SOC14 = F(14, R, 0, "SOC14 overflow")
    SOC13 = F(13, R, 0, "SOC13 overflow")
    SOC12 = F(12, R, 0, "SOC12 overflow")
    SOC11 = F(11, R, 0, "SOC11 overflow")
    SOC10 = F(10, R, 0, "SOC10 overflow")
    SOC9  = F( 9, R, 0, "SOC9 overflow")
    SOC8  = F( 8, R, 0, "SOC8 overflow")
    SOC7  = F( 7, R, 0, "SOC7 overflow")
    SOC6  = F( 6, R, 0, "SOC6 overflow")
    SOC5  = F( 5, R, 0, "SOC5 overflow")
    SOC4  = F( 4, R, 0, "SOC4 overflow")
    SOC3  = F( 3, R, 0, "SOC3 overflow")
    SOC2  = F( 2, R, 0, "SOC2 overflow")
    SOC1  = F( 1, R, 0, "SOC1 overflow")
    SOC0  = F( 0, R, 0, "SOC0 overflow")


class ADCSOCOVFCLR1(Register):
    """Clears ADCSOCOVF1.  TRM ADC registers; HDR ADCSOCOVFCLR1_BITS."""
    SOC15 = F(15, R0W1, 0, "clear SOC15 overflow")
    SOC14 = F(14, R0W1, 0, "clear SOC14 overflow")
    SOC13 = F(13, R0W1, 0, "clear SOC13 overflow")
    SOC12 = F(12, R0W1, 0, "clear SOC12 overflow")
    SOC11 = F(11, R0W1, 0, "clear SOC11 overflow")
    SOC10 = F(10, R0W1, 0, "clear SOC10 overflow")
    SOC9  = F( 9, R0W1, 0, "clear SOC9 overflow")
    SOC8  = F( 8, R0W1, 0, "clear SOC8 overflow")
    SOC7  = F( 7, R0W1, 0, "clear SOC7 overflow")
    SOC6  = F( 6, R0W1, 0, "clear SOC6 overflow")
    SOC5  = F( 5, R0W1, 0, "clear SOC5 overflow")
    SOC4  = F( 4, R0W1, 0, "clear SOC4 overflow")
    SOC3  = F( 3, R0W1, 0, "clear SOC3 overflow")
    SOC2  = F( 2, R0W1, 0, "clear SOC2 overflow")
    SOC1  = F( 1, R0W1, 0, "clear SOC1 overflow")
    SOC0  = F( 0, R0W1, 0, "clear SOC0 overflow")


class ADCSOCxCTL(Register, bits=32, eallow=True):
    """SOCx control.  TRM ADC registers; HDR ADCSOC0CTL_BITS."""
    TRIGSEL = F(24, 20, RW, 0, "trigger source")
    CHSEL   = F(18, 15, RW, 0, "channel")
    ACQPS   = F( 8,  0, RW, 0, "sample window in SYSCLK, less one")


class ADCOSDETECT(Register, eallow=True):
    """Open and short detection.  TRM ADC registers; HDR ADCOSDETECT_BITS."""
    DETECTCFG = F(2, 0, RW, 0, "detection circuit", modelled=False)


class ADCCOUNTER(Register):
    """Free-running SYSCLK counter.  TRM ADC registers; HDR ADCCOUNTER_BITS."""
    FREECOUNT = F(11, 0, R, 0, "counter")


class ADCREV(Register):
    """Revision.  TRM ADC registers; HDR ADCREV_BITS."""
    REV  = F(15, 8, R, 0, "revision", modelled=False)
    TYPE = F( 7, 0, R, 0, "ADC type", modelled=False)


class ADCOFFTRIM(Register, eallow=True):
    """Offset trim.  TRM ADC registers; HDR ADCOFFTRIM_BITS."""
    OFFTRIM = F(7, 0, RW, 0, "offset trim", modelled=False)


# Post-processing blocks and their events


class ADCEVTSTAT(Register):
    """PPB event status.  TRM ADC registers; HDR ADCEVTSTAT_BITS."""
    PPB4ZERO   = F(14, R, 0, "PPB4 zero crossing event")
    PPB4TRIPLO = F(13, R, 0, "PPB4 trip low event")
    PPB4TRIPHI = F(12, R, 0, "PPB4 trip high event")
    PPB3ZERO   = F(10, R, 0, "PPB3 zero crossing event")
    PPB3TRIPLO = F( 9, R, 0, "PPB3 trip low event")
    PPB3TRIPHI = F( 8, R, 0, "PPB3 trip high event")
    PPB2ZERO   = F( 6, R, 0, "PPB2 zero crossing event")
    PPB2TRIPLO = F( 5, R, 0, "PPB2 trip low event")
    PPB2TRIPHI = F( 4, R, 0, "PPB2 trip high event")
    PPB1ZERO   = F( 2, R, 0, "PPB1 zero crossing event")
    PPB1TRIPLO = F( 1, R, 0, "PPB1 trip low event")
    PPB1TRIPHI = F( 0, R, 0, "PPB1 trip high event")


class ADCEVTCLR(Register):
    """Clears ADCEVTSTAT.  TRM ADC registers; HDR ADCEVTCLR_BITS."""
    PPB4ZERO   = F(14, R0W1, 0, "PPB4 zero crossing clear event")
    PPB4TRIPLO = F(13, R0W1, 0, "PPB4 trip low clear event")
    PPB4TRIPHI = F(12, R0W1, 0, "PPB4 trip high clear event")
    PPB3ZERO   = F(10, R0W1, 0, "PPB3 zero crossing clear event")
    PPB3TRIPLO = F( 9, R0W1, 0, "PPB3 trip low clear event")
    PPB3TRIPHI = F( 8, R0W1, 0, "PPB3 trip high clear event")
    PPB2ZERO   = F( 6, R0W1, 0, "PPB2 zero crossing clear event")
    PPB2TRIPLO = F( 5, R0W1, 0, "PPB2 trip low clear event")
    PPB2TRIPHI = F( 4, R0W1, 0, "PPB2 trip high clear event")
    PPB1ZERO   = F( 2, R0W1, 0, "PPB1 zero crossing clear event")
    PPB1TRIPLO = F( 1, R0W1, 0, "PPB1 trip low clear event")
    PPB1TRIPHI = F( 0, R0W1, 0, "PPB1 trip high clear event")


class ADCEVTSEL(Register, eallow=True):
    """PPB events to the trip zone.  TRM ADC registers; HDR ADCEVTSEL_BITS."""
    PPB4ZERO   = F(14, RW, 0, "PPB4 zero crossing event enable", modelled=False)
    PPB4TRIPLO = F(13, RW, 0, "PPB4 trip low event enable", modelled=False)
    PPB4TRIPHI = F(12, RW, 0, "PPB4 trip high event enable", modelled=False)
    PPB3ZERO   = F(10, RW, 0, "PPB3 zero crossing event enable", modelled=False)
    PPB3TRIPLO = F( 9, RW, 0, "PPB3 trip low event enable", modelled=False)
    PPB3TRIPHI = F( 8, RW, 0, "PPB3 trip high event enable", modelled=False)
    PPB2ZERO   = F( 6, RW, 0, "PPB2 zero crossing event enable", modelled=False)
    PPB2TRIPLO = F( 5, RW, 0, "PPB2 trip low event enable", modelled=False)
    PPB2TRIPHI = F( 4, RW, 0, "PPB2 trip high event enable", modelled=False)
    PPB1ZERO   = F( 2, RW, 0, "PPB1 zero crossing event enable", modelled=False)
    PPB1TRIPLO = F( 1, RW, 0, "PPB1 trip low event enable", modelled=False)
    PPB1TRIPHI = F( 0, RW, 0, "PPB1 trip high event enable", modelled=False)


class ADCEVTINTSEL(Register, eallow=True):
    """PPB events to the interrupt.  TRM ADC registers; HDR ADCEVTINTSEL_BITS."""
    PPB4ZERO   = F(14, RW, 0, "PPB4 zero crossing event interrupt enable")
    PPB4TRIPLO = F(13, RW, 0, "PPB4 trip low event interrupt enable")
    PPB4TRIPHI = F(12, RW, 0, "PPB4 trip high event interrupt enable")
    PPB3ZERO   = F(10, RW, 0, "PPB3 zero crossing event interrupt enable")
    PPB3TRIPLO = F( 9, RW, 0, "PPB3 trip low event interrupt enable")
    PPB3TRIPHI = F( 8, RW, 0, "PPB3 trip high event interrupt enable")
    PPB2ZERO   = F( 6, RW, 0, "PPB2 zero crossing event interrupt enable")
    PPB2TRIPLO = F( 5, RW, 0, "PPB2 trip low event interrupt enable")
    PPB2TRIPHI = F( 4, RW, 0, "PPB2 trip high event interrupt enable")
    PPB1ZERO   = F( 2, RW, 0, "PPB1 zero crossing event interrupt enable")
    PPB1TRIPLO = F( 1, RW, 0, "PPB1 trip low event interrupt enable")
    PPB1TRIPHI = F( 0, RW, 0, "PPB1 trip high event interrupt enable")


class ADCPPBxCONFIG(Register, eallow=True):
    """Post-processing block x configuration.  TRM ADC registers; HDR ADCPPB1CONFIG_BITS."""
    TWOSCOMPEN = F(4,    RW, 0, "two's complement")
    CONFIG     = F(3, 0, RW, 0, "SOC watched")


class ADCPPBxSTAMP(Register):
    """Post-processing block x delay stamp.  TRM ADC registers; HDR ADCPPB1STAMP_BITS."""
    DLYSTAMP = F(11, 0, R, 0, "delay from trigger to sample")


class ADCPPBxOFFCAL(Register, eallow=True, data=True):
    """Post-processing block x offset correction.  TRM ADC registers; HDR ADCPPB1OFFCAL_BITS."""
    OFFCAL = F(9, 0, RW, 0, "offset subtracted from the result")


class ADCPPBxTRIPHI(Register, bits=32, eallow=True):
    """Post-processing block x high limit.  TRM ADC registers; HDR ADCPPB1TRIPHI_BITS."""
    HSIGN   = F(16,     RW, 0, "sign of the limit")
    LIMITHI = F(15,  0, RW, 0, "high limit")


class ADCPPBxTRIPLO(Register, bits=32, eallow=True):
    """Post-processing block x low limit.  TRM ADC registers; HDR ADCPPB1TRIPLO_BITS."""
    REQSTAMP = F(31, 20, R,  0, "request stamp")
    LSIGN    = F(16,     RW, 0, "sign of the limit")
    LIMITLO  = F(15,  0, RW, 0, "low limit")


class ADCPPBxRESULT(Register, bits=32):
    """Post-processing block x result.  TRM ADC registers; HDR ADCPPB1RESULT_BITS."""
    SIGN      = F(31, 16, R, 0, "sign extension")
    PPBRESULT = F(15,  0, R, 0, "result")


class AdcRegs(Block, struct="ADC_REGS"):
    """ADC control registers.  HDR struct ADC_REGS."""
    ADCCTL1       = At(0x00, ADCCTL1)
    ADCCTL2       = At(0x01, ADCCTL2)
    ADCBURSTCTL   = At(0x02, ADCBURSTCTL)
    ADCINTFLG     = At(0x03, ADCINTFLG)
    ADCINTFLGCLR  = At(0x04, ADCINTFLGCLR)
    ADCINTOVF     = At(0x05, ADCINTOVF)
    ADCINTOVFCLR  = At(0x06, ADCINTOVFCLR)
    ADCINTSEL1N2  = At(0x07, ADCINTSEL1N2)
    ADCINTSEL3N4  = At(0x08, ADCINTSEL3N4)
    ADCSOCPRICTL  = At(0x09, ADCSOCPRICTL)
    ADCINTSOCSEL1 = At(0x0A, ADCINTSOCSEL1)
    ADCINTSOCSEL2 = At(0x0B, ADCINTSOCSEL2)
    ADCSOCFLG1    = At(0x0C, ADCSOCFLG1)
    ADCSOCFRC1    = At(0x0D, ADCSOCFRC1)
    ADCSOCOVF1    = At(0x0E, ADCSOCOVF1)
    ADCSOCOVFCLR1 = At(0x0F, ADCSOCOVFCLR1)
    ADCSOC0CTL    = At(0x10, ADCSOCxCTL)
    ADCSOC1CTL    = At(0x12, ADCSOCxCTL)
    ADCSOC2CTL    = At(0x14, ADCSOCxCTL)
    ADCSOC3CTL    = At(0x16, ADCSOCxCTL)
    ADCSOC4CTL    = At(0x18, ADCSOCxCTL)
    ADCSOC5CTL    = At(0x1A, ADCSOCxCTL)
    ADCSOC6CTL    = At(0x1C, ADCSOCxCTL)
    ADCSOC7CTL    = At(0x1E, ADCSOCxCTL)
    ADCSOC8CTL    = At(0x20, ADCSOCxCTL)
    ADCSOC9CTL    = At(0x22, ADCSOCxCTL)
    ADCSOC10CTL   = At(0x24, ADCSOCxCTL)
    ADCSOC11CTL   = At(0x26, ADCSOCxCTL)
    ADCSOC12CTL   = At(0x28, ADCSOCxCTL)
    ADCSOC13CTL   = At(0x2A, ADCSOCxCTL)
    ADCSOC14CTL   = At(0x2C, ADCSOCxCTL)
    ADCSOC15CTL   = At(0x2E, ADCSOCxCTL)
    ADCEVTSTAT    = At(0x30, ADCEVTSTAT)
    ADCEVTCLR     = At(0x32, ADCEVTCLR)
    ADCEVTSEL     = At(0x34, ADCEVTSEL)
    ADCEVTINTSEL  = At(0x36, ADCEVTINTSEL)
    ADCOSDETECT   = At(0x38, ADCOSDETECT)
    ADCCOUNTER    = At(0x39, ADCCOUNTER)
    ADCREV        = At(0x3A, ADCREV)
    ADCOFFTRIM    = At(0x3B, ADCOFFTRIM)
    ADCPPB1CONFIG = At(0x40, ADCPPBxCONFIG)
    ADCPPB1STAMP  = At(0x41, ADCPPBxSTAMP)
    ADCPPB1OFFCAL = At(0x42, ADCPPBxOFFCAL)
    ADCPPB1OFFREF = Word(0x43, RW, 0, text="PPB1 offset reference")
    ADCPPB1TRIPHI = At(0x44, ADCPPBxTRIPHI)
    ADCPPB1TRIPLO = At(0x46, ADCPPBxTRIPLO)
    ADCPPB2CONFIG = At(0x48, ADCPPBxCONFIG)
    ADCPPB2STAMP  = At(0x49, ADCPPBxSTAMP)
    ADCPPB2OFFCAL = At(0x4A, ADCPPBxOFFCAL)
    ADCPPB2OFFREF = Word(0x4B, RW, 0, text="PPB2 offset reference")
    ADCPPB2TRIPHI = At(0x4C, ADCPPBxTRIPHI)
    ADCPPB2TRIPLO = At(0x4E, ADCPPBxTRIPLO)
    ADCPPB3CONFIG = At(0x50, ADCPPBxCONFIG)
    ADCPPB3STAMP  = At(0x51, ADCPPBxSTAMP)
    ADCPPB3OFFCAL = At(0x52, ADCPPBxOFFCAL)
    ADCPPB3OFFREF = Word(0x53, RW, 0, text="PPB3 offset reference")
    ADCPPB3TRIPHI = At(0x54, ADCPPBxTRIPHI)
    ADCPPB3TRIPLO = At(0x56, ADCPPBxTRIPLO)
    ADCPPB4CONFIG = At(0x58, ADCPPBxCONFIG)
    ADCPPB4STAMP  = At(0x59, ADCPPBxSTAMP)
    ADCPPB4OFFCAL = At(0x5A, ADCPPBxOFFCAL)
    ADCPPB4OFFREF = Word(0x5B, RW, 0, text="PPB4 offset reference")
    ADCPPB4TRIPHI = At(0x5C, ADCPPBxTRIPHI)
    ADCPPB4TRIPLO = At(0x5E, ADCPPBxTRIPLO)
    ADCINLTRIM1   = Word(0x70, RW, 0, 32, eallow=True, modelled=False, text="linearity trim 1")
    ADCINLTRIM2   = Word(0x72, RW, 0, 32, eallow=True, modelled=False, text="linearity trim 2")
    ADCINLTRIM3   = Word(0x74, RW, 0, 32, eallow=True, modelled=False, text="linearity trim 3")
    ADCINLTRIM4   = Word(0x76, RW, 0, 32, eallow=True, modelled=False, text="linearity trim 4")
    ADCINLTRIM5   = Word(0x78, RW, 0, 32, eallow=True, modelled=False, text="linearity trim 5")
    ADCINLTRIM6   = Word(0x7A, RW, 0, 32, eallow=True, modelled=False, text="linearity trim 6")


class AdcResultRegs(Block, struct="ADC_RESULT_REGS"):
    """ADC results, on a frame of their own without wait states.  HDR struct ADC_RESULT_REGS."""
    ADCRESULT0    = Word(0x00, R, 0, text="result of SOC0")
    ADCRESULT1    = Word(0x01, R, 0, text="result of SOC1")
    ADCRESULT2    = Word(0x02, R, 0, text="result of SOC2")
    ADCRESULT3    = Word(0x03, R, 0, text="result of SOC3")
    ADCRESULT4    = Word(0x04, R, 0, text="result of SOC4")
    ADCRESULT5    = Word(0x05, R, 0, text="result of SOC5")
    ADCRESULT6    = Word(0x06, R, 0, text="result of SOC6")
    ADCRESULT7    = Word(0x07, R, 0, text="result of SOC7")
    ADCRESULT8    = Word(0x08, R, 0, text="result of SOC8")
    ADCRESULT9    = Word(0x09, R, 0, text="result of SOC9")
    ADCRESULT10   = Word(0x0A, R, 0, text="result of SOC10")
    ADCRESULT11   = Word(0x0B, R, 0, text="result of SOC11")
    ADCRESULT12   = Word(0x0C, R, 0, text="result of SOC12")
    ADCRESULT13   = Word(0x0D, R, 0, text="result of SOC13")
    ADCRESULT14   = Word(0x0E, R, 0, text="result of SOC14")
    ADCRESULT15   = Word(0x0F, R, 0, text="result of SOC15")
    ADCPPB1RESULT = At(0x10, ADCPPBxRESULT)
    ADCPPB2RESULT = At(0x12, ADCPPBxRESULT)
    ADCPPB3RESULT = At(0x14, ADCPPBxRESULT)
    ADCPPB4RESULT = At(0x16, ADCPPBxRESULT)
