"""System control: CPUSYS 0x5D300, CLKCFG 0x5D200, DEVCFG 0x5D000, ANALOGSUBSYS 0x5D180 (all protected but RESC).

Offsets and fields: HDR F2837xS_sysctrl.h, F2837xS_analogsubsys.h.  Declared is what drivers touch: clock gates, soft
resets, clock dividers, PLL, timer 2 source, trims.  PLL, oscillators, low power and trims are not modelled: SYSCLK is
200 MHz from the first instruction.
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import R0W1, RW, W1C, W1S, At, Block, F, R, Register, Word
from emulator.registers.gpio import pins


class CPUSYSLOCK1(Register, bits=32, eallow=True):
    """Locks of CPUSYS registers, set once until reset.  TRM CPU_SYS_REGS; HDR CPUSYSLOCK1_BITS."""
    GPIOLPMSEL1   = F(23, W1S, 0, "lock GPIOLPMSEL1", modelled=False)
    GPIOLPMSEL0   = F(22, W1S, 0, "lock GPIOLPMSEL0", modelled=False)
    LPMCR         = F(21, W1S, 0, "lock LPMCR", modelled=False)
    SECMSEL       = F(20, W1S, 0, "lock SECMSEL", modelled=False)
    PCLKCR16      = F(19, W1S, 0, "lock PCLKCR16")
    PCLKCR15      = F(18, W1S, 0, "lock PCLKCR15, which this part lacks")
    PCLKCR14      = F(17, W1S, 0, "lock PCLKCR14")
    PCLKCR13      = F(16, W1S, 0, "lock PCLKCR13")
    PCLKCR12      = F(15, W1S, 0, "lock PCLKCR12")
    PCLKCR11      = F(14, W1S, 0, "lock PCLKCR11")
    PCLKCR10      = F(13, W1S, 0, "lock PCLKCR10")
    PCLKCR9       = F(12, W1S, 0, "lock PCLKCR9")
    PCLKCR8       = F(11, W1S, 0, "lock PCLKCR8")
    PCLKCR7       = F(10, W1S, 0, "lock PCLKCR7")
    PCLKCR6       = F( 9, W1S, 0, "lock PCLKCR6")
    PCLKCR5       = F( 8, W1S, 0, "lock PCLKCR5, which this part lacks")
    PCLKCR4       = F( 7, W1S, 0, "lock PCLKCR4")
    PCLKCR3       = F( 6, W1S, 0, "lock PCLKCR3")
    PCLKCR2       = F( 5, W1S, 0, "lock PCLKCR2")
    PCLKCR1       = F( 4, W1S, 0, "lock PCLKCR1")
    PCLKCR0       = F( 3, W1S, 0, "lock PCLKCR0")
    PIEVERRADDR   = F( 2, W1S, 0, "lock PIEVERRADDR", modelled=False)
    IORESTOREADDR = F( 1, W1S, 0, "lock IORESTOREADDR", modelled=False)
    HIBBOOTMODE   = F( 0, W1S, 0, "lock HIBBOOTMODE", modelled=False)


class PCLKCR0(Register, bits=32, eallow=True):
    """Clock gates.  TRM CPU_SYS_REGS; HDR PCLKCR0_BITS."""
    # CHOICE: reset 0x38 (timers running), unconfirmed.
    # GTBCLKSYNC: parts with two CPUs (HDR F2837xD PCLKCR0_BITS)
    GTBCLKSYNC = F(19, RW, 0, "time bases of both CPUs run", modelled=False)
    TBCLKSYNC  = F(18, RW, 0, "time base of all ePWM modules runs")
    HRPWM      = F(16, RW, 0, "HRPWM clock")
    CPUTIMER2  = F( 5, RW, 1, "CPU timer 2 clock")
    CPUTIMER1  = F( 4, RW, 1, "CPU timer 1 clock")
    CPUTIMER0  = F( 3, RW, 1, "CPU timer 0 clock")
    DMA        = F( 2, RW, 0, "DMA clock")
    CLA1       = F( 0, RW, 0, "CLA clock")


class PCLKCR1(Register, bits=32, eallow=True):
    """Clock gates.  TRM CPU_SYS_REGS; HDR PCLKCR1_BITS."""
    EMIF2 = F(1, RW, 0, "EMIF2 clock")
    EMIF1 = F(0, RW, 0, "EMIF1 clock")


class PCLKCR2(Register, bits=32, eallow=True):
    """Clock gates.  TRM CPU_SYS_REGS; HDR PCLKCR2_BITS."""
    EPWM12 = F(11, RW, 0, "ePWM12 clock")
    EPWM11 = F(10, RW, 0, "ePWM11 clock")
    EPWM10 = F( 9, RW, 0, "ePWM10 clock")
    EPWM9  = F( 8, RW, 0, "ePWM9 clock")
    EPWM8  = F( 7, RW, 0, "ePWM8 clock")
    EPWM7  = F( 6, RW, 0, "ePWM7 clock")
    EPWM6  = F( 5, RW, 0, "ePWM6 clock")
    EPWM5  = F( 4, RW, 0, "ePWM5 clock")
    EPWM4  = F( 3, RW, 0, "ePWM4 clock")
    EPWM3  = F( 2, RW, 0, "ePWM3 clock")
    EPWM2  = F( 1, RW, 0, "ePWM2 clock")
    EPWM1  = F( 0, RW, 0, "ePWM1 clock")


class PCLKCR3(Register, bits=32, eallow=True):
    """Clock gates.  TRM CPU_SYS_REGS; HDR PCLKCR3_BITS."""
    ECAP6 = F(5, RW, 0, "eCAP6 clock")
    ECAP5 = F(4, RW, 0, "eCAP5 clock")
    ECAP4 = F(3, RW, 0, "eCAP4 clock")
    ECAP3 = F(2, RW, 0, "eCAP3 clock")
    ECAP2 = F(1, RW, 0, "eCAP2 clock")
    ECAP1 = F(0, RW, 0, "eCAP1 clock")


class PCLKCR4(Register, bits=32, eallow=True):
    """Clock gates.  TRM CPU_SYS_REGS; HDR PCLKCR4_BITS."""
    EQEP3 = F(2, RW, 0, "eQEP3 clock")
    EQEP2 = F(1, RW, 0, "eQEP2 clock")
    EQEP1 = F(0, RW, 0, "eQEP1 clock")


class PCLKCR6(Register, bits=32, eallow=True):
    """Clock gates.  TRM CPU_SYS_REGS; HDR PCLKCR6_BITS."""
    SD2 = F(1, RW, 0, "SDFM2 clock")
    SD1 = F(0, RW, 0, "SDFM1 clock")


class PCLKCR7(Register, bits=32, eallow=True):
    """Clock gates.  TRM CPU_SYS_REGS; HDR PCLKCR7_BITS."""
    SCI_D = F(3, RW, 0, "SCI-D clock")
    SCI_C = F(2, RW, 0, "SCI-C clock")
    SCI_B = F(1, RW, 0, "SCI-B clock")
    SCI_A = F(0, RW, 0, "SCI-A clock")


class PCLKCR8(Register, bits=32, eallow=True):
    """Clock gates.  TRM CPU_SYS_REGS; HDR PCLKCR8_BITS."""
    SPI_C = F(2, RW, 0, "SPI-C clock")
    SPI_B = F(1, RW, 0, "SPI-B clock")
    SPI_A = F(0, RW, 0, "SPI-A clock")


class PCLKCR9(Register, bits=32, eallow=True):
    """Clock gates.  TRM CPU_SYS_REGS; HDR PCLKCR9_BITS."""
    I2C_B = F(1, RW, 0, "I2C-B clock")
    I2C_A = F(0, RW, 0, "I2C-A clock")


class PCLKCR10(Register, bits=32, eallow=True):
    """Clock gates.  TRM CPU_SYS_REGS; HDR PCLKCR10_BITS."""
    CAN_B = F(1, RW, 0, "CAN-B clock")
    CAN_A = F(0, RW, 0, "CAN-A clock")


class PCLKCR11(Register, bits=32, eallow=True):
    """Clock gates.  TRM CPU_SYS_REGS; HDR PCLKCR11_BITS."""
    USB_A   = F(16, RW, 0, "USB-A clock")
    McBSP_B = F( 1, RW, 0, "McBSP-B clock")
    McBSP_A = F( 0, RW, 0, "McBSP-A clock")


class PCLKCR12(Register, bits=32, eallow=True):
    """Clock gates.  TRM CPU_SYS_REGS; HDR PCLKCR12_BITS."""
    uPP_A = F(0, RW, 0, "uPP-A clock")


class PCLKCR13(Register, bits=32, eallow=True):
    """Clock gates.  TRM CPU_SYS_REGS; HDR PCLKCR13_BITS."""
    ADC_D = F(3, RW, 0, "ADC-D clock")
    ADC_C = F(2, RW, 0, "ADC-C clock")
    ADC_B = F(1, RW, 0, "ADC-B clock")
    ADC_A = F(0, RW, 0, "ADC-A clock")


class PCLKCR14(Register, bits=32, eallow=True):
    """Clock gates.  TRM CPU_SYS_REGS; HDR PCLKCR14_BITS."""
    CMPSS8 = F(7, RW, 0, "CMPSS8 clock")
    CMPSS7 = F(6, RW, 0, "CMPSS7 clock")
    CMPSS6 = F(5, RW, 0, "CMPSS6 clock")
    CMPSS5 = F(4, RW, 0, "CMPSS5 clock")
    CMPSS4 = F(3, RW, 0, "CMPSS4 clock")
    CMPSS3 = F(2, RW, 0, "CMPSS3 clock")
    CMPSS2 = F(1, RW, 0, "CMPSS2 clock")
    CMPSS1 = F(0, RW, 0, "CMPSS1 clock")


class PCLKCR16(Register, bits=32, eallow=True):
    """Clock gates.  TRM CPU_SYS_REGS; HDR PCLKCR16_BITS."""
    DAC_C = F(18, RW, 0, "buffered DAC-C clock")
    DAC_B = F(17, RW, 0, "buffered DAC-B clock")
    DAC_A = F(16, RW, 0, "buffered DAC-A clock")


class LPMCR(Register, bits=32, eallow=True):
    """Low-power modes.  TRM CPU_SYS_REGS; HDR LPMCR_BITS."""
    IOISODIS  = F(31,     RW, 0, "I/O isolation off", modelled=False)
    M0M1MODE  = F(17, 16, RW, 0, "M0 and M1 in hibernation", modelled=False)
    WDINTE    = F(15,     RW, 0, "WDINT wakes from STANDBY", modelled=False)
    QUALSTDBY = F( 7,  2, RW, 0, "qualification of the wake-up pin", modelled=False)
    LPM       = F( 1,  0, RW, 0, "mode that IDLE enters", modelled=False)


class TMR2CLKCTL(Register, bits=32, eallow=True):
    """CPU timer 2 clock.  TRM CPU_SYS_REGS; HDR TMR2CLKCTL_BITS."""
    TMR2CLKPRESCALE = F(5, 3, RW, 0, "prescaler of a source other than SYSCLK: /1 to /16")
    TMR2CLKSRCSEL   = F(2, 0, RW, 0, "0 = SYSCLK, 1 = INTOSC1, 2 = INTOSC2, 3 = XTAL, 6 = AUXPLLCLK")


class RESC(Register, bits=32):
    """Reset causes.  TRM CPU_SYS_REGS; HDR RESC_BITS."""
    # CHOICE: not protected: driverlib's SysCtl_clearResetCause and an example of TI's write it without EALLOW.
    # CHOICE: after power-on POR and XRSn are set and the pin reads high (reset word unconfirmed).
    TRSTn_pin_status = F(31, R,   0, "TRSTn pin")
    XRSn_pin_status  = F(30, R,   1, "XRSn pin")
    SCCRESETn        = F( 8, W1C, 0, "reset by the code security module")
    HIBRESETn        = F( 6, W1C, 0, "reset by hibernation")
    HWBISTn          = F( 5, W1C, 0, "reset by the built-in self test")
    NMIWDRSn         = F( 3, W1C, 0, "reset by the NMI watchdog")
    WDRSn            = F( 2, W1C, 0, "reset by the watchdog")
    XRSn             = F( 1, W1C, 1, "reset by the pin")
    POR              = F( 0, W1C, 1, "power-on reset")


class IORESTOREADDR(Register, bits=32, eallow=True):
    """Where the boot ROM goes on after hibernation.  TRM CPU_SYS_REGS; HDR IORESTOREADDR_BITS."""
    ADDR = F(21, 0, RW, 0, "routine that restores the pins", modelled=False)


class PIEVERRADDR(Register, bits=32, eallow=True):
    """Where a fetch of a broken vector goes.  TRM CPU_SYS_REGS; HDR PIEVERRADDR_BITS."""
    ADDR = F(21, 0, RW, 0x3FFFFF, "routine of a vector that does not match its copy", modelled=False)


class SECMSEL(Register, bits=32, eallow=True):
    """Second master of the peripherals' bridges.  TRM CPU_SYS_REGS; HDR SECMSEL_BITS."""
    PF2SEL = F(3, 2, RW, 0, "bridge 2: 0 = CLA, 1 = DMA")
    PF1SEL = F(1, 0, RW, 0, "bridge 1: 0 = CLA, 1 = DMA")


