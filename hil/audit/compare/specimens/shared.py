"""Two tasks, one object of two words, no gate."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.sysbios.headers import (
    BIOS_start,
    Task_create,
    Task_Params,
    Task_Params_init,
    Task_sleep,
    UArg,
)

speed: float32 = 0.0
turn: float32 = 0.0


def task_order(a0: UArg, a1: UArg) -> void:
    while 1:
        speed = speed + 0.1  # DEFECT
        turn = turn + 0.1
        Task_sleep(5)


def task_wheels(a0: UArg, a1: UArg) -> void:
    while 1:
        speed = speed * 0.5
        turn = turn * 0.5
        Task_sleep(7)


def run() -> void:
    params: Task_Params

    Task_Params_init(addressof(params))
    params.priority = 2
    Task_create(task_order, addressof(params), NULL)
    Task_Params_init(addressof(params))
    params.priority = 1
    Task_create(task_wheels, addressof(params), NULL)
    BIOS_start()
