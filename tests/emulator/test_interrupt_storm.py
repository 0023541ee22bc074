"""Interrupts that leave what they interrupt nothing are a finding and the end; fast ones that leave something are not.

An interrupt takes 14 cycles of entry and 8 of return besides its routine; a storm is 1000 of them in a row over
2,000,000 cycles (10 ms) in which nothing else ran, or 50 over 0.75 s.
"""

from __future__ import annotations

import re

import pytest

from emulator.clock import CYCLES_PER_MS
from emulator.cpu import LONG_STORM_INTERRUPTS, STORM_CYCLES, STORM_INTERRUPTS, InterruptStorm
from tests.emulator.drivers import Driver

SECOND = 1000 * CYCLES_PER_MS
SOURCE = """
from emulator.sysbios.headers import *
Count: uint32 = 0
Done: uint32 = 0

# drv.c: Isr
def Isr() -> void: #!
    Count += 1
{body}
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP{group}

# drv.c: Handle
def Handle(arg: UArg) -> void:
    Count += 1
    PieCtrlRegs.PIEIFR1.bit.INTx7 = 1

# drv.c: main
def main() -> void:
    InitSysCtrl()
    DINT()
    InitPieCtrl()
    IER = 0x0000
    IFR = 0x0000
    InitPieVectTable()
    EALLOW()
    PieVectTable.{vector} = Isr
    EDIS()
    PieCtrlRegs.PIEIER{group}.all = 0xFFFF
    IER |= {mask}
{init}
    EINT()
    while Done < 100000:
        Done += GpioDataRegs.GPADAT.bit.GPIO0 + 1
"""


def driver(vector: str, group: int, *, mask: str = "", init: str, body: str = "") -> Driver:
    """A `main` that counts to 100,000 by reading a pin, under one interrupt."""
    indented = ["\n".join(f"    {line}" for line in text.splitlines()) for text in (init, body)]
    text = SOURCE.format(
        vector=vector, group=group, mask=mask or f"M_INT{group}", init=indented[0] or "    pass", body=indented[1]
    )
    return Driver(text)


def timer(number: int, period: int) -> str:
    name = f"CpuTimer{number}Regs"
    return f"{name}.TCR.bit.TSS = 1\n{name}.PRD.all = {period}\n{name}.TPR.all = 0\n{name}.TPRH.all = 0\n" + (
        f"{name}.TCR.bit.TRB = 1\n{name}.TCR.bit.TIE = 1\n{name}.TCR.bit.TSS = 0"
    )


ADC = """EALLOW()
AdcaRegs.ADCCTL2.bit.PRESCALE = 0
AdcaRegs.ADCCTL1.bit.INTPULSEPOS = 1
AdcaRegs.ADCCTL1.bit.ADCPWDNZ = 1
DELAY_US(1000.0)
AdcaRegs.ADCSOC0CTL.bit.CHSEL = 0
AdcaRegs.ADCSOC0CTL.bit.ACQPS = 0
AdcaRegs.ADCINTSEL1N2.bit.INT1SEL = 0
AdcaRegs.ADCINTSEL1N2.bit.INT1CONT = 1
AdcaRegs.ADCINTSEL1N2.bit.INT1E = 1
AdcaRegs.ADCINTSOCSEL1.bit.SOC0 = 1
EDIS()
AdcaRegs.ADCSOCFRC1.all = 1"""
#: The transmit FIFO is empty, and at or below its level: the flag that the routine clears is set again at once.
SCI = """SciaRegs.SCICTL1.all = 0x0003
SciaRegs.SCIFFTX.all = 0xE040
SciaRegs.SCIFFTX.bit.TXFFIL = 2
SciaRegs.SCICTL1.all = 0x0023
SciaRegs.SCIFFTX.bit.TXFFIENA = 1"""

