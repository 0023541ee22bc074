"""Peripherals that several tasks use: `transaction-cut`.

Two transactions on the same part of a peripheral must not be interleaved.  A transaction is a conversion from the
trigger to the result, a word on SPI from the transmit to the receive register, all words on SPI while a slave is
selected, or the characters that a task writes to a UART.
Each part that a transaction occupies (a SOC, an ADC interrupt flag, a shift register) is a cell like any object in
memory: two tasks that use it need a common gate.  If a transaction was open when another began, the finding says so.
Handlers take part only where they begin a transaction.  A handler that clears the flag of a conversion which a task has
started does no harm: drivers with interrupts work so.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from emulator.c28x.findings import Finding, Findings
from emulator.clock import us
from emulator.registers.cell import Cell
from emulator.registers.taps import RegisterTap
from emulator.signal import Signal
from emulator.sysbios.watch.accesses import LatestAccess, SharedCell
from emulator.sysbios.watch.names import HandleNames
from emulator.sysbios.watch.statements import StatementLocator, StatementNumber
from emulator.sysbios.watch.threads import Protection, Thread, ThreadWatch
from emulator.trace import Trace


class WatchedBlock(Protocol):
    """A block of registers whose accesses a listener can follow (`emulator.registers.core.Block`)."""

    name: str
    registers: dict[str, Any]


class SelectWire(Protocol):
    """A wire that selects a slave while it is low (`emulator.signals.Wire`)."""

    name: str

    @property
    def changed(self) -> Signal[int]:
        """(level): every change."""


class OpenTransaction:
    """A transaction that has begun and not ended; `lasts`: it stays open while its thread blocks."""

    __slots__ = ("block", "lasts", "statement", "thread", "time")

    def __init__(
        self, block: str, thread: Thread, statement: StatementNumber, time: int, *, lasts: bool = False
    ) -> None:
        self.block = block
        self.thread = thread
        self.statement = statement
        self.time = time
        self.lasts = lasts


class Transactions:
    """Keeps which thread occupies which part of a peripheral, and reports transactions that can be interleaved."""

    def __init__(self, threads: ThreadWatch, locator: StatementLocator, names: HandleNames, findings: Findings) -> None:
        self._threads = threads
        self._locator = locator
        self._names = names
        self._findings = findings
        self._clock = findings.clock
        self._cells: dict[str, SharedCell] = {}
        self._open: dict[str, OpenTransaction] = {}
        self._occupying: list[_Occupying] = []
        self._found: dict[tuple[str, frozenset[Thread]], Finding] = {}

    def listen(self, trace: Trace) -> None:
        """Listen to tasks that block."""
        trace.listen(self._blocks, "block", each_tick=False)

    def _blocks(self, _cycles: int, _kind: str, name: str) -> None:
        """A task blocks.  Its conversions and words are now its interrupt's, so they no longer count as open."""
        for part in [key for key, opened in self._open.items() if opened.thread.name == name and not opened.lasts]:
            del self._open[part]

    def begin(self, block: str, part: str, *, opens: bool) -> None:
        """The running thread occupies a part of a peripheral.  `opens`: the transaction stays open until it ends."""
        thread = self._threads.current
        if thread is self._threads.main or self.owner(part) is thread:
            return
        statement = self._locator.here()
        self._use(block, part, thread, statement, self._threads.protection())
        if opens:
            self._open[part] = OpenTransaction(block, thread, statement, self._clock.now)

    def owner(self, part: str) -> Thread | None:
        """The only thread that has used a part so far."""
        cell = self._cells.get(part)
        return None if cell is None else cell.owner

    def _use(self, block: str, part: str, thread: Thread, statement: StatementNumber, protection: Protection) -> None:
        """A thread has used a part, and `protection` held for the whole time."""
        cell = self._cells.get(part)
        if cell is None:
            cell = self._cells[part] = SharedCell(thread)
        if cell.owner is thread:
            return
        if cell.owner is not None:
            cell.owner = None
            for occupying in self._occupying:
                occupying.quiet.clear()
        conflicts = cell.conflicts(thread, protection)
        if conflicts:
            self._cut(block, part, thread, conflicts[0])
        cell.keep(thread, True, protection, statement, self._clock.now)

    def _cut(self, block: str, part: str, thread: Thread, other: LatestAccess) -> None:
        opened = next((each for each in self._open.values() if each.block == block and each.thread is not thread), None)
        happened = () if opened is None else (
            f"it has happened: {opened.thread.name} began at {us(opened.time):.3f} us in "
            f"{self._locator.text(opened.statement)} and had not ended",
        )  # fmt: skip
        key = (block, frozenset((thread, other.thread)))
        known = self._found.get(key)
        if known is not None:
            known.count += 1
            if happened and len(known.details) < 2:
                known.details += happened
            return
        low, high = sorted((thread, other.thread), key=lambda side: side.level)
        finding = self._findings.report(
            "transaction-cut", f"{part} is used by {thread} and by {other.thread} without a common gate: {high} can "
            f"cut a transaction of {low}", object=block,
            details=(f"{other.thread} uses it in {self._locator.text(other.statement)}", *happened),
        )  # fmt: skip
        if finding is not None:
            self._found[key] = finding

    # Peripherals

    def watch_adc(self, regs: WatchedBlock, results: WatchedBlock) -> None:
        """A conversion occupies a SOC and an interrupt flag from the trigger until the result is read."""
        socs = [f"{regs.name} SOC{soc}" for soc in range(16)]
        flags = [f"{regs.name} ADCINT{number}" for number in range(1, 5)]
        for soc, part in enumerate(socs):
            self._on_read(results, f"ADCRESULT{soc}", part)
        self._on_bits(regs, "ADCSOCFRC1", socs, opens=True, tasks_only=False)
        self._on_bits(regs, "ADCINTFLGCLR", flags, opens=False, tasks_only=True)

    def watch_spi(self, regs: WatchedBlock) -> None:
        """A word occupies the shift register from the write of SPITXBUF to the read of SPIRXBUF."""
        part = f"{regs.name} shift register"
        self._on_write(regs, "SPITXBUF", lambda _word: self.begin(regs.name, part, opens=True))
        self._on_read(regs, "SPIRXBUF", part)

    def watch_select(self, block: str, chip_select: SelectWire) -> None:
        """All words while a slave is selected are one transaction.  The protection must hold for all of them."""
        part = f"{block} with {chip_select.name} low"
        held: dict[Thread, Protection] = {}

        def changed(level: int) -> None:
            thread = self._threads.current
            opened = self._open.get(part)
            if thread is self._threads.main or (level and opened is None):
                return
            now, statement = self._threads.protection(), self._locator.here()
            if not level:
                self._open[part] = OpenTransaction(block, thread, statement, self._clock.now, lasts=True)
                held[thread] = now
            elif opened is not None:
                begun = held.pop(opened.thread, now)
                whole = self._throughout(opened, begun, now) if opened.thread is thread else begun
                self._use(block, part, opened.thread, opened.statement, whole)
                if opened.thread is not thread:
                    self._use(block, part, thread, statement, now)
                del self._open[part]

        chip_select.changed.connect(changed)

    def _throughout(self, opened: OpenTransaction, begun: Protection, now: Protection) -> Protection:
        """The protection that held from begin to end.  A gate that was left meanwhile does not count."""
        left = opened.thread.left
        gates = frozenset(gate for gate in begun.gates & now.gates if left.get(gate, -1) < opened.time)
        ceiling = min(begun.ceiling, now.ceiling)
        return self._threads.protected(gates, ceiling, begun.lines & now.lines, begun.disabled & now.disabled)

    def watch_sci(self, regs: WatchedBlock, sent: Callable[[], None]) -> None:
        """Watch the characters that tasks write.  `sent()` is called for every character, whoever writes it."""

        def write(_word: int) -> None:
            if self._threads.current.is_task:
                self.begin(regs.name, f"{regs.name}.SCITXBUF", opens=False)
            sent()

        self._on_write(regs, "SCITXBUF", write)

    def _on_read(self, regs: WatchedBlock, name: str, part: str) -> None:
        """A read of the register ends the transaction on a part."""
        regs.registers[name].tap(_Ending(self._open, part), reads=True)

    def _on_bits(self, regs: WatchedBlock, name: str, parts: list[str], *, opens: bool, tasks_only: bool) -> None:
        """A write to the register occupies the parts whose bits are set in the word."""
        occupying = _Occupying(self, self._threads, regs.name, parts, opens=opens, tasks_only=tasks_only)
        self._occupying.append(occupying)
        regs.registers[name].tap(occupying)

    @staticmethod
    def _on_write(regs: WatchedBlock, name: str, callback: Callable[[int], None]) -> None:
        regs.registers[name].tap(lambda _register, _access, word, _mask: callback(word))


