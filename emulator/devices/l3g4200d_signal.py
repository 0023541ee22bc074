"""From angular rate to digits: the analog chain, filters and imperfections of one L3G4200D.

Modelled: sensitivity, saturation, zero-rate level and its drift, sensitivity over temperature, non-linearity, noise
density, settling after turn-on, self test, LPF1, HPF (normal, reference, auto-reset), LPF2 and the four paths.
Not modelled: cross-axis sensitivity, response to acceleration and supply, flicker noise (no figure in the sheet).
Time: one call for each sample, in the order of the samples.
Sources: L3G mechanical characteristics; figure of the output paths; CTRL_REG1, CTRL_REG2, CTRL_REG4, CTRL_REG5.
"""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from emulator.devices.l3g4200d_registers import (
    FULL_SCALE_DPS,
    HPF_HZ,
    INT16_MAX,
    INT16_MIN,
    LPF1_HZ,
    LPF2_HZ,
    NOISE_DENSITY_DPS,
    ODR_HZ,
    SELF_TEST_DPS,
    SENSITIVITY_DPS,
    ZERO_RATE_DPS,
    ZERO_RATE_DPS_PER_C,
    HighPassMode,
)
from emulator.noise import Gaussian

Vector = tuple[float, float, float]
Digits = tuple[int, int, int]

_ZERO: Vector = (0.0, 0.0, 0.0)
_DEG: Final = 180.0 / math.pi

#: A filter has forgotten an input when less than this part of it is left (below one digit of 65536).
_FORGOTTEN: Final = 1e-5


@dataclass(frozen=True, slots=True)
class GyroUnit:
    """The differences of one specimen from the data sheet.  The default is the perfect specimen.

    `zero_rate` and `scale` are fractions, -1..1 for each axis, of the typical zero-rate level and of the 2 %
    sensitivity change over temperature.  `nonlinearity` is such a fraction of 0.2 % of full scale.
    `turn_on_error_dps` is the error at the moment of leaving power-down.
    """

    zero_rate: Vector = _ZERO
    zero_rate_drift: Vector = _ZERO
    scale: Vector = _ZERO
    nonlinearity: Vector = _ZERO
    turn_on_error_dps: Vector = _ZERO
    turn_on_s: float = 0.0
    odr_error: float = 0.0
    noise_density_dps: float = 0.0
    lpf1: bool = False

    @staticmethod
    def drawn(rng: random.Random) -> GyroUnit:
        """A specimen at random.

        CHOICE: uniform within the typical figures; ODR within 3 % (the sheet gives none); turn-on error up to
        170 dps (3 rad/s; a user of a sister part logged 2.7, 3.1 and -5.0 at first), gone linearly within 250-300 ms.
        """

        def axes(limit: float) -> Vector:
            return (rng.uniform(-limit, limit), rng.uniform(-limit, limit), rng.uniform(-limit, limit))

        return GyroUnit(
            zero_rate=axes(1.0),
            zero_rate_drift=axes(1.0),
            scale=axes(1.0),
            nonlinearity=axes(1.0),
            turn_on_error_dps=axes(170.0),
            turn_on_s=rng.uniform(0.25, 0.30),
            odr_error=rng.uniform(-0.03, 0.03),
            noise_density_dps=NOISE_DENSITY_DPS,
            lpf1=True,
        )


class _LowPass1:
    """First order, the pole matched at the sample rate.  CHOICE: the sheet gives no order."""

    __slots__ = ("_gain", "_y")

    def __init__(self, cut_off_hz: float, odr_hz: float) -> None:
        self._gain = 1.0 - math.exp(-2.0 * math.pi * cut_off_hz / odr_hz)
        self._y = 0.0

    def step(self, x: float) -> float:
        self._y += self._gain * (x - self._y)
        return self._y


class _LowPass2:
    """Second-order Butterworth by the bilinear transform.  CHOICE: the sheet gives the cut-off only."""

    __slots__ = ("_a1", "_a2", "_b", "_z1", "_z2")

    def __init__(self, cut_off_hz: float, odr_hz: float) -> None:
        k = math.tan(math.pi * cut_off_hz / odr_hz)
        norm = 1.0 / (1.0 + math.sqrt(2.0) * k + k * k)
        self._b = k * k * norm
        self._a1 = 2.0 * (k * k - 1.0) * norm
        self._a2 = (1.0 - math.sqrt(2.0) * k + k * k) * norm
        self._z1 = self._z2 = 0.0

    def step(self, x: float) -> float:
        bx = self._b * x
        y = bx + self._z1
        self._z1 = 2.0 * bx - self._a1 * y + self._z2
        self._z2 = bx - self._a2 * y
        return y


