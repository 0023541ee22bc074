"""What `<ti/sysbios/...>` and `<xdc/...>` give a C file: types, constants and prototypes, in the firmware language.

What the functions do stands in this package, one module an object; the linker binds them by name (`Kernel.externs`).
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
UIABenchmark_start = 1
UIABenchmark_stop = 2

Task_Handle = handle("Task_Handle")
Semaphore_Handle = handle("Semaphore_Handle")
Clock_Handle = handle("Clock_Handle")
Swi_Handle = handle("Swi_Handle")
Hwi_Handle = handle("Hwi_Handle")
GateMutexPri_Handle = handle("GateMutexPri_Handle")


class Error_Block(struct):
    """`xdc.runtime.Error`: what a create call leaves here when it fails."""

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
    event: ptr[void]
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


# GateMutexPri


@extern
def GateMutexPri_Params_init(params: ptr[GateMutexPri_Params]) -> void: ...
@extern
def GateMutexPri_create(params: ptr[GateMutexPri_Params], eb: ptr[Error_Block]) -> GateMutexPri_Handle: ...
@extern
def GateMutexPri_enter(gate: GateMutexPri_Handle) -> IArg: ...
@extern
def GateMutexPri_leave(gate: GateMutexPri_Handle, key: IArg) -> void: ...


# xdc.runtime


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
