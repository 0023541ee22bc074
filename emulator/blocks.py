"""Every register block of the chip, one line per block: name in C, address, registers, clock gate, interrupts.

All code that needs the list of blocks reads this table.  `chip.py` creates the registers, connects clock gates, soft
resets and interrupts, and does the wiring that only some blocks need.  `device_h.py` gives the names to firmware.  The
C headers are generated from it.  `registers/instance.py` describes the fields of a line.
Sources: DS memory map and PIE channel table; HDR (names of blocks; F2837xS_sysctrl.h: what gates and resets them).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from emulator.peripherals.cpu_timer import CpuTimer
from emulator.registers import (
    adc,
    can,
    cmpss,
    cpu_timer,
    dac,
    dma,
    ecap,
    epwm,
    epwm_xbar,
    eqep,
    flash,
    gpio,
    i2c,
    input_xbar,
    output_xbar,
    pie,
    pie_vectors,
    sci,
    spi,
    sysctrl,
    watchdog,
    xbar,
    xint,
)
from emulator.registers.instance import Instance, at

if TYPE_CHECKING:
    from emulator.c28x.language import unmodelled

# Blocks that are modelled

# `pie`: ADCINT1 to 4, the event of the PPBs
AdcaRegs = at(
    0x7400, adc.AdcRegs, gate="PCLKCR13.ADC_A", reset="SOFTPRES13.ADC_A",
    pie=[(1, 1), (10, 2), (10, 3), (10, 4), (10, 1)],
)
AdcbRegs = at(
    0x7480, adc.AdcRegs, gate="PCLKCR13.ADC_B", reset="SOFTPRES13.ADC_B",
    pie=[(1, 2), (10, 6), (10, 7), (10, 8), (10, 5)],
)
AdccRegs = at(
    0x7500, adc.AdcRegs, gate="PCLKCR13.ADC_C", reset="SOFTPRES13.ADC_C",
    pie=[(1, 3), (10, 10), (10, 11), (10, 12), (10, 9)],
)
AdcdRegs = at(
    0x7580, adc.AdcRegs, gate="PCLKCR13.ADC_D", reset="SOFTPRES13.ADC_D",
    pie=[(1, 6), (10, 14), (10, 15), (10, 16), (10, 13)],
)
AdcaResultRegs = at(0x0B00, adc.AdcResultRegs, gate="PCLKCR13.ADC_A")
AdcbResultRegs = at(0x0B20, adc.AdcResultRegs, gate="PCLKCR13.ADC_B")
AdccResultRegs = at(0x0B40, adc.AdcResultRegs, gate="PCLKCR13.ADC_C")
AdcdResultRegs = at(0x0B60, adc.AdcResultRegs, gate="PCLKCR13.ADC_D")
DacaRegs = at(0x5C00, dac.DacRegs, gate="PCLKCR16.DAC_A", reset="SOFTPRES16.DAC_A")
DacbRegs = at(0x5C10, dac.DacRegs, gate="PCLKCR16.DAC_B", reset="SOFTPRES16.DAC_B")
DaccRegs = at(0x5C20, dac.DacRegs, gate="PCLKCR16.DAC_C", reset="SOFTPRES16.DAC_C")
Cmpss1Regs = at(0x5C80, cmpss.CmpssRegs, gate="PCLKCR14.CMPSS1", reset="SOFTPRES14.CMPSS1")
Cmpss2Regs = at(0x5CA0, cmpss.CmpssRegs, gate="PCLKCR14.CMPSS2", reset="SOFTPRES14.CMPSS2")
Cmpss3Regs = at(0x5CC0, cmpss.CmpssRegs, gate="PCLKCR14.CMPSS3", reset="SOFTPRES14.CMPSS3")
Cmpss4Regs = at(0x5CE0, cmpss.CmpssRegs, gate="PCLKCR14.CMPSS4", reset="SOFTPRES14.CMPSS4")
Cmpss5Regs = at(0x5D00, cmpss.CmpssRegs, gate="PCLKCR14.CMPSS5", reset="SOFTPRES14.CMPSS5")
Cmpss6Regs = at(0x5D20, cmpss.CmpssRegs, gate="PCLKCR14.CMPSS6", reset="SOFTPRES14.CMPSS6")
Cmpss7Regs = at(0x5D40, cmpss.CmpssRegs, gate="PCLKCR14.CMPSS7", reset="SOFTPRES14.CMPSS7")
Cmpss8Regs = at(0x5D60, cmpss.CmpssRegs, gate="PCLKCR14.CMPSS8", reset="SOFTPRES14.CMPSS8")
# `pie` of serial modules: receiver, transmitter; of the I2C its basic interrupt, that of the FIFOs
SpiaRegs = at(0x6100, spi.SpiRegs, gate="PCLKCR8.SPI_A", reset="SOFTPRES8.SPI_A", pie=[(6, 1), (6, 2)])
SpibRegs = at(0x6110, spi.SpiRegs, gate="PCLKCR8.SPI_B", reset="SOFTPRES8.SPI_B", pie=[(6, 3), (6, 4)])
SpicRegs = at(0x6120, spi.SpiRegs, gate="PCLKCR8.SPI_C", reset="SOFTPRES8.SPI_C", pie=[(6, 9), (6, 10)])
I2caRegs = at(0x7300, i2c.I2cRegs, gate="PCLKCR9.I2C_A", reset="SOFTPRES9.I2C_A", pie=[(8, 1), (8, 2)])
I2cbRegs = at(0x7340, i2c.I2cRegs, gate="PCLKCR9.I2C_B", reset="SOFTPRES9.I2C_B", pie=[(8, 3), (8, 4)])
SciaRegs = at(0x7200, sci.SciRegs, gate="PCLKCR7.SCI_A", reset="SOFTPRES7.SCI_A", pie=[(9, 1), (9, 2)])
ScibRegs = at(0x7210, sci.SciRegs, gate="PCLKCR7.SCI_B", reset="SOFTPRES7.SCI_B", pie=[(9, 3), (9, 4)])
ScicRegs = at(0x7220, sci.SciRegs, gate="PCLKCR7.SCI_C", reset="SOFTPRES7.SCI_C", pie=[(8, 5), (8, 6)])
ScidRegs = at(0x7230, sci.SciRegs, gate="PCLKCR7.SCI_D", reset="SOFTPRES7.SCI_D", pie=[(8, 7), (8, 8)])
# `pie`: lines 0 and 1
CanaRegs = at(0x48000, can.CanRegs, gate="PCLKCR10.CAN_A", pie=[(9, 5), (9, 6)])
CanbRegs = at(0x4A000, can.CanRegs, gate="PCLKCR10.CAN_B", pie=[(9, 7), (9, 8)])

DmaRegs = at(0x1000, dma.DmaRegs, gate="PCLKCR0.DMA", pie=[(7, 1), (7, 2), (7, 3), (7, 4), (7, 5), (7, 6)])
DmaClaSrcSelRegs = at(0x7980, dma.DmaClaSrcSelRegs)
CpuTimer0Regs = at(0x0C00, cpu_timer.CpuTimerRegs, CpuTimer, gate="PCLKCR0.CPUTIMER0", pie=[(1, 7)], trigsel=1)
CpuTimer1Regs = at(0x0C08, cpu_timer.CpuTimerRegs, CpuTimer, gate="PCLKCR0.CPUTIMER1", line=13, trigsel=2)
CpuTimer2Regs = at(0x0C10, cpu_timer.CpuTimerRegs, CpuTimer, gate="PCLKCR0.CPUTIMER2", line=14, trigsel=3)
EQep1Regs = at(0x5100, eqep.EQepRegs, gate="PCLKCR4.EQEP1", reset="SOFTPRES4.EQEP1", pie=[(5, 1)])
EQep2Regs = at(0x5140, eqep.EQepRegs, gate="PCLKCR4.EQEP2", reset="SOFTPRES4.EQEP2", pie=[(5, 2)])
EQep3Regs = at(0x5180, eqep.EQepRegs, gate="PCLKCR4.EQEP3", reset="SOFTPRES4.EQEP3", pie=[(5, 3)])
ECap1Regs = at(0x5000, ecap.ECapRegs, gate="PCLKCR3.ECAP1", reset="SOFTPRES3.ECAP1", pie=[(4, 1)])
ECap2Regs = at(0x5020, ecap.ECapRegs, gate="PCLKCR3.ECAP2", reset="SOFTPRES3.ECAP2", pie=[(4, 2)])
ECap3Regs = at(0x5040, ecap.ECapRegs, gate="PCLKCR3.ECAP3", reset="SOFTPRES3.ECAP3", pie=[(4, 3)])
ECap4Regs = at(0x5060, ecap.ECapRegs, gate="PCLKCR3.ECAP4", reset="SOFTPRES3.ECAP4", pie=[(4, 4)])
ECap5Regs = at(0x5080, ecap.ECapRegs, gate="PCLKCR3.ECAP5", reset="SOFTPRES3.ECAP5", pie=[(4, 5)])
ECap6Regs = at(0x50A0, ecap.ECapRegs, gate="PCLKCR3.ECAP6", reset="SOFTPRES3.ECAP6", pie=[(4, 6)])
# `pie`: EPWMxINT, EPWMxTZINT
EPwm1Regs = at(0x4000, epwm.EPwmRegs, gate="PCLKCR2.EPWM1", reset="SOFTPRES2.EPWM1", pie=[(3, 1), (2, 1)])
EPwm2Regs = at(0x4100, epwm.EPwmRegs, gate="PCLKCR2.EPWM2", reset="SOFTPRES2.EPWM2", pie=[(3, 2), (2, 2)])
EPwm3Regs = at(0x4200, epwm.EPwmRegs, gate="PCLKCR2.EPWM3", reset="SOFTPRES2.EPWM3", pie=[(3, 3), (2, 3)])
EPwm4Regs = at(0x4300, epwm.EPwmRegs, gate="PCLKCR2.EPWM4", reset="SOFTPRES2.EPWM4", pie=[(3, 4), (2, 4)])
EPwm5Regs = at(0x4400, epwm.EPwmRegs, gate="PCLKCR2.EPWM5", reset="SOFTPRES2.EPWM5", pie=[(3, 5), (2, 5)])
EPwm6Regs = at(0x4500, epwm.EPwmRegs, gate="PCLKCR2.EPWM6", reset="SOFTPRES2.EPWM6", pie=[(3, 6), (2, 6)])
EPwm7Regs = at(0x4600, epwm.EPwmRegs, gate="PCLKCR2.EPWM7", reset="SOFTPRES2.EPWM7", pie=[(3, 7), (2, 7)])
EPwm8Regs = at(0x4700, epwm.EPwmRegs, gate="PCLKCR2.EPWM8", reset="SOFTPRES2.EPWM8", pie=[(3, 8), (2, 8)])
EPwm9Regs = at(0x4800, epwm.EPwmRegs, gate="PCLKCR2.EPWM9", reset="SOFTPRES2.EPWM9", pie=[(3, 9), (2, 9)])
EPwm10Regs = at(0x4900, epwm.EPwmRegs, gate="PCLKCR2.EPWM10", reset="SOFTPRES2.EPWM10", pie=[(3, 10), (2, 10)])
EPwm11Regs = at(0x4A00, epwm.EPwmRegs, gate="PCLKCR2.EPWM11", reset="SOFTPRES2.EPWM11", pie=[(3, 11), (2, 11)])
EPwm12Regs = at(0x4B00, epwm.EPwmRegs, gate="PCLKCR2.EPWM12", reset="SOFTPRES2.EPWM12", pie=[(3, 12), (2, 12)])

GpioCtrlRegs = at(0x7C00, gpio.GpioCtrlRegs)
GpioDataRegs = at(0x7F00, gpio.GpioDataRegs)
InputXbarRegs = at(0x7900, input_xbar.InputXbarRegs)
XbarRegs = at(0x7920, xbar.XbarRegs)
EPwmXbarRegs = at(0x7A00, epwm_xbar.EPwmXbarRegs)
OutputXbarRegs = at(0x7A80, output_xbar.OutputXbarRegs)
XintRegs = at(0x7070, xint.XintRegs, pie=[(1, 4), (1, 5), (12, 1), (12, 2), (12, 3)])
PieCtrlRegs = at(0x0CE0, pie.PieCtrlRegs)
PieVectTable = at(0x0D00, pie_vectors.PieVectTable)
WdRegs = at(0x7000, watchdog.WdRegs, pie=[(1, 8)])
CpuSysRegs = at(0x5D300, sysctrl.CpuSysRegs)
ClkCfgRegs = at(0x5D200, sysctrl.ClkCfgRegs)
DevCfgRegs = at(0x5D000, sysctrl.DevCfgRegs)
AnalogSubsysRegs = at(0x5D180, sysctrl.AnalogSubsysRegs)
Flash0CtrlRegs = at(0x5F800, flash.FlashCtrlRegs)
Flash0EccRegs = at(0x5FB00, flash.FlashEccRegs)
Flash1CtrlRegs = at(0x5FC00, flash.FlashCtrlRegs)
Flash1EccRegs = at(0x5FF00, flash.FlashEccRegs)
FlashPumpSemaphoreRegs = at(0x50024, flash.FlashPumpSemaphoreRegs)

# Blocks that the chip has and the emulator does not model.  IpcRegs: parts with two CPUs, whose programs for CPU1 run
# here too (HDR F2837xD_ipc.h).

AccessProtectionRegs: unmodelled
Cla1Regs: unmodelled
Cla1SoftIntRegs: unmodelled
Clb1DataExchRegs: unmodelled
Clb1LogicCfgRegs: unmodelled
Clb1LogicCtrlRegs: unmodelled
Clb2DataExchRegs: unmodelled
Clb2LogicCfgRegs: unmodelled
Clb2LogicCtrlRegs: unmodelled
Clb3DataExchRegs: unmodelled
Clb3LogicCfgRegs: unmodelled
Clb3LogicCtrlRegs: unmodelled
Clb4DataExchRegs: unmodelled
Clb4LogicCfgRegs: unmodelled
Clb4LogicCtrlRegs: unmodelled
ClbXbarRegs: unmodelled
DcsmCommonRegs: unmodelled
DcsmZ1Otp: unmodelled
DcsmZ1Regs: unmodelled
DcsmZ2Otp: unmodelled
DcsmZ2Regs: unmodelled
Emif1ConfigRegs: unmodelled
Emif1Regs: unmodelled
Emif2ConfigRegs: unmodelled
Emif2Regs: unmodelled
IpcRegs: unmodelled
McbspaRegs: unmodelled
McbspbRegs: unmodelled
MemCfgRegs: unmodelled
MemoryErrorRegs: unmodelled
NmiIntruptRegs: unmodelled
RomPrefetchRegs: unmodelled
RomWaitStateRegs: unmodelled
Sdfm1Regs: unmodelled
Sdfm2Regs: unmodelled
SyncSocRegs: unmodelled
UidRegs: unmodelled
UppRegs: unmodelled

#: The modelled blocks by their names in C.
BLOCKS: Final[dict[str, Instance]] = {
    name: found for name, found in list(globals().items()) if isinstance(found, Instance)
}
#: The names of those that are not.
UNMODELLED: Final = tuple(name for name, kind in __annotations__.items() if kind == "unmodelled")
#: Where what is not modelled lies, for programs that reach it by a number (driverlib): first and last address (DS,
#: "Peripheral Registers Memory Map" and "EMIF Chip Select Memory Map").
UNMODELLED_AT: Final = {
    "Cla1Regs": (0x1400, 0x147F), "Clb1 to Clb4": (0x3000, 0x3FFF), "Sdfm1Regs": (0x5E00, 0x5E7F),
    "Sdfm2Regs": (0x5E80, 0x5EFF), "McbspaRegs": (0x6000, 0x603F), "McbspbRegs": (0x6040, 0x607F),
    "UppRegs": (0x6200, 0x62FF), "the message RAM of the uPP": (0x6C00, 0x6FFF), "NmiIntruptRegs": (0x7060, 0x706F),
    "SyncSocRegs": (0x7940, 0x794F), "UsbaRegs": (0x40000, 0x40FFF), "Emif1Regs": (0x47000, 0x477FF),
    "Emif2Regs": (0x47800, 0x47FFF), "IpcRegs": (0x50000, 0x50023), "memory at the EMIF2": (0x2000, 0x2FFF),
    "memory at the EMIF1": (0x100000, 0x3DFFFF),
}
