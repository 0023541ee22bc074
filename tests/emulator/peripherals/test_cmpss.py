"""Comparator subsystem (TRM, CMPSS): comparators, DACs, hysteresis, digital filters, latches, ramp, sync, locks."""

from __future__ import annotations

from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.chip import CMPSS_INPUT, Chip
from emulator.peripherals.cmpss import COMPARE_CYCLES
from emulator.peripherals.cmpss_filter import DigitalFilter
from emulator.registers.core import ALL

#: COMPCTL.COMPDACE.
ON = 1 << 15
#: CTRIPHSEL and CTRIPOUTHSEL.
SYNCHRONOUS, FILTERED, LATCHED = (choice << 2 | choice << 4 for choice in (1, 2, 3))
#: Volts of a code: VDDA is 3.3 V, of 4096 parts.
LSB_V = 3.3 / 4096


@pytest.fixture
def chip() -> Chip:
    return new_chip()


def new_chip() -> Chip:
    chip = Chip(rng=Random(0), vrefhi_v=2.5, vdda_v=3.3)
    write(chip, "CpuSysRegs", "PCLKCR14", 0xFF)
    return chip


def write(chip: Chip, block: str, register: str, word: int) -> None:
    chip.cpu.eallow = True
    chip.register(block, register).write(word, ALL)


def put(chip: Chip, volts: float, pin: int = 2, adc: str = "A") -> None:
    """A steady voltage on an analog input; ADCINA2 is CMPIN1P."""
    chip.analog[adc][pin].follow("test", lambda _cycles: volts, steady=True)


def outputs(chip: Chip, n: int = 1) -> tuple[int, int, int, int]:
    """CTRIPH, CTRIPOUTH, CTRIPL, CTRIPOUTL."""
    high, low = chip.cmpss[n].high, chip.cmpss[n].low
    return high.trip.level, high.trip_out.level, low.trip.level, low.trip_out.level


def status(chip: Chip, n: int = 1) -> int:
    return chip.register(f"Cmpss{n}Regs", "COMPSTS").read()


def events(chip: Chip) -> int:
    """How many events wait, those of the CPU timers not counted, which run out of reset."""
    timers = set(chip.timers)
    return sum(getattr(callback, "__self__", None) not in timers for callback in chip.clock.waiting())


def later(chip: Chip, cycles: int) -> None:
    chip.clock.advance_to(chip.clock.now + cycles)


@pytest.mark.parametrize("n", CMPSS_INPUT)
def test_each_comparator_compares_its_pin_with_its_dac(chip: Chip, n: int) -> None:
    adc, channel = CMPSS_INPUT[n]
    block = f"Cmpss{n}Regs"
    write(chip, block, "DACHVALS", 2048)
    write(chip, block, "DACLVALS", 1024)
    write(chip, block, "COMPCTL", ON)
    # The DACs have 2048 and 1024 of 4096 parts of 3.3 V.
    for volts, expected in ((0.8, (0, 0, 0, 0)), (0.83, (0, 0, 1, 1)), (1.64, (0, 0, 1, 1)), (1.66, (1, 1, 1, 1))):
        put(chip, volts, channel, adc)
        assert outputs(chip, n) == expected


def test_the_pins_are_those_of_the_data_sheet() -> None:
    # DS, analog subsystem: CMPIN1P ... CMPIN8P.
    names = ("A2", "A4", "B2", "A14", "C4", "C2", "D0", "D2")
    assert [f"{adc}{channel}" for adc, channel in CMPSS_INPUT.values()] == list(names)


def test_what_an_adc_calls_adcin14_is_one_pin_for_all(chip: Chip) -> None:
    write(chip, "Cmpss4Regs", "COMPCTL", ON)
    put(chip, 0.1, 14, "C")
    assert outputs(chip, 4) == (1, 1, 1, 1)


def test_vdac_is_the_other_reference(chip: Chip) -> None:
    write(chip, "Cmpss1Regs", "COMPCTL", ON)
    write(chip, "Cmpss1Regs", "DACHVALS", 2048)
    put(chip, 1.3)
    assert outputs(chip)[0] == 0
    write(chip, "Cmpss1Regs", "COMPDACCTL", 1 << 5)
    # 2048 of 4096 parts of 2.5 V, which the board gives VDAC too.
    assert outputs(chip)[0] == 1


