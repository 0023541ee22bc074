"""The running thread: its vector clock, what it holds off, and the CPU time it has used.

A thread is a task, a Swi, a Hwi, or the function of a Clock object.  Each Clock function counts as a Swi of its own:
a post by one of them orders nothing for the others.  Until BIOS_start there is `main`; in a program without
the kernel, `main` and the routines of the vector table.

A thread's vector clock (L. Lamport 1978, C. Fidge 1988) says how far it knows the others.  A release (post, Swi_post,
create, start) stores the clock of the releasing thread at the object.  An acquire (pend, the start of the Swi or Hwi)
takes it over.  What one thread did before it released is ordered before what the other does after it acquired.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, NamedTuple

from emulator.cpu import INTERRUPT_ENTRY_CYCLES, INTERRUPT_EXIT_CYCLES
from emulator.registers.cell import Cell
from emulator.sysbios.clock import ClockObject
from emulator.sysbios.gate_mutex import GateMutex
from emulator.sysbios.gate_mutex_pri import GateMutexPri
from emulator.sysbios.hwi import FIRST_PIE, Hwi, ier_bit
from emulator.sysbios.kernel import Kernel
from emulator.sysbios.scheduler import PRIORITIES, READY, Task
from emulator.sysbios.swi import Swi
from emulator.sysbios.timer import TIMER_INTERRUPT
from emulator.trace import Trace

#: Levels: tasks 0..15, Swis 16..31, interrupts above.  They pre-empt upwards only.
SWI_LEVEL: Final = PRIORITIES
HWI_LEVEL: Final = 2 * PRIORITIES
ALL_LINES: Final = 0x3FFF

VectorClock = tuple[int, ...]
#: A gate that a task can own.
Gate = GateMutexPri | GateMutex
_NO_GATES: Final[frozenset[Gate]] = frozenset()


#: A register, and the mask of a bit in it.
Enable = tuple[Cell, int]
#: The bits that let an interrupt through: its own bit (PIEIER's, or a timer's TIE) must be set, one of the enables at
#: the peripheral too, and none of those that stop the peripheral.
Enables = tuple[Enable, tuple[Enable, ...], tuple[Enable, ...]]


class Protection:
    """What protects an access: the gates held, the highest level that cannot pre-empt, the interrupts held off.

    `ThreadWatch.protected` makes them: equal ones are one object.
    """

    __slots__ = ("ceiling", "disabled", "gates", "lines")

    def __init__(self, gates: frozenset[Gate], ceiling: int, lines: int, disabled: int) -> None:
        self.gates = gates
        self.ceiling = ceiling
        #: CPU lines masked by INTM or IER, bit 0 is line 1.
        self.lines = lines
        #: Interrupts that are disabled one by one: their bits (`ThreadWatch.bit`).
        self.disabled = disabled


class _Gated:
    """An interrupt with a handler, that a driver can hold off by the enables of its peripheral."""

    __slots__ = ("_bit", "_line", "_mask", "_sources", "_stops")

    def __init__(self, bit: int, line: Enable, sources: tuple[Enable, ...], stops: tuple[Enable, ...]) -> None:
        self._bit = bit
        self._line, self._mask = line
        self._sources = sources
        self._stops = stops

    def registers(self) -> list[Cell]:
        """The registers that its enables are in."""
        return [self._line, *(register for register, _ in (*self._sources, *self._stops))]

    def held_off(self) -> int:
        """Its bit while it cannot come through, else 0."""
        for register, mask in self._stops:
            if register.value & mask:
                return self._bit
        if self._line.value & self._mask:
            for register, mask in self._sources:
                if register.value & mask:
                    return 0
        return self._bit


class _Enabling:
    """A register with enables of handlers, and its word when it was looked at last."""

    __slots__ = ("register", "seen")

    def __init__(self, register: Cell) -> None:
        self.register = register
        self.seen = register.value


class Routine(NamedTuple):
    """A routine of the vector table, in a program without the kernel."""

    number: int
    name: str

    @property
    def ier_bit(self) -> int:
        """The IER bit of its interrupt."""
        return ier_bit(self.number)


class Thread:
    """A task, Swi, Hwi, Clock object or routine (`what`), or `main`."""

    __slots__ = (
        "bit", "clock", "cpu", "entered", "index", "is_task", "left", "level", "name", "protection", "run", "seen",
        "stepped", "taken", "vector", "what",
    )  # fmt: skip

    def __init__(
        self, name: str, what: Task | Swi | Hwi | ClockObject | Routine | None, level: int, index: int,
        vector: VectorClock, protection: Protection, bit: int = 0,
    ) -> None:  # fmt: skip
        self.name = name
        self.what = what
        #: Whether it is a task.
        self.is_task = isinstance(what, Task)
        self.level = level
        self.index = index
        #: Its own clock, which grows at each release.  `vector` holds its value as of the last call of `known`.
        self.clock = 1
        self.vector = (*vector, *(0,) * (index - len(vector)), 1)
        #: The clock up to which its present run has come, or its latest one: a Swi or handler runs many times.
        self.run = [1]
        #: The words that may tell it something, with the values that its present run has read (not a task's).
        self.seen: dict[Any, Any] = {}
        #: The statement that has last told others something through a plain word, and when it did.
        self.stepped: tuple[int, int] = (0, 0)
        #: What protected it at the last call of `ThreadWatch.protection`.
        self.protection = protection
        #: The bit of its interrupt (`ThreadWatch.bit`); 0 if it has none.
        self.bit = bit
        #: The clock that it has taken over last from each object.
        self.taken: dict[Any, VectorClock] = {}
        #: CPU cycles so far.
        self.cpu = 0
        #: Gates entered and not left, innermost last.
        self.entered: list[Gate] = []
        #: Gate -> the cycle at which it was left last.
        self.left: dict[Gate, int] = {}

    def __str__(self) -> str:
        return f"{self.name} (priority {self.level})" if self.is_task else self.name

    def knows(self, other: Thread, clock: int) -> bool:
        """Whether what `other` did at its `clock` is ordered before what this thread does now."""
        vector = self.vector
        return other is self or (other.index < len(vector) and vector[other.index] >= clock)

    def step(self) -> None:
        """What it does from now on is later than what it has told others."""
        self.clock += 1
        self.run[0] = self.clock

    def begin(self) -> None:
        """A run of a Swi or handler begins."""
        self.clock += 1
        self.run = [self.clock]
        self.seen.clear()

    def known(self) -> VectorClock:
        """Its vector clock now, including its own component."""
        vector = self.vector
        if vector[self.index] != self.clock:
            vector = self.vector = at_clock(vector, self.index, self.clock)
        return vector


def at_clock(vector: VectorClock, index: int, clock: int) -> VectorClock:
    """A copy of a vector clock with the component at `index` replaced by `clock`."""
    return (*vector[:index], clock, *vector[index + 1 :])


def joined(one: VectorClock, other: VectorClock) -> VectorClock:
    """The maximum of two vector clocks, component by component."""
    if len(one) < len(other):
        one, other = other, one
    return (*[max(one[i], other[i]) for i in range(len(other))], *one[len(other) :])


class ThreadWatch:
    """The threads of a kernel; listens to its trace."""

    def __init__(self, kernel: Kernel) -> None:
        self.kernel = kernel
        self._clock = kernel.core.clock
        self._cpu = kernel.core.cpu
        self._protections: dict[tuple[frozenset[Gate], int, int, int], Protection] = {}
        self.main = Thread("main", None, -1, 0, (), self._unprotected(-1))
        self.current = self.main
        self.all = [self.main]
        self._of: dict[Any, Thread] = {}
        self._tasks: dict[str, Thread] = {}
        self._nested: list[Thread] = []
        self._since = 0
        #: The clock that a semaphore, Swi, Hwi or Clock object carries.
        self._carried: dict[Any, VectorClock] = {}
        self._bits: dict[int, int] = {}
        #: Interrupts that Hwi_disableInterrupt holds off: their bits.
        self._disabled = 0
        #: Interrupt -> the bits by which a driver can hold it off; those with a handler.
        self.enables: dict[int, Enables] = {}
        self._gated: list[_Gated] = []
        self._handlers = 0
        #: Those of `_gated` that are held off, their bits: as long as none of these registers changes.
        self._off = 0
        self._enabling: list[_Enabling] = []
        #: Returns PIEIER and the bit of a PIE interrupt.
        self.line: Callable[[int], Enable] | None = None
        #: Interrupt -> the registers by which a program starts the operations that end in it.
        self.begun: dict[int, list[Any]] = {}
        #: Without the kernel: the interrupts that have occurred, and how many routines have run.
        self.routines: set[int] = set()
        self.runs = 0

    def listen(self, trace: Trace) -> None:
        """Listen to all events that decide which thread runs."""
        trace.listen(self._switched, "switch", each_tick=False)
        trace.listen(self._interrupt_begins, "hwi", each_tick=False)
        trace.listen(self._interrupt_ends, "hwi end", each_tick=False)
        trace.listen(self._swi_begins, "swi", each_tick=False)
        trace.listen(self._swi_ends, "swi end", each_tick=False)
        trace.listen(self._readied, "ready", each_tick=False)
        trace.listen(self._clock_runs, "clock", each_tick=False)
        trace.ticks_joined.connect(self._ticks_passed)

    def _switched(self, cycles: int, _kind: str, _name: str) -> None:
        self._account(cycles)
        task = self.kernel.tasks.current
        assert task is not None
        self.current = self.of(task)

    def _interrupt_begins(self, cycles: int, _kind: str, _name: str) -> None:
        self._account(cycles - INTERRUPT_ENTRY_CYCLES)
        self._push(self.kernel.hwis.current)

    def _interrupt_ends(self, cycles: int, _kind: str, _name: str) -> None:
        self._account(cycles + INTERRUPT_EXIT_CYCLES)
        self.current = self._nested.pop()

    def routine_begins(self, number: int, name: str) -> None:
        """A routine of the vector table begins.  While the kernel runs, it does not count as a thread."""
        if not self.kernel.active:
            self.runs += 1
            if number not in self.routines:
                self.routines.add(number)
                if number >= FIRST_PIE and number not in self.enables and self.line is not None:
                    line = self.line(number)
                    self.enables[number] = line, (line,), ()
                self._update_handlers()
            self._nested.append(self.current)
            routine = self.of(Routine(number, name))
            routine.begin()
            self._follow(number, routine)
            self.current = routine

    def routine_ends(self, _number: int, _name: str) -> None:
        """A routine of the vector table has ended."""
        if not self.kernel.active:
            self.current = self._nested.pop()

    def _swi_begins(self, cycles: int, _kind: str, _name: str) -> None:
        self._account(cycles)
        self._push(self.kernel.swis.current)

    def _swi_ends(self, cycles: int, _kind: str, _name: str) -> None:
        self._account(cycles)
        self.current = self._nested.pop()

    def _ticks_passed(self, count: int, interrupt_cycles: int, swi_cycles: int) -> None:
        """`count` ticks have passed at once.  Each interrupted the idle task and nothing else."""
        kernel = self.kernel
        handler = kernel.hwis.table[TIMER_INTERRUPT]
        for what, cycles in ((handler, interrupt_cycles), (kernel.clocks.swi, swi_cycles)):
            self.of(what).cpu += count * cycles
            self._since += count * cycles

    def _readied(self, _cycles: int, _kind: str, name: str) -> None:
        if name not in self._tasks:
            self._created(name)

    def _clock_runs(self, cycles: int, _kind: str, name: str) -> None:
        self._account(cycles)
        timer = next(timer for timer in self.kernel.clocks.queue if timer.name == name)
        self.current = self.of(timer)
        self.current.begin()
        self.acquire(timer)

    def _push(self, what: Hwi | Swi | None) -> None:
        self._nested.append(self.current)
        thread = self.of(what)
        thread.begin()
        self.acquire(what, thread)
        if isinstance(what, Hwi):
            self._follow(what.number, thread)
        self.current = thread

    def _follow(self, number: int, handler: Thread) -> None:
        """Order the handler of interrupt `number` after what was done before the peripheral was started."""
        for started in self.begun.get(number, ()):
            self.acquire(started, handler)

    def _created(self, name: str) -> None:
        task = next(task for task in reversed(self.kernel.tasks.all) if task.name == name)
        self.of(task)

    def set_priority(self, task: Task, priority: int) -> None:
        """The firmware gives a task another priority.  What a task inherits at a gate is not its own."""
        self.of(task).level = priority

    def of(self, what: Any) -> Thread:
        """The thread of a task, Swi, Hwi, Clock object or routine.

        A new thread knows what its creator knew (a task), or what `main` knew (all others).
        """
        thread = self._of.get(what)
        if thread is None:
            creator = self.current if isinstance(what, Task) else self.main
            if isinstance(what, Task):
                name, level = what.name, what.priority
            elif isinstance(what, Swi):
                name, level = f"Swi:{what.name}", SWI_LEVEL + what.priority
            elif isinstance(what, ClockObject):
                name, level = f"Clock:{what.name}", SWI_LEVEL + self.kernel.clocks.swi.priority
            else:
                name, level = f"{'Isr' if isinstance(what, Routine) else 'Hwi'}:{what.name}", HWI_LEVEL
            bit = self.bit(what.number) if isinstance(what, Hwi | Routine) else 0
            thread = Thread(name, what, level, len(self.all), creator.known(), self._unprotected(level), bit)
            self.all.append(thread)
            self._of[what] = thread
            if isinstance(what, Task):
                self._tasks[what.name] = thread
            creator.step()
        return thread

    def named(self, name: str) -> Thread | None:
        """The thread of the task of this name; None if there is none."""
        return self._tasks.get(name)

    @property
    def interrupted(self) -> Thread:
        """The thread that the innermost Swi or Hwi interrupts."""
        return self._nested[-1]

    # Order

    def release(self, what: Any) -> None:
        """The running thread stores its vector clock at an object."""
        thread = self.current
        carried = self._carried.get(what)
        known = thread.known()
        self._carried[what] = known if carried is None else joined(carried, known)
        thread.step()

    def acquire(self, what: Any, thread: Thread | None = None) -> None:
        """The running thread (or `thread`) takes over the vector clock that is stored at an object."""
        carried = self._carried.get(what)
        if carried is not None:
            thread = thread or self.current
            if thread.taken.get(what) is not carried:
                thread.taken[what] = carried
                thread.vector = joined(thread.vector, carried)

    # Exclusion

    def bit(self, number: int) -> int:
        """The bit that stands for interrupt `number` in a protection."""
        return self._bits.setdefault(number, 1 << len(self._bits))

    def disable(self, number: int) -> None:
        """Hwi_disableInterrupt holds an interrupt off."""
        self._disabled |= self.bit(number)

    def enable(self, number: int) -> None:
        """It does so no more."""
        self._disabled &= ~self.bit(number)

    def protected(self, gates: frozenset[Gate], ceiling: int, lines: int, disabled: int) -> Protection:
        """The protection with these properties."""
        key = (gates, ceiling, lines, disabled)
        protection = self._protections.get(key)
        if protection is None:
            protection = self._protections[key] = Protection(gates, ceiling, lines, disabled)
        return protection

    def _unprotected(self, level: int) -> Protection:
        """That of a thread of this level which has not run yet."""
        return self.protected(_NO_GATES, level, ALL_LINES, 0)

    def protection(self) -> Protection:
        """What protects the running thread now."""
        thread, kernel, cpu = self.current, self.kernel, self._cpu
        level = thread.level
        ceiling = level
        if level < HWI_LEVEL:
            if kernel.swis.locked or cpu.intm:
                ceiling = HWI_LEVEL - 1
            elif level < SWI_LEVEL and kernel.tasks.locked:
                ceiling = SWI_LEVEL - 1
        lines = ALL_LINES if cpu.intm else ~cpu.ier & ALL_LINES
        if len(kernel.hwis.table) != self._handlers:
            self._update_handlers()
        for enabling in self._enabling:
            if enabling.register.value != enabling.seen:
                self._look_at_enables()
                break
        # Interrupts with a handler that are disabled one by one, by the kernel's call or at the peripheral.
        off = self._disabled | self._off
        gates = self.gates(thread) if thread.entered else _NO_GATES
        last = thread.protection
        if last.lines == lines and last.ceiling == ceiling and last.gates == gates and last.disabled == off:
            return last  # the usual case
        thread.protection = now = self.protected(gates, ceiling, lines, off)
        return now

    def _update_handlers(self) -> None:
        handlers = [*self.kernel.hwis.table, *self.routines]
        self._handlers = len(self.kernel.hwis.table)
        self._gated = [_Gated(self.bit(number), *self.enables[number]) for number in handlers if number in self.enables]
        self._look_at_enables()

    def _look_at_enables(self) -> None:
        """Find out which interrupts with a handler are held off at the peripheral.

        Peripherals and the DMA change registers too, so no write tells of it: `protection` compares the words.
        """
        self._off = 0
        for gated in self._gated:
            self._off |= gated.held_off()
        registers = dict.fromkeys(cell for gated in self._gated for cell in gated.registers())
        self._enabling = [_Enabling(register) for register in registers]

    @staticmethod
    def gates(thread: Thread) -> frozenset[Gate]:
        """The gates that a thread owns."""
        if not thread.entered:
            return _NO_GATES
        return frozenset(gate for gate in thread.entered if not gate.free and gate.owner is thread.what)

    # CPU time

    def _account(self, cycles: int) -> None:
        used = cycles - self._since
        if used > 0:
            self.current.cpu += used
            self._since = cycles

    def usage(self) -> list[int]:
        """CPU cycles of every thread so far."""
        self._account(self._clock.now)
        return [thread.cpu for thread in self.all]

    def used_since(self, usage: list[int]) -> list[tuple[Thread, int]]:
        """The threads that had the CPU since `usage` was taken, each with its cycles, longest first."""
        then = usage + [0] * (len(self.all) - len(usage))
        used = [(thread, now - before) for thread, now, before in zip(self.all, self.usage(), then, strict=True)]
        return sorted(((thread, cycles) for thread, cycles in used if cycles > 0), key=lambda row: -row[1])

    def ready_below(self, level: int) -> list[Thread]:
        """Tasks of a lower level that could run, without the idle task."""
        return [
            thread
            for thread in self.all
            if isinstance(thread.what, Task)
            and 0 < thread.level < level
            and thread.what.mode == READY
            and thread is not self.current
        ]


def excluded(first: Thread, first_protection: Protection, second: Thread, second_protection: Protection) -> bool:
    """Whether accesses of two threads, each under its protection, can never interrupt each other.

    A common gate excludes them.  Otherwise only the thread of lower level can be interrupted, so it is enough that this
    one holds the other off.  Equal levels do not pre-empt each other.  A masked line or a cleared enable holds a Hwi
    off.  Two handlers can nest either way round.
    """
    if first_protection.gates & second_protection.gates:
        return True
    if first.level > second.level:
        first, first_protection, second, second_protection = second, second_protection, first, first_protection
    if not isinstance(second.what, Hwi | Routine):
        return first_protection.ceiling >= second.level
    if not first_protection.lines & second.what.ier_bit and not first_protection.disabled & second.bit:
        return False
    return not isinstance(first.what, Hwi | Routine) or bool(second_protection.lines & first.what.ier_bit)
