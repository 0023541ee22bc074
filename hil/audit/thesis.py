"""Demonstrations of errors in the text: each figure as printed is compared with the emulated robot.

Some are compared with the result of `hil rta` for the text's own numbers; such evidence is only read.  With its id, the
corrected figure replaces the printed one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Final

from emulator.c28x.memory import Pointer
from emulator.clock import SYSCLK_HZ
from emulator.devices.lv_maxsonar_beam import Echo
from firmware_model.corrections import ALL
from hil.audit.evidence import Evidence, measured, read
from hil.audit.rig import ALONE, Fixes, Rig, robot
from hil.robot.board import RobotBoard
from hil.rta.analysis import Protocol, analyse
from hil.rta.task_set import NS_PER_US
from hil.rta.thesis import PrintedNumber, cells, load, task_set

#: Annex A.3.1: the mean of the left sensor's column at 40 cm.
LEFT_AT_40: Final = 521.2
_INCH_CM: Final = 2.54


def _sonar_codes(range_m: float) -> float:
    """The left sonar's code, in counts, of a wall at this range."""
    rig = Rig(modules=ALONE["us"])
    rig.board.sonars.set_range_source(lambda _name, _cycles: Echo(range_m))
    rig.fw.us.Init_US()
    rig.wait(0.6)  # three rounds of the ring: a step upwards falls short in the first
    return float(rig.fw.us.Read_Channel(0))


def left_at_40() -> float:
    """The value of Read_Distance for 40 cm before it calibrates: the sum of twelve conversions divided by 2.3."""
    return _sonar_codes(0.4) * 12 / 2.3


def sensitivity() -> float:
    """Millivolts a centimetre, between 10 and 100 inches, as the sonar rounds to whole ones."""
    counts = _sonar_codes(100.5 * _INCH_CM / 100) - _sonar_codes(10.5 * _INCH_CM / 100)
    return counts * RobotBoard.vrefhi_v * 1e3 / 4096 / (90 * _INCH_CM)


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
    """The position of the left distance among the frame's six numbers."""
    return _frame().split(" ")[1].strip().split(",").index("20") + 1


def last_character() -> float:
    """The code of the frame's last character."""
    return ord(_frame()[-1])


def threshold() -> float:
    """The square of the smallest rate, in (rad/s)^2, that turns the heading of Odom_Trayect, by bisection."""
    rig = Rig()

    def turns(square: float) -> bool:
        odometry = rig.fw.new("ODOMETRY_Trayect", X=0.0, Y=0.0, tita=0.0, df=0.0, dl=0.0, dr=0.0)
        rig.fw.odometry.Odom_Trayect(odometry, 0.0, math.sqrt(square), 0.0, 0.0, 0.0, 250.0)
        return bool(odometry.tita)

    low, high = 0.0, 0.01
    for _ in range(20):
        middle = (low + high) / 2
        low, high = (low, middle) if turns(middle) else (middle, high)
    return high


def arc() -> float:
    """The way in m of a period of 0.25 s at 0.3 m/s and 0.5 rad/s."""
    rig = Rig({"ODO-units-turning"})
    odometry = rig.fw.new("ODOMETRY_Trayect", X=0.0, Y=0.0, tita=0.0, df=0.0, dl=0.0, dr=0.0)
    rig.fw.odometry.Odom_Trayect(odometry, 0.3, 0.5, 0.0, 0.0, 0.0, 250.0)
    return math.hypot(odometry.X, odometry.Y) / 1e3


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
    """The priority of TaskNAVIGATION when it leaves the gate of the sonars, while no task waits for the gate."""
    return max(_priorities("GateMutexPri_leave", "US_server", b"", "TaskNAVIGATION"))


def longest_us(task: str) -> float:
    """The largest computation time of a task while the robot drives."""
    with robot() as bench:
        bench.run_for(1.0)
        bench.feed(b"#TELE\r#SETR0.2,0.1\r")
        bench.measure_tasks()
        bench.run_for(1.0)
        return next(t.computation_max_us for t in bench.task_statistics().tasks if t.task == task)


def characters_ms(order: bytes) -> list[float]:
    """When each character of an order has arrived, after the first one began."""
    with robot() as bench:
        times: list[int] = []
        bench.board.trace.listen(
            lambda cycles, kind, name: times.append(cycles) if kind == "hwi" and name == "XBee_Receive" else None
        )
        bench.run_for(1.0)
        begin = bench.clock.now
        bench.feed(order)
        bench.run_for(0.1)
        return [1e3 * int(cycles - begin) / SYSCLK_HZ for cycles in times]


def bits_of_stop() -> float:
    """Bits of the shortest order on a line of 9600 baud."""
    return characters_ms(b"#STOP\r")[-1] * 9.6


def utilisation() -> float:
    """U with both interrupts as often as they come on the robot; computing times as rounded in the section."""
    printed = load()["utilisation"]
    first, *_, last = characters_ms(b"#STOP\r")
    periods_ms = {"Clock": tick_ms(), "ORD interrupt": (last - first) / 5}
    terms = zip(printed["names"], printed["terms"], strict=True)
    return math.fsum(c / periods_ms.get(name, t) for name, (c, t) in terms)


