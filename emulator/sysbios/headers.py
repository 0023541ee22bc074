"""The types, constants and prototypes of `<ti/sysbios/...>` and `<xdc/...>`, in the firmware language.

The modules of this package implement the functions.  The linker binds them by name (`Kernel.externs`).
A function pointer argument takes any function, as the casts of C code do; `Log_write` takes its arguments with their
own type where C casts them to IArg.
"""

# mypy: ignore-errors
# ruff: noqa: D103
from __future__ import annotations

from emulator.c28x.language import char, extern, funcptr, handle, int16, int32, ptr, struct, uint16, uint32, void

Int = int16
UInt = uint16
Int16 = int16
UInt16 = uint16
Int32 = int32
UInt32 = uint32
Bool = uint16
SizeT = uint32
Memory_Size = uint32
IArg = int32
UArg = uint32
Ptr = ptr[void]
String = ptr[char]
Void = void

FALSE = 0
TRUE = 1
BIOS_NO_WAIT = 0
BIOS_WAIT_FOREVER = 0xFFFF  # ~(0U) with a 16-bit unsigned int
BIOS_ThreadType_Hwi = 0
BIOS_ThreadType_Swi = 1
BIOS_ThreadType_Task = 2
BIOS_ThreadType_Main = 3
Semaphore_Mode_COUNTING = 0
Semaphore_Mode_BINARY = 1
Semaphore_Mode_COUNTING_PRIORITY = 2
Semaphore_Mode_BINARY_PRIORITY = 3
Task_Mode_RUNNING = 0
Task_Mode_READY = 1
Task_Mode_BLOCKED = 2
Task_Mode_TERMINATED = 3
Task_Mode_INACTIVE = 4
Hwi_MaskingOption_NONE = 0
Hwi_MaskingOption_ALL = 1
Hwi_MaskingOption_SELF = 2
Hwi_MaskingOption_BITMASK = 3
Hwi_MaskingOption_LOWER = 4
Event_Id_00 = 0x1
Event_Id_01 = 0x2
Event_Id_02 = 0x4
Event_Id_03 = 0x8
Event_Id_04 = 0x10
Event_Id_05 = 0x20
Event_Id_06 = 0x40
Event_Id_07 = 0x80
Event_Id_08 = 0x100
Event_Id_09 = 0x200
Event_Id_10 = 0x400
Event_Id_11 = 0x800
Event_Id_12 = 0x1000
Event_Id_13 = 0x2000
Event_Id_14 = 0x4000
Event_Id_15 = 0x8000
Event_Id_NONE = 0
UIABenchmark_start = 1
UIABenchmark_stop = 2
#: The period of the kernel's tick, in microseconds.
ti_sysbios_knl_Clock_tickPeriod__C = uint32(1000)
Clock_tickPeriod = ti_sysbios_knl_Clock_tickPeriod__C

Task_Handle = handle("Task_Handle")
Semaphore_Handle = handle("Semaphore_Handle")
Clock_Handle = handle("Clock_Handle")
Swi_Handle = handle("Swi_Handle")
Hwi_Handle = handle("Hwi_Handle")
GateMutexPri_Handle = handle("GateMutexPri_Handle")
GateMutex_Handle = handle("GateMutex_Handle")
GateTask_Handle = handle("GateTask_Handle")
GateSwi_Handle = handle("GateSwi_Handle")
GateHwi_Handle = handle("GateHwi_Handle")
GateAll_Handle = handle("GateAll_Handle")
Event_Handle = handle("Event_Handle")
Mailbox_Handle = handle("Mailbox_Handle")
IHeap_Handle = handle("IHeap_Handle")
HeapMem_Handle = handle("HeapMem_Handle")
HeapBuf_Handle = handle("HeapBuf_Handle")


class Error_Block(struct):
    """`xdc.runtime.Error`: a create call that fails stores its error here."""

    id: uint32


class xdc_runtime_IInstance_Params(struct):
    """What every `*_Params` points to as `instance`."""

    __size: uint32
    name: ptr[char]


