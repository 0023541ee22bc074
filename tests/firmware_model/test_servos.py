"""The wheel controllers of servos.c on the emulated bridge and motor: translated firmware, exact encoder edges."""

from __future__ import annotations

from dataclasses import replace

import pytest

from emulator.clock import CYCLES_PER_MS
from emulator.devices.lb1836m import Lb1836m
from emulator.devices.nxt_motor import NxtMotor, NxtMotorParams
from emulator.image import Firmware
from emulator.signals import DutyWire, QuadratureWire
from firmware_model.image import link
from hil.robot.board import RobotBoard

PERIOD_MS = 25
PWM_CYCLES = 10_000  # 20 kHz at 200 MHz


class Wheel:
    """The left wheel: firmware functions closed over one motor."""

    def __init__(self, supply_v: float = 7.4, params: NxtMotorParams | None = None) -> None:
        self.in1, self.in2 = DutyWire("IN1"), DutyWire("IN2")
        self.encoder = QuadratureWire("encoder")
        self.motor = NxtMotor(Lb1836m(self.in1, self.in2, supply_v), self.encoder, params)
        self.now = 0
        self.fw: Firmware = link(
            RobotBoard(),
            modules=("firmware_model.board_support.servos",),
            externs={
                "Encoder_left": lambda: self.encoder.position,
                "Encoder_right": lambda: 0,
                "Duty_EPWM2": self._duty,
            },
        )
        self.fw.servos.Init_Servos(PERIOD_MS)

    def _duty(self, a: float, b: float) -> None:
        self.in1.set(a, PWM_CYCLES)
        self.in2.set(b, PWM_CYCLES)

    def run(self, reference_rad_s: float, periods: int) -> list[float]:
        """The true speed at the end of each servo period."""
        servos = self.fw.servos
        speeds = []
        for _ in range(periods):
            servos.left_action(servos.Rl(reference_rad_s, servos.left_velocity()))
            until = self.now + PERIOD_MS * CYCLES_PER_MS
            self.motor.spin(self.now, until)
            self.now = until
            speeds.append(self.motor.omega_rad_s)
        return speeds


# 0.3 m/s and 0.15 m/s on a wheel of 0.027 m, forward and backward.
@pytest.mark.parametrize("reference", [0.3 / 0.027, 0.15 / 0.027, 2.0, -0.15 / 0.027, -0.3 / 0.027])
def test_a_step_is_within_a_tenth_after_a_quarter_second_and_without_error_after_one(reference: float) -> None:
    speeds = Wheel().run(reference, 80)
    # One edge is 0.0087 rad, so a servo period measures the speed in steps of 0.35 rad/s.
    assert abs(speeds[9] - reference) < max(0.1 * abs(reference), 0.35)
    assert sum(speeds[40:]) / 40 == pytest.approx(reference, rel=0.01)


def test_an_aged_motor_and_a_low_battery_are_compensated() -> None:
    worn = replace(NxtMotorParams(), resistance_ohm=6.7, coulomb_nm=0.03, static_nm=0.045)
    speeds = Wheel(supply_v=7.2, params=worn).run(0.2 / 0.027, 80)
    assert sum(speeds[40:]) / 40 == pytest.approx(0.2 / 0.027, rel=0.01)


def test_a_step_does_not_overshoot_by_more_than_a_tenth() -> None:
    assert max(Wheel().run(0.2 / 0.027, 40)) < 1.1 * 0.2 / 0.027


def test_a_reference_that_cannot_be_reached_does_not_wind_up() -> None:
    wheel = Wheel()
    wheel.run(40.0, 80)  # 1.08 m/s: beyond the motor at 7.4 V
    speeds = wheel.run(5.0, 80)
    assert abs(speeds[19] - 5.0) < 0.5  # half a second later the wheel follows again


def test_a_reference_of_zero_brakes_and_holds() -> None:
    wheel = Wheel()
    wheel.run(0.3 / 0.027, 40)
    speeds = wheel.run(0.0, 40)
    assert (wheel.in1.duty, wheel.in2.duty) == (1.0, 1.0)
    assert speeds[-1] == 0.0
    assert wheel.fw.servos.Left_Integral == 0.0


def test_velocity_is_the_edges_of_the_period_in_radians_per_second() -> None:
    wheel = Wheel()
    wheel.encoder.position = 72  # a tenth of a turn in 25 ms: 2*pi/10/0.025 = 25.13 rad/s
    assert wheel.fw.servos.left_velocity() == pytest.approx(25.1327, rel=1e-5)
    assert wheel.fw.servos.left_velocity() == 0.0


@pytest.mark.parametrize(
    ("action", "duties"),
    [
        (0.0, (1.0, 1.0)),
        (1.0, (1.0, 0.0)),
        (-1.0, (0.0, 1.0)),
        (0.25, (1.0, 0.75)),
        (-0.25, (0.75, 1.0)),
        (3.0, (1.0, 0.0)),
    ],
)
def test_forward_lets_in2_fall_and_backward_in1(action: float, duties: tuple[float, float]) -> None:
    wheel = Wheel()
    wheel.fw.servos.left_action(action)
    assert (wheel.in1.duty, wheel.in2.duty) == duties
