"""What an ePWM does on its pins: edges for who listens, levels for who looks, and trips from the Input X-BAR.

Two of the programs are those of TI's examples of dead band and trip zones, in our words and with shorter periods.
"""

from __future__ import annotations

from itertools import pairwise
from random import Random

import pytest

from emulator.chip import Chip
from emulator.registers.core import ALL
from tests.emulator.drivers import Driver

SET, CLEAR = 2, 1
#: Fields of AQCTLA and AQCTLB.
ZRO, PRD, CAU, CAD = 0, 2, 4, 6


@pytest.fixture
def chip() -> Chip:
    chip = Chip(rng=Random(0))
    chip.cpu.eallow = True
    return chip


def write(chip: Chip, path: str, word: int) -> None:
    chip.register(*path.split(".")).write(word, ALL)


def read(chip: Chip, path: str) -> int:
    return chip.register(*path.split(".")).read()


def square(chip: Chip, period: int = 1000, high: int = 300) -> None:
    """ePWM1A high for `high` of `period` cycles on GPIO0, in TBCLK of one cycle."""
    write(chip, "CpuSysRegs.PCLKCR2", 1)
    write(chip, "ClkCfgRegs.PERCLKDIVSEL", 0x50)  # EPWMCLK = SYSCLK
    write(chip, "EPwm1Regs.TBCTL", 1 << 3 | 3)  # stopped, PRDLD immediate, dividers 1
    write(chip, "EPwm1Regs.CMPCTL", 1 << 4)  # CMPA immediate
    write(chip, "EPwm1Regs.TBPRD", period - 1)
    write(chip, "EPwm1Regs.CMPA", high << 16)
    write(chip, "EPwm1Regs.AQCTLA", SET << ZRO | CLEAR << CAU)
    write(chip, "GpioCtrlRegs.GPAMUX1", 1)
    write(chip, "CpuSysRegs.PCLKCR0", 1 << 18)
    write(chip, "EPwm1Regs.TBCTL", 1 << 3)


def test_a_pwm_that_only_drives_a_motor_makes_no_events(chip: Chip) -> None:
    square(chip)
    before = chip.clock.events_run
    chip.clock.advance_to(1_000_000)
    assert chip.clock.events_run == before
    assert chip.pwm_outputs["GPIO0"].duty == 0.3


def test_dat_and_the_wire_show_the_level_of_the_instant(chip: Chip) -> None:
    square(chip)
    events, start = chip.clock.events_run, chip.clock.now
    # CTR = 0 first at 1000 TBCLK from the start: high for 300 of each 1000 from there on.
    for after, level in ((999, 0), (1_000, 1), (1_299, 1), (1_300, 0), (50_299, 1), (50_300, 0)):
        chip.clock.advance_to(start + after)
        assert read(chip, "GpioDataRegs.GPADAT") & 1 == level
        assert chip.pins[0].level == level
    # A look at DAT marks the next edge: 1000, 1300, 2000 and 50300 have passed; nobody marked those between.
    assert chip.clock.events_run - events == 4
    pending = chip.clock.pending
    assert chip.pins[0].level == 0
    assert chip.clock.pending == pending


def test_input_inversion_turns_what_dat_shows_and_not_the_pin(chip: Chip) -> None:
    square(chip)
    write(chip, "GpioCtrlRegs.GPAINV", 1)
    start = chip.clock.now
    chip.clock.advance_to(start + 10_100)
    assert (chip.pins[0].level, read(chip, "GpioDataRegs.GPADAT") & 1) == (1, 0)


def test_a_pin_given_back_to_gpio_is_no_longer_the_modules(chip: Chip) -> None:
    square(chip)
    chip.clock.advance_to(chip.clock.now + 10_100)
    assert chip.pins[0].level == 1
    write(chip, "GpioCtrlRegs.GPAMUX1", 0)
    assert (chip.pins[0].level, chip.pins[0].driven(), read(chip, "GpioDataRegs.GPADAT") & 1) == (0, False, 0)


