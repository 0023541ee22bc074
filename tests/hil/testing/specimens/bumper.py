"""bumper.c: the bumper on GPIO43, debounced by a state machine that is called every 5 ms."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import EALLOW, EDIS, GpioCtrlRegs, GpioDataRegs

STABLE = 4


class CONTACT(enum):
    OPEN = 0
    CLOSING = 1
    CLOSED = 2
    OPENING = 3


State: CONTACT = CONTACT.OPEN
Count: uint16 = 0
Presses: uint16 = 0


# bumper.c: Init_Contact
def Init_Contact() -> void:
    EALLOW()
    GpioCtrlRegs.GPBGMUX1.bit.GPIO43 = 0
    GpioCtrlRegs.GPBMUX1.bit.GPIO43 = 0
    GpioCtrlRegs.GPBDIR.bit.GPIO43 = 0
    GpioCtrlRegs.GPBPUD.bit.GPIO43 = 0
    EDIS()


# bumper.c: Step
def Step() -> void:
    down: uint16
    down = GpioDataRegs.GPBDAT.bit.GPIO43 == 0
    match State:
        case CONTACT.OPEN:
            if down:
                State = CONTACT.CLOSING
                Count = 1
        case CONTACT.CLOSING:
            if not down:
                State = CONTACT.OPEN
            else:
                Count += 1
                if Count >= STABLE:
                    State = CONTACT.CLOSED
                    Presses += 1
        case CONTACT.CLOSED:
            if not down:
                State = CONTACT.OPENING
                Count = 1
        case CONTACT.OPENING:
            if down:
                State = CONTACT.CLOSED
            else:
                Count += 1
                if Count >= STABLE:
                    State = CONTACT.OPEN
