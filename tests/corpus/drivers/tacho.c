/*
 * tacho.c: a fan at ePWM1A, its tachometer (four pulses a turn) at GPIO24 and eCAP1.  The speed is ordered in steps;
 * a lamp at GPIO31 says that the fan stands.
 */
#include "F28x_Project.h"

#define TBCLK_HZ        100000000UL
#define CARRIER_HZ      20000UL
#define CARRIER         (TBCLK_HZ / CARRIER_HZ)
#define CONTROL_PRD     24999U      /* 100 MHz / 25000 = 4 kHz */
#define CYCLES_PER_US   200UL
#define STALL_US        100000UL
#define SHORTEST_US     500UL
#define US_PER_MINUTE   60000000UL
#define PULSES_PER_TURN 4
#define RUNS_PER_ORDER  600U
#define LAMP            31

static volatile uint32_t pulseCycles = 0;
static volatile uint32_t pulses = 0;
static volatile uint32_t runs = 0;
volatile uint16_t speedRpm = 0;
static const uint16_t percent[4] = {60, 90, 45, 70};

interrupt void capturedIsr(void);
interrupt void controlIsr(void);

static void initPins(void)
{
    EALLOW;
    GpioCtrlRegs.GPAMUX1.bit.GPIO0 = 1;
    GpioCtrlRegs.GPADIR.bit.GPIO31 = 1;
    InputXbarRegs.INPUT7SELECT = 24;
    EDIS;
}

static void initPwm(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR2.bit.EPWM1 = 1;
    CpuSysRegs.PCLKCR2.bit.EPWM2 = 1;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0;
    EDIS;
    EPwm1Regs.TBCTL.bit.HSPCLKDIV = 0;
    EPwm1Regs.TBCTL.bit.CLKDIV = 0;
    EPwm1Regs.TBPRD = CARRIER - 1;
    EPwm1Regs.TBCTR = 0;
    EPwm1Regs.CMPA.bit.CMPA = 0;
    EPwm1Regs.AQCTLA.bit.ZRO = AQ_SET;
    EPwm1Regs.AQCTLA.bit.CAU = AQ_CLEAR;
    EPwm1Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;

    EPwm2Regs.TBCTL.bit.HSPCLKDIV = 0;
    EPwm2Regs.TBCTL.bit.CLKDIV = 0;
    EPwm2Regs.TBPRD = CONTROL_PRD;
    EPwm2Regs.TBCTR = 0;
    EPwm2Regs.ETSEL.bit.INTSEL = ET_CTR_ZERO;
    EPwm2Regs.ETPS.bit.INTPRD = ET_1ST;
    EPwm2Regs.ETSEL.bit.INTEN = 1;
    EPwm2Regs.TBCTL.bit.CTRMODE = TB_COUNT_UP;
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1;
    EDIS;
}

static void initCapture(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR3.bit.ECAP1 = 1;
    EDIS;
    ECap1Regs.ECCTL1.bit.CAP1POL = 0;
    ECap1Regs.ECCTL1.bit.CTRRST1 = 1;
    ECap1Regs.ECCTL1.bit.CAPLDEN = 1;
    ECap1Regs.ECCTL2.bit.STOP_WRAP = 0;
    ECap1Regs.ECEINT.bit.CEVT1 = 1;
    ECap1Regs.ECCTL2.bit.TSCTRSTOP = 1;
}

static void initTimer(void)
{
    InitCpuTimers();
    CpuTimer1Regs.PRD.all = 0xFFFFFFFFUL;
    CpuTimer1Regs.TPR.all = 199;                    /* counts microseconds */
    CpuTimer1Regs.TPRH.all = 0;
    CpuTimer1Regs.TCR.bit.TRB = 1;
    CpuTimer1Regs.TCR.bit.TSS = 0;
}

/* The time in microseconds between two pulses */
static uint32_t pulseUs(void)
{
    return pulseCycles / CYCLES_PER_US;
}

static uint16_t longer(uint32_t measured, uint32_t limit)
{
    return measured > limit;
}

interrupt void capturedIsr(void)
{
    pulseCycles = ECap1Regs.CAP1;
    pulses++;
    ECap1Regs.ECCLR.all = 0x0003;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP4;
}

interrupt void controlIsr(void)
{
    static uint32_t begun = 0;
    static uint32_t seen = 0;
    uint32_t now = ~CpuTimer1Regs.TIM.all;
    uint32_t us = pulseUs();

    if (pulses != seen)
    {
        seen = pulses;
        begun = now;
        if (us > SHORTEST_US)
            speedRpm = (uint16_t)(US_PER_MINUTE / PULSES_PER_TURN / us);
    }
    else if (longer(now - begun, STALL_US))
    {
        speedRpm = 0;
    }
    GPIO_WritePin(LAMP, speedRpm == 0);
    runs++;
    EPwm1Regs.CMPA.bit.CMPA = (uint16_t)(CARRIER * percent[runs / RUNS_PER_ORDER & 3] / 100);
    EPwm2Regs.ETCLR.bit.INT = 1;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP3;
}

void main(void)
{
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0;
    IFR = 0;
    InitPieVectTable();
    EALLOW;
    PieVectTable.ECAP1_INT = &capturedIsr;
    PieVectTable.EPWM2_INT = &controlIsr;
    EDIS;
    initPins();
    initTimer();
    initCapture();
    initPwm();
    PieCtrlRegs.PIEIER3.bit.INTx2 = 1;
    PieCtrlRegs.PIEIER4.bit.INTx1 = 1;
    IER |= M_INT3 | M_INT4;
    EINT;
    for (;;)
    {
    }
}