class _HighPass:
    """First order by the bilinear transform.  CHOICE: the sheet gives the cut-off only."""

    __slots__ = ("_a1", "_b0", "_x", "y")

    def __init__(self, cut_off_hz: float, odr_hz: float) -> None:
        k = math.tan(math.pi * cut_off_hz / odr_hz)
        self._b0 = 1.0 / (1.0 + k)
        self._a1 = (k - 1.0) / (k + 1.0)
        self._x = 0.0
        self.y = 0.0

    def step(self, x: float) -> float:
        self.y = self._b0 * (x - self._x) - self._a1 * self.y
        self._x = x
        return self.y


class SignalPath:
    """The chain of one device.  `configure` restarts the filters whose setting changed."""

    __slots__ = (
        "_element",
        "_fs",
        "_full_scale_dps",
        "_gauss",
        "_hp",
        "_hpm",
        "_key",
        "_lp1",
        "_lp2",
        "_noise",
        "_paths",
        "_perfect",
        "_reference_dps",
        "_self_test_dps",
        "_sensitivity_dps",
        "_temperature_c",
        "_unit",
        "memory_samples",
    )

    def __init__(self, unit: GyroUnit, rng: random.Random, temperature_c: float) -> None:
        self._unit = unit
        self._perfect = unit == GyroUnit()
        self._gauss = Gaussian(rng)
        self._temperature_c = temperature_c
        self._key: tuple[int, ...] = ()
        self._lp1: list[_LowPass1] = []
        self._lp2: list[_LowPass2] = []
        self._hp: list[_HighPass] = []
        self._paths = (0, 0)
        self._fs = 0
        self._full_scale_dps = FULL_SCALE_DPS[0]
        self._sensitivity_dps = SENSITIVITY_DPS[0]
        #: For each axis: gain, weight of the non-linearity, and zero-rate level in dps.
        self._element: tuple[Vector, ...] = ()
        self._hpm = 0
        self._noise = 0.0
        self._reference_dps = 0.0
        self._self_test_dps = 0.0
        #: The number of earlier samples that the present one depends on, to well below a digit.
        self.memory_samples = 0
        self._calibrate()

    def set_temperature(self, temperature_c: float) -> None:
        """Die temperature in degrees Celsius."""
        self._temperature_c = temperature_c
        self._calibrate()

    def configure(self, ctrl1: int, ctrl2: int, ctrl4: int, ctrl5: int, reference: int) -> None:
        """The control registers as stored.

        CHOICE: HPCF above 9 acts as 9; a stage outside both paths (output, interrupt) rests at zero; the reference
        weighs 256 digits per LSB, two's complement (the sheet gives no weight); self test acts alike on all axes.
        """
        dr, bw = ctrl1 >> 6, ctrl1 >> 4 & 3
        hpcf = min(ctrl2 & 0x0F, 9)
        self._hpm = ctrl2 >> 4 & 3
        self._fs = fs = ctrl4 >> 4 & 3
        self._full_scale_dps = FULL_SCALE_DPS[fs]
        self._sensitivity_dps = SENSITIVITY_DPS[fs]
        self._self_test_dps = {0: 0.0, 1: SELF_TEST_DPS[fs], 2: 0.0, 3: -SELF_TEST_DPS[fs]}[ctrl4 >> 1 & 3]
        signed = reference - 256 if reference & 0x80 else reference
        self._reference_dps = signed * 256 * SENSITIVITY_DPS[fs]
        self._paths = (ctrl5 & 3, ctrl5 >> 2 & 3)
        hpen = bool(ctrl5 & 0x10)
        use_lp2 = any(sel & 2 for sel in self._paths)
        use_hp = any(sel == 1 for sel in self._paths) or (hpen and use_lp2)
        key = (dr, bw, hpcf, use_lp2, use_hp, hpen)
        if key != self._key:
            self._key = key
            self._rebuild(dr, bw, hpcf, use_lp2, use_hp)
        self._calibrate()

    def _calibrate(self) -> None:
        """Compute the constants of the element for the present range and temperature."""
        unit = self._unit
        warm = self._temperature_c - 25.0
        self._element = tuple(
            (
                1.0 + 0.02 * unit.scale[axis] * warm / 60.0,
                0.002 * self._full_scale_dps * unit.nonlinearity[axis],
                self.zero_rate_dps(axis),
            )
            for axis in range(3)
        )

    def _rebuild(self, dr: int, bw: int, hpcf: int, use_lp2: bool, use_hp: bool) -> None:
        odr = float(ODR_HZ[dr])
        cut_offs = []
        self._lp1, self._lp2, self._hp = [], [], []
        if self._unit.lpf1:
            cut_offs.append(LPF1_HZ[dr])
            self._lp1 = [_LowPass1(LPF1_HZ[dr], odr) for _ in range(3)]
        if use_lp2:
            cut_offs.append(LPF2_HZ[dr][bw])
            self._lp2 = [_LowPass2(LPF2_HZ[dr][bw], odr) for _ in range(3)]
        if use_hp:
            cut_offs.append(HPF_HZ[dr][hpcf])
            self._hp = [_HighPass(HPF_HZ[dr][hpcf], odr) for _ in range(3)]
        # exp(-2 pi fc n / ODR) = _FORGOTTEN for the slowest pole; a Butterworth pair decays slower by sqrt(2).
        self.memory_samples = sum(
            math.ceil(-math.log(_FORGOTTEN) * odr / (math.sqrt(2.0) * math.pi * fc)) for fc in cut_offs
        )
        # White noise of the stated density fills the band up to ODR / 2; the filters shape it.
        self._noise = self._unit.noise_density_dps * math.sqrt(odr / 2.0)

    def restart(self) -> None:
        """Start the filters from rest, because the chain was off."""
        key = self._key
        if key:
            self._rebuild(key[0], key[1], key[2], bool(key[3]), bool(key[4]))

    def reset_high_pass(self) -> None:
        """REFERENCE was read (HPM = 00) or an interrupt came (HPM = 11): the output restarts from zero."""
        for stage in self._hp:
            stage.y = 0.0

    @property
    def resets_on_reference_read(self) -> bool:
        """HPM = 00."""
        return self._hpm == HighPassMode.NORMAL_RESET

    @property
    def resets_on_interrupt(self) -> bool:
        """HPM = 11."""
        return self._hpm == HighPassMode.AUTO_RESET

    def zero_rate_dps(self, axis: int) -> float:
        """Zero-rate level of `axis` at the present range and temperature."""
        unit = self._unit
        warm = self._temperature_c - 25.0
        return (
            unit.zero_rate[axis] * ZERO_RATE_DPS[self._fs]
            + unit.zero_rate_drift[axis] * ZERO_RATE_DPS_PER_C[self._fs] * warm
        )

    def sample(self, rate_rad_s: Vector, awake_s: float) -> tuple[Digits, Digits]:
        """Digits of the output path and of the interrupt path for one sample.

        `awake_s` is the time since power-down was left.
        """
        unit = self._unit
        settling = 1.0 - awake_s / unit.turn_on_s if awake_s < unit.turn_on_s else 0.0
        values: list[float] = []
        for axis in range(3):
            v = rate_rad_s[axis] * _DEG
            if not self._perfect:
                v = self._imperfect(axis, v) + settling * unit.turn_on_error_dps[axis]
            v += self._self_test_dps
            if self._lp1:
                v = self._lp1[axis].step(v)
            values.append(v)
        if not self._hp and not self._lp2:
            # No stage after the first is active: all positions of both switches give the same value.
            digits = self._digits(values)
            return digits, digits
        taps = [self._taps(axis, v) for axis, v in enumerate(values)]
        out_sel, int_sel = self._paths
        return self._digits([tap[out_sel] for tap in taps]), self._digits([tap[int_sel] for tap in taps])

    def _taps(self, axis: int, v: float) -> tuple[float, float, float, float]:
        """The four inputs of the path switches (Out_Sel, INT1_Sel) for one sample of `axis`."""
        high = low = v
        if self._hp:
            high = self._hp[axis].step(v)
            if self._hpm == HighPassMode.REFERENCE:
                high = v - self._reference_dps
        if self._lp2:
            low = self._lp2[axis].step(high if self._key[5] else v)
        return v, high, low, low

    def _imperfect(self, axis: int, dps: float) -> float:
        """The output of a real element for a rate.

        CHOICE: non-linearity is the third Chebyshev polynomial, the shape whose best-fit line is zero and whose
        error touches the stated bound at both ends and twice between.
        """
        gain, bend_dps, zero_dps = self._element[axis]
        x = dps / self._full_scale_dps
        if x > 1.0:
            x = 1.0
        elif x < -1.0:
            x = -1.0
        bent = bend_dps * (4.0 * x * x - 3.0) * x
        return dps * gain + bent + zero_dps + (self._gauss.value(self._noise) if self._noise else 0.0)

    def _digits(self, dps: Sequence[float]) -> Digits:
        """The three axes in digits of the present range."""
        sensitivity = self._sensitivity_dps
        x, y, z = dps
        return (
            _saturated(round(x / sensitivity)),
            _saturated(round(y / sensitivity)),
            _saturated(round(z / sensitivity)),
        )


def _saturated(digit: int) -> int:
    """The value limited to 16 bits (CHOICE: no figure in the sheet)."""
    return INT16_MAX if digit > INT16_MAX else INT16_MIN if digit < INT16_MIN else digit
