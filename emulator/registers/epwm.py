"""ePWM1-12: the block, and its time base, counter compare, action qualifier and event trigger (TRM chapter ePWM, type 4;
names, offsets and bits as in HDR F2837xS_epwm.h).

Base 0x4000 + 0x100 * (n - 1).  EALLOW protects the trip zone, digital compare, valley, high-resolution and global-load
registers.  In the 32-bit pairs CMPA, CMPB and TBPHS the value is the high word.
"""

from __future__ import annotations

from emulator.registers.core import R0W1, RW, W1C, At, Block, F, R, Register, Word
from emulator.registers.epwm_output import (
    DBCTL,
    DBCTL2,
    DBFED,
    DBFEDHR,
    DBRED,
    DBREDHR,
    EPWMXLINK,
    GLDCFG,
    GLDCTL,
    GLDCTL2,
    HRCNFG,
    HRCNFG2,
    HRMSTEP,
    HRPCTL,
    HRPWR,
    PCCTL,
    TRREM,
    VCAPCTL,
    VCNTCFG,
)
from emulator.registers.epwm_trip import (
    DCACTL,
    DCAHTRIPSEL,
    DCALTRIPSEL,
    DCBCTL,
    DCBHTRIPSEL,
    DCBLTRIPSEL,
    DCCAPCTL,
    DCFCTL,
    DCTRIPSEL,
    TZCBCCLR,
    TZCBCFLG,
    TZCLR,
    TZCTL,
    TZCTL2,
    TZCTLDCA,
    TZCTLDCB,
    TZDCSEL,
    TZEINT,
    TZFLG,
    TZFRC,
    TZOSTCLR,
    TZOSTFLG,
    TZSEL,
)


class TBCTL(Register):
    #             bits     type  reset  description
    CTRMODE   = F( 1,  0,  RW,   3,     "0 up, 1 down, 2 up-down, 3 stopped")
    PHSEN     = F( 2,      RW,   0,     "sync loads TBPHS into TBCTR")
    PRDLD     = F( 3,      RW,   0,     "TBPRD: 0 shadowed, loads at CTR = 0; 1 immediate")
    SYNCOSEL  = F( 5,  4,  RW,   0,     "sync output: 0 sync input, 1 CTR = 0, 2 CTR = CMPB, 3 none")
    SWFSYNC   = F( 6,      R0W1, 0,     "one sync pulse now")
    HSPCLKDIV = F( 9,  7,  RW,   1,     "prescaler: 0 /1, n /(2n)")
    CLKDIV    = F(12, 10,  RW,   0,     "prescaler: /(2^n)")
    PHSDIR    = F(13,      RW,   0,     "up-down: direction after a sync, 1 up")
    FREE_SOFT = F(15, 14,  RW,   0,     "emulation halt (no debugger halts this CPU)")


class TBCTL2(Register):
    #                bits     type  reset  description
    OSHTSYNCMODE = F( 6,      RW,   0,     "one-shot sync mode", modelled=False)
    OSHTSYNC     = F( 7,      R0W1, 0,     "one-shot sync", modelled=False)
    SYNCOSELX    = F(13, 12,  RW,   0,     "extended sync output select", modelled=False)
    PRDLDSYNC    = F(15, 14,  RW,   0,     "TBPRD shadow load: 1 also at sync, 2 at sync only", modelled=False)


class TBSTS(Register):
    #          bits     type  reset  description
    CTRDIR = F( 0,      R,    1,     "counting up")
    SYNCI  = F( 1,      W1C,  0,     "a sync came in")
    CTRMAX = F( 2,      W1C,  0,     "TBCTR was 0xFFFF")


