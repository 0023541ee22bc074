"""Constants fitted to what the thesis measured, and what they then predict of what they were not fitted to.

A model says which code shares a factor.  Its constants are these factors, the kernel's, and the cycles of
System_sprintf.  They are fitted by least squares of the logarithms of predicted over measured time, with so weak a pull
to a factor of 1 that it decides only what no target tells: 1 is what code has that nobody calibrated.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from math import ceil, exp, sqrt
from types import MappingProxyType
from typing import Final

import numpy as np
import numpy.typing as npt

from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION
from hil.cli.tasks import PUBLISHED, ThesisTimes
from tests.calibration.robot import CODE, Constants, measure

#: A time of each target, in microseconds.
Times = npt.NDArray[np.float64]


def _both(task: ThesisTimes) -> float:
    """Geometric mean of the two figures."""
    assert task.figure37_min_us is not None
    assert task.figure37_max_us is not None
    return sqrt((task.figure37_min_us + task.figure37_max_us) / 2 * task.figure39_us)


#: What the constants of the port were fitted to, in microseconds: the periodic tasks (TFG figures 37 and 39), the tick
#: (figure 39) and a gate (3.4.3).  CHOICE: TaskSERVO's two figures are of a robot that stands (39) and of one that
#: drives (37): the thesis does not say, and nothing else makes the task take that much longer.
TARGETS: Final[Mapping[str, float]] = MappingProxyType({
    **{task: _both(PUBLISHED[task]) for task in ("TaskUS", "TaskGYRO", "TaskNAVIGATION", "TaskODO")},
    "TaskSERVO": PUBLISHED["TaskSERVO"].figure39_us,
    "TaskSERVO driving": PUBLISHED["TaskSERVO"].figure37_max_us or 0.0,
    "tick": 5.0,
    "gate": 4.05,
})  # fmt: skip
#: What the thesis measured and nothing was ever fitted to (figure 39).  It does not say which order TaskORD had.
NEVER_FITTED: Final[Mapping[str, float]] = MappingProxyType({
    "TaskORD": PUBLISHED["TaskORD"].figure39_us,
    "TaskORD longest": PUBLISHED["TaskORD"].figure39_us,
    "receive interrupt": 7.0,
})
#: What is left out in turn: a task with all of its targets.
LEFT_OUT: Final[Mapping[str, tuple[str, ...]]] = MappingProxyType({
    **{task: (task,) for task in ("TaskUS", "TaskGYRO", "TaskNAVIGATION")},
    "TaskSERVO": ("TaskSERVO", "TaskSERVO driving"),
    "TaskODO": ("TaskODO",),
})
#: Weight of the pull to what nobody fitted, against 1 for a target that is off by a factor of e.
_PULL: Final = 1e-3
#: Unit of System_sprintf's cycles among constants that are logarithms.
_PRINT_UNIT: Final = 10_000.0
#: Steps of a fit on straight lines, and how often the lines are laid through a run.
_STEPS: Final = 60
_RUNS: Final = 2


@dataclass(frozen=True)
class Model:
    """Which code shares a factor: code -> name of its factor; what is not named has 1."""

    name: str
    factors: Mapping[str, str]

    @property
    def constants(self) -> tuple[str, ...]:
        """The names of what is fitted."""
        return (*dict.fromkeys(self.factors.values()), "kernel", "print_call")


_DRIVERS: Final = {"us": "drivers", "gyro": "drivers", "wheels": "drivers"}
_SHIPPED: Final = {"us": "us", "gyro": "gyro", "wheels": "gyro"}
#: That of the port.
SHIPPED: Final = Model("as shipped", {**_SHIPPED, "main": "shared", "servers": "shared"})
#: A driver that is left out has the factor 1 then: that of code nobody calibrated.
EACH_DRIVER: Final = Model("us | gyro | wheels", {"us": "us", "gyro": "gyro", "wheels": "wheels"})
#: As many factors as there are tasks with code of their own, and one for what they share.
EACH_TASK: Final = Model("each task its factor", {code: code for code in CODE if code != "rest"})
MODELS: Final = (
    Model("no factor", {}),
    Model("one factor", dict.fromkeys(CODE, "code")),
    Model("drivers", _DRIVERS),
    Model("us | gyro and wheels", _SHIPPED),
    EACH_DRIVER,
    SHIPPED,
    EACH_TASK,
)


@dataclass(frozen=True)
class Fitted:
    """The constants that a model came to, and everything that they predict, in microseconds."""

    constants: Constants
    predicted: Mapping[str, float]

    def ratio(self, what: str) -> float:
        """Predicted over measured."""
        return self.predicted[what] / (TARGETS.get(what) or NEVER_FITTED[what])


class Robot:
    """What the port takes with any constants: each prediction is a run; slopes are of the runs beside the first one.

    Times are sums of what each constant stands before, but for cycles that are rounded and waits that code hides in.
    """

    def __init__(self, float_division: str = DEFAULT_FLOAT_DIVISION) -> None:
        self.float_division = float_division
        self.plain = Constants(dict.fromkeys(CODE, 1.0), 1.0, 0.0)
        self._known: dict[tuple[float, ...], dict[str, float]] = {}
        self._slopes: dict[str, dict[str, float]] = {}

    def times(self, constants: Constants) -> dict[str, float]:
        """Everything that `measure` measures."""
        key = (*(constants.factors[code] for code in CODE), constants.kernel, constants.print_call)
        if key not in self._known:
            self._known[key] = measure(constants, self.float_division)
        return self._known[key]

    def slopes(self, constant: str) -> dict[str, float]:
        """Microseconds by a code's factor, by the kernel's, by a cycle of System_sprintf."""
        if constant not in self._slopes:
            plain = self.plain
            beside, step = {
                "kernel": (replace(plain, kernel=3.0), 2.0), "print_call": (replace(plain, print_call=2e4), 2e4),
            }.get(constant) or (replace(plain, factors={**plain.factors, constant: 3.0}), 2.0)  # fmt: skip
            before, after = self.times(plain), self.times(beside)
            self._slopes[constant] = {what: (after[what] - before[what]) / step for what in before}
        return self._slopes[constant]


def fit(model: Model, robot: Robot, measured: Mapping[str, float] = TARGETS) -> Fitted:
    """The constants of `model` that meet what was `measured` (in microseconds) best.

    They are found on the straight lines of `Robot.slopes`, then once more on lines that go through what the robot took
    with them.
    """
    wanted = list(measured)
    logs = np.log(list(measured.values()))
    off = np.zeros(len(wanted))
    for _ in range(_RUNS):
        values = _solved(model, robot, wanted, logs, off)
        found = _predicted(model, robot, values)
        off = off + np.array([found.predicted[t] for t in wanted]) - _straight(model, robot, values, wanted, off)
    return found


def _straight(model: Model, robot: Robot, values: Mapping[str, float], wanted: list[str], off: Times) -> Times:
    """What the straight lines predict."""
    constants = _constants(model, values)
    plain = robot.times(robot.plain)
    predicted = np.array([plain[target] for target in wanted]) + off
    for code in CODE:
        predicted += (constants.factors[code] - 1.0) * _slope(robot, code, wanted)
    predicted += (constants.kernel - 1.0) * _slope(robot, "kernel", wanted)
    return predicted + constants.print_call * _slope(robot, "print_call", wanted)


def _solved(model: Model, robot: Robot, wanted: list[str], logs: Times, off: Times) -> dict[str, float]:
    """The fit on straight lines to times whose logarithms are given, by Gauss and Newton."""
    values = dict.fromkeys(model.constants, 0.0)
    for _ in range(_STEPS):
        predicted = _straight(model, robot, values, wanted, off)
        columns = []
        for name, value in values.items():
            if name in ("kernel", "print_call"):
                slope = _slope(robot, name, wanted) * (exp(value) if name == "kernel" else _PRINT_UNIT)
            else:
                of = [code for code, factor in model.factors.items() if factor == name]
                slope = sum((_slope(robot, code, wanted) for code in of), np.zeros(len(wanted))) * exp(value)
            columns.append(slope / predicted)
        vector = np.array(list(values.values()))
        rows = np.vstack([np.column_stack(columns), _PULL * np.eye(len(values))])
        change = np.linalg.lstsq(rows, np.concatenate([logs - np.log(predicted), -_PULL * vector]), rcond=None)[0]
        values = dict(zip(values, map(float, vector + np.clip(change, -0.5, 0.5)), strict=True))
    return values


def _slope(robot: Robot, constant: str, wanted: list[str]) -> Times:
    slopes = robot.slopes(constant)
    return np.array([slopes[target] for target in wanted])


def _constants(model: Model, values: Mapping[str, float]) -> Constants:
    return Constants(
        {code: exp(values[model.factors[code]]) if code in model.factors else 1.0 for code in CODE},
        exp(values["kernel"]), max(0.0, values["print_call"]) * _PRINT_UNIT,
    )  # fmt: skip


def _predicted(model: Model, robot: Robot, values: Mapping[str, float]) -> Fitted:
    constants = _constants(model, values)
    return Fitted(constants, robot.times(constants))


def left_out(model: Model, robot: Robot) -> dict[str, float]:
    """Predicted over measured of each target, by the constants that are fitted without its task."""
    ratios = {}
    for own in LEFT_OUT.values():
        found = fit(model, robot, {target: time for target, time in TARGETS.items() if target not in own})
        ratios.update({target: found.ratio(target) for target in own})
    return ratios


def worst(ratios: Iterable[float]) -> float:
    """The factor by which the worst of some predictions is off."""
    return max(max(ratio, 1 / ratio) for ratio in ratios)


def worst_left_out(model: Model, robot: Robot) -> float:
    """The worst prediction of a task that was left out.

    TaskODO does not count: it is System_sprintf, a service of its own price that nothing else tells.
    """
    return worst(ratio for target, ratio in left_out(model, robot).items() if target != "TaskODO")


def tolerance(robot: Robot) -> float:
    """How far a time of code without a calibration may be off, as a factor: the worst that the model came to.

    Of the tasks that were left out, when their code has the factor 1 as such code has, and of what was never fitted.
    CHOICE: rounded up to a tenth, and taken for both directions.  Most of these times are longer than predicted;
    listings of optimised code in RAM are two to three times shorter.
    """
    never_fitted = Fitted(Constants(), robot.times(Constants()))
    worst_of_all = max(worst_left_out(EACH_DRIVER, robot), worst(never_fitted.ratio(what) for what in NEVER_FITTED))
    return ceil(10 * worst_of_all) / 10
