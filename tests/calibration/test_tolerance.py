"""The tolerance that is printed is the one that the model comes to when it has to predict."""

from __future__ import annotations

from dataclasses import replace

import pytest

from emulator.c28x.passes.costs import UNCALIBRATED_FACTOR
from firmware_model.calibration import CALIBRATED_TASKS, CALIBRATION
from tests.calibration.fit import LEFT_OUT, MODELS, SHIPPED, TARGETS, Model, Robot, fit, left_out, tolerance
from tests.calibration.robot import CODE, Constants


@pytest.fixture(scope="module")
def robot() -> Robot:
    return Robot()


def test_the_code_of_the_fit_has_every_module_that_is_calibrated() -> None:
    assert set(CALIBRATION) <= {module for modules in CODE.values() for module in modules}
    calibration = Constants().calibration
    assert {module: calibration[module] for module in CALIBRATION} == CALIBRATION
    assert all(calibration[module] == 1.0 for module in calibration.keys() - CALIBRATION.keys())
    assert set(LEFT_OUT) == CALIBRATED_TASKS


def test_the_constants_of_the_port_meet_what_they_were_fitted_to(robot: Robot) -> None:
    times = robot.times(Constants())
    for target, measured_us in TARGETS.items():
        assert times[target] == pytest.approx(measured_us, rel=0.04), target


@pytest.mark.slow
def test_a_fit_finds_constants_that_are_known(robot: Robot) -> None:
    # The model's own predictions in the place of the thesis' times: the fit must come back to what gave them.
    known = Constants({**dict.fromkeys(CODE, 1.0), "us": 1.7, "gyro": 2.5, "wheels": 3.0}, 2.0, 15_000.0)
    model = replace(SHIPPED, factors={code: code for code in ("us", "gyro", "wheels")})
    found = fit(model, robot, measured={target: robot.times(known)[target] for target in TARGETS}).constants
    for code in CODE:
        assert found.factors[code] == pytest.approx(known.factors[code], rel=0.02)
    assert found.kernel == pytest.approx(known.kernel, rel=0.02)
    assert found.print_call == pytest.approx(known.print_call, rel=0.02)


@pytest.mark.slow
def test_a_task_that_is_left_out_decides_nothing(robot: Robot) -> None:
    without = [target for target in TARGETS if target != "TaskUS"]
    found = fit(SHIPPED, robot, {target: TARGETS[target] for target in without})
    # Nothing but TaskUS tells the factor of us.c: it is that of code nobody calibrated.
    assert found.constants.factors["us"] == pytest.approx(1.0, abs=0.01)
    assert found.predicted["TaskUS"] < 0.7 * TARGETS["TaskUS"]


@pytest.mark.slow
def test_the_printed_tolerance_is_what_leaving_out_comes_to(robot: Robot) -> None:
    assert tolerance(robot) == UNCALIBRATED_FACTOR, "python -m tests.calibration --write"
    assert 1.5 < worst(SHIPPED, robot) <= UNCALIBRATED_FACTOR


@pytest.mark.slow
def test_fewer_constants_predict_better_as_the_readme_says(robot: Robot) -> None:
    models = {model.name: model for model in MODELS}
    assert worst(SHIPPED, robot) < 2.2
    assert worst(models["one factor"], robot) < 1.35
    assert worst(models["drivers"], Robot("standard")) < 1.15


def worst(model: Model, robot: Robot) -> float:
    """The worst prediction of a task that was left out.  TaskODO has a constant that nothing else tells."""
    return max(max(ratio, 1 / ratio) for target, ratio in left_out(model, robot).items() if target != "TaskODO")
