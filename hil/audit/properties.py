"""Properties of the drivers, which must hold for every example.  They are the rules of `emulator.rules.behaviour`.

A property is a function of a rig and one example.  Its evidence is `seen` if the property does not hold.  The
demonstrations of the catalogue use the example that falsifies the faithful firmware; the property tests use any
example.  A rig is used many times, so each property sets everything on which it depends.  Properties of the closed loop
are in `hil.audit.properties_robot`.

The drivers that only move bytes (SPI, SCI, PWM) have no properties here; the peripherals' tests check them.
"""

from __future__ import annotations

import math
import re
import statistics
from collections.abc import Sequence
from typing import Final, NamedTuple

from emulator.devices.lv_maxsonar_beam import Echo
from hil.audit.evidence import Evidence, Picture, Series, measured
from hil.audit.rig import Rig
from hil.golden.scripted_gyro import ScriptedGyro
from hil.robot.board import SONAR_VCC_V, RobotBoard

# us.c

#: The error that remains after the calibration of the measurement (TFG 3.1.1).
ERROR_CM: Final = 2.0
#: The conversions of a reading: 13 in the text.  The code, which uses 12, ignores the last one.
CONVERSIONS: Final = 13
INCH_CM: Final = 2.54
#: The slope and bias of the left sensor, for the sum of 12 conversions divided by 2.3 (TFG 3.1.1, figure 5).
LEFT_CALIBRATION: Final = (0.0551, 4.3516)
_SUM_PER_COUNT: Final = 12 / 2.3
#: The counts of the converter per inch: LV-MaxSonar-EZ gives Vcc / 512 per inch; the converter has 12 bits.
_COUNTS_PER_INCH: Final = SONAR_VCC_V / 512 / RobotBoard.vrefhi_v * 4096


def distance_read(rig: Rig, codes: Sequence[int]) -> float:
    """The distance in cm that the driver computes for the calibrated left sensor if the conversions give `codes`."""
    left = rig.fw.us.US_SENSOR.LEFT
    rig.fw.us.Init_US()
    rig.fw.us.Calibrate_US(left, *LEFT_CALIBRATION)
    rig.codes(iter(codes))
    return float(rig.fw.us.Read_Distance(left))


def outlier_bound(rig: Rig, clean: Sequence[int], index: int, wrong: int) -> Evidence:
    """`outlier-bound`: of 13 conversions `clean` (counts), the one at `index` is replaced by `wrong`.  The distance may
    change by the differences between the others, or by the 2 cm that the text allows (TFG 3.1.1), whichever is more."""
    codes = [*clean[:index], wrong, *clean[index + 1 :]]
    moved = abs(distance_read(rig, codes) - distance_read(rig, clean))
    others = [*clean[:index], *clean[index + 1 :]]
    spread_cm = (max(others) - min(others)) * _SUM_PER_COUNT * LEFT_CALIBRATION[0]
    what = f"sample {index} of {wrong} counts among {min(others)}..{max(others)} moves the distance by"
    return measured(what, moved, "cm", high=max(ERROR_CM, spread_cm))


def distance_scale(rig: Rig, sensor: int, range_m: float) -> Evidence:
    """`distance-scale`: with a wall at `range_m` (0.16 to 6.45 m) and a calibration from the data sheet (a slope of
    Vcc/512 per inch, and half an inch for the truncation), the distance is right within half an inch and one count."""
    rig.board.sonars.set_range_source(lambda _name, _cycles: Echo(range_m))
    rig.codes(None)
    rig.fw.us.Init_US()
    rig.wait(0.6)  # three rounds of the ring: a step upwards falls short in the first
    slope = INCH_CM / (_COUNTS_PER_INCH * _SUM_PER_COUNT)
    rig.fw.us.Calibrate_US(sensor, slope, INCH_CM / 2)
    error = rig.fw.us.Read_Distance(sensor) - 100 * range_m
    bound = INCH_CM / 2 + INCH_CM / _COUNTS_PER_INCH
    return measured(f"error of a distance of {100 * range_m:.2f} cm", error, "cm", low=-bound, high=bound)


def _statistic(rig: Rig, function: str, values: Sequence[float], right: float) -> Evidence:
    # Elements behind the values, so that only reading too many of them is wrong, not where they lie.
    data = rig.fw.array("float32", [*values, *[0.0] * (64 - len(values))])
    result = float(getattr(rig.fw.us, function)(data, len(values)))
    # A float32 sum of n values is off by half a last bit of the greatest partial sum at each addition, and the FPU has
    # no numbers between 0 and 2^-126.
    slack = len(values) * max(map(abs, values)) * 2**-23 + 2**-126
    what = f"{function} of {', '.join(f'{value:g}' for value in values)}"
    return measured(what, result, low=right - slack, high=right + slack)


