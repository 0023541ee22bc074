"""Flash controller, its error correction, and the semaphore of its pump: registers that hold what is written.

Not modelled: the effect of all of them.  The flash has no wait states here, is ready from the first instruction, and
has no errors.
Offsets and fields: HDR F2837xS_flash.h.
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import R0W1, RW, At, Block, F, R, Register, W, Word


class FRDCNTL(Register, bits=32, eallow=True):
    """FRDCNTL of FLASH_CTRL_REGS.  HDR FRDCNTL_BITS."""
    RWAIT = F(11, 8, RW, 0, "random read waitstate")


class FBAC(Register, bits=32, eallow=True):
    """FBAC of FLASH_CTRL_REGS.  HDR FBAC_BITS."""
    VREADST = F(7, 0, RW, 0, "VREAD setup time count")


class FBFALLBACK(Register, bits=32, eallow=True):
    """FBFALLBACK of FLASH_CTRL_REGS.  HDR FBFALLBACK_BITS."""
    BNKPWR0 = F(1, 0, RW, 0, "bank power mode")


class FBPRDY(Register, bits=32, eallow=True):
    """FBPRDY of FLASH_CTRL_REGS.  HDR FBPRDY_BITS."""
    # CHOICE: bank and pump are ready.
    PUMPRDY = F(15, R, 1, "flash pump active power mode")
    BANKRDY = F(0, R, 1, "flash bank active power state")


class FPAC1(Register, bits=32, eallow=True):
    """FPAC1 of FLASH_CTRL_REGS.  HDR FPAC1_BITS."""
    PSLEEP = F(27, 16, RW, 0, "pump sleep down count")
    PMPPWR = F(0, RW, 0, "charge pump fallback power mode")


class FMSTAT(Register, bits=32, eallow=True):
    """FMSTAT of FLASH_CTRL_REGS.  HDR FMSTAT_BITS."""
    PGV      = F(12, R, 0, "programming verify status")
    EV       = F(10, R, 0, "erase verify status")
    BUSY     = F(8, R, 0, "busy")
    ERS      = F(7, R, 0, "erase operation status")
    PGM      = F(6, R, 0, "program operation status")
    INVDAT   = F(5, R, 0, "invalid data")
    CSTAT    = F(4, R, 0, "command fail status")
    VOLTSTAT = F(3, R, 0, "flash pump power status")
    ESUSP    = F(2, R, 0, "erase suspend")
    PSUSP    = F(1, R, 0, "program suspend")


class FRD_INTF_CTRL(Register, bits=32, eallow=True):
    """FRD_INTF_CTRL of FLASH_CTRL_REGS.  HDR FRD_INTF_CTRL_BITS."""
    DATA_CACHE_EN = F(1, RW, 0, "data cache enable")
    PREFETCH_EN   = F(0, RW, 0, "prefetch enable")


class ECC_ENABLE(Register, bits=32, eallow=True):
    """ECC_ENABLE of FLASH_ECC_REGS.  HDR ECC_ENABLE_BITS."""
    ENABLE = F(3, 0, RW, 0, "enable ECC")


class ERR_STATUS(Register, bits=32, eallow=True):
    """ERR_STATUS of FLASH_ECC_REGS.  HDR ERR_STATUS_BITS."""
    UNC_ERR_H = F(18, R, 0, "upper 64 bits uncorrectable error")
    FAIL_1_H  = F(17, R, 0, "upper 64 bits single bit error corrected to 1")
    FAIL_0_H  = F(16, R, 0, "upper 64 bits single bit error corrected to 0")
    UNC_ERR_L = F(2, R, 0, "lower 64 bits uncorrectable error")
    FAIL_1_L  = F(1, R, 0, "lower 64 bits single bit error corrected to 1")
    FAIL_0_L  = F(0, R, 0, "lower 64 bits single bit error corrected to 0")


class ERR_POS(Register, bits=32, eallow=True):
    """ERR_POS of FLASH_ECC_REGS.  HDR ERR_POS_BITS."""
    ERR_TYPE_H = F(24, R, 0, "error type in upper 64 bits")
    ERR_POS_H  = F(21, 16, R, 0, "bit position of single bit error in upper 64 bits")
    ERR_TYPE_L = F(8, R, 0, "error type in lower 64 bits")
    ERR_POS_L  = F(5, 0, R, 0, "bit position of single bit error in lower 64 bits")


class ERR_STATUS_CLR(Register, bits=32, eallow=True):
    """ERR_STATUS_CLR of FLASH_ECC_REGS.  HDR ERR_STATUS_CLR_BITS."""
    UNC_ERR_H_CLR = F(18, R0W1, 0, "upper 64 bits uncorrectable error: clear")
    FAIL_1_H_CLR  = F(17, R0W1, 0, "upper 64 bits single bit error corrected to 1 clear")
    FAIL_0_H_CLR  = F(16, R0W1, 0, "upper 64 bits single bit error corrected to 0 clear")
    UNC_ERR_L_CLR = F(2, R0W1, 0, "lower 64 bits uncorrectable error: clear")
    FAIL_1_L_CLR  = F(1, R0W1, 0, "lower 64 bits single bit error corrected to 1 clear")
    FAIL_0_L_CLR  = F(0, R0W1, 0, "lower 64 bits single bit error corrected to 0 clear")


class ERR_CNT(Register, bits=32, eallow=True):
    """ERR_CNT of FLASH_ECC_REGS.  HDR ERR_CNT_BITS."""
    ERR_CNT = F(15, 0, RW, 0, "error counter")


class ERR_THRESHOLD(Register, bits=32, eallow=True):
    """ERR_THRESHOLD of FLASH_ECC_REGS.  HDR ERR_THRESHOLD_BITS."""
    ERR_THRESHOLD = F(15, 0, RW, 0, "error threshold")


class ERR_INTFLG(Register, bits=32, eallow=True):
    """ERR_INTFLG of FLASH_ECC_REGS.  HDR ERR_INTFLG_BITS."""
    UNC_ERR_INTFLG    = F(1, R, 0, "uncorrectable interrupt flag")
    SINGLE_ERR_INTFLG = F(0, R, 0, "single error interrupt flag")


class ERR_INTCLR(Register, bits=32, eallow=True):
    """ERR_INTCLR of FLASH_ECC_REGS.  HDR ERR_INTCLR_BITS."""
    UNC_ERR_INTCLR    = F(1, R0W1, 0, "uncorrectable interrupt flag clear")
    SINGLE_ERR_INTCLR = F(0, R0W1, 0, "single error interrupt flag clear")


class FADDR_TEST(Register, bits=32, eallow=True):
    """FADDR_TEST of FLASH_ECC_REGS.  HDR FADDR_TEST_BITS."""
    ADDRH = F(21, 16, RW, 0, "ECC address high")
    ADDRL = F(15, 3, RW, 0, "ECC address low")


class FECC_TEST(Register, bits=32, eallow=True):
    """FECC_TEST of FLASH_ECC_REGS.  HDR FECC_TEST_BITS."""
    ECC = F(7, 0, RW, 0, "ECC control bits")


class FECC_CTRL(Register, bits=32, eallow=True):
    """FECC_CTRL of FLASH_ECC_REGS.  HDR FECC_CTRL_BITS."""
    DO_ECC_CALC = F(2, RW, 0, "enable ECC calculation")
    ECC_SELECT  = F(1, RW, 0, "ECC bit select")
    ECC_TEST_EN = F(0, RW, 0, "enable ECC test logic")


class FECC_STATUS(Register, bits=32, eallow=True):
    """FECC_STATUS of FLASH_ECC_REGS.  HDR FECC_STATUS_BITS."""
    ERR_TYPE     = F(8, R, 0, "position of 8 check bits of error")
    DATA_ERR_POS = F(7, 2, R, 0, "position of error")
    UNC_ERR      = F(1, R, 0, "test result is uncorrectable error")
    SINGLE_ERR   = F(0, R, 0, "test result is single bit error")


class PUMPREQUEST(Register, bits=32, eallow=True):
    """PUMPREQUEST of FLASH_PUMP_SEMAPHORE_REGS.  HDR PUMPREQUEST_BITS."""
    KEY            = F(31, 16, W, 0, "key of a write")
    PUMP_OWNERSHIP = F(1, 0, RW, 0, "owner of the pump")


class FlashCtrlRegs(Block, struct="FLASH_CTRL_REGS"):
    """Flash controller: wait states, power, read interface.  HDR struct FLASH_CTRL_REGS."""
    FRDCNTL       = At(0x00, FRDCNTL)
    FBAC          = At(0x1E, FBAC)
    FBFALLBACK    = At(0x20, FBFALLBACK)
    FBPRDY        = At(0x22, FBPRDY)
    FPAC1         = At(0x24, FPAC1)
    FMSTAT        = At(0x2A, FMSTAT)
    FRD_INTF_CTRL = At(0x180, FRD_INTF_CTRL)


class FlashEccRegs(Block, struct="FLASH_ECC_REGS"):
    """Error correction of the flash.  HDR struct FLASH_ECC_REGS."""
    ECC_ENABLE           = At(0x00, ECC_ENABLE)
    SINGLE_ERR_ADDR_LOW  = Word(0x02, R, 0, bits=32, eallow=True, text="single error address low")
    SINGLE_ERR_ADDR_HIGH = Word(0x04, R, 0, bits=32, eallow=True, text="single error address high")
    UNC_ERR_ADDR_LOW     = Word(0x06, R, 0, bits=32, eallow=True, text="uncorrectable error address low")
    UNC_ERR_ADDR_HIGH    = Word(0x08, R, 0, bits=32, eallow=True, text="uncorrectable error address high")
    ERR_STATUS           = At(0x0A, ERR_STATUS)
    ERR_POS              = At(0x0C, ERR_POS)
    ERR_STATUS_CLR       = At(0x0E, ERR_STATUS_CLR)
    ERR_CNT              = At(0x10, ERR_CNT)
    ERR_THRESHOLD        = At(0x12, ERR_THRESHOLD)
    ERR_INTFLG           = At(0x14, ERR_INTFLG)
    ERR_INTCLR           = At(0x16, ERR_INTCLR)
    FDATAH_TEST          = Word(0x18, RW, 0, bits=32, eallow=True, text="data high test")
    FDATAL_TEST          = Word(0x1A, RW, 0, bits=32, eallow=True, text="data low test")
    FADDR_TEST           = At(0x1C, FADDR_TEST)
    FECC_TEST            = At(0x1E, FECC_TEST)
    FECC_CTRL            = At(0x20, FECC_CTRL)
    FOUTH_TEST           = Word(0x22, RW, 0, bits=32, eallow=True, text="test data out high")
    FOUTL_TEST           = Word(0x24, RW, 0, bits=32, eallow=True, text="test data out low")
    FECC_STATUS          = At(0x26, FECC_STATUS)


class FlashPumpSemaphoreRegs(Block, struct="FLASH_PUMP_SEMAPHORE_REGS"):
    """The owner of the flash pump.  HDR struct FLASH_PUMP_SEMAPHORE_REGS."""
    PUMPREQUEST = At(0x00, PUMPREQUEST)
