"""ePWM1-12: what each register is (TRM chapter ePWM, type 4; names, offsets and bits as in HDR F2837xS_epwm.h).

Base 0x4000 + 0x100 * (n - 1).  EALLOW protects the trip zone, digital compare, valley, high-resolution and global-load
registers.  In the 32-bit pairs CMPA, CMPB and TBPHS the value is the high word.
"""

from __future__ import annotations

from emulator.registers.core import R0W1, RW, W1C, At, Block, F, R, Register, Word


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


class DBCTL(Register):
    #                 bits     type  reset  description
    OUT_MODE      = F( 1,  0,  RW,   0,     "0 bypass; other values delay edges by DBRED and DBFED, here they stay undelayed", modelled=False)
    POLSEL        = F( 3,  2,  RW,   0,     "dead-band polarity", modelled=False)
    IN_MODE       = F( 5,  4,  RW,   0,     "dead-band sources", modelled=False)
    LOADREDMODE   = F( 7,  6,  RW,   0,     "DBRED load event", modelled=False)
    LOADFEDMODE   = F( 9,  8,  RW,   0,     "DBFED load event", modelled=False)
    SHDWDBREDMODE = F(10,      RW,   0,     "DBRED shadowed", modelled=False)
    SHDWDBFEDMODE = F(11,      RW,   0,     "DBFED shadowed", modelled=False)
    OUTSWAP       = F(13, 12,  RW,   0,     "outputs A and B exchanged", modelled=False)
    DEDB_MODE     = F(14,      RW,   0,     "both delays on one signal", modelled=False)
    HALFCYCLE     = F(15,      RW,   0,     "half-cycle clocking", modelled=False)


class DBCTL2(Register):
    #                 bits     type  reset  description
    LOADDBCTLMODE = F( 1,  0,  RW,   0,     "DBCTL load event", modelled=False)
    SHDWDBCTLMODE = F( 2,      RW,   0,     "DBCTL shadowed", modelled=False)


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


class PCCTL(Register):
    #           bits     type  reset  description
    CHPEN   = F( 0,      RW,   0,     "chopper enabled", modelled=False)
    OSHTWTH = F( 4,  1,  RW,   0,     "first pulse width", modelled=False)
    CHPFREQ = F( 7,  5,  RW,   0,     "chopping frequency", modelled=False)
    CHPDUTY = F(10,  8,  RW,   0,     "chopping duty", modelled=False)


class VCAPCTL(Register, eallow=True):
    #                  bits     type  reset  description
    VCAPE          = F( 0,      RW,   0,     "valley capture enabled", modelled=False)
    VCAPSTART      = F( 1,      RW,   0,     "valley capture start", modelled=False)
    TRIGSEL        = F( 4,  2,  RW,   0,     "valley capture trigger", modelled=False)
    VDELAYDIV      = F( 9,  7,  RW,   0,     "valley delay divider", modelled=False)
    EDGEFILTDLYSEL = F(10,      RW,   0,     "edge filter delay", modelled=False)


class VCNTCFG(Register, eallow=True):
    #                bits     type  reset  description
    STARTEDGE    = F( 3,  0,  RW,   0,     "first edge counted", modelled=False)
    STARTEDGESTS = F( 7,      R,    0,     "first edge seen", modelled=False)
    STOPEDGE     = F(11,  8,  RW,   0,     "last edge counted", modelled=False)
    STOPEDGESTS  = F(15,      R,    0,     "last edge seen", modelled=False)