def median(rig: Rig, values: Sequence[float]) -> Evidence:
    """`wrong-result`: for 1 to 20 float32 values, `median` returns the median (as Python's statistics)."""
    return _statistic(rig, "median", values, statistics.median(values))


def average(rig: Rig, values: Sequence[float]) -> Evidence:
    """`wrong-result`: for float32 values, `average` returns the arithmetic mean (as Python's statistics)."""
    return _statistic(rig, "average", values, statistics.fmean(values))


# GYRO.c

#: The sensitivity at 250 dps, and its change over temperature (L3G4200D table 4).
DPS_PER_DIGIT: Final = 8.75e-3
RAD_S_PER_DIGIT: Final = math.radians(DPS_PER_DIGIT)
SENSITIVITY_SHARE: Final = 0.02
Z: Final = 2


def rate_read(rig: Rig, gyro: ScriptedGyro, axis: int, digits: int, level: int = 0) -> float:
    """The rate in rad/s that get_GYRO returns for a rotation of `digits` above a zero-rate level that it knows."""
    face = rig.fw.gyro
    rig.fw.spi.Init_SPIA()
    face.Z_dc_offset = level if axis == Z else 0
    face.X_Calib_b = face.Y_Calib_b = face.Z_Calib_b = 0.0
    gyro.set_axis(axis, digits + level)
    return float(face.get_GYRO(axis, 0.0 if axis == Z else float(level)))


def rotation_sign(rig: Rig, gyro: ScriptedGyro, axis: int, digits: int, level: int = 0) -> Evidence:
    """`rotation-sign`: for a rotation of `digits` (8.75 mdps each, with either sign, not 0) above a zero-rate level,
    the result has the same sign and is more than half of the rotation.  So an error of the scale does not count as one
    of the sign.  (L3G4200D: two's complement; rotation and level together fit in 16 bits.)"""
    rate = digits * RAD_S_PER_DIGIT
    read = math.copysign(1.0, digits) * rate_read(rig, gyro, axis, digits, level)
    return measured(f"a turn of {rate:+.4f} rad/s reads, in its own direction", read, "rad/s", low=abs(rate) / 2)


def rotation_scale(rig: Rig, gyro: ScriptedGyro, axis: int, digits: int, level: int = 0) -> Evidence:
    """`rotation-scale`: for a rotation of `digits` above a zero-rate level, the result in rad/s is right within half a
    digit and the 2 % by which the sensitivity changes over temperature (L3G4200D table 4)."""
    rate = digits * RAD_S_PER_DIGIT
    bound = SENSITIVITY_SHARE * abs(rate) + RAD_S_PER_DIGIT / 2
    read = rate_read(rig, gyro, axis, digits, level)
    return measured(f"a turn of {rate:+.4f} rad/s reads", read, "rad/s", low=rate - bound, high=rate + bound)


def rotation_bias(rig: Rig, gyro: ScriptedGyro, level: int) -> Evidence:
    """`rotation-bias`: at rest, with a zero-rate level of `level` digits (data sheet: up to 10 degrees/s, which are
    1143), getZ is within one digit of 0 after Init_GYRO."""
    face = rig.fw.gyro
    gyro.set_axis(Z, level)
    face.Z_dc_offset, face.Z_Calib_b = 0, 0.0
    if "aux" in dir(face):
        face.aux = 0  # the sum of the faithful firmware, as after a reset
    face.Init_GYRO()
    return measured(f"Z at rest, zero-rate level {level} digits", face.getZ(), "digits", low=-1, high=1)


# Odometry.c

#: The period of TaskODO in ms.
PERIOD_MS: Final = 250.0
#: The bound for results that are not rounded: more than the error of float32 at 100 mm.
EXACT_MM: Final = 0.05
EXACT_RAD: Final = 1e-4


class SpeedStep(NamedTuple):
    """Constant speeds for some periods of 250 ms."""

    v_m_s: float
    w_rad_s: float
    periods: int = 1


