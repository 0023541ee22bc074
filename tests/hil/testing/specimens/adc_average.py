"""adc_average.c: one channel of ADC-A by polling, the mean of eight conversions."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import (
    ADC_ADCA,
    ADC_RESOLUTION_12BIT,
    ADC_SIGNALMODE_SINGLE,
    EALLOW,
    EDIS,
    AdcaRegs,
    AdcaResultRegs,
    AdcSetMode,
    CpuSysRegs,
    DelayUs,
)

SAMPLES = 8


# adc_average.c: Init_ADC
def Init_ADC() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR13.bit.ADC_A = 1
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6
    AdcSetMode(ADC_ADCA, ADC_RESOLUTION_12BIT, ADC_SIGNALMODE_SINGLE)
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1
    DelayUs(1000)
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 5
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 19
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1
    EDIS()


# adc_average.c: Convert
def Convert() -> uint16:
    AdcaRegs.ADCSOCFRC1.bit.SOC0 = 1
    while AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0:
        pass
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1
    return AdcaResultRegs.ADCRESULT0


# adc_average.c: Read_Mean
def Read_Mean() -> uint16:
    sum: uint32 = 0
    i: uint16
    for i in range(SAMPLES):
        sum += Convert()
    return sum / SAMPLES


# adc_average.c: To_Millivolts
def To_Millivolts(code: uint16) -> uint16:
    return uint32(code) * 3000 / 4096
