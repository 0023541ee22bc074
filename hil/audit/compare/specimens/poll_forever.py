"""A wait for a conversion that nobody started."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, AdcaRegs, CpuSysRegs


def run() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR13.bit.ADC_A = 1
    EDIS()
    while AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0:  # DEFECT
        pass