def test_a_listener_on_the_wire_hears_every_edge(chip: Chip) -> None:
    square(chip)
    start = chip.clock.now
    edges: list[tuple[int, int]] = []

    def hear(level: int) -> None:
        edges.append((chip.clock.now - start, level))

    stop = chip.pins[0].changed.connect(hear)
    chip.clock.advance_to(start + 3_000)
    assert edges == [(1_000, 1), (1_300, 0), (2_000, 1), (2_300, 0), (3_000, 1)]
    stop()
    events = chip.clock.events_run
    chip.clock.advance_to(start + 100_000)
    assert chip.clock.events_run == events


def test_edges_of_a_pwm_interrupt_by_xint1_while_that_is_enabled(chip: Chip) -> None:
    square(chip)
    start, events = chip.clock.now, chip.clock.events_run
    taken: list[int] = []
    chip.pie.set_vector(0x23, lambda: taken.append(chip.clock.now - start))  # INT1.4
    write(chip, "PieCtrlRegs.PIECTRL", 1)
    write(chip, "PieCtrlRegs.PIEIER1", 1 << 3)
    chip.enable_line(1)
    chip.cpu.enable_interrupts()
    write(chip, "InputXbarRegs.INPUT4SELECT", 0)
    chip.clock.advance_to(start + 5_000)
    assert chip.clock.events_run == events
    write(chip, "XintRegs.XINT1CR", 1)  # falling edge
    for _ in range(4):
        chip.clock.advance_to(chip.clock.now + 1_000)
        write(chip, "PieCtrlRegs.PIEACK", 1)
    # Falling edges at 300 of each 1000, and the CPU's way into the routine.
    assert [cycle - cycle % 100 for cycle in taken] == [5_300, 6_300, 7_300, 8_300]
    assert read(chip, "XintRegs.XINT1CTR") == 9_000 - 8_300


def test_a_qualified_input_sees_only_what_lasts(chip: Chip) -> None:
    # GPACTRL.QUALPRD0 = 50: a sample every 100 cycles; QSEL 2: six equal samples, so 500 cycles at least.
    for high, seen in ((300, {0}), (800, {0, 1})):
        chip = Chip(rng=Random(0))
        chip.cpu.eallow = True
        write(chip, "GpioCtrlRegs.GPACTRL", 50)
        write(chip, "GpioCtrlRegs.GPAQSEL1", 2)
        square(chip, period=5_000, high=high)
        levels = set()
        for _ in range(400):
            chip.clock.advance_to(chip.clock.now + 70)
            levels.add(read(chip, "GpioDataRegs.GPADAT") & 1)
        assert levels == seen


@pytest.mark.parametrize(("jumpers", "counts"), [({20: 0, 21: 1}, 200), ({20: 1, 21: 0}, 0xFFFFFFFF - 200 + 1)])
def test_two_outputs_in_quadrature_turn_an_eqep(chip: Chip, jumpers: dict[int, int], counts: int) -> None:
    # Up-down, TBPRD = 2000 TBCLK of one cycle: A is high while counting up, B while CTR > 1000, a quarter later.
    # 4000 cycles a period give four edges: 200 in 200000 cycles.
    square(chip)
    write(chip, "EPwm1Regs.TBCTL", 1 << 3 | 3)
    write(chip, "EPwm1Regs.TBCTR", 0)
    write(chip, "EPwm1Regs.TBPRD", 2_000)
    write(chip, "EPwm1Regs.CMPA", 1_000 << 16)
    write(chip, "EPwm1Regs.AQCTLA", SET << ZRO | CLEAR << PRD)
    write(chip, "EPwm1Regs.AQCTLB", SET << CAU | CLEAR << CAD)
    write(chip, "GpioCtrlRegs.GPAMUX1", 1 | 1 << 2)
    for to, source in jumpers.items():
        chip.pins[to].follow("jumper", chip.pins[source])
    write(chip, "GpioCtrlRegs.GPAMUX2", 1 << 8 | 1 << 10)  # GPIO20, 21: EQEP1A, B
    write(chip, "CpuSysRegs.PCLKCR4", 1)
    write(chip, "EQep1Regs.QPOSMAX", 0xFFFFFFFF)
    write(chip, "EQep1Regs.QEPCTL", 1 << 3)
    write(chip, "EPwm1Regs.TBCTL", 1 << 3 | 2)
    chip.clock.advance_to(chip.clock.now + 8_500)
    before, events = read(chip, "EQep1Regs.QPOSCNT"), chip.clock.events_run
    chip.clock.advance_to(chip.clock.now + 200_000)
    assert read(chip, "EQep1Regs.QPOSCNT") - before & 0xFFFFFFFF == counts
    assert read(chip, "EQep1Regs.QFLG") & 1 << 2 == 0  # no phase error
    # An edge of the output, and a look of the decoder.
    assert chip.clock.events_run - events == 2 * 200


