"""eCAP1 to eCAP6: what each register is (TRM chapter eCAP; names, offsets and bits as in HDR F2837xS_ecap.h).

Bases 0x5000 to 0x50A0, 0x20 apart.  Nothing is EALLOW protected: TI's driver library for this chip writes all of it
without EALLOW.  The flags of period and compare are CTR_EQ_PRD and CTR_EQ_CMP in ECEINT, but CTR_PRD and CTR_CMP in the
other registers, as in the header.
CHOICE: ECCTL2 resets to 0x0006 (STOP_WRAP is 3), all others to 0.  HDR has no reset values.  TI's register headers of
other families have them, and disagree: four that were read have 0x0006, one has 0.
"""

from __future__ import annotations

from emulator.registers.core import R0W1, RW, At, Block, F, R, Register, Word


class ECCTL1(Register):
    #              bits     type  reset  description
    CAP1POL   = F( 0,       RW,   0,     "event 1 is 0 a rising edge, 1 a falling one")
    CTRRST1   = F( 1,       RW,   0,     "event 1 resets the counter")
    CAP2POL   = F( 2,       RW,   0,     "event 2 is 0 a rising edge, 1 a falling one")
    CTRRST2   = F( 3,       RW,   0,     "event 2 resets the counter")
    CAP3POL   = F( 4,       RW,   0,     "event 3 is 0 a rising edge, 1 a falling one")
    CTRRST3   = F( 5,       RW,   0,     "event 3 resets the counter")
    CAP4POL   = F( 6,       RW,   0,     "event 4 is 0 a rising edge, 1 a falling one")
    CTRRST4   = F( 7,       RW,   0,     "event 4 resets the counter")
    CAPLDEN   = F( 8,       RW,   0,     "events load CAP1 to CAP4")
    PRESCALE  = F(13,  9,   RW,   0,     "input divided by twice this; 0 not at all")
    FREE_SOFT = F(15, 14,   RW,   0,     "emulation halt (no debugger halts this CPU)")


class ECCTL2(Register):
    #                bits    type  reset  description
    CONT_ONESHT = F( 0,      RW,   0,     "0 continuous, 1 one-shot")
    STOP_WRAP   = F( 2, 1,   RW,   3,     "the event (0 is event 1) after which a one-shot stops, else the first follows")
    REARM       = F( 3,      R0W1, 0,     "the next event is event 1, and loads are enabled")
    TSCTRSTOP   = F( 4,      RW,   0,     "0 stops the counter, 1 lets it run")
    SYNCI_EN    = F( 5,      RW,   0,     "a sync loads CTRPHS into the counter")
    SYNCO_SEL   = F( 7, 6,   RW,   0,     "sync-out is 0 sync-in, 1 CTR = PRD, 2 and 3 nothing")
    SWSYNC      = F( 8,      R0W1, 0,     "a sync by software")
    CAP_APWM    = F( 9,      RW,   0,     "0 capture, 1 APWM")
    APWMPOL     = F(10,      RW,   0,     "the APWM output is active low")


class ECEINT(Register):
    #               bits  type  reset  description
    CEVT1      = F( 1,    RW,   0,     "event 1")
    CEVT2      = F( 2,    RW,   0,     "event 2")
    CEVT3      = F( 3,    RW,   0,     "event 3")
    CEVT4      = F( 4,    RW,   0,     "event 4")
    CTROVF     = F( 5,    RW,   0,     "counter overflow")
    CTR_EQ_PRD = F( 6,    RW,   0,     "counter at the period")
    CTR_EQ_CMP = F( 7,    RW,   0,     "counter at the compare value")


class ECFLG(Register):
    #            bits  type  reset  description
    INT     = F( 0,    R,    0,     "interrupt given and not cleared yet")
    CEVT1   = F( 1,    R,    0,     "event 1")
    CEVT2   = F( 2,    R,    0,     "event 2")
    CEVT3   = F( 3,    R,    0,     "event 3")
    CEVT4   = F( 4,    R,    0,     "event 4")
    CTROVF  = F( 5,    R,    0,     "counter overflow")
    CTR_PRD = F( 6,    R,    0,     "counter at the period")
    CTR_CMP = F( 7,    R,    0,     "counter at the compare value")


class ECCLR(Register):
    #            bits  type  reset  description
    INT     = F( 0,    R0W1, 0,     "clear ECFLG.INT")
    CEVT1   = F( 1,    R0W1, 0,     "clear ECFLG.CEVT1")
    CEVT2   = F( 2,    R0W1, 0,     "clear ECFLG.CEVT2")
    CEVT3   = F( 3,    R0W1, 0,     "clear ECFLG.CEVT3")
    CEVT4   = F( 4,    R0W1, 0,     "clear ECFLG.CEVT4")
    CTROVF  = F( 5,    R0W1, 0,     "clear ECFLG.CTROVF")
    CTR_PRD = F( 6,    R0W1, 0,     "clear ECFLG.CTR_PRD")
    CTR_CMP = F( 7,    R0W1, 0,     "clear ECFLG.CTR_CMP")


class ECFRC(Register):
    #            bits  type  reset  description
    CEVT1   = F( 1,    R0W1, 0,     "set ECFLG.CEVT1")
    CEVT2   = F( 2,    R0W1, 0,     "set ECFLG.CEVT2")
    CEVT3   = F( 3,    R0W1, 0,     "set ECFLG.CEVT3")
    CEVT4   = F( 4,    R0W1, 0,     "set ECFLG.CEVT4")
    CTROVF  = F( 5,    R0W1, 0,     "set ECFLG.CTROVF")
    CTR_PRD = F( 6,    R0W1, 0,     "set ECFLG.CTR_PRD")
    CTR_CMP = F( 7,    R0W1, 0,     "set ECFLG.CTR_CMP")


class ECapRegs(Block, struct="ECAP_REGS"):
    #        offset                  type  reset  bits
    TSCTR  = Word(0x00,              RW,   0,     32, text="time-stamp counter")
    CTRPHS = Word(0x02,              RW,   0,     32, text="what a sync loads into it")
    CAP1   = Word(0x04,              RW,   0,     32, text="time of event 1; APWM: period")
    CAP2   = Word(0x06,              RW,   0,     32, text="time of event 2; APWM: compare value")
    CAP3   = Word(0x08,              RW,   0,     32, text="time of event 3; APWM: next period")
    CAP4   = Word(0x0A,              RW,   0,     32, text="time of event 4; APWM: next compare value")
    ECCTL1 = At(0x14, ECCTL1)
    ECCTL2 = At(0x15, ECCTL2)
    ECEINT = At(0x16, ECEINT)
    ECFLG  = At(0x17, ECFLG)
    ECCLR  = At(0x18, ECCLR)
    ECFRC  = At(0x19, ECFRC)
