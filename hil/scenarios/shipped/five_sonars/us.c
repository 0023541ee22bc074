/* us.c for a robot with five sonars: what stands ahead is the nearest of what three of them hear.

   Inputs of ADC-A: left 2, front 3, right 4 as on the robot, front left 1, front right 5 (`hil docs options`). */
#include "F2837xS_Device.h"
#include "F2837xS_Adc_defines.h"
#include "us.h"

#define SONARS  5
#define SAMPLES 12
/* Where the diagonals stand behind the enumeration of us.h. */
#define FRONT_LEFT  3
#define FRONT_RIGHT 4

extern void AdcSetMode(uint16 adc, uint16 resolution, uint16 signalmode);
extern void DelayUs(volatile uint16 Usec);

/* Centimetres of a sum of 12 samples over 2.3, as the robot's sonars are calibrated.
   A sonar of 3.3 V gives 3.3 V / 512 an inch, the converter 3.0 V / 4096 a count. */
static float slope[SONARS] = {0.0545f, 0.0545f, 0.0545f, 0.0545f, 0.0545f};
static float bias[SONARS];

void Init_US(void)
{
    EALLOW;
    CpuSysRegs.PCLKCR13.bit.ADC_A = 1;
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6;
    AdcSetMode(ADC_ADCA, ADC_RESOLUTION_12BIT, ADC_SIGNALMODE_SINGLE);
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1;
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1;
    DelayUs(1000);
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 2;
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 19;
    AdcaRegs.ADCSOC1CTL.bit.CHSEL = 3;
    AdcaRegs.ADCSOC1CTL.bit.ACQPS = 19;
    AdcaRegs.ADCSOC2CTL.bit.CHSEL = 4;
    AdcaRegs.ADCSOC2CTL.bit.ACQPS = 19;
    AdcaRegs.ADCSOC3CTL.bit.CHSEL = 1;
    AdcaRegs.ADCSOC3CTL.bit.ACQPS = 19;
    AdcaRegs.ADCSOC4CTL.bit.CHSEL = 5;
    AdcaRegs.ADCSOC4CTL.bit.ACQPS = 19;
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1;
    /* One pulse starts the ring, then its last sonar drives the wire. */
    GpioDataRegs.GPCCLEAR.bit.GPIO69 = 1;
    GpioCtrlRegs.GPCDIR.bit.GPIO69 = 1;
    EDIS;
    DelayUs(1000);
    GpioDataRegs.GPCSET.bit.GPIO69 = 1;
    DelayUs(25);
    GpioDataRegs.GPCCLEAR.bit.GPIO69 = 1;
    DelayUs(10);
    EALLOW;
    GpioCtrlRegs.GPCDIR.bit.GPIO69 = 0;
    EDIS;
}

void Calibrate_US(US_SENSOR USS, float m, float b)
{
    slope[USS] = m;
    bias[USS] = b;
    if (USS == FRONT) {
        slope[FRONT_LEFT] = slope[FRONT_RIGHT] = m;
        bias[FRONT_LEFT] = bias[FRONT_RIGHT] = b;
    }
}

Uint16 Read_Channel(char CH)
{
    EALLOW;
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = CH;
    EDIS;
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    AdcaRegs.ADCSOCFRC1.all = 1 << CH;
    while (AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0)
        ;
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1;
    switch (CH) {
    case 0:  return AdcaResultRegs.ADCRESULT0;
    case 1:  return AdcaResultRegs.ADCRESULT1;
    case 2:  return AdcaResultRegs.ADCRESULT2;
    case 3:  return AdcaResultRegs.ADCRESULT3;
    default: return AdcaResultRegs.ADCRESULT4;
    }
}

static float Distance(char CH)
{
    float sum = 0.0f;
    int i;

    for (i = 0; i < SAMPLES; i++)
        sum += Read_Channel(CH);
    return slope[CH] * (sum / 2.3f) + bias[CH];
}

static float Nearer(float a, float b)
{
    return a < b ? a : b;
}

float Read_Distance(US_SENSOR USS)
{
    float ahead = Distance((char)USS);

    if (USS == FRONT)
        ahead = Nearer(ahead, Nearer(Distance(FRONT_LEFT), Distance(FRONT_RIGHT)));
    return ahead;
}
