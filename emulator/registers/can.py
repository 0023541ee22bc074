"""CAN registers (CAN-A and CAN-B, at 0x48000 and 0x4A000; unprotected).

The controller stands behind the bridge to byte peripherals, which takes an address for one of bytes: a register of 32
bits has four addresses, its upper half begins at the third.  Offsets are those addresses, as in HDR hw_can.h.
Offsets and fields: HDR F2837xS_can.h, struct CAN_REGS; reset values: HDR F2837xS_Can_defines.h, TRM CAN registers.
No register needs EALLOW: TI's functions write all of them without.  CAN_REL, which has a reset value in HDR and no
place in the structure, is not there.
"""

# fmt: off
from __future__ import annotations

from emulator.registers.core import R0W1, RSV, RW, At, Block, F, R, Register, Word


class CAN_CTL(Register, bits=32):
    """Control.  TRM CAN registers; HDR CAN_CTL_BITS."""
    IE1     = F(17,     RW,   0, "interrupt line 1")
    INITDBG = F(16,     R,    0, "stopped by a debugger: nothing halts here")
    SWR     = F(15,     R0W1, 0, "software reset, with Init")
    PMD     = F(13, 10, RW,   5, "parity: 5 = off; no word of this message RAM is ever damaged")
    ABO     = F(9,      RW,   0, "comes back by itself after bus-off")
    IDS     = F(8,      RW,   0, "debug requests wait for the end of a frame: nothing halts here")
    Test    = F(7,      RW,   0, "CAN_TEST has effect and can be written")
    CCE     = F(6,      RW,   0, "CAN_BTR can be written, with Init")
    DAR     = F(5,      RW,   0, "no automatic retransmission")
    EIE     = F(3,      RW,   0, "interrupt at changes of BOff, EWarn and PER")
    SIE     = F(2,      RW,   0, "interrupt at RxOk, TxOk and LEC")
    IE0     = F(1,      RW,   0, "interrupt line 0")
    Init    = F(0,      RW,   1, "1 = takes no part in the bus")


class CAN_ES(Register, bits=32):
    """Error and status; reading it ends a status interrupt.  TRM CAN registers; HDR CAN_ES_BITS."""
    PER   = F(8,    R, 0, "parity error")
    BOff  = F(7,    R, 0, "bus-off")
    EWarn = F(6,    R, 0, "an error counter is at 96 or more")
    EPass = F(5,    R, 0, "error passive")
    RxOk  = F(4,    R, 0, "a frame was received since the last read")
    TxOk  = F(3,    R, 0, "a frame was sent since the last read")
    LEC   = F(2, 0, R, 7, "last error; 0 none, 7 no frame since the last read")


class CAN_ERRC(Register, bits=32):
    """Error counters.  TRM CAN registers; HDR CAN_ERRC_BITS."""
    RP  = F(15,    R, 0, "the receive error counter is at 128 or more")
    REC = F(14, 8, R, 0, "receive error counter")
    TEC = F( 7, 0, R, 0, "transmit error counter")


class CAN_BTR(Register, bits=32):
    """Bit timing; a bit has 3 + TSEG1 + TSEG2 quanta.  TRM CAN registers; HDR CAN_BTR_BITS."""
    BRPE  = F(19, 16, RW, 0, "prescaler, upper bits")
    TSEG2 = F(14, 12, RW, 2, "quanta behind the sample point, less one")
    TSEG1 = F(11,  8, RW, 3, "quanta before it, less one; the first one not counted")
    SJW   = F( 7,  6, RW, 0, "jump width, less one: nothing drifts here")
    BRP   = F( 5,  0, RW, 1, "prescaler: clocks of a quantum, less one")


class CAN_INT(Register, bits=32):
    """Interrupts.  TRM CAN registers; HDR CAN_INT_BITS."""
    INT1ID = F(23, 16, R, 0, "first pending object of line 1")
    INT0ID = F(15,  0, R, 0, "0x8000 status, else the first pending object of line 0")


