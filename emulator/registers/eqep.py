"""eQEP1-3: what each register is (TRM chapter eQEP; names, offsets and bits as in HDR F2837xS_eqep.h).

Bases 0x5100, 0x5140, 0x5180.  Nothing is EALLOW protected; everything resets to 0.  Bit 2 is QPE in QEINT but PHE in
QFLG, QCLR and QFRC: so the header spells it.
"""

from __future__ import annotations

from emulator.registers.core import R0W1, RW, W1C, At, Block, F, R, Register, Word


class QDECCTL(Register):
    #          bits     type  reset  description
    QSP   = F( 5,       RW,   0,     "strobe input inverted")
    QIP   = F( 6,       RW,   0,     "index input inverted")
    QBP   = F( 7,       RW,   0,     "B input inverted")
    QAP   = F( 8,       RW,   0,     "A input inverted")
    IGATE = F( 9,       RW,   0,     "index gated with the strobe", modelled=False)
    SWAP  = F(10,       RW,   0,     "A and B exchanged")
    XCR   = F(11,       RW,   0,     "QSRC 1-3: 0 both edges of A, 1 rising edge only")
    SPSEL = F(12,       RW,   0,     "sync output on 0 index pin, 1 strobe pin", modelled=False)
    SOEN  = F(13,       RW,   0,     "sync output enabled", modelled=False)
    QSRC  = F(15, 14,   RW,   0,     "0 quadrature, 1 direction-count, 2 up-count, 3 down-count")


class QEPCTL(Register):
    #              bits     type  reset  description
    WDE       = F( 0,       RW,   0,     "watchdog enabled")
    UTE       = F( 1,       RW,   0,     "unit timer enabled")
    QCLM      = F( 2,       RW,   0,     "capture latched on 0 CPU read of QPOSCNT, 1 unit time-out")
    QPEN      = F( 3,       RW,   0,     "position counter enabled (TRM: PHEN); 0 is a software reset")
    IEL       = F( 5,  4,   RW,   0,     "index latch: 1 rising, 2 falling, 3 index marker")
    SEL       = F( 6,       RW,   0,     "strobe latch: 0 rising, 1 rising forward and falling backward")
    SWI       = F( 7,       R0W1, 0,     "load QPOSINIT now")
    IEI       = F( 9,  8,   RW,   0,     "load QPOSINIT on index: 2 rising, 3 falling")
    SEI       = F(11, 10,   RW,   0,     "load QPOSINIT on strobe: 2 rising, 3 rising forward and falling backward")
    PCRM      = F(13, 12,   RW,   0,     "reset on: 0 index, 1 QPOSMAX, 2 first index, 3 unit time-out")
    FREE_SOFT = F(15, 14,   RW,   0,     "emulation halt (no debugger halts this CPU)")


class QCAPCTL(Register):
    #         bits     type  reset  description
    UPPS = F( 3,  0,   RW,   0,     "unit position event every 2^UPPS edges")
    CCPS = F( 6,  4,   RW,   0,     "capture clock SYSCLK / 2^CCPS")
    CEN  = F(15,       RW,   0,     "capture enabled")


class QPOSCTL(Register):
    #           bits     type  reset  description
    PCSPW  = F(11,  0,   RW,   0,     "sync output pulse width", modelled=False)
    PCE    = F(12,       RW,   0,     "position compare enabled")
    PCPOL  = F(13,       RW,   0,     "sync output polarity", modelled=False)
    PCLOAD = F(14,       RW,   0,     "QPOSCMP loads at 0 QPOSCNT = 0, 1 QPOSCNT = QPOSCMP")
    PCSHDW = F(15,       RW,   0,     "QPOSCMP is shadowed")


class QEINT(Register):
    #        bits  type  reset  description
    PCE = F( 1,    RW,   0,     "position counter error")
    QPE = F( 2,    RW,   0,     "quadrature phase error")
    QDC = F( 3,    RW,   0,     "direction change")
    WTO = F( 4,    RW,   0,     "watchdog time-out")
    PCU = F( 5,    RW,   0,     "position counter underflow")
    PCO = F( 6,    RW,   0,     "position counter overflow")
    PCR = F( 7,    RW,   0,     "position compare ready (shadow loaded)")
    PCM = F( 8,    RW,   0,     "position compare match")
    SEL = F( 9,    RW,   0,     "strobe latch")
    IEL = F(10,    RW,   0,     "index latch")
    UTO = F(11,    RW,   0,     "unit time-out")


class QFLG(Register):
    #        bits  type  reset  description
    INT = F( 0,    R,    0,     "interrupt given and not cleared yet")
    PCE = F( 1,    R,    0,     "position counter error")
    PHE = F( 2,    R,    0,     "quadrature phase error")
    QDC = F( 3,    R,    0,     "direction change")
    WTO = F( 4,    R,    0,     "watchdog time-out")
    PCU = F( 5,    R,    0,     "position counter underflow")
    PCO = F( 6,    R,    0,     "position counter overflow")
    PCR = F( 7,    R,    0,     "position compare ready (shadow loaded)")
    PCM = F( 8,    R,    0,     "position compare match")
    SEL = F( 9,    R,    0,     "strobe latch")
    IEL = F(10,    R,    0,     "index latch")
    UTO = F(11,    R,    0,     "unit time-out")