class HRCNFG(Register, eallow=True):
    #            bits     type  reset  description
    EDGMODE  = F( 1,  0,  RW,   0,     "high resolution: edges of A", modelled=False)
    CTLMODE  = F( 2,      RW,   0,     "high resolution: control of A", modelled=False)
    HRLOAD   = F( 4,  3,  RW,   0,     "high resolution: load event of A", modelled=False)
    SELOUTB  = F( 5,      RW,   0,     "B is A inverted", modelled=False)
    AUTOCONV = F( 6,      RW,   0,     "automatic scaling", modelled=False)
    SWAPAB   = F( 7,      RW,   0,     "A and B exchanged", modelled=False)
    EDGMODEB = F( 9,  8,  RW,   0,     "high resolution: edges of B", modelled=False)
    CTLMODEB = F(10,      RW,   0,     "high resolution: control of B", modelled=False)
    HRLOADB  = F(12, 11,  RW,   0,     "high resolution: load event of B", modelled=False)


class HRPWR(Register, eallow=True):
    #            bits     type  reset  description
    CALPWRON = F(15,      RW,   0,     "calibration powered", modelled=False)


class HRMSTEP(Register, eallow=True):
    #           bits     type  reset  description
    HRMSTEP = F( 7,  0,  RW,   0,     "micro steps a cycle", modelled=False)


class HRCNFG2(Register, eallow=True):
    #                bits     type  reset  description
    EDGMODEDB    = F( 1,  0,  RW,   0,     "high resolution: dead-band edges", modelled=False)
    CTLMODEDBRED = F( 3,  2,  RW,   0,     "high resolution: DBRED load event", modelled=False)
    CTLMODEDBFED = F( 5,  4,  RW,   0,     "high resolution: DBFED load event", modelled=False)


class HRPCTL(Register, eallow=True):
    #                bits     type  reset  description
    HRPE         = F( 0,      RW,   0,     "high-resolution period", modelled=False)
    PWMSYNCSEL   = F( 1,      RW,   0,     "PWMSYNC source", modelled=False)
    TBPHSHRLOADE = F( 2,      RW,   0,     "high-resolution phase load", modelled=False)
    PWMSYNCSELX  = F( 6,  4,  RW,   0,     "extended PWMSYNC source", modelled=False)


class TRREM(Register, eallow=True):
    #         bits     type  reset  description
    TRREM = F(10,  0,  RW,   0,     "high-resolution remainder", modelled=False)


class GLDCTL(Register, eallow=True):
    #            bits     type  reset  description
    GLD      = F( 0,      RW,   0,     "global load", modelled=False)
    GLDMODE  = F( 4,  1,  RW,   0,     "global load event", modelled=False)
    OSHTMODE = F( 5,      RW,   0,     "one-shot global load", modelled=False)
    GLDPRD   = F( 9,  7,  RW,   0,     "global load every nth event", modelled=False)
    GLDCNT   = F(12, 10,  R,    0,     "events counted", modelled=False)


class GLDCFG(Register, eallow=True):
    #                  bits     type  reset  description
    TBPRD_TBPRDHR  = F( 0,      RW,   0,     "TBPRD loads globally", modelled=False)
    CMPA_CMPAHR    = F( 1,      RW,   0,     "CMPA loads globally", modelled=False)
    CMPB_CMPBHR    = F( 2,      RW,   0,     "CMPB loads globally", modelled=False)
    CMPC           = F( 3,      RW,   0,     "CMPC loads globally", modelled=False)
    CMPD           = F( 4,      RW,   0,     "CMPD loads globally", modelled=False)
    DBRED_DBREDHR  = F( 5,      RW,   0,     "DBRED loads globally", modelled=False)
    DBFED_DBFEDHR  = F( 6,      RW,   0,     "DBFED loads globally", modelled=False)
    DBCTL          = F( 7,      RW,   0,     "DBCTL loads globally", modelled=False)
    AQCTLA_AQCTLA2 = F( 8,      RW,   0,     "AQCTLA loads globally", modelled=False)
    AQCTLB_AQCTLB2 = F( 9,      RW,   0,     "AQCTLB loads globally", modelled=False)
    AQCSFRC        = F(10,      RW,   0,     "AQCSFRC loads globally", modelled=False)