class CMPCTL(Register):
    #             bits     type  reset  description
    LOADAMODE = F( 1,  0,  RW,   0,     "CMPA loads at: 0 zero, 1 period, 2 both, 3 never")
    LOADBMODE = F( 3,  2,  RW,   0,     "CMPB loads at: 0 zero, 1 period, 2 both, 3 never")
    SHDWAMODE = F( 4,      RW,   0,     "CMPA: 0 shadowed, 1 immediate")
    SHDWBMODE = F( 6,      RW,   0,     "CMPB: 0 shadowed, 1 immediate")
    SHDWAFULL = F( 8,      R,    0,     "CMPA shadow waits to be loaded")
    SHDWBFULL = F( 9,      R,    0,     "CMPB shadow waits to be loaded")
    LOADASYNC = F(11, 10,  RW,   0,     "CMPA shadow load at sync", modelled=False)
    LOADBSYNC = F(13, 12,  RW,   0,     "CMPB shadow load at sync", modelled=False)


class CMPCTL2(Register):
    #             bits     type  reset  description
    LOADCMODE = F( 1,  0,  RW,   0,     "CMPC load event", modelled=False)
    LOADDMODE = F( 3,  2,  RW,   0,     "CMPD load event", modelled=False)
    SHDWCMODE = F( 4,      RW,   0,     "CMPC immediate", modelled=False)
    SHDWDMODE = F( 6,      RW,   0,     "CMPD immediate", modelled=False)
    LOADCSYNC = F(11, 10,  RW,   0,     "CMPC load at sync", modelled=False)
    LOADDSYNC = F(13, 12,  RW,   0,     "CMPD load at sync", modelled=False)


class AQCTL(Register):
    #               bits     type  reset  description
    LDAQAMODE   = F( 1,  0,  RW,   0,     "AQCTLA loads at: 0 zero, 1 period, 2 both, 3 never")
    LDAQBMODE   = F( 3,  2,  RW,   0,     "AQCTLB loads at: 0 zero, 1 period, 2 both, 3 never")
    SHDWAQAMODE = F( 4,      RW,   0,     "AQCTLA: 0 immediate, 1 shadowed")
    SHDWAQBMODE = F( 6,      RW,   0,     "AQCTLB: 0 immediate, 1 shadowed")
    LDAQASYNC   = F( 9,  8,  RW,   0,     "AQCTLA load at sync", modelled=False)
    LDAQBSYNC   = F(11, 10,  RW,   0,     "AQCTLB load at sync", modelled=False)


class AQTSRCSEL(Register):
    #         bits     type  reset  description
    T1SEL = F( 3,  0,  RW,   0,     "source of event T1", modelled=False)
    T2SEL = F( 7,  4,  RW,   0,     "source of event T2", modelled=False)


class AQCTLA(Register):
    #       bits     type  reset  description
    ZRO = F( 1,  0,  RW,   0,     "at CTR = 0: 0 nothing, 1 clear, 2 set, 3 toggle")
    PRD = F( 3,  2,  RW,   0,     "at CTR = TBPRD")
    CAU = F( 5,  4,  RW,   0,     "at CTR = CMPA counting up")
    CAD = F( 7,  6,  RW,   0,     "at CTR = CMPA counting down")
    CBU = F( 9,  8,  RW,   0,     "at CTR = CMPB counting up")
    CBD = F(11, 10,  RW,   0,     "at CTR = CMPB counting down")


class AQCTLA2(Register):
    #       bits     type  reset  description
    T1U = F( 1,  0,  RW,   0,     "at T1 counting up", modelled=False)
    T1D = F( 3,  2,  RW,   0,     "at T1 counting down", modelled=False)
    T2U = F( 5,  4,  RW,   0,     "at T2 counting up", modelled=False)
    T2D = F( 7,  6,  RW,   0,     "at T2 counting down", modelled=False)


class AQCTLB(Register):
    #       bits     type  reset  description
    ZRO = F( 1,  0,  RW,   0,     "at CTR = 0: 0 nothing, 1 clear, 2 set, 3 toggle")
    PRD = F( 3,  2,  RW,   0,     "at CTR = TBPRD")
    CAU = F( 5,  4,  RW,   0,     "at CTR = CMPA counting up")
    CAD = F( 7,  6,  RW,   0,     "at CTR = CMPA counting down")
    CBU = F( 9,  8,  RW,   0,     "at CTR = CMPB counting up")
    CBD = F(11, 10,  RW,   0,     "at CTR = CMPB counting down")