def test_up_counts_of_one_output_measure_its_frequency(chip: Chip) -> None:
    # QSRC = 2: A alone clocks upwards; XCR = 1: its rising edges.  1000 cycles a period: 50 in 50000 and a bit.
    square(chip)
    chip.pins[20].follow("jumper", chip.pins[0])
    write(chip, "GpioCtrlRegs.GPAMUX2", 1 << 8)
    write(chip, "CpuSysRegs.PCLKCR4", 1)
    write(chip, "EQep1Regs.QPOSMAX", 0xFFFFFFFF)
    write(chip, "EQep1Regs.QDECCTL", 2 << 14 | 1 << 11)
    write(chip, "EQep1Regs.QEPCTL", 1 << 3)
    chip.clock.advance_to(chip.clock.now + 50_500)
    assert read(chip, "EQep1Regs.QPOSCNT") == 50


def test_both_phases_at_once_are_a_phase_error_and_trip_by_tz4(chip: Chip) -> None:
    square(chip)
    for pin in (20, 21):
        chip.pins[pin].follow("jumper", chip.pins[0])
    write(chip, "GpioCtrlRegs.GPAMUX2", 1 << 8 | 1 << 10)
    write(chip, "CpuSysRegs.PCLKCR4", 1)
    write(chip, "EQep1Regs.QPOSMAX", 0xFFFFFFFF)
    write(chip, "EQep1Regs.QEPCTL", 1 << 3)
    write(chip, "EPwm1Regs.TZCTL", 2)
    write(chip, "EPwm1Regs.TZSEL", 1 << 11)  # OSHT4
    chip.clock.advance_to(chip.clock.now + 10_000)
    assert (read(chip, "EQep1Regs.QPOSCNT"), read(chip, "EQep1Regs.QFLG") & 1 << 2) == (0, 1 << 2)
    assert (read(chip, "EPwm1Regs.TZFLG"), read(chip, "EPwm1Regs.TZOSTFLG")) == (1 << 2, 1 << 3)
    assert chip.pwm_outputs["GPIO0"].duty == 0.0
    write(chip, "EQep1Regs.QCLR", 1 << 2)
    write(chip, "EPwm1Regs.TZCLR", 1 << 2)
    assert read(chip, "EPwm1Regs.TZFLG") == 0


def test_a_released_output_leaves_its_pin_to_the_pull(chip: Chip) -> None:
    square(chip)
    write(chip, "GpioCtrlRegs.GPAPUD", ALL & ~1)
    chip.clock.advance_to(chip.clock.now + 10_500)
    assert (chip.pins[0].level, chip.pwm_outputs["GPIO0"].duty) == (0, 0.3)
    write(chip, "EPwm1Regs.TZFRC", 1 << 2)  # TZCTL.TZA = 0: high impedance
    assert (chip.pins[0].level, chip.pins[0].driven()) == (1, False)
    assert (chip.pwm_outputs["GPIO0"].duty, chip.pwm_outputs["GPIO0"].period_cycles) == (1.0, 0)
    write(chip, "EPwm1Regs.TZCLR", 1 << 2)
    assert (chip.pins[0].level, chip.pwm_outputs["GPIO0"].duty) == (0, 0.3)
    assert not list(chip.findings)


def test_an_output_against_another_driver_is_contention(chip: Chip) -> None:
    square(chip)
    chip.clock.advance_to(chip.clock.now + 10_100)
    chip.pins[0].drive("test", 0)
    assert (chip.pins[0].level, chip.pins[0].contention) == (0, True)
    assert read(chip, "GpioDataRegs.GPADAT") & 1 == 0


