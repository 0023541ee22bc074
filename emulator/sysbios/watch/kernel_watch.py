"""Watches a linked image for errors that show only between threads.

    watch = KernelWatch(kernel, linked)      # the image must be linked with `watch=True`
    ...
    watch.finish()                           # findings at the end of a run; the kernel's shutdown calls it too

The detectors listen to the kernel's trace, to the calls of its C functions and to the accesses of objects.  They change
nothing.  An image that is not watched pays nothing for them.  `emulator/rules/kernel.py` lists the rules.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol

from emulator.c28x.link import Linked
from emulator.c28x.memory import Object, Pointer
from emulator.c28x.watcher import Watcher
from emulator.registers.cell import Cell
from emulator.registers.taps import RegisterTap
from emulator.signal import Signal
from emulator.sysbios.kernel import Kernel
from emulator.sysbios.mailbox import Mailbox
from emulator.sysbios.watch.calls import Calls
from emulator.sysbios.watch.gates import Gates
from emulator.sysbios.watch.interfaces import CanBlock, Interfaces
from emulator.sysbios.watch.inversion import Inversion
from emulator.sysbios.watch.let_in import LetIn
from emulator.sysbios.watch.lost_events import LostEvents
from emulator.sysbios.watch.lost_posts import LostPosts
from emulator.sysbios.watch.names import HandleNames
from emulator.sysbios.watch.posters import Posters
from emulator.sysbios.watch.races import Races
from emulator.sysbios.watch.releases import Releases
from emulator.sysbios.watch.standstill import Standstill
from emulator.sysbios.watch.starvation import STARVED_CYCLES, StarvationWatch
from emulator.sysbios.watch.statements import StatementLocator
from emulator.sysbios.watch.threads import Enable, Enables, ThreadWatch
from emulator.sysbios.watch.timeouts import TimeoutWatch
from emulator.sysbios.watch.transactions import SelectWire, Transactions, WatchedBlock
from emulator.sysbios.watch.transmission import Transmission


class Vectors(Protocol):
    """The vector table.  It signals when a routine begins and ends, with the interrupt's number and the name."""

    @property
    def began(self) -> Signal[int, str]:
        """A routine begins."""

    @property
    def ended(self) -> Signal[int, str]:
        """A routine has ended."""


class Transfer(Protocol):
    """A DMA transfer that is under way (`emulator.peripherals.dma_checks.TransferChecks`)."""

    def touched(self, base: int, *, write: bool) -> None:
        """The CPU reads or writes the object at `base` during the transfer."""