class AQCTLB2(Register):
    #       bits     type  reset  description
    T1U = F( 1,  0,  RW,   0,     "at T1 counting up", modelled=False)
    T1D = F( 3,  2,  RW,   0,     "at T1 counting down", modelled=False)
    T2U = F( 5,  4,  RW,   0,     "at T2 counting up", modelled=False)
    T2D = F( 7,  6,  RW,   0,     "at T2 counting down", modelled=False)


class AQSFRC(Register):
    #          bits     type  reset  description
    ACTSFA = F( 1,  0,  RW,   0,     "action of OTSFA: 0 nothing, 1 clear, 2 set, 3 toggle")
    OTSFA  = F( 2,      R0W1, 0,     "one-shot force of output A")
    ACTSFB = F( 4,  3,  RW,   0,     "action of OTSFB")
    OTSFB  = F( 5,      R0W1, 0,     "one-shot force of output B")
    RLDCSF = F( 7,  6,  RW,   0,     "AQCSFRC loads at: 0 zero, 1 period, 2 both, 3 immediately")


class AQCSFRC(Register):
    #        bits     type  reset  description
    CSFA = F( 1,  0,  RW,   0,     "output A: 0 free, 1 forced low, 2 forced high, 3 free")
    CSFB = F( 3,  2,  RW,   0,     "output B: 0 free, 1 forced low, 2 forced high, 3 free")


class TBPHS(Register, bits=32):
    #           bits     type  reset  description
    TBPHSHR = F(15,  0,  RW,   0,     "phase, high resolution", modelled=False)
    TBPHS   = F(31, 16,  RW,   0,     "phase")


class CMPA(Register, bits=32):
    #          bits     type  reset  description
    CMPAHR = F(15,  0,  RW,   0,     "compare A, high resolution", modelled=False)
    CMPA   = F(31, 16,  RW,   0,     "compare A")


class CMPB(Register, bits=32):
    #          bits     type  reset  description
    CMPBHR = F(15,  0,  RW,   0,     "compare B, high resolution", modelled=False)
    CMPB   = F(31, 16,  RW,   0,     "compare B")


class ETSEL(Register):
    #              bits     type  reset  description
    INTSEL     = F( 2,  0,  RW,   0,     "interrupt at: 1 zero, 2 period, 3 both, 4 CAU, 5 CAD, 6 CBU, 7 CBD")
    INTEN      = F( 3,      RW,   0,     "interrupt enabled")
    SOCASELCMP = F( 4,      RW,   0,     "SOCA: CMPC and CMPD instead of CMPA and CMPB", modelled=False)
    SOCBSELCMP = F( 5,      RW,   0,     "SOCB: CMPC and CMPD instead of CMPA and CMPB", modelled=False)
    INTSELCMP  = F( 6,      RW,   0,     "interrupt: CMPC and CMPD instead of CMPA and CMPB", modelled=False)
    SOCASEL    = F(10,  8,  RW,   0,     "SOCA at: 0 digital compare event, 1-7 as INTSEL")
    SOCAEN     = F(11,      RW,   0,     "SOCA enabled")
    SOCBSEL    = F(14, 12,  RW,   0,     "SOCB at: 0 digital compare event, 1-7 as INTSEL")
    SOCBEN     = F(15,      RW,   0,     "SOCB enabled")


class ETPS(Register):
    #            bits     type  reset  description
    INTPRD   = F( 1,  0,  RW,   0,     "interrupt at every nth event; 0 never")
    INTCNT   = F( 3,  2,  R,    0,     "events since the last interrupt")
    INTPSSEL = F( 4,      RW,   0,     "interrupt uses ETINTPS")
    SOCPSSEL = F( 5,      RW,   0,     "SOCA and SOCB use ETSOCPS")
    SOCAPRD  = F( 9,  8,  RW,   0,     "SOCA at every nth event; 0 never")
    SOCACNT  = F(11, 10,  R,    0,     "events since the last SOCA")
    SOCBPRD  = F(13, 12,  RW,   0,     "SOCB at every nth event; 0 never")
    SOCBCNT  = F(15, 14,  R,    0,     "events since the last SOCB")