class _Reckoned:
    """Calls Odom_Trayect with a speed for each period, and computes the circular arcs for comparison."""

    def __init__(self, rig: Rig, heading_rad: float, drives: Sequence[SpeedStep]) -> None:
        odometry = rig.fw.new("ODOMETRY_Trayect", X=0.0, Y=0.0, tita=heading_rad, df=0.0, dl=0.0, dr=0.0)
        x = y = 0.0
        self.heading_rad = heading_rad
        self.path, self.true = [(0.0, 0.0)], [(0.0, 0.0)]
        self.way_mm = 0.0
        for v, w, periods in drives:
            turn = w * PERIOD_MS / 1000
            chord = v * PERIOD_MS * (math.sin(turn / 2) / (turn / 2) if turn else 1.0)
            for _ in range(periods):
                rig.fw.odometry.Odom_Trayect(odometry, v, w, 0.0, 0.0, 0.0, PERIOD_MS)
                x += chord * math.cos(self.heading_rad + turn / 2)
                y += chord * math.sin(self.heading_rad + turn / 2)
                self.heading_rad += turn
                self.way_mm += abs(chord)
                self.path.append((odometry.X, odometry.Y))
                self.true.append((x, y))
        self.read_rad = float(odometry.tita)


def odometry_picture(rig: Rig, title: str, heading_rad: float, drives: Sequence[SpeedStep]) -> Picture:
    """The path that Odom_Trayect computes, and the path that was driven."""
    run = _Reckoned(rig, heading_rad, drives)
    lines = [Series(name, *zip(*points, strict=True)) for name, points in
             (("Odom_Trayect", run.path), ("driven", run.true))]  # fmt: skip
    return Picture(title, "X in mm", "Y in mm", lines, plane=True)


def _chord_share(drives: Sequence[SpeedStep]) -> float:
    """The share by which the chord of a step is shorter than its arc: (W T)^2 / 24.  TFG 3.3.2 uses the arc."""
    return max((drive.w_rad_s * PERIOD_MS / 1000) ** 2 / 24 for drive in drives)


def odometry_heading(rig: Rig, heading_rad: float, drives: Sequence[SpeedStep]) -> Evidence:
    """`odometry-path`: the heading (degrees) changes by W times the time (TFG 3.3.2).

    Whole turns are ignored, because they do not change the direction.
    """
    run = _Reckoned(rig, heading_rad, drives)
    error = math.degrees(math.remainder(run.read_rad - run.heading_rad, math.tau))
    return measured("error of the heading", error, "degrees", low=-0.1, high=0.1)


def odometry_distance(rig: Rig, heading_rad: float, drive: SpeedStep) -> Evidence:
    """`unit`: the distance of a period (mm) is V [m/s] times the period [ms], turning or not, except for the chord."""
    run = _Reckoned(rig, heading_rad, [drive._replace(periods=1)])
    bound = EXACT_MM + run.way_mm * _chord_share([drive])
    what = f"way of a period at {drive.v_m_s:g} m/s and {drive.w_rad_s:g} rad/s"
    return measured(what, math.hypot(*run.path[-1]), "mm", low=run.way_mm - bound, high=run.way_mm + bound)


def odometry_course(rig: Rig, heading_rad: float, drive: SpeedStep) -> Evidence:
    """`odometry-path`: the chord of a period has the heading of its middle (rad), also backwards (TFG 3.3.2)."""
    run = _Reckoned(rig, heading_rad, [drive._replace(periods=1)])
    (x, y), (true_x, true_y) = run.path[-1], run.true[-1]
    error = math.remainder(math.atan2(y, x) - math.atan2(true_y, true_x), math.tau)
    what = f"direction of a period at {drive.v_m_s:g} m/s, {drive.w_rad_s:g} rad/s, from {heading_rad:g} rad is off by"
    return measured(what, error, "rad", low=-EXACT_RAD, high=EXACT_RAD)


def odometry_path(rig: Rig, heading_rad: float, drives: Sequence[SpeedStep]) -> Evidence:
    """`odometry-path`: the end of a path is right (mm), within the error of chords and float32: 0.1 mm per metre."""
    run = _Reckoned(rig, heading_rad, drives)
    bound = EXACT_MM + run.way_mm * (EXACT_RAD + _chord_share(drives))
    error = math.dist(run.path[-1], run.true[-1])
    return measured(f"error after {run.way_mm:.0f} mm", error, "mm", high=bound)


# protocol.c