class Task_Params(struct):
    """`Task_Params`; `stackSize` in 16-bit words."""

    __size: uint32
    __self: ptr[void]
    __fxns: ptr[void]
    instance: ptr[xdc_runtime_IInstance_Params]
    arg0: uint32
    arg1: uint32
    priority: int16
    stack: ptr[void]
    stackSize: uint32
    stackHeap: ptr[void]
    env: ptr[void]
    vitalTaskFlag: uint16
    affinity: uint16


class Semaphore_Params(struct):
    """`Semaphore_Params`."""

    __size: uint32
    __self: ptr[void]
    __fxns: ptr[void]
    instance: ptr[xdc_runtime_IInstance_Params]
    event: Event_Handle
    eventId: uint16
    mode: uint16


class Clock_Params(struct):
    """`Clock_Params`; `period` in ticks."""

    __size: uint32
    __self: ptr[void]
    __fxns: ptr[void]
    instance: ptr[xdc_runtime_IInstance_Params]
    startFlag: uint16
    period: uint32
    arg: uint32


class Swi_Params(struct):
    """`Swi_Params`."""

    __size: uint32
    __self: ptr[void]
    __fxns: ptr[void]
    instance: ptr[xdc_runtime_IInstance_Params]
    arg0: uint32
    arg1: uint32
    priority: uint16
    trigger: uint16


class Hwi_Params(struct):
    """`Hwi_Params` of the C28x family."""

    __size: uint32
    __self: ptr[void]
    __fxns: ptr[void]
    instance: ptr[xdc_runtime_IInstance_Params]
    maskSetting: uint16
    arg: uint32
    enableInt: uint16
    eventId: int16
    priority: int16
    disableMask: uint16
    restoreMask: uint16
    enableAck: uint16


class GateMutexPri_Params(struct):
    """`GateMutexPri_Params`."""

    __size: uint32
    __self: ptr[void]
    __fxns: ptr[void]
    instance: ptr[xdc_runtime_IInstance_Params]


class GateMutex_Params(struct):
    """`GateMutex_Params`."""

    __size: uint32
    __self: ptr[void]
    __fxns: ptr[void]
    instance: ptr[xdc_runtime_IInstance_Params]


class GateTask_Params(struct):
    """`GateTask_Params`."""

    __size: uint32
    __self: ptr[void]
    __fxns: ptr[void]
    instance: ptr[xdc_runtime_IInstance_Params]


class GateSwi_Params(struct):
    """`GateSwi_Params`."""

    __size: uint32
    __self: ptr[void]
    __fxns: ptr[void]
    instance: ptr[xdc_runtime_IInstance_Params]


class GateHwi_Params(struct):
    """`GateHwi_Params`."""

    __size: uint32
    __self: ptr[void]
    __fxns: ptr[void]
    instance: ptr[xdc_runtime_IInstance_Params]


class GateAll_Params(struct):
    """`GateAll_Params`."""

    __size: uint32
    __self: ptr[void]
    __fxns: ptr[void]
    instance: ptr[xdc_runtime_IInstance_Params]


class Event_Params(struct):
    """`Event_Params`."""

    __size: uint32
    __self: ptr[void]
    __fxns: ptr[void]
    instance: ptr[xdc_runtime_IInstance_Params]


class Queue_Params(struct):
    """`Queue_Params`."""

    __size: uint32
    __self: ptr[void]
    __fxns: ptr[void]
    instance: ptr[xdc_runtime_IInstance_Params]


class Queue_Elem(struct):
    """`Queue_Elem`: each element of a queue begins with one."""

    next: ptr[Queue_Elem]
    prev: ptr[Queue_Elem]


class Queue_Object(struct):
    """The object behind a `Queue_Handle`: the element that head and tail are tied to."""

    elem: Queue_Elem


Queue_Handle = ptr[Queue_Object]


class Mailbox_Params(struct):
    """`Mailbox_Params`; `bufSize` in 16-bit words."""

    __size: uint32
    __self: ptr[void]
    __fxns: ptr[void]
    instance: ptr[xdc_runtime_IInstance_Params]
    heap: ptr[void]
    readerEvent: Event_Handle
    readerEventId: uint16
    writerEvent: Event_Handle
    writerEventId: uint16
    buf: ptr[void]
    bufSize: uint16


