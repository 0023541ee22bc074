"""The tolerance that is printed is the one that the model comes to when it has to predict."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import cache

import pytest

from emulator.c28x.float_division import DEFAULT_FLOAT_DIVISION
from emulator.c28x.passes.costs import UNCALIBRATED_FACTOR
from firmware_model.calibration import CALIBRATED_TASKS, CALIBRATION
from hil.cli.tasks import PUBLISHED
from tests.calibration.fit import (
    EACH_DRIVER,
    EACH_TASK,
    LEFT_OUT,
    MODELS,
    SHIPPED,
    TARGETS,
    Robot,
    fit,
    tolerance,
    worst_left_out,
)
from tests.calibration.page import BUILDS, cells, cells_of_page
from tests.calibration.robot import CODE, Constants


@pytest.fixture(scope="module")
def robots() -> Callable[[str], Robot]:
    """The robot of a build: each keeps what it has measured."""
    return cache(Robot)


@pytest.fixture
def robot(robots: Callable[[str], Robot]) -> Robot:
    return robots(DEFAULT_FLOAT_DIVISION)


def test_the_code_of_the_fit_has_every_module_that_is_calibrated() -> None:
    assert set(CALIBRATION) <= {module for modules in CODE.values() for module in modules}
    calibration = Constants().calibration
    assert {module: calibration[module] for module in CALIBRATION} == CALIBRATION
    assert all(calibration[module] == 1.0 for module in calibration.keys() - CALIBRATION.keys())
    assert set(LEFT_OUT) == CALIBRATED_TASKS


def test_the_constants_of_the_port_meet_what_they_were_fitted_to(robot: Robot) -> None:
    times = robot.times(Constants())
    for target, measured_us in TARGETS.items():
        assert times[target] == pytest.approx(measured_us, rel=0.045), target


def test_every_task_keeps_to_the_figures_of_the_thesis(robot: Robot) -> None:
    # Figures 37 and 39: between the shortest and the longest time.
    times = robot.times(Constants())
    for what in [*CALIBRATED_TASKS, "TaskSERVO driving"]:
        figures = PUBLISHED[what.removesuffix(" driving")].times_us
        assert min(figures) <= times[what] <= max(figures), what


@pytest.mark.slow
def test_a_fit_finds_constants_that_are_known(robot: Robot) -> None:
    # The model's own predictions in the place of the thesis' times: the fit must come back to what gave them.
    known = Constants({**dict.fromkeys(CODE, 1.0), "us": 1.7, "gyro": 2.5, "wheels": 3.0}, 2.0, 15_000.0)
    measured = {target: robot.times(known)[target] for target in TARGETS}
    found = fit(EACH_DRIVER, robot, measured).constants
    for code in CODE:
        assert found.factors[code] == pytest.approx(known.factors[code], rel=0.02)
    assert found.kernel == pytest.approx(known.kernel, rel=0.02)
    assert found.print_call == pytest.approx(known.print_call, rel=0.02)


@pytest.mark.slow
def test_a_task_that_is_left_out_decides_nothing(robot: Robot) -> None:
    without = [target for target in TARGETS if target != "TaskUS"]
    found = fit(EACH_DRIVER, robot, {target: TARGETS[target] for target in without})
    # Nothing but TaskUS tells the factor of us.c: it is that of code nobody calibrated.
    assert found.constants.factors["us"] == pytest.approx(1.0, abs=0.01)
    assert found.predicted["TaskUS"] < 0.7 * TARGETS["TaskUS"]


@pytest.mark.slow
def test_the_printed_tolerance_is_what_leaving_out_comes_to(robot: Robot) -> None:
    assert tolerance(robot) == UNCALIBRATED_FACTOR, "python -m tests.calibration --write"
    assert 1.5 < worst_left_out(EACH_DRIVER, robot) <= UNCALIBRATED_FACTOR


@pytest.mark.slow
@pytest.mark.parametrize("build", BUILDS)
def test_the_page_shows_what_each_model_comes_to(build: str, robots: Callable[[str], Robot]) -> None:
    # Half a second of CPU a fit, 12 fits a model: the simplest one that the text speaks of, or the shipped one.
    fast = SHIPPED.name if build == "calibrated" else "one factor"
    shown = [
        (model, row)
        for model, row in zip(MODELS, cells_of_page(build), strict=True)
        if os.environ.get("HIL_CALIBRATION") == "all" or model.name == fast
    ]
    found = cells(robots(build), [model for model, _ in shown])
    assert found == [row for _, row in shown], "python -m tests.calibration --write"


def test_no_fewer_factors_fit_and_more_predict_worse_by_the_table_of_the_page() -> None:
    fitted, left_out = (
        {model.name: float(row[column]) for model, row in zip(MODELS, cells_of_page("calibrated"), strict=True)}
        for column in (0, 1)
    )
    shipped = len(SHIPPED.constants)
    assert fitted[SHIPPED.name] < 1.04
    assert all(fitted[model.name] > 1.05 for model in MODELS if len(model.constants) < shipped)
    assert left_out[SHIPPED.name] < left_out[EACH_TASK.name]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["one factor", "drivers"])
def test_what_predicts_best_does_not_keep_to_the_figures_of_the_thesis(
    name: str, robots: Callable[[str], Robot]
) -> None:  # fmt: skip
    (model,) = (model for model in MODELS if model.name == name)
    predicted = fit(model, robots("standard")).predicted
    gyro, navigation = PUBLISHED["TaskGYRO"].times_us, PUBLISHED["TaskNAVIGATION"].times_us
    assert predicted["TaskGYRO"] < 0.9 * min(gyro)
    assert predicted["TaskNAVIGATION"] > max(navigation)