class CpuSysRegs(Block, struct="CPU_SYS_REGS"):
    """CPU system control.  HDR struct CPU_SYS_REGS."""
    CPUSYSLOCK1 = At(0x00, CPUSYSLOCK1)
    HIBBOOTMODE = Word(0x06, RW, 0, bits=32, eallow=True, modelled=False, text="boot after hibernation")
    IORESTOREADDR = At(0x08, IORESTOREADDR)
    PIEVERRADDR = At(0x0A, PIEVERRADDR)
    PCLKCR0     = At(0x22, PCLKCR0)
    PCLKCR1     = At(0x24, PCLKCR1)
    PCLKCR2     = At(0x26, PCLKCR2)
    PCLKCR3     = At(0x28, PCLKCR3)
    PCLKCR4     = At(0x2A, PCLKCR4)
    PCLKCR6     = At(0x2E, PCLKCR6)
    PCLKCR7     = At(0x30, PCLKCR7)
    PCLKCR8     = At(0x32, PCLKCR8)
    PCLKCR9     = At(0x34, PCLKCR9)
    PCLKCR10    = At(0x36, PCLKCR10)
    PCLKCR11    = At(0x38, PCLKCR11)
    PCLKCR12    = At(0x3A, PCLKCR12)
    PCLKCR13    = At(0x3C, PCLKCR13)
    PCLKCR14    = At(0x3E, PCLKCR14)
    PCLKCR16    = At(0x42, PCLKCR16)
    SECMSEL     = At(0x74, SECMSEL)
    LPMCR       = At(0x76, LPMCR)
    GPIOLPMSEL0 = At(0x78, pins(0, 1, RW, 0, "wake-up from HALT and STANDBY", modelled=False))
    GPIOLPMSEL1 = At(0x7A, pins(32, 1, RW, 0, "wake-up from HALT and STANDBY", modelled=False))
    TMR2CLKCTL  = At(0x7C, TMR2CLKCTL)
    RESC        = At(0x80, RESC)