class ETFLG(Register):
    #        bits     type  reset  description
    INT  = F( 0,      R,    0,     "interrupt given and not cleared yet")
    SOCA = F( 2,      R,    0,     "SOCA given")
    SOCB = F( 3,      R,    0,     "SOCB given")


class ETCLR(Register):
    #        bits     type  reset  description
    INT  = F( 0,      R0W1, 0,     "clear ETFLG.INT")
    SOCA = F( 2,      R0W1, 0,     "clear ETFLG.SOCA")
    SOCB = F( 3,      R0W1, 0,     "clear ETFLG.SOCB")


class ETFRC(Register):
    #        bits     type  reset  description
    INT  = F( 0,      R0W1, 0,     "force an interrupt")
    SOCA = F( 2,      R0W1, 0,     "force a SOCA")
    SOCB = F( 3,      R0W1, 0,     "force a SOCB")


class ETINTPS(Register):
    #           bits     type  reset  description
    INTPRD2 = F( 3,  0,  RW,   0,     "interrupt at every nth event; 0 never")
    INTCNT2 = F( 7,  4,  R,    0,     "events since the last interrupt")


class ETSOCPS(Register):
    #            bits     type  reset  description
    SOCAPRD2 = F( 3,  0,  RW,   0,     "SOCA at every nth event; 0 never")
    SOCACNT2 = F( 7,  4,  R,    0,     "events since the last SOCA")
    SOCBPRD2 = F(11,  8,  RW,   0,     "SOCB at every nth event; 0 never")
    SOCBCNT2 = F(15, 12,  R,    0,     "events since the last SOCB")


class ETCNTINITCTL(Register):
    #               bits     type  reset  description
    INTINITFRC  = F(10,      R0W1, 0,     "load INTINIT now", modelled=False)
    SOCAINITFRC = F(11,      R0W1, 0,     "load SOCAINIT now", modelled=False)
    SOCBINITFRC = F(12,      R0W1, 0,     "load SOCBINIT now", modelled=False)
    INTINITEN   = F(13,      RW,   0,     "load INTINIT at sync", modelled=False)
    SOCAINITEN  = F(14,      RW,   0,     "load SOCAINIT at sync", modelled=False)
    SOCBINITEN  = F(15,      RW,   0,     "load SOCBINIT at sync", modelled=False)


class ETCNTINIT(Register):
    #            bits     type  reset  description
    INTINIT  = F( 3,  0,  RW,   0,     "initial INTCNT2", modelled=False)
    SOCAINIT = F( 7,  4,  RW,   0,     "initial SOCACNT2", modelled=False)
    SOCBINIT = F(11,  8,  RW,   0,     "initial SOCBCNT2", modelled=False)


