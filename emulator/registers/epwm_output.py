"""ePWM dead band, chopper, high resolution, valley switching and global load: what each register is (TRM chapter ePWM; HDR
F2837xS_epwm.h).  Of it only the dead band is modelled.
"""

from __future__ import annotations

from emulator.registers.core import R0W1, RW, F, R, Register


class DBCTL(Register):
    #                 bits     type  reset  description
    OUT_MODE      = F( 1,  0,  RW,   0,     "S1, S0: A path, B path delayed")
    POLSEL        = F( 3,  2,  RW,   0,     "S3, S2: B path, A path inverted")
    IN_MODE       = F( 5,  4,  RW,   0,     "S5, S4: source of the falling, of the rising edge delay")
    LOADREDMODE   = F( 7,  6,  RW,   0,     "DBRED load event")
    LOADFEDMODE   = F( 9,  8,  RW,   0,     "DBFED load event")
    SHDWDBREDMODE = F(10,      RW,   0,     "DBRED shadowed")
    SHDWDBFEDMODE = F(11,      RW,   0,     "DBFED shadowed")
    OUTSWAP       = F(13, 12,  RW,   0,     "S6, S7: output A has the B path, output B the A path")
    DEDB_MODE     = F(14,      RW,   0,     "S8: both delays on one signal")
    HALFCYCLE     = F(15,      RW,   0,     "half-cycle clocking", modelled=False)


class DBCTL2(Register):
    #                 bits     type  reset  description
    LOADDBCTLMODE = F( 1,  0,  RW,   0,     "DBCTL load event")
    SHDWDBCTLMODE = F( 2,      RW,   0,     "DBCTL shadowed")


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
    PWMSYNCSEL   = F( 1,      RW,   0,     "EPWMSYNCPER at: 0 TBPRD, 1 zero")
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


class DBREDHR(Register):
    #           bits     type  reset  description
    DBREDHR = F(15,  9,  RW,   0,     "rising edge delay, high resolution", modelled=False)


class DBRED(Register):
    #         bits     type  reset  description
    DBRED = F(13,  0,  RW,   0,     "rising edge delay in TBCLK")


class DBFEDHR(Register):
    #           bits     type  reset  description
    DBFEDHR = F(15,  9,  RW,   0,     "falling edge delay, high resolution", modelled=False)


class DBFED(Register):
    #         bits     type  reset  description
    DBFED = F(13,  0,  RW,   0,     "falling edge delay in TBCLK")


class GLDCTL2(Register, eallow=True):
    #          bits     type  reset  description
    OSHTLD = F( 0,      R0W1, 0,     "one-shot global load", modelled=False)
    GFRCLD = F( 1,      R0W1, 0,     "forced global load", modelled=False)
