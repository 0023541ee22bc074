"""A C program on a kernel without a chip: its findings, and what its objects hold."""

from __future__ import annotations

from typing import Any

from emulator.c28x.memory import Memory, Pointer
from emulator.c28x.options import CompileOptions
from emulator.c28x.rts_functions import library
from emulator.c28x.runtime import Runtime
from emulator.sysbios.core import KernelError
from emulator.sysbios.watch.kernel_watch import KernelWatch
from tests.emulator.c28x.linking import link
from tests.emulator.c28x.readers.c.workshop import NAME, read
from tests.emulator.sysbios.bench import Bench

HEADERS = """\
#include <xdc/std.h>
#include <xdc/runtime/Error.h>
#include <xdc/runtime/Memory.h>
#include <ti/sysbios/BIOS.h>
#include <ti/sysbios/knl/Clock.h>
#include <ti/sysbios/knl/Event.h>
#include <ti/sysbios/knl/Mailbox.h>
#include <ti/sysbios/knl/Queue.h>
#include <ti/sysbios/knl/Semaphore.h>
#include <ti/sysbios/knl/Swi.h>
#include <ti/sysbios/knl/Task.h>
#include <ti/sysbios/family/c28/Hwi.h>
#include <ti/sysbios/gates/GateAll.h>
#include <ti/sysbios/gates/GateHwi.h>
#include <ti/sysbios/gates/GateMutex.h>
#include <ti/sysbios/gates/GateMutexPri.h>
#include <ti/sysbios/gates/GateSwi.h>
#include <ti/sysbios/gates/GateTask.h>
#include <ti/sysbios/heaps/HeapBuf.h>
#include <ti/sysbios/heaps/HeapMem.h>
#include <stdlib.h>
#include <string.h>

int seen[32];
int count = 0;
void note(int what) { seen[count++] = what; }
void task(Task_FuncPtr function, int priority)
{
    Task_Params params;
    Task_Params_init(&params);
    params.priority = priority;
    Task_create(function, &params, Error_IGNORE);
}
void once(Clock_FuncPtr function, int timeout)
{
    Clock_Params params;
    Clock_Params_init(&params);
    params.startFlag = TRUE;
    Clock_create(function, timeout, &params, Error_IGNORE);
}
"""
#: Text for programs with a heap of their own: it needs a buffer, and is made in several statements.
HEAPS = """
long pool[16];
HeapMem_Handle heapmem(void)
{
    HeapMem_Params params;
    HeapMem_Params_init(&params);
    params.buf = pool;
    params.size = sizeof(pool);
    return HeapMem_create(&params, NULL);
}
HeapBuf_Handle heapbuf(void)
{
    HeapBuf_Params params;
    HeapBuf_Params_init(&params);
    params.buf = pool;
    params.bufSize = sizeof(pool);
    params.numBlocks = 3;
    params.blockSize = 9;
    return HeapBuf_create(&params, NULL);
}
"""


class CProgram:
    """`drv.c`: the headers of the kernel, `note`, `task`, `once`, and a text with a `main`."""

    def __init__(self, text: str, *, watch: bool = True, **switches: Any) -> None:
        memory = Memory()
        self.bench = b = Bench(cost_scale=1.0, memory=memory, **switches)
        self.findings = b.findings
        runtime = Runtime(b.clock, b.cpu, b.findings, memory)
        externs = library(runtime) | dict(b.kernel.externs)
        self.lines = (HEADERS + text).splitlines()
        self.linked = link(
            read({NAME: HEADERS + text}), runtime, CompileOptions(watch=watch), registers=lambda block, name: None,
            externs=externs, replaced={},
        )  # fmt: skip
        if watch:
            KernelWatch(b.kernel, self.linked)
        #: The kernel's name of the assertion or error that ended the program.
        self.stopped = ""

    def run(self, ticks: int = 60) -> CProgram:
        """From `main` until a while after tick `ticks`, or until the kernel ends it."""
        try:
            self.bench.kernel.start(self.linked.functions["drv.main"])
            if self.bench.kernel.exit_status is None:
                self.bench.run_ticks(ticks)
        except KernelError as error:
            self.stopped = error.identifier
        self.bench.kernel.shutdown()
        return self

    def value(self, name: str) -> Any:
        """What a scalar of the program holds."""
        (value,) = self.linked.objects[f"drv.{name}"].data
        return value.addr if isinstance(value, Pointer) else value

    def seen(self) -> list[int]:
        """What the program has noted."""
        return list(self.linked.objects["drv.seen"].data[: self.value("count")])

    def rules(self) -> list[tuple[str, str]]:
        """Rule and statement of each finding."""
        return [(f.rule, self.lines[f.place.line - 1].strip() if f.place else "") for f in self.findings]


def seen(text: str, ticks: int = 60, **switches: Any) -> list[int]:
    """What a program has noted that nothing is said about.  Raises ValueError with what is said."""
    program = CProgram(text, **switches).run(ticks)
    said = [f.message for f in program.findings] + ([program.stopped] if program.stopped else [])
    if said:
        raise ValueError("; ".join(said))
    return program.seen()