class CLKSRCCTL1(Register, bits=32, eallow=True):
    """Clock source.  TRM CLK_CFG_REGS; HDR CLKSRCCTL1_BITS."""
    WDHALTI      = F(5,    RW, 0, "watchdog runs in HALT", modelled=False)
    XTALOFF      = F(4,    RW, 0, "crystal oscillator off", modelled=False)
    INTOSC2OFF   = F(3,    RW, 0, "internal oscillator 2 off", modelled=False)
    OSCCLKSRCSEL = F(1, 0, RW, 0, "source of OSCCLK: 0 INTOSC2, 1 crystal, 2 INTOSC1")


class CLKSRCCTL2(Register, bits=32, eallow=True):
    """Clock sources of CAN and USB.  TRM CLK_CFG_REGS; HDR CLKSRCCTL2_BITS."""
    CANBBCLKSEL     = F(5, 4, RW, 0, "bit clock of CAN-B: 0 SYSCLK, 1 crystal, 2 AUXCLKIN")
    CANABCLKSEL     = F(3, 2, RW, 0, "bit clock of CAN-A: 0 SYSCLK, 1 crystal, 2 AUXCLKIN")
    AUXOSCCLKSRCSEL = F(1, 0, RW, 0, "source of AUXOSCCLK: 0 INTOSC2, 1 crystal, 2 AUXCLKIN")


class CLKSRCCTL3(Register, bits=32, eallow=True):
    """Clock on a pin.  TRM CLK_CFG_REGS; HDR CLKSRCCTL3_BITS."""
    XCLKOUTSEL = F(2, 0, RW, 0, "source of XCLKOUT", modelled=False)


class SYSPLLCTL1(Register, bits=32, eallow=True):
    """PLL control.  TRM CLK_CFG_REGS; HDR SYSPLLCTL1_BITS."""
    PLLCLKEN = F(1, RW, 0, "PLL drives SYSCLK")
    PLLEN    = F(0, RW, 0, "PLL on")


class SYSPLLMULT(Register, bits=32, eallow=True):
    """PLL multiplier.  TRM CLK_CFG_REGS; HDR SYSPLLMULT_BITS."""
    FMULT = F(9, 8, RW, 0, "fraction, quarters")
    IMULT = F(6, 0, RW, 0, "integer part")


class SYSPLLSTS(Register, bits=32, eallow=True):
    """PLL status.  TRM CLK_CFG_REGS; HDR SYSPLLSTS_BITS."""
    # CHOICE: locked out of reset, as SYSCLK is 200 MHz then; the start-up code that retries (ERR) never needs to.
    SLIPS = F(1, R, 0, "PLL slipped")
    LOCKS = F(0, R, 1, "PLL locked")


class AUXPLLCTL1(Register, bits=32, eallow=True):
    """Second PLL, control.  TRM CLK_CFG_REGS; HDR AUXPLLCTL1_BITS."""
    PLLCLKEN = F(1, RW, 0, "PLL drives AUXPLLCLK")
    PLLEN    = F(0, RW, 0, "PLL on")


class AUXPLLMULT(Register, bits=32, eallow=True):
    """Second PLL, multiplier.  TRM CLK_CFG_REGS; HDR AUXPLLMULT_BITS."""
    FMULT = F(9, 8, RW, 0, "fraction, quarters")
    IMULT = F(6, 0, RW, 0, "integer part")


class AUXPLLSTS(Register, bits=32, eallow=True):
    """Second PLL, status.  TRM CLK_CFG_REGS; HDR AUXPLLSTS_BITS."""
    # CHOICE: always locked, like the first PLL.
    SLIPS = F(1, R, 0, "PLL slipped")
    LOCKS = F(0, R, 1, "PLL locked")


class AUXCLKDIVSEL(Register, bits=32, eallow=True):
    """Second PLL, divider.  TRM CLK_CFG_REGS; HDR AUXCLKDIVSEL_BITS."""
    AUXPLLDIV = F(1, 0, RW, 1, "AUXPLLCLK: 0 = /1, 1 = /2, 2 = /4, 3 = /8")


class XCLKOUTDIVSEL(Register, bits=32, eallow=True):
    """Clock on a pin, divider.  TRM CLK_CFG_REGS; HDR XCLKOUTDIVSEL_BITS."""
    XCLKOUTDIV = F(1, 0, RW, 3, "XCLKOUT: 0 = /1, 1 = /2, 2 = /4, 3 = /8", modelled=False)


class SYSCLKDIVSEL(Register, bits=32, eallow=True):
    """SYSCLK divider.  TRM CLK_CFG_REGS; HDR SYSCLKDIVSEL_BITS."""
    PLLSYSCLKDIV = F(5, 0, RW, 0, "0 = /1, n = /2n")


