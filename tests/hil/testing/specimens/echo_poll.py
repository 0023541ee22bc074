"""echo_poll.c: SCI-A on GPIO84 and GPIO85 by polling: what is received is sent back."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, CpuSysRegs, GpioCtrlRegs, SciaRegs

Errors: uint16 = 0


# echo_poll.c: Init_Echo
def Init_Echo() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1
    GpioCtrlRegs.GPCGMUX2.bit.GPIO84 = 1
    GpioCtrlRegs.GPCGMUX2.bit.GPIO85 = 1
    GpioCtrlRegs.GPCMUX2.bit.GPIO84 = 1
    GpioCtrlRegs.GPCMUX2.bit.GPIO85 = 1
    GpioCtrlRegs.GPCQSEL2.bit.GPIO85 = 3
    EDIS()
    SciaRegs.SCICTL1.all = 0x0000
    SciaRegs.SCICCR.all = 0x0007
    SciaRegs.SCIHBAUD.all = 0x00
    SciaRegs.SCILBAUD.all = 0xA2
    SciaRegs.SCICTL1.all = 0x0023


# echo_poll.c: Echo
def Echo(count: uint16) -> void:
    character: uint16
    while count > 0:
        while SciaRegs.SCIRXST.bit.RXRDY == 0:
            if SciaRegs.SCIRXST.bit.RXERROR == 1:
                Errors += 1
                SciaRegs.SCICTL1.bit.SWRESET = 0
                SciaRegs.SCICTL1.bit.SWRESET = 1
        character = SciaRegs.SCIRXBUF.all & 0xFF
        while SciaRegs.SCICTL2.bit.TXRDY == 0:
            pass
        SciaRegs.SCITXBUF.all = character
        count -= 1
