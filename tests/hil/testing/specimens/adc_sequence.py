"""adc_sequence.c: three channels in one go, the end of the last one on ADCINT2; results kept in a structure."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, AdcaRegs, AdcaResultRegs, CpuSysRegs, DelayUs


class SCAN(struct):
    left: uint16
    front: uint16
    right: uint16
    count: uint16


Last: SCAN = (0, 0, 0, 0)


# adc_sequence.c: Init_Scan
def Init_Scan() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR13.bit.ADC_A = 1
    AdcaRegs.ADCCTL2.all = 0x0006
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1
    DelayUs(600)
    AdcaRegs.ADCSOC0CTL.bit.CHSEL = 2
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 14
    AdcaRegs.ADCSOC1CTL.bit.CHSEL = 3
    AdcaRegs.ADCSOC1CTL.bit.ACQPS = 14
    AdcaRegs.ADCSOC2CTL.bit.CHSEL = 4
    AdcaRegs.ADCSOC2CTL.bit.ACQPS = 14
    AdcaRegs.ADCINTSEL1N2.bit.INT2SEL = 2
    AdcaRegs.ADCINTSEL1N2.bit.INT2E = 1
    EDIS()


# adc_sequence.c: Scan
def Scan(result: ptr[SCAN]) -> int16:
    timeout: uint16 = 1000
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT2 = 1
    AdcaRegs.ADCSOCFRC1.all = 0x0007
    while AdcaRegs.ADCINTFLG.bit.ADCINT2 == 0 and timeout > 0:
        timeout -= 1
    if timeout == 0:
        return 0
    result.left = AdcaResultRegs.ADCRESULT0
    result.front = AdcaResultRegs.ADCRESULT1
    result.right = AdcaResultRegs.ADCRESULT2
    result.count += 1
    return 1


# adc_sequence.c: Nearest
def Nearest() -> uint16:
    least: uint16
    if not Scan(addressof(Last)):
        return 0xFFFF
    least = Last.left
    if Last.front < least:
        least = Last.front
    if Last.right < least:
        least = Last.right
    return least