def test_a_motor_behind_a_dead_band_gets_the_duty_that_is_left(chip: Chip) -> None:
    # 300 of 1000 high, rising edge 40 later: 260.
    square(chip)
    write(chip, "EPwm1Regs.DBRED", 40)
    write(chip, "EPwm1Regs.DBCTL", 2)
    assert chip.pwm_outputs["GPIO0"].duty == pytest.approx(0.26)


DEFINES = "from emulator.device_defines import *\n"
START = """
# drv.c: Start
def Start() -> void:
    InitSysCtrl()
    DINT()
    InitPieCtrl()
    IER = 0x0000
    IFR = 0x0000
    InitPieVectTable()
    EALLOW()
    PieVectTable.{vector1} = Isr1
    PieVectTable.{vector2} = Isr2
    EDIS()
    InitEPwm1Gpio()
    InitEPwm2Gpio()
    EALLOW()
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 0
    EDIS()
    Init()
    EALLOW()
    CpuSysRegs.PCLKCR0.bit.TBCLKSYNC = 1
    EDIS()
    IER |= {line}
    PieCtrlRegs.{enable}.bit.INTx1 = 1
    PieCtrlRegs.{enable}.bit.INTx2 = 1
    EINT()
    ERTM()
"""
WAVE = """
    EPwm{n}Regs.TBPRD = {period}
    EPwm{n}Regs.TBCTR = 0
    EPwm{n}Regs.TBCTL.bit.CTRMODE = TB_COUNT_UPDOWN
    EPwm{n}Regs.TBCTL.bit.PHSEN = TB_DISABLE
    EPwm{n}Regs.TBCTL.bit.HSPCLKDIV = TB_DIV1
    EPwm{n}Regs.TBCTL.bit.CLKDIV = TB_DIV1
    EPwm{n}Regs.CMPCTL.bit.SHDWAMODE = CC_SHADOW
    EPwm{n}Regs.CMPCTL.bit.LOADAMODE = CC_CTR_ZERO
    EPwm{n}Regs.CMPA.bit.CMPA = {period} / 2
    EPwm{n}Regs.AQCTLA.bit.CAU = AQ_SET
    EPwm{n}Regs.AQCTLA.bit.CAD = AQ_CLEAR
"""
BAND_ISR = """
Direction{n}: uint16 = 1
Count{n}: uint32 = 0

# drv.c: Isr{n}
def Isr{n}() -> void:
    if Direction{n} == 1 and EPwm{n}Regs.DBFED.bit.DBFED == 5:
        Direction{n} = 0
    elif Direction{n} == 0 and EPwm{n}Regs.DBFED.bit.DBFED == 0:
        Direction{n} = 1
    if Direction{n} == 1:
        EPwm{n}Regs.DBFED.bit.DBFED += 1
        EPwm{n}Regs.DBRED.bit.DBRED += 1
    else:
        EPwm{n}Regs.DBFED.bit.DBFED -= 1
        EPwm{n}Regs.DBRED.bit.DBRED -= 1
    Count{n} += 1
    EPwm{n}Regs.ETCLR.bit.INT = 1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP3
"""
BAND_INIT = """
    EPwm{n}Regs.DBCTL.bit.OUT_MODE = DB_FULL_ENABLE
    EPwm{n}Regs.DBCTL.bit.POLSEL = {polarity}
    EPwm{n}Regs.DBCTL.bit.IN_MODE = DBA_ALL
    EPwm{n}Regs.DBRED.bit.DBRED = 0
    EPwm{n}Regs.DBFED.bit.DBFED = 0
    EPwm{n}Regs.ETSEL.bit.INTSEL = ET_CTR_ZERO
    EPwm{n}Regs.ETSEL.bit.INTEN = 1
    EPwm{n}Regs.ETPS.bit.INTPRD = ET_3RD
"""