class EPWMXLINK(Register, bits=32):
    #               bits     type  reset  description
    TBPRDLINK   = F( 3,  0,  RW,   0,     "TBPRD written with another module's", modelled=False)
    CMPALINK    = F( 7,  4,  RW,   0,     "CMPA written with another module's", modelled=False)
    CMPBLINK    = F(11,  8,  RW,   0,     "CMPB written with another module's", modelled=False)
    CMPCLINK    = F(15, 12,  RW,   0,     "CMPC written with another module's", modelled=False)
    CMPDLINK    = F(19, 16,  RW,   0,     "CMPD written with another module's", modelled=False)
    GLDCTL2LINK = F(31, 28,  RW,   0,     "GLDCTL2 written with another module's", modelled=False)


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


class DBREDHR(Register):
    #           bits     type  reset  description
    DBREDHR = F(15,  9,  RW,   0,     "rising edge delay, high resolution", modelled=False)


class DBRED(Register):
    #         bits     type  reset  description
    DBRED = F(13,  0,  RW,   0,     "rising edge delay", modelled=False)


class DBFEDHR(Register):
    #           bits     type  reset  description
    DBFEDHR = F(15,  9,  RW,   0,     "falling edge delay, high resolution", modelled=False)


class DBFED(Register):
    #         bits     type  reset  description
    DBFED = F(13,  0,  RW,   0,     "falling edge delay", modelled=False)


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


class GLDCTL2(Register, eallow=True):
    #          bits     type  reset  description
    OSHTLD = F( 0,      R0W1, 0,     "one-shot global load", modelled=False)
    GFRCLD = F( 1,      R0W1, 0,     "forced global load", modelled=False)


class TZSEL(Register, eallow=True):
    #           bits     type  reset  description
    CBC1    = F( 0,      RW,   0,     "TZ1 trips cycle by cycle", modelled=False)
    CBC2    = F( 1,      RW,   0,     "TZ2 trips cycle by cycle", modelled=False)
    CBC3    = F( 2,      RW,   0,     "TZ3 trips cycle by cycle", modelled=False)
    CBC4    = F( 3,      RW,   0,     "TZ4 trips cycle by cycle", modelled=False)
    CBC5    = F( 4,      RW,   0,     "TZ5 trips cycle by cycle", modelled=False)
    CBC6    = F( 5,      RW,   0,     "TZ6 trips cycle by cycle", modelled=False)
    DCAEVT2 = F( 6,      RW,   0,     "digital compare A event 2 trips cycle by cycle", modelled=False)
    DCBEVT2 = F( 7,      RW,   0,     "digital compare B event 2 trips cycle by cycle", modelled=False)
    OSHT1   = F( 8,      RW,   0,     "TZ1 trips one-shot", modelled=False)
    OSHT2   = F( 9,      RW,   0,     "TZ2 trips one-shot", modelled=False)
    OSHT3   = F(10,      RW,   0,     "TZ3 trips one-shot", modelled=False)
    OSHT4   = F(11,      RW,   0,     "TZ4 trips one-shot", modelled=False)
    OSHT5   = F(12,      RW,   0,     "TZ5 trips one-shot", modelled=False)
    OSHT6   = F(13,      RW,   0,     "TZ6 trips one-shot", modelled=False)
    DCAEVT1 = F(14,      RW,   0,     "digital compare A event 1 trips one-shot", modelled=False)
    DCBEVT1 = F(15,      RW,   0,     "digital compare B event 1 trips one-shot", modelled=False)


class TZDCSEL(Register, eallow=True):
    #           bits     type  reset  description
    DCAEVT1 = F( 2,  0,  RW,   0,     "condition of digital compare A event 1", modelled=False)
    DCAEVT2 = F( 5,  3,  RW,   0,     "condition of digital compare A event 2", modelled=False)
    DCBEVT1 = F( 8,  6,  RW,   0,     "condition of digital compare B event 1", modelled=False)
    DCBEVT2 = F(11,  9,  RW,   0,     "condition of digital compare B event 2", modelled=False)


