"""What can end a wait: programs that are right are waited for, however long; what reaches nothing is told soon.

A timer interrupts every 50 us.  The 2000th run of its routine ends the wait, after 0.1 s; a hopeless wait is told
after 1000 runs and a look, after 0.07 s.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.hil.testing.test_plugin import ALONE

DRIVER = '''
"""drv.c"""
from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import *

Flag: volatile[uint16] = 0
Other: volatile[uint16] = 0
Done: volatile[uint16] = 0
Runs: uint32 = 0
Turns: uint32 = 0
Unread: uint16 = 0


# drv.c: Ready
def Ready() -> uint16:
    Runs += 1
    return Runs == 2000


# drv.c: Set
def Set() -> void:
    if Ready():
        Flag = 1


# drv.c: Asked
def Asked() -> void:
    Unread += 1


Handler: funcptr[void] = Set
Target: ptr[volatile[uint16]] = addressof(Flag)


# drv.c: Directly
def Directly() -> void:
    Set()
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


# drv.c: By_Function
def By_Function() -> void:
    Handler()
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


# drv.c: By_Pointer
def By_Pointer() -> void:
    if Ready():
        Target[0] = 1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


# drv.c: By_Test
def By_Test() -> void:
    Asked()
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


# drv.c: By_PIEIER
def By_PIEIER() -> void:
    if Ready():
        PieCtrlRegs.PIEIER1.bit.INTx8 = 1
        PieCtrlRegs.PIEIFR1.bit.INTx8 = 1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


# drv.c: By_IER
def By_IER() -> void:
    if Ready():
        IER |= M_INT13  # until the return: the other interrupt must come within
        EINT()
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


# drv.c: Last
def Last() -> void:
    i: uint16
    j: uint16
    if Ready():
        PieCtrlRegs.PIEIER1.all = 0
        Flag = 1
        for i in range(500):
            for j in range(1000):
                Unread += j
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


# drv.c: Draining
def Draining() -> void:
    if Ready():
        Unread = SpiaRegs.SPIRXBUF
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


# drv.c: Toggling
def Toggling() -> void:
    if Ready():
        EALLOW()
        GpioCtrlRegs.GPADIR.bit.GPIO7 = 1
        EDIS()
        GpioDataRegs.GPASET.bit.GPIO7 = 1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


# drv.c: Waking
def Waking() -> void:
    Flag = 1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


# drv.c: Counting
def Counting() -> void:
    Unread += 1
    EPwm1Regs.ETCLR.bit.INT = 1
    AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP3


# drv.c: Init
def Init(routine: funcptr[void]) -> void:
    InitPieCtrl()
    InitPieVectTable()
    EALLOW()
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1
    CpuSysRegs.PCLKCR2.bit.EPWM1 = 1
    CpuSysRegs.PCLKCR8.bit.SPI_A = 1
    CpuSysRegs.PCLKCR13.bit.ADC_A = 1
    PieVectTable.TIMER0_INT = routine
    PieVectTable.ADCA1_INT = routine
    PieVectTable.EPWM1_INT = routine
    PieVectTable.WAKE_INT = Waking
    PieVectTable.TIMER1_INT = Waking
    AdcaRegs.ADCCTL2.bit.PRESCALE = 6
    AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1
    AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1
    EDIS()
    DelayUs(1000)
    EALLOW()
    AdcaRegs.ADCSOC0CTL.bit.ACQPS = 14
    AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0
    AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1
    EDIS()
    SpiaRegs.SPICCR.all = 0x0007
    SpiaRegs.SPICTL.all = 0x0006
    SpiaRegs.SPICCR.bit.SPILBK = 1
    SpiaRegs.SPICCR.bit.SPISWRESET = 1
    InitCpuTimers()
    IER |= M_INT1 | M_INT3
    EINT()


# drv.c: Every_50_us
def Every_50_us(routine: funcptr[void]) -> void:
    Init(routine)
    ConfigCpuTimer(CpuTimer0, 200.0, 50.0)
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1
    StartCpuTimer0()


# drv.c: Pwm_50_us
def Pwm_50_us(routine: funcptr[void]) -> void:
    Init(routine)
    EPwm1Regs.TBCTL.bit.HSPCLKDIV = 0
    EPwm1Regs.TBCTL.bit.CLKDIV = 0
    EPwm1Regs.TBPRD = 4999
    EPwm1Regs.ETSEL.bit.INTSEL = 1
    EPwm1Regs.ETSEL.bit.SOCASEL = 1
    EPwm1Regs.ETPS.bit.INTPRD = 1
    EPwm1Regs.ETPS.bit.SOCAPRD = 1
    EPwm1Regs.TBCTL.bit.CTRMODE = 0


# drv.c: For_Flag
def For_Flag() -> void:
    while Flag == 0:
        Turns += 1


# drv.c: Timer_1
def Timer_1() -> void:
    ConfigCpuTimer(CpuTimer1, 200.0, 100.0)
    StartCpuTimer1()
    For_Flag()


# drv.c: Step
def Step() -> void:
    if Flag == 1:
        Done = 1


# drv.c: Stepping
def Stepping() -> void:
    while Done == 0:
        Step()


# drv.c: Switching
def Switching() -> void:
    while Other == 0:
        match Flag:
            case 1:
                return
            case _:
                Turns += 1


# drv.c: For_Pin
def For_Pin() -> void:
    while GpioDataRegs.GPADAT.bit.GPIO7 == 0:
        Turns += 1


# drv.c: Spi
def Spi() -> void:
    while SpiaRegs.SPISTS.bit.INT_FLAG == 0:
        Turns += 1


# drv.c: Drained
def Drained() -> void:
    SpiaRegs.SPITXBUF = 0x5500
    Spi()
    while SpiaRegs.SPISTS.bit.INT_FLAG == 1:
        Turns += 1


# drv.c: Slow_Timer
def Slow_Timer() -> void:
    PieCtrlRegs.PIEIER1.all = 0
    ConfigCpuTimer(CpuTimer0, 200.0, 100000.0)
    StartCpuTimer0()


# drv.c: Flag_Of_Timer
def Flag_Of_Timer() -> void:
    Slow_Timer()
    while PieCtrlRegs.PIEIFR1.bit.INTx7 == 0:
        Turns += 1


# drv.c: Converted
def Converted() -> void:
    while AdcaRegs.ADCINTFLG.bit.ADCINT1 == 0:
        Turns += 1


# drv.c: Converted_By_Timer
def Converted_By_Timer() -> void:
    EALLOW()
    AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 1
    EDIS()
    Slow_Timer()
    Converted()


# drv.c: Long_Turn
def Long_Turn() -> void:
    i: uint16
    while Done == 0:
        for i in range(60000):
            Turns += i
        for i in range(60000):
            Turns += i
        for i in range(60000):
            Turns += i
        for i in range(60000):
            Turns += i
        for i in range(60000):
            Turns += i
        for i in range(60000):
            Turns += i
        for i in range(60000):
            Turns += i
        Done = 1


# drv.c: Pwm_Interrupt
def Pwm_Interrupt() -> void:
    EPwm1Regs.ETSEL.bit.INTEN = 1
    PieCtrlRegs.PIEIER3.bit.INTx1 = 1


# drv.c: Adc_Interrupt
def Adc_Interrupt() -> void:
    EALLOW()
    AdcaRegs.ADCSOC0CTL.bit.TRIGSEL = 5
    EDIS()
    EPwm1Regs.ETSEL.bit.SOCAEN = 1
    PieCtrlRegs.PIEIER1.bit.INTx1 = 1
'''

TEST = '''
import pytest

pytestmark = [
    pytest.mark.board("bare"), pytest.mark.firmware("drv.py"), pytest.mark.allows("poll-not-volatile"),
]
drivers = []


@pytest.fixture
def firmware_externs(request):
    asked = []

    def Asked():
        asked.append(0)
        if len(asked) == 2000:
            drivers[-1].Flag = 1

    return {"Asked": Asked} if "By_Test" in request.node.name else {}


@pytest.fixture
def drv(firmware):
    drivers.append(firmware.drv)
    return firmware.drv
'''

#: Routine of the timer -> the function that waits; each of them is right.
RIGHT = {
    "Directly": "For_Flag", "By_Function": "For_Flag", "By_Pointer": "For_Flag", "By_Test": "For_Flag",
    "By_PIEIER": "For_Flag", "By_IER": "Timer_1", "Last": "For_Flag", "Draining": "Drained", "Toggling": "For_Pin",
}  # fmt: skip


@pytest.fixture
def project(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> pytest.Pytester:
    monkeypatch.setenv("COLUMNS", "250")
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    (pytester.path / "drv.py").write_text(DRIVER, encoding="utf-8")
    return pytester


def run(project: pytest.Pytester, tests: str) -> pytest.RunResult:
    (Path(project.path) / "test_drv.py").write_text(TEST + tests, encoding="utf-8")
    return project.runpytest(*ALONE)


def test_a_routine_that_ends_the_wait_is_waited_for_however_it_does(project: pytest.Pytester) -> None:
    outcome = run(
        project,
        f"""