class PERCLKDIVSEL(Register, bits=32, eallow=True):
    """Peripheral clock dividers.  TRM CLK_CFG_REGS; HDR PERCLKDIVSEL_BITS."""
    # CHOICE: reset word 0x51, unconfirmed; ePWM at SYSCLK/2 is documented.
    EMIF2CLKDIV = F(6,    RW, 1, "EMIF2 clock divider", modelled=False)
    EMIF1CLKDIV = F(4,    RW, 1, "EMIF1 clock divider", modelled=False)
    EPWMCLKDIV  = F(1, 0, RW, 1, "ePWM clock: 0 = /1, 1 = /2")


class LOSPCP(Register, bits=32, eallow=True):
    """Low-speed clock.  TRM CLK_CFG_REGS; HDR LOSPCP_BITS."""
    LSPCLKDIV = F(2, 0, RW, 2, "LSPCLK: 0 = /1, n = /2n")


class CLKCFGLOCK1(Register, bits=32, eallow=True):
    """Locks of the clock configuration.  TRM CLK_CFG_REGS; HDR CLKCFGLOCK1_BITS."""
    LOSPCP       = F(15, W1S, 0, "lock LOSPCP", modelled=False)
    PERCLKDIVSEL = F(13, W1S, 0, "lock PERCLKDIVSEL", modelled=False)
    AUXCLKDIVSEL = F(12, W1S, 0, "lock AUXCLKDIVSEL", modelled=False)
    SYSCLKDIVSEL = F(11, W1S, 0, "lock SYSCLKDIVSEL", modelled=False)
    AUXPLLMULT   = F(10, W1S, 0, "lock AUXPLLMULT", modelled=False)
    AUXPLLCTL1   = F(7, W1S, 0, "lock AUXPLLCTL1", modelled=False)
    SYSPLLMULT   = F(6, W1S, 0, "lock SYSPLLMULT", modelled=False)
    SYSPLLCTL3   = F(5, W1S, 0, "lock SYSPLLCTL3", modelled=False)
    SYSPLLCTL2   = F(4, W1S, 0, "lock SYSPLLCTL2", modelled=False)
    SYSPLLCTL1   = F(3, W1S, 0, "lock SYSPLLCTL1", modelled=False)
    CLKSRCCTL3   = F(2, W1S, 0, "lock CLKSRCCTL3", modelled=False)
    CLKSRCCTL2   = F(1, W1S, 0, "lock CLKSRCCTL2", modelled=False)
    CLKSRCCTL1   = F(0, W1S, 0, "lock CLKSRCCTL1", modelled=False)


class MCDCR(Register, bits=32, eallow=True):
    """Missing clock detection.  TRM CLK_CFG_REGS; HDR MCDCR_BITS."""
    OSCOFF  = F(3, RW, 0, "oscillator off", modelled=False)
    MCLKOFF = F(2, RW, 0, "detection off", modelled=False)
    MCLKCLR = F(1, R0W1, 0, "clear MCLKSTS")
    MCLKSTS = F(0, R, 0, "the clock is missing")


class X1CNT(Register, bits=32, eallow=True):
    """Counter of the crystal's cycles.  TRM CLK_CFG_REGS; HDR X1CNT_BITS."""
    # CHOICE: the crystal has run long enough, so the counter is at its end.
    X1CNT = F(9, 0, R, 0x3FF, "cycles of X1, up to 0x3FF")


class ClkCfgRegs(Block, struct="CLK_CFG_REGS"):
    """Clock configuration.  HDR struct CLK_CFG_REGS."""
    CLKCFGLOCK1   = At(0x02, CLKCFGLOCK1)
    CLKSRCCTL1    = At(0x08, CLKSRCCTL1)
    CLKSRCCTL2    = At(0x0A, CLKSRCCTL2)
    CLKSRCCTL3    = At(0x0C, CLKSRCCTL3)
    SYSPLLCTL1    = At(0x0E, SYSPLLCTL1)
    SYSPLLMULT    = At(0x14, SYSPLLMULT)
    SYSPLLSTS     = At(0x16, SYSPLLSTS)
    AUXPLLCTL1    = At(0x18, AUXPLLCTL1)
    AUXPLLMULT    = At(0x1E, AUXPLLMULT)
    AUXPLLSTS     = At(0x20, AUXPLLSTS)
    SYSCLKDIVSEL  = At(0x22, SYSCLKDIVSEL)
    AUXCLKDIVSEL  = At(0x24, AUXCLKDIVSEL)
    PERCLKDIVSEL  = At(0x26, PERCLKDIVSEL)
    XCLKOUTDIVSEL = At(0x28, XCLKOUTDIVSEL)
    LOSPCP        = At(0x2C, LOSPCP)
    MCDCR         = At(0x2E, MCDCR)
    X1CNT         = At(0x30, X1CNT)


class PARTIDL(Register, bits=32, eallow=True):
    """What part this is, lower half.  TRM DEV_CFG_REGS; HDR PARTIDL_BITS."""
    # CHOICE: a qualified part with all of its pins (337), 1 MB of flash; the words of the parts are in no document.
    PARTID_FORMAT_REVISION = F(31, 28, R, 0, "format of this word")
    FLASH_SIZE             = F(23, 16, R, 7, "7 = 1 MB of flash")
    INSTASPIN              = F(14, 13, R, 3, "3 = without InstaSPIN")
    PIN_COUNT              = F(10,  8, R, 7, "5 = 100 pins, 6 = 176, 7 = 337")
    QUAL                   = F( 7,  6, R, 2, "0 = engineering sample, 1 = pilot, 2 = qualified")


class PARTIDH(Register, bits=32, eallow=True):
    """What part this is, upper half.  TRM DEV_CFG_REGS; HDR PARTIDH_BITS."""
    # CHOICE: 0, as no document gives the words.
    DEVICE_CLASS_ID = F(31, 24, R, 0, "class")
    PARTNO          = F(23, 16, R, 0, "part number")
    FAMILY          = F(15,  8, R, 0, "family")


class SOFTPRES1(Register, bits=32, eallow=True):
    """Software resets.  TRM DEV_CFG_REGS; HDR SOFTPRES1_BITS."""
    EMIF2 = F(1, RW, 0, "reset EMIF2", modelled=False)
    EMIF1 = F(0, RW, 0, "reset EMIF1", modelled=False)


class SYSDBGCTL(Register, bits=32, eallow=True):
    """What only a power-on resets.  TRM DEV_CFG_REGS; HDR SYSDBGCTL_BITS."""
    BIT_0 = F(0, RW, 0, "the start-up code has begun to start the PLL")


