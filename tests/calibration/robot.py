"""The port with other constants of time, and what takes how long in it."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final
from unittest.mock import patch

from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION
from emulator.clock import SYSCLK_HZ, us
from emulator.cpu import INTERRUPT_ENTRY_CYCLES, INTERRUPT_EXIT_CYCLES
from emulator.sysbios.costs import CYCLES
from emulator.sysbios.statistics import TaskStatistics
from emulator.system import KERNEL_COST_SCALE
from firmware_model.calibration import CALIBRATION
from firmware_model.image import link
from hil.bench import BOOT_S
from hil.robot.board import RobotBoard
from hil.robot.mounting import mounted
from hil.world.maps import load_map

_BOARD_SUPPORT: Final = "firmware_model.board_support."
#: Code that has one factor -> its modules: those of a task, those that all tasks share, and what has none of its own.
CODE: Final[Mapping[str, tuple[str, ...]]] = MappingProxyType({
    "us": ("firmware_model.us",),
    "gyro": ("firmware_model.gyro", f"{_BOARD_SUPPORT}spi"),
    "wheels": tuple(_BOARD_SUPPORT + name for name in ("servos", "encoder", "pwm")),
    "main": ("firmware_model.main_robot",),
    "servers": ("firmware_model.servidores",),
    "rest": (
        "firmware_model.protocol", "firmware_model.odometry",
        *(_BOARD_SUPPORT + name for name in ("xbee", "bumper", "clock")),
    ),
})  # fmt: skip


def _shipped_factors() -> dict[str, float]:
    """Code -> the factor that `calibration.py` gives to all of its modules."""
    factors = {}
    for code, modules in CODE.items():
        (factors[code],) = {CALIBRATION.get(module, 1.0) for module in modules}
    return factors


@dataclass(frozen=True)
class Constants:
    """The constants of time.  Those of the port if nothing else is said."""

    #: Code -> factor on the cycles of the translator's table.
    factors: Mapping[str, float] = field(default_factory=_shipped_factors)
    #: Factor on the kernel's table.
    kernel: float = KERNEL_COST_SCALE
    #: Cycles of System_sprintf besides its characters and digits.
    print_call: float = KERNEL_COST_SCALE * CYCLES["print_call"]

    @property
    def calibration(self) -> dict[str, float]:
        """Module -> factor."""
        return {module: self.factors[code] for code, modules in CODE.items() for module in modules}


class _Spans:
    """Spans that the trace alone tells, in cycles: ticks with their Swi, received bytes' interrupts, gates."""

    def __init__(self) -> None:
        self.ticks: list[int] = []
        self.received: list[int] = []
        self.gates: list[int] = []
        self._since: dict[str, int] = {}
        self._tick = 0

    def __call__(self, cycles: int, kind: str, name: str) -> None:
        """One event."""
        if kind in ("hwi", "swi", "gate enter"):
            self._since[f"{kind} {name}"] = cycles
        elif kind == "hwi end":
            took = cycles - self._since[f"hwi {name}"] + INTERRUPT_ENTRY_CYCLES + INTERRUPT_EXIT_CYCLES
            if name == "Clock_tick":
                self._tick = took
            elif name == "XBee_Receive":
                self.received.append(took)
        elif kind == "swi end" and name == "Clock":
            self.ticks.append(self._tick + cycles - self._since["swi Clock"])
        elif kind == "gate leave":
            self.gates.append(cycles - self._since[f"gate enter {name}"])


def measure(constants: Constants, float_division: str = DEFAULT_FLOAT_DIVISION) -> dict[str, float]:
    """What takes how long with these constants, in microseconds.

    The five periodic tasks and the tick while the robot stands, TaskORD with its shortest order (`TaskORD`) and its
    longest (`TaskORD longest`), the receive interrupt, TaskSERVO while it drives (`TaskSERVO driving`), one server.
    """

    class Scaled(RobotBoard):
        kernel_cost_scale = constants.kernel

    board = Scaled(seed=1, ideal=False)
    board.kernel.core.costs["print_call"] = round(constants.print_call)
    with patch.dict(os.environ, HIL_CACHE="off"):  # none of these programs is wanted twice
        firmware = link(board, calibration=constants.calibration, float_division=float_division)
    mounted(board, load_map("corridor"), seed=1)
    statistics, spans = TaskStatistics(), _Spans()
    board.trace.read(statistics)
    board.trace.listen(spans)
    kernel, clock = board.kernel, board.clock
    pause = clock.after(SYSCLK_HZ // 20, kernel.pause)
    kernel.start(firmware.function("main_robot.main"))
    clock.cancel(pause)

    def run(seconds: float) -> None:
        kernel.run_until(clock.now + round(seconds * SYSCLK_HZ))

    def computation(task: str) -> float:
        return us(statistics.tasks[task].computation.mean)

    run(BOOT_S - clock.now / SYSCLK_HZ)
    statistics.reset(clock.now)
    run(0.5)
    found = {task: computation(task) for task in ("TaskUS", "TaskGYRO", "TaskNAVIGATION", "TaskSERVO", "TaskODO")}
    found["tick"] = us(min(spans.ticks))  # of most ticks: no Clock is due
    found["gate"] = us(kernel.core.costs["gate_enter"] + min(spans.gates))
    statistics.reset(clock.now)
    spans.received.clear()
    board.link.feed(b"#STOP\r")
    run(0.05)
    found["TaskORD"] = computation("TaskORD")
    found["receive interrupt"] = us(sum(spans.received)) / len(spans.received)
    statistics.reset(clock.now)
    board.link.feed(b"#SETR0.2,0.3\r")
    run(0.05)
    found["TaskORD longest"] = computation("TaskORD")
    board.link.feed(b"#MISN\r")
    run(0.2)
    statistics.reset(clock.now)
    run(0.25)
    found["TaskSERVO driving"] = computation("TaskSERVO")
    kernel.shutdown()
    return found
