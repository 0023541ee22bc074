"""one_wire.c: a thermometer on a one-wire bus at GPIO33, whose line the driver pulls low by the direction of the
pin, and lets go likewise; a lamp in the same port.  What did not come, or is older than a second, is no temperature."""
from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import *

RESET_US = 480.0
SAMPLE_US = 70.0
REST_US = 410.0
TRIES = 3
MAX_AGE_MS = 1000
SKIP_ROM = 0xCC
READ_PAD = 0xBE
NO_TEMPERATURE = -1000

Now_Ms: volatile[uint16] = 0
Temperature: int16 = NO_TEMPERATURE
Measured_Ms: uint16 = 0
Absent: uint16 = 0
Bus_Faults: uint16 = 0
Heating: uint16 = 0


@interrupt
def Tick() -> void:
    Now_Ms += 1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


def _Init_Pins() -> void:
    EALLOW()
    GpioCtrlRegs.GPBMUX1.bit.GPIO33 = 0
    GpioCtrlRegs.GPBGMUX1.bit.GPIO33 = 0
    GpioCtrlRegs.GPBPUD.bit.GPIO33 = 0  # the pull-up of the bus
    GpioCtrlRegs.GPBQSEL1.bit.GPIO33 = 3
    GpioCtrlRegs.GPBDIR.bit.GPIO33 = 0
    GpioCtrlRegs.GPBMUX1.bit.GPIO34 = 0
    GpioCtrlRegs.GPBGMUX1.bit.GPIO34 = 0
    GpioCtrlRegs.GPBDIR.bit.GPIO34 = 1
    EDIS()
    GpioDataRegs.GPBCLEAR.bit.GPIO33 = 1  # what the pin shows whenever it is an output
    GpioDataRegs.GPBCLEAR.bit.GPIO34 = 1


def _Pull() -> void:
    EALLOW()
    GpioCtrlRegs.GPBDIR.bit.GPIO33 = 1
    EDIS()


def _Let_Go() -> void:
    EALLOW()
    GpioCtrlRegs.GPBDIR.bit.GPIO33 = 0
    EDIS()


# 1 if something answers on the bus.
def _Reset_Bus() -> uint16:
    present: uint16
    _Pull()
    DELAY_US(RESET_US)
    if GpioDataRegs.GPBDAT.bit.GPIO33 != 0:
        Bus_Faults += 1
    _Let_Go()
    DELAY_US(SAMPLE_US)
    present = 1 if GpioDataRegs.GPBDAT.bit.GPIO33 == 0 else 0
    DELAY_US(REST_US)
    return present


def _Write_Bit(value: uint16) -> void:
    _Pull()
    DELAY_US(6.0 if value else 60.0)
    _Let_Go()
    DELAY_US(64.0 if value else 10.0)


def _Read_Bit() -> uint16:
    value: uint16
    _Pull()
    DELAY_US(6.0)
    _Let_Go()
    DELAY_US(9.0)
    value = GpioDataRegs.GPBDAT.bit.GPIO33
    DELAY_US(55.0)
    return value


def _Write_Octet(octet: uint16) -> void:
    i: uint16
    for i in range(8):
        _Write_Bit(octet >> i & 1)


def _Read_Word() -> uint16:
    i: uint16
    word: uint16 = 0
    for i in range(16):
        word |= _Read_Bit() << i
    return word


# 1 if there is a new temperature.
def _Measure() -> uint16:
    tries: uint16 = 0
    while _Reset_Bus() == 0:
        tries += 1
        if tries == TRIES:
            return 0
    _Write_Octet(SKIP_ROM)
    _Write_Octet(READ_PAD)
    Temperature = int16(_Read_Word())
    Measured_Ms = Now_Ms
    return 1


def main() -> void:
    InitSysCtrl()
    DINT()
    InitPieCtrl()
    IER = 0x0000
    IFR = 0x0000
    InitPieVectTable()
    EALLOW()
    PieVectTable.TIMER0_INT = Tick
    EDIS()
    _Init_Pins()
    InitCpuTimers()
    ConfigCpuTimer(CpuTimer0, 200.0, 1000.0)
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1
    IER |= M_INT1
    EINT()
    StartCpuTimer0()
    while 1:
        if _Measure() == 0:
            Absent += 1
            if uint16(Now_Ms - Measured_Ms) > MAX_AGE_MS:
                Temperature = NO_TEMPERATURE
        if Temperature != NO_TEMPERATURE and Temperature < 16 * 20:
            Heating = 1
            GpioDataRegs.GPBSET.bit.GPIO34 = 1
        else:
            Heating = 0
            GpioDataRegs.GPBCLEAR.bit.GPIO34 = 1
        DELAY_US(5000.0)
