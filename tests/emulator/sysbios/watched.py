"""A few lines of firmware on the kernel, watched: what is found, and what is not."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from emulator.c28x.findings import Finding, Findings
from emulator.c28x.link import Linked
from emulator.c28x.memory import Memory
from emulator.c28x.options import CompileOptions
from emulator.c28x.program import Program
from emulator.c28x.rts_functions import library
from emulator.c28x.runtime import Runtime
from emulator.chip import delay_us
from emulator.rules.kernel import RULES
from emulator.sysbios.watch.kernel_watch import KernelWatch
from hil.robot.board import RobotBoard
from tests.emulator.c28x.linking import link
from tests.emulator.sysbios.bench import MS, Bench

HEADER = '''"""drv.c: a specimen."""
from emulator.c28x.language import *
from emulator.c28x.rts import memcpy
from emulator.device_h import *
from emulator.sysbios.headers import *

class PAIR(struct):
    V: float32
    W: float32

semA: Semaphore_Handle
semB: Semaphore_Handle
semC: Semaphore_Handle
gate: GateMutexPri_Handle
other: GateMutexPri_Handle
third: GateMutexPri_Handle


# drv.c: postA
def postA() -> void:
    Semaphore_post(semA)


# drv.c: postB
def postB() -> void:
    Semaphore_post(semB)


# drv.c: postC
def postC() -> void:
    Semaphore_post(semC)


# drv.c: task
def task(function: funcptr, priority: int16) -> void:
    params: Task_Params
    Task_Params_init(addressof(params))
    params.priority = priority
    Task_create(function, addressof(params), NULL)


# drv.c: every
def every(function: funcptr, first: uint16, period: uint32) -> void:
    params: Clock_Params
    Clock_Params_init(addressof(params))
    params.period = period
    params.startFlag = TRUE
    Clock_create(function, first, addressof(params), NULL)


# drv.c: swi
def swi(function: funcptr, priority: uint16) -> Swi_Handle:
    params: Swi_Params
    Swi_Params_init(addressof(params))
    params.priority = priority
    return Swi_create(function, addressof(params), NULL)


# drv.c: objects
def objects() -> void:
    semA = Semaphore_create(0, NULL, NULL)
    semB = Semaphore_create(0, NULL, NULL)
    semC = Semaphore_create(0, NULL, NULL)
    gate = GateMutexPri_create(NULL, NULL)
    other = GateMutexPri_create(NULL, NULL)
    third = GateMutexPri_create(NULL, NULL)

'''
KERNEL_RULES = {rule.id for rule in RULES}


class _Found:
    """What the tests ask of a run."""

    findings: Findings
    watch: KernelWatch
    lines: list[str]

    def statement(self, finding: Finding) -> str:
        """The source line that a finding names."""
        assert finding.place is not None
        return self.lines[finding.place.line - 1].strip()

    def rules(self) -> set[str]:
        """Rules of the kernel's family that were found, without the gates that a specimen happens not to use."""
        return {f.rule for f in self.findings if f.rule in KERNEL_RULES and f.rule != "gate-unused"}

    def one(self, rule: str) -> Finding:
        """The only finding of a rule."""
        (finding,) = self.findings.of(rule)
        return finding


class Watched(_Found):
    """The specimen on a kernel without a chip; its `main` must end in BIOS_start()."""

    def __init__(self, source: str, *, watch: bool = True) -> None:
        memory = Memory()
        self.bench = b = Bench(cost_scale=1.0, memory=memory)
        b.listen()
        self.events = b.events
        self.findings = b.findings
        runtime = Runtime(b.clock, b.cpu, b.findings, memory)
        self.linked = _link(source, runtime, lambda block, name: None, {
            **b.kernel.externs, "DelayUs": lambda microseconds: delay_us(b.clock, microseconds),
            "EALLOW": lambda: None, "EDIS": lambda: None,
        }, watch=watch)  # fmt: skip
        if watch:
            self.watch = KernelWatch(b.kernel, self.linked)
        self.lines = (HEADER + source).splitlines()

    def run(self, ticks: int) -> Watched:
        """Until a while after this tick."""
        if not self.bench.kernel.started:
            self.bench.kernel.start(self.linked.functions["drv.main"])
        self.bench.run_ticks(ticks)
        return self

    def interrupt(self, number: int) -> None:
        """Raise a PIE interrupt."""
        self.bench.pie.request(number)


class OnChip(_Found):
    """The specimen on a board, with its peripherals."""

    def __init__(self, source: str) -> None:
        self.board = board = RobotBoard()
        self.findings = board.findings
        runtime = Runtime(board.clock, board.cpu, board.findings, board.memory)
        self.linked = _link(source, runtime, board.register, board.externs())
        self.watch = board.watch(self.linked)
        self.lines = (HEADER + source).splitlines()

    def run(self, milliseconds: float) -> OnChip:
        """Start it and run it."""
        self.board.kernel.start(self.linked.functions["drv.main"])
        self.board.kernel.run_until(round(milliseconds * MS))
        return self


def _link(
    source: str, runtime: Runtime, registers: Any, externs: Mapping[str, Any], *, watch: bool = True
) -> Linked:  # fmt: skip
    program = Program()
    program.add("drv", "drv.py", HEADER + source)
    implemented = library(runtime) | dict(externs)
    return link(program, runtime, CompileOptions(watch=watch), registers=registers, externs=implemented, replaced={})


def found(source: str, ticks: int = 60) -> set[str]:
    """Rules found within so many ticks."""
    return Watched(source).run(ticks).rules()


RELEASES = "every(postA, 5, 5)\nevery(postB, 5, 5)"


def two_tasks(file_scope: str, high: str, low: str, *, start: str = "pass", clocks: str = RELEASES) -> str:
    """Tasks High (priority 3) and Low (2), each released every 5 ticks through semA and semB.

    In them `key`, `x`, `n` and `i` are locals.  `start` runs in main before BIOS_start.
    """

    def body(text: str) -> str:
        return "\n".join("        " + line for line in text.strip("\n").splitlines())

    return f"""
{file_scope}

# drv.c: High
def High(a0: UArg, a1: UArg) -> void:
    key: IArg
    x: float32
    n: int16
    i: int16
    while 1:
        Semaphore_pend(semA, BIOS_WAIT_FOREVER)
{body(high)}

# drv.c: Low
def Low(a0: UArg, a1: UArg) -> void:
    key: IArg
    x: float32
    n: int16
    i: int16
    while 1:
        Semaphore_pend(semB, BIOS_WAIT_FOREVER)
{body(low)}

# drv.c: main
def main() -> void:
    objects()
    task(High, 3)
    task(Low, 2)
{body(clocks).replace("        ", "    ")}
{body(start).replace("        ", "    ")}
    BIOS_start()
"""