class HeapMem_Params(struct):
    """`HeapMem_Params`; sizes in 16-bit words."""

    __size: uint32
    __self: ptr[void]
    __fxns: ptr[void]
    instance: ptr[xdc_runtime_IInstance_Params]
    minBlockAlign: uint32
    buf: ptr[void]
    size: uint32


class HeapBuf_Params(struct):
    """`HeapBuf_Params`; sizes in 16-bit words."""

    __size: uint32
    __self: ptr[void]
    __fxns: ptr[void]
    instance: ptr[xdc_runtime_IInstance_Params]
    align: uint32
    numBlocks: uint16
    blockSize: uint32
    bufSize: uint32
    buf: ptr[void]


class Memory_Stats(struct):
    """`xdc.runtime.Memory.Stats`, in 16-bit words."""

    totalSize: uint32
    totalFreeSize: uint32
    largestFreeSize: uint32


# BIOS


@extern
def BIOS_start() -> void: ...
@extern
def BIOS_exit(status: Int) -> void: ...
@extern
def BIOS_getThreadType() -> UInt: ...


# Task


@extern
def Task_Params_init(params: ptr[Task_Params]) -> void: ...
@extern
def Task_create(fxn: funcptr, params: ptr[Task_Params], eb: ptr[Error_Block]) -> Task_Handle: ...
@extern
def Task_sleep(nticks: UInt32) -> void: ...
@extern
def Task_yield() -> void: ...
@extern
def Task_disable() -> UInt: ...
@extern
def Task_enable() -> void: ...
@extern
def Task_restore(key: UInt) -> void: ...
@extern
def Task_setPri(task: Task_Handle, priority: Int) -> Int: ...
@extern
def Task_getPri(task: Task_Handle) -> Int: ...
@extern
def Task_getMode(task: Task_Handle) -> UInt: ...
@extern
def Task_self() -> Task_Handle: ...
@extern
def Task_getIdleTask() -> Task_Handle: ...
@extern
def Task_exit() -> void: ...
@extern
def Task_delete(task: ptr[Task_Handle]) -> void: ...


# Semaphore


@extern
def Semaphore_Params_init(params: ptr[Semaphore_Params]) -> void: ...
@extern
def Semaphore_create(count: Int, params: ptr[Semaphore_Params], eb: ptr[Error_Block]) -> Semaphore_Handle: ...
@extern
def Semaphore_pend(semaphore: Semaphore_Handle, timeout: UInt32) -> Bool: ...
@extern
def Semaphore_post(semaphore: Semaphore_Handle) -> void: ...
@extern
def Semaphore_getCount(semaphore: Semaphore_Handle) -> Int: ...
@extern
def Semaphore_reset(semaphore: Semaphore_Handle, count: Int) -> void: ...
@extern
def Semaphore_registerEvent(semaphore: Semaphore_Handle, event: Event_Handle, eventId: UInt) -> void: ...
@extern
def Semaphore_delete(semaphore: ptr[Semaphore_Handle]) -> void: ...


# Clock


@extern
def Clock_Params_init(params: ptr[Clock_Params]) -> void: ...
@extern
def Clock_create(fxn: funcptr, timeout: UInt, params: ptr[Clock_Params], eb: ptr[Error_Block]) -> Clock_Handle: ...
@extern
def Clock_start(clock: Clock_Handle) -> void: ...
@extern
def Clock_stop(clock: Clock_Handle) -> void: ...
@extern
def Clock_setPeriod(clock: Clock_Handle, period: UInt32) -> void: ...
@extern
def Clock_setTimeout(clock: Clock_Handle, timeout: UInt32) -> void: ...
@extern
def Clock_setFunc(clock: Clock_Handle, fxn: funcptr, arg: UArg) -> void: ...
@extern
def Clock_getPeriod(clock: Clock_Handle) -> UInt32: ...
@extern
def Clock_getTimeout(clock: Clock_Handle) -> UInt32: ...
@extern
def Clock_isActive(clock: Clock_Handle) -> Bool: ...
@extern
def Clock_getTicks() -> UInt32: ...
@extern
def Clock_getTickPeriod() -> UInt32: ...
@extern
def Clock_delete(clock: ptr[Clock_Handle]) -> void: ...