class EPwmRegs(Block, struct="EPWM_REGS"):
    #               offset                   type  reset  bits
    TBCTL         = At(0x00, TBCTL)
    TBCTL2        = At(0x01, TBCTL2)
    TBCTR         = Word(0x04,              RW,   0,     16, text="counter")
    TBSTS         = At(0x05, TBSTS)
    CMPCTL        = At(0x08, CMPCTL)
    CMPCTL2       = At(0x09, CMPCTL2)
    DBCTL         = At(0x0C, DBCTL)
    DBCTL2        = At(0x0D, DBCTL2)
    AQCTL         = At(0x10, AQCTL)
    AQTSRCSEL     = At(0x11, AQTSRCSEL)
    PCCTL         = At(0x14, PCCTL)
    VCAPCTL       = At(0x18, VCAPCTL)
    VCNTCFG       = At(0x19, VCNTCFG)
    HRCNFG        = At(0x20, HRCNFG)
    HRPWR         = At(0x21, HRPWR)
    HRMSTEP       = At(0x26, HRMSTEP)
    HRCNFG2       = At(0x27, HRCNFG2)
    HRPCTL        = At(0x2D, HRPCTL)
    TRREM         = At(0x2E, TRREM)
    GLDCTL        = At(0x34, GLDCTL)
    GLDCFG        = At(0x35, GLDCFG)
    EPWMXLINK     = At(0x38, EPWMXLINK)
    AQCTLA        = At(0x40, AQCTLA)
    AQCTLA2       = At(0x41, AQCTLA2)
    AQCTLB        = At(0x42, AQCTLB)
    AQCTLB2       = At(0x43, AQCTLB2)
    AQSFRC        = At(0x47, AQSFRC)
    AQCSFRC       = At(0x49, AQCSFRC)
    DBREDHR       = At(0x50, DBREDHR)
    DBRED         = At(0x51, DBRED)
    DBFEDHR       = At(0x52, DBFEDHR)
    DBFED         = At(0x53, DBFED)
    TBPHS         = At(0x60, TBPHS)
    TBPRDHR       = Word(0x62,              RW,   0,     16, text="period, high resolution", modelled=False)
    TBPRD         = Word(0x63,              RW,   0,     16, text="period")
    CMPA          = At(0x6A, CMPA)
    CMPB          = At(0x6C, CMPB)
    CMPC          = Word(0x6F,              RW,   0,     16, text="compare C", modelled=False)
    CMPD          = Word(0x71,              RW,   0,     16, text="compare D", modelled=False)
    GLDCTL2       = At(0x74, GLDCTL2)
    SWVDELVAL     = Word(0x77,              RW,   0,     16, text="software valley delay", modelled=False)
    TZSEL         = At(0x80, TZSEL)
    TZDCSEL       = At(0x82, TZDCSEL)
    TZCTL         = At(0x84, TZCTL)
    TZCTL2        = At(0x85, TZCTL2)
    TZCTLDCA      = At(0x86, TZCTLDCA)
    TZCTLDCB      = At(0x87, TZCTLDCB)
    TZEINT        = At(0x8D, TZEINT)
    TZFLG         = At(0x93, TZFLG)
    TZCBCFLG      = At(0x94, TZCBCFLG)
    TZOSTFLG      = At(0x95, TZOSTFLG)
    TZCLR         = At(0x97, TZCLR)
    TZCBCCLR      = At(0x98, TZCBCCLR)
    TZOSTCLR      = At(0x99, TZOSTCLR)
    TZFRC         = At(0x9B, TZFRC)
    ETSEL         = At(0xA4, ETSEL)
    ETPS          = At(0xA6, ETPS)
    ETFLG         = At(0xA8, ETFLG)
    ETCLR         = At(0xAA, ETCLR)
    ETFRC         = At(0xAC, ETFRC)
    ETINTPS       = At(0xAE, ETINTPS)
    ETSOCPS       = At(0xB0, ETSOCPS)
    ETCNTINITCTL  = At(0xB2, ETCNTINITCTL)
    ETCNTINIT     = At(0xB4, ETCNTINIT)
    DCTRIPSEL     = At(0xC0, DCTRIPSEL)
    DCACTL        = At(0xC3, DCACTL)
    DCBCTL        = At(0xC4, DCBCTL)
    DCFCTL        = At(0xC7, DCFCTL)
    DCCAPCTL      = At(0xC8, DCCAPCTL)
    DCFOFFSET     = Word(0xC9,              RW,   0,     16, text="blanking offset")
    DCFOFFSETCNT  = Word(0xCA,              R,    0,     16, text="blanking offset counter")
    DCFWINDOW     = Word(0xCB,              RW,   0,     16, text="blanking window")
    DCFWINDOWCNT  = Word(0xCC,              R,    0,     16, text="blanking window counter")
    DCCAP         = Word(0xCF,              R,    0,     16, text="captured TBCTR", modelled=False)
    DCAHTRIPSEL   = At(0xD2, DCAHTRIPSEL)
    DCALTRIPSEL   = At(0xD3, DCALTRIPSEL)
    DCBHTRIPSEL   = At(0xD4, DCBHTRIPSEL)
    DCBLTRIPSEL   = At(0xD5, DCBLTRIPSEL)
    HWVDELVAL     = Word(0xFD,              R,    0,     16, text="hardware valley delay", modelled=False)
    VCNTVAL       = Word(0xFE,              R,    0,     16, text="valley counter", modelled=False)
