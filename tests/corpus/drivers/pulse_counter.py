"""pulse_counter.c: XINT1 counts the pulses of a flow meter on GPIO32; the same pin is driven by the driver itself for
its self-test: CPU timer 1 makes pulses of 10 us, a known number of them, and main compares."""
from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import *

PIN = 32
ROUNDS = 40
PULSES = 5
QUIET_US = 300.0
PULSE_US = 10.0

Counted: volatile[uint16] = 0
To_Make: volatile[uint16] = 0
Wrong: uint16 = 0
Round: uint16 = 0
Flow: uint32 = 0


@interrupt
def Pulse() -> void:
    Counted += 1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


@interrupt
def Make_Pulse() -> void:
    if To_Make > 0:
        GpioDataRegs.GPBSET.bit.GPIO32 = 1
        DELAY_US(PULSE_US)
        GpioDataRegs.GPBCLEAR.bit.GPIO32 = 1
        To_Make -= 1


def _Init_Pin() -> void:
    GpioDataRegs.GPBCLEAR.bit.GPIO32 = 1
    GPIO_SetupPinMux(PIN, GPIO_MUX_CPU1, 0)
    GPIO_SetupPinOptions(PIN, GPIO_OUTPUT, GPIO_QUAL3)
    EALLOW()
    GpioCtrlRegs.GPBCTRL.bit.QUALPRD0 = 10  # three samples, 20 cycles apart: 0.3 us
    InputXbarRegs.INPUT4SELECT = PIN
    EDIS()
    XintRegs.XINT1CR.bit.POLARITY = 1  # rising
    XintRegs.XINT1CR.bit.ENABLE = 1


def _Self_Test(pulses: uint16) -> uint16:
    before: uint16 = Counted
    To_Make = pulses
    while To_Make > 0:
        pass
    DELAY_US(QUIET_US)
    return Counted - before


def main() -> void:
    InitSysCtrl()
    DINT()
    InitPieCtrl()
    IER = 0x0000
    IFR = 0x0000
    InitPieVectTable()
    EALLOW()
    PieVectTable.XINT1_INT = Pulse
    PieVectTable.TIMER1_INT = Make_Pulse
    EDIS()
    _Init_Pin()
    InitCpuTimers()
    ConfigCpuTimer(CpuTimer1, 200.0, 100.0)
    PieCtrlRegs.PIEIER1.bit.INTx4 = 1
    IER |= M_INT1 | M_INT13
    EINT()
    StartCpuTimer1()
    while 1:
        counted: uint16 = _Self_Test(PULSES)
        if counted != PULSES:
            Wrong += 1
        Flow += counted
        Round += 1