class TZCTL(Register, eallow=True):
    #           bits     type  reset  description
    TZA     = F( 1,  0,  RW,   0,     "output A tripped: 0 high impedance, 1 high, 2 low, 3 untouched")
    TZB     = F( 3,  2,  RW,   0,     "output B tripped: 0 high impedance, 1 high, 2 low, 3 untouched")
    DCAEVT1 = F( 5,  4,  RW,   0,     "action of digital compare A event 1", modelled=False)
    DCAEVT2 = F( 7,  6,  RW,   0,     "action of digital compare A event 2", modelled=False)
    DCBEVT1 = F( 9,  8,  RW,   0,     "action of digital compare B event 1", modelled=False)
    DCBEVT2 = F(11, 10,  RW,   0,     "action of digital compare B event 2", modelled=False)


class TZCTL2(Register, eallow=True):
    #        bits     type  reset  description
    TZAU = F( 2,  0,  RW,   0,     "output A tripped counting up", modelled=False)
    TZAD = F( 5,  3,  RW,   0,     "output A tripped counting down", modelled=False)
    TZBU = F( 8,  6,  RW,   0,     "output B tripped counting up", modelled=False)
    TZBD = F(11,  9,  RW,   0,     "output B tripped counting down", modelled=False)
    ETZE = F(15,      RW,   0,     "TZCTL2 used instead of TZCTL", modelled=False)


class TZCTLDCA(Register, eallow=True):
    #            bits     type  reset  description
    DCAEVT1U = F( 2,  0,  RW,   0,     "digital compare A event 1 counting up", modelled=False)
    DCAEVT1D = F( 5,  3,  RW,   0,     "digital compare A event 1 counting down", modelled=False)
    DCAEVT2U = F( 8,  6,  RW,   0,     "digital compare A event 2 counting up", modelled=False)
    DCAEVT2D = F(11,  9,  RW,   0,     "digital compare A event 2 counting down", modelled=False)


class TZCTLDCB(Register, eallow=True):
    #            bits     type  reset  description
    DCBEVT1U = F( 2,  0,  RW,   0,     "digital compare B event 1 counting up", modelled=False)
    DCBEVT1D = F( 5,  3,  RW,   0,     "digital compare B event 1 counting down", modelled=False)
    DCBEVT2U = F( 8,  6,  RW,   0,     "digital compare B event 2 counting up", modelled=False)
    DCBEVT2D = F(11,  9,  RW,   0,     "digital compare B event 2 counting down", modelled=False)


class TZEINT(Register, eallow=True):
    #           bits     type  reset  description
    CBC     = F( 1,      RW,   0,     "cycle-by-cycle trip interrupts", modelled=False)
    OST     = F( 2,      RW,   0,     "one-shot trip interrupts")
    DCAEVT1 = F( 3,      RW,   0,     "digital compare A event 1 interrupts", modelled=False)
    DCAEVT2 = F( 4,      RW,   0,     "digital compare A event 2 interrupts", modelled=False)
    DCBEVT1 = F( 5,      RW,   0,     "digital compare B event 1 interrupts", modelled=False)
    DCBEVT2 = F( 6,      RW,   0,     "digital compare B event 2 interrupts", modelled=False)


class TZFLG(Register):
    #           bits     type  reset  description
    INT     = F( 0,      R,    0,     "trip interrupt given and not cleared yet")
    CBC     = F( 1,      R,    0,     "cycle-by-cycle trip", modelled=False)
    OST     = F( 2,      R,    0,     "one-shot trip")
    DCAEVT1 = F( 3,      R,    0,     "digital compare A event 1", modelled=False)
    DCAEVT2 = F( 4,      R,    0,     "digital compare A event 2", modelled=False)
    DCBEVT1 = F( 5,      R,    0,     "digital compare B event 1", modelled=False)
    DCBEVT2 = F( 6,      R,    0,     "digital compare B event 2", modelled=False)


