"""ePWM trip zone and digital compare: what each register is (TRM chapter ePWM; HDR F2837xS_epwm.h).  All that configure are
EALLOW protected, the flags are read only.
"""

from __future__ import annotations

from emulator.registers.core import R0W1, RW, F, R, Register


class TZSEL(Register, eallow=True):
    #           bits     type  reset  description
    CBC1    = F( 0,      RW,   0,     "TZ1 trips cycle by cycle")
    CBC2    = F( 1,      RW,   0,     "TZ2 trips cycle by cycle")
    CBC3    = F( 2,      RW,   0,     "TZ3 trips cycle by cycle")
    CBC4    = F( 3,      RW,   0,     "TZ4 trips cycle by cycle")
    CBC5    = F( 4,      RW,   0,     "TZ5 trips cycle by cycle")
    CBC6    = F( 5,      RW,   0,     "TZ6 trips cycle by cycle")
    DCAEVT2 = F( 6,      RW,   0,     "digital compare A event 2 trips cycle by cycle")
    DCBEVT2 = F( 7,      RW,   0,     "digital compare B event 2 trips cycle by cycle")
    OSHT1   = F( 8,      RW,   0,     "TZ1 trips one-shot")
    OSHT2   = F( 9,      RW,   0,     "TZ2 trips one-shot")
    OSHT3   = F(10,      RW,   0,     "TZ3 trips one-shot")
    OSHT4   = F(11,      RW,   0,     "TZ4 trips one-shot")
    OSHT5   = F(12,      RW,   0,     "TZ5 trips one-shot")
    OSHT6   = F(13,      RW,   0,     "TZ6 trips one-shot")
    DCAEVT1 = F(14,      RW,   0,     "digital compare A event 1 trips one-shot")
    DCBEVT1 = F(15,      RW,   0,     "digital compare B event 1 trips one-shot")


class TZDCSEL(Register, eallow=True):
    #           bits     type  reset  description
    DCAEVT1 = F( 2,  0,  RW,   0,     "condition of digital compare A event 1")
    DCAEVT2 = F( 5,  3,  RW,   0,     "condition of digital compare A event 2")
    DCBEVT1 = F( 8,  6,  RW,   0,     "condition of digital compare B event 1")
    DCBEVT2 = F(11,  9,  RW,   0,     "condition of digital compare B event 2")


class TZCTL(Register, eallow=True):
    #           bits     type  reset  description
    TZA     = F( 1,  0,  RW,   0,     "output A tripped: 0 high impedance, 1 high, 2 low, 3 untouched")
    TZB     = F( 3,  2,  RW,   0,     "output B tripped: 0 high impedance, 1 high, 2 low, 3 untouched")
    DCAEVT1 = F( 5,  4,  RW,   0,     "action of digital compare A event 1")
    DCAEVT2 = F( 7,  6,  RW,   0,     "action of digital compare A event 2")
    DCBEVT1 = F( 9,  8,  RW,   0,     "action of digital compare B event 1")
    DCBEVT2 = F(11, 10,  RW,   0,     "action of digital compare B event 2")


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
    CBC     = F( 1,      RW,   0,     "cycle-by-cycle trip interrupts")
    OST     = F( 2,      RW,   0,     "one-shot trip interrupts")
    DCAEVT1 = F( 3,      RW,   0,     "digital compare A event 1 interrupts")
    DCAEVT2 = F( 4,      RW,   0,     "digital compare A event 2 interrupts")
    DCBEVT1 = F( 5,      RW,   0,     "digital compare B event 1 interrupts")
    DCBEVT2 = F( 6,      RW,   0,     "digital compare B event 2 interrupts")


class TZFLG(Register):
    #           bits     type  reset  description
    INT     = F( 0,      R,    0,     "trip interrupt given and not cleared yet")
    CBC     = F( 1,      R,    0,     "cycle-by-cycle trip")
    OST     = F( 2,      R,    0,     "one-shot trip")
    DCAEVT1 = F( 3,      R,    0,     "digital compare A event 1")
    DCAEVT2 = F( 4,      R,    0,     "digital compare A event 2")
    DCBEVT1 = F( 5,      R,    0,     "digital compare B event 1")
    DCBEVT2 = F( 6,      R,    0,     "digital compare B event 2")


class TZCBCFLG(Register):
    #           bits     type  reset  description
    CBC1    = F( 0,      R,    0,     "TZ1 tripped")
    CBC2    = F( 1,      R,    0,     "TZ2 tripped")
    CBC3    = F( 2,      R,    0,     "TZ3 tripped")
    CBC4    = F( 3,      R,    0,     "TZ4 tripped")
    CBC5    = F( 4,      R,    0,     "TZ5 tripped")
    CBC6    = F( 5,      R,    0,     "TZ6 tripped")
    DCAEVT2 = F( 6,      R,    0,     "digital compare A event 2 tripped")
    DCBEVT2 = F( 7,      R,    0,     "digital compare B event 2 tripped")


class TZOSTFLG(Register):
    #           bits     type  reset  description
    OST1    = F( 0,      R,    0,     "TZ1 tripped")
    OST2    = F( 1,      R,    0,     "TZ2 tripped")
    OST3    = F( 2,      R,    0,     "TZ3 tripped")
    OST4    = F( 3,      R,    0,     "TZ4 tripped")
    OST5    = F( 4,      R,    0,     "TZ5 tripped")
    OST6    = F( 5,      R,    0,     "TZ6 tripped")
    DCAEVT1 = F( 6,      R,    0,     "digital compare A event 1 tripped")
    DCBEVT1 = F( 7,      R,    0,     "digital compare B event 1 tripped")


