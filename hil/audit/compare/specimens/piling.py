"""Releases that come faster than they are taken."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.device_h import DelayUs
from emulator.sysbios.headers import (
    BIOS_WAIT_FOREVER,
    TRUE,
    BIOS_start,
    Clock_create,
    Clock_Params,
    Clock_Params_init,
    Semaphore_create,
    Semaphore_Handle,
    Semaphore_pend,
    Semaphore_post,
    Task_create,
    Task_Params,
    Task_Params_init,
    UArg,
)

sem: Semaphore_Handle


def release() -> void:
    Semaphore_post(sem)  # DEFECT


def task_slow(a0: UArg, a1: UArg) -> void:
    while 1:
        Semaphore_pend(sem, BIOS_WAIT_FOREVER)
        DelayUs(20000)


def run() -> void:
    clock: Clock_Params
    params: Task_Params

    sem = Semaphore_create(0, NULL, NULL)
    Clock_Params_init(addressof(clock))
    clock.period = 5
    clock.startFlag = TRUE
    Clock_create(release, 5, addressof(clock), NULL)
    Task_Params_init(addressof(params))
    params.priority = 2
    Task_create(task_slow, addressof(params), NULL)
    BIOS_start()
