"""DMA registers (0x1000; channel 1 at 0x1020) and the registers that choose its triggers (0x7980).

Offsets and fields: HDR F2837xS_dma.h, F2837xS_sysctrl.h; protection and reset values: TRM, DMA registers and
DMA_CLA_SRC_SEL_REGS.  Only the DMA writes counters and active addresses.
CHOICE: out of reset the wrap sizes are 0xFFFF, so that nothing wraps.  No document at hand gives their reset value.
The manual says that by default addresses do not wrap (wrap size greater than transfer size).  Three of TI's examples
(dma_gsram_transfer, adc_soc_continuous_dma, spi_loopback_dma) never write these registers, and would wrap at every
burst with 0; others write 0xFFFF.
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import R0W1, RW, W1S, At, Block, F, R, Register, RegisterStruct, Word


class MODE(Register, eallow=True):
    """Mode of a channel.  TRM DMA registers; HDR MODE_BITS."""
    CHINTE     = F(15,   RW, 0, "interrupt enable")
    DATASIZE   = F(14,   RW, 0, "0 = 16 bits a transfer, 1 = 32")
    CONTINUOUS = F(11,   RW, 0, "1 = the channel stays on at the end of a transfer")
    ONESHOT    = F(10,   RW, 0, "1 = one trigger carries the whole transfer, 0 = one burst")
    CHINTMODE  = F( 9,   RW, 0, "interrupt at: 0 the beginning of a transfer, 1 its end")
    PERINTE    = F( 8,   RW, 0, "triggers enable")
    OVRINTE    = F( 7,   RW, 0, "an overflow interrupts")
    PERINTSEL  = F(4, 0, RW, 0, "trigger input: the channel's number")


class CONTROL(Register, eallow=True):
    """Control and state of a channel.  TRM DMA registers; HDR CONTROL_BITS."""
    OVRFLG      = F(14, R,    0, "a trigger came while one waited")
    RUNSTS      = F(13, R,    0, "the channel is on")
    BURSTSTS    = F(12, R,    0, "a burst is under way, or held up")
    TRANSFERSTS = F(11, R,    0, "a transfer is under way")
    PERINTFLG   = F( 8, R,    0, "a trigger waits")
    ERRCLR      = F( 7, R0W1, 0, "clear OVRFLG")
    PERINTCLR   = F( 4, R0W1, 0, "clear PERINTFLG")
    PERINTFRC   = F( 3, R0W1, 0, "trigger")
    SOFTRESET   = F( 2, R0W1, 0, "reset of the channel")
    HALT        = F( 1, R0W1, 0, "stop where it is")
    RUN         = F( 0, R0W1, 0, "start, or go on")


class BURST_SIZE(Register, eallow=True):
    """Words a burst, less one.  TRM DMA registers; HDR BURST_SIZE_BITS."""
    BURSTSIZE = F(4, 0, RW, 0, "words of 16 bits a burst, less one")


class BURST_COUNT(Register):
    """Words left.  TRM DMA registers; HDR BURST_COUNT_BITS."""
    BURSTCOUNT = F(4, 0, R, 0, "words left in the burst")


class DmaChannelRegs(Block, struct="CH_REGS"):
    """A DMA channel.  HDR struct CH_REGS."""
    MODE                = At(0x00, MODE)
    CONTROL             = At(0x01, CONTROL)
    BURST_SIZE          = At(0x02, BURST_SIZE)
    BURST_COUNT         = At(0x03, BURST_COUNT)
    SRC_BURST_STEP      = Word(0x04, RW, 0, eallow=True, text="added to the source after each word of a burst")
    DST_BURST_STEP      = Word(0x05, RW, 0, eallow=True, text="added to the destination after each word of a burst")
    TRANSFER_SIZE       = Word(0x06, RW, 0, eallow=True, text="bursts a transfer, less one")
    TRANSFER_COUNT      = Word(0x07, R, 0, text="bursts left in the transfer")
    SRC_TRANSFER_STEP   = Word(0x08, RW, 0, eallow=True, text="added to the source after a burst")
    DST_TRANSFER_STEP   = Word(0x09, RW, 0, eallow=True, text="added to the destination after a burst")
    SRC_WRAP_SIZE       = Word(0x0A, RW, 0xFFFF, eallow=True, text="bursts until the source wraps, less one")
    SRC_WRAP_COUNT      = Word(0x0B, R, 0, text="bursts left until the source wraps")
    SRC_WRAP_STEP       = Word(0x0C, RW, 0, eallow=True, text="added to the source's begin when it wraps")
    DST_WRAP_SIZE       = Word(0x0D, RW, 0xFFFF, eallow=True, text="bursts until the destination wraps, less one")
    DST_WRAP_COUNT      = Word(0x0E, R, 0, text="bursts left until the destination wraps")
    DST_WRAP_STEP       = Word(0x0F, RW, 0, eallow=True, text="added to the destination's begin when it wraps")
    SRC_BEG_ADDR_SHADOW = Word(0x10, RW, 0, 32, eallow=True, text="next begin of the source")
    SRC_ADDR_SHADOW     = Word(0x12, RW, 0, 32, eallow=True, text="next source")
    SRC_BEG_ADDR_ACTIVE = Word(0x14, R, 0, 32, text="begin of the source, where it wraps to")
    SRC_ADDR_ACTIVE     = Word(0x16, R, 0, 32, text="source")
    DST_BEG_ADDR_SHADOW = Word(0x18, RW, 0, 32, eallow=True, text="next begin of the destination")
    DST_ADDR_SHADOW     = Word(0x1A, RW, 0, 32, eallow=True, text="next destination")
    DST_BEG_ADDR_ACTIVE = Word(0x1C, R, 0, 32, text="begin of the destination, where it wraps to")
    DST_ADDR_ACTIVE     = Word(0x1E, R, 0, 32, text="destination")


class DMACTRL(Register, eallow=True):
    """Control of the module.  TRM DMA registers; HDR DMACTRL_BITS."""
    PRIORITYRESET = F(1, R0W1, 0, "the round begins anew")
    HARDRESET     = F(0, R0W1, 0, "reset of the module")


class DEBUGCTRL(Register, eallow=True):
    """Emulation.  TRM DMA registers; HDR DEBUGCTRL_BITS."""
    FREE = F(15, RW, 0, "1 = a debugger's halt does not stop the DMA")


class PRIORITYCTRL1(Register, eallow=True):
    """Priority.  TRM DMA registers; HDR PRIORITYCTRL1_BITS."""
    CH1PRIORITY = F(0, RW, 0, "channel 1 comes before the others")


class PRIORITYSTAT(Register):
    """The channel that is served.  TRM DMA registers; HDR PRIORITYSTAT_BITS."""
    ACTIVESTS_SHADOW = F(6, 4, R, 0, "channel that channel 1 interrupted")
    ACTIVESTS        = F(2, 0, R, 0, "channel that is served; 0 = none")


class DmaRegs(Block, struct="DMA_REGS"):
    """DMA.  HDR struct DMA_REGS."""
    DMACTRL       = At(0x00, DMACTRL)
    DEBUGCTRL     = At(0x01, DEBUGCTRL)
    PRIORITYCTRL1 = At(0x04, PRIORITYCTRL1)
    PRIORITYSTAT  = At(0x06, PRIORITYSTAT)
    CH1           = RegisterStruct(0x20, DmaChannelRegs)
    CH2           = RegisterStruct(0x40, DmaChannelRegs)
    CH3           = RegisterStruct(0x60, DmaChannelRegs)
    CH4           = RegisterStruct(0x80, DmaChannelRegs)
    CH5           = RegisterStruct(0xA0, DmaChannelRegs)
    CH6           = RegisterStruct(0xC0, DmaChannelRegs)


class CLA1TASKSRCSELLOCK(Register, bits=32, eallow=True):
    """Locks.  TRM DMA_CLA_SRC_SEL_REGS; HDR CLA1TASKSRCSELLOCK_BITS."""
    CLA1TASKSRCSEL2 = F(1, W1S, 0, "CLA1TASKSRCSEL2 is locked", modelled=False)
    CLA1TASKSRCSEL1 = F(0, W1S, 0, "CLA1TASKSRCSEL1 is locked", modelled=False)


class DMACHSRCSELLOCK(Register, bits=32, eallow=True):
    """Locks, set until reset.  TRM DMA_CLA_SRC_SEL_REGS; HDR DMACHSRCSELLOCK_BITS."""
    DMACHSRCSEL2 = F(1, W1S, 0, "DMACHSRCSEL2 is locked")
    DMACHSRCSEL1 = F(0, W1S, 0, "DMACHSRCSEL1 is locked")


class CLA1TASKSRCSEL1(Register, bits=32, eallow=True):
    """Triggers of CLA tasks.  TRM DMA_CLA_SRC_SEL_REGS; HDR CLA1TASKSRCSEL1_BITS."""
    TASK4 = F(31, 24, RW, 0, "trigger of task 4", modelled=False)
    TASK3 = F(23, 16, RW, 0, "trigger of task 3", modelled=False)
    TASK2 = F(15,  8, RW, 0, "trigger of task 2", modelled=False)
    TASK1 = F( 7,  0, RW, 0, "trigger of task 1", modelled=False)


class CLA1TASKSRCSEL2(Register, bits=32, eallow=True):
    """Triggers of CLA tasks.  TRM DMA_CLA_SRC_SEL_REGS; HDR CLA1TASKSRCSEL2_BITS."""
    TASK8 = F(31, 24, RW, 0, "trigger of task 8", modelled=False)
    TASK7 = F(23, 16, RW, 0, "trigger of task 7", modelled=False)
    TASK6 = F(15,  8, RW, 0, "trigger of task 6", modelled=False)
    TASK5 = F( 7,  0, RW, 0, "trigger of task 5", modelled=False)


class DMACHSRCSEL1(Register, bits=32, eallow=True):
    """Triggers of DMA channels.  TRM DMA_CLA_SRC_SEL_REGS; HDR DMACHSRCSEL1_BITS."""
    CH4 = F(31, 24, RW, 0, "trigger of channel 4")
    CH3 = F(23, 16, RW, 0, "trigger of channel 3")
    CH2 = F(15,  8, RW, 0, "trigger of channel 2")
    CH1 = F( 7,  0, RW, 0, "trigger of channel 1")


class DMACHSRCSEL2(Register, bits=32, eallow=True):
    """Triggers of DMA channels.  TRM DMA_CLA_SRC_SEL_REGS; HDR DMACHSRCSEL2_BITS."""
    CH6 = F(15, 8, RW, 0, "trigger of channel 6")
    CH5 = F( 7, 0, RW, 0, "trigger of channel 5")


class DmaClaSrcSelRegs(Block, struct="DMA_CLA_SRC_SEL_REGS"):
    """Triggers of DMA channels and CLA tasks.  HDR struct DMA_CLA_SRC_SEL_REGS."""
    CLA1TASKSRCSELLOCK = At(0x00, CLA1TASKSRCSELLOCK)
    DMACHSRCSELLOCK    = At(0x04, DMACHSRCSELLOCK)
    CLA1TASKSRCSEL1    = At(0x06, CLA1TASKSRCSEL1)
    CLA1TASKSRCSEL2    = At(0x08, CLA1TASKSRCSEL2)
    DMACHSRCSEL1       = At(0x16, DMACHSRCSEL1)
    DMACHSRCSEL2       = At(0x18, DMACHSRCSEL2)
