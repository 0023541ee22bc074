"""Which times were calibrated, and how far those are off."""

from __future__ import annotations

import pytest

from emulator.c28x.program import Program
from firmware_model.calibration import CALIBRATED_TASKS
from firmware_model.image import MODULES
from hil.tolerance import residual_percent, tasks_of
from tests.emulator.c28x.workshop import HEADER

MINE = """
def Deep() -> uint16:
    return 1
def Middle() -> uint16:
    return Deep()
"""
TASKS = """
def TaskA() -> uint16:
    return Middle()
def TaskB() -> uint16:
    return 1
def TaskC() -> uint16:
    while 1:
        if TaskA() == 2:
            return 1
    return 0
"""


@pytest.fixture(scope="module")
def program() -> Program:
    program = Program()
    program.add("mine", "/mine.py", HEADER + MINE)
    program.add("tasks", "/tasks.py", HEADER + "from mine import Middle\n" + TASKS)
    program.translate()
    return program


def test_a_residual_is_against_the_longest_and_the_shortest_time() -> None:
    assert residual_percent(10.0, [8.0, 12.5, 10.0]) == pytest.approx((-20.0, 25.0))
    assert residual_percent(10.0, [10.0]) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("files", "found"),
    [
        (("/mine.py",), {"TaskA", "TaskC", "TaskA#2"}),
        (("/other.py",), set()),
        (("/tasks.py",), {"TaskA", "TaskB", "TaskC", "TaskA#2"}),
    ],
)
def test_a_task_is_the_users_if_a_function_of_the_users_is_called_in_it(
    program: Program, files: tuple[str, ...], found: set[str]
) -> None:
    tasks = ["TaskA", "TaskB", "TaskC", "TaskA#2"]
    assert tasks_of(files, program.modules.values(), tasks) == found


def test_a_task_without_a_function_of_its_name_is_not_claimed_to_be_calibrated(program: Program) -> None:
    assert tasks_of(["/mine.py"], program.modules.values(), ["Unknown"]) == {"Unknown"}
    assert tasks_of([], program.modules.values(), ["Unknown", "TaskA"]) == set()  # the port alone


def test_every_task_of_the_port_runs_its_servers_and_none_of_it_runs_nothing() -> None:
    program = Program(MODULES)
    modules = program.translate()
    servers = program.modules["firmware_model.servidores"].file
    assert tasks_of([servers], modules, CALIBRATED_TASKS) == CALIBRATED_TASKS
    us = program.modules["firmware_model.us"].file
    assert tasks_of([us], modules, CALIBRATED_TASKS) == {"TaskUS"}