# Swi


@extern
def Swi_Params_init(params: ptr[Swi_Params]) -> void: ...
@extern
def Swi_create(fxn: funcptr, params: ptr[Swi_Params], eb: ptr[Error_Block]) -> Swi_Handle: ...
@extern
def Swi_post(swi: Swi_Handle) -> void: ...
@extern
def Swi_or(swi: Swi_Handle, mask: UInt) -> void: ...
@extern
def Swi_inc(swi: Swi_Handle) -> void: ...
@extern
def Swi_andn(swi: Swi_Handle, mask: UInt) -> void: ...
@extern
def Swi_dec(swi: Swi_Handle) -> void: ...
@extern
def Swi_getTrigger() -> UInt: ...
@extern
def Swi_getPri(swi: Swi_Handle) -> UInt: ...
@extern
def Swi_self() -> Swi_Handle: ...
@extern
def Swi_disable() -> UInt: ...
@extern
def Swi_enable() -> void: ...
@extern
def Swi_restore(key: UInt) -> void: ...
@extern
def Swi_delete(swi: ptr[Swi_Handle]) -> void: ...


# Hwi


@extern
def Hwi_Params_init(params: ptr[Hwi_Params]) -> void: ...
@extern
def Hwi_create(intNum: Int, fxn: funcptr, params: ptr[Hwi_Params], eb: ptr[Error_Block]) -> Hwi_Handle: ...
@extern
def Hwi_disable() -> UInt: ...
@extern
def Hwi_enable() -> UInt: ...
@extern
def Hwi_restore(key: UInt) -> void: ...
@extern
def Hwi_enableInterrupt(intNum: UInt) -> UInt: ...
@extern
def Hwi_disableInterrupt(intNum: UInt) -> UInt: ...
@extern
def Hwi_delete(hwi: ptr[Hwi_Handle]) -> void: ...


# GateMutexPri


@extern
def GateMutexPri_Params_init(params: ptr[GateMutexPri_Params]) -> void: ...
@extern
def GateMutexPri_create(params: ptr[GateMutexPri_Params], eb: ptr[Error_Block]) -> GateMutexPri_Handle: ...
@extern
def GateMutexPri_enter(gate: GateMutexPri_Handle) -> IArg: ...
@extern
def GateMutexPri_leave(gate: GateMutexPri_Handle, key: IArg) -> void: ...
@extern
def GateMutexPri_delete(gate: ptr[GateMutexPri_Handle]) -> void: ...


# GateMutex


@extern
def GateMutex_Params_init(params: ptr[GateMutex_Params]) -> void: ...
@extern
def GateMutex_create(params: ptr[GateMutex_Params], eb: ptr[Error_Block]) -> GateMutex_Handle: ...
@extern
def GateMutex_delete(gate: ptr[GateMutex_Handle]) -> void: ...
@extern
def GateMutex_enter(gate: GateMutex_Handle) -> IArg: ...
@extern
def GateMutex_leave(gate: GateMutex_Handle, key: IArg) -> void: ...


# GateTask


@extern
def GateTask_Params_init(params: ptr[GateTask_Params]) -> void: ...
@extern
def GateTask_create(params: ptr[GateTask_Params], eb: ptr[Error_Block]) -> GateTask_Handle: ...
@extern
def GateTask_delete(gate: ptr[GateTask_Handle]) -> void: ...
@extern
def GateTask_enter(gate: GateTask_Handle) -> IArg: ...
@extern
def GateTask_leave(gate: GateTask_Handle, key: IArg) -> void: ...


# GateSwi


@extern
def GateSwi_Params_init(params: ptr[GateSwi_Params]) -> void: ...
@extern
def GateSwi_create(params: ptr[GateSwi_Params], eb: ptr[Error_Block]) -> GateSwi_Handle: ...
@extern
def GateSwi_delete(gate: ptr[GateSwi_Handle]) -> void: ...
@extern
def GateSwi_enter(gate: GateSwi_Handle) -> IArg: ...
@extern
def GateSwi_leave(gate: GateSwi_Handle, key: IArg) -> void: ...


