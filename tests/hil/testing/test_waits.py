"""Calls that wait: one that nothing can end is ended soon, with what could have ended it; others are waited for.

A turn of the loops below takes some ten to a hundred cycles, and the chip computes two million in 10 ms of its time
(200 MHz): a hopeless wait ends within 0.1 s of virtual time, long before the limit of 5 s.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.hil.testing.test_plugin import ALONE

DRIVER = '''
"""drv.c"""
from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import *

Flag: volatile[uint16] = 0
Other: volatile[uint16] = 0
Late: volatile[uint16] = 0
Ticks: volatile[uint16] = 0
Count: uint32 = 0


# drv.c: Tick
def Tick() -> void:
    Ticks += 1
    if Ticks == 1000:
        Flag = 1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


# drv.c: Start
def Start() -> void:
    InitPieCtrl()
    InitPieVectTable()
    EALLOW()
    PieVectTable.TIMER0_INT = Tick
    EDIS()
    InitCpuTimers()
    ConfigCpuTimer(CpuTimer0, 200.0, 100.0)
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1
    IER |= M_INT1
    EINT()
    StartCpuTimer0()


# drv.c: Set
def Set(p: ptr[uint16]) -> void:
    p[0] = 1


# drv.c: Ready
def Ready() -> uint16:
    value: uint16
    value = Flag
    return value


# drv.c: Received
def Received() -> uint16:
    return SciaRegs.SCIRXST.bit.RXRDY


# drv.c: By_Call
def By_Call() -> void:
    while Ready() == 0:
        pass


# drv.c: Guarded
def Guarded() -> void:
    DINT()
    EINT()


# drv.c: Guarding
def Guarding() -> void:
    while Flag == 0:
        Guarded()


# drv.c: By_Local
def By_Local() -> void:
    seen: uint16
    seen = 0
    while seen == 0:
        seen = Ready()


# drv.c: Counting
def Counting() -> void:
    while Flag == 0:
        Count += 1


# drv.c: Delaying
def Delaying() -> void:
    while Flag == 0:
        DelayUs(1)


# drv.c: Serving
def Serving() -> void:
    while Flag == 0:
        ServiceDog()


# drv.c: Byte
def Byte() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1
    EDIS()
    SciaRegs.SCICTL1.all = 0x0021
    while Received() == 0:
        Count += 1


# drv.c: Pins
def Pins() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR7.bit.SCI_A = 1
    GpioCtrlRegs.GPCGMUX2.bit.GPIO85 = 1
    GpioCtrlRegs.GPCMUX2.bit.GPIO85 = 1
    EDIS()
    SciaRegs.SCICCR.all = 0x0007
    SciaRegs.SCIHBAUD.all = 0x02
    SciaRegs.SCILBAUD.all = 0x8A


# drv.c: Masked
def Masked() -> void:
    Start()
    DINT()
    By_Call()


# drv.c: Line_Off
def Line_Off() -> void:
    Start()
    PieCtrlRegs.PIEIER1.all = 0
    By_Call()


# drv.c: Group_Off
def Group_Off() -> void:
    Start()
    IER &= ~M_INT1
    By_Call()


# drv.c: Interrupted
def Interrupted() -> void:
    Start()
    Delaying()


# drv.c: Long
def Long() -> void:
    i: uint16
    Ticks += 1
    if Ticks == 3000:
        Late = 1
    for i in range(700):
        Count += i
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


# drv.c: Take_Long
def Take_Long() -> void:
    EALLOW()
    PieVectTable.TIMER0_INT = Long
    EDIS()


# drv.c: Late_Flag
def Late_Flag() -> void:
    while Late == 0:
        pass


# drv.c: Other_Flag
def Other_Flag() -> void:
    while Other == 0:
        pass


# drv.c: Quick
def Quick() -> void:
    Count += 1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


# drv.c: Sending
def Sending() -> void:
    Count += 1
    if Count == 70000:
        SpiaRegs.SPITXBUF = 0x5500
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1


# drv.c: Every_10_us
def Every_10_us() -> void:
    EALLOW()
    CpuSysRegs.PCLKCR8.bit.SPI_A = 1
    EDIS()
    SpiaRegs.SPICCR.all = 0x0007
    SpiaRegs.SPICTL.all = 0x0006
    SpiaRegs.SPICCR.bit.SPILBK = 1
    SpiaRegs.SPICCR.bit.SPISWRESET = 1
    ConfigCpuTimer(CpuTimer0, 200.0, 10.0)
    StartCpuTimer0()
    while SpiaRegs.SPISTS.bit.INT_FLAG == 0:
        pass


# drv.c: Quickly
def Quickly() -> void:
    Start()
    EALLOW()
    PieVectTable.TIMER0_INT = Quick
    EDIS()
    Every_10_us()


# drv.c: Sent
def Sent() -> void:
    Start()
    EALLOW()
    PieVectTable.TIMER0_INT = Sending
    EDIS()
    Every_10_us()


# drv.c: Opening
def Opening() -> void:
    Start()
    DINT()
    while Ready() == 0:
        EINT()
        DelayUs(1)
        DINT()


# drv.c: Computing
def Computing(n: uint32) -> uint32:
    i: uint32
    sum: uint32
    i = 0
    sum = 0
    while i != n:
        sum += Ready()
        i += 1
    return sum
'''


@pytest.fixture
def project(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> pytest.Pytester:
    monkeypatch.setenv("COLUMNS", "250")
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    (pytester.path / "drv.py").write_text(DRIVER, encoding="utf-8")
    return pytester


def run(project: pytest.Pytester, body: str, fixtures: str = "") -> pytest.RunResult:
    """A test whose body is `body`, in which no finding is expected but those about the language of the driver."""
    header = "import pytest\n\npytestmark = [pytest.mark.firmware('drv.py'), pytest.mark.allows('poll-not-volatile')]\n"
    lines = "".join(f"    {line}\n" for line in body.splitlines())
    test = f"{header}\n\ndef test_a(firmware, timeline{fixtures}):\n    drv = firmware.drv\n{lines}"
    (Path(project.path) / "test_drv.py").write_text(test, encoding="utf-8")
    return project.runpytest(*ALONE)


NO_ENTRY = "it waits for drv.Flag, which drv.Tick writes: no entry of PieVectTable leads to it"
#: Function, the line of its loop's condition, and what could have ended it.
HOPELESS: dict[str, tuple[str, str]] = {
    "By_Call": ("while Ready() == 0:", NO_ENTRY),
    "By_Local": ("while seen == 0:", NO_ENTRY),
    "Counting": ("while Flag == 0:", NO_ENTRY),
    "Delaying": ("while Flag == 0:", NO_ENTRY),
    "Serving": ("while Flag == 0:", NO_ENTRY),
    "Byte": (
        "while Received() == 0:",
        "it waits for SciaRegs.SCIRXST.bit.RXRDY, which is 0, and nothing is under way on the chip that could change *",
    ),
    "Masked": (
        "while Ready() == 0:",
        "it waits for drv.Flag, which drv.Tick writes: the routine of TIMER0_INT; INTM is set: no interrupt is taken*",
    ),
    "Line_Off": ("while Ready() == 0:", "*the routine of TIMER0_INT; PieCtrlRegs.PIEIER1.bit.INTx7 is 0"),
    "Group_Off": ("while Ready() == 0:", "*the routine of TIMER0_INT; IER has no M_INT1"),
}  # fmt: skip


@pytest.mark.parametrize("name", HOPELESS)
def test_a_wait_that_nothing_can_end_is_ended_soon_at_its_condition(project: pytest.Pytester, name: str) -> None:
    rule = "endless-loop" if name == "Counting" else "endless-poll"
    # A delay of 1 us in each turn makes two million cycles last 0.1 s, and hopeless it is twice as long.
    outcome = run(project, f"try:\n    drv.{name}()\nfinally:\n    print('ended', timeline.now_s < 0.6)")
    outcome.assert_outcomes(failed=1)
    condition, said = HOPELESS[name]
    outcome.stdout.fnmatch_lines([f"error {rule}: *", f" *{condition}", f"    note     {said}"])
    outcome.stdout.fnmatch_lines(["ended True"])


def test_a_wait_may_call_what_masks_interrupts(project: pytest.Pytester) -> None:
    """`DINT` is called as a function is, and has no body to look into."""
    outcome = run(project, "drv.Guarding()")
    outcome.assert_outcomes(failed=1)
    outcome.stdout.fnmatch_lines(["error endless-poll: *", " *while Flag == 0:", f"    note     {NO_ENTRY}"])


def test_a_register_that_a_routine_does_not_concern_is_not_waited_for(project: pytest.Pytester) -> None:
    # Two million cycles are some 30,000 runs of the routine, one each 10 us: 0.3 s, and hopeless it is twice as long.
    outcome = run(project, "try:\n    drv.Quickly()\nfinally:\n    print('ended', timeline.now_s < 2.5)")
    outcome.assert_outcomes(failed=1)
    said = "*SpiaRegs.SPISTS.bit.INT_FLAG, which is 0, and nothing is under way on the chip that could change it"
    outcome.stdout.fnmatch_lines(["error endless-poll: *", " *while SpiaRegs.SPISTS.bit.INT_FLAG == 0:", said])
    outcome.stdout.fnmatch_lines(["ended True"])


def test_a_routine_that_runs_most_of_the_time_may_end_a_wait(project: pytest.Pytester) -> None:
    # 90 of each 100 us belong to the routine, in which INTM is set; its 3000th run ends the wait, after 0.3 s.
    outcome = run(project, "drv.Start()\ndrv.Take_Long()\ndrv.Late_Flag()\nassert 0.29 < timeline.now_s < 0.31")
    outcome.assert_outcomes(passed=1)


def test_a_wait_is_that_of_its_caller_whoever_interrupts_it(project: pytest.Pytester) -> None:
    # The call is ended half-way between two ticks of 100 us, and the routine takes 90 us of each.
    (Path(project.path) / "pytest.ini").write_text("[pytest]\nhil_call_limit = 0.00105\n", encoding="utf-8")
    outcome = run(project, "drv.Start()\ndrv.Take_Long()\ndrv.Other_Flag()")
    outcome.assert_outcomes(failed=1)
    outcome.stdout.fnmatch_lines(["    at       Other_Flag (*", "    seen     in main at *"])


#: What ends a wait, and when, in seconds.
ENDED: dict[str, tuple[str, str]] = {
    "a test, later": ("later(0.3, lambda: setattr(drv, 'Flag', 1))\ndrv.By_Call()", ", later"),
    "a byte, late": (
        "line = uart(84, 85, 9600)\ndrv.Pins()\nlater(0.3, lambda: line.send(b'x'))\ndrv.Byte()", ", later, uart"
    ),
    "a routine": ("drv.Interrupted()", ""),
    "a routine that makes the chip do something": ("drv.Sent()", ""),
    "a routine that may run now and then": ("drv.Opening()", ""),
    "a counter of its own": ("assert drv.Computing(700000) == 0", ""),
}


@pytest.mark.slow
@pytest.mark.parametrize("how", ENDED)
def test_a_wait_that_something_ends_is_waited_for(project: pytest.Pytester, how: str) -> None:
    body, fixtures = ENDED[how]
    # Each lasts longer than a hopeless one: 0.3 s, 1000 ticks of 100 us, 70000 of 10 us, 700000 turns of some twenty
    # cycles.
    outcome = run(project, f"{body}\nassert timeline.now_s > 0.06", fixtures)
    outcome.assert_outcomes(passed=1)


def test_a_function_of_the_test_may_end_a_wait(project: pytest.Pytester) -> None:
    body = "assert drv.By_Call() is None\nassert len(asked) == 300000"
    tests = f"""
import pytest

pytestmark = [pytest.mark.firmware("drv.py"), pytest.mark.allows("poll-not-volatile")]
asked = []


@pytest.fixture
def firmware_externs():
    def Ready():
        asked.append(0)
        return len(asked) // 300000

    return {{"Ready": Ready}}


def test_a(firmware):
    drv = firmware.drv
    {body.splitlines()[0]}
    {body.splitlines()[1]}
"""
    (Path(project.path) / "test_drv.py").write_text(tests, encoding="utf-8")
    outcome: Any = project.runpytest(*ALONE)
    outcome.assert_outcomes(passed=1)
