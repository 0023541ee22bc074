"""SYS/BIOS on a board.  It connects the kernel's modules with time, the CPU and each other, and a host runs them.

Modelled
    The start-up in the kernel's order: `main` runs with interrupts disabled; then the tick timer, interrupts, posted
    Swis and tasks start.  Interrupts run before Swis, Swis before tasks, tasks before the idle loop.  BIOS_exit ends
    the program.  Every task is a greenlet.  Interrupts and Swis are calls on the greenlet that they interrupt.
Not modelled
    The module Load, `*_construct` and `*_destruct`, the kernel in ROM, SMP.
Time
    A service takes the cycles of costs.py times `cost_scale`.  While no thread is ready, time moves on from event to
    event.
Sources
    BIOS; `BIOS.xdt` (BIOS_startFunc), `knl/Task.c` 6.83.

The host calls `start(main)` once, `run_until(cycles)` again and again, `shutdown()` at the end, all from one thread.
Pausing leaves no trace: many short runs are the same run as a long one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, Final, NoReturn

from greenlet import GreenletExit, getcurrent, greenlet

from emulator.c28x.findings import Findings
from emulator.c28x.memory import Memory
from emulator.clock import NEVER, SYSCLK_HZ, Clock, no_attention, us
from emulator.cpu import Cpu
from emulator.signal import Signal
from emulator.sysbios.clock import ClockObject
from emulator.sysbios.core import Function, KernelCore, KernelError, KernelObject
from emulator.sysbios.event import Event, EventModule
from emulator.sysbios.gate_key import GateKey, GateKeyModule
from emulator.sysbios.gate_mutex import GateMutex, GateMutexModule
from emulator.sysbios.gate_mutex_pri import GateMutexPri, GateMutexPriModule
from emulator.sysbios.handles import Find, Handles
from emulator.sysbios.heap import Heap, HeapBlocks
from emulator.sysbios.heap_buf import HeapBuf, HeapBufModule
from emulator.sysbios.heap_mem import HEAP_WORDS, HeapMem, HeapMemModule
from emulator.sysbios.hwi import Hwi, HwiModule, SetVector
from emulator.sysbios.log import LogModule
from emulator.sysbios.mailbox import Mailbox, MailboxModule
from emulator.sysbios.memory import MemoryModule
from emulator.sysbios.queue import QueueModule
from emulator.sysbios.scheduler import Task
from emulator.sysbios.semaphore import Semaphore, SemaphoreModule
from emulator.sysbios.stack import SYSTEM_STACK_INIT, StackSpace
from emulator.sysbios.swi import Swi
from emulator.sysbios.system import SystemModule
from emulator.sysbios.task import TaskModule
from emulator.sysbios.timer import StartTick, TickTimer
from emulator.trace import Trace

IDLE_STACK_WORDS: Final = 256
#: The exit status of a program that a reset of the chip has ended.
RESET_STATUS: Final = -1


def _key_gate(kind: str) -> Find:
    """A function that finds gates of one kind; all kinds share the class GateKey."""

    def find(value: Any) -> KernelObject | None:
        return value if isinstance(value, GateKey) and value.kind == kind else None

    return find


class Kernel:
    """One SYS/BIOS.  Its C functions are attributes (`kernel.Semaphore_post`), all of them in `externs`.

    The board gives four functions.  `pie_set_vector(id, handler, begins)` writes a vector; `begins` is the place of the
    firmware's function.  `pie_enable(id, on)` writes the PIEIER bit of vector id 32..223, and returns whether it was
    set.  `pie_acknowledge(group)` acknowledges a group.  `start_tick(period_register, handler)` loads PRD of CPU timer
    2 (the timer counts one more) and starts it.  The timer's interrupt raises CPU line 14, which is connected to
    `handler` already.  `start_tick` returns the timer if that can `skip` idle ticks.

    With `join_idle_ticks` False every tick is taken singly, with the same result.  `string_at(address)` returns the
    text of the string constant there, or None.  Queues and heaps need the `memory` of the C program.  `heap_words` is
    `BIOS.heapSize`, or in a program without SYS/BIOS the linker's option `-heap`.  `start_up()` does what the start-up
    of SYS/BIOS does to the chip before `main`.
    """

    def __init__(
        self,
        clock: Clock,
        cpu: Cpu,
        findings: Findings,
        trace: Trace,
        *,
        pie_set_vector: SetVector,
        pie_enable: Callable[[int, bool], bool],
        pie_acknowledge: Callable[[int], None],
        start_tick: StartTick,
        memory: Memory | None = None,
        string_at: Callable[[int], str | None] = lambda address: None,
        task_stack_base: int = 0x8000,
        system_stack: tuple[int, int] = (0x0400, 0x03F8),
        task_object_base: int = 0xB800,
        heap_words: int = HEAP_WORDS,
        cost_scale: float = 1.0,
        asserts: bool = True,
        check_stacks: bool = True,
        narrow_timeouts: bool = False,
        gate_order_fault: bool = False,
        idle_functions: Iterable[Function] = (),
        idle_vital: bool = True,
        extended_formats: str = "%$L%$S%$F",
        tick_period_us: int = 1000,
        join_idle_ticks: bool = True,
        start_up: Callable[[], None] = lambda: None,
    ) -> None:
        core = self.core = KernelCore(clock, cpu, findings, trace, cost_scale=cost_scale, asserts=asserts)
        base, words = system_stack
        stack = (base, base + words)
        self.tasks = TaskModule(
            core, StackSpace(core, task_stack_base, memory, check=check_stacks), system_stack=stack,
            object_base=task_object_base, fail=self._fail, exit_program=self._exit, host=self._falls_back_to,
            # The idle task is static, so it counts before main begins.
            vital_tasks=int(idle_vital), timeout_mask=0xFFFF if narrow_timeouts else 0xFFFFFFFF,
            tick_period_us=tick_period_us,
        )  # fmt: skip
        self.swis, self.clocks = self.tasks.swis, self.tasks.clocks
        self.hwis = HwiModule(
            core, self.swis, self.tasks, system_stack=stack,
            pie_set_vector=pie_set_vector, pie_enable=pie_enable, pie_acknowledge=pie_acknowledge,
        )  # fmt: skip
        self.queues = QueueModule(core, memory)
        self.handles = Handles(core, memory, {
            "Task_Handle": Task, "Semaphore_Handle": Semaphore, "Clock_Handle": ClockObject, "Swi_Handle": Swi,
            "Hwi_Handle": Hwi, "Event_Handle": Event, "Mailbox_Handle": Mailbox,
            "GateMutexPri_Handle": GateMutexPri, "GateMutex_Handle": GateMutex, "HeapMem_Handle": HeapMem,
            "HeapBuf_Handle": HeapBuf, "IHeap_Handle": Heap,
        }, {
            "Queue_Handle": self.queues.find, "GateTask_Handle": _key_gate("GateTask"),
            "GateSwi_Handle": _key_gate("GateSwi"), "GateHwi_Handle": _key_gate("GateHwi"),
            "GateAll_Handle": _key_gate("GateAll"),
        }, lambda: self.tasks.current is not None)  # fmt: skip
        self.events = EventModule(core, self.tasks, self.handles)
        self.semaphores = SemaphoreModule(core, self.tasks, self.events)
        self.mailboxes = MailboxModule(core, self.tasks, self.semaphores, self.events)
        self.gates = GateMutexPriModule(core, self.tasks, order_fault=gate_order_fault)
        self.plain_gates = GateMutexModule(core, self.tasks, self.semaphores)
        self.key_gates = GateKeyModule(core, self.tasks, self.swis, self.hwis)
        blocks = HeapBlocks(core, memory)
        self.heaps = HeapMemModule(core, blocks, self.plain_gates, heap_words)
        self.buffer_heaps = HeapBufModule(core, blocks)
        self.heap_memory = MemoryModule(core, blocks, self.heaps, self.buffer_heaps)
        self.system = SystemModule(core, extended_formats=extended_formats, exit_program=self._exit)
        self.log = LogModule(core, string_at)
        self.timer = TickTimer(
            self.hwis, self.clocks, self.tasks, cpu_frequency_hz=SYSCLK_HZ, start_tick=start_tick,
            join_idle_ticks=join_idle_ticks,
        )  # fmt: skip
        #: Every C function by name, as the linker wants them.
        self.externs: Mapping[str, Function] = self._externs()
        #: The argument of BIOS_exit, or RESET_STATUS; None while the program runs.
        self.exit_status: int | None = None
        self._idle_functions = tuple(idle_functions)
        self._idle_vital = idle_vital
        #: Whether `main` has reached BIOS_start.
        self.started = False
        self._main: greenlet | None = None
        self._host = getcurrent()
        self._running: greenlet | None = None
        self._failure: BaseException | None = None
        self._stopped = ""
        #: Whether firmware runs now.  False between two runs, when the host may call its functions.
        self.active = False
        self._pause = False
        self._reset = False
        #: Whether the host has moved time itself, and the CPU has not yet handled what became due.
        self._deferred = False
        self._start_up = start_up
        #: Emitted once by `shutdown` before the tasks end.  Checks that need the end of a run listen to it.
        self.ending: Signal[[]] = Signal()
        self._ended = False
        if memory is not None:
            memory.fill(base, words, SYSTEM_STACK_INIT)
        clock.serve_with(self._attention)

    def _externs(self) -> dict[str, Function]:
        modules = (
            self, self.tasks, self.swis, self.hwis, self.clocks, self.semaphores, self.events, self.mailboxes,
            self.queues, self.gates, self.plain_gates, self.key_gates, self.heaps, self.buffer_heaps, self.heap_memory,
            self.system, self.log,
        )  # fmt: skip
        prefixes = (
            "BIOS_",
            "Task_",
            "Swi_",
            "Hwi_",
            "Clock_",
            "Semaphore_",
            "Event_",
            "Mailbox_",
            "Queue_",
            "GateMutexPri_",
            "GateMutex_",
            "GateTask_",
            "GateSwi_",
            "GateHwi_",
            "GateAll_",
            "HeapMem_",
            "HeapBuf_",
            "Memory_",
            "malloc",
            "calloc",
            "realloc",
            "free",
            "System_",
            "Log_",
            "Error_",
        )
        return {
            name: self.handles.guarded(name, getattr(module, name))
            for module in modules
            for name in dir(type(module))
            if name.startswith(prefixes)
        }

    def __getattr__(self, name: str) -> Function:
        """A C function of any module."""
        if name != "externs" and name in self.externs:
            return self.externs[name]
        raise AttributeError(f"the kernel has no function {name}")

    # The interface of the host

    def start(self, main: Callable[[], Any]) -> None:
        """Run the firmware's `main` until its BIOS_start has started the kernel (or until it returns).

        Whatever `main` raises is raised here.
        """
        if self._main is not None:
            raise ValueError("the kernel was started already")
        self._start_up()
        self._main = greenlet(lambda: self._run_main(main), parent=getcurrent())
        self._enter(self._main)

    def run_until(self, cycles: int) -> None:
        """Run until virtual time is `cycles`; returns at once if it has passed.

        An exception that ends a task, a Swi or a handler is raised here once, with a note that names the thread.  After
        it the kernel does not run again (ValueError).  After BIOS_exit only time and the world go on.
        """
        if self._stopped:
            raise ValueError(f"the kernel has stopped: {self._stopped}")
        if self._running is None:
            raise ValueError("the kernel runs after start(main)")
        clock = self.core.clock
        if cycles <= clock.now:
            return
        if self.exit_status is None:
            event = clock.schedule(cycles, self.pause)
            if self._deferred:
                self._deferred = False
                clock.request_attention()
            self._enter(self._running)
            clock.cancel(event)
        if self.exit_status is not None:
            clock.advance_to(cycles)

    def pause(self) -> None:
        """Make `run_until` return at the CPU's next charge.  A listener or an event of the run calls it."""
        self._pause = True
        self.core.clock.request_attention()

    def stop(self) -> None:
        """End the program because the chip has been reset.  An event or a register calls it."""
        self._reset = True
        self.core.clock.request_attention()

    def shutdown(self) -> None:
        """End all greenlets; the kernel does not run again.  May be called more than once."""
        if not self._ended:
            self.ending.emit()
            self._ended = True
        self._stopped = self._stopped or "it was shut down"
        self.active = False
        self.core.clock.serve_with(no_attention)
        mine = getcurrent()
        for victim in [task.greenlet for task in self.tasks.all] + [self._main]:
            if victim is not None and not victim.dead and victim is not mine:
                victim.parent = mine
                victim.throw(GreenletExit)

    def context(self) -> str:
        """The name of the thread that runs now (`Position.who`)."""
        return self.core.cpu.position.who

    # Between host and firmware

    def _enter(self, target: greenlet) -> None:
        """Let firmware run until it pauses, exits or fails."""
        self._host = getcurrent()
        self.active = True
        position = self.core.cpu.position
        at, calls = position.at, position.calls
        try:
            target.switch()
        finally:
            self.active = False
            position.at, position.calls = at, calls
        failure = self._failure
        if failure is not None:
            self._failure = None
            raise failure

    def _leave(self) -> None:
        """Switch from the running greenlet back to the host; returns when the host resumes it."""
        self._running = getcurrent()
        position = self.core.cpu.position
        at, calls = position.at, position.calls
        self._host.switch()
        position.at, position.calls = at, calls

    def _falls_back_to(self) -> greenlet:
        """The greenlet that runs after a task has ended: the host's."""
        return self._host

    def _leave_for_good(self) -> NoReturn:
        while True:
            self._leave()

    def _fail(self, error: BaseException, name: str) -> NoReturn:
        """Pass the exception that has ended a greenlet to the host."""
        who = self.context()
        where = name if who == name else f"{who}, on the stack of {name}"
        error.add_note(f"in {where} at {us(self.core.clock.now):.3f} us of virtual time")
        self._failure = error
        self._stopped = f"{type(error).__name__} in {where}"
        self._leave_for_good()

    def _exit(self, status: int) -> NoReturn:
        """End the program: the schedulers are off, and the CPU spins."""
        self.exit_status = status
        self.swis.locked = self.tasks.locked = True
        self.core.cpu.intm = True
        self.core.clock.serve_with(no_attention)
        self._leave_for_good()

    def _run_main(self, main: Callable[[], Any]) -> None:
        try:
            main()
            self._exit(0)
        except GreenletExit:
            return
        except BaseException as error:
            self._fail(error, "main")

    # The CPU's attention

    def _attention(self) -> None:
        """Handle what is due between two charges of the CPU: pause, interrupts, Swis, task switch, in this order."""
        if self._pause:
            self._pause = False
            self._leave()
        cpu = self.core.cpu
        if not self.active:
            if self._main is None:  # Firmware without a kernel: the core takes interrupts by itself.
                cpu.service()
            else:
                self._deferred = True
            return
        if self._reset:
            self._exit(RESET_STATUS)
        if not cpu.intm and cpu.ifr & cpu.ier:
            cpu.service()
        if cpu.in_interrupt:
            return
        swis, tasks = self.swis, self.tasks
        if swis.ready_set and not swis.locked:
            # An interrupt clears EALLOW, and its return restores it.  Code that runs before the return sees it cleared.
            eallow, edis_at, cpu.eallow, cpu.edis_at = cpu.eallow, cpu.edis_at, False, 0
            swis.run_ready()
            if tasks.work and not tasks.locked and not swis.locked:
                tasks.schedule()
            cpu.eallow, cpu.edis_at = eallow, edis_at
        elif tasks.work and not tasks.locked and not swis.locked:
            eallow, edis_at, cpu.eallow, cpu.edis_at = cpu.eallow, cpu.edis_at, False, 0
            tasks.schedule()
            cpu.eallow, cpu.edis_at = eallow, edis_at

    def _idle(self, _arg0: int, _arg1: int) -> None:
        """The idle task.  It calls the idle functions in a loop; without any, it moves time on to the next event."""
        clock = self.core.clock
        functions = self._idle_functions
        pass_idle_ticks = self.timer.pass_idle_ticks
        while True:
            for function in functions:
                function()
            if functions:
                clock.charge(20)
                continue
            if clock.next > clock.now:
                if clock.next == NEVER:
                    raise KernelError("idle", "no task is ready and no event is left that could make one ready")
                began = clock.now
                pass_idle_ticks()
                if clock.next > clock.now:
                    clock.now = clock.next
                clock.waited += clock.now - began
            clock.run_due()

    # C functions

    def BIOS_start(self) -> NoReturn:
        """Start the kernel; never returns."""
        core, tasks, swis = self.core, self.tasks, self.swis
        if self.started:
            raise KernelError("BIOS_start", "BIOS_start was called twice")
        self.started = True
        core.clock.charge(core.costs["bios_start"])
        stack = tasks.stacks.allocate(IDLE_STACK_WORDS, 0, None)
        assert stack is not None
        tasks.add(self._idle, 0, stack, (0, 0), False, "Idle").vital = self._idle_vital
        self.timer.start()
        core.cpu.enable_interrupts()
        swis.locked = False
        swis.run_ready()
        self._running = tasks.start()
        self._host.switch()
        raise KernelError("BIOS_start", "main was resumed")

    def BIOS_exit(self, status: int) -> NoReturn:
        """End the program; never returns."""
        self._exit(status)

    def BIOS_getThreadType(self) -> int:
        """The type of the running thread: 0 is a Hwi, 1 a Swi, 2 a Task, 3 is main."""
        return self.core.thread_type
