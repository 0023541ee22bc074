"""LB1836M dual H-bridge: one of its two channels, between two PWM inputs and a motor winding.

Modelled
    The truth table (IN1 IN2: 00 outputs off, 10 forward, 01 reverse, 11 brake); PWM on either or both inputs,
    averaged exactly over one period of a winding (R, L) with constant back-EMF, in continuous and in
    discontinuous conduction.  With drive/brake the current decays slowly through transistor and diode.  With
    drive/coast it decays fast through two diodes into the supply, so that the mean current of a fast PWM is small and
    far from proportional to the duty.  Saturation voltage that grows with current; the knee and the limit of the
    current.
Not modelled
    Thermal shutdown, supply droop, the 1 A limit shared by ground pin, standby current, switching times,
    torque ripple inside a PWM period, electrical transients between duties (L/R is about 1 ms, the shaft takes more
    than 40).  When both inputs carry PWM of different duty, the off time is a mixture whose decay voltage is the
    time-weighted mean.
Time
    None of its own: the mean over a PWM period is computed when the plant is integrated.
Sources
    LB (truth table, saturation 0.40 V at 400 mA, abs. max 1.0 A, supply 2.5-9 V); sister LB1843V for low currents.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, log1p
from typing import Final

from emulator.signals import DutyWire

#: LB recommended operating range of VS; 10.5 V is the absolute maximum.
SUPPLY_MIN_V: Final = 2.5
SUPPLY_MAX_V: Final = 9.0
#: Passes that settle pulses of both signs in one period; each pass shrinks the error by the duty.
PASSES: Final = 8


@dataclass(frozen=True, slots=True)
class Lb1836mParams:
    """Values of the data sheet, and CHOICEs where it gives none.

    `saturation_ohm`: upper plus lower drop per ampere (0.40 V at 400 mA).  `diode_v`: one spark-killer diode.
    `brake_v`: transistor plus diode met by a freewheeling current while braking.
    """

    saturation_ohm: float = 1.0
    #: CHOICE: drop per ampere beyond the knee; LB only says that it grows.
    knee_ohm: float = 3.0
    knee_a: float = 0.5
    #: CHOICE: the current stays below LB's absolute maximum; the part droops and shuts down by heat instead.
    limit_a: float = 1.0
    #: CHOICE: ordinary silicon junction; LB gives no figure.
    diode_v: float = 0.8
    #: CHOICE: a back-EMF below this is hardly braked (bipolar bridge).
    brake_v: float = 0.4


class Lb1836m:
    """One channel: `current(emf, resistance, inductance)` is the mean winding current for the present inputs.

    For the bus: the duty wires IN1 and IN2 (their PWM periods start together; the high part comes first).
    For the world: `supply_v`, and `current`, which the motor calls.
    """

    __slots__ = (
        "_a", "_a_gone", "_duty1", "_duty2", "_g", "_g_gone", "_inductance_h", "_knee_a", "_off_share", "_off_v",
        "_on_s", "_period", "_period_s", "_resistance_ohm", "_supply_v", "_tau_s", "_total",
        "coast", "drive", "in1", "in2", "params", "polarity", "supply_v",
    )  # fmt: skip

    def __init__(self, in1: DutyWire, in2: DutyWire, supply_v: float, params: Lb1836mParams | None = None) -> None:
        if not SUPPLY_MIN_V <= supply_v <= SUPPLY_MAX_V:
            raise ValueError(f"LB1836M supply {supply_v} V: must lie within {SUPPLY_MIN_V}..{SUPPLY_MAX_V} V")
        self.in1 = in1
        self.in2 = in2
        self.supply_v = supply_v
        self.params = params or Lb1836mParams()
        self.drive = 0.0  # fraction of the period with exactly one input high
        self.coast = 1.0  # fraction with both low
        self.polarity = 1.0  # +1: OUT1 high while driving
        self._duty1 = self._duty2 = -1.0
        self._period = -1
        self._resistance_ohm = self._inductance_h = self._supply_v = self._total = 0.0
        self._knee_a = 0.0
        self._a = self._g = 1.0
        self._a_gone = self._g_gone = self._off_share = 0.0
        self._on_s = self._period_s = self._tau_s = self._off_v = 0.0

    def current(self, emf_v: float, resistance_ohm: float, inductance_h: float) -> tuple[float, float]:
        """Mean current in A (positive into OUT1) and its slope dI/dEMF in A/V at this back-EMF."""
        in1, in2 = self.in1, self.in2
        period = in1.period_cycles or in2.period_cycles
        if (
            in1.duty != self._duty1 or in2.duty != self._duty2 or period != self._period
            or self.supply_v != self._supply_v or resistance_ohm != self._resistance_ohm
            or inductance_h != self._inductance_h
        ):  # fmt: skip
            self._latch(period, resistance_ohm, inductance_h)
        emf = emf_v * self.polarity
        drive = self.drive
        if drive <= 0.0:
            amps, slope = self._off(emf, self._total)
        elif drive >= 1.0 or self._period_s <= 0.0:
            amps, slope = self._ccm(emf, self._total, drive)
        else:
            amps, slope = self._switched(emf, self._total)
        if amps > self._knee_a or amps < -self._knee_a:
            amps, slope = self._limited(amps, slope, self._total)
        return amps * self.polarity, slope

    def _latch(self, period_cycles: int, resistance: float, inductance: float) -> None:
        """Compute the values that depend only on the duties, the supply and the winding."""
        self._duty1, self._duty2 = duty1, duty2 = self.in1.duty, self.in2.duty
        self._period = period_cycles
        self._resistance_ohm, self._inductance_h, self._supply_v = resistance, inductance, self.supply_v
        both = min(duty1, duty2)
        self.drive = drive = abs(duty1 - duty2)
        self.coast = coast = 1.0 - max(duty1, duty2)
        self.polarity = -1.0 if duty2 > duty1 else 1.0
        off = 1.0 - drive
        coast_v = self.supply_v + 2.0 * self.params.diode_v
        self._off_v = (both * self.params.brake_v + coast * coast_v) / off if off > 0.0 else 0.0
        self._off_share = off
        self._knee_a = self.params.knee_a
        self._total = resistance + self.params.saturation_ohm
        self._tau_s = inductance / self._total
        self._period_s = period_cycles * 5e-9
        self._on_s = drive * self._period_s
        self._a = exp(-self._on_s / self._tau_s)
        self._g = exp(-off * self._period_s / self._tau_s)
        self._a_gone, self._g_gone = 1.0 - self._a, 1.0 - self._g

    def _off(self, emf: float, total: float) -> tuple[float, float]:
        """The current while the winding is not driven: it brakes, coasts, or alternates between the two.

        While it coasts, only a motor that is turned from outside conducts.
        """
        share = 1.0 - self.coast
        threshold = self.params.brake_v if share > 0.0 else self._off_v
        share = share if share > 0.0 else 1.0
        if emf > threshold:
            return -share * (emf - threshold) / total, -share / total
        if emf < -threshold:
            return -share * (emf + threshold) / total, -share / total
        return 0.0, 0.0

    def _ccm(self, emf: float, total: float, drive: float) -> tuple[float, float]:
        """The current in continuous conduction, positive or negative; zero in between."""
        off = 1.0 - drive
        forward = (drive * self.supply_v - off * self._off_v - emf) / total
        if forward > 0.0:
            return forward, -1.0 / total
        regenerated = (drive * (self.supply_v + 2.0 * self.params.diode_v) + off * self._off_v - emf) / total
        if regenerated < 0.0:
            return regenerated, -1.0 / total
        return 0.0, 0.0

    def _switched(self, emf: float, total: float) -> tuple[float, float]:
        """The periodic steady state of the winding under PWM.  It is exact while the current keeps its sign."""
        a_gone, g_gone, tau, period = self._a_gone, self._g_gone, self._tau_s, self._period_s
        on = (self.supply_v - emf) / total  # where the current heads while driven
        fall = (self._off_v + emf) / total  # minus where it heads while off
        if on * a_gone * self._g >= fall * g_gone:  # its minimum stays above zero
            return (self.drive * on - self._off_share * fall), -1.0 / total
        back = (emf - self._off_v) / total  # a back-EMF above the decay voltage drives current while off
        rise = (self.supply_v + 2.0 * self.params.diode_v - emf) / total
        if back > 0.0 and back * g_gone * self._a >= rise * a_gone:
            return self.drive * rise - self._off_share * back, -1.0 / total
        if back <= 0.0:
            if on <= 0.0:
                return 0.0, 0.0
            peak = on * a_gone
            ratio = peak / fall
            decay = tau * log1p(ratio)
            # charge of the pulse: the voltage integral over R, because the current returns to zero
            amps = on * self.drive - fall * decay / period
            decay_slope = -tau / (1.0 + ratio) * (a_gone * fall + peak) / (fall * fall * total)
            return amps, (-self.drive - decay / period) / total - fall * decay_slope / period
        amps = self._both_signs(on, fall, back, rise)
        nudge = 1e-4 / total
        return amps, (self._both_signs(on - nudge, fall + nudge, back + nudge, rise - nudge) - amps) / 1e-4

    def _both_signs(self, on: float, fall: float, back: float, rise: float) -> float:
        """Mean current when a positive pulse follows each drive and a negative one each off time."""
        tau, period, on_s = self._tau_s, self._period_s, self._on_s
        off_s = period - on_s
        held = before = 0.0  # part of the drive time that only brings the negative current back to zero
        decay = 0.0
        for _ in range(PASSES):
            before = held
            if on > 0.0:
                decay = tau * log1p(on * (1.0 - exp(-(on_s - held) / tau)) / fall)
                if decay > off_s:
                    decay = off_s
            held = tau * log1p(back * (1.0 - exp(-(off_s - decay) / tau)) / rise)
            if held > on_s:
                held = on_s
            if held == before:
                break
        positive = (on * (on_s - before) - fall * decay) / period if on > 0.0 else 0.0
        return positive - (back * (off_s - decay) - rise * held) / period

    def _limited(self, amps: float, slope: float, total: float) -> tuple[float, float]:
        """Beyond the knee the drop grows faster; the limit is hard."""
        params = self.params
        ratio = total / (total - params.saturation_ohm + params.knee_ohm)
        excess = (abs(amps) - params.knee_a) * ratio
        limited = params.knee_a + excess
        if limited >= params.limit_a:
            return (params.limit_a if amps > 0.0 else -params.limit_a), 0.0
        return (limited if amps > 0.0 else -limited), slope * ratio