def test_the_negative_input_may_be_a_pin(chip: Chip) -> None:
    write(chip, "Cmpss1Regs", "COMPCTL", ON | 1 << 8 | 1)
    put(chip, 1.0)
    put(chip, 1.1, 3)
    assert outputs(chip) == (0, 0, 0, 0)
    put(chip, 0.9, 3)
    assert outputs(chip) == (1, 1, 1, 1)


def test_inversion_is_of_a_comparator_that_is_on(chip: Chip) -> None:
    # COMPLINV without COMPDACE: what is off trips nothing.
    write(chip, "Cmpss1Regs", "COMPCTL", 1 << 9 | 1 << 1)
    assert outputs(chip) == (0, 0, 0, 0)
    write(chip, "Cmpss1Regs", "COMPCTL", ON | 1 << 9)
    put(chip, 0.1)
    assert outputs(chip) == (1, 1, 0, 0)


def test_a_dac_may_drive_the_pin_of_a_comparator_and_its_step_is_seen_at_once(chip: Chip) -> None:
    seen: list[tuple[int, int]] = []
    chip.cmpss[1].high.trip.changed.connect(lambda level: seen.append((chip.clock.now, level)))
    write(chip, "Cmpss1Regs", "COMPCTL", ON)
    write(chip, "Cmpss1Regs", "DACHVALS", 1000)
    later(chip, 777)
    # The chip drives the wire itself: the emulator's own notion of a step.
    chip.analog["A"][2].drive(lambda _cycles: 1001 * LSB_V, steady=True)
    assert seen == [(777, 1)]
    assert events(chip) == 0


@pytest.mark.parametrize("steps", range(5))
def test_hysteresis_is_twelve_codes_a_step_below_the_threshold(chip: Chip, steps: int) -> None:
    write(chip, "Cmpss1Regs", "COMPHYSCTL", steps)
    write(chip, "Cmpss1Regs", "DACHVALS", 2000)
    write(chip, "Cmpss1Regs", "COMPCTL", ON)
    levels = []
    for code in (2000.5, 2000 - 12 * steps + 0.5, 2000 - 12 * steps - 0.5, 1999.5, 2000.5):
        put(chip, code * LSB_V)
        levels.append(outputs(chip)[0])
    assert levels == [1, 1, 0, 0, 1]


@pytest.mark.parametrize("compare_cycles", [COMPARE_CYCLES, 7])
def test_a_voltage_that_moves_is_looked_at_while_the_comparators_are_on(chip: Chip, compare_cycles: int) -> None:
    chip.cmpss[1].compare_cycles = compare_cycles
    seen: list[tuple[int, int]] = []
    chip.cmpss[1].high.trip.changed.connect(lambda level: seen.append((chip.clock.now, level)))
    # A ramp of 1 V in 1 ms: 1.65 V are at 330 000 cycles.
    chip.analog["A"][2].follow("test", lambda cycles: cycles / 200_000)
    write(chip, "Cmpss1Regs", "DACHVALS", 2048)
    assert events(chip) == 0
    write(chip, "Cmpss1Regs", "COMPCTL", ON)
    later(chip, 400_000)
    assert [level for _, level in seen] == [1]
    assert 330_000 < seen[0][0] <= 330_000 + compare_cycles
    write(chip, "Cmpss1Regs", "COMPCTL", 0)
    assert outputs(chip) == (0, 0, 0, 0)
    # The next sample of both filters, which are settled then.
    later(chip, 1)
    assert events(chip) == 0


def test_reading_the_status_looks_now(chip: Chip) -> None:
    step_cycles = 1_010
    chip.analog["A"][2].follow("test", lambda cycles: 3.0 if cycles >= step_cycles else 0.0)
    write(chip, "Cmpss1Regs", "DACHVALS", 2048)
    write(chip, "Cmpss1Regs", "COMPCTL", ON)
    later(chip, step_cycles)
    # Between two looks (1 000 and 1 200): the filter takes every cycle's sample out of reset.
    assert status(chip) & 1 == 1


# Filter and latch


def filtered(chip: Chip, window: int, threshold: int, prescale: int, control: int = FILTERED) -> None:
    write(chip, "Cmpss1Regs", "DACHVALS", 2048)
    write(chip, "Cmpss1Regs", "CTRIPHFILCLKCTL", prescale - 1)
    write(chip, "Cmpss1Regs", "CTRIPHFILCTL", threshold - 1 << 9 | window - 1 << 4)
    write(chip, "Cmpss1Regs", "COMPCTL", ON | control)


