"""Interrupts of firmware without a kernel: vector table, PIE, IER, INTM, as C says them."""

from __future__ import annotations

import pytest

from emulator.c28x.runtime import Idling
from emulator.c28x.symbols import SourceError
from emulator.clock import CYCLES_PER_MS, CYCLES_PER_US
from tests.emulator.drivers import Driver

TIMER = """
Ticks: uint16 = 0
Seen: uint16 = 0

# drv.c: Tick
def Tick() -> void:
    Ticks += 1
{body}

# drv.c: Init
def Init() -> void:
    InitSysCtrl()
    DINT()
    InitPieCtrl()
    IER = 0x0000
    IFR = 0x0000
    InitPieVectTable()
{table}
    InitCpuTimers()
    ConfigCpuTimer(CpuTimer0, 200.0, 1000.0)
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1
    IER |= M_INT1
    EINT()
    ERTM()
    StartCpuTimer0()

# drv.c: Wait
def Wait(n: uint16) -> void:
    while Ticks < n:
        pass

# drv.c: Sum
def Sum(n: uint16) -> uint32:
    sum: uint32 = 0
    i: uint16
    for i in range(n):
        sum += GPIO_ReadPin(i & 15)
        Seen += 1
    return sum
"""
ACKNOWLEDGE = "    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1"
TABLE = "    EALLOW()\n    PieVectTable.TIMER0_INT = Tick\n    EDIS()"


def timer(body: str = ACKNOWLEDGE, table: str = TABLE, more: str = "") -> Driver:
    driver = Driver(TIMER.format(body=body, table=table) + more)
    driver.Init()
    return driver


def ticks(driver: Driver) -> int:
    value: int = driver.linked.objects["drv.Ticks"].data[0]
    return value


def test_a_routine_runs_once_a_period_while_nobody_else_does() -> None:
    driver = timer()
    driver.wait_ms(10.5)
    # 200 MHz * 1000 us = 200000 cycles: PRD + 1 of them, by ConfigCpuTimer.
    assert ticks(driver) == 10
    assert driver.rules() == []


def test_a_poll_of_what_the_routine_changes_ends() -> None:
    driver = timer()
    began = driver.board.clock.now
    driver.Wait(3)
    assert ticks(driver) == 3
    assert (driver.board.clock.now - began) // CYCLES_PER_MS == 3
    assert driver.rules() == []


SLEEP = """
# drv.c: Sleep
def Sleep(turns: uint16) -> uint16:
    while turns > 0:
        {before}
        IDLE()
        {after}
        turns -= 1
    return Ticks

# drv.c: Off
def Off() -> void:
    IER = {ier}
"""


@pytest.mark.parametrize(("before", "after"), [("pass", "pass"), ("DINT()", "EINT()")])
def test_IDLE_ends_with_the_next_interrupt(before: str, after: str) -> None:
    driver = timer(more=SLEEP.format(before=before, after=after, ier=0))
    driver.wait_ms(0.5)
    began = driver.board.clock.now
    # With INTM = 1 the routine runs behind the EINT.
    assert driver.Sleep(3) == 3
    assert (driver.board.clock.now - began) // CYCLES_PER_US in range(2490, 2510)
    assert not driver.board.cpu.asleep
    assert driver.rules() == []


@pytest.mark.parametrize("ier", ["0", "M_INT2 | M_INT13"])
def test_IDLE_does_not_end_with_an_interrupt_that_IER_keeps_out(ier: str) -> None:
    driver = timer(more=SLEEP.format(before="pass", after="pass", ier=ier))
    driver.Off()

    class Morning(Exception):
        pass

    def alarm() -> None:
        assert driver.board.cpu.asleep
        raise Morning

    driver.board.clock.after(20 * CYCLES_PER_MS, alarm)
    with pytest.raises(Morning):
        driver.Sleep(1)
    assert not driver.board.cpu.asleep
    assert ticks(driver) == 0


def test_IDLE_with_nothing_left_that_could_end_it_says_so() -> None:
    driver = Driver("Ticks: uint16 = 0\n" + SLEEP.format(before="pass", after="pass", ier=0))
    with pytest.raises(Idling, match="sleeps in IDLE"):
        driver.Sleep(1)


def test_a_routine_interrupts_a_function_that_computes() -> None:
    driver = timer()
    start = driver.board.clock.now
    driver.Sum(20000)
    passed = (driver.board.clock.now - start) // CYCLES_PER_MS
    assert passed > 2
    assert ticks(driver) == passed