class CAN_TEST(Register, bits=32):
    """Test modes, with CAN_CTL.Test.  TRM CAN registers; HDR CAN_TEST_BITS."""
    RDA    = F(9,    RW, 0, "message RAM at addresses of its own", modelled=False)
    EXL    = F(8,    RW, 0, "loopback through the pin CANTX")
    RX     = F(7,    R,  0, "level at CANRX")
    TX     = F(6, 5, RW, 0, "CANTX: 0 the controller, 1 sample point, 2 low, 3 high", modelled=False)
    LBACK  = F(4,    RW, 0, "loopback inside")
    SILENT = F(3,    RW, 0, "sends recessive bits only")


class CAN_PERR(Register, bits=32):
    """Parity error.  TRM CAN registers; HDR CAN_PERR_BITS."""
    WORD_NUM = F(10, 8, R, 0, "word")
    MSG_NUM  = F( 7, 0, R, 0, "message object")


class CAN_RAM_INIT(Register, bits=32):
    """Initialisation of the message RAM.  TRM CAN registers; HDR CAN_RAM_INIT_BITS."""
    RAM_INIT_DONE = F(5, R,  0, "done")
    CAN_RAM_INIT  = F(4, RW, 0, "1 with the key 0xA: begin")
    KEY3          = F(3, RW, 0, "key, bit 3")
    KEY2          = F(2, RW, 1, "key, bit 2")
    KEY1          = F(1, RW, 0, "key, bit 1")
    KEY0          = F(0, RW, 1, "key, bit 0")


class CAN_GLB_INT_EN(Register, bits=32):
    """Interrupt lines to the PIE.  TRM CAN registers; HDR CAN_GLB_INT_EN_BITS."""
    GLBINT1_EN = F(1, RW, 0, "line 1")
    GLBINT0_EN = F(0, RW, 0, "line 0")


class CAN_GLB_INT_FLG(Register, bits=32):
    """Interrupts that were given to the PIE.  TRM CAN registers; HDR CAN_GLB_INT_FLG_BITS."""
    INT1_FLG = F(1, R, 0, "line 1: no further interrupt until it is cleared")
    INT0_FLG = F(0, R, 0, "line 0: no further interrupt until it is cleared")


class CAN_GLB_INT_CLR(Register, bits=32):
    """Clears CAN_GLB_INT_FLG.  TRM CAN registers; HDR CAN_GLB_INT_CLR_BITS."""
    INT1_FLG_CLR = F(1, R0W1, 0, "line 1")
    INT0_FLG_CLR = F(0, R0W1, 0, "line 0")


class CAN_TXRQ_X(Register, bits=32):
    """TxRqst in groups of eight objects.  TRM CAN registers; HDR CAN_TXRQ_X_BITS."""
    TxRqstReg2 = F(3, 2, R, 0, "objects 17 to 24, 25 to 32")
    TxRqstReg1 = F(1, 0, R, 0, "objects 1 to 8, 9 to 16")


class CAN_NDAT_X(Register, bits=32):
    """NewDat in groups of eight objects.  TRM CAN registers; HDR CAN_NDAT_X_BITS."""
    NewDatReg2 = F(3, 2, R, 0, "objects 17 to 24, 25 to 32")
    NewDatReg1 = F(1, 0, R, 0, "objects 1 to 8, 9 to 16")


class CAN_IPEN_X(Register, bits=32):
    """IntPnd in groups of eight objects.  TRM CAN registers; HDR CAN_IPEN_X_BITS."""
    IntPndReg2 = F(3, 2, R, 0, "objects 17 to 24, 25 to 32")
    IntPndReg1 = F(1, 0, R, 0, "objects 1 to 8, 9 to 16")


class CAN_MVAL_X(Register, bits=32):
    """MsgVal in groups of eight objects.  TRM CAN registers; HDR CAN_MVAL_X_BITS."""
    MsgValReg2 = F(3, 2, R, 0, "objects 17 to 24, 25 to 32")
    MsgValReg1 = F(1, 0, R, 0, "objects 1 to 8, 9 to 16")


