"""Demonstrations of the defects of GYRO.c, by id."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import partial
from itertools import count
from typing import Any, Final

from emulator.devices.l3g4200d_registers import CTRL_REG1
from emulator.signals import SpiSlave
from hil.audit import main_robot_guards, properties
from hil.audit.evidence import Evidence, Picture, Series, measured, reported
from hil.audit.properties import Z
from hil.audit.rig import ALONE, Fixes, Rig, robot, static_findings
from hil.audit.task_rig import TaskRig
from hil.golden.scripted_gyro import OUT_TEMP, ScriptedGyro
from hil.robot.board import GYRO_CS_GPIO

#: A rig with GYRO.c and the modules that it needs.  It is built faster than the whole robot's program.
_rig: Final = partial(Rig, modules=ALONE["gyro"])

X: Final = 0
#: A turn of 1 rad/s.
RAD_S_DIGITS: Final = round(1.0 / properties.RAD_S_PER_DIGIT)


def _scripted(fixes: Fixes, axis: int = Z, raw: int = 0, **options: Any) -> tuple[Rig, ScriptedGyro]:
    """Set SPI-A up, with a slave that gives `raw` on one axis."""
    rig = _rig(fixes, **options)
    gyro = rig.scripted_gyro()
    gyro.set_axis(axis, raw)
    rig.fw.spi.Init_SPIA()
    return rig, gyro


def _rates(rig: Rig, gyro: ScriptedGyro, most_rad_s: float) -> Picture:
    """Return the results of get_GYRO for rates up to `most_rad_s` in both directions."""
    true = [most_rad_s * i / 50 for i in range(-50, 51)]
    read = [properties.rate_read(rig, gyro, Z, round(rate / properties.RAD_S_PER_DIGIT)) for rate in true]
    lines = [Series("get_GYRO", true, read), Series("true", true, true)]
    return Picture("The rate as it is read", "rate in rad/s", "get_GYRO in rad/s", lines)


class DisturbedSpiSlave:
    """A bus on which the first value written to CTRL_REG1 arrives as 0."""

    def __init__(self, slave: SpiSlave) -> None:
        self._slave = slave
        self._bytes: list[int] = []
        self._done = False

    def select(self, level: int) -> None:
        """Chip select."""
        self._bytes.clear()
        self._slave.select(level)

    def exchange(self, out_bits: int, length: int, cpol: int, cpha: int) -> int | None:
        """One word in, one word out."""
        if self._bytes == [CTRL_REG1] and not self._done:
            out_bits, self._done = 0, True
        self._bytes.append(out_bits)
        return self._slave.exchange(out_bits, length, cpol, cpha)


def global_names(fixes: Fixes) -> Evidence:
    """Look for the names in the typed tree of the image."""
    return reported(static_findings(fixes), "hidden-name", function="readReg")


def fifo_bypassed(fixes: Fixes) -> Evidence:
    """Run Init_GYRO on the sensor."""
    rig = _rig(fixes)
    rig.fw.gyro.Init_GYRO()
    return reported(rig.findings, "fifo-bypassed", function="Init_GYRO")


def write_unchecked(fixes: Fixes) -> Evidence:
    """Disturb one byte during Init_GYRO."""
    rig = _rig(fixes)
    rig.board.spi_bus["A"].attach(rig.board.pins[GYRO_CS_GPIO], DisturbedSpiSlave(rig.board.gyro))
    rig.fw.gyro.Init_GYRO()
    power = rig.board.gyro.registers[CTRL_REG1] >> 3 & 1
    return measured("CTRL_REG1.PD (1 is awake) after one disturbed write", power, low=1)


def turn_on(fixes: Fixes) -> Evidence:
    """Run Init_GYRO on a sensor that was just switched on."""
    rig = _rig(fixes)
    rig.fw.gyro.Init_GYRO()
    return reported(rig.findings, "startup-read", function="Init_GYRO")


def xy_off(fixes: Fixes) -> Evidence:
    """Read the X axis after Init_GYRO."""
    rig = _rig(fixes)
    rig.fw.gyro.Init_GYRO()
    rig.fw.gyro.getX()
    return reported(rig.findings, "not-configured", function="getX")


def sum16(fixes: Fixes) -> Evidence:
    """Calibrate with a zero-rate level of 3.5 deg/s, which is 400 digits."""
    sums: list[int] = []

    def sample() -> int:
        sums.append(getattr(rig.fw.gyro, "aux" if "aux" in dir(rig.fw.gyro) else "sum_Z"))
        return 400

    rig, _ = _scripted(fixes, externs={"getZ": sample})
    rig.fw.gyro.Init_GYRO()
    picture = Picture("Samples of 400 digits", "samples added", "sum", [Series("sum", range(len(sums)), sums)])
    return reported(rig.findings, "overflow", function="Init_GYRO").shown(picture)


def starves_at_start(fixes: Fixes) -> Evidence:
    """Run the robot's start-up."""
    with robot(fixes) as bench:
        return reported(bench.findings, "starvation", function="Init_GYRO")


