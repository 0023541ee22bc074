"""pipeline.c: tasks under SYS/BIOS that share a sample behind a gate: producer, consumer by semaphore, monitor."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.sysbios.headers import (
    BIOS_WAIT_FOREVER,
    BIOS_start,
    GateMutexPri_create,
    GateMutexPri_enter,
    GateMutexPri_Handle,
    GateMutexPri_leave,
    IArg,
    Semaphore_create,
    Semaphore_Handle,
    Semaphore_pend,
    Semaphore_post,
    Task_create,
    Task_Params,
    Task_Params_init,
    Task_sleep,
    UArg,
)


class SAMPLE(struct):
    value: float32
    number: uint16


Shared: SAMPLE = (0.0, 0)
Total: float32 = 0.0
Taken: uint16 = 0
Copy: float32 = 0.0
Gate: GateMutexPri_Handle
Ready: Semaphore_Handle


# pipeline.c: Producer
def Producer(a0: UArg, a1: UArg) -> void:
    key: IArg
    n: uint16 = 0
    while 1:
        Task_sleep(5)
        key = GateMutexPri_enter(Gate)
        n += 1
        Shared.value = 0.5 * n
        Shared.number = n
        GateMutexPri_leave(Gate, key)
        Semaphore_post(Ready)


# pipeline.c: Consumer
def Consumer(a0: UArg, a1: UArg) -> void:
    key: IArg
    while 1:
        Semaphore_pend(Ready, BIOS_WAIT_FOREVER)
        key = GateMutexPri_enter(Gate)
        Total += Shared.value
        Taken = Shared.number
        GateMutexPri_leave(Gate, key)


# pipeline.c: Monitor
def Monitor(a0: UArg, a1: UArg) -> void:
    key: IArg
    while 1:
        Task_sleep(7)
        key = GateMutexPri_enter(Gate)
        Copy = Shared.value + Shared.number
        GateMutexPri_leave(Gate, key)


# pipeline.c: main
def main() -> void:
    params: Task_Params
    Gate = GateMutexPri_create(NULL, NULL)
    Ready = Semaphore_create(0, NULL, NULL)
    Task_Params_init(addressof(params))
    params.priority = 2
    params.stackSize = 512
    Task_create(Producer, addressof(params), NULL)
    params.priority = 4
    Task_create(Consumer, addressof(params), NULL)
    params.priority = 3
    Task_create(Monitor, addressof(params), NULL)
    BIOS_start()
