"""LEGO NXT servo motor 9842 with its optical encoder; all quantities are referred to the output shaft.

Modelled
    Winding resistance and inductance (through the bridge's mean current), torque and back-EMF constants,
    Coulomb, static and viscous friction, rotor inertia, spread between individual motors, the encoder's 720 edges
    a revolution at their own times.
Not modelled
    Backlash of the gears (several degrees), the protecting thermistor, winding heat, cogging, encoder phase and
    duty errors, current ripple.
Time
    The owner of the shaft (a robot's chassis, or `spin` for a shaft in the air) integrates between two virtual times;
    the times of edges in between follow from constant acceleration.
Sources
    NXT: 170 rpm and 60 mA at 9 V unloaded, stall 0.50 N.m, 180 lines a revolution on each channel; R, Kt, Kb fitted
    at 8.5 V.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import expm1, floor, pi, sqrt
from random import Random
from typing import Final

from emulator.clock import SYSCLK_HZ
from emulator.devices.lb1836m import Lb1836m
from emulator.signals import QuadratureWire

#: NXT: 180 lines a revolution on each channel, four edges a line.
EDGES_PER_REVOLUTION: Final = 720
_EDGES_PER_RAD: Final = EDGES_PER_REVOLUTION / (2.0 * pi)


@dataclass(frozen=True, slots=True)
class NxtMotorParams:
    """Output-shaft parameters.  The defaults are CHOICEs between published fits that contradict each other
    (R 4.5 to 6.7 ohm, Kb 0.468 to 0.483): they meet the no-load speeds within 4 % and the stall torque within 6 %.
    """

    resistance_ohm: float = 6.0
    inductance_h: float = 8e-3
    torque_nm_per_a: float = 0.317
    back_emf_v_s: float = 0.478
    coulomb_nm: float = 0.016
    #: Breakaway: 8 to 12 % duty at 9 V unloaded, about 40 % with 0.115 N.m, both through the bridge's drops.
    static_nm: float = 0.030
    viscous_nm_s: float = 3e-4
    inertia_kg_m2: float = 1.3e-3

    def individual(self, random: Random, spread: float = 0.04) -> NxtMotorParams:
        """One motor out of a box: constants within +-`spread` of these, friction within five times that."""

        def vary(value: float, by: float) -> float:
            return value * (1.0 + random.uniform(-by, by))

        coulomb = vary(self.coulomb_nm, 5.0 * spread)
        return replace(
            self,
            resistance_ohm=vary(self.resistance_ohm, spread),
            torque_nm_per_a=vary(self.torque_nm_per_a, spread),
            back_emf_v_s=vary(self.back_emf_v_s, spread),
            coulomb_nm=coulomb,
            static_nm=max(coulomb, vary(self.static_nm, 5.0 * spread)),
        )


class NxtMotor:
    """Motor, gear and encoder.  Positive current turns the shaft in the positive sense; then A leads B.

    For the bus: the bridge's duty wires and `encoder`.  For the world: `angle_rad`, `omega_rad_s`, `torque_line`,
    `turn`.
    """

    __slots__ = (
        "_edge", "_last_edge_cycles", "angle_rad", "bridge", "encoder", "omega_rad_s", "params", "second_cycles",
    )  # fmt: skip

    def __init__(self, bridge: Lb1836m, encoder: QuadratureWire, params: NxtMotorParams | None = None) -> None:
        self.bridge = bridge
        self.encoder = encoder
        self.params = params or NxtMotorParams()
        self.omega_rad_s = 0.0
        #: The length of a second in cycles.  It differs from the nominal one if the chip's oscillator is wrong.
        self.second_cycles = float(SYSCLK_HZ)
        #: The shaft starts half an edge into the first count, so that a shaft at rest is not just at an edge.
        self.angle_rad = 0.5 / _EDGES_PER_RAD
        self._edge = 0
        self._last_edge_cycles = 0

    @property
    def current_a(self) -> float:
        """Mean winding current at the present speed and inputs."""
        params = self.params
        emf = params.back_emf_v_s * self.omega_rad_s
        return self.bridge.current(emf, params.resistance_ohm, params.inductance_h)[0]

    def torque_line(self, omega_rad_s: float) -> tuple[float, float]:
        """Torque near this speed as `intercept - slope * omega`, in N.m and N.m.s, without dry friction.

        It is exact where the bridge conducts continuously; elsewhere it is the tangent.
        """
        params = self.params
        kb, kt = params.back_emf_v_s, params.torque_nm_per_a
        amps, amps_per_v = self.bridge.current(kb * omega_rad_s, params.resistance_ohm, params.inductance_h)
        slope = -kt * kb * amps_per_v
        return kt * amps + slope * omega_rad_s, slope + params.viscous_nm_s

    def turn(self, delta_rad: float, start_cycles: int, end_cycles: int, omega_start_rad_s: float) -> None:
        """Report the edges of a turn by `delta_rad`, one way, at constant acceleration from `omega_start_rad_s`."""
        angle = self.angle_rad
        after = angle + delta_rad
        self.angle_rad = after
        edge = floor(after * _EDGES_PER_RAD)
        edges = edge - self._edge
        if not edges:
            return
        if edges > 0:
            first, last = self._edge + 1, edge
        else:
            first, last = self._edge, edge + 1
        self._edge = edge
        span = end_cycles - start_cycles
        reach = omega_start_rad_s * span / self.second_cycles  # angle at the initial speed
        bend = delta_rad - reach
        last_at = start_cycles + round(span * _fraction(last / _EDGES_PER_RAD - angle, delta_rad, reach, bend))
        before = self._last_edge_cycles
        self._last_edge_cycles = last_at
        if first == last:
            self.encoder.move(edges, before, last_at)
            return
        first_at = start_cycles + round(span * _fraction(first / _EDGES_PER_RAD - angle, delta_rad, reach, bend))
        begin = first_at - (last_at - first_at) // (abs(edges) - 1)
        if begin < before:  # equal spacing would reach back beyond the edge before: the first one goes alone
            one = 1 if edges > 0 else -1
            self.encoder.move(one, before, first_at)
            edges -= one
            begin = first_at
        self.encoder.move(edges, begin, last_at)

    def spin(self, start_cycles: int, end_cycles: int, load_nm: float = 0.0, max_step_s: float = 0.005) -> None:
        """Integrate a shaft with only its rotor and a constant opposing `load_nm` (>= 0)."""
        params = self.params
        dry = params.coulomb_nm + load_nm
        total = (end_cycles - start_cycles) / self.second_cycles
        if total <= 0.0:
            return
        steps = max(1, -floor(-total / max_step_s))
        now = start_cycles
        for index in range(1, steps + 1):
            until = start_cycles + (end_cycles - start_cycles) * index // steps
            while now < until:
                now = self._spin_step(now, until, dry, params.static_nm + load_nm)

    def _spin_step(self, now: int, until: int, dry_nm: float, static_nm: float) -> int:
        """One step, cut short where the shaft stops; returns the time reached."""
        omega = self.omega_rad_s
        torque, slope = self.torque_line(omega)
        if omega == 0.0:
            if abs(torque) <= static_nm:
                return until
            sense = 1.0 if torque > 0.0 else -1.0
        else:
            sense = 1.0 if omega > 0.0 else -1.0
        inertia = self.params.inertia_kg_m2
        span = (until - now) / self.second_cycles
        rate = slope / inertia
        final = (torque - sense * dry_nm) / slope
        after, delta = _relax(omega, final, rate, span)
        reached = until
        if after * sense < 0.0:
            low, high = 0.0, span
            for _ in range(40):
                middle = 0.5 * (low + high)
                if _relax(omega, final, rate, middle)[0] * sense < 0.0:
                    high = middle
                else:
                    low = middle
            reached = min(until, now + max(1, round(high * self.second_cycles)))
            delta = _relax(omega, final, rate, high)[1]
            after = 0.0
        self.omega_rad_s = after
        self.turn(delta, now, reached, omega)
        return reached


def _relax(start: float, final: float, rate: float, span_s: float) -> tuple[float, float]:
    """Exponential approach: value after `span_s`, and its integral."""
    gone = -expm1(-rate * span_s)
    return start + (final - start) * gone, final * span_s + (start - final) * gone / rate


def _fraction(distance: float, delta: float, reach: float, bend: float) -> float:
    """The fraction `u` of the span at which `reach * u + bend * u * u` passes `distance`; linear if it turns back."""
    under = reach * reach + 4.0 * bend * distance
    if under >= 0.0:
        root = sqrt(under)
        divisor = reach + (root if delta > 0.0 else -root)
        if divisor:
            fraction = 2.0 * distance / divisor
            if 0.0 <= fraction <= 1.0:
                return fraction
    return min(1.0, max(0.0, distance / delta))
