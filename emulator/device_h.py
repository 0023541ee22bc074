"""F2837xS_Device.h: the contents of the device header, under the names that C uses.

The register blocks are those of `blocks.py`, typed for editors and type checkers.  The translator resolves
`AdcaRegs.ADCCTL1.bit.F` when an image is linked to a board.  Before that they are placeholders, and touching one raises
an error that says so.  EALLOW, EDIS, EINT, DINT, ERTM and DRTM are statements in C and calls here.  The functions are
those of TI's start-up files that drivers call; `device_functions.py` implements them.  A routine in `PieVectTable`
counts as declared `interrupt`.
Sources: HDR (F2837xS_Device.h, F2837xS_Adc_defines.h, F2837xS_Gpio_defines.h, F2837xS_GlobalPrototypes.h,
F2837xS_CpuTimers.h).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.c28x.language import cregister, extern, float32, int16, int32, ptr, uint16, uint32, void

if TYPE_CHECKING:
    from emulator.blocks import *  # noqa: F403 - the register blocks

# Core registers, and their bits
IER: cregister[uint16]
IFR: cregister[uint16]
M_INT1 = 0x0001
M_INT2 = 0x0002
M_INT3 = 0x0004
M_INT4 = 0x0008
M_INT5 = 0x0010
M_INT6 = 0x0020
M_INT7 = 0x0040
M_INT8 = 0x0080
M_INT9 = 0x0100
M_INT10 = 0x0200
M_INT11 = 0x0400
M_INT12 = 0x0800
M_INT13 = 0x1000
M_INT14 = 0x2000

# F2837xS_PieCtrl.h: what PIEACK is written with
PIEACK_GROUP1 = 0x0001
PIEACK_GROUP2 = 0x0002
PIEACK_GROUP3 = 0x0004
PIEACK_GROUP4 = 0x0008
PIEACK_GROUP5 = 0x0010
PIEACK_GROUP6 = 0x0020
PIEACK_GROUP7 = 0x0040
PIEACK_GROUP8 = 0x0080
PIEACK_GROUP9 = 0x0100
PIEACK_GROUP10 = 0x0200
PIEACK_GROUP11 = 0x0400
PIEACK_GROUP12 = 0x0800

# F2837xS_Gpio_defines.h
GPIO_MUX_CPU1 = 0
GPIO_MUX_CPU1CLA = 1
# Parts with two CPUs (HDR F2837xD_Gpio_defines.h)
GPIO_MUX_CPU2 = 2
GPIO_MUX_CPU2CLA = 3
GPIO_INPUT = 0
GPIO_OUTPUT = 1
GPIO_PUSHPULL = 0
GPIO_PULLUP = 1 << 0
GPIO_INVERT = 1 << 1
GPIO_OPENDRAIN = 1 << 2
GPIO_SYNC = 0 << 4
GPIO_QUAL3 = 1 << 4
GPIO_QUAL6 = 2 << 4
GPIO_ASYNC = 3 << 4

# F2837xS_CpuTimers.h: what ConfigCpuTimer takes (the address of a structure in C, the timer's number here)
CpuTimer0 = 0
CpuTimer1 = 1
CpuTimer2 = 2

# F2837xS_Adc_defines.h
ADC_ADCA = 0
ADC_ADCB = 1
ADC_ADCC = 2
ADC_ADCD = 3
ADC_RESOLUTION_12BIT = 0
ADC_RESOLUTION_16BIT = 1
ADC_SIGNALMODE_SINGLE = 0
ADC_SIGNALMODE_DIFFERENTIAL = 1

# What a channel of the DMA reads and writes
WordPointer = ptr[uint16]  # type: ignore[type-arg]
DoubleWordPointer = ptr[uint32]  # type: ignore[type-arg]


@extern
def EALLOW() -> void:
    """Set ST1.EALLOW: the program can write protected registers."""
@extern
def EDIS() -> void:
    """Clear ST1.EALLOW.  EALLOW and EDIS do not nest."""
@extern
def EINT() -> void:
    """Clear ST1.INTM: the CPU takes interrupts."""
@extern
def DINT() -> void:
    """Set ST1.INTM: interrupts stay pending."""
@extern
def ERTM() -> void:
    """Clear ST1.DBGM, which only a debugger uses."""
@extern
def DRTM() -> void:
    """Set ST1.DBGM, which only a debugger uses."""
@extern
def DelayUs(Usec: uint16) -> void:
    """Busy-wait for `Usec` microseconds of executed time."""
@extern
def DELAY_US(A: float32) -> void:
    """Busy-wait for `A` microseconds of executed time."""
@extern
def F28x_usDelay(LoopCount: int32) -> void:
    """Busy-wait for 5 * `LoopCount` + 9 cycles; in C, `DELAY_US` computes `LoopCount`."""
@extern
def InitSysCtrl() -> void:
    """Switch the watchdog off, set up the PLL, and switch the clock of every module on."""
@extern
def InitPeripheralClocks() -> void:
    """Switch the clock of every module on."""
@extern
def DisablePeripheralClocks() -> void:
    """Switch the clock of every module off."""
@extern
def InitSysPll(clock_source: uint16, imult: uint16, fmult: uint16, divsel: uint16) -> void:
    """Lock the PLL five times and measure SYSCLK, unless the PLL is set up so already; ends in EDIS."""
@extern
def SysIntOsc1Sel() -> void:
    """Select INTOSC1 as the source of the PLL."""
@extern
def SysIntOsc2Sel() -> void:
    """Select INTOSC2 as the source of the PLL."""
@extern
def SysXtalOscSel() -> void:
    """Select the crystal as the source of the PLL."""
@extern
def ConfigureTMXAnalogTrim() -> void:
    """Do nothing: no trim is missing."""
@extern
def SetDBGIER(dbgier: uint16) -> void:
    """Do nothing: no debugger stops the CPU."""
@extern
def IDLE() -> void:
    """Wait for an interrupt that IER lets through."""
@extern
def STANDBY() -> void:
    """Not modelled: the CPU continues."""
@extern
def HALT() -> void:
    """Not modelled: the CPU continues."""
@extern
def HIB() -> void:
    """Not modelled: the CPU continues."""
@extern
def FlashOff() -> void:
    """Put pump and bank 0 to sleep; the registers only keep it here.  Ends in EDIS."""
@extern
def FlashOff_Bank0() -> void:
    """Put pump and bank 0 to sleep; the registers only keep it here.  Ends in EDIS."""
@extern
def FlashOff_Bank1() -> void:
    """Put pump and bank 1 to sleep; the registers only keep it here.  Ends in EDIS."""
@extern
def ServiceDog() -> void:
    """Service the watchdog; ends in EDIS."""
@extern
def DisableDog() -> void:
    """Switch the watchdog off; ends in EDIS."""
@extern
def EnableInterrupts() -> void:
    """Enable the PIE, acknowledge all groups, and execute EINT."""
@extern
def SysCtl_delay(count: uint32) -> void:
    """Busy-wait for 5 * `count` + 9 cycles; driverlib has it in assembler."""
@extern
def InitFlash() -> void:
    """Set wait states, cache, prefetch and ECC of bank 0; the registers only keep them here.  Ends in EDIS."""
@extern
def InitFlash_Bank0() -> void:
    """Set wait states, cache, prefetch and ECC of bank 0; the registers only keep them here.  Ends in EDIS."""
@extern
def InitFlash_Bank1() -> void:
    """Set wait states, cache, prefetch and ECC of bank 1; the registers only keep them here.  Ends in EDIS."""
@extern
def SeizeFlashPump() -> void:
    """Do nothing: no other CPU uses the flash."""
@extern
def SeizeFlashPump_Bank0() -> void:
    """Do nothing: no other CPU uses the flash."""
@extern
def SeizeFlashPump_Bank1() -> void:
    """Do nothing: no other CPU uses the flash."""
@extern
def ReleaseFlashPump() -> void:
    """Do nothing: no other CPU uses the flash."""
@extern
def GPIO_EnableUnbondedIOPullups() -> void:
    """Do nothing: every pin is bonded here."""
@extern
def InitPieCtrl() -> void:
    """Execute DINT, disable the PIE, and clear all its enables and flags."""
@extern
def InitPieVectTable() -> void:
    """Write a default routine to every vector, and enable the PIE."""
@extern
def GPIO_EnableUnbondedIOPullupsFor100Pin() -> void:
    """Do nothing: every pin is bonded here."""
@extern
def GPIO_SetupLock(gpioNumber: uint16, flags: uint16) -> void:
    """Lock (1) or unlock (0) the configuration of a pin; ends in EDIS."""
@extern
def InitGpio() -> void:
    """Make all pins GPIO inputs, and clear all latches."""
@extern
def GPIO_SetupPinMux(gpioNumber: uint16, cpu: uint16, muxPosition: uint16) -> void:
    """Set function and owner of a pin; ends in EDIS."""
@extern
def GPIO_SetupPinOptions(gpioNumber: uint16, output: uint16, flags: uint16) -> void:
    """Set direction, pull-up and the other options of a pin; ends in EDIS."""
@extern
def GPIO_WritePin(gpioNumber: uint16, outVal: uint16) -> void:
    """Set (1) or clear (0) the latch of a pin."""
@extern
def GPIO_ReadPin(gpioNumber: uint16) -> uint16:  # type: ignore[empty-body]
    """Return the level of a pin."""
@extern
def InitEPwm1Gpio() -> void:
    """Set up the pins of ePWM1: GPIO0 and GPIO1; ends in EDIS."""
@extern
def InitEPwm2Gpio() -> void:
    """Set up the pins of ePWM2: GPIO2 and GPIO3; ends in EDIS."""
@extern
def InitEPwm3Gpio() -> void:
    """Set up the pins of ePWM3: GPIO4 and GPIO5; ends in EDIS."""
@extern
def InitEPwm4Gpio() -> void:
    """Set up the pins of ePWM4: GPIO6 and GPIO7; ends in EDIS."""
@extern
def InitEPwm5Gpio() -> void:
    """Set up the pins of ePWM5: GPIO8 and GPIO9; ends in EDIS."""
@extern
def InitEPwm6Gpio() -> void:
    """Set up the pins of ePWM6: GPIO10 and GPIO11; ends in EDIS."""
@extern
def InitEPwm7Gpio() -> void:
    """Set up the pins of ePWM7: GPIO12 and GPIO13; ends in EDIS."""
@extern
def InitEPwm8Gpio() -> void:
    """Set up the pins of ePWM8: GPIO14 and GPIO15; ends in EDIS."""
@extern
def InitEPwm9Gpio() -> void:
    """Set up the pins of ePWM9: GPIO16 and GPIO17; ends in EDIS."""
@extern
def InitEPwm10Gpio() -> void:
    """Set up the pins of ePWM10: GPIO18 and GPIO19; ends in EDIS."""
@extern
def InitEPwm11Gpio() -> void:
    """Set up the pins of ePWM11: GPIO20 and GPIO21; ends in EDIS."""
@extern
def InitEPwm12Gpio() -> void:
    """Set up the pins of ePWM12: GPIO22 and GPIO23; ends in EDIS."""
@extern
def InitEPwmGpio() -> void:
    """Set up the pins of all ePWM modules."""
@extern
def InitECap() -> void:
    """Do nothing."""
@extern
def InitECapGpio() -> void:
    """Do nothing."""
@extern
def InitECap1Gpio(pin: uint16) -> void:
    """Set up the pin of eCAP1 through INPUT7 of the Input X-BAR; ends in EDIS."""
@extern
def InitECap2Gpio(pin: uint16) -> void:
    """Set up the pin of eCAP2 through INPUT8 of the Input X-BAR; ends in EDIS."""
@extern
def InitECap3Gpio(pin: uint16) -> void:
    """Set up the pin of eCAP3 through INPUT9 of the Input X-BAR; ends in EDIS."""
@extern
def InitECap4Gpio(pin: uint16) -> void:
    """Set up the pin of eCAP4 through INPUT10 of the Input X-BAR; ends in EDIS."""
@extern
def InitECap5Gpio(pin: uint16) -> void:
    """Set up the pin of eCAP5 through INPUT11 of the Input X-BAR; ends in EDIS."""
@extern
def InitECap6Gpio(pin: uint16) -> void:
    """Set up the pin of eCAP6 through INPUT12 of the Input X-BAR; ends in EDIS."""
@extern
def InitEQep1Gpio() -> void:
    """Set up the pins of eQEP1: GPIO20 to 23; ends in EDIS."""
@extern
def InitEQep2Gpio() -> void:
    """Set up the pins of eQEP2: GPIO24 to 27; ends in EDIS."""
@extern
def InitEQep3Gpio() -> void:
    """Set up the pins of eQEP3: GPIO28 to 31; ends in EDIS."""
@extern
def InitEQepGpio() -> void:
    """Set up the pins of all eQEP modules."""
@extern
def InitAPwm1Gpio() -> void:
    """Route the PWM of eCAP1 to GPIO5, through OUTPUTXBAR3; ends in EDIS."""
@extern
def InitSpiaGpio() -> void:
    """Set up the pins of SPI-A: GPIO16 to 19; ends in EDIS."""
@extern
def InitSpi() -> void:
    """Set up SPI-A in loopback, as a master of 16-bit words at 500 kHz."""
@extern
def InitSpiGpio() -> void:
    """Set up the pins of SPI-A, as `InitSpiaGpio` does; ends in EDIS."""
@extern
def GPIO_SetupXINT1Gpio(pin: uint16) -> void:
    """Set up the pin of XINT1; ends in EDIS."""
@extern
def GPIO_SetupXINT2Gpio(pin: uint16) -> void:
    """Set up the pin of XINT2; ends in EDIS."""
@extern
def GPIO_SetupXINT3Gpio(pin: uint16) -> void:
    """Set up the pin of XINT3; ends in EDIS."""
@extern
def GPIO_SetupXINT4Gpio(pin: uint16) -> void:
    """Set up the pin of XINT4; ends in EDIS."""
@extern
def GPIO_SetupXINT5Gpio(pin: uint16) -> void:
    """Set up the pin of XINT5; ends in EDIS."""
@extern
def InitCpuTimers() -> void:
    """Stop all CPU timers, and set the longest period."""
@extern
def ConfigCpuTimer(Timer: uint16, Freq: float32, Period: float32) -> void:
    """Stop a timer, set a period of `Period` us at `Freq` MHz, and enable its interrupt."""
@extern
def StartCpuTimer0() -> void:
    """Start the timer."""
@extern
def StartCpuTimer1() -> void:
    """Start the timer."""
@extern
def StartCpuTimer2() -> void:
    """Start the timer."""
@extern
def StopCpuTimer0() -> void:
    """Stop the timer."""
@extern
def StopCpuTimer1() -> void:
    """Stop the timer."""
@extern
def StopCpuTimer2() -> void:
    """Stop the timer."""
@extern
def ReloadCpuTimer0() -> void:
    """Reload the period."""
@extern
def ReloadCpuTimer1() -> void:
    """Reload the period."""
@extern
def ReloadCpuTimer2() -> void:
    """Reload the period."""
@extern
def InitTempSensor(vrefhi_voltage: float32) -> void:
    """Switch the temperature sensor on and wait 1 ms; the argument is the ADC reference in volts.  Ends in EDIS."""
@extern
def GetTemperatureC(sensorSample: int16) -> int16:  # type: ignore[empty-body]
    """Convert a 12-bit result to degrees Celsius."""
@extern
def GetTemperatureK(sensorSample: int16) -> int16:  # type: ignore[empty-body]
    """Convert a 12-bit result to Kelvin."""
@extern
def AdcSetMode(adc: uint16, resolution: uint16, signalmode: uint16) -> void:
    """Set resolution and signal mode of one ADC and load its trims; the caller must hold EALLOW."""
@extern
def InitCAN() -> void:
    """Stop and reset CAN-A, and make all its message objects invalid."""
@extern
def DMAInitialize() -> void:
    """Reset the DMA; ends in EDIS."""
@extern
def DMACH1AddrConfig(DMA_Dest: WordPointer, DMA_Source: WordPointer) -> void:
    """Set where channel 1 writes and reads; ends in EDIS."""
@extern
def DMACH1AddrConfig32bit(DMA_Dest: DoubleWordPointer, DMA_Source: DoubleWordPointer) -> void:
    """Set where channel 1 writes and reads; ends in EDIS."""
@extern
def DMACH1BurstConfig(bsize: uint16, srcbstep: int16, desbstep: int16) -> void:
    """Set the words of a burst, less one, and the steps from word to word; ends in EDIS."""
@extern
def DMACH1TransferConfig(tsize: uint16, srctstep: int16, deststep: int16) -> void:
    """Set the bursts of a transfer, less one, and the steps from burst to burst; ends in EDIS."""
@extern
def DMACH1WrapConfig(srcwsize: uint16, srcwstep: int16, deswsize: uint16, deswstep: int16) -> void:
    """Set after how many bursts, less one, the addresses wrap, and the steps of their begin; ends in EDIS."""
@extern
def DMACH1ModeConfig(
    persel: uint16, perinte: uint16, oneshot: uint16, cont: uint16, synce: uint16, syncsel: uint16, ovrinte: uint16,
    datasize: uint16, chintmode: uint16, chinte: uint16,
) -> void:  # fmt: skip
    """Set trigger and mode of channel 1; ends in EDIS."""
@extern
def StartDMACH1() -> void:
    """Start channel 1, which then waits for its trigger; ends in EDIS."""
@extern
def DMACH2AddrConfig(DMA_Dest: WordPointer, DMA_Source: WordPointer) -> void:
    """Set where channel 2 writes and reads; ends in EDIS."""
@extern
def DMACH2AddrConfig32bit(DMA_Dest: DoubleWordPointer, DMA_Source: DoubleWordPointer) -> void:
    """Set where channel 2 writes and reads; ends in EDIS."""
@extern
def DMACH2BurstConfig(bsize: uint16, srcbstep: int16, desbstep: int16) -> void:
    """Set the words of a burst, less one, and the steps from word to word; ends in EDIS."""
@extern
def DMACH2TransferConfig(tsize: uint16, srctstep: int16, deststep: int16) -> void:
    """Set the bursts of a transfer, less one, and the steps from burst to burst; ends in EDIS."""
@extern
def DMACH2WrapConfig(srcwsize: uint16, srcwstep: int16, deswsize: uint16, deswstep: int16) -> void:
    """Set after how many bursts, less one, the addresses wrap, and the steps of their begin; ends in EDIS."""
@extern
def DMACH2ModeConfig(
    persel: uint16, perinte: uint16, oneshot: uint16, cont: uint16, synce: uint16, syncsel: uint16, ovrinte: uint16,
    datasize: uint16, chintmode: uint16, chinte: uint16,
) -> void:  # fmt: skip
    """Set trigger and mode of channel 2; ends in EDIS."""
@extern
def StartDMACH2() -> void:
    """Start channel 2, which then waits for its trigger; ends in EDIS."""
@extern
def DMACH3AddrConfig(DMA_Dest: WordPointer, DMA_Source: WordPointer) -> void:
    """Set where channel 3 writes and reads; ends in EDIS."""
@extern
def DMACH3AddrConfig32bit(DMA_Dest: DoubleWordPointer, DMA_Source: DoubleWordPointer) -> void:
    """Set where channel 3 writes and reads; ends in EDIS."""
@extern
def DMACH3BurstConfig(bsize: uint16, srcbstep: int16, desbstep: int16) -> void:
    """Set the words of a burst, less one, and the steps from word to word; ends in EDIS."""
@extern
def DMACH3TransferConfig(tsize: uint16, srctstep: int16, deststep: int16) -> void:
    """Set the bursts of a transfer, less one, and the steps from burst to burst; ends in EDIS."""
@extern
def DMACH3WrapConfig(srcwsize: uint16, srcwstep: int16, deswsize: uint16, deswstep: int16) -> void:
    """Set after how many bursts, less one, the addresses wrap, and the steps of their begin; ends in EDIS."""
@extern
def DMACH3ModeConfig(
    persel: uint16, perinte: uint16, oneshot: uint16, cont: uint16, synce: uint16, syncsel: uint16, ovrinte: uint16,
    datasize: uint16, chintmode: uint16, chinte: uint16,
) -> void:  # fmt: skip
    """Set trigger and mode of channel 3; ends in EDIS."""
@extern
def StartDMACH3() -> void:
    """Start channel 3, which then waits for its trigger; ends in EDIS."""
@extern
def DMACH4AddrConfig(DMA_Dest: WordPointer, DMA_Source: WordPointer) -> void:
    """Set where channel 4 writes and reads; ends in EDIS."""
@extern
def DMACH4AddrConfig32bit(DMA_Dest: DoubleWordPointer, DMA_Source: DoubleWordPointer) -> void:
    """Set where channel 4 writes and reads; ends in EDIS."""
@extern
def DMACH4BurstConfig(bsize: uint16, srcbstep: int16, desbstep: int16) -> void:
    """Set the words of a burst, less one, and the steps from word to word; ends in EDIS."""
@extern
def DMACH4TransferConfig(tsize: uint16, srctstep: int16, deststep: int16) -> void:
    """Set the bursts of a transfer, less one, and the steps from burst to burst; ends in EDIS."""
@extern
def DMACH4WrapConfig(srcwsize: uint16, srcwstep: int16, deswsize: uint16, deswstep: int16) -> void:
    """Set after how many bursts, less one, the addresses wrap, and the steps of their begin; ends in EDIS."""
@extern
def DMACH4ModeConfig(
    persel: uint16, perinte: uint16, oneshot: uint16, cont: uint16, synce: uint16, syncsel: uint16, ovrinte: uint16,
    datasize: uint16, chintmode: uint16, chinte: uint16,
) -> void:  # fmt: skip
    """Set trigger and mode of channel 4; ends in EDIS."""
@extern
def StartDMACH4() -> void:
    """Start channel 4, which then waits for its trigger; ends in EDIS."""
@extern
def DMACH5AddrConfig(DMA_Dest: WordPointer, DMA_Source: WordPointer) -> void:
    """Set where channel 5 writes and reads; ends in EDIS."""
@extern
def DMACH5AddrConfig32bit(DMA_Dest: DoubleWordPointer, DMA_Source: DoubleWordPointer) -> void:
    """Set where channel 5 writes and reads; ends in EDIS."""
@extern
def DMACH5BurstConfig(bsize: uint16, srcbstep: int16, desbstep: int16) -> void:
    """Set the words of a burst, less one, and the steps from word to word; ends in EDIS."""
@extern
def DMACH5TransferConfig(tsize: uint16, srctstep: int16, deststep: int16) -> void:
    """Set the bursts of a transfer, less one, and the steps from burst to burst; ends in EDIS."""
@extern
def DMACH5WrapConfig(srcwsize: uint16, srcwstep: int16, deswsize: uint16, deswstep: int16) -> void:
    """Set after how many bursts, less one, the addresses wrap, and the steps of their begin; ends in EDIS."""
@extern
def DMACH5ModeConfig(
    persel: uint16, perinte: uint16, oneshot: uint16, cont: uint16, synce: uint16, syncsel: uint16, ovrinte: uint16,
    datasize: uint16, chintmode: uint16, chinte: uint16,
) -> void:  # fmt: skip
    """Set trigger and mode of channel 5; ends in EDIS."""
@extern
def StartDMACH5() -> void:
    """Start channel 5, which then waits for its trigger; ends in EDIS."""
@extern
def DMACH6AddrConfig(DMA_Dest: WordPointer, DMA_Source: WordPointer) -> void:
    """Set where channel 6 writes and reads; ends in EDIS."""
@extern
def DMACH6AddrConfig32bit(DMA_Dest: DoubleWordPointer, DMA_Source: DoubleWordPointer) -> void:
    """Set where channel 6 writes and reads; ends in EDIS."""
@extern
def DMACH6BurstConfig(bsize: uint16, srcbstep: int16, desbstep: int16) -> void:
    """Set the words of a burst, less one, and the steps from word to word; ends in EDIS."""
@extern
def DMACH6TransferConfig(tsize: uint16, srctstep: int16, deststep: int16) -> void:
    """Set the bursts of a transfer, less one, and the steps from burst to burst; ends in EDIS."""
@extern
def DMACH6WrapConfig(srcwsize: uint16, srcwstep: int16, deswsize: uint16, deswstep: int16) -> void:
    """Set after how many bursts, less one, the addresses wrap, and the steps of their begin; ends in EDIS."""
@extern
def DMACH6ModeConfig(
    persel: uint16, perinte: uint16, oneshot: uint16, cont: uint16, synce: uint16, syncsel: uint16, ovrinte: uint16,
    datasize: uint16, chintmode: uint16, chinte: uint16,
) -> void:  # fmt: skip
    """Set trigger and mode of channel 6; ends in EDIS."""
@extern
def StartDMACH6() -> void:
    """Start channel 6, which then waits for its trigger; ends in EDIS."""


if not TYPE_CHECKING:

    class _Unlinked:
        """A placeholder for a register block until firmware is linked to a board."""

        __slots__ = ("_name",)

        def __init__(self, name):
            self._name = name

        def __getattr__(self, register):
            raise RuntimeError(f"{self._name}.{register}: firmware does not run unlinked, link it to a board first")

        def __repr__(self):
            return f"<{self._name}, unlinked>"

    from emulator import blocks as _blocks

    for _name in (*_blocks.BLOCKS, *_blocks.UNMODELLED, *__annotations__):
        globals()[_name] = _Unlinked(_name)
