"""Demonstrations of the slips in the text: each figure as printed, against what its own numbers, a data sheet or the
emulated robot give.  With its id, the corrected figure stands in the place of the printed one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, partial
from typing import Final

import numpy as np

from emulator.c28x.memory import Pointer
from firmware_model.corrections import ALL
from hil.audit.evidence import Evidence, measured
from hil.audit.rig import Fixes, Rig, robot

# Figures 37 and 39: microseconds and milliseconds.
C_US, C_GYRO, C_ORD, C_SERVO, C_NAV, C_ODO = 106.55, 42.97, 27.54, 20.91, 29.37, 872.50
CLOCK_US, INTERRUPT_US = 5.0, 7.0
T_US, T_GYRO, T_ORD, T_SERVO, T_NAV, T_ODO = 5.0, 5.0, 6.25, 25.0, 50.0, 250.0
TICK_MS: Final = 1.0
CHARACTER_MS: Final = 10 / 9600 * 1e3
B_US, B_ORD, B_NAV = 12.0, 33.25, 10.0

#: Annex A.3.1: true distance in cm -> mean of the left sensor's column.
LEFT_COLUMN: Final = {20: 362.2, 25: 401.1, 40: 521.2, 50: 841.9, 60: 1025.8}
#: Distances of the column that lie on one line.
ON_THE_LINE: Final = (20, 25, 50, 60)


def left_at_40() -> float:
    """What the left sensor reads at 40 cm by the line through the other distances."""
    slope, offset = np.polyfit([LEFT_COLUMN[d] for d in ON_THE_LINE], ON_THE_LINE, 1)
    return float((40 - offset) / slope)


def _frame() -> str:
    """A frame with distances 1, 2 and 3 cm in front, left and right."""
    frames: list[str] = []

    def send(data: Pointer, length: int) -> None:
        frames.append("".join(chr(data.at(i).load() & 0xFF) for i in range(length)))

    rig = Rig(externs={"Send_Frame": send})
    odometry = rig.fw.new("ODOMETRY_Trayect", X=0.0, Y=0.0, tita=0.0, df=1.0, dl=2.0, dr=3.0)
    rig.fw.protocol.Send_ODO_Trayect(odometry)
    return frames[0]


def place_of_left() -> float:
    """Which of the frame's six numbers is the left distance."""
    return _frame().split(" ")[1].strip().split(",").index("20") + 1


def last_character() -> float:
    """The code of the frame's last character."""
    return ord(_frame()[-1])


def threshold() -> float:
    """The square of the smallest rate, in (rad/s)^2, that turns the heading of Odom_Trayect, by bisection."""
    rig = Rig()

    def turns(square: float) -> bool:
        odometry = rig.fw.new("ODOMETRY_Trayect", X=0.0, Y=0.0, tita=0.0, df=0.0, dl=0.0, dr=0.0)
        rig.fw.odometry.Odom_Trayect(odometry, 0.0, math.sqrt(square), 0.0, 0.0, 0.0, T_ODO)
        return bool(odometry.tita)

    low, high = 0.0, 0.01
    for _ in range(20):
        middle = (low + high) / 2
        low, high = (low, middle) if turns(middle) else (middle, high)
    return high


def clocks() -> float:
    """Tasks that a Clock releases."""
    with robot() as bench:
        names: set[str] = set()
        bench.board.trace.listen(lambda _cycles, kind, name: names.add(name) if kind == "clock" else None)
        bench.run_for(1.0)
        return len(names)


def tick_ms() -> float:
    """Virtual time between two ticks of the kernel's clock."""
    with robot() as bench:
        ticks = bench.board.kernel.externs["Clock_getTicks"]
        before = ticks()
        bench.run_for(1.0)
        return 1000.0 / float(ticks() - before)


def _priorities(extern: str, gate: str, order: bytes, task: str = "") -> set[int]:
    """Priorities of the tasks (or of one) that call `extern` on a gate of servidores.c within two seconds."""
    with robot() as bench:
        wanted = getattr(bench.firmware.servidores, gate)
        kernel = bench.board.kernel
        faithful = kernel.externs[extern]
        seen: set[int] = set()

        def watched(handle: object, *key: int) -> object:
            running = kernel.tasks.current
            if handle is wanted and running is not None and running.name.startswith(task):
                seen.add(running.priority)
            return faithful(handle, *key)

        bench.firmware.linked.replace(extern, watched)
        bench.feed(order)
        bench.run_for(2.0)
        return seen


def ceiling_of_odometry() -> float:
    """The highest priority among the tasks that enter the odometry's gate in a mission."""
    return max(_priorities("GateMutexPri_enter", "Odometry_server", b"#MISN\r"))


def priority_inside() -> float:
    """The priority of TaskNAVIGATION as it leaves the gate of the sonars, which nobody waited for."""
    return max(_priorities("GateMutexPri_leave", "US_server", b"", "TaskNAVIGATION"))


def w_orders(gyro_us: float = C_GYRO) -> float:
    """W of TaskORD by the formula of the section."""
    return math.ceil(T_ORD / T_US) * C_US + math.ceil(T_ORD / T_GYRO) * gyro_us + C_ORD + B_ORD