class TZCBCFLG(Register):
    #           bits     type  reset  description
    CBC1    = F( 0,      R,    0,     "TZ1 tripped", modelled=False)
    CBC2    = F( 1,      R,    0,     "TZ2 tripped", modelled=False)
    CBC3    = F( 2,      R,    0,     "TZ3 tripped", modelled=False)
    CBC4    = F( 3,      R,    0,     "TZ4 tripped", modelled=False)
    CBC5    = F( 4,      R,    0,     "TZ5 tripped", modelled=False)
    CBC6    = F( 5,      R,    0,     "TZ6 tripped", modelled=False)
    DCAEVT2 = F( 6,      R,    0,     "digital compare A event 2 tripped", modelled=False)
    DCBEVT2 = F( 7,      R,    0,     "digital compare B event 2 tripped", modelled=False)


class TZOSTFLG(Register):
    #           bits     type  reset  description
    OST1    = F( 0,      R,    0,     "TZ1 tripped", modelled=False)
    OST2    = F( 1,      R,    0,     "TZ2 tripped", modelled=False)
    OST3    = F( 2,      R,    0,     "TZ3 tripped", modelled=False)
    OST4    = F( 3,      R,    0,     "TZ4 tripped", modelled=False)
    OST5    = F( 4,      R,    0,     "TZ5 tripped", modelled=False)
    OST6    = F( 5,      R,    0,     "TZ6 tripped", modelled=False)
    DCAEVT1 = F( 6,      R,    0,     "digital compare A event 1 tripped", modelled=False)
    DCBEVT1 = F( 7,      R,    0,     "digital compare B event 1 tripped", modelled=False)


class TZCLR(Register, eallow=True):
    #            bits     type  reset  description
    INT      = F( 0,      R0W1, 0,     "clear TZFLG.INT")
    CBC      = F( 1,      R0W1, 0,     "clear TZFLG.CBC")
    OST      = F( 2,      R0W1, 0,     "clear TZFLG.OST and release the outputs")
    DCAEVT1  = F( 3,      R0W1, 0,     "clear TZFLG.DCAEVT1")
    DCAEVT2  = F( 4,      R0W1, 0,     "clear TZFLG.DCAEVT2")
    DCBEVT1  = F( 5,      R0W1, 0,     "clear TZFLG.DCBEVT1")
    DCBEVT2  = F( 6,      R0W1, 0,     "clear TZFLG.DCBEVT2")
    CBCPULSE = F(15, 14,  RW,   0,     "event that ends a cycle-by-cycle trip", modelled=False)


class TZCBCCLR(Register, eallow=True):
    #           bits     type  reset  description
    CBC1    = F( 0,      R0W1, 0,     "clear TZCBCFLG.CBC1")
    CBC2    = F( 1,      R0W1, 0,     "clear TZCBCFLG.CBC2")
    CBC3    = F( 2,      R0W1, 0,     "clear TZCBCFLG.CBC3")
    CBC4    = F( 3,      R0W1, 0,     "clear TZCBCFLG.CBC4")
    CBC5    = F( 4,      R0W1, 0,     "clear TZCBCFLG.CBC5")
    CBC6    = F( 5,      R0W1, 0,     "clear TZCBCFLG.CBC6")
    DCAEVT2 = F( 6,      R0W1, 0,     "clear TZCBCFLG.DCAEVT2")
    DCBEVT2 = F( 7,      R0W1, 0,     "clear TZCBCFLG.DCBEVT2")


