"""A robot on a bench without chip or firmware: motors on plain duty wires, and a driver that sees only what the
firmware could see (encoder edges each 25 ms, sonars in a ring, the bumper)."""

from __future__ import annotations

from math import tau

from emulator.clock import CYCLES_PER_MS, Clock
from emulator.devices.lb1836m import Lb1836m
from emulator.devices.nxt_motor import EDGES_PER_REVOLUTION, NxtMotor, NxtMotorParams
from emulator.signals import DutyWire, QuadratureWire
from hil.world import World, WorldMap

PWM_CYCLES = 10_000  # 20 kHz


def motor(supply_v: float = 7.2, params: NxtMotorParams | None = None) -> NxtMotor:
    bridge = Lb1836m(DutyWire("IN1"), DutyWire("IN2"), supply_v)
    return NxtMotor(bridge, QuadratureWire("encoder"), params)


def act(which: NxtMotor, action: float) -> None:
    """Drive and brake: the driven input stays high, the other one falls for the driven part of the period."""
    which.bridge.in1.set(1.0 + min(action, 0.0), PWM_CYCLES)
    which.bridge.in2.set(1.0 - max(action, 0.0), PWM_CYCLES)


class Wheel:
    """A speed controller in volts: feed-forward and a slow integral."""

    def __init__(self, which: NxtMotor) -> None:
        self.motor = which
        self.reference_rad_s = 0.0
        self.integral = 0.0
        self.position = 0

    def step(self) -> None:
        self.motor.encoder.sync()
        edges = self.motor.encoder.position - self.position
        self.position += edges
        if self.reference_rad_s == 0.0:
            self.integral = 0.0
            act(self.motor, 0.0)
            return
        speed = edges / EDGES_PER_REVOLUTION * tau / 0.025
        error = self.reference_rad_s - speed
        self.integral += 0.05 * error
        volts = 0.5 * self.reference_rad_s + 0.3 * error + self.integral
        volts += 0.8 if self.reference_rad_s > 0 else -0.8
        act(self.motor, max(-1.0, min(1.0, volts / 7.2)))


class Rover:
    """Straight on unless something is ahead; then stop, wait, and turn towards the larger side."""

    def __init__(self, world_map: WorldMap, seed: int | None = None) -> None:
        self.clock = Clock()
        self.world = World(world_map, motor(), motor(), seed=seed)
        self.world.attach(self.clock)
        self.bumps: list[tuple[int, bool]] = []
        self.world.bumper_changed.connect(lambda pressed: self.bumps.append((self.clock.now, pressed)))
        self.wheels = (Wheel(self.world.robot.left), Wheel(self.world.robot.right))
        self.seen_m = {"LEFT": 6.0, "FRONT": 6.0, "RIGHT": 6.0}
        self.turned_at: list[tuple[float, float]] = []  # headings at which each turn began and ended
        self.waited = 0
        self._next = 0
        self._turn_from: float | None = None
        self.clock.after(49 * CYCLES_PER_MS, self._sonar)
        self.clock.after(25 * CYCLES_PER_MS, self._servo)
        self.clock.after(50 * CYCLES_PER_MS, self._navigate)

    def run(self, seconds: float) -> None:
        self.clock.advance_to(self.clock.now + round(seconds * 200e6))

    def _sonar(self) -> None:
        name = ("LEFT", "FRONT", "RIGHT")[self._next % 3]
        self._next += 1
        echo = self.world.range_source(name, self.clock.now)
        while echo is not None and echo.strength < 0.5:
            echo = echo.behind
        self.seen_m[name] = 6.0 if echo is None else max(echo.range_m, 0.1524)
        self.clock.after(49 * CYCLES_PER_MS, self._sonar)

    def _servo(self) -> None:
        for wheel in self.wheels:
            wheel.step()
        self.clock.after(25 * CYCLES_PER_MS, self._servo)

    def _navigate(self) -> None:
        left, front, right = (self.seen_m[name] for name in ("LEFT", "FRONT", "RIGHT"))
        speed, rate = 0.15, 0.0
        if front < 0.45:
            speed = 0.0
            self.waited += 1
            if self.waited > 60:
                speed, rate = 0.1, 1.55 if left > right else -1.55
        else:
            self.waited = 0
            speed = 0.15 if front >= 0.6 else 0.1
            if left < 0.3 <= right:
                rate = -0.035
            elif right < 0.3 <= left:
                rate = 0.035
        if self.world.bumper_pressed:
            speed = rate = 0.0
        heading = self.world.pose.heading_rad
        if abs(rate) > 1.0 and self._turn_from is None:
            self._turn_from = heading
        elif abs(rate) < 1.0 and self._turn_from is not None:
            self.turned_at.append((self._turn_from, heading))
            self._turn_from = None
        for sign, wheel in zip((-1.0, 1.0), self.wheels, strict=True):
            wheel.reference_rad_s = (speed + sign * 0.065 * rate) / 0.027
        self.clock.after(50 * CYCLES_PER_MS, self._navigate)