def test_the_filter_wants_its_threshold_of_samples(chip: Chip) -> None:
    filtered(chip, window=32, threshold=32, prescale=1024)
    seen: list[tuple[int, int]] = []
    chip.cmpss[1].high.trip.changed.connect(lambda level: seen.append((chip.clock.now, level)))
    later(chip, 100)
    put(chip, 3.0)
    later(chip, 100_000)
    # Samples are at multiples of 1024; the first high one at 1024, the 32nd at 32 * 1024.
    assert seen == [(32 * 1024, 1)]
    put(chip, 0.0)
    later(chip, 100_000)
    # From 100 100 on: the first low one at 98 * 1024 = 100 352, the 32nd at 129 * 1024.
    assert seen[1:] == [(129 * 1024, 0)]


def test_a_shorter_pulse_does_not_pass(chip: Chip) -> None:
    filtered(chip, window=32, threshold=32, prescale=1024)
    put(chip, 3.0)
    later(chip, 31 * 1024)
    put(chip, 0.0)
    later(chip, 100_000)
    assert status(chip) & 0xFF == 0


def test_an_initialised_filter_has_its_input_at_once(chip: Chip) -> None:
    filtered(chip, window=32, threshold=32, prescale=1024)
    put(chip, 3.0)
    assert outputs(chip)[0] == 0
    write(chip, "Cmpss1Regs", "CTRIPHFILCTL", 1 << 15 | 31 << 9 | 31 << 4)
    assert outputs(chip)[0] == 1
    # FILINIT reads 0.
    assert chip.register("Cmpss1Regs", "CTRIPHFILCTL").read() == 31 << 9 | 31 << 4


def test_the_latch_remembers_until_it_is_cleared_and_the_input_has_gone(chip: Chip) -> None:
    filtered(chip, 1, 1, 1, LATCHED)
    put(chip, 3.0)
    later(chip, 10)
    assert status(chip) & 3 == 3
    write(chip, "Cmpss1Regs", "COMPSTSCLR", 1 << 1)
    assert status(chip) & 3 == 3, "the filter's output still sets it"
    put(chip, 0.0)
    later(chip, 10)
    assert (status(chip) & 3, outputs(chip)[:2]) == (2, (1, 1))
    write(chip, "Cmpss1Regs", "COMPSTSCLR", 1 << 1)
    assert (status(chip) & 3, outputs(chip)[:2]) == (0, (0, 0))


def test_the_asynchronous_path_trips_before_the_latch(chip: Chip) -> None:
    filtered(chip, 32, 32, 1024, LATCHED | 1 << 6)
    put(chip, 3.0)
    assert outputs(chip)[:2] == (1, 1)
    put(chip, 0.0)
    assert outputs(chip)[:2] == (0, 0)


def test_the_low_half_has_its_own_filter_latch_and_clear(chip: Chip) -> None:
    write(chip, "Cmpss1Regs", "DACHVALS", 4095)
    write(chip, "Cmpss1Regs", "CTRIPLFILCTL", 3 << 9 | 3 << 4)
    write(chip, "Cmpss1Regs", "CTRIPLFILCLKCTL", 9)
    write(chip, "Cmpss1Regs", "COMPCTL", ON | 2 << 10 | 3 << 12)
    put(chip, 1.0)
    later(chip, 39)
    assert (status(chip), outputs(chip)) == (0, (0, 0, 0, 0))
    later(chip, 1)
    assert (status(chip), outputs(chip)) == (0x300, (0, 0, 1, 1))
    put(chip, 0.0)
    later(chip, 100)
    assert (status(chip), outputs(chip)) == (0x200, (0, 0, 0, 1))
    write(chip, "Cmpss1Regs", "COMPSTSCLR", 1 << 9)
    assert (status(chip), outputs(chip)) == (0, (0, 0, 0, 0))