class CAN_IF1CMD(Register, bits=32):
    """Command of interface 1: what is moved, and to or from which object.  TRM CAN registers; HDR CAN_IF1CMD_BITS."""
    DIR       = F(23,   RW, 0, "1 = to the message object, 0 = from it")
    Mask      = F(22,   RW, 0, "move the mask")
    Arb       = F(21,   RW, 0, "move identifier, Xtd, Dir and MsgVal")
    Control   = F(20,   RW, 0, "move the control bits")
    ClrIntPnd = F(19,   RW, 0, "clear IntPnd of the object (reading)")
    TXRQST    = F(18,   RW, 0, "set TxRqst and NewDat of the object (writing), clear its NewDat (reading)")
    DATA_A    = F(17,   RW, 0, "move bytes 0 to 3")
    DATA_B    = F(16,   RW, 0, "move bytes 4 to 7")
    Busy      = F(15,    R, 0, "the transfer is under way: the registers of this interface take no write")
    MSG_NUM   = F(7, 0, RW, 1, "message object: writing it starts the transfer")


class CAN_IF1MSK(Register, bits=32):
    """Mask.  TRM CAN registers; HDR CAN_IF1MSK_BITS."""
    MXtd     = F(31,    RW,  1, "Xtd is compared")
    MDir     = F(30,    RW,  1, "Dir is compared")
    RESERVED = F(29,    RSV, 1, "reserved")
    Msk      = F(28, 0, RW,  0x1FFFFFFF, "bits of the identifier that are compared")


class CAN_IF1ARB(Register, bits=32):
    """Arbitration.  TRM CAN registers; HDR CAN_IF1ARB_BITS."""
    MsgVal = F(31,    RW, 0, "the object is used")
    Xtd    = F(30,    RW, 0, "29 bits of identifier")
    Dir    = F(29,    RW, 0, "1 = transmit, 0 = receive")
    ID     = F(28, 0, RW, 0, "identifier; one of 11 bits in 28:18")


class CAN_IF1MCTL(Register, bits=32):
    """Message control.  TRM CAN registers; HDR CAN_IF1MCTL_BITS."""
    NewDat = F(15,   RW, 0, "new data in the object")
    MsgLst = F(14,   RW, 0, "a message was overwritten unread")
    IntPnd = F(13,   RW, 0, "the object is the source of an interrupt")
    UMask  = F(12,   RW, 0, "the mask is used")
    TxIE   = F(11,   RW, 0, "IntPnd after a transmission")
    RxIE   = F(10,   RW, 0, "IntPnd after a reception")
    RmtEn  = F(9,    RW, 0, "a remote frame sets TxRqst")
    TxRqst = F(8,    RW, 0, "waits for its transmission")
    EoB    = F(7,    RW, 0, "single object, or the last of a FIFO")
    DLC    = F(3, 0, RW, 0, "length code")


class CAN_IF1DATA(Register, bits=32, data=True):
    """Bytes 0 to 3.  TRM CAN registers; HDR CAN_IF1DATA_BITS."""
    Data_3 = F(31, 24, RW, 0, "byte 3")
    Data_2 = F(23, 16, RW, 0, "byte 2")
    Data_1 = F(15,  8, RW, 0, "byte 1")
    Data_0 = F( 7,  0, RW, 0, "byte 0")


class CAN_IF1DATB(Register, bits=32, data=True):
    """Bytes 4 to 7.  TRM CAN registers; HDR CAN_IF1DATB_BITS."""
    Data_7 = F(31, 24, RW, 0, "byte 7")
    Data_6 = F(23, 16, RW, 0, "byte 6")
    Data_5 = F(15,  8, RW, 0, "byte 5")
    Data_4 = F( 7,  0, RW, 0, "byte 4")


class CAN_IF2CMD(Register, bits=32):
    """Command of interface 2: what is moved, and to or from which object.  TRM CAN registers; HDR CAN_IF2CMD_BITS."""
    DIR       = F(23,   RW, 0, "1 = to the message object, 0 = from it")
    Mask      = F(22,   RW, 0, "move the mask")
    Arb       = F(21,   RW, 0, "move identifier, Xtd, Dir and MsgVal")
    Control   = F(20,   RW, 0, "move the control bits")
    ClrIntPnd = F(19,   RW, 0, "clear IntPnd of the object (reading)")
    TxRqst    = F(18,   RW, 0, "set TxRqst and NewDat of the object (writing), clear its NewDat (reading)")
    DATA_A    = F(17,   RW, 0, "move bytes 0 to 3")
    DATA_B    = F(16,   RW, 0, "move bytes 4 to 7")
    Busy      = F(15,    R, 0, "the transfer is under way: the registers of this interface take no write")
    MSG_NUM   = F(7, 0, RW, 1, "message object: writing it starts the transfer")