class KernelWatch:
    """All detectors on one kernel and one image.

    `starved_cycles`: a ready task without a period counts as starved after this time.  `transfers`: the DMA transfers
    that are under way.
    """

    def __init__(
        self, kernel: Kernel, linked: Linked, *, transfers: Sequence[Transfer] = (),
        starved_cycles: int = STARVED_CYCLES,
    ) -> None:  # fmt: skip
        findings = kernel.core.findings
        self.transfers = transfers
        calls, locator, names = Calls(kernel), StatementLocator(findings), HandleNames(linked)
        self.threads = threads = ThreadWatch(kernel)
        _order(calls, threads)
        self.races = Races(
            threads, locator, names, findings, linked.runtime.memory, linked.program.modules.values()
        )  # fmt: skip
        self.transmission = Transmission(threads, locator, findings)
        self.transactions = Transactions(threads, locator, names, findings)
        self.gates = Gates(threads, locator, names, findings, calls)
        self.waits = TimeoutWatch(threads, locator, names, findings, self.gates, calls, linked)
        self.inversion = Inversion(threads, locator, names, findings, self.gates, calls)
        self.standstill = Standstill(
            threads, locator, names, findings, self.gates, Posters(kernel, linked, names), calls, linked
        )
        self.releases = Releases(threads, locator, names, findings, calls)
        self.lost_posts = LostPosts(threads, locator, names, findings, calls, linked)
        self.lost_events = LostEvents(threads, locator, findings, linked.program.modules.values())
        self.let_in = LetIn(threads, locator, findings, linked.program.modules.values())
        self.interfaces = Interfaces(threads, locator, findings, linked.program.modules.values())
        #: Register -> what hears of its writes, and knows the interrupts that these can bring.
        self._started: dict[Cell, _Beginnings] = {}
        self.starvation = StarvationWatch(threads, locator, findings, self.releases, calls, starved_cycles)
        runtime = linked.runtime

        def printed(count: int, buf: Pointer | None, *_arguments: Any) -> None:
            if buf is not None:
                runtime.touch_block(buf, count + 1, True)

        def printed_at_most(count: int, buf: Pointer, n: int, *_arguments: Any) -> None:
            runtime.touch_block(buf, min(count + 1, n), True)

        def posted(mailbox: Mailbox, message: Pointer | None, _timeout: int) -> None:
            if message is not None:
                runtime.touch_block(message, mailbox.size, False)

        def taken(taken: int, mailbox: Mailbox, message: Pointer | None, _timeout: int) -> None:
            if taken and message is not None:
                runtime.touch_block(message, mailbox.size, True)

        calls.before("Mailbox_post", callback=posted)
        calls.after("Mailbox_pend", callback=taken)
        calls.after("System_sprintf", callback=printed)
        calls.after("System_snprintf", callback=printed_at_most)
        calls.install(linked)
        linked.watch_with(_Accesses(self, kernel))
        # In this order: `threads` first, `gates` before `inversion`.
        for listener in (threads, self.gates, self.inversion, self.standstill, self.starvation, self.transactions):
            listener.listen(kernel.core.trace)
        kernel.ending.connect(self.finish)

    def finish(self) -> None:
        """Report what shows at the end of a run: unused gates, and tasks that still wait or wait for ever."""
        self.gates.finish()
        self.standstill.finish()
        self.lost_posts.finish()
        self.starvation.finish()
        self.waits.finish()

    # Peripherals

    def vectors(self, vectors: Vectors, line: Callable[[int], Enable]) -> None:
        """Watch the routines of the vector table.  `line` returns the PIEIER bit of a PIE interrupt."""
        self.threads.line = line
        # The routine is the running thread for all others.
        vectors.began.connect(self.threads.routine_begins)
        vectors.began.connect(self.let_in.began)
        vectors.ended.connect(self.let_in.ended)
        vectors.ended.connect(self.threads.routine_ends)

    def interrupt(self, number: int, enables: Enables) -> None:
        """Register the enable bits of a peripheral's interrupt `number`.  A driver can clear them to hold it off."""
        self.threads.enables[number] = enables

    def starts(self, number: int, register: Cell, begins: Callable[[int], bool]) -> None:
        """Writing a word that `begins` accepts to `register` starts an operation that ends in interrupt `number`.

        What the writer did before the write is therefore ordered before the interrupt routine.
        """
        started = self._started.get(register)
        if started is None:
            started = self._started[register] = _Beginnings(self.threads, self.lost_events)
            register.tap(started)
        started.add(number, begins)
        self.threads.begun.setdefault(number, []).append(register)

    def adc(self, regs: WatchedBlock, results: WatchedBlock) -> None:
        """Watch the transactions of an ADC."""
        self.transactions.watch_adc(regs, results)

    def spi(self, regs: WatchedBlock) -> None:
        """Watch the transactions of an SPI master."""
        self.transactions.watch_spi(regs)

    def select(self, regs: WatchedBlock, chip_select: SelectWire) -> None:
        """Watch the transfers to one slave of an SPI master."""
        self.transactions.watch_select(regs.name, chip_select)

    def can(self, regs: CanBlock) -> None:
        """Watch the message interfaces of a CAN."""
        self.interfaces.watch(regs)

    def sci(self, regs: WatchedBlock, character_cycles: Callable[[], int]) -> None:
        """Watch what an SCI sends and from which buffer.  `character_cycles()` is the time of one character."""
        register = f"{regs.name}.SCITXBUF"
        self.transactions.watch_sci(regs, lambda: self.transmission.sent(register, character_cycles()))