def test_nothing_is_taken_between_DINT_and_EINT() -> None:
    driver = timer(
        more="\n# drv.c: Section\ndef Section() -> uint16:\n    n: uint16\n    DINT()\n    DELAY_US(2500.0)\n"
        "    n = Ticks\n    EINT()\n    DELAY_US(1.0)\n    return Ticks * 10 + n\n"
    )
    # Two periods have passed: one latched flag, so one run of the routine, behind EINT.
    assert driver.Section() == 10


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("    EINT()\n    ERTM()", "    ERTM()"),
        ("    IER |= M_INT1\n", ""),
        ("    PieCtrlRegs.PIEIER1.bit.INTx7 = 1\n", ""),
        ("    InitPieVectTable()\n", ""),
    ],
    ids=["INTM", "IER", "PIEIER", "ENPIE"],
)
def test_each_of_the_four_enables_is_needed(old: str, new: str) -> None:
    source = TIMER.format(body=ACKNOWLEDGE, table=TABLE)
    assert source.count(old) == 1
    driver = Driver(source.replace(old, new))
    driver.Init()
    driver.wait_ms(5)
    assert ticks(driver) == 0


def test_without_acknowledge_the_second_one_never_comes() -> None:
    driver = timer(body="")
    driver.wait_ms(5)
    assert ticks(driver) == 1
    assert driver.rules() == ["flag-not-cleared"]


def test_the_vector_table_is_protected() -> None:
    driver = timer(table="    PieVectTable.TIMER0_INT = Tick #!")
    driver.only("eallow")
    driver.wait_ms(2)
    assert driver.rules() == ["eallow", "interrupt-without-handler"]
    assert ticks(driver) == 0


def test_a_finding_names_the_routine_that_ran() -> None:
    driver = timer(body=ACKNOWLEDGE + "\n    CpuSysRegs.PCLKCR13.bit.ADC_A = 1 #!")
    driver.wait_ms(2)
    finding = driver.only("eallow")
    assert finding.task == "Isr:Tick"
    driver.Sum(1)
    assert driver.findings.context() == "main"


def test_EALLOW_of_the_interrupted_code_is_off_in_the_routine_and_back_behind_it() -> None:
    driver = timer(
        body=ACKNOWLEDGE + "\n    CpuSysRegs.PCLKCR13.bit.ADC_A = 1 #!",
        more="\n# drv.c: Setup\ndef Setup() -> void:\n    EALLOW()\n    DELAY_US(1500.0)\n"
        "    CpuSysRegs.PCLKCR8.bit.SPI_A = 1\n    EDIS()\n",
    )
    driver.Setup()
    driver.only("eallow")
    assert driver.board.register("CpuSysRegs", "PCLKCR8").value & 1


NESTED = """
Order: array[char, 8] = (0, 0, 0, 0, 0, 0, 0, 0)
N: uint16 = 0

# drv.c: Note
def Note(c: char) -> void:
    Order[N] = c
    N += 1

# drv.c: Slow
def Slow() -> void:
    Note('s')
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP1
{inside}
    DELAY_US(300.0)
    Note('S')

# drv.c: Fast
def Fast() -> void:
    Note('f')

# drv.c: Init
def Init() -> void:
    InitPieVectTable()
    EALLOW()
    PieVectTable.TIMER0_INT = addressof(Slow)
    PieVectTable.TIMER2_INT = addressof(Fast)
    EDIS()
    InitCpuTimers()
    ConfigCpuTimer(CpuTimer0, 200.0, 1000.0)
    ConfigCpuTimer(CpuTimer2, 200.0, 1100.0)
    PieCtrlRegs.PIEIER1.bit.INTx7 = 1
    IER = M_INT1 | M_INT14
    EINT()
    StartCpuTimer0()
    StartCpuTimer2()
"""


@pytest.mark.parametrize(("inside", "order"), [("", "sSf"), ("    EINT()", "sfS")], ids=["INTM stays set", "EINT"])
def test_routines_nest_only_where_they_allow_it(inside: str, order: str) -> None:
    driver = Driver(NESTED.format(inside=inside))
    driver.Init()
    # Timer 0 at 1.0 ms runs for 0.3 ms, timer 2 comes at 1.1 ms; its vector bypasses the PIE.
    driver.wait_ms(1.5)
    text = driver.linked.objects["drv.Order"].data
    assert "".join(chr(c) for c in text[:3]) == order
    assert driver.board.cpu.in_interrupt == 0
    assert driver.board.cpu.ier == 0x2001


@pytest.mark.parametrize("inside", ["    IER &= M_INT14", "    IER |= M_INT13", "    IER = 0"])
def test_what_a_routine_writes_to_IER_holds_until_it_returns(inside: str) -> None:
    driver = Driver(NESTED.format(inside=f"{inside}\n    EINT()"))
    driver.Init()
    driver.wait_ms(1.2)
    text = driver.linked.objects["drv.Order"].data
    assert "".join(chr(c) for c in text[:2]) == ("sS" if inside == "    IER = 0" else "sf")
    driver.wait_ms(0.3)
    assert "".join(chr(c) for c in text[:3]) == ("sSf" if inside == "    IER = 0" else "sfS")
    assert driver.board.cpu.ier == 0x2001


def test_an_interrupt_can_be_made_by_setting_its_bit_in_IFR() -> None:
    driver = Driver(
        "Runs: uint16 = 0\n\n# drv.c: Once\ndef Once() -> void:\n    Runs += 1\n\n"
        "# drv.c: Init\ndef Init() -> uint16:\n    EALLOW()\n    PieVectTable.TIMER1_INT = Once\n    EDIS()\n"
        "    IER |= M_INT13\n    IFR |= M_INT13\n    if IFR & M_INT13:\n        EINT()\n"
        "        DELAY_US(1.0)\n    return IFR\n"
    )
    assert driver.Init() == 0
    assert driver.linked.objects["drv.Runs"].data[0] == 1


