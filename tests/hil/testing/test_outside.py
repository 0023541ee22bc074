"""The world's side of a board, as tests set it, is what registers, pins and devices then show."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from math import radians
from typing import Any

import pytest

from emulator.clock import SYSCLK_HZ
from emulator.registers.core import ALL
from hil.robot.board import RobotBoard
from hil.testing.outside import Outside
from hil.testing.timeline import NotReached


def start_gyro(board: RobotBoard) -> None:
    """CTRL_REG1: 100 Hz, all axes."""
    board.gyro.write_register(0x20, 0x0F)


def axis(board: RobotBoard, low: int) -> int:
    """A signed output word."""
    word = board.gyro.read_register(low) | board.gyro.read_register(low + 1) << 8
    return word - 0x10000 if word & 0x8000 else word


def test_volts_may_follow_time(board: RobotBoard, outside: Outside, advance: Callable[[float], None]) -> None:
    outside.adc_volts(7, lambda time_s: 2.0 * time_s)
    advance(0.5)
    assert board.analog["A"][7].source.volts(board.clock.now) == pytest.approx(1.0)


def test_sonar_sees_what_is_set_and_the_others_nothing(board: RobotBoard, outside: Outside) -> None:
    outside.sonar_range_m("FRONT", 1.25)
    front = board.sonars.sensors["FRONT"].range_source
    assert front is not None
    echo = front("FRONT", 0)
    assert echo is not None
    assert echo.range_m == 1.25


def test_gyro_rate_in_degrees_is_the_rate_in_radians(
    board: RobotBoard, outside: Outside, advance: Callable[[float], None]
) -> None:
    start_gyro(board)
    outside.gyro_rate_dps(z=-35.0)
    advance(0.3)
    # 8.75 mdps a digit at 250 dps (data sheet): -35 / 0.00875 = -4000
    assert axis(board, 0x2C) == -4000
    outside.gyro_rate_rad_s(x=radians(70.0))
    advance(0.02)
    assert axis(board, 0x28) == 8000


def test_raw_digits_come_one_a_sample_and_the_last_stays(
    board: RobotBoard, outside: Outside, advance: Callable[[float], None]
) -> None:
    start_gyro(board)
    advance(0.3)
    outside.gyro_raw(x=7, z=[-32768, -1, 32767])
    seen = []
    for _ in range(4):
        advance(0.01)
        seen.append((axis(board, 0x28), axis(board, 0x2C)))
    assert seen == [(7, -32768), (7, -1), (7, 32767), (7, 32767)]


def test_a_rate_begins_when_it_is_set_and_ends_given_digits(
    board: RobotBoard, outside: Outside, advance: Callable[[float], None]
) -> None:
    start_gyro(board)
    advance(0.3)
    outside.gyro_raw(z=7)
    # 100 Hz: the sample that is there was taken before, at rest.
    assert axis(board, 0x2C) == 0
    advance(0.01)
    outside.gyro_rate_dps(z=-35.0)
    assert axis(board, 0x2C) == 7
    advance(0.01)
    assert axis(board, 0x2C) == -4000


def test_digits_may_be_given_again_and_again(
    board: RobotBoard, outside: Outside, advance: Callable[[float], None]
) -> None:
    """One board lives through all examples of a property."""
    start_gyro(board)
    for digits in range(2000):
        outside.gyro_raw(z=digits)
    advance(0.3)
    board.gyro.write_register(0x20, 0x0F)
    assert axis(board, 0x2C) == 1999


@pytest.mark.parametrize(("side", "pins"), [("left", (10, 11)), ("right", (62, 63))])
def test_a_wheel_turns_at_the_speed_set(
    board: RobotBoard, outside: Outside, advance: Callable[[float], None], side: str, pins: tuple[int, int]
) -> None:
    encoder = board.encoder_pins[pins]
    outside.wheel_speed_rad_s(side, 6.283185307)
    advance(1.0)
    # One turn: 720 edges, and the phase it began with.
    assert abs(encoder.position - 720) <= 1
    outside.wheel_speed_rad_s(side, -6.283185307)
    advance(2.0)
    assert abs(encoder.position + 720) <= 1


def test_bumper_pulls_its_pin_low(outside: Outside) -> None:
    before = outside.pin(43)
    outside.bumper(True)
    assert (before, outside.pin(43)) == (1, 0)


def test_a_pin_is_driven_and_let_go(board: RobotBoard, outside: Outside) -> None:
    outside.drive_pin(20, 1)
    driven = outside.pin(20)
    outside.drive_pin(20, None)
    assert (driven, outside.pin(20)) == (1, board.pins[20].pull)


@pytest.mark.parametrize(
    ("pin", "function", "said"),
    [
        (28, 1, "GPIO28 is SCIRXDA, which does not see levels: send characters with uart"),
        (17, 1, "GPIO17 is SPISOMIA, which does not see levels: attach a device"),
        (0, 6, "GPIO0 is SDAA, which does not see levels: attach a device"),
        (0, 1, "GPIO0 is EPWM1A, which does not see levels: the module drives it"),
    ],
)
def test_a_pin_of_a_module_is_not_driven_by_levels(
    board: RobotBoard, outside: Outside, pin: int, function: int, said: str
) -> None:
    board.device_functions.GPIO_SetupPinMux(pin, 0, function)
    with pytest.raises(ValueError, match=said):
        outside.drive_pin(pin, 1)
    assert "test" not in board.pins[pin].drivers()
    outside.drive_pin(pin, None)


def test_an_eqep_counts_the_levels_that_a_test_drives(
    board: RobotBoard, outside: Outside, advance: Callable[[float], None]
) -> None:
    board.cpu.eallow = True
    board.register("CpuSysRegs", "PCLKCR4").write(1, ALL)
    board.register("GpioCtrlRegs", "GPAMUX2").write(1 << 8 | 1 << 10, ALL)  # GPIO20, 21: EQEP1A, B
    board.register("EQep1Regs", "QPOSMAX").write(0xFFFFFFFF, ALL)
    board.register("EQep1Regs", "QEPCTL").write(1 << 12 | 1 << 3, ALL)  # PCRM = 1, QPEN
    for pin, level in ((20, 1), (21, 1), (20, 0), (21, 0), (20, 1)):  # A leads B: five edges upwards
        outside.drive_pin(pin, level)
        advance(1e-6)
    assert board.register("EQep1Regs", "QPOSCNT").read() == 5


def test_two_drivers_of_one_pin_are_named(board: RobotBoard, outside: Outside) -> None:
    outside.bumper(True)
    with pytest.raises(ValueError, match="GPIO43 is driven to 0 by touch sensor: two drivers"):
        outside.drive_pin(43, 1)
    assert outside.pin(43) == 0
    outside.drive_pin(43, 0)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda o: o.adc_volts(16, 1.0), "ADC channel 16"),
        (lambda o: o.sonar_range_m("BACK", 1.0), "no sonar 'BACK': LEFT, FRONT, RIGHT"),
        (lambda o: o.wheel_speed_rad_s("middle", 1.0), "no wheel 'middle': left, right"),
    ],
)
def test_what_does_not_exist_is_named(outside: Outside, call: Callable[[Outside], None], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        call(outside)


# Time


def test_advance_is_exact(board: RobotBoard, advance: Callable[[float], None]) -> None:
    advance(0.123456)
    assert board.clock.now == round(0.123456 * SYSCLK_HZ)
    with pytest.raises(ValueError, match="forward"):
        advance(-1.0)


def test_until_stops_at_the_moment(board: RobotBoard, outside: Outside, until: Any, when: Any, later: Any) -> None:
    later(0.0021, lambda: outside.drive_pin(20, 1))
    assert until(when.pin(20, 1)) == 1
    assert board.clock.now == round(0.0021 * SYSCLK_HZ)


def test_the_first_of_two_triggers_ends_the_wait(board: RobotBoard, until: Any, when: Any) -> None:
    assert until(when.pin(20, 1) | when.time(0.004)) == pytest.approx(0.004)
    assert board.clock.now == round(0.004 * SYSCLK_HZ)


def test_a_time_out_says_what_is_the_case(until: Any, when: Any) -> None:
    with pytest.raises(NotReached, match=r"change of GPIO20 to 1 did not come within 0\.001 s .*: GPIO20 is 0"):
        until(when.rises(20), within_s=0.001)


def test_a_register_is_seen_written_also_when_its_clock_comes_on_meanwhile(
    board: RobotBoard, until: Any, when: Any, later: Any
) -> None:
    pclkcr = board.register("CpuSysRegs", "PCLKCR13")

    def clock_and_force() -> None:
        board.cpu.eallow = True
        pclkcr.write(1, ALL)
        board.register("AdcaRegs", "ADCSOC0CTL").write(0x8013, ALL)  # CHSEL 1, ACQPS 19

    later(0.001, clock_and_force)
    assert until(when.written("AdcaRegs.ADCSOC0CTL")) == 0x8013


def test_a_register_that_was_watched_is_as_before(board: RobotBoard, until: Any, when: Any) -> None:
    register = board.register("GpioDataRegs", "GPASET")
    before = register.write
    with pytest.raises(NotReached, match="it was not written"):
        until(when.written("GpioDataRegs.GPASET"), within_s=0.001)
    assert register.write == before


def test_a_field_assignment_writes_the_whole_word(board: RobotBoard, until: Any, when: Any, later: Any) -> None:
    """GPACLEAR reads 0, so the word is the field: GPIO5 is bit 5."""
    later(0.001, lambda: setattr(board.register("GpioDataRegs", "GPACLEAR").bit, "GPIO5", 1))
    assert until(when.written("GpioDataRegs.GPACLEAR", 0x20)) == 0x20


def test_either_of_two_words_of_one_register(board: RobotBoard, until: Any, when: Any, later: Any) -> None:
    later(0.001, lambda: board.register("GpioDataRegs", "GPASET").write(2, ALL))
    assert until(when.written("GpioDataRegs.GPASET", 1) | when.written("GpioDataRegs.GPASET", 2)) == 2


def test_bytes_arrive_at_the_pace_of_the_line(board: RobotBoard, uart: Any, advance: Callable[[float], None]) -> None:
    """Ten bits a character: at 9600 baud 24 characters need 25 ms."""
    line = uart()
    line.send(b"x" * 24)
    advance(0.0249)
    assert line.pending == 1
    advance(0.0002)
    assert line.pending == 0


def test_a_gap_stands_behind_every_byte(board: RobotBoard, uart: Any, advance: Callable[[float], None]) -> None:
    times: list[int] = []
    board.serial_pins[85].sent.connect(lambda frame: times.append(frame.end))
    uart(84, 85, 9600).send(b"abc", gap_s=0.002)
    advance(0.02)
    steps = [b - a for a, b in pairwise(times)]
    assert all(abs(step - (10 / 9600 + 0.002) * SYSCLK_HZ) < 3 for step in steps)
    assert len(times) == 3


def test_a_line_without_speed_is_refused_and_one_that_says_none_has_the_robots(board: RobotBoard, uart: Any) -> None:
    with pytest.raises(pytest.fail.Exception, match=r"uart\(89, 90, 0\): expected more than 0 baud"):
        uart(89, 90, 0)
    assert uart(89, 90) is uart(baud=9600)
