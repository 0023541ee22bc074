/* adc_dma.c: CPU timer 1 starts four conversions of ADCC each 50 us; its end lets the DMA carry them into one of two
   halves of a buffer.  Main works on a half while the DMA fills the other. */
#include "F28x_Project.h"

#define CHANNELS    4u
#define ROUNDS      16u
#define HALF        (CHANNELS * ROUNDS)

#pragma DATA_SECTION(Buffer, "ramgs0");
static volatile Uint16 Buffer[2 * HALF];
static volatile Uint16 Halves = 0;
static Uint16 Mean[CHANNELS] = {0};
static Uint16 Done = 0;
static Uint16 Missed = 0;

__interrupt void Half_Full(void)
{
    Halves++;
    EALLOW;
    DmaRegs.CH1.DST_BEG_ADDR_SHADOW = (Uint32)&Buffer[(Halves % 2) * HALF];
    DmaRegs.CH1.DST_ADDR_SHADOW = (Uint32)&Buffer[(Halves % 2) * HALF];
    EDIS;
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP7;
}

static void Init_Adc(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR13.bit.ADC_C = 1;
    AdccRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcSetMode(ADC_ADCC, ADC_RESOLUTION_12BIT, ADC_SIGNALMODE_SINGLE);
    AdccRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdccRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdccRegs.ADCSOC0CTL.bit.CHSEL = 2;
    AdccRegs.ADCSOC0CTL.bit.ACQPS = 29;
    AdccRegs.ADCSOC0CTL.bit.TRIGSEL = 2;            /* CPU timer 1 */
    AdccRegs.ADCSOC1CTL.bit.CHSEL = 3;
    AdccRegs.ADCSOC1CTL.bit.ACQPS = 29;
    AdccRegs.ADCSOC1CTL.bit.TRIGSEL = 2;
    AdccRegs.ADCSOC2CTL.bit.CHSEL = 4;
    AdccRegs.ADCSOC2CTL.bit.ACQPS = 29;
    AdccRegs.ADCSOC2CTL.bit.TRIGSEL = 2;
    AdccRegs.ADCSOC3CTL.bit.CHSEL = 5;
    AdccRegs.ADCSOC3CTL.bit.ACQPS = 29;
    AdccRegs.ADCSOC3CTL.bit.TRIGSEL = 2;
    AdccRegs.ADCINTSEL1N2.bit.INT1SEL = 3;
    AdccRegs.ADCINTSEL1N2.bit.INT1CONT = 1;         /* nobody clears the flag: the DMA listens */
    AdccRegs.ADCINTSEL1N2.bit.INT1E = 1;
    AdccRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    EDIS;
}

static void Init_Dma(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR0.bit.DMA = 1;
    EDIS;
    DMAInitialize();
    DMACH1AddrConfig(&Buffer[0], &AdccResultRegs.ADCRESULT0);
    DMACH1BurstConfig(CHANNELS - 1, 1, 1);
    DMACH1TransferConfig(ROUNDS - 1, 0, 1);
    DMACH1WrapConfig(0, 0, 0xFFFF, 0);
    DMACH1ModeConfig(DMA_ADCCINT1, PERINT_ENABLE, ONESHOT_DISABLE, CONT_ENABLE, SYNC_DISABLE, SYNC_SRC,
                     OVRFLOW_DISABLE, SIXTEEN_BIT, CHINT_BEGIN, CHINT_ENABLE);
    StartDMACH1();
}

static void Work_On(Uint16 half)
{
    Uint16 channel, round;
    Uint32 sum;
    for (channel = 0; channel < CHANNELS; channel++) {
        sum = 0;
        for (round = 0; round < ROUNDS; round++)
            sum += Buffer[half * HALF + round * CHANNELS + channel];
        Mean[channel] = sum / ROUNDS;
    }
}

void main(void)
{
    Uint16 seen, now;
    InitSysCtrl();
    DINT;
    InitPieCtrl();
    IER = 0x0000;
    IFR = 0x0000;
    InitPieVectTable();
    EALLOW;
    PieVectTable.DMA_CH1_INT = &Half_Full;
    EDIS;
    Init_Adc();
    Init_Dma();
    InitCpuTimers();
    ConfigCpuTimer(&CpuTimer1, 200, 50);
    PieCtrlRegs.PIEIER7.bit.INTx1 = 1;
    IER |= M_INT7;
    EINT;
    StartCpuTimer1();
    /* The interrupt comes as a transfer begins: with the second one the first half is full. */
    while (Halves == 0)
        ;
    seen = 1;
    for (;;) {
        do {
            now = Halves;
        } while (now == seen);
        if (now != seen + 1)
            Missed++;
        seen = now;
        Work_On((now - 2) % 2);
        Done++;
    }
}
