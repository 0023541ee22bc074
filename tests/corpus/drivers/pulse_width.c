/* pulse_width.c: eCAP1 measures period and width of the PWM on GPIO4, which ePWM3 makes with a changing duty; main
   compares both and counts what is off. */
#include "F28x_Project.h"

#define PWM_PIN     4u
#define PERIOD      2000u           /* counts of 100 MHz: 20 us, 4000 cycles */
#define NARROW      100u            /* 1 us */
#define WIDE        1900u
#define DUTY_STEP   100u
#define TOLERANCE   8u              /* cycles of 200 MHz */

static volatile Uint32 Period = 0;
static volatile Uint32 Width = 0;
static volatile Uint16 Captures = 0;
static Uint16 Off = 0;

__interrupt void Captured(void)
{
    Width = ECap1Regs.CAP2;
    Period = ECap1Regs.CAP2 + ECap1Regs.CAP3;
    Captures++;
    ECap1Regs.ECCLR.bit.CEVT3 = 1;
    ECap1Regs.ECCLR.bit.INT = 1;
    ECap1Regs.ECCTL2.bit.REARM = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP4;
}

static void Init_Capture(void)
{
    InitECap1Gpio(PWM_PIN);
    GPIO_SetupPinOptions(PWM_PIN, GPIO_OUTPUT, GPIO_SYNC);
    ECap1Regs.ECEINT.all = 0;
    ECap1Regs.ECCTL1.bit.CAPLDEN = 0;
    ECap1Regs.ECCTL2.bit.TSCTRSTOP = 0;
    ECap1Regs.ECCLR.all = 0x00FF;
    ECap1Regs.ECCTL1.bit.CAP1POL = 0;           /* rising */
    ECap1Regs.ECCTL1.bit.CAP2POL = 1;           /* falling */
    ECap1Regs.ECCTL1.bit.CAP3POL = 0;
    ECap1Regs.ECCTL1.bit.CTRRST1 = 1;           /* each edge begins at 0 */
    ECap1Regs.ECCTL1.bit.CTRRST2 = 1;
    ECap1Regs.ECCTL1.bit.CTRRST3 = 1;
    ECap1Regs.ECCTL1.bit.PRESCALE = 0;
    ECap1Regs.ECCTL2.bit.CAP_APWM = 0;
    ECap1Regs.ECCTL2.bit.CONT_ONESHT = 1;       /* one shot */
    ECap1Regs.ECCTL2.bit.STOP_WRAP = 2;         /* of three edges */
    ECap1Regs.ECCTL2.bit.SYNCI_EN = 0;
    ECap1Regs.ECCTL2.bit.SYNCO_SEL = 2;
    ECap1Regs.ECCTL1.bit.CAPLDEN = 1;
    ECap1Regs.ECCTL2.bit.TSCTRSTOP = 1;
    ECap1Regs.ECEINT.bit.CEVT3 = 1;
    ECap1Regs.ECCTL2.bit.REARM = 1;
}

static void Init_Pwm(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0;
    EDIS;
    EPwm3Regs.TBPRD = PERIOD - 1;
    EPwm3Regs.TBCTR = 0;
    EPwm3Regs.TBCTL.bit.HSPCLKDIV = TB_DIV1;
    EPwm3Regs.TBCTL.bit.CLKDIV = TB_DIV1;
    EPwm3Regs.CMPA.bit.CMPA = NARROW;
    EPwm3Regs.AQCTLA.bit.ZRO = AQ_SET;
    EPwm3Regs.AQCTLA.bit.CAU = AQ_CLEAR;
    EPwm3Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    InitEPwm3Gpio();
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
}

static Uint16 Differ(Uint32 a, Uint32 b)
{
    Uint32 by = a > b ? a - b : b - a;
    return by > TOLERANCE;
}

void main(void)
{
    Uint16 duty = NARROW, seen;
    Uint32 width, period;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.ECAP1_INT = &Captured;
    EDIS;
    Init_Pwm();
    Init_Capture();
    PieCtrlRegs.PIEIER4.bit.INTx1 = 1;
    IER |= M_INT4;
    EINT;
    for (;;) {
        EPwm3Regs.CMPA.bit.CMPA = duty;
        DELAY_US(200);                          /* the old duty has left the capture */
        seen = Captures;
        while (Captures == seen)
            ;
        DINT;
        width = Width;
        period = Period;
        EINT;
        if (Differ(period, 2ul * PERIOD) || Differ(width, 2ul * duty))
            Off++;
        duty = duty < WIDE ? duty + DUTY_STEP : NARROW;
    }
}
