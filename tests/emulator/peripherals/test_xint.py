"""External interrupts and the Input X-BAR: pins, edges, counters, locks."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.findings import Findings
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.peripherals.gpio import Gpio
from emulator.peripherals.input_xbar import InputXbar
from emulator.peripherals.xint import Xint
from emulator.registers.gpio import PIN_COUNT, GpioCtrlRegs, GpioDataRegs
from emulator.registers.input_xbar import InputXbarRegs
from emulator.registers.xint import XintRegs
from emulator.signals import Wire
from tests.emulator.drivers import Driver

FALLING, RISING, FALLING_TOO, BOTH = range(4)
#: DS, Input X-BAR destinations.
INPUT = {1: 4, 2: 5, 3: 6, 4: 13, 5: 14}


class Bench:
    """Pins, X-BAR and the five interrupts; `pulses` are (interrupt, cycle)."""

    def __init__(self) -> None:
        self.clock = Clock()
        self.findings = Findings(self.clock)
        self.cpu = Cpu(self.clock, self.findings)
        self.cpu.eallow = True
        self.pins = [Wire(f"GPIO{n}") for n in range(PIN_COUNT)]
        self.ctrl = GpioCtrlRegs("GpioCtrlRegs", 0x7C00, self.cpu)
        self.data = GpioDataRegs("GpioDataRegs", 0x7F00, self.cpu)
        self.gpio = Gpio(self.clock, self.cpu, self.ctrl, self.data, self.pins)
        self.regs = XintRegs("XintRegs", 0x7070, self.cpu)
        self.xbar = InputXbarRegs("InputXbarRegs", 0x7900, self.cpu)
        self.pulses: list[tuple[int, int]] = []
        gpio = self.gpio
        self.inputs = InputXbar(self.cpu, self.xbar, level=gpio.input, pin_changed=gpio.input_changed)
        self.stops: dict[int, Callable[[], None]] = {}
        self.xint = {n: Xint(self.clock, self.regs, n, partial(self.note, n), partial(self.listen, n)) for n in INPUT}

    def listen(self, n: int, on: bool) -> None:
        if on:
            self.stops[n] = self.inputs.changed[INPUT[n]].connect(self.xint[n].edge)
        else:
            self.stops.pop(n)()

    def note(self, n: int) -> None:
        self.pulses.append((n, self.clock.now))

    def enable(self, n: int, pin: int, polarity: int) -> None:
        self.xbar.registers[f"INPUT{INPUT[n]}SELECT"].write(pin)
        self.regs.registers[f"XINT{n}CR"].write(polarity << 2 | 1)

    def drive(self, pin: int, *levels: int) -> None:
        for level in levels:
            self.pins[pin].drive("button", level)

    def rules(self) -> list[str]:
        return [finding.rule for finding in self.findings]


@pytest.fixture
def bench() -> Bench:
    return Bench()


@pytest.mark.parametrize(("polarity", "edges"), [(FALLING, 2), (RISING, 3), (FALLING_TOO, 2), (BOTH, 5)])
@pytest.mark.parametrize("n", INPUT)
def test_each_interrupt_has_its_input_and_obeys_its_polarity(bench: Bench, n: int, polarity: int, edges: int) -> None:
    bench.enable(n, 32 + n, polarity)
    bench.drive(32 + n, 1, 0, 1, 0, 1)
    assert bench.pulses == [(n, 0)] * edges


def test_a_disabled_interrupt_and_another_pin_give_nothing(bench: Bench) -> None:
    bench.enable(1, 40, BOTH)
    bench.drive(41, 1, 0)
    bench.regs.XINT1CR.bit.ENABLE = 0
    bench.drive(40, 1, 0)
    assert bench.pulses == []


def test_one_pin_may_serve_several_interrupts_and_an_interrupt_leaves_its_old_pin(bench: Bench) -> None:
    bench.enable(1, 40, RISING)
    bench.enable(2, 40, BOTH)
    bench.drive(40, 1)
    assert sorted(bench.pulses) == [(1, 0), (2, 0)]
    bench.drive(40, 0)
    bench.pulses.clear()
    bench.xbar.INPUT4SELECT = 41
    bench.drive(40, 1)
    assert bench.pulses == [(2, 0)]


def test_selecting_a_pin_of_another_level_is_an_edge(bench: Bench) -> None:
    bench.drive(50, 1)
    bench.enable(3, 40, RISING)
    bench.xbar.INPUT6SELECT = 50
    assert bench.pulses == [(3, 0)]
    bench.xbar.INPUT6SELECT = 40
    assert bench.pulses == [(3, 0)]


def test_an_edge_while_disabled_is_not_remembered(bench: Bench) -> None:
    bench.enable(1, 40, RISING)
    bench.regs.XINT1CR.bit.ENABLE = 0
    bench.drive(40, 1)
    bench.regs.XINT1CR.bit.ENABLE = 1
    assert bench.pulses == []


def test_after_reset_every_input_is_GPIO0_and_nothing_is_enabled(bench: Bench) -> None:
    assert {register.value for register in (*bench.regs, *bench.xbar)} == {0}
    bench.drive(0, 1)
    assert bench.pulses == []
    for n in INPUT:
        bench.regs.registers[f"XINT{n}CR"].write(1)
    bench.drive(0, 0)  # falling: POLARITY 0
    assert sorted(bench.pulses) == [(n, 0) for n in INPUT]


def test_inversion_turns_the_edge_and_switching_it_is_one(bench: Bench) -> None:
    bench.enable(1, 5, RISING)
    bench.ctrl.GPAINV.bit.GPIO5 = 1  # the pin is low: its input rises
    assert len(bench.pulses) == 1
    bench.drive(5, 1)
    assert len(bench.pulses) == 1
    bench.drive(5, 0)
    assert len(bench.pulses) == 2


def test_a_qualified_pin_interrupts_when_its_level_is_accepted(bench: Bench) -> None:
    bench.ctrl.GPACTRL.bit.QUALPRD0 = 50  # a sample every 100 cycles
    bench.ctrl.GPAQSEL1.bit.GPIO5 = 1  # three equal samples
    bench.enable(1, 5, RISING)
    bench.clock.charge(10)
    bench.drive(5, 1)
    bench.clock.charge(50)
    bench.drive(5, 0)  # between two samples: not seen
    bench.clock.charge(60)
    bench.drive(5, 1)  # at cycle 120: samples at 200, 300, 400
    bench.clock.charge(1000)
    assert bench.pulses == [(1, 400)]


def test_an_output_interrupts_too(bench: Bench) -> None:
    bench.enable(1, 5, RISING)
    bench.ctrl.GPADIR.bit.GPIO5 = 1
    bench.data.GPASET.bit.GPIO5 = 1
    bench.data.GPASET.bit.GPIO5 = 1
    assert len(bench.pulses) == 1


def test_the_counter_starts_again_at_an_edge_that_interrupts_and_stands_while_disabled(bench: Bench) -> None:
    bench.enable(1, 5, RISING)
    bench.drive(5, 1)
    bench.clock.charge(700)
    bench.drive(5, 0)  # no interrupt: it counts on
    bench.clock.charge(300)
    assert bench.regs.XINT1CTR == 1000
    bench.regs.XINT1CR.bit.ENABLE = 0
    bench.clock.charge(500)
    assert bench.regs.XINT1CTR == 1000
    bench.regs.XINT1CR.bit.ENABLE = 1
    bench.clock.charge(65536)
    assert bench.regs.XINT1CTR == 1000  # 16 bits
    bench.drive(5, 1)
    assert bench.regs.XINT1CTR == 0


@given(st.lists(st.tuples(st.integers(0, 70000), st.sampled_from(["edge", "other", "on", "off"])), max_size=12))
def test_the_counter_equals_counting_cycle_by_cycle(steps: list[tuple[int, str]]) -> None:
    bench = Bench()
    bench.enable(2, 5, RISING)
    count, enabled = 0, True
    for wait, what in steps:
        bench.clock.charge(wait)
        count += wait if enabled else 0
        if what == "edge":
            bench.drive(5, 0, 1)
            count = 0 if enabled else count
        elif what == "other":
            bench.drive(5, 0)
        else:
            enabled = what == "on"
            bench.regs.XINT2CR.bit.ENABLE = int(enabled)
        assert bench.regs.XINT2CTR == count % 65536


def test_a_locked_select_keeps_its_pin_and_the_lock_stays(bench: Bench) -> None:
    bench.enable(1, 40, RISING)
    bench.xbar.INPUTSELECTLOCK.bit.INPUT4SELECT = 1
    bench.xbar.INPUTSELECTLOCK.bit.INPUT4SELECT = 0
    bench.xbar.INPUT4SELECT = 41
    assert bench.xbar.INPUT4SELECT == 40
    assert bench.rules() == ["locked"]
    bench.xbar.INPUT4SELECT = 40  # as a second start-up would: nothing is lost
    assert bench.findings.of("locked")[0].count == 1
    bench.drive(41, 1)
    assert bench.pulses == []


def test_a_pin_that_does_not_exist_is_told_and_is_low(bench: Bench) -> None:
    bench.enable(1, 40, FALLING)
    bench.drive(40, 1)
    bench.xbar.INPUT4SELECT = PIN_COUNT
    assert bench.rules() == ["unmodelled"]
    assert len(bench.pulses) == 1
    bench.xbar.INPUT4SELECT = 40
    bench.drive(40, 0)
    assert len(bench.pulses) == 2


def test_selecting_needs_eallow_and_configuring_does_not(bench: Bench) -> None:
    bench.cpu.eallow = False
    bench.regs.XINT1CR.bit.ENABLE = 1
    assert bench.rules() == []
    bench.xbar.INPUT4SELECT = 12
    assert bench.xbar.INPUT4SELECT == 0
    assert bench.rules() == ["eallow"]


@pytest.mark.parametrize(
    ("n", "enable", "line"),
    [
        (1, "PIEIER1.bit.INTx4", "M_INT1"),
        (2, "PIEIER1.bit.INTx5", "M_INT1"),
        (3, "PIEIER12.bit.INTx1", "M_INT12"),
        (4, "PIEIER12.bit.INTx2", "M_INT12"),
        (5, "PIEIER12.bit.INTx3", "M_INT12"),
    ],
)
def test_a_routine_of_a_driver_runs_at_each_press(n: int, enable: str, line: str) -> None:
    driver = Driver(f"""
Presses: uint16 = 0

# drv.c: Pressed
def Pressed() -> void:
    Presses += 1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP{line.removeprefix("M_INT")}

# drv.c: Init
def Init() -> void:
    InitSysCtrl()
    DINT()
    InitPieCtrl()
    IER = 0
    IFR = 0
    InitPieVectTable()
    EALLOW()
    PieVectTable.XINT{n}_INT = Pressed
    EDIS()
    GPIO_SetupPinMux(99, GPIO_MUX_CPU1, 0)
    GPIO_SetupPinOptions(99, GPIO_INPUT, GPIO_PULLUP)
    GPIO_SetupXINT{n}Gpio(99)
    XintRegs.XINT{n}CR.bit.POLARITY = 0
    XintRegs.XINT{n}CR.bit.ENABLE = 1
    PieCtrlRegs.{enable} = 1
    IER |= {line}
    EINT()

# drv.c: Read
def Read() -> uint16:
    return Presses
""")
    driver.Init()
    assert driver.Read() == 0
    button = driver.board.pins[99]
    for _ in range(3):
        button.drive("button", 0)
        driver.wait_ms(1)
        button.drive("button", None)
        driver.wait_ms(1)
    assert driver.Read() == 3
    assert not driver.rules()