#: The greatest speeds of the robot (TFG 3.2.3).
V_MAX_M_S: Final = 0.3
W_MAX_RAD_S: Final = 1.57
#: The largest coordinate of a frame, which has 16 bits, in mm.
COORDINATE_MM: Final = 32767
_NUMBER: Final = rb"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)"
#: A valid order: `#`, four letters, the end mark; SETR has two numbers before it, with a decimal point and without an
#: exponent, as the console sends them (TFG 3.1.4).
_WELL_FORMED: Final = re.compile(rb"#(?:(STOP|MISN|TELE|CALB|INIT)|(SETR)(%b),(%b))\r" % (_NUMBER, _NUMBER))
_ORDERS: Final = {
    b"STOP": "O_STOP", b"MISN": "O_MISSION", b"TELE": "O_TELEMANIPULATION", b"CALB": "O_CALIBRATION",
    b"INIT": "O_INITIALITATION", b"SETR": "O_SETR",
}  # fmt: skip


def well_formed(frame: bytes) -> bool:
    """Whether a frame, marks included, is an order."""
    return _WELL_FORMED.fullmatch(frame) is not None


def order_read(rig: Rig, frame: bytes) -> Evidence:
    """`malformed-frame`: a frame as Read_Frame returns it (start mark first, end mark last, neither inside, at most 79
    characters) is understood as the order that it is, a malformed frame as none, and there is no finding."""
    match = _WELL_FORMED.fullmatch(frame)
    face = rig.fw.protocol.ORDER
    right = _ORDERS[match[1] or match[2]] if match else "O_ERROR"
    rig.findings.clear()
    taken = face.name(rig.fw.protocol.Interpret_Order(rig.frame(frame.decode("latin-1"))))
    wrong = int(taken != right) + len(rig.findings)
    return measured(f"{frame!r}, {right}, is taken for {taken}: wrong orders and findings", wrong, high=0)


def reference_read(rig: Rig, frame: bytes) -> Evidence:
    """`order-range`: a well-formed SETR sets its speeds (m/s, rad/s), limited to the robot's range (TFG 3.2.3), to six
    digits.  Raises ValueError for another frame."""
    match = _WELL_FORMED.fullmatch(frame)
    if match is None or match[2] is None:
        raise ValueError(f"{frame!r} is not a SETR with two numbers")
    reference = rig.fw.new("REFERENCE", V=0.0, W=0.0)
    rig.fw.protocol.Obtain_Reference(rig.frame(frame.decode("latin-1")), reference)
    errors = [
        abs(getattr(reference, name) - max(-limit, min(limit, float(text))))
        for name, text, limit in (("V", match[3], V_MAX_M_S), ("W", match[4], W_MAX_RAD_S))
    ]
    return measured(f"greatest error of V and W of {frame!r}", max(errors), "m/s or rad/s", high=1e-6)


class MonitorValues(NamedTuple):
    """The values of the monitors: coordinates in mm, heading in rad, distances in cm (0 to 1217 cm: 4095 counts)."""

    x_mm: float = 0.0
    y_mm: float = 0.0
    heading_rad: float = 0.0
    front_cm: float = 0.0
    right_cm: float = 0.0
    left_cm: float = 0.0


def frame_sent(rig: Rig, shown: MonitorValues) -> str:
    """The frame that Send_ODO_Trayect passes to XBee.c."""
    names = ("X", "Y", "tita", "df", "dr", "dl")
    rig.fw.xbee.Tx_Count = 0  # the one before has left
    rig.fw.protocol.Send_ODO_Trayect(rig.fw.new("ODOMETRY_Trayect", **dict(zip(names, shown, strict=True))))
    return "".join(chr(rig.fw.protocol.Aux_Frame[i] & 0xFF) for i in range(rig.fw.xbee.Tx_Count))


def frame_units(rig: Rig, shown: MonitorValues) -> Evidence:
    """`unit`: a frame has the values of the monitors in its units: mm (limited to 16 bits), radians within a degree
    (any whole turns are allowed, because the console only uses sine and cosine, TFG annex 2), and mm, truncated.
    """
    frame = frame_sent(rig, shown)
    fields = re.fullmatch(r"#ODO (-?\d+),(-?\d+),(-?\d+),(-?\d+),(-?\d+),(-?\d+)\n\r", frame)
    if fields is None:
        return measured(f"fields of the frame {frame!r}", math.nan, low=6, high=6)
    x, y, radians, *distances = map(int, fields.groups())
    errors = [
        *(read - max(-COORDINATE_MM, min(COORDINATE_MM, mm)) for read, mm in ((x, shown.x_mm), (y, shown.y_mm))),
        math.degrees(math.remainder(radians - shown.heading_rad, math.tau)),
        *(read - 10 * cm for read, cm in zip(distances, shown[3:], strict=True)),
    ]
    worst = max(map(abs, errors))
    # The error of float32 at 30 m, in mm, is 0.004.
    return measured(f"greatest error of a field of {frame[:-2]!r}", worst, "mm or degrees", high=1.005)