# GateHwi


@extern
def GateHwi_Params_init(params: ptr[GateHwi_Params]) -> void: ...
@extern
def GateHwi_create(params: ptr[GateHwi_Params], eb: ptr[Error_Block]) -> GateHwi_Handle: ...
@extern
def GateHwi_delete(gate: ptr[GateHwi_Handle]) -> void: ...
@extern
def GateHwi_enter(gate: GateHwi_Handle) -> IArg: ...
@extern
def GateHwi_leave(gate: GateHwi_Handle, key: IArg) -> void: ...


# GateAll


@extern
def GateAll_Params_init(params: ptr[GateAll_Params]) -> void: ...
@extern
def GateAll_create(params: ptr[GateAll_Params], eb: ptr[Error_Block]) -> GateAll_Handle: ...
@extern
def GateAll_delete(gate: ptr[GateAll_Handle]) -> void: ...
@extern
def GateAll_enter(gate: GateAll_Handle) -> IArg: ...
@extern
def GateAll_leave(gate: GateAll_Handle, key: IArg) -> void: ...


# Event


@extern
def Event_Params_init(params: ptr[Event_Params]) -> void: ...
@extern
def Event_create(params: ptr[Event_Params], eb: ptr[Error_Block]) -> Event_Handle: ...
@extern
def Event_delete(event: ptr[Event_Handle]) -> void: ...
@extern
def Event_pend(event: Event_Handle, andMask: UInt, orMask: UInt, timeout: UInt32) -> UInt: ...
@extern
def Event_post(event: Event_Handle, eventMask: UInt) -> void: ...
@extern
def Event_sync(event: Event_Handle, eventId: UInt, count: UInt) -> void: ...
@extern
def Event_getPostedEvents(event: Event_Handle) -> UInt: ...


# Mailbox


@extern
def Mailbox_Params_init(params: ptr[Mailbox_Params]) -> void: ...
@extern
def Mailbox_create(
    msgSize: SizeT, numMsgs: UInt, params: ptr[Mailbox_Params], eb: ptr[Error_Block]
) -> Mailbox_Handle: ...
@extern
def Mailbox_delete(mailbox: ptr[Mailbox_Handle]) -> void: ...
@extern
def Mailbox_pend(mailbox: Mailbox_Handle, msg: Ptr, timeout: UInt32) -> Bool: ...
@extern
def Mailbox_post(mailbox: Mailbox_Handle, msg: Ptr, timeout: UInt32) -> Bool: ...
@extern
def Mailbox_getMsgSize(mailbox: Mailbox_Handle) -> SizeT: ...
@extern
def Mailbox_getNumFreeMsgs(mailbox: Mailbox_Handle) -> Int: ...
@extern
def Mailbox_getNumPendingMsgs(mailbox: Mailbox_Handle) -> Int: ...


# Queue


@extern
def Queue_Params_init(params: ptr[Queue_Params]) -> void: ...
@extern
def Queue_create(params: ptr[Queue_Params], eb: ptr[Error_Block]) -> Queue_Handle: ...
@extern
def Queue_delete(queue: ptr[Queue_Handle]) -> void: ...
@extern
def Queue_empty(queue: Queue_Handle) -> Bool: ...
@extern
def Queue_get(queue: Queue_Handle) -> Ptr: ...
@extern
def Queue_getTail(queue: Queue_Handle) -> Ptr: ...
@extern
def Queue_dequeue(queue: Queue_Handle) -> Ptr: ...
@extern
def Queue_put(queue: Queue_Handle, elem: ptr[Queue_Elem]) -> void: ...
@extern
def Queue_putHead(queue: Queue_Handle, elem: ptr[Queue_Elem]) -> void: ...
@extern
def Queue_enqueue(queue: Queue_Handle, elem: ptr[Queue_Elem]) -> void: ...
@extern
def Queue_head(queue: Queue_Handle) -> Ptr: ...
@extern
def Queue_next(qelem: ptr[Queue_Elem]) -> Ptr: ...
@extern
def Queue_prev(qelem: ptr[Queue_Elem]) -> Ptr: ...
@extern
def Queue_insert(qelem: ptr[Queue_Elem], elem: ptr[Queue_Elem]) -> void: ...
@extern
def Queue_remove(qelem: ptr[Queue_Elem]) -> void: ...
@extern
def Queue_elemClear(qelem: ptr[Queue_Elem]) -> void: ...
@extern
def Queue_isQueued(qelem: ptr[Queue_Elem]) -> Bool: ...