def bias_unsigned(fixes: Fixes) -> Evidence:
    """Read a sample of 50 digits with a bias of -100."""
    rig, _ = _scripted(fixes, raw=50)
    rig.fw.gyro.Z_Calib_b = -100.0
    rig.fw.gyro.getZ()
    return reported(rig.findings, "float-to-int", function="getZ")


def offset_wraps(fixes: Fixes) -> Evidence:
    """Read a sample near full scale with an offset of -200 digits."""
    rig, _ = _scripted(fixes, raw=32700)
    rig.fw.gyro.Z_dc_offset = -200
    rig.fw.gyro.getZ()
    return reported(rig.findings, "overflow", function="getZ")


def temperature_unused(fixes: Fixes) -> Evidence:
    """Look for calls in the call graph of the image."""
    return reported(static_findings(fixes), "never-called", object="getTemp")


def temperature_sign(fixes: Fixes) -> Evidence:
    """Read a temperature register of -10, which is 0xF6."""
    rig, gyro = _scripted(fixes)
    values, read = range(-60, 61, 5), []
    for value in values:
        gyro.registers[OUT_TEMP] = value & 0xFF
        read.append(float(rig.fw.gyro.getTemp()))
    lines = [Series("getTemp", values, read), Series("44 - OUT_TEMP", values, [44 - value for value in values])]
    picture = Picture("The temperature as it is read", "OUT_TEMP", "degrees Celsius", lines)
    evidence = measured("temperature for a register of -10", read[values.index(-10)], "degrees", low=54, high=54)
    return evidence.shown(picture)


def offset_one_sample(fixes: Fixes) -> Evidence:
    """Run Offset_GYRO on a sensor that has been on for a second."""
    rig = _rig(fixes, ideal=False, keep_locals=True)
    rig.fw.gyro.Init_GYRO()
    rig.findings.clear()
    rig.fw.gyro.Offset_GYRO(rig.fw.gyro.GYRO_SENSOR.Z)
    samples = rig.fw.last_locals("gyro.Offset_GYRO")["Calib_b"]
    picture = Picture("What the offset is the mean of", "read", "Z in digits", [Series("getZ", range(50), samples)])
    return reported(rig.findings, "stale-sample", function="Offset_GYRO").shown(picture)


def offset_moving(fixes: Fixes) -> Evidence:
    """Turn the robot back and forth at about 20 deg/s while TaskGYRO starts; at rest the gyro then reads 100."""
    reads = count()

    def sample() -> int:
        n = next(reads)
        return round(2285 + 1500 * math.sin(n / 4)) if n < 50 else 100

    rig = TaskRig(fixes, getZ=sample, Init_GYRO=lambda: None, get_GYRO=lambda _axis, _bias: 0.0,
                  Gyro_Answers=lambda: 1)  # fmt: skip
    rig.turns("TaskGYRO")
    return measured("offset of a gyro that reads 100 at rest", rig.fw.main_robot.vZ_b, "digits", low=95.0, high=105.0)