class QCLR(Register):
    #        bits  type  reset  description
    INT = F( 0,    R0W1, 0,     "clear QFLG.INT")
    PCE = F( 1,    R0W1, 0,     "clear QFLG.PCE")
    PHE = F( 2,    R0W1, 0,     "clear QFLG.PHE")
    QDC = F( 3,    R0W1, 0,     "clear QFLG.QDC")
    WTO = F( 4,    R0W1, 0,     "clear QFLG.WTO")
    PCU = F( 5,    R0W1, 0,     "clear QFLG.PCU")
    PCO = F( 6,    R0W1, 0,     "clear QFLG.PCO")
    PCR = F( 7,    R0W1, 0,     "clear QFLG.PCR")
    PCM = F( 8,    R0W1, 0,     "clear QFLG.PCM")
    SEL = F( 9,    R0W1, 0,     "clear QFLG.SEL")
    IEL = F(10,    R0W1, 0,     "clear QFLG.IEL")
    UTO = F(11,    R0W1, 0,     "clear QFLG.UTO")


class QFRC(Register):
    #        bits  type  reset  description
    PCE = F( 1,    R0W1, 0,     "set QFLG.PCE")
    PHE = F( 2,    R0W1, 0,     "set QFLG.PHE")
    QDC = F( 3,    R0W1, 0,     "set QFLG.QDC")
    WTO = F( 4,    R0W1, 0,     "set QFLG.WTO")
    PCU = F( 5,    R0W1, 0,     "set QFLG.PCU")
    PCO = F( 6,    R0W1, 0,     "set QFLG.PCO")
    PCR = F( 7,    R0W1, 0,     "set QFLG.PCR")
    PCM = F( 8,    R0W1, 0,     "set QFLG.PCM")
    SEL = F( 9,    R0W1, 0,     "set QFLG.SEL")
    IEL = F(10,    R0W1, 0,     "set QFLG.IEL")
    UTO = F(11,    R0W1, 0,     "set QFLG.UTO")


class QEPSTS(Register):
    #          bits  type  reset  description
    PCEF   = F(0,    R,    0,     "position counter error at the last index (PCRM 0)")
    FIMF   = F(1,    W1C,  0,     "first index marker seen")
    CDEF   = F(2,    W1C,  0,     "direction changed between two unit position events")
    COEF   = F(3,    W1C,  0,     "capture timer overflowed between two unit position events")
    QDLF   = F(4,    R,    0,     "direction at the last index marker")
    QDF    = F(5,    R,    0,     "direction: 1 forward")
    FIDF   = F(6,    R,    0,     "direction at the first index marker")
    UPEVNT = F(7,    W1C,  0,     "unit position event")


class EQepRegs(Block, struct="EQEP_REGS"):
    #          offset                   type  reset  bits
    QPOSCNT  = Word(0x00,               RW,   0,     32, text="position counter")
    QPOSINIT = Word(0x02,               RW,   0,     32, text="initial position")
    QPOSMAX  = Word(0x04,               RW,   0,     32, text="maximum position")
    QPOSCMP  = Word(0x06,               RW,   0,     32, text="position compare")
    QPOSILAT = Word(0x08,               R,    0,     32, text="position latched on index")
    QPOSSLAT = Word(0x0A,               R,    0,     32, text="position latched on strobe")
    QPOSLAT  = Word(0x0C,               R,    0,     32, text="position latched on unit time-out")
    QUTMR    = Word(0x0E,               RW,   0,     32, text="unit timer")
    QUPRD    = Word(0x10,               RW,   0,     32, text="unit period")
    QWDTMR   = Word(0x12,               RW,   0,     16, text="watchdog timer")
    QWDPRD   = Word(0x13,               RW,   0,     16, text="watchdog period")
    QDECCTL  = At(0x14, QDECCTL)
    QEPCTL   = At(0x15, QEPCTL)
    QCAPCTL  = At(0x16, QCAPCTL)
    QPOSCTL  = At(0x17, QPOSCTL)
    QEINT    = At(0x18, QEINT)
    QFLG     = At(0x19, QFLG)
    QCLR     = At(0x1A, QCLR)
    QFRC     = At(0x1B, QFRC)
    QEPSTS   = At(0x1C, QEPSTS)
    QCTMR    = Word(0x1D,               RW,   0,     16, text="capture timer")
    QCPRD    = Word(0x1E,               RW,   0,     16, text="capture period")
    QCTMRLAT = Word(0x1F,               R,    0,     16, text="capture timer latch")
    QCPRDLAT = Word(0x20,               R,    0,     16, text="capture period latch")
