"""F2837xS_Device.h: what the device header gives a C file, under the names that C uses.

The register blocks are typed for editors, type checkers and the translator, which resolves `AdcaRegs.ADCCTL1.bit.F`
when an image is linked to a board.  Before that they are placeholders: touching one says so.  EALLOW and EDIS are
statements in C and calls here.  DelayUs and AdcSetMode are the two routines of TI's start-up files that the drivers
declare for themselves.  Sources: HDR (F2837xS_Device.h, F2837xS_Adc_defines.h).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.c28x.language import extern, uint16, void

if TYPE_CHECKING:
    from emulator.registers.adc import AdcRegs, AdcResultRegs
    from emulator.registers.cpu_timer import CpuTimerRegs
    from emulator.registers.epwm import EPwmRegs
    from emulator.registers.eqep import EQepRegs
    from emulator.registers.gpio import GpioCtrlRegs as GpioCtrlBlock
    from emulator.registers.gpio import GpioDataRegs as GpioDataBlock
    from emulator.registers.pie import PieCtrlRegs as PieCtrlBlock
    from emulator.registers.sci import SciRegs
    from emulator.registers.spi import SpiRegs
    from emulator.registers.sysctrl import ClkCfgRegs as ClkCfgBlock
    from emulator.registers.sysctrl import CpuSysRegs as CpuSysBlock
    from emulator.registers.sysctrl import DevCfgRegs as DevCfgBlock
    from emulator.registers.watchdog import WdRegs as WdBlock

AdcaRegs: AdcRegs
AdcaResultRegs: AdcResultRegs
SpiaRegs: SpiRegs
SciaRegs: SciRegs
ScibRegs: SciRegs
ScicRegs: SciRegs
EQep1Regs: EQepRegs
EQep2Regs: EQepRegs
EQep3Regs: EQepRegs
EPwm1Regs: EPwmRegs
EPwm2Regs: EPwmRegs
EPwm3Regs: EPwmRegs
EPwm4Regs: EPwmRegs
EPwm5Regs: EPwmRegs
EPwm6Regs: EPwmRegs
EPwm7Regs: EPwmRegs
EPwm8Regs: EPwmRegs
EPwm9Regs: EPwmRegs
EPwm10Regs: EPwmRegs
EPwm11Regs: EPwmRegs
EPwm12Regs: EPwmRegs
GpioCtrlRegs: GpioCtrlBlock
GpioDataRegs: GpioDataBlock
CpuTimer0Regs: CpuTimerRegs
CpuTimer1Regs: CpuTimerRegs
CpuTimer2Regs: CpuTimerRegs
PieCtrlRegs: PieCtrlBlock
CpuSysRegs: CpuSysBlock
ClkCfgRegs: ClkCfgBlock
DevCfgRegs: DevCfgBlock
WdRegs: WdBlock

# F2837xS_Adc_defines.h
ADC_ADCA = 0
ADC_ADCB = 1
ADC_ADCC = 2
ADC_ADCD = 3
ADC_RESOLUTION_12BIT = 0
ADC_RESOLUTION_16BIT = 1
ADC_SIGNALMODE_SINGLE = 0
ADC_SIGNALMODE_DIFFERENTIAL = 1


@extern
def EALLOW() -> void:
    """Set ST1.EALLOW: protected registers may be written."""


@extern
def EDIS() -> void:
    """Clear ST1.EALLOW; it does not nest."""


@extern
def DelayUs(Usec: uint16) -> void:
    """Busy wait of `Usec` microseconds of executed time."""


@extern
def AdcSetMode(adc: uint16, resolution: uint16, signalmode: uint16) -> void:
    """Set resolution and signal mode of one ADC and load its trims; the caller must hold EALLOW."""


if not TYPE_CHECKING:

    class _Unlinked:
        """Stands for a register block until firmware is linked to a board."""

        __slots__ = ("_name",)

        def __init__(self, name):
            self._name = name

        def __getattr__(self, register):
            raise RuntimeError(f"{self._name}.{register}: firmware does not run unlinked, link it to a board first")

        def __repr__(self):
            return f"<{self._name}, unlinked>"

    for _name in list(__annotations__):
        globals()[_name] = _Unlinked(_name)