def w_us_with_interrupts() -> float:
    """W of TaskUS with the interrupts of figure 39 at their true periods."""
    interrupts = math.ceil(T_US / TICK_MS) * CLOCK_US + math.ceil(T_US / CHARACTER_MS) * INTERRUPT_US
    return interrupts + C_US + B_US


def w_navigation_ms() -> float:
    """W of TaskNAVIGATION by the formula of the section."""
    higher = ((T_US, C_US), (T_GYRO, C_GYRO), (T_ORD, C_ORD), (T_SERVO, C_SERVO))
    return (sum(math.ceil(T_NAV / t) * c for t, c in higher) + C_NAV + B_NAV) / 1e3


def utilisation() -> float:
    """U with both interrupts at their true periods; computing times in ms, rounded as in the section."""
    terms = (
        (0.005, TICK_MS), (0.007, CHARACTER_MS), (0.106, T_US), (0.043, T_GYRO), (0.028, T_ORD), (0.021, T_SERVO),
        (0.029, T_NAV), (0.872, T_ODO),
    )  # fmt: skip
    return sum(c / t for c, t in terms)


@dataclass(frozen=True, slots=True)
class Figure:
    """A number of the text: as printed, as corrected, and what it must be."""

    what: str
    unit: str
    printed: float
    corrected: float
    right: Callable[[], float]
    tolerance: float = 0.0


FIGURES: Final[Mapping[str, Figure]] = {
    "FIG-sonar-sensitivity": Figure(
        "sensitivity of a sonar at 3.3 V", "mV/cm", 16.5, 2.54, lambda: 3300 / 512 / 2.54, 0.01
    ),
    "FIG-left-calibration": Figure("left sensor at 40 cm", "units", LEFT_COLUMN[40], 678.5, left_at_40, 5.0),
    "FIG-field-order": Figure("place of the left distance in a frame", "", 5, 6, place_of_left),
    "FIG-end-mark": Figure("last character of a frame", "", ord("\n"), ord("\r"), last_character),
    "FIG-odometry-threshold": Figure("square of the rate that is zero", "(rad/s)^2", 1e-3, 1e-4, threshold, 1e-6),
    "FIG-arc-formula": Figure(
        "way in 0.25 s at 0.3 m/s and 0.5 rad/s",
        "m",
        0.3 / 0.5 * 0.25,
        0.3 / 0.5 * (0.5 * 0.25),
        lambda: 0.3 * 0.25,
        1e-9,
    ),
    "FIG-periodic-tasks": Figure("tasks released by a clock", "", 6, 5, clocks),
    "FIG-time-unit": Figure("time of TaskUS", "us", 106602.9, 106.6029, lambda: C_US, 1.0),
    "FIG-worst-us": Figure("worst time of TaskUS", "us", C_US, 107.28, lambda: 107280 / 1e3, 0.005),
    "FIG-worst-gyro": Figure("worst time of TaskGYRO", "us", C_GYRO, 43.29, lambda: 43290 / 1e3, 0.005),
    "FIG-worst-servo": Figure("worst time of TaskSERVO", "us", C_SERVO, 28.87, lambda: 28870 / 1e3, 0.005),
    "FIG-clock-period": Figure("period of the clock", "ms", 10, 1, tick_ms, 1e-3),
    "FIG-interrupt-period": Figure("time between two characters", "ms", 2, 1.0417, lambda: CHARACTER_MS, 1e-4),
    "FIG-order-bits": Figure("the shortest order on the line", "bits", 6, 60, lambda: len("#STOP\r") * 10),
    "FIG-odometry-ceiling": Figure("ceiling of the odometry's server", "", 3, 1, ceiling_of_odometry),
    "FIG-ceiling-protocol": Figure("priority of TaskNAVIGATION within the sonars' server", "", 6, 2, priority_inside),
    "FIG-blocking-servo": Figure("blocking of TaskSERVO", "us", 16.5, 16.7, lambda: 6.7 + 10, 0.005),
    "FIG-response-interrupts": Figure("W of TaskUS", "us", 118.55, 178.55, w_us_with_interrupts, 0.005),
    "FIG-gyro-time": Figure("time of TaskGYRO in W of TaskORD", "us", 42.67, 42.97, lambda: C_GYRO, 0.005),
    "FIG-response-orders": Figure("W of TaskORD", "us", 247.315, 359.83, w_orders, 0.005),
    "FIG-response-navigation": Figure("W of TaskNAVIGATION", "ms", 1.79, 1.80, w_navigation_ms, 0.005),
    "FIG-utilisation": Figure("utilisation", "", 0.043188, 0.0509, utilisation, 5e-5),
}


@cache
def _right(name: str) -> float:
    """What a figure must be; corrections of the firmware have no part in it."""
    return FIGURES[name].right()


def _demonstrate(name: str, fixes: Fixes) -> Evidence:
    figure = FIGURES[name]
    stated = figure.corrected if name in fixes or ALL in fixes else figure.printed
    right = _right(name)
    return measured(figure.what, stated, figure.unit, low=right - figure.tolerance, high=right + figure.tolerance)


DEMONSTRATIONS: Final[Mapping[str, Callable[[Fixes], Evidence]]] = {
    name: partial(_demonstrate, name) for name in FIGURES
}