class SOFTPRES2(Register, bits=32, eallow=True):
    """Software resets.  TRM DEV_CFG_REGS; HDR SOFTPRES2_BITS."""
    EPWM12 = F(11, RW, 0, "reset ePWM12")
    EPWM11 = F(10, RW, 0, "reset ePWM11")
    EPWM10 = F( 9, RW, 0, "reset ePWM10")
    EPWM9  = F( 8, RW, 0, "reset ePWM9")
    EPWM8  = F( 7, RW, 0, "reset ePWM8")
    EPWM7  = F( 6, RW, 0, "reset ePWM7")
    EPWM6  = F( 5, RW, 0, "reset ePWM6")
    EPWM5  = F( 4, RW, 0, "reset ePWM5")
    EPWM4  = F( 3, RW, 0, "reset ePWM4")
    EPWM3  = F( 2, RW, 0, "reset ePWM3")
    EPWM2  = F( 1, RW, 0, "reset ePWM2")
    EPWM1  = F( 0, RW, 0, "reset ePWM1")


class SOFTPRES4(Register, bits=32, eallow=True):
    """Software resets.  TRM DEV_CFG_REGS; HDR SOFTPRES4_BITS."""
    EQEP3 = F(2, RW, 0, "reset eQEP3")
    EQEP2 = F(1, RW, 0, "reset eQEP2")
    EQEP1 = F(0, RW, 0, "reset eQEP1")


class SOFTPRES7(Register, bits=32, eallow=True):
    """Software resets.  TRM DEV_CFG_REGS; HDR SOFTPRES7_BITS."""
    SCI_D = F(3, RW, 0, "reset SCI-D")
    SCI_C = F(2, RW, 0, "reset SCI-C")
    SCI_B = F(1, RW, 0, "reset SCI-B")
    SCI_A = F(0, RW, 0, "reset SCI-A")


class SOFTPRES8(Register, bits=32, eallow=True):
    """Software resets.  TRM DEV_CFG_REGS; HDR SOFTPRES8_BITS."""
    SPI_C = F(2, RW, 0, "reset SPI-C")
    SPI_B = F(1, RW, 0, "reset SPI-B")
    SPI_A = F(0, RW, 0, "reset SPI-A")


class SOFTPRES13(Register, bits=32, eallow=True):
    """Software resets.  TRM DEV_CFG_REGS; HDR SOFTPRES13_BITS."""
    ADC_D = F(3, RW, 0, "reset ADC-D")
    ADC_C = F(2, RW, 0, "reset ADC-C")
    ADC_B = F(1, RW, 0, "reset ADC-B")
    ADC_A = F(0, RW, 0, "reset ADC-A")


class SOFTPRES16(Register, bits=32, eallow=True):
    """Software resets.  TRM DEV_CFG_REGS; HDR SOFTPRES16_BITS."""
    DAC_C = F(18, RW, 0, "reset DAC-C")
    DAC_B = F(17, RW, 0, "reset DAC-B")
    DAC_A = F(16, RW, 0, "reset DAC-A")


