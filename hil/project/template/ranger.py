"""The distance to a wall, by an infrared sensor at input 3 of ADC-B."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, AdcbRegs, AdcbResultRegs, CpuSysRegs, DelayUs

SAMPLES = 8
FARTHEST_MM = 4000

_Samples: array[uint16, SAMPLES]


def Ranger_Init() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR13.bit.ADC_B = 1
    AdcbRegs.ADCCTL2.bit.PRESCALE = 6  # 200 MHz / 4
    AdcbRegs.ADCCTL1.bit.INTPULSEPOS = 1
    AdcbRegs.ADCCTL1.bit.ADCPWDNZ = 1
    DelayUs(1000)
    AdcbRegs.ADCSOC0CTL.bit.CHSEL = 3
    AdcbRegs.ADCSOC0CTL.bit.ACQPS = 19  # 100 ns
    AdcbRegs.ADCINTSEL1N2.bit.INT1SEL = 0
    AdcbRegs.ADCINTSEL1N2.bit.INT1E = 1
    EDIS()


def _Convert() -> uint16:
    AdcbRegs.ADCINTFLGCLR.bit.ADCINT1 = 1
    AdcbRegs.ADCSOCFRC1.bit.SOC0 = 1
    while AdcbRegs.ADCINTFLG.bit.ADCINT1 == 0:
        pass
    return AdcbResultRegs.ADCRESULT0


# The mean of the last conversions.
def Ranger_Mean() -> uint16:
    i: uint16
    sum: uint32 = 0
    for i in range(SAMPLES):
        _Samples[i] = _Convert()
    for i in range(SAMPLES):
        sum += _Samples[i]
    # sum += _Samples[SAMPLES]  # take the first sign away, and run pytest again
    return sum / SAMPLES


# The sensor gives 0.24 V at a metre, and less the farther the wall is; 3 V are 4096.
def Ranger_Distance_Mm() -> uint16:
    code: uint16 = Ranger_Mean()
    if code <= 327680 / FARTHEST_MM:
        return FARTHEST_MM
    return 327680 / code
