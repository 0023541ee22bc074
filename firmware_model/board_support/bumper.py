"""bumper.c: the touch sensor at the front.

CHOICE: GPIO43 (BoosterPack pin 9; GPIO41 on pin 5 carries the gyro's interrupt, TFG annex 1), an input with the pull-up
on; the switch pulls it to ground, so 0 means pressed, as main_Robot.c expects.  CHOICE: six samples at SYSCLK/510
qualify the level, no other debouncing. Sources: TRM GPIO chapter, TFG section 2.2.1.
"""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, GpioCtrlRegs, GpioDataRegs


# bumper.c: Init_Bumper
def Init_Bumper() -> void:

    EALLOW()
    GpioCtrlRegs.GPBMUX1.bit.GPIO43 = 0
    GpioCtrlRegs.GPBGMUX1.bit.GPIO43 = 0
    GpioCtrlRegs.GPBDIR.bit.GPIO43 = 0
    GpioCtrlRegs.GPBPUD.bit.GPIO43 = 0
    GpioCtrlRegs.GPBCTRL.bit.QUALPRD1 = 255
    GpioCtrlRegs.GPBQSEL1.bit.GPIO43 = 2
    EDIS()


# bumper.c: Read_Bumper
def Read_Bumper() -> char:
    return GpioDataRegs.GPBDAT.bit.GPIO43