def test_a_main_that_only_waits_for_interrupts_is_no_endless_poll() -> None:
    driver = timer(more="\n# drv.c: main\ndef main() -> void:\n    while 1:\n        pass\n")
    kernel, clock = driver.board.kernel, driver.board.clock
    clock.schedule(clock.now, kernel.pause)
    kernel.start(driver.main)
    kernel.run_until(clock.now + 7000 * CYCLES_PER_MS)
    kernel.shutdown()
    assert ticks(driver) >= 6999
    assert driver.rules() == []


def test_an_entry_is_read_back() -> None:
    driver = timer(
        more="\n# drv.c: Mine\ndef Mine() -> uint16:\n    return (PieVectTable.TIMER0_INT == Tick) * 2 + "
        "(PieVectTable.TIMER1_INT == NULL)\n"
    )
    assert driver.Mine() == 3


def test_a_routine_with_a_parameter_is_refused() -> None:
    with pytest.raises(SourceError, match="an interrupt routine has no parameters"):
        Driver("\ndef Isr(n: uint16) -> void:\n    pass\n\ndef Init() -> void:\n    PieVectTable.ADCA1_INT = Isr\n")


def test_the_kernel_owns_a_vector_that_Hwi_create_took() -> None:
    source = (
        "from emulator.sysbios.headers import Hwi_create, Hwi_Params, UArg\n"
        "Runs: uint16 = 0\n\n# drv.c: Handler\ndef Handler(arg: UArg) -> void:\n    Runs += 1\n\n"
        "# drv.c: main\ndef main() -> void:\n    Hwi_create(38, Handler, NULL, NULL)\n"
        "    InitCpuTimers()\n    ConfigCpuTimer(CpuTimer0, 200.0, 1000.0)\n    StartCpuTimer0()\n    BIOS_start()\n"
    )
    driver = Driver(source.replace("import Hwi_create,", "import BIOS_start, Hwi_create,"))
    kernel = driver.board.kernel
    kernel.start(driver.main)
    kernel.run_until(4500 * CYCLES_PER_US)
    kernel.shutdown()
    assert driver.linked.objects["drv.Runs"].data[0] == 4
    assert driver.rules() == []


def test_the_dispatchers_number_of_a_timer_line_is_that_of_its_interrupt() -> None:
    # BIOS Hwi_disp_asm.s28: the number of an interrupt is (PIECTRL - 0xD00) >> 1, taken on entry.
    driver = Driver(
        """
from emulator.sysbios.headers import *
Number: uint16 = 0

# drv.c: Tick
def Tick(arg: UArg) -> void:
    Number = PieCtrlRegs.PIECTRL.all - 0xD00 >> 1

# drv.c: main
def main() -> void:
    Hwi_create(13, Tick, NULL, NULL)
    EINT()
    IFR = M_INT13
    DELAY_US(1.0)
"""
    )
    driver.board.register("PieCtrlRegs", "PIECTRL").write(1, 0xFFFF)  # what the kernel's start-up does before main
    driver.main()
    assert driver.linked.objects["drv.Number"].data[0] == 13
    assert driver.rules() == []


VECTORS = """
First: uint16 = 0
Second: uint16 = 0
Group: uint16 = 0

# drv.c: Tint_1
def Tint_1() -> void:
    First = PieCtrlRegs.PIECTRL.bit.PIEVECT

# drv.c: Tint_2
def Tint_2() -> void:
    Second = PieCtrlRegs.PIECTRL.bit.PIEVECT

# drv.c: Run
def Run() -> void:
    EALLOW()
    PieVectTable.TIMER1_INT = Tint_1
    PieVectTable.TIMER2_INT = Tint_2
    EDIS()
    ConfigCpuTimer(CpuTimer1, 200.0, 700.0)
    ConfigCpuTimer(CpuTimer2, 200.0, 800.0)
    IER |= M_INT13 | M_INT14
    StartCpuTimer1()
    StartCpuTimer2()
    while First == 0 or Second == 0 or Group == 0:
        pass
"""


def test_PIEVECT_says_in_each_routine_which_one_it_is() -> None:
    # HDR F2837xS_pievect.h: entries 13, 14 and 0x26 of 32 bits from 0x0D00 on.  PIEVECT is bits 15 to 1 of PIECTRL, so
    # that the field reads half the address.
    driver = timer(f"    Group = PieCtrlRegs.PIECTRL.bit.PIEVECT\n{ACKNOWLEDGE}", more=VECTORS)
    driver.Run()
    seen = [driver.linked.objects[f"drv.{name}"].data[0] for name in ("First", "Second", "Group")]
    assert seen == [(0x0D00 + 2 * vector) >> 1 for vector in (13, 14, 0x26)]
    assert driver.rules() == []