class CAN_IF2MSK(CAN_IF1MSK, bits=32):
    """Mask of interface 2, as of interface 1.  HDR CAN_IF2MSK_BITS."""


class CAN_IF2ARB(CAN_IF1ARB, bits=32):
    """Arbitration of interface 2, as of interface 1.  HDR CAN_IF2ARB_BITS."""


class CAN_IF2MCTL(CAN_IF1MCTL, bits=32):
    """Message control of interface 2, as of interface 1.  HDR CAN_IF2MCTL_BITS."""


class CAN_IF2DATA(CAN_IF1DATA, bits=32, data=True):
    """Bytes 0 to 3 of interface 2, as of interface 1.  HDR CAN_IF2DATA_BITS."""


class CAN_IF2DATB(CAN_IF1DATB, bits=32, data=True):
    """Bytes 4 to 7 of interface 2, as of interface 1.  HDR CAN_IF2DATB_BITS."""


class CAN_IF3OBS(Register, bits=32):
    """What of interface 3 is read.  TRM CAN registers; HDR CAN_IF3OBS_BITS."""
    IF3Upd = F(15, R,  0, "new values, not yet read")
    IF3SDB = F(12, R,  0, "bytes 4 to 7 are still to be read")
    IF3SDA = F(11, R,  0, "bytes 0 to 3 are still to be read")
    IF3SC  = F(10, R,  0, "the control bits are still to be read")
    IF3SA  = F(9,  R,  0, "arbitration is still to be read")
    IF3SM  = F(8,  R,  0, "the mask is still to be read")
    Data_B = F(4,  RW, 0, "bytes 4 to 7 have to be read")
    Data_A = F(3,  RW, 0, "bytes 0 to 3 have to be read")
    Ctrl   = F(2,  RW, 0, "the control bits have to be read")
    Arb    = F(1,  RW, 0, "arbitration has to be read")
    Mask   = F(0,  RW, 0, "the mask has to be read")


class CAN_IF3MSK(Register, bits=32):
    """Mask.  TRM CAN registers; HDR CAN_IF3MSK_BITS."""
    MXtd     = F(31,    R,   1, "Xtd is compared")
    MDir     = F(30,    R,   1, "Dir is compared")
    RESERVED = F(29,    RSV, 1, "reserved")
    Msk      = F(28, 0, R,   0x1FFFFFFF, "bits of the identifier that are compared")


class CAN_IF3ARB(Register, bits=32):
    """Arbitration.  TRM CAN registers; HDR CAN_IF3ARB_BITS."""
    MsgVal = F(31,    R,  0, "the object is used")
    Xtd    = F(30,    R,  0, "29 bits of identifier")
    Dir    = F(29,    R,  0, "1 = transmit, 0 = receive")
    ID     = F(28, 0, R,  0, "identifier; one of 11 bits in 28:18")


class CAN_IF3MCTL(Register, bits=32):
    """Message control.  TRM CAN registers; HDR CAN_IF3MCTL_BITS."""
    NewDat = F(15,   R,  0, "new data in the object")
    MsgLst = F(14,   R,  0, "a message was overwritten unread")
    IntPnd = F(13,   R,  0, "the object is the source of an interrupt")
    UMask  = F(12,   R,  0, "the mask is used")
    TxIE   = F(11,   R,  0, "IntPnd after a transmission")
    RxIE   = F(10,   R,  0, "IntPnd after a reception")
    RmtEn  = F(9,    R,  0, "a remote frame sets TxRqst")
    TxRqst = F(8,    R,  0, "waits for its transmission")
    EoB    = F(7,    R,  0, "single object, or the last of a FIFO")
    DLC    = F(3, 0, R,  0, "length code")


class CAN_IF3DATA(Register, bits=32, data=True):
    """Bytes 0 to 3.  TRM CAN registers; HDR CAN_IF3DATA_BITS."""
    Data_3 = F(31, 24, R,  0, "byte 3")
    Data_2 = F(23, 16, R,  0, "byte 2")
    Data_1 = F(15,  8, R,  0, "byte 1")
    Data_0 = F( 7,  0, R,  0, "byte 0")