class TZOSTCLR(Register, eallow=True):
    #           bits     type  reset  description
    OST1    = F( 0,      R0W1, 0,     "clear TZOSTFLG.OST1")
    OST2    = F( 1,      R0W1, 0,     "clear TZOSTFLG.OST2")
    OST3    = F( 2,      R0W1, 0,     "clear TZOSTFLG.OST3")
    OST4    = F( 3,      R0W1, 0,     "clear TZOSTFLG.OST4")
    OST5    = F( 4,      R0W1, 0,     "clear TZOSTFLG.OST5")
    OST6    = F( 5,      R0W1, 0,     "clear TZOSTFLG.OST6")
    DCAEVT1 = F( 6,      R0W1, 0,     "clear TZOSTFLG.DCAEVT1")
    DCBEVT1 = F( 7,      R0W1, 0,     "clear TZOSTFLG.DCBEVT1")


class TZFRC(Register, eallow=True):
    #           bits     type  reset  description
    CBC     = F( 1,      R0W1, 0,     "force a cycle-by-cycle trip", modelled=False)
    OST     = F( 2,      R0W1, 0,     "force a one-shot trip")
    DCAEVT1 = F( 3,      R0W1, 0,     "force digital compare A event 1", modelled=False)
    DCAEVT2 = F( 4,      R0W1, 0,     "force digital compare A event 2", modelled=False)
    DCBEVT1 = F( 5,      R0W1, 0,     "force digital compare B event 1", modelled=False)
    DCBEVT2 = F( 6,      R0W1, 0,     "force digital compare B event 2", modelled=False)


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


class DCTRIPSEL(Register, eallow=True):
    #               bits     type  reset  description
    DCAHCOMPSEL = F( 3,  0,  RW,   0,     "source of DCAH", modelled=False)
    DCALCOMPSEL = F( 7,  4,  RW,   0,     "source of DCAL", modelled=False)
    DCBHCOMPSEL = F(11,  8,  RW,   0,     "source of DCBH", modelled=False)
    DCBLCOMPSEL = F(15, 12,  RW,   0,     "source of DCBL", modelled=False)


class DCACTL(Register, eallow=True):
    #                  bits     type  reset  description
    EVT1SRCSEL     = F( 0,      RW,   0,     "event 1 filtered", modelled=False)
    EVT1FRCSYNCSEL = F( 1,      RW,   0,     "event 1 asynchronous", modelled=False)
    EVT1SOCE       = F( 2,      RW,   0,     "event 1 gives SOC", modelled=False)
    EVT1SYNCE      = F( 3,      RW,   0,     "event 1 gives sync", modelled=False)
    EVT2SRCSEL     = F( 8,      RW,   0,     "event 2 filtered", modelled=False)
    EVT2FRCSYNCSEL = F( 9,      RW,   0,     "event 2 asynchronous", modelled=False)


class DCBCTL(Register, eallow=True):
    #                  bits     type  reset  description
    EVT1SRCSEL     = F( 0,      RW,   0,     "event 1 filtered", modelled=False)
    EVT1FRCSYNCSEL = F( 1,      RW,   0,     "event 1 asynchronous", modelled=False)
    EVT1SOCE       = F( 2,      RW,   0,     "event 1 gives SOC", modelled=False)
    EVT1SYNCE      = F( 3,      RW,   0,     "event 1 gives sync", modelled=False)
    EVT2SRCSEL     = F( 8,      RW,   0,     "event 2 filtered", modelled=False)
    EVT2FRCSYNCSEL = F( 9,      RW,   0,     "event 2 asynchronous", modelled=False)


class DCFCTL(Register, eallow=True):
    #               bits     type  reset  description
    SRCSEL      = F( 1,  0,  RW,   0,     "filtered signal", modelled=False)
    BLANKE      = F( 2,      RW,   0,     "blanking enabled", modelled=False)
    BLANKINV    = F( 3,      RW,   0,     "blanking inverted", modelled=False)
    PULSESEL    = F( 5,  4,  RW,   0,     "blanking aligned to", modelled=False)
    EDGEFILTSEL = F( 6,      RW,   0,     "edge filter", modelled=False)
    EDGEMODE    = F( 9,  8,  RW,   0,     "edges counted", modelled=False)
    EDGECOUNT   = F(12, 10,  RW,   0,     "edges wanted", modelled=False)
    EDGESTATUS  = F(15, 13,  R,    0,     "edges seen", modelled=False)