# HeapMem


@extern
def HeapMem_Params_init(params: ptr[HeapMem_Params]) -> void: ...
@extern
def HeapMem_create(params: ptr[HeapMem_Params], eb: ptr[Error_Block]) -> HeapMem_Handle: ...
@extern
def HeapMem_delete(heap: ptr[HeapMem_Handle]) -> void: ...
@extern
def HeapMem_alloc(heap: HeapMem_Handle, size: SizeT, align: SizeT, eb: ptr[Error_Block]) -> Ptr: ...
@extern
def HeapMem_free(heap: HeapMem_Handle, block: Ptr, size: SizeT) -> void: ...
@extern
def HeapMem_getStats(heap: HeapMem_Handle, stats: ptr[Memory_Stats]) -> void: ...
@extern
def HeapMem_Handle_upCast(heap: HeapMem_Handle) -> IHeap_Handle: ...


# HeapBuf


@extern
def HeapBuf_Params_init(params: ptr[HeapBuf_Params]) -> void: ...
@extern
def HeapBuf_create(params: ptr[HeapBuf_Params], eb: ptr[Error_Block]) -> HeapBuf_Handle: ...
@extern
def HeapBuf_delete(heap: ptr[HeapBuf_Handle]) -> void: ...
@extern
def HeapBuf_alloc(heap: HeapBuf_Handle, size: SizeT, align: SizeT, eb: ptr[Error_Block]) -> Ptr: ...
@extern
def HeapBuf_free(heap: HeapBuf_Handle, block: Ptr, size: SizeT) -> void: ...
@extern
def HeapBuf_getStats(heap: HeapBuf_Handle, stats: ptr[Memory_Stats]) -> void: ...
@extern
def HeapBuf_Handle_upCast(heap: HeapBuf_Handle) -> IHeap_Handle: ...


# xdc.runtime


@extern
def Memory_alloc(heap: IHeap_Handle, size: SizeT, align: SizeT, eb: ptr[Error_Block]) -> Ptr: ...
@extern
def Memory_calloc(heap: IHeap_Handle, size: SizeT, align: SizeT, eb: ptr[Error_Block]) -> Ptr: ...
@extern
def Memory_valloc(heap: IHeap_Handle, size: SizeT, align: SizeT, value: char, eb: ptr[Error_Block]) -> Ptr: ...
@extern
def Memory_free(heap: IHeap_Handle, block: Ptr, size: SizeT) -> void: ...
@extern
def Memory_getStats(heap: IHeap_Handle, stats: ptr[Memory_Stats]) -> void: ...
@extern
def Memory_getMaxDefaultTypeAlign() -> SizeT: ...
@extern
def System_printf(fmt: ptr[char], *arguments) -> Int: ...
@extern
def System_sprintf(buf: ptr[char], fmt: ptr[char], *arguments) -> Int: ...
@extern
def System_snprintf(buf: ptr[char], n: SizeT, fmt: ptr[char], *arguments) -> Int: ...
@extern
def System_flush() -> void: ...
@extern
def System_abort(text: ptr[char]) -> void: ...
@extern
def System_exit(status: Int) -> void: ...
@extern
def Log_write0(event: UInt) -> void: ...
@extern
def Log_write1(event: UInt, *arguments) -> void: ...
@extern
def Log_write2(event: UInt, *arguments) -> void: ...
@extern
def Log_write3(event: UInt, *arguments) -> void: ...
@extern
def Error_init(eb: ptr[Error_Block]) -> void: ...
@extern
def Error_check(eb: ptr[Error_Block]) -> Bool: ...
@extern
def Error_getId(eb: ptr[Error_Block]) -> UInt32: ...
