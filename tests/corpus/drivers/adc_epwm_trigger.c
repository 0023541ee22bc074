/* adc_epwm_trigger.c: ePWM1 starts a conversion of two currents in every period; the interrupt routine of the ADC
   limits the duty of the half bridge that draws them. */
#include "F28x_Project.h"

#define PERIOD      5000u           /* TBCLK of 100 MHz, counting up: 20 kHz */
#define SAMPLE_AT   2500u
#define WINDOW      29u             /* 30 cycles: 150 ns */
#define LIMIT       3000u
#define OFFSET_RUNS 64u

static volatile Uint16 Current_A = 0;
static volatile Uint16 Current_B = 0;
static volatile Uint32 Conversions = 0;
static Uint16 Offset_A = 0;
static Uint16 Offset_B = 0;
static volatile Uint16 Duty = 100;

__interrupt void Currents(void)
{
    Current_A = AdcbResultRegs.ADCRESULT0;
    Current_B = AdcbResultRegs.ADCRESULT1;
    Conversions++;
    if (Current_A > LIMIT || Current_B > LIMIT)
        EPwm1Regs.CMPB.bit.CMPB = 0;
    else
        EPwm1Regs.CMPB.bit.CMPB = Duty;
    AdcbRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1;
}

static void Init_Adc(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR13.bit.ADC_B = 1;
    AdcbRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcSetMode(ADC_ADCB, ADC_RESOLUTION_12BIT, ADC_SIGNALMODE_SINGLE);
    AdcbRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcbRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcbRegs.ADCSOC0CTL.bit.CHSEL = 2;
    AdcbRegs.ADCSOC0CTL.bit.ACQPS = WINDOW;
    AdcbRegs.ADCSOC0CTL.bit.TRIGSEL = 5;            /* EPWM1 SOCA */
    AdcbRegs.ADCSOC1CTL.bit.CHSEL = 3;
    AdcbRegs.ADCSOC1CTL.bit.ACQPS = WINDOW;
    AdcbRegs.ADCSOC1CTL.bit.TRIGSEL = 5;
    AdcbRegs.ADCINTSEL1N2.bit.INT1SEL = 1;          /* end of SOC1 */
    AdcbRegs.ADCINTSEL1N2.bit.INT1CONT = 0;
    AdcbRegs.ADCINTSEL1N2.bit.INT1E = 1;
    AdcbRegs.ADCINTFLGCLR.all = 0x000F;
    EDIS;
}

static void Init_Pwm(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0;
    CpuSysRegs.PCLKCR2.bit.EPWM1 = 1;
    EDIS;
    EPwm1Regs.TBCTL.bit.CTRMODE = TB_FREEZE;
    EPwm1Regs.TBCTL.bit.PHSEN = TB_DISABLE;
    EPwm1Regs.TBCTL.bit.HSPCLKDIV = TB_DIV1;
    EPwm1Regs.TBCTL.bit.CLKDIV = TB_DIV1;
    EPwm1Regs.TBPRD = PERIOD - 1;
    EPwm1Regs.TBCTR = 0;
    EPwm1Regs.CMPCTL.bit.SHDWBMODE = CC_SHADOW;
    EPwm1Regs.CMPCTL.bit.LOADBMODE = CC_CTR_ZERO;
    EPwm1Regs.CMPA.bit.CMPA = SAMPLE_AT;
    EPwm1Regs.CMPB.bit.CMPB = Duty;
    EPwm1Regs.AQCTLB.bit.ZRO = AQ_SET;
    EPwm1Regs.AQCTLB.bit.CBU = AQ_CLEAR;
    EPwm1Regs.ETSEL.bit.SOCASEL = ET_CTRU_CMPA;
    EPwm1Regs.ETPS.bit.SOCAPRD = ET_1ST;
    EPwm1Regs.ETSEL.bit.SOCAEN = 1;
    InitEPwm1Gpio();
    EPwm1Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
}

/* The offsets of the amplifiers, while nothing flows. */
static void Find_Offsets(void)
{
    Uint32 sum_a = 0, sum_b = 0, seen, last;
    Uint16 n;
    last = Conversions;
    for (n = 0; n < OFFSET_RUNS; n++) {
        do {
            seen = Conversions;
        } while (seen == last);
        last = seen;
        sum_a += Current_A;
        sum_b += Current_B;
    }
    Offset_A = sum_a / OFFSET_RUNS;
    Offset_B = sum_b / OFFSET_RUNS;
}

void main(void)
{
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.ADCB1_INT = &Currents;
    EDIS;
    Init_Adc();
    Init_Pwm();
    PieCtrlRegs.PIEIER1.bit.INTx2 = 1;              /* ADCB1 */
    IER |= M_INT1;
    EINT;
    Find_Offsets();
    for (;;) {
        Duty = Offset_A > 100 || Offset_B > 100 ? 50 : 200;
        DELAY_US(1000);
    }
}