class DCCAPCTL(Register, eallow=True):
    #            bits     type  reset  description
    CAPE     = F( 0,      RW,   0,     "TBCTR capture enabled", modelled=False)
    SHDWMODE = F( 1,      RW,   0,     "capture shadow", modelled=False)
    CAPSTS   = F(13,      R,    0,     "captured", modelled=False)
    CAPCLR   = F(14,      R0W1, 0,     "clear CAPSTS", modelled=False)
    CAPMODE  = F(15,      RW,   0,     "capture mode", modelled=False)


class _TripSelect(Register, eallow=True):
    #                bits  type  reset  description
    TRIPINPUT1   = F( 0,    RW,   0,     "trip input 1", modelled=False)
    TRIPINPUT2   = F( 1,    RW,   0,     "trip input 2", modelled=False)
    TRIPINPUT3   = F( 2,    RW,   0,     "trip input 3", modelled=False)
    TRIPINPUT4   = F( 3,    RW,   0,     "trip input 4", modelled=False)
    TRIPINPUT5   = F( 4,    RW,   0,     "trip input 5", modelled=False)
    TRIPINPUT6   = F( 5,    RW,   0,     "trip input 6", modelled=False)
    TRIPINPUT7   = F( 6,    RW,   0,     "trip input 7", modelled=False)
    TRIPINPUT8   = F( 7,    RW,   0,     "trip input 8", modelled=False)
    TRIPINPUT9   = F( 8,    RW,   0,     "trip input 9", modelled=False)
    TRIPINPUT10  = F( 9,    RW,   0,     "trip input 10", modelled=False)
    TRIPINPUT11  = F(10,    RW,   0,     "trip input 11", modelled=False)
    TRIPINPUT12  = F(11,    RW,   0,     "trip input 12", modelled=False)
    TRIPINPUT14  = F(13,    RW,   0,     "trip input 14", modelled=False)
    TRIPINPUT15  = F(14,    RW,   0,     "trip input 15", modelled=False)


class DCAHTRIPSEL(_TripSelect, eallow=True):
    """Trip inputs combined into DCAH."""


class DCALTRIPSEL(_TripSelect, eallow=True):
    """Trip inputs combined into DCAL."""


class DCBHTRIPSEL(_TripSelect, eallow=True):
    """Trip inputs combined into DCBH."""


class DCBLTRIPSEL(_TripSelect, eallow=True):
    """Trip inputs combined into DCBL."""


class EPwmRegs(Block):
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
    DCFOFFSET     = Word(0xC9,              RW,   0,     16, text="blanking offset", modelled=False)
    DCFOFFSETCNT  = Word(0xCA,              R,    0,     16, text="blanking offset counter", modelled=False)
    DCFWINDOW     = Word(0xCB,              RW,   0,     16, text="blanking window", modelled=False)
    DCFWINDOWCNT  = Word(0xCC,              R,    0,     16, text="blanking window counter", modelled=False)
    DCCAP         = Word(0xCF,              R,    0,     16, text="captured TBCTR", modelled=False)
    DCAHTRIPSEL   = At(0xD2, DCAHTRIPSEL)
    DCALTRIPSEL   = At(0xD3, DCALTRIPSEL)
    DCBHTRIPSEL   = At(0xD4, DCBHTRIPSEL)
    DCBLTRIPSEL   = At(0xD5, DCBLTRIPSEL)
    HWVDELVAL     = Word(0xFD,              R,    0,     16, text="hardware valley delay", modelled=False)
    VCNTVAL       = Word(0xFE,              R,    0,     16, text="valley counter", modelled=False)