class DC0(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC0_BITS."""
    # CHOICE: an F28377S has all of them.
    SINGLE_CORE = F(0, R, 1, "one core")


class DC1(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC1_BITS."""
    # CHOICE: an F28377S has all of them.
    CPU1_CLA1    = F(6, R, 1, "has the CLA")
    CPU1_VCU     = F(2, R, 1, "has the VCU")
    CPU1_FPU_TMU = F(0, R, 1, "has FPU and TMU")


class DC2(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC2_BITS."""
    # CHOICE: an F28377S has all of them.
    EMIF2 = F(1, R, 1, "has EMIF2")
    EMIF1 = F(0, R, 1, "has EMIF1")


class DC3(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC3_BITS."""
    # CHOICE: an F28377S has all of them.
    EPWM12 = F(11, R, 1, "has EPWM12")
    EPWM11 = F(10, R, 1, "has EPWM11")
    EPWM10 = F(9, R, 1, "has EPWM10")
    EPWM9  = F(8, R, 1, "has EPWM9")
    EPWM8  = F(7, R, 1, "has EPWM8")
    EPWM7  = F(6, R, 1, "has EPWM7")
    EPWM6  = F(5, R, 1, "has EPWM6")
    EPWM5  = F(4, R, 1, "has EPWM5")
    EPWM4  = F(3, R, 1, "has EPWM4")
    EPWM3  = F(2, R, 1, "has EPWM3")
    EPWM2  = F(1, R, 1, "has EPWM2")
    EPWM1  = F(0, R, 1, "has EPWM1")


class DC4(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC4_BITS."""
    # CHOICE: an F28377S has all of them.
    ECAP6 = F(5, R, 1, "has ECAP6")
    ECAP5 = F(4, R, 1, "has ECAP5")
    ECAP4 = F(3, R, 1, "has ECAP4")
    ECAP3 = F(2, R, 1, "has ECAP3")
    ECAP2 = F(1, R, 1, "has ECAP2")
    ECAP1 = F(0, R, 1, "has ECAP1")


class DC5(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC5_BITS."""
    # CHOICE: an F28377S has all of them.
    EQEP3 = F(2, R, 1, "has EQEP3")
    EQEP2 = F(1, R, 1, "has EQEP2")
    EQEP1 = F(0, R, 1, "has EQEP1")


class DC6(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC6_BITS."""
    # CHOICE: an F28377S has all of them.
    CLB4 = F(3, R, 1, "has CLB4")
    CLB3 = F(2, R, 1, "has CLB3")
    CLB2 = F(1, R, 1, "has CLB2")
    CLB1 = F(0, R, 1, "has CLB1")


class DC7(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC7_BITS."""
    # CHOICE: an F28377S has all of them.
    SD2 = F(1, R, 1, "has SD2")
    SD1 = F(0, R, 1, "has SD1")


class DC8(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC8_BITS."""
    # CHOICE: an F28377S has all of them.
    SCI_D = F(3, R, 1, "has SCI-D")
    SCI_C = F(2, R, 1, "has SCI-C")
    SCI_B = F(1, R, 1, "has SCI-B")
    SCI_A = F(0, R, 1, "has SCI-A")


class DC9(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC9_BITS."""
    # CHOICE: an F28377S has all of them.
    SPI_C = F(2, R, 1, "has SPI-C")
    SPI_B = F(1, R, 1, "has SPI-B")
    SPI_A = F(0, R, 1, "has SPI-A")


class DC10(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC10_BITS."""
    # CHOICE: an F28377S has all of them.
    I2C_B = F(1, R, 1, "has I2C-B")
    I2C_A = F(0, R, 1, "has I2C-A")


class DC11(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC11_BITS."""
    # CHOICE: an F28377S has all of them.
    CAN_B = F(1, R, 1, "has CAN-B")
    CAN_A = F(0, R, 1, "has CAN-A")


class DC12(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC12_BITS."""
    # CHOICE: an F28377S has all of them.
    USB_A   = F(17, 16, R, 1, "capability of the USB module")
    McBSP_B = F(1, R, 1, "has McBSP-B")
    McBSP_A = F(0, R, 1, "has McBSP-A")


class DC13(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC13_BITS."""
    # CHOICE: an F28377S has all of them.
    uPP_A = F(0, R, 1, "has uPP-A")


class DC14(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC14_BITS."""
    # CHOICE: an F28377S has all of them.
    ADC_D = F(3, R, 1, "has ADC-D")
    ADC_C = F(2, R, 1, "has ADC-C")
    ADC_B = F(1, R, 1, "has ADC-B")
    ADC_A = F(0, R, 1, "has ADC-A")


class DC15(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC15_BITS."""
    # CHOICE: an F28377S has all of them.
    CMPSS8 = F(7, R, 1, "has CMPSS8")
    CMPSS7 = F(6, R, 1, "has CMPSS7")
    CMPSS6 = F(5, R, 1, "has CMPSS6")
    CMPSS5 = F(4, R, 1, "has CMPSS5")
    CMPSS4 = F(3, R, 1, "has CMPSS4")
    CMPSS3 = F(2, R, 1, "has CMPSS3")
    CMPSS2 = F(1, R, 1, "has CMPSS2")
    CMPSS1 = F(0, R, 1, "has CMPSS1")


class DC17(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC17_BITS."""
    # CHOICE: an F28377S has all of them.
    DAC_C = F(18, R, 1, "has DAC-C")
    DAC_B = F(17, R, 1, "has DAC-B")
    DAC_A = F(16, R, 1, "has DAC-A")


class DC18(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC18_BITS."""
    # CHOICE: an F28377S has all of them.
    LS5_1 = F(5, R, 1, "has RAM LS5")
    LS4_1 = F(4, R, 1, "has RAM LS4")
    LS3_1 = F(3, R, 1, "has RAM LS3")
    LS2_1 = F(2, R, 1, "has RAM LS2")
    LS1_1 = F(1, R, 1, "has RAM LS1")
    LS0_1 = F(0, R, 1, "has RAM LS0")


class DC20(Register, bits=32, eallow=True):
    """Device capability: what this part has.  TRM DEV_CFG_REGS; HDR DC20_BITS."""
    # CHOICE: an F28377S has all of them.
    GS15 = F(15, R, 1, "has RAM GS15")
    GS14 = F(14, R, 1, "has RAM GS14")
    GS13 = F(13, R, 1, "has RAM GS13")
    GS12 = F(12, R, 1, "has RAM GS12")
    GS11 = F(11, R, 1, "has RAM GS11")
    GS10 = F(10, R, 1, "has RAM GS10")
    GS9  = F(9, R, 1, "has RAM GS9")
    GS8  = F(8, R, 1, "has RAM GS8")
    GS7  = F(7, R, 1, "has RAM GS7")
    GS6  = F(6, R, 1, "has RAM GS6")
    GS5  = F(5, R, 1, "has RAM GS5")
    GS4  = F(4, R, 1, "has RAM GS4")
    GS3  = F(3, R, 1, "has RAM GS3")
    GS2  = F(2, R, 1, "has RAM GS2")
    GS1  = F(1, R, 1, "has RAM GS1")
    GS0  = F(0, R, 1, "has RAM GS0")


class PERCNF1(Register, bits=32, eallow=True):
    """Peripheral configuration.  TRM DEV_CFG_REGS; HDR PERCNF1_BITS."""
    USB_A_PHY  = F(16, R, 0, "USB_A_PHY")
    ADC_D_MODE = F(3, R, 0, "ADC_D mode setting bit")
    ADC_C_MODE = F(2, R, 0, "ADC_C mode setting bit")
    ADC_B_MODE = F(1, R, 0, "ADC_B mode setting bit")
    ADC_A_MODE = F(0, R, 0, "ADC_A mode setting bit")


class FUSEERR(Register, bits=32, eallow=True):
    """Fuse errors.  TRM DEV_CFG_REGS; HDR FUSEERR_BITS."""
    ERR   = F(5, R, 0, "self test error")
    ALERR = F(4, 0, R, 0, "autoload error")


class SOFTPRES0(Register, bits=32, eallow=True):
    """Software resets.  TRM DEV_CFG_REGS; HDR SOFTPRES0_BITS."""
    CPU1_CLA1 = F(0, RW, 0, "reset the CLA")


class SOFTPRES3(Register, bits=32, eallow=True):
    """Software resets.  TRM DEV_CFG_REGS; HDR SOFTPRES3_BITS."""
    ECAP6 = F(5, RW, 0, "reset ECAP6")
    ECAP5 = F(4, RW, 0, "reset ECAP5")
    ECAP4 = F(3, RW, 0, "reset ECAP4")
    ECAP3 = F(2, RW, 0, "reset ECAP3")
    ECAP2 = F(1, RW, 0, "reset ECAP2")
    ECAP1 = F(0, RW, 0, "reset ECAP1")


class SOFTPRES6(Register, bits=32, eallow=True):
    """Software resets.  TRM DEV_CFG_REGS; HDR SOFTPRES6_BITS."""
    SD2 = F(1, RW, 0, "reset SD2")
    SD1 = F(0, RW, 0, "reset SD1")


class SOFTPRES9(Register, bits=32, eallow=True):
    """Software resets.  TRM DEV_CFG_REGS; HDR SOFTPRES9_BITS."""
    I2C_B = F(1, RW, 0, "reset I2C-B")
    I2C_A = F(0, RW, 0, "reset I2C-A")


class SOFTPRES11(Register, bits=32, eallow=True):
    """Software resets.  TRM DEV_CFG_REGS; HDR SOFTPRES11_BITS."""
    USB_A   = F(16, RW, 0, "reset USB-A")
    McBSP_B = F(1, RW, 0, "reset McBSP-B")
    McBSP_A = F(0, RW, 0, "reset McBSP-A")


class SOFTPRES14(Register, bits=32, eallow=True):
    """Software resets.  TRM DEV_CFG_REGS; HDR SOFTPRES14_BITS."""
    CMPSS8 = F(7, RW, 0, "reset CMPSS8")
    CMPSS7 = F(6, RW, 0, "reset CMPSS7")
    CMPSS6 = F(5, RW, 0, "reset CMPSS6")
    CMPSS5 = F(4, RW, 0, "reset CMPSS5")
    CMPSS4 = F(3, RW, 0, "reset CMPSS4")
    CMPSS3 = F(2, RW, 0, "reset CMPSS3")
    CMPSS2 = F(1, RW, 0, "reset CMPSS2")
    CMPSS1 = F(0, RW, 0, "reset CMPSS1")


class CPUSEL0(Register, bits=32, eallow=True):
    """Owners of peripherals on parts with two CPUs.  TRM DEV_CFG_REGS; HDR F2837xD CPUSEL0_BITS."""
    EPWM12 = F(11, RW, 0, "EPWM12 belongs to CPU2", modelled=False)
    EPWM11 = F(10, RW, 0, "EPWM11 belongs to CPU2", modelled=False)
    EPWM10 = F(9, RW, 0, "EPWM10 belongs to CPU2", modelled=False)
    EPWM9  = F(8, RW, 0, "EPWM9 belongs to CPU2", modelled=False)
    EPWM8  = F(7, RW, 0, "EPWM8 belongs to CPU2", modelled=False)
    EPWM7  = F(6, RW, 0, "EPWM7 belongs to CPU2", modelled=False)
    EPWM6  = F(5, RW, 0, "EPWM6 belongs to CPU2", modelled=False)
    EPWM5  = F(4, RW, 0, "EPWM5 belongs to CPU2", modelled=False)
    EPWM4  = F(3, RW, 0, "EPWM4 belongs to CPU2", modelled=False)
    EPWM3  = F(2, RW, 0, "EPWM3 belongs to CPU2", modelled=False)
    EPWM2  = F(1, RW, 0, "EPWM2 belongs to CPU2", modelled=False)
    EPWM1  = F(0, RW, 0, "EPWM1 belongs to CPU2", modelled=False)


class CPUSEL1(Register, bits=32, eallow=True):
    """Owners of peripherals on parts with two CPUs.  TRM DEV_CFG_REGS; HDR F2837xD CPUSEL1_BITS."""
    ECAP6 = F(5, RW, 0, "ECAP6 belongs to CPU2", modelled=False)
    ECAP5 = F(4, RW, 0, "ECAP5 belongs to CPU2", modelled=False)
    ECAP4 = F(3, RW, 0, "ECAP4 belongs to CPU2", modelled=False)
    ECAP3 = F(2, RW, 0, "ECAP3 belongs to CPU2", modelled=False)
    ECAP2 = F(1, RW, 0, "ECAP2 belongs to CPU2", modelled=False)
    ECAP1 = F(0, RW, 0, "ECAP1 belongs to CPU2", modelled=False)


class CPUSEL2(Register, bits=32, eallow=True):
    """Owners of peripherals on parts with two CPUs.  TRM DEV_CFG_REGS; HDR F2837xD CPUSEL2_BITS."""
    EQEP3 = F(2, RW, 0, "EQEP3 belongs to CPU2", modelled=False)
    EQEP2 = F(1, RW, 0, "EQEP2 belongs to CPU2", modelled=False)
    EQEP1 = F(0, RW, 0, "EQEP1 belongs to CPU2", modelled=False)


class CPUSEL4(Register, bits=32, eallow=True):
    """Owners of peripherals on parts with two CPUs.  TRM DEV_CFG_REGS; HDR F2837xD CPUSEL4_BITS."""
    SD2 = F(1, RW, 0, "SD2 belongs to CPU2", modelled=False)
    SD1 = F(0, RW, 0, "SD1 belongs to CPU2", modelled=False)


class CPUSEL5(Register, bits=32, eallow=True):
    """Owners of peripherals on parts with two CPUs.  TRM DEV_CFG_REGS; HDR F2837xD CPUSEL5_BITS."""
    SCI_D = F(3, RW, 0, "SCI_D belongs to CPU2", modelled=False)
    SCI_C = F(2, RW, 0, "SCI_C belongs to CPU2", modelled=False)
    SCI_B = F(1, RW, 0, "SCI_B belongs to CPU2", modelled=False)
    SCI_A = F(0, RW, 0, "SCI_A belongs to CPU2", modelled=False)


class CPUSEL6(Register, bits=32, eallow=True):
    """Owners of peripherals on parts with two CPUs.  TRM DEV_CFG_REGS; HDR F2837xD CPUSEL6_BITS."""
    SPI_C = F(2, RW, 0, "SPI_C belongs to CPU2", modelled=False)
    SPI_B = F(1, RW, 0, "SPI_B belongs to CPU2", modelled=False)
    SPI_A = F(0, RW, 0, "SPI_A belongs to CPU2", modelled=False)


class CPUSEL7(Register, bits=32, eallow=True):
    """Owners of peripherals on parts with two CPUs.  TRM DEV_CFG_REGS; HDR F2837xD CPUSEL7_BITS."""
    I2C_B = F(1, RW, 0, "I2C_B belongs to CPU2", modelled=False)
    I2C_A = F(0, RW, 0, "I2C_A belongs to CPU2", modelled=False)


class CPUSEL8(Register, bits=32, eallow=True):
    """Owners of peripherals on parts with two CPUs.  TRM DEV_CFG_REGS; HDR F2837xD CPUSEL8_BITS."""
    CAN_B = F(1, RW, 0, "CAN_B belongs to CPU2", modelled=False)
    CAN_A = F(0, RW, 0, "CAN_A belongs to CPU2", modelled=False)


class CPUSEL9(Register, bits=32, eallow=True):
    """Owners of peripherals on parts with two CPUs.  TRM DEV_CFG_REGS; HDR F2837xD CPUSEL9_BITS."""
    McBSP_B = F(1, RW, 0, "McBSP_B belongs to CPU2", modelled=False)
    McBSP_A = F(0, RW, 0, "McBSP_A belongs to CPU2", modelled=False)


class CPUSEL11(Register, bits=32, eallow=True):
    """Owners of peripherals on parts with two CPUs.  TRM DEV_CFG_REGS; HDR F2837xD CPUSEL11_BITS."""
    ADC_D = F(3, RW, 0, "ADC_D belongs to CPU2", modelled=False)
    ADC_C = F(2, RW, 0, "ADC_C belongs to CPU2", modelled=False)
    ADC_B = F(1, RW, 0, "ADC_B belongs to CPU2", modelled=False)
    ADC_A = F(0, RW, 0, "ADC_A belongs to CPU2", modelled=False)


class CPUSEL12(Register, bits=32, eallow=True):
    """Owners of peripherals on parts with two CPUs.  TRM DEV_CFG_REGS; HDR F2837xD CPUSEL12_BITS."""
    CMPSS8 = F(7, RW, 0, "CMPSS8 belongs to CPU2", modelled=False)
    CMPSS7 = F(6, RW, 0, "CMPSS7 belongs to CPU2", modelled=False)
    CMPSS6 = F(5, RW, 0, "CMPSS6 belongs to CPU2", modelled=False)
    CMPSS5 = F(4, RW, 0, "CMPSS5 belongs to CPU2", modelled=False)
    CMPSS4 = F(3, RW, 0, "CMPSS4 belongs to CPU2", modelled=False)
    CMPSS3 = F(2, RW, 0, "CMPSS3 belongs to CPU2", modelled=False)
    CMPSS2 = F(1, RW, 0, "CMPSS2 belongs to CPU2", modelled=False)
    CMPSS1 = F(0, RW, 0, "CMPSS1 belongs to CPU2", modelled=False)


class CPUSEL14(Register, bits=32, eallow=True):
    """Owners of peripherals on parts with two CPUs.  TRM DEV_CFG_REGS; HDR F2837xD CPUSEL14_BITS."""
    DAC_C = F(18, RW, 0, "DAC_C belongs to CPU2", modelled=False)
    DAC_B = F(17, RW, 0, "DAC_B belongs to CPU2", modelled=False)
    DAC_A = F(16, RW, 0, "DAC_A belongs to CPU2", modelled=False)


class DevCfgRegs(Block, struct="DEV_CFG_REGS"):
    """Device configuration: what part this is, and software resets.  HDR struct DEV_CFG_REGS.

    CPUSELx exist on parts with two CPUs only (F2837xD), whose programs for CPU1 run here too.
    """
    PARTIDL    = At(0x08, PARTIDL)
    PARTIDH    = At(0x0A, PARTIDH)
    # CHOICE: revision C, the last one that TI's sources ask for.
    REVID      = Word(0x0C, R, 3, bits=32, eallow=True, text="silicon revision")
    DC0        = At(0x10, DC0)
    DC1        = At(0x12, DC1)
    DC2        = At(0x14, DC2)
    DC3        = At(0x16, DC3)
    DC4        = At(0x18, DC4)
    DC5        = At(0x1A, DC5)
    DC6        = At(0x1C, DC6)
    DC7        = At(0x1E, DC7)
    DC8        = At(0x20, DC8)
    DC9        = At(0x22, DC9)
    DC10       = At(0x24, DC10)
    DC11       = At(0x26, DC11)
    DC12       = At(0x28, DC12)
    DC13       = At(0x2A, DC13)
    DC14       = At(0x2C, DC14)
    DC15       = At(0x2E, DC15)
    DC17       = At(0x32, DC17)
    DC18       = At(0x34, DC18)
    DC20       = At(0x38, DC20)
    PERCNF1    = At(0x60, PERCNF1)
    FUSEERR    = At(0x74, FUSEERR)
    SOFTPRES0  = At(0x82, SOFTPRES0)
    SOFTPRES1  = At(0x84, SOFTPRES1)
    SOFTPRES2  = At(0x86, SOFTPRES2)
    SOFTPRES3  = At(0x88, SOFTPRES3)
    SOFTPRES4  = At(0x8A, SOFTPRES4)
    SOFTPRES6  = At(0x8E, SOFTPRES6)
    SOFTPRES7  = At(0x90, SOFTPRES7)
    SOFTPRES8  = At(0x92, SOFTPRES8)
    SOFTPRES9  = At(0x94, SOFTPRES9)
    SOFTPRES11 = At(0x98, SOFTPRES11)
    SOFTPRES13 = At(0x9C, SOFTPRES13)
    SOFTPRES14 = At(0x9E, SOFTPRES14)
    SOFTPRES16 = At(0xA2, SOFTPRES16)
    CPUSEL0    = At(0xD6, CPUSEL0)
    CPUSEL1    = At(0xD8, CPUSEL1)
    CPUSEL2    = At(0xDA, CPUSEL2)
    CPUSEL4    = At(0xDE, CPUSEL4)
    CPUSEL5    = At(0xE0, CPUSEL5)
    CPUSEL6    = At(0xE2, CPUSEL6)
    CPUSEL7    = At(0xE4, CPUSEL7)
    CPUSEL8    = At(0xE6, CPUSEL8)
    CPUSEL9    = At(0xE8, CPUSEL9)
    CPUSEL11   = At(0xEC, CPUSEL11)
    CPUSEL12   = At(0xEE, CPUSEL12)
    CPUSEL14   = At(0xF2, CPUSEL14)
    SYSDBGCTL  = At(0x12C, SYSDBGCTL)


class TSNSCTL(Register, eallow=True):
    """Temperature sensor.  TRM ANALOG_SUBSYS_REGS; HDR TSNSCTL_BITS."""
    ENABLE = F(0, RW, 0, "temperature sensor on")


class ANAREFTRIMx(Register, bits=32, eallow=True):
    """Reference trim.  TRM ANALOG_SUBSYS_REGS; HDR ANAREFTRIMA_BITS."""
    # CHOICE: a calibrated part: 31709, the word that TI's start-up code writes where it finds 0.
    IREFTRIM    = F(15, 11, RW, 15, "reference current", modelled=False)
    BGSLOPETRIM = F(10,  6, RW, 15, "bandgap slope", modelled=False)
    BGVALTRIM   = F( 5,  0, RW, 29, "bandgap value", modelled=False)


class INTOSC1TRIM(Register, bits=32, eallow=True):
    """Oscillator trim.  TRM ANALOG_SUBSYS_REGS; HDR INTOSC1TRIM_BITS."""
    VALFINETRIM = F(11, 0, RW, 0, "fine trim", modelled=False)


class INTOSC2TRIM(Register, bits=32, eallow=True):
    """Oscillator trim.  TRM ANALOG_SUBSYS_REGS; HDR INTOSC2TRIM_BITS."""
    VALFINETRIM = F(11, 0, RW, 0, "fine trim", modelled=False)


class LOCK(Register, bits=32, eallow=True):
    """Locks.  TRM ANALOG_SUBSYS_REGS; HDR LOCK_BITS."""
    ANAREFTRIMD = F(26, W1S, 0, "lock ANAREFTRIMD", modelled=False)
    ANAREFTRIMC = F(25, W1S, 0, "lock ANAREFTRIMC", modelled=False)
    ANAREFTRIMB = F(24, W1S, 0, "lock ANAREFTRIMB", modelled=False)
    ANAREFTRIMA = F(23, W1S, 0, "lock ANAREFTRIMA", modelled=False)
    TSNSCTL     = F(3, W1S, 0, "lock TSNSCTL", modelled=False)


class AnalogSubsysRegs(Block, struct="ANALOG_SUBSYS_REGS"):
    """Analog subsystem.  HDR struct ANALOG_SUBSYS_REGS."""
    INTOSC1TRIM = At(0x20, INTOSC1TRIM)
    INTOSC2TRIM = At(0x22, INTOSC2TRIM)
    TSNSCTL     = At(0x26, TSNSCTL)
    LOCK        = At(0x2E, LOCK)
    ANAREFTRIMA = At(0x36, ANAREFTRIMx)
    ANAREFTRIMB = At(0x38, ANAREFTRIMx)
    ANAREFTRIMC = At(0x3A, ANAREFTRIMx)
    ANAREFTRIMD = At(0x3C, ANAREFTRIMx)