@pytest.mark.parametrize(
    ("polarity", "first", "second"),
    # A in rises, then falls; each time one output changes at once and the other one by the delay later (TRM, figure of
    # the dead-band waveforms): (output, level) of the prompt edge and of the delayed one.
    [
        ("DB_ACTV_HIC", (("B", 0), ("A", 1)), (("A", 0), ("B", 1))),
        ("DB_ACTV_LOC", (("B", 1), ("A", 0)), (("A", 1), ("B", 0))),
        ("DB_ACTV_LO", (("B", 0), ("A", 0)), (("A", 1), ("B", 1))),
        ("DB_ACTV_HI", (("B", 1), ("A", 1)), (("A", 0), ("B", 0))),
    ],
)
def test_a_dead_band_that_an_interrupt_moves_up_and_down(
    polarity: str, first: tuple[tuple[str, int], ...], second: tuple[tuple[str, int], ...]
) -> None:
    # TI's example of the dead band: every third zero event the delay goes one further, between 0 and a maximum.
    # TBCLK = EPWMCLK = SYSCLK / 2; a period is 2 * 500 of them.
    tick, period = 2, 2 * 500 * 2
    init = "".join(
        WAVE.format(n=n, period=500) + BAND_INIT.format(n=n, polarity=polarity) for n in (1, 2)
    )  # fmt: skip
    driver = Driver(
        DEFINES + "".join(BAND_ISR.format(n=n) for n in (1, 2)) + "\n# drv.c: Init\ndef Init() -> void:" + init
        + START.format(vector1="EPWM1_INT", vector2="EPWM2_INT", line="M_INT3", enable="PIEIER3")
    )  # fmt: skip
    driver.Start()
    clock = driver.board.clock
    edges: dict[int, list[tuple[int, str, int]]] = {1: [], 2: []}
    for n in (1, 2):
        for letter, pin in (("A", 2 * n - 2), ("B", 2 * n - 1)):
            def hear(level: int, n: int = n, letter: str = letter) -> None:
                edges[n].append((clock.now, letter, level))

            driver.board.pins[pin].changed.connect(hear)
    clock.advance_to(clock.now - clock.now % period + 40 * period)
    for n in (1, 2):
        waves = [(time, (letter, level)) for time, letter, level in edges[n]]
        for cause in (first, second):
            prompt = [time for time, edge in waves if edge == cause[0]]
            late = [time for time, edge in waves if edge == cause[1]]
            assert [b - a for a, b in pairwise(prompt)] == [period] * (len(prompt) - 1)
            gaps = [b - a for a, b in zip(prompt[1:], late[1:], strict=False)]
            assert all(gap % tick == 0 for gap in gaps)
            delays = [gap // tick for gap in gaps]
            # One more or one less every third period, up to 5 and back to 0.
            assert set(delays) == set(range(6))
            assert {abs(b - a) for a, b in pairwise(delays)} == {0, 1}
            assert {abs(b - a) for a, b in zip(delays, delays[3:], strict=False)} == {1}
    assert driver.linked.objects["drv.Count1"].data[0] >= 12
    assert driver.rules() == []


POLLS = """
# drv.c: Init
def Init() -> void:
    InitSysCtrl()
    InitEPwm1Gpio()
{wave}
# drv.c: Wait
def Wait() -> void:
    while GpioDataRegs.GPADAT.bit.GPIO0 == 0:
        pass
    while GpioDataRegs.GPADAT.bit.GPIO0 == 1:
        pass

# drv.c: WaitForZero
def WaitForZero() -> void:
    while EPwm1Regs.TBSTS.bit.CTRDIR == 1:
        pass
    while EPwm1Regs.TBCTR > 10:
        pass
    while EPwm1Regs.TBSTS.bit.CTRDIR == 0:
        pass
"""


def test_a_program_that_polls_the_pin_of_a_pwm_goes_on_at_its_edges() -> None:
    # A period is 2 * 5000 TBCLK of two cycles; TBPRD / 2 < CTR: high for half of it.
    driver = Driver(DEFINES + POLLS.format(wave=WAVE.format(n=1, period=5000)))
    driver.Init()
    driver.Wait()
    clock = driver.board.clock
    start = clock.now
    for n in range(1, 4):
        driver.Wait()
        assert clock.now - start == pytest.approx(n * 20_000, abs=50)
    driver.WaitForZero()
    assert driver.board.register("EPwm1Regs", "TBSTS").read() & 1 == 1
    assert driver.board.register("EPwm1Regs", "TBCTR").read() < 20
    assert driver.rules() == []


TRIP_ISRS = """
Trips1: uint32 = 0
Trips2: uint32 = 0

# drv.c: Isr1
def Isr1() -> void:
    Trips1 += 1
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP2

# drv.c: Isr2
def Isr2() -> void:
    Trips2 += 1
    EALLOW()
    EPwm2Regs.TZCLR.bit.CBC = 1
    EPwm2Regs.TZCLR.bit.INT = 1
    EDIS()
    PieCtrlRegs.PIEACK.all = PIEACK_GROUP2

# drv.c: Release
def Release() -> void:
    EALLOW()
    EPwm1Regs.TZCLR.bit.OST = 1
    EPwm1Regs.TZCLR.bit.INT = 1
    EDIS()

# drv.c: Init
def Init() -> void:
    EALLOW()
    GpioCtrlRegs.GPAPUD.bit.GPIO12 = 0
    GpioCtrlRegs.GPAQSEL1.bit.GPIO12 = 3
    InputXbarRegs.INPUT1SELECT = 12
    EPwm1Regs.TZSEL.bit.OSHT1 = 1
    EPwm1Regs.TZCTL.bit.TZA = TZ_FORCE_HI
    EPwm1Regs.TZEINT.bit.OST = 1
    EPwm2Regs.TZSEL.bit.CBC1 = 1
    EPwm2Regs.TZCTL.bit.TZA = TZ_FORCE_HI
    EPwm2Regs.TZEINT.bit.CBC = 1
    EDIS()
"""


def test_a_pin_trips_one_module_for_good_and_another_one_cycle_by_cycle() -> None:
    # TI's example of trip zones: TZ1 is GPIO12, tied high; ePWM1 has it as a one-shot, ePWM2 as a cycle-by-cycle trip.
    # Both count up and down in 2 * 5000 TBCLK of two cycles, and are high for half of that.
    source = DEFINES + TRIP_ISRS + "".join(WAVE.format(n=n, period=5000) for n in (1, 2)) + START.format(
        vector1="EPWM1_TZ_INT", vector2="EPWM2_TZ_INT", line="M_INT2", enable="PIEIER2"
    )  # fmt: skip
    driver = Driver(source)
    driver.Start()
    board, clock = driver.board, driver.board.clock
    period = 20_000

    def counts() -> tuple[int, int]:
        objects = driver.linked.objects
        return objects["drv.Trips1"].data[0], objects["drv.Trips2"].data[0]

    def highs(pin: int, cycles: int) -> float:
        """The part of the time in which a pin is high, sampled."""
        seen = []
        for _ in range(cycles // 100):
            clock.advance_to(clock.now + 100)
            seen.append(board.pins[pin].level)
        return sum(seen) / len(seen)

    driver.wait_ms(1)
    assert (highs(0, period), highs(2, period), counts()) == (0.5, 0.5, (0, 0))
    counter = board.register("EPwm2Regs", "TBCTR")
    while counter.read():
        clock.advance_to(clock.now + 1)
    edges: list[tuple[int, int, int]] = []
    start = clock.now
    for pin in (0, 2):
        board.pins[pin].changed.connect(lambda level, pin=pin: edges.append((pin, clock.now - start, level)))
    board.pins[12].drive("test", 0)
    clock.after(2 * period + 5_000, lambda: board.pins[12].drive("test", None))
    clock.advance_to(start + 3 * period)
    # Both are forced high at once.  CTR = 0 releases ePWM2, as soon as the pin is high again: after three periods.
    assert edges == [(0, 0, 1), (2, 0, 1), (2, 3 * period, 0)]
    once, many = counts()
    # The routine of ePWM2 is taken as long as the pin is low, that of ePWM1, which clears nothing, once.
    assert once == 1
    assert many > 50
    assert (highs(0, period), highs(2, period)) == (1.0, 0.5)
    assert counts() == (1, many)
    driver.Release()
    assert highs(0, period) == 0.5
    assert board.register("EPwm1Regs", "TZOSTFLG").read() == 1
    assert board.register("EPwm2Regs", "TZCBCFLG").read() == 1
    assert driver.rules() == []
