"""Runs a task set on the emulated kernel.  Each task computes for its time, enters its gates, and waits for a release.

Modelled
    The kernel is `emulator.sysbios` with the costs of its services.  The computation of a task is the time in the
    sheet, plus the kernel calls around it.  The gates are `GateMutexPri` (inheritance), `GateMutex` (none), or
    `GateMutexPri` with `Task_setPri` to the ceiling (ceiling).  The point of an activation at which a gate is entered
    is random.  Releases and interrupts are Hwis; there is no tick except those of the sheet.
Not modelled
    The start-up of tasks, and computation times below the largest.
Time
    Times are cycles of 5 ns; the times of the sheet are rounded up.  The first phasing is the critical instant.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from random import Random
from typing import Any, Final

from emulator.c28x.findings import Findings
from emulator.c28x.sites import Place
from emulator.clock import CYCLES_PER_MS, Clock
from emulator.cpu import Cpu
from emulator.sysbios.kernel import Kernel
from emulator.system import KERNEL_COST_SCALE
from emulator.trace import Trace
from hil.rta.analysis import Protocol, analyse
from hil.rta.observe import NS_PER_CYCLE, Observer
from hil.rta.task_set import Interrupt, Section, TaskModel, TaskSet

#: The line of CPU timer 1, whose Hwi releases the tasks.  The other interrupts use the first vectors of the PIE groups.
_RELEASE: Final = 13
_FIRST_VECTOR: Final = 32
_VECTORS_OF_A_GROUP: Final = 8
MAX_INTERRUPTS: Final = 12
_FOREVER: Final = 0xFFFFFFFF
#: The idle time between two phasings.
_QUIET_CYCLES: Final = CYCLES_PER_MS


class _Member:
    """A pointer to one member of a structure that has no memory behind it."""

    memory = None

    def __init__(self, values: dict[str, Any], name: str) -> None:
        self._values, self._name = values, name

    def load(self) -> Any:
        return self._values[self._name]

    def store(self, value: Any) -> None:
        self._values[self._name] = value

    write = store


class _Params:
    """A pointer to a structure that has no memory behind it."""

    def __init__(self) -> None:
        self.values: dict[str, Any] = {}

    def member(self, name: str) -> _Member:
        return _Member(self.values, name)


class CannotRunError(ValueError):
    """A task set that can be analysed, but cannot run."""


class SyntheticTasks:
    """The kernel with the tasks of a set.  With `cost_scale` 0, its services take no time.

    Raises CannotRunError for a set without a bound, or with activations that last beyond their next release.
    """

    def __init__(
        self, task_set: TaskSet, protocol: Protocol, *, seed: int = 1, cost_scale: float = KERNEL_COST_SCALE
    ) -> None:  # fmt: skip
        if len(task_set.interrupts) > MAX_INTERRUPTS:
            raise CannotRunError(f"{len(task_set.interrupts)} interrupts: {MAX_INTERRUPTS} at most can run here")
        for task in task_set.tasks:
            if task.priority > 15:
                raise CannotRunError(f"{task.name}: priority {task.priority}: the kernel has those from 1 to 15")
        for response in analyse(task_set, protocol):
            task = response.task
            if response.response_ns is None or response.response_ns > task.arrival.period_ns:
                raise CannotRunError(f"{task.name} may not end before its next release: such a set cannot be run")
        self.task_set = task_set
        self.protocol = protocol
        self.observer = Observer()
        self.clock = Clock()
        self._random = Random(seed)
        findings = Findings(self.clock)
        self._cpu = Cpu(self.clock, findings)
        trace = Trace(self.clock)
        trace.read(self.observer)
        self._handlers: dict[int, Callable[[], None] | None] = {}
        self.kernel = Kernel(
            self.clock, self._cpu, findings, trace, pie_set_vector=self._set_vector, pie_enable=_always,
            pie_acknowledge=_nothing, start_tick=_no_tick, cost_scale=cost_scale,
        )  # fmt: skip
        self._semaphores: dict[str, Any] = {}
        self._gates: dict[str, Any] = {}
        self._ceilings = task_set.ceilings()
        self._due: list[Any] = []
        self.kernel.start(self._main)
        # Every task comes to its first wait.
        self.kernel.run_until(self.clock.now + 100 * CYCLES_PER_MS)
        self.observer.begin()

    def close(self) -> None:
        """End the kernel."""
        self.kernel.shutdown()

    def run(self, phasings: int, progress: Callable[[float], None] = lambda fraction: None) -> None:
        """Run the critical instant, and then a number of random phasings."""
        for number in range(phasings + 1):
            self._phasing(random=number > 0)
            progress((number + 1) / (phasings + 1))

    def _phasing(self, *, random: bool) -> None:
        begin = self.clock.now + _QUIET_CYCLES
        longest = max(_cycles(task.arrival.period_ns) for task in self.task_set.tasks)
        end = begin + 2 * longest if random else begin + longest
        items: list[TaskModel | Interrupt] = [*self.task_set.tasks, *self.task_set.interrupts]
        for item in items:
            offset = self._random.randrange(_cycles(item.arrival.period_ns)) if random else 0
            self._schedule(item, begin + offset, end)
        self.kernel.run_until(end + longest)

    def _schedule(self, item: TaskModel | Interrupt, nominal: int, end: int) -> None:
        if nominal < end:
            late = self._random.randint(0, _cycles(item.arrival.jitter_ns)) if item.arrival.jitter_ns else 0
            self.clock.schedule(nominal + late, partial(self._come, item, nominal, end))

    def _come(self, item: TaskModel | Interrupt, nominal: int, end: int) -> None:
        if isinstance(item, TaskModel):
            self._due.append(self._semaphores[item.name])
            self._cpu.raise_line(_RELEASE)
        else:
            self._cpu.raise_line(1 + self.task_set.interrupts.index(item))
        self._schedule(item, max(nominal + _cycles(item.arrival.period_ns), self.clock.now), end)

    # The firmware

    def _main(self) -> None:
        kernel = self.kernel
        for task in self.task_set.tasks:
            self._semaphores[task.name] = kernel.Semaphore_create(0, None, None)
            params = _Params()
            kernel.Task_Params_init(params)
            params.values.update(priority=task.priority)
            function = partial(self._task, task)
            function.__name__ = task.name  # type: ignore[attr-defined]
            kernel.Task_create(function, params, None)
        for gate in self._ceilings:
            plain = self.protocol is Protocol.NONE
            made = kernel.GateMutex_create(None, None) if plain else kernel.GateMutexPri_create(None, None)
            made.name = gate
            self._gates[gate] = made
        kernel.hwis.create(_RELEASE, self._release, name="release")
        kernel.Hwi_enableInterrupt(_RELEASE)
        for index, interrupt in enumerate(self.task_set.interrupts):
            number = _FIRST_VECTOR + index * _VECTORS_OF_A_GROUP
            kernel.hwis.create(number, partial(self._interrupt, interrupt), name=interrupt.name)
            kernel.Hwi_enableInterrupt(number)
            self._cpu.connect(1 + index, partial(self._fetch, number))
        self._cpu.write_ier(0xFFFF)
        kernel.BIOS_start()

    def _set_vector(self, number: int, handler: Callable[[], None] | None, _begins: Place | None = None) -> None:
        if number < _FIRST_VECTOR:
            assert handler is not None
            self._cpu.connect(number, handler)
        else:
            self._handlers[number] = handler

    def _fetch(self, number: int) -> None:
        handler = self._handlers[number]
        assert handler is not None
        handler()

    def _release(self, _arg: int) -> None:
        due, self._due = self._due, []
        for semaphore in due:
            self.kernel.Semaphore_post(semaphore)

    def _interrupt(self, interrupt: Interrupt, _arg: int) -> None:
        self._compute(_cycles(interrupt.computation_ns))

    def _task(self, task: TaskModel, _arg0: int, _arg1: int) -> None:
        semaphore = self._semaphores[task.name]
        while True:
            self.kernel.Semaphore_pend(semaphore, _FOREVER)
            self._work(_cycles(task.computation_ns), task.sections)

    def _work(self, cycles: int, sections: Sequence[Section]) -> None:
        """Compute for a time, with the sections at random points in it."""
        outside = cycles - sum(_cycles(section.time_ns) for section in sections)
        at = 0
        places = sorted(self._random.randint(0, max(0, outside)) for _ in sections)
        for place, section in zip(places, sections, strict=True):
            self._compute(place - at)
            at = place
            self._within(section)
        self._compute(outside - at)

    def _within(self, section: Section) -> None:
        kernel, handle, cycles = self.kernel, self._gates[section.gate], _cycles(section.time_ns)
        if self.protocol is Protocol.NONE:
            key = kernel.GateMutex_enter(handle)
            self._work(cycles, section.inner)
            kernel.GateMutex_leave(handle, key)
            return
        own = kernel.tasks.current
        assert own is not None
        before = own.priority
        if self.protocol is Protocol.CEILING:
            kernel.Task_setPri(own, max(before, self._ceilings[section.gate]))
        key = kernel.GateMutexPri_enter(handle)
        self._work(cycles, section.inner)
        kernel.GateMutexPri_leave(handle, key)
        if self.protocol is Protocol.CEILING:
            kernel.Task_setPri(own, before)

    def _compute(self, cycles: int) -> None:
        """Use CPU time.  The task can be pre-empted at any cycle."""
        clock = self.clock
        while cycles > 0:
            step = min(cycles, max(1, clock.next - clock.now))
            cycles -= step
            clock.charge(step)

    def measured(self) -> TaskSet:
        """The task set with the largest times of the runs."""
        costs = self.kernel.core.costs
        # Around the gate, from the first to the last `Task_setPri`, the task has the raised priority, too.
        around = costs["gate_enter"] + 2 * costs["task_set_priority"] if self.protocol is Protocol.CEILING else 0
        return self.observer.measured(
            {task.name: (task.priority, task.deadline_ns) for task in self.task_set.tasks}, around_gate_cycles=around
        )


def _cycles(time_ns: int) -> int:
    return -(-time_ns // NS_PER_CYCLE)


def _always(_number: int, _on: bool) -> bool:
    return True


def _nothing(_group: int) -> None:
    pass


def _no_tick(_period_register: int, _handler: Callable[[], None]) -> None:
    return None