class _Accesses(Watcher):
    """Tells the detectors of every access to an object."""

    __slots__ = ("_cpu", "_events", "_kernel", "_races", "_sending", "_threads", "_transfers", "_transmission")

    def __init__(self, watch: KernelWatch, kernel: Kernel) -> None:
        self._cpu, self._kernel = kernel.core.cpu, kernel
        self._threads, self._races, self._events = watch.threads, watch.races, watch.lost_events
        self._transmission, self._sending = watch.transmission, watch.transmission.sending
        self._transfers = watch.transfers

    def touch(self, obj: Object, word: int, write: bool) -> None:
        if self._transfers:
            for transfer in self._transfers:
                transfer.touched(obj.base, write=write)
        if not self._kernel.active:
            # The program has no kernel.  `main` needs no protection before the first interrupt.
            if self._threads.routines:
                self._races.touch(obj, word, write)
                self._events.touch(obj, word, write)
            return
        # A routine of the vector table is no thread of the kernel.
        if self._cpu.isr:
            return
        self._races.touch(obj, word, write)
        if self._sending if write else not self._threads.current.is_task:
            self._transmission.touch(obj, word, write)


class _Beginnings(RegisterTap):
    """Hears of the writes to a register that can begin what ends in an interrupt."""

    __slots__ = ("_events", "_handled", "_handlers", "_kernel", "_started", "_table", "_threads")

    def __init__(self, threads: ThreadWatch, events: LostEvents) -> None:
        self._threads, self._kernel, self._events = threads, threads.kernel, events
        self._table = threads.kernel.hwis.table
        #: The interrupts, each with a test of the word that is written.
        self._started: list[tuple[int, Callable[[int], bool]]] = []
        #: The tests of interrupts that have a handler.  It is valid while the table holds `_handlers` handlers.  A
        #: thread that creates a handler later passes its own knowledge on to it.
        self._handled: list[Callable[[int], bool]] = []
        self._handlers = 0

    def add(self, number: int, begins: Callable[[int], bool]) -> None:
        """A word that `begins` accepts can bring interrupt `number`."""
        self._started.append((number, begins))

    def told(self, register: Cell, access: str, word: Any, mask: int) -> None:
        if self._kernel.active:
            if len(self._table) != self._handlers:
                self._handlers = len(self._table)
                self._handled = [begins for number, begins in self._started if number in self._table]
            for begins in self._handled:
                if begins(word):
                    self._threads.release(register)
                    return
            return
        numbers = [number for number, begins in self._started if begins(word)]
        if numbers:
            self._threads.release(register)
        for number in numbers:
            self._events.start(number)


def _order(calls: Calls, threads: ThreadWatch) -> None:
    """Report the calls that order threads, e.g. a post before its pend, or Swi_post before the Swi."""
    acquire, release = threads.acquire, threads.release

    def released(what: Any, *_arguments: Any) -> None:
        release(what)

    def made(what: Any, *_arguments: Any) -> None:
        if what is not None:
            release(what)

    def enabled(number: int) -> None:
        threads.enable(number)
        hwi = threads.kernel.hwis.table.get(number)
        if hwi is not None:
            release(hwi)

    def disabled(_was: int, number: int) -> None:
        threads.disable(number)

    def pended(taken: int, semaphore: Any, _timeout: int) -> None:
        if taken:
            acquire(semaphore)

    def passed(taken: int, mailbox: Any, _message: Any, _timeout: int) -> None:
        """A message orders its reader after its writer.  A free place orders the next writer after that reader."""
        if taken:
            acquire(mailbox)

    def matched(bits: int, event: Any, *_arguments: Any) -> None:
        if bits:
            acquire(event)

    calls.before("Event_post", "Mailbox_post", "Mailbox_pend", callback=released)
    calls.after("Mailbox_post", "Mailbox_pend", callback=passed)
    calls.after("Event_pend", callback=matched)
    calls.before(
        "Semaphore_post", "Swi_post", "Swi_or", "Swi_inc", "Swi_andn", "Swi_dec", "Clock_start", callback=released
    )
    calls.before("Task_setPri", callback=threads.set_priority)
    calls.before("Hwi_enableInterrupt", callback=enabled)
    calls.after("Hwi_disableInterrupt", callback=disabled)
    calls.after("Hwi_create", "Swi_create", "Clock_create", callback=made)
    calls.after("Semaphore_pend", callback=pended)
