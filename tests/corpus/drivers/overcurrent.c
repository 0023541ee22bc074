/* overcurrent.c: comparator 2 watches a current at ADCINA4 and trips ePWM4 through TRIP4 and its digital compare.
   Before the bridge is let go, the whole way is tried by turning the comparator over, with the output forced low. */
#include "F28x_Project.h"

#define PERIOD      2000u
#define DUTY        800u
#define LIMIT       3000u           /* of 4096 parts of VDDA: 2.42 V */
#define SAMPLES     10u
#define ENOUGH      7u
#define REST_US     1000

static volatile Uint16 Trips = 0;
static Uint16 Way_Works = 0;
static Uint16 Rounds = 0;

static void Init_Comparator(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR14.bit.CMPSS2 = 1;
    Cmpss2Regs.COMPCTL.bit.COMPDACE = 1;
    Cmpss2Regs.COMPCTL.bit.COMPHSOURCE = 0;         /* against the DAC */
    Cmpss2Regs.COMPDACCTL.bit.SELREF = 0;           /* of VDDA */
    Cmpss2Regs.COMPDACCTL.bit.SWLOADSEL = 0;
    Cmpss2Regs.COMPDACCTL.bit.DACSOURCE = 0;
    Cmpss2Regs.DACHVALS.bit.DACVAL = LIMIT;
    Cmpss2Regs.CTRIPHFILCLKCTL.bit.CLKPRESCALE = 9;
    Cmpss2Regs.CTRIPHFILCTL.bit.SAMPWIN = SAMPLES - 1;
    Cmpss2Regs.CTRIPHFILCTL.bit.THRESH = ENOUGH - 1;
    Cmpss2Regs.CTRIPHFILCTL.bit.FILINIT = 1;
    Cmpss2Regs.COMPCTL.bit.CTRIPHSEL = 2;           /* filtered */
    DELAY_US(10);
    EPwmXbarRegs.TRIP4MUX0TO15CFG.bit.MUX2 = 0;     /* CMPSS2.CTRIPH */
    EPwmXbarRegs.TRIP4MUXENABLE.bit.MUX2 = 1;
    EDIS;
}

static void Init_Pwm(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0;
    EDIS;
    EPwm4Regs.TBCTL.bit.HSPCLKDIV = TB_DIV1;
    EPwm4Regs.TBCTL.bit.CLKDIV = TB_DIV1;
    EPwm4Regs.TBPRD = PERIOD - 1;
    EPwm4Regs.CMPA.bit.CMPA = DUTY;
    EPwm4Regs.AQCTLA.bit.ZRO = AQ_SET;
    EPwm4Regs.AQCTLA.bit.CAU = AQ_CLEAR;
    EALLOW;
    EPwm4Regs.DCTRIPSEL.bit.DCAHCOMPSEL = DC_TRIPIN4;
    EPwm4Regs.TZDCSEL.bit.DCAEVT1 = TZ_DCAH_HI;
    EPwm4Regs.DCACTL.bit.EVT1SRCSEL = DC_EVT1;
    EPwm4Regs.DCACTL.bit.EVT1FRCSYNCSEL = DC_EVT_ASYNC;
    EPwm4Regs.TZSEL.bit.DCAEVT1 = TZ_ENABLE;        /* one shot */
    EPwm4Regs.TZCTL.bit.TZA = TZ_FORCE_LO;
    EPwm4Regs.TZFRC.bit.OST = 1;                    /* nothing before the test */
    EDIS;
    EPwm4Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
    InitEPwm4Gpio();
}

static void Clear_Trip(void)
{
    EALLOW;
    EPwm4Regs.TZCLR.bit.DCAEVT1 = 1;
    EPwm4Regs.TZCLR.bit.OST = 1;
    EDIS;
}

/* 1 if a comparator that is turned over trips the bridge. */
static Uint16 Try_Way(void)
{
    Uint16 tripped;
    EPwm4Regs.AQCSFRC.bit.CSFA = 1;                 /* low, whatever the trip does */
    DELAY_US(50);
    Clear_Trip();
    EALLOW;
    Cmpss2Regs.COMPCTL.bit.COMPHINV = 1;
    EDIS;
    DELAY_US(5);                                    /* the filter takes half a microsecond */
    tripped = EPwm4Regs.TZFLG.bit.OST;
    EALLOW;
    Cmpss2Regs.COMPCTL.bit.COMPHINV = 0;
    EDIS;
    DELAY_US(5);
    return tripped;
}

void main(void)
{
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    Init_Comparator();
    Init_Pwm();
    Way_Works = Try_Way();
    while (!Way_Works)
        DELAY_US(REST_US);                          /* a bridge that nothing protects stays off */
    EPwm4Regs.AQCSFRC.bit.CSFA = 0;
    Clear_Trip();
    for (;;) {
        if (EPwm4Regs.TZFLG.bit.OST) {
            Trips++;
            DELAY_US(REST_US);
            Clear_Trip();
        }
        Rounds++;
        DELAY_US(100);
    }
}