def offset_unknown_axis(fixes: Fixes) -> Evidence:
    """Ask for the offset of an axis that GYRO.h does not have."""
    rig, _ = _scripted(fixes)
    rig.fw.gyro.Offset_GYRO(3)
    return reported(rig.findings, "no-case", function="Offset_GYRO")


def scale(fixes: Fixes) -> Evidence:
    """Measure a rotation of 1 rad/s."""
    rig, gyro = _scripted(fixes)
    return properties.rotation_scale(rig, gyro, Z, RAD_S_DIGITS).shown(_rates(rig, gyro, 4.0))


def radians(fixes: Fixes) -> Evidence:
    """Compare the driver's own degrees with its radians."""
    rig, _ = _scripted(fixes, Z, RAD_S_DIGITS, keep_locals=True)
    rig.fw.gyro.get_GYRO(Z, 0.0)
    values = rig.fw.last_locals("gyro.get_GYRO")
    ratio = values["W"] / math.radians(values["g_deg_s"])
    return measured("radians over degrees x pi / 180", ratio, low=0.9999, high=1.0001)


def xy_result(fixes: Fixes) -> Evidence:
    """Measure a rotation about X."""
    rig, _ = _scripted(fixes, X, RAD_S_DIGITS)
    rig.fw.gyro.get_GYRO(X, 0.0)
    return reported(rig.findings, "uninitialised", function="get_GYRO", object="Wabs")


def clockwise_zero(fixes: Fixes) -> Evidence:
    """Measure a rotation of -1 rad/s."""
    rig, gyro = _scripted(fixes)
    return properties.rotation_sign(rig, gyro, Z, -RAD_S_DIGITS).shown(_rates(rig, gyro, 4.0))


def dead_band(fixes: Fixes) -> Evidence:
    """Measure a slow rotation: 59 digits are 0.009 rad/s."""
    rig, gyro = _scripted(fixes)
    return properties.rotation_sign(rig, gyro, Z, 59).shown(_rates(rig, gyro, 0.03))


def unknown_axis(fixes: Fixes) -> Evidence:
    """Ask for the rate of an axis that GYRO.h does not have."""
    rig, _ = _scripted(fixes)
    rig.fw.gyro.get_GYRO(3, 0.0)
    # Once every case gives the result a value, the missing case alone is the cause, and is what is told.
    hits = [reported(rig.findings, rule, function="get_GYRO") for rule in ("uninitialised", "no-case")]
    return next((hit for hit in hits if hit.seen), hits[0])


def answer_unchecked(fixes: Fixes) -> Evidence:
    """Silence the gyro's bus during a mission.  Two tasks' periods and a turn of the wheels take 0.2 s."""
    distance_m = main_robot_guards.distance_despite(fixes, "gyro-miso-stuck:level=1", 0.3)
    return measured("way in a second, 0.3 s after the gyro fell silent", distance_m, "m", high=0.005)


DEMONSTRATIONS: Final[Mapping[str, Callable[[Fixes], Evidence]]] = {
    "GYRO-global-names": global_names,
    "GYRO-fifo-bypassed": fifo_bypassed,
    "GYRO-write-unchecked": write_unchecked,
    "GYRO-turn-on": turn_on,
    "GYRO-xy-off": xy_off,
    "GYRO-sum16": sum16,
    "GYRO-starves-at-start": starves_at_start,
    "GYRO-answer-unchecked": answer_unchecked,
    "GYRO-bias-unsigned": bias_unsigned,
    "GYRO-offset-wraps": offset_wraps,
    "GYRO-temperature-unused": temperature_unused,
    "GYRO-temperature-sign": temperature_sign,
    "GYRO-offset-one-sample": offset_one_sample,
    "GYRO-offset-moving": offset_moving,
    "GYRO-offset-unknown-axis": offset_unknown_axis,
    "GYRO-scale": scale,
    "GYRO-radians": radians,
    "GYRO-xy-result": xy_result,
    "GYRO-clockwise-zero": clockwise_zero,
    "GYRO-dead-band": dead_band,
    "GYRO-unknown-axis": unknown_axis,
}