STORMS = {
    "a timer of period 0": (driver("TIMER0_INT", 1, init=timer(0, 0)), "TIMER0_INT (interrupt 1.7): its source TIMER0"),
    "a timer that bypasses the PIE": (
        driver("TIMER1_INT", 1, mask="M_INT13", init=timer(1, 0)),
        "TIMER1_INT (interrupt 13 of the CPU): its source TIMER1",
    ),
    "a flag of the PIE": (
        driver("XINT1_INT", 1, init="PieCtrlRegs.PIEIFR1.bit.INTx4 = 1", body="PieCtrlRegs.PIEIFR1.bit.INTx4 = 1"),
        "XINT1_INT (interrupt 1.4): the firmware itself, which sets PIEIFR1.INTx4,",
    ),
    "a flag of the core": (
        driver("TIMER2_INT", 1, mask="M_INT14", init="IFR |= M_INT14", body="IFR |= M_INT14"),
        "TIMER2_INT (interrupt 14 of the CPU): the firmware itself, which sets INT14 in IFR,",
    ),
    "a continuous conversion": (
        driver("ADCA1_INT", 1, init=ADC, body="AdcaRegs.ADCINTFLGCLR.bit.ADCINT1 = 1\nCount += 1\nCount -= 1"),
        "ADCA1_INT (interrupt 1.1): its source ADCA1",
    ),
    "a FIFO that nobody fills": (
        driver("SCIA_TX_INT", 9, init=SCI, body="SciaRegs.SCIFFTX.bit.TXFFINTCLR = 1"),
        "SCIA_TX_INT (interrupt 9.2): its source SCIA_TX",
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", STORMS)
def test_a_storm_names_vector_source_count_and_who_is_starved(kind: str) -> None:
    storm, names = STORMS[kind]
    with pytest.raises(InterruptStorm):
        storm.main()
    (finding,) = storm.findings.of("interrupt-storm")
    assert finding.message.startswith(names.replace(": ", " occurs again as soon as its routine returns: ", 1))
    counted = re.search(r"; (\d+) interrupts in a row, (\d+\.\d+) ms without a statement of main$", finding.message)
    assert counted is not None, finding.message
    assert int(counted[1]) == finding.value >= STORM_INTERRUPTS
    # It is looked at when the next interrupt is due: less than one routine beyond 10 ms.
    assert 10.0 <= float(counted[2]) < 10.1
    assert storm.linked.objects["drv.Count"].data[0] >= finding.value
    assert finding.task == "Isr:Isr"
    assert finding.place is not None
    assert storm.lines[finding.place.line - 1].endswith("#!")
    assert any("main is at" in detail for detail in finding.details)


def test_a_storm_ends_the_time_that_a_test_lets_pass() -> None:
    storm = Driver(SOURCE.format(vector="TIMER0_INT", group=1, mask="M_INT1", init="    pass", body=""))
    storm.board.device_functions.externs["InitSysCtrl"]()
    storm.main()
    assert storm.rules() == []
    registers = storm.board.blocks["CpuTimer0Regs"].registers
    registers["PRD"].write(9, 0xFFFFFFFF)
    registers["TCR"].write(1 << 5 | 1 << 14, 0xFFFF)
    with pytest.raises(InterruptStorm):
        storm.wait_ms(1000)
    assert storm.rules() == ["interrupt-storm"]
    assert storm.board.clock.now < 1000 * CYCLES_PER_MS


def test_a_handler_of_the_kernel_that_asks_for_itself_is_a_storm() -> None:
    text = SOURCE.format(vector="TIMER0_INT", group=1, mask="M_INT1", init="    pass", body="")
    kernel = text.replace("    EINT()\n", "    Hwi_create(38, Handle, NULL, NULL)\n    PieCtrlRegs.PIECTRL.all = 1\n"
                          "    PieCtrlRegs.PIEIFR1.bit.INTx7 = 1\n    EINT()\n")  # fmt: skip
    assert kernel != text
    storm = Driver(kernel)
    with pytest.raises(InterruptStorm, match=r"^TIMER0_INT .* PIEIFR1\.INTx7, .* statement of main$"):
        storm.main()
    assert storm.rules() == ["interrupt-storm"]


def test_what_a_routine_lets_through_can_starve_the_routine() -> None:
    # The routine of timer 0 enables the timer of INT14 within itself, as nesting is done.
    body = "PieCtrlRegs.PIEIER1.all = 0\nIER |= M_INT14\nIFR |= M_INT14\nEINT()\nDELAY_US(1.0)\nDINT()"
    text = SOURCE.format(
        vector="TIMER0_INT", group=1, mask="M_INT1",
        init="    EALLOW()\n    PieVectTable.TIMER2_INT = Inner\n    EDIS()\n    PieCtrlRegs.PIEIFR1.bit.INTx7 = 1",
        body="\n".join(f"    {line}" for line in body.splitlines()),
    )  # fmt: skip
    storm = Driver(text.replace(" #!", "") + "\n# drv.c: Inner\ndef Inner() -> void: #!\n    IFR |= M_INT14\n")
    with pytest.raises(InterruptStorm, match=r"^TIMER2_INT .* without a statement of Isr:Isr$"):
        storm.main()
    assert storm.rules() == ["interrupt-storm"]


def test_a_fast_interrupt_that_lets_main_get_on_is_none() -> None:
    # 22 cycles of entry and return and those of the routine; of a period of 100 cycles some are left.
    calm = driver("TIMER0_INT", 1, init=timer(0, 99))
    calm.main()
    assert calm.rules() == []
    assert calm.board.clock.now > STORM_CYCLES // 2
    assert calm.linked.objects["drv.Count"].data[0] > STORM_INTERRUPTS


def test_a_routine_that_asks_for_itself_until_its_work_is_done_is_none() -> None:
    # 15,000 in a row, of less than 100 cycles each, are less than 2,000,000 cycles.
    calm = driver(
        "XINT1_INT", 1, init="PieCtrlRegs.PIEIFR1.bit.INTx4 = 1",
        body="if Count < 15000:\n    PieCtrlRegs.PIEIFR1.bit.INTx4 = 1",
    )  # fmt: skip
    calm.main()
    assert calm.linked.objects["drv.Count"].data[0] == 15_000
    assert calm.rules() == []


def test_a_routine_that_is_longer_than_its_period_is_one_after_three_quarters_of_a_second() -> None:
    storm = driver("TIMER0_INT", 1, init=timer(0, 1_999_999), body="DELAY_US(11000.0)")
    with pytest.raises(InterruptStorm):
        storm.main()
    (finding,) = storm.findings.of("interrupt-storm")
    assert 0.75 * SECOND <= storm.board.clock.now < 0.8 * SECOND
    assert finding.value is not None
    assert LONG_STORM_INTERRUPTS <= finding.value < STORM_INTERRUPTS


def test_a_routine_that_is_taken_rarely_and_computes_for_long_is_none() -> None:
    # Each takes 1 ms, the next waits already: 500 in a row, then the timer is stopped.
    calm = driver(
        "TIMER0_INT", 1, init=timer(0, 199_999),
        body="DELAY_US(1001.0)\nif Count == 500:\n    CpuTimer0Regs.TCR.bit.TSS = 1",
    )  # fmt: skip
    calm.main()
    assert calm.linked.objects["drv.Count"].data[0] >= 500
    assert calm.rules() == []
