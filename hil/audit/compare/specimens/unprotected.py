"""A protected register written without EALLOW."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, AdcaRegs, CpuSysRegs


def run() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR13.bit.ADC_A = 1
    EDIS()
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1  # DEFECT
