"""task_queue.c: a sampler fills a queue, a worker empties it, a reporter copies the sums under the gate."""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.sysbios.headers import (
    BIOS_start,
    BIOS_WAIT_FOREVER,
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

QUEUE = 4


class ITEM(struct):
    number: uint16
    value: int32


class TOTALS(struct):
    sum: int32
    count: uint16
    largest: int32


Queue: array[ITEM, QUEUE]
Put_At: uint16 = 0
Get_At: uint16 = 0
Free: Semaphore_Handle
Full: Semaphore_Handle
Lock: GateMutexPri_Handle
Guard: GateMutexPri_Handle
Totals: TOTALS = (0, 0, 0)
Report: TOTALS = (0, 0, 0)


# task_queue.c: Queue_Put
def Queue_Put(number: uint16, value: int32) -> void:
    key: IArg
    Semaphore_pend(Free, BIOS_WAIT_FOREVER)
    key = GateMutexPri_enter(Guard)
    Queue[Put_At].number = number
    Queue[Put_At].value = value
    Put_At = (Put_At + 1) % QUEUE
    GateMutexPri_leave(Guard, key)
    Semaphore_post(Full)


# task_queue.c: Queue_Get
def Queue_Get(item: ptr[ITEM]) -> void:
    key: IArg
    Semaphore_pend(Full, BIOS_WAIT_FOREVER)
    key = GateMutexPri_enter(Guard)
    item.number = Queue[Get_At].number
    item.value = Queue[Get_At].value
    Get_At = (Get_At + 1) % QUEUE
    GateMutexPri_leave(Guard, key)
    Semaphore_post(Free)


# task_queue.c: Sampler
def Sampler(a0: UArg, a1: UArg) -> void:
    n: uint16 = 0
    while 1:
        Task_sleep(3)
        n += 1
        Queue_Put(n, int32(n) * 1000)


# task_queue.c: Worker
def Worker(a0: UArg, a1: UArg) -> void:
    key: IArg
    item: ITEM
    while 1:
        Queue_Get(addressof(item))
        key = GateMutexPri_enter(Lock)
        Totals.sum += item.value
        Totals.count += 1
        if item.value > Totals.largest:
            Totals.largest = item.value
        GateMutexPri_leave(Lock, key)


# task_queue.c: Reporter
def Reporter(a0: UArg, a1: UArg) -> void:
    key: IArg
    while 1:
        Task_sleep(10)
        key = GateMutexPri_enter(Lock)
        Report.sum = Totals.sum
        Report.count = Totals.count
        Report.largest = Totals.largest
        GateMutexPri_leave(Lock, key)


# task_queue.c: main
def main() -> void:
    params: Task_Params
    Lock = GateMutexPri_create(NULL, NULL)
    Guard = GateMutexPri_create(NULL, NULL)
    Free = Semaphore_create(QUEUE, NULL, NULL)
    Full = Semaphore_create(0, NULL, NULL)
    Task_Params_init(addressof(params))
    params.stackSize = 512
    params.priority = 5
    Task_create(Sampler, addressof(params), NULL)
    params.priority = 3
    Task_create(Worker, addressof(params), NULL)
    params.priority = 4
    Task_create(Reporter, addressof(params), NULL)
    BIOS_start()