@pytest.mark.parametrize(("routine", "wait"), {list(RIGHT.items())})
def test_a(drv, timeline, routine, wait):
    drv.Every_50_us(getattr(drv, routine))
    getattr(drv, wait)()
    assert timeline.now_s > 0.0999
""",
    )
    outcome.assert_outcomes(passed=len(RIGHT))


def test_a_turn_is_looked_through_wherever_it_chooses_or_waits(project: pytest.Pytester) -> None:
    waits = ["Stepping", "Switching", "Flag_Of_Timer", "Converted_By_Timer"]
    outcome = run(
        project,
        f"""
@pytest.mark.parametrize("wait", {waits})
def test_a(drv, timeline, wait):
    drv.Every_50_us(drv.Directly)
    getattr(drv, wait)()
    assert timeline.now_s > 0.0999


def test_the_first_turn_takes_long(drv, timeline):
    drv.Long_Turn()
    assert timeline.now_s > 0.03
""",
    )
    outcome.assert_outcomes(passed=len(waits) + 1)


def test_a_listener_of_the_test_may_end_a_wait(project: pytest.Pytester) -> None:
    outcome = run(
        project,
        """
def test_a(drv, timeline, board):
    board.pins[7].changed.connect(lambda level: setattr(drv, "Flag", 1))
    drv.Every_50_us(drv.Toggling)
    drv.For_Flag()
    assert timeline.now_s > 0.0999
""",
    )
    outcome.assert_outcomes(passed=1)


#: What interrupts every 50 us with a routine that counts what nobody reads, and what is waited for.
HOPELESS = {
    ("Every_50_us", ""): ("For_Flag", "Spi"),
    ("Pwm_50_us", "Pwm_Interrupt"): ("For_Flag", "Spi"),
    ("Pwm_50_us", "Adc_Interrupt"): ("For_Flag", "Spi"),
}


def test_interrupts_that_reach_nothing_do_not_put_the_end_off(project: pytest.Pytester) -> None:
    cases = [(begin, then, wait) for (begin, then), waits in HOPELESS.items() for wait in waits]
    outcome = run(
        project,
        f"""
@pytest.mark.parametrize(("begin", "then", "wait"), {cases})
def test_a(drv, timeline, expects, begin, then, wait):
    expects("endless-poll" if wait != "For_Flag" else "endless-loop")
    getattr(drv, begin)(drv.Counting)
    if then:
        getattr(drv, then)()
    with pytest.raises(Exception, match="without returning"):
        getattr(drv, wait)()
    assert timeline.now_s < 0.1
""",
    )
    outcome.assert_outcomes(passed=len(cases))