class CAN_IF3DATB(Register, bits=32, data=True):
    """Bytes 4 to 7.  TRM CAN registers; HDR CAN_IF3DATB_BITS."""
    Data_7 = F(31, 24, R,  0, "byte 7")
    Data_6 = F(23, 16, R,  0, "byte 6")
    Data_5 = F(15,  8, R,  0, "byte 5")
    Data_4 = F( 7,  0, R,  0, "byte 4")


class CanRegs(Block, struct="CAN_REGS", byte_peripheral=True):
    """One CAN controller.  HDR struct CAN_REGS."""
    CAN_CTL         = At(0x000, CAN_CTL)
    CAN_ES          = At(0x004, CAN_ES)
    CAN_ERRC        = At(0x008, CAN_ERRC)
    CAN_BTR         = At(0x00C, CAN_BTR)
    CAN_INT         = At(0x010, CAN_INT)
    CAN_TEST        = At(0x014, CAN_TEST)
    CAN_PERR        = At(0x01C, CAN_PERR)
    CAN_RAM_INIT    = At(0x040, CAN_RAM_INIT)
    CAN_GLB_INT_EN  = At(0x050, CAN_GLB_INT_EN)
    CAN_GLB_INT_FLG = At(0x054, CAN_GLB_INT_FLG)
    CAN_GLB_INT_CLR = At(0x058, CAN_GLB_INT_CLR)
    CAN_ABOTR       = Word(0x080, RW, 0, 32, text="cycles from bus-off to the way back, with ABO")
    CAN_TXRQ_X      = At(0x084, CAN_TXRQ_X)
    CAN_TXRQ_21     = Word(0x088, R, 0, 32, text="TxRqst of objects 1 (bit 0) to 32")
    CAN_NDAT_X      = At(0x098, CAN_NDAT_X)
    CAN_NDAT_21     = Word(0x09C, R, 0, 32, text="NewDat of objects 1 to 32")
    CAN_IPEN_X      = At(0x0AC, CAN_IPEN_X)
    CAN_IPEN_21     = Word(0x0B0, R, 0, 32, text="IntPnd of objects 1 to 32")
    CAN_MVAL_X      = At(0x0C0, CAN_MVAL_X)
    CAN_MVAL_21     = Word(0x0C4, R, 0, 32, text="MsgVal of objects 1 to 32")
    CAN_IP_MUX21    = Word(0x0D8, RW, 0, 32, text="interrupt line of objects 1 to 32")
    CAN_IF1CMD      = At(0x100, CAN_IF1CMD)
    CAN_IF1MSK      = At(0x104, CAN_IF1MSK)
    CAN_IF1ARB      = At(0x108, CAN_IF1ARB)
    CAN_IF1MCTL     = At(0x10C, CAN_IF1MCTL)
    CAN_IF1DATA     = At(0x110, CAN_IF1DATA)
    CAN_IF1DATB     = At(0x114, CAN_IF1DATB)
    CAN_IF2CMD      = At(0x120, CAN_IF2CMD)
    CAN_IF2MSK      = At(0x124, CAN_IF2MSK)
    CAN_IF2ARB      = At(0x128, CAN_IF2ARB)
    CAN_IF2MCTL     = At(0x12C, CAN_IF2MCTL)
    CAN_IF2DATA     = At(0x130, CAN_IF2DATA)
    CAN_IF2DATB     = At(0x134, CAN_IF2DATB)
    CAN_IF3OBS      = At(0x140, CAN_IF3OBS)
    CAN_IF3MSK      = At(0x144, CAN_IF3MSK)
    CAN_IF3ARB      = At(0x148, CAN_IF3ARB)
    CAN_IF3MCTL     = At(0x14C, CAN_IF3MCTL)
    CAN_IF3DATA     = At(0x150, CAN_IF3DATA)
    CAN_IF3DATB     = At(0x154, CAN_IF3DATB)
    CAN_IF3UPD      = Word(0x160, RW, 0, 32, text="objects 1 to 32 that are copied to interface 3")
