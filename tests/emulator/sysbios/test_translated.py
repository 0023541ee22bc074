"""Translated firmware on the kernel: handles, params structures, function pointers, varargs and labels fit together."""

from __future__ import annotations

from emulator.c28x.memory import Memory
from emulator.c28x.options import CompileOptions
from emulator.c28x.program import Program
from emulator.c28x.runtime import Runtime
from tests.emulator.c28x.linking import link
from tests.emulator.sysbios.bench import Bench

SOURCE = '''"""robot.c: a task that a Clock releases."""
from emulator.c28x.language import *
from emulator.sysbios.headers import (
    BIOS_WAIT_FOREVER, TRUE, BIOS_start, Clock_create, Clock_Params, Clock_Params_init, GateMutexPri_create,
    GateMutexPri_enter, GateMutexPri_Handle, GateMutexPri_leave, GateMutexPri_Params, GateMutexPri_Params_init, IArg,
    Log_write1, Semaphore_create, Semaphore_Handle, Semaphore_pend, Semaphore_post, System_sprintf, Task_create,
    Task_Params, Task_Params_init, UArg, UIABenchmark_start, UIABenchmark_stop,
)

sem: Semaphore_Handle
gate: GateMutexPri_Handle
count: int16 = 0
written: int16 = 0
text: array[char, 40]


# robot.c: release
def release() -> void:
    Semaphore_post(sem)


# robot.c: TaskDemo
def TaskDemo(a0: UArg, a1: UArg) -> void:
    key: IArg
    while 1:
        Semaphore_pend(sem, BIOS_WAIT_FOREVER)
        Log_write1(UIABenchmark_start, "demo")
        key = GateMutexPri_enter(gate)
        count += 1
        GateMutexPri_leave(gate, key)
        written = System_sprintf(text, "%d,%ld,%s", count, int32(count) * 100000, "end")
        Log_write1(UIABenchmark_stop, "demo")


# robot.c: main
def main() -> void:
    clockParams: Clock_Params
    taskParams: Task_Params
    gateParams: GateMutexPri_Params
    Clock_Params_init(addressof(clockParams))
    clockParams.period = 5
    clockParams.startFlag = TRUE
    Clock_create(release, 10, addressof(clockParams), NULL)
    Task_Params_init(addressof(taskParams))
    taskParams.stackSize = 255
    taskParams.priority = 6
    Task_create(TaskDemo, addressof(taskParams), NULL)
    GateMutexPri_Params_init(addressof(gateParams))
    gate = GateMutexPri_create(addressof(gateParams), NULL)
    sem = Semaphore_create(0, NULL, NULL)
    BIOS_start()
'''


def test_a_task_released_by_a_clock_runs_as_written() -> None:
    memory = Memory()
    b = Bench(cost_scale=1.0, memory=memory)
    b.listen()
    runtime = Runtime(b.clock, b.cpu, b.findings, memory)
    program = Program()
    program.add("robot", "robot.py", SOURCE)
    linked = link(
        program, runtime, CompileOptions(), registers=lambda block, name: None, externs=b.kernel.externs, replaced={}
    )
    b.kernel.start(linked.functions["robot.main"])
    b.run_ticks(24)
    # Released at ticks 10, 15 and 20.
    assert linked.objects["robot.count"].data == [3]
    text = "3,300000,end"
    assert linked.objects["robot.written"].data == [len(text)]
    assert linked.objects["robot.text"].data[: len(text) + 1] == [*map(ord, text), 0]
    assert b.kinds("benchmark start", "benchmark stop") == [("benchmark start", "demo"), ("benchmark stop", "demo")] * 3
    assert [task.name for task in b.kernel.tasks.all] == ["TaskDemo", "Idle"]
    assert (b.kernel.tasks.all[0].stack.words, b.kernel.tasks.all[0].priority) == (256, 6)
    assert len(b.findings) == 0
    b.kernel.shutdown()
