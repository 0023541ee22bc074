"""A busy wait above everybody else."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import DelayUs
from emulator.sysbios.headers import (
    BIOS_start,
    Task_create,
    Task_Params,
    Task_Params_init,
    Task_sleep,
    UArg,
)


def task_sensor(a0: UArg, a1: UArg) -> void:
    i: int16

    for i in range(100):
        DelayUs(20000)  # DEFECT


def task_report(a0: UArg, a1: UArg) -> void:
    while 1:
        Task_sleep(10)


def run() -> void:
    params: Task_Params

    Task_Params_init(addressof(params))
    params.priority = 5
    Task_create(task_sensor, addressof(params), NULL)
    Task_Params_init(addressof(params))
    params.priority = 1
    Task_create(task_report, addressof(params), NULL)
    BIOS_start()