def _cell(table: str, name: str, unit: str = "us") -> PrintedNumber:
    """A number of section 3.4 as `hil rta --thesis` has it."""
    return next(cell for cell in cells() if (cell.table, cell.name, cell.unit) == (table, name, unit))


def exact(table: str, name: str) -> float:
    """The value of a number of the text by exact analysis of the text's task set."""
    value = _cell(table, name).exact
    assert value is not None
    return value


def own_rule(table: str, name: str) -> float:
    """The value of a number of the text by the formula printed beside it."""
    value = _cell(table, name).own_rule
    assert value is not None
    return value


def w_us_with_interrupts() -> float:
    """W of TaskUS with the interrupts of figure 39, no less than a millisecond apart."""
    read = task_set()
    interrupts = tuple(replace(each, arrival=replace(each.arrival, period_ns=1_000_000)) for each in read.interrupts)
    responses = analyse(replace(read, interrupts=interrupts), Protocol.INHERITANCE)
    response_ns = next(each.response_ns for each in responses if each.task.name == "TaskUS")
    assert response_ns is not None
    return response_ns / NS_PER_US


@dataclass(frozen=True, slots=True)
class Figure:
    """A number of the text: as printed, as corrected, and the right value.

    The right value comes from the robot, or (`only_read`) from `hil rta` and numbers of the text alone.
    """

    what: str
    unit: str
    printed: float
    corrected: float
    right: Callable[[], float]
    tolerance: float = 0.0
    only_read: bool = False


_read = partial(Figure, only_read=True)

FIGURES: Final[Mapping[str, Figure]] = {
    "FIG-sonar-sensitivity": Figure("sensitivity of a sonar at 3.3 V", "mV/cm", 16.5, 2.54, sensitivity, 0.01),
    # One inch, to which the sonar rounds, is 46 units.
    "FIG-left-calibration": Figure("left sensor at 40 cm", "units", LEFT_AT_40, 678.5, left_at_40, 46.0),
    "FIG-field-order": Figure("place of the left distance in a frame", "", 5, 6, place_of_left),
    "FIG-end-mark": Figure("last character of a frame", "", ord("\n"), ord("\r"), last_character),
    "FIG-odometry-threshold": Figure("square of the rate that is zero", "(rad/s)^2", 1e-3, 1e-4, threshold, 1e-6),
    "FIG-arc-formula": Figure(
        "way in 0.25 s at 0.3 m/s and 0.5 rad/s", "m", 0.3 / 0.5 * 0.25, 0.3 / 0.5 * (0.5 * 0.25), arc, 1e-6,
    ),
    "FIG-periodic-tasks": Figure("tasks released by a clock", "", 6, 5, clocks),
    # 2 %: how far the emulated time of TaskUS is off the one that was measured.
    "FIG-time-unit": Figure("time of TaskUS", "us", 106602.9, 106.6029, partial(longest_us, "TaskUS"), 2.0),
    "FIG-worst-times": Figure("worst time of TaskSERVO", "us", 20.91, 28.87, partial(longest_us, "TaskSERVO"), 0.6),
    "FIG-order-bits": Figure("the shortest order on the line", "bits", 6, 60, bits_of_stop, 0.5),
    "FIG-odometry-ceiling": Figure("ceiling of the odometry's server", "", 3, 1, ceiling_of_odometry),
    "FIG-ceiling-protocol": Figure("priority of TaskNAVIGATION within the sonars' server", "", 6, 2, priority_inside),
    "FIG-blocking-orders": _read(
        "blocking of TaskORD", "us", 33.25, 12, partial(exact, "figure 41", "TaskORD"), 0.005
    ),
    "FIG-blocking-servo": _read(
        "blocking of TaskSERVO", "us", 16.5, 22, partial(exact, "figure 41", "TaskSERVO"), 0.005
    ),
    "FIG-response-interrupts": _read("W of TaskUS", "us", 118.55, 130.55, w_us_with_interrupts, 0.005),
    "FIG-response-orders": _read("W of TaskORD", "us", 247.315, 359.83, partial(own_rule, "3.4.4", "W TaskORD"), 0.005),
    "FIG-response-navigation": _read(
        "W of TaskNAVIGATION", "us", 1790, 1800, partial(own_rule, "3.4.4", "W TaskNAVIGATION"), 5.0
    ),
    "FIG-utilisation": Figure("utilisation", "", 0.043188, 0.0509, utilisation, 5e-5),
}


@cache
def _right(name: str) -> float:
    """The right value of a figure.  Corrections of the firmware do not change it."""
    return FIGURES[name].right()


def _demonstrate(name: str, fixes: Fixes) -> Evidence:
    figure = FIGURES[name]
    stated = figure.corrected if name in fixes or ALL in fixes else figure.printed
    right = _right(name)
    saw = read if figure.only_read else measured
    return saw(figure.what, stated, figure.unit, low=right - figure.tolerance, high=right + figure.tolerance)


DEMONSTRATIONS: Final[Mapping[str, Callable[[Fixes], Evidence]]] = {
    name: partial(_demonstrate, name) for name in FIGURES
}