class TZCLR(Register, eallow=True):
    #            bits     type  reset  description
    INT      = F( 0,      R0W1, 0,     "clear TZFLG.INT")
    CBC      = F( 1,      R0W1, 0,     "clear TZFLG.CBC")
    OST      = F( 2,      R0W1, 0,     "clear TZFLG.OST and release the outputs")
    DCAEVT1  = F( 3,      R0W1, 0,     "clear TZFLG.DCAEVT1")
    DCAEVT2  = F( 4,      R0W1, 0,     "clear TZFLG.DCAEVT2")
    DCBEVT1  = F( 5,      R0W1, 0,     "clear TZFLG.DCBEVT1")
    DCBEVT2  = F( 6,      R0W1, 0,     "clear TZFLG.DCBEVT2")
    CBCPULSE = F(15, 14,  RW,   0,     "a cycle-by-cycle trip ends at CTR: 0 0, 1 TBPRD, 2 both, 3 never")


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
    CBC     = F( 1,      R0W1, 0,     "force a cycle-by-cycle trip")
    OST     = F( 2,      R0W1, 0,     "force a one-shot trip")
    DCAEVT1 = F( 3,      R0W1, 0,     "force digital compare A event 1")
    DCAEVT2 = F( 4,      R0W1, 0,     "force digital compare A event 2")
    DCBEVT1 = F( 5,      R0W1, 0,     "force digital compare B event 1")
    DCBEVT2 = F( 6,      R0W1, 0,     "force digital compare B event 2")


class DCTRIPSEL(Register, eallow=True):
    #               bits     type  reset  description
    DCAHCOMPSEL = F( 3,  0,  RW,   0,     "source of DCAH")
    DCALCOMPSEL = F( 7,  4,  RW,   0,     "source of DCAL")
    DCBHCOMPSEL = F(11,  8,  RW,   0,     "source of DCBH")
    DCBLCOMPSEL = F(15, 12,  RW,   0,     "source of DCBL")


class DCACTL(Register, eallow=True):
    #                  bits     type  reset  description
    EVT1SRCSEL     = F( 0,      RW,   0,     "event 1 filtered")
    EVT1FRCSYNCSEL = F( 1,      RW,   0,     "event 1 asynchronous")
    EVT1SOCE       = F( 2,      RW,   0,     "event 1 gives SOC")
    EVT1SYNCE      = F( 3,      RW,   0,     "event 1 gives sync")
    EVT2SRCSEL     = F( 8,      RW,   0,     "event 2 filtered")
    EVT2FRCSYNCSEL = F( 9,      RW,   0,     "event 2 asynchronous")


class DCBCTL(Register, eallow=True):
    #                  bits     type  reset  description
    EVT1SRCSEL     = F( 0,      RW,   0,     "event 1 filtered")
    EVT1FRCSYNCSEL = F( 1,      RW,   0,     "event 1 asynchronous")
    EVT1SOCE       = F( 2,      RW,   0,     "event 1 gives SOC")
    EVT1SYNCE      = F( 3,      RW,   0,     "event 1 gives sync")
    EVT2SRCSEL     = F( 8,      RW,   0,     "event 2 filtered")
    EVT2FRCSYNCSEL = F( 9,      RW,   0,     "event 2 asynchronous")


class DCFCTL(Register, eallow=True):
    #               bits     type  reset  description
    SRCSEL      = F( 1,  0,  RW,   0,     "filtered signal")
    BLANKE      = F( 2,      RW,   0,     "blanking enabled")
    BLANKINV    = F( 3,      RW,   0,     "blanking inverted")
    PULSESEL    = F( 5,  4,  RW,   0,     "blanking aligned to")
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
    TRIPINPUT1   = F( 0,    RW,   0,     "trip input 1")
    TRIPINPUT2   = F( 1,    RW,   0,     "trip input 2")
    TRIPINPUT3   = F( 2,    RW,   0,     "trip input 3")
    TRIPINPUT4   = F( 3,    RW,   0,     "trip input 4")
    TRIPINPUT5   = F( 4,    RW,   0,     "trip input 5")
    TRIPINPUT6   = F( 5,    RW,   0,     "trip input 6")
    TRIPINPUT7   = F( 6,    RW,   0,     "trip input 7")
    TRIPINPUT8   = F( 7,    RW,   0,     "trip input 8")
    TRIPINPUT9   = F( 8,    RW,   0,     "trip input 9")
    TRIPINPUT10  = F( 9,    RW,   0,     "trip input 10")
    TRIPINPUT11  = F(10,    RW,   0,     "trip input 11")
    TRIPINPUT12  = F(11,    RW,   0,     "trip input 12")
    TRIPINPUT14  = F(13,    RW,   0,     "trip input 14")
    TRIPINPUT15  = F(14,    RW,   0,     "trip input 15")


class DCAHTRIPSEL(_TripSelect, eallow=True):
    """Trip inputs combined into DCAH."""


class DCALTRIPSEL(_TripSelect, eallow=True):
    """Trip inputs combined into DCAL."""


class DCBHTRIPSEL(_TripSelect, eallow=True):
    """Trip inputs combined into DCBH."""


class DCBLTRIPSEL(_TripSelect, eallow=True):
    """Trip inputs combined into DCBL."""