@given(
    window=st.integers(1, 32), data=st.data(), period=st.integers(1, 5),
    steps=st.lists(st.integers(1, 60), min_size=1, max_size=12),
)  # fmt: skip
def test_the_filter_is_the_one_that_counts_every_sample(
    window: int, data: st.DataObject, period: int, steps: list[int]
) -> None:
    """Against the manual's picture of it: a FIFO, and a count of it at each sample."""
    # A proper threshold: more than half of the window.
    threshold = data.draw(st.integers(window // 2 + 1, window))
    changes = [sum(steps[: n + 1]) for n in range(len(steps))]
    end = changes[-1] + 40 * period
    fifo, output, latched, level, expected = [0] * window, 0, 0, 0, []
    for cycle in range(1, end + 1):
        level ^= cycle in changes
        if cycle % period == 0:
            fifo = [*fifo[1:], level]
            if fifo.count(1 - output) >= threshold:
                output ^= 1
                expected.append((cycle, output))
            latched |= output
    digital, seen, now, level = DigitalFilter(), [], 0, 0
    digital.set_period(0, period)
    digital.configure(window, threshold)
    pending = list(changes)
    while True:
        # What the module does: an event at the next change of the output or of the input.
        time = min(digital.next_change(), pending[0] if pending else end)
        if time >= end and not pending:
            break
        now, before = time, digital.output
        if pending and now == pending[0]:
            pending.pop(0)
            level ^= 1
        digital.take(now, level)
        if digital.output != before:
            seen.append((now, digital.output))
    digital.settle(end)
    assert seen == [(cycle, out) for cycle, out in expected if cycle < end]
    assert (digital.output, digital.latched) == (output, latched)


# Ramp and sync


def pwm(chip: Chip, n: int, period: int) -> None:
    """An ePWM that counts up in SYSCLK, with EPWMSYNCPER at 0."""
    write(chip, "CpuSysRegs", "PCLKCR2", 1 << n - 1)
    write(chip, "ClkCfgRegs", "PERCLKDIVSEL", 0)
    block = f"EPwm{n}Regs"
    write(chip, block, "HRPCTL", 1 << 1)
    write(chip, block, "TBPRD", period - 1)
    write(chip, block, "TBCTL", 0)
    write(chip, "CpuSysRegs", "PCLKCR0", 1 << 18)
    # TBPRD comes out of its shadow at the counter's first 0.
    later(chip, 2 * period - chip.clock.now % period)


def test_codes_wait_for_the_sync_pulse(chip: Chip) -> None:
    write(chip, "Cmpss1Regs", "COMPDACCTL", 1 << 7 | 2 << 1)
    write(chip, "Cmpss1Regs", "COMPCTL", ON)
    pwm(chip, 3, 1_000)
    write(chip, "Cmpss1Regs", "DACHVALS", 100)
    write(chip, "Cmpss1Regs", "DACLVALS", 200)
    zero = chip.clock.now + 1_000 - chip.epwm[3].regs.TBCTR
    chip.clock.advance_to(zero - 1)
    assert chip.register("Cmpss1Regs", "DACHVALA").read() == 0
    chip.clock.advance_to(zero)
    assert chip.register("Cmpss1Regs", "DACHVALA").read() == 100
    assert chip.register("Cmpss1Regs", "DACLVALA").read() == 200


def test_no_epwm_makes_pulses_that_nobody_wants(chip: Chip) -> None:
    pwm(chip, 3, 1_000)
    assert events(chip) == 0
    write(chip, "Cmpss1Regs", "COMPDACCTL", 1 << 7 | 2 << 1)
    assert events(chip) == 1
    write(chip, "Cmpss1Regs", "COMPDACCTL", 2 << 1)
    chip.clock.advance_to(chip.clock.now + 5_000)
    assert events(chip) == 0


def test_the_sync_pulse_clears_the_latch(chip: Chip) -> None:
    filtered(chip, 1, 1, 1, LATCHED)
    write(chip, "Cmpss1Regs", "COMPSTSCLR", 1 << 2)
    pwm(chip, 1, 1_000)
    put(chip, 3.0)
    put(chip, 0.0)
    later(chip, 5)
    put(chip, 3.0)
    later(chip, 5)
    put(chip, 0.0)
    later(chip, 5)
    assert status(chip) & 3 == 2
    later(chip, 1_000)
    assert status(chip) & 3 == 0


def test_the_ramp_stands_falls_and_trips_to_the_cycle(chip: Chip) -> None:
    seen: list[tuple[int, int]] = []
    chip.cmpss[1].high.trip.changed.connect(lambda level: seen.append((chip.clock.now, level)))
    for register, word in (("RAMPMAXREFS", 40_000), ("RAMPDECVALS", 7), ("RAMPDLYS", 100)):
        write(chip, "Cmpss1Regs", register, word)
    write(chip, "Cmpss1Regs", "COMPDACCTL", 1)
    write(chip, "Cmpss1Regs", "COMPCTL", ON)
    # Until the first pulse it stands at its start; the DAC has the upper twelve bits.
    assert chip.register("Cmpss1Regs", "RAMPSTS").read() == 40_000
    assert chip.register("Cmpss1Regs", "DACHVALA").read() == 40_000 >> 4
    put(chip, 2000.5 * LSB_V)
    pwm(chip, 1, 10_000)
    zero = chip.clock.now + 10_000 - chip.epwm[1].regs.TBCTR
    seen.clear()
    chip.clock.advance_to(zero + 103)
    assert chip.register("Cmpss1Regs", "RAMPSTS").read() == 40_000 - 3 * 7
    chip.clock.advance_to(zero + 9_000)
    # The code comes from 2001 to 2000 when RAMPSTS goes below 2001 * 16 = 32 016: 7 984 / 7 = 1140.6, so in the 1141st
    # step, 100 cycles after 0.  COMPHSTS rises with it, and the ramp goes back to its start, which ends the trip.
    assert seen == [(zero + 100 + 1141, 1), (zero + 100 + 1142, 0)]
    assert chip.register("Cmpss1Regs", "RAMPSTS").read() == 40_000
    write(chip, "Cmpss1Regs", "RAMPMAXREFS", 36_000)
    chip.clock.advance_to(zero + 10_000)
    assert chip.register("Cmpss1Regs", "RAMPMAXREFA").read() == 36_000
    assert chip.register("Cmpss1Regs", "RAMPSTS").read() == 36_000


def test_a_ramp_that_nothing_trips_ends_at_0(chip: Chip) -> None:
    for register, word in (("RAMPMAXREFS", 1_000), ("RAMPDECVALS", 300), ("RAMPDLYS", 0)):
        write(chip, "Cmpss1Regs", register, word)
    write(chip, "Cmpss1Regs", "COMPDACCTL", 1)
    pwm(chip, 1, 1_000)
    zero = chip.clock.now + 1_000 - chip.epwm[1].regs.TBCTR
    values = []
    for cycles in (0, 1, 3, 4, 900):
        chip.clock.advance_to(zero + cycles)
        values.append(chip.register("Cmpss1Regs", "RAMPSTS").read())
    assert values == [1_000, 700, 100, 0, 0]


def test_a_source_that_is_no_epwm_is_told(chip: Chip) -> None:
    write(chip, "Cmpss1Regs", "COMPDACCTL", 1 << 7 | 12 << 1)
    assert [(f.rule, f.object) for f in chip.findings] == [("unmodelled", "Cmpss1Regs.COMPDACCTL.RAMPSOURCE")]


# The module


@pytest.mark.parametrize(
    ("register", "lock", "word"), [("COMPCTL", 1, 2), ("COMPHYSCTL", 2, 2), ("COMPDACCTL", 4, 2),
                                   ("CTRIPHFILCTL", 8, 0x10), ("CTRIPLFILCLKCTL", 8, 2)]
)  # fmt: skip
def test_a_locked_register_drops_writes_until_a_reset(chip: Chip, register: str, lock: int, word: int) -> None:
    write(chip, "Cmpss1Regs", "COMPLOCK", lock)
    write(chip, "Cmpss1Regs", "COMPLOCK", 0)
    assert chip.register("Cmpss1Regs", "COMPLOCK").read() == lock
    write(chip, "Cmpss1Regs", register, word)
    assert chip.register("Cmpss1Regs", register).read() == 0
    assert [(f.rule, f.object) for f in chip.findings] == [("locked", f"Cmpss1Regs.{register}")]
    write(chip, "DevCfgRegs", "SOFTPRES14", 1)
    write(chip, "DevCfgRegs", "SOFTPRES14", 0)
    write(chip, "Cmpss1Regs", register, word)
    assert chip.register("Cmpss1Regs", register).read() == word


def test_a_reset_turns_it_off(chip: Chip) -> None:
    write(chip, "Cmpss2Regs", "COMPCTL", ON | SYNCHRONOUS)
    put(chip, 3.0, 4)
    assert outputs(chip, 2) == (1, 1, 1, 1)
    write(chip, "DevCfgRegs", "SOFTPRES14", 1 << 1)
    assert (outputs(chip, 2), status(chip, 2)) == ((0, 0, 0, 0), 0)
    assert not list(chip.findings)


def test_without_its_clock_it_is_deaf(chip: Chip) -> None:
    write(chip, "CpuSysRegs", "PCLKCR14", 0xFE)
    write(chip, "Cmpss1Regs", "COMPCTL", ON)
    assert [f.rule for f in chip.findings] == ["clock-gated"]
