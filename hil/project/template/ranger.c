/* ranger.c: the distance to a wall, by an infrared sensor at input 3 of ADC-B. */
#include "ranger.h"

#define SAMPLES         8
#define FARTHEST_MM     4000

static Uint16 Samples[SAMPLES];

void Ranger_Init(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR13.bit.ADC_B = 1;
    AdcbRegs.ADCCTL2.bit.PRESCALE = 6;          /* 200 MHz / 4 */
    AdcbRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcbRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DELAY_US(1000);
    AdcbRegs.ADCSOC0CTL.bit.CHSEL = 3;
    AdcbRegs.ADCSOC0CTL.bit.ACQPS = 19;         /* 100 ns */
    AdcbRegs.ADCINTSEL1N2.bit.INT1SEL = 0;
    AdcbRegs.ADCINTSEL1N2.bit.INT1E = 1;
    EDIS;
}

static Uint16 Convert(void)
{
    AdcbRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    AdcbRegs.ADCSOCFRC1.bit.SOC0 = 1;
    while (AdcbRegs.ADCINTFLG.bit.ADCINT1 == 0)
        ;
    return AdcbResultRegs.ADCRESULT0;
}

/* The mean of the last conversions. */
Uint16 Ranger_Mean(void)
{
    Uint16 i;
    Uint32 sum = 0;
    for (i = 0; i < SAMPLES; i++)
        Samples[i] = Convert();
    for (i = 0; i < SAMPLES; i++)
        sum += Samples[i];
    // sum += Samples[SAMPLES];                 /* take both slashes away, and run pytest again */
    return sum / SAMPLES;
}

/* The sensor gives 0.24 V at a metre, and less the farther the wall is; 3 V are 4096. */
Uint16 Ranger_Distance_Mm(void)
{
    Uint16 code = Ranger_Mean();
    if (code <= 327680UL / FARTHEST_MM)
        return FARTHEST_MM;
    return 327680UL / code;
}