class _Ending(RegisterTap):
    """Hears of the reads that end the transaction on a part."""

    __slots__ = ("_open", "_part")

    def __init__(self, opened: dict[str, OpenTransaction], part: str) -> None:
        self._open, self._part = opened, part

    def told(self, register: Cell, access: str, word: Any, mask: int) -> None:
        if self._open and access == "read":
            self._open.pop(self._part, None)


class _Occupying(RegisterTap):
    """Hears of the writes that occupy the parts whose bits are set in the word."""

    __slots__ = ("_block", "_opens", "_parts", "_tasks_only", "_threads", "_transactions", "quiet")

    def __init__(
        self, transactions: Transactions, threads: ThreadWatch, block: str, parts: list[str], *, opens: bool,
        tasks_only: bool,
    ) -> None:  # fmt: skip
        self._transactions, self._threads = transactions, threads
        self._block, self._parts, self._opens, self._tasks_only = block, parts, opens, tasks_only
        #: Word -> the thread that alone has used all parts of this word.  Such a write needs no check.
        self.quiet: dict[int, Thread] = {}

    def told(self, register: Cell, access: str, word: Any, mask: int) -> None:
        thread = self._threads.current
        if self.quiet.get(word) is thread or (self._tasks_only and not thread.is_task):
            return
        parts = _bits(self._parts, word)
        for part in parts:
            self._transactions.begin(self._block, part, opens=self._opens)
        if all(self._transactions.owner(part) is thread for part in parts):
            self.quiet[word] = thread


def _bits(parts: list[str], word: int) -> list[str]:
    """The parts whose bits are set.  It is nearly always one."""
    word &= (1 << len(parts)) - 1
    if word and not word & word - 1:
        return [parts[word.bit_length() - 1]]
    return [part for number, part in enumerate(parts) if word >> number & 1]
