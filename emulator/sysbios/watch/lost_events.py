"""Flags that are cleared after their event has occurred: `event-lost`, in programs without the kernel.

`main` starts something, its interrupt routine sets a flag, `main` clears the flag without having read it, and then
waits for it.  Clearing a flag before the start is right, because it drops an old event; so is clearing it after a read.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Final

from emulator.c28x.ctypes import ArrayType
from emulator.c28x.findings import Findings
from emulator.c28x.memory import Object
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Assign, Const
from emulator.c28x.tree_queries import statements
from emulator.clock import us
from emulator.sysbios.watch.names import scalar_path
from emulator.sysbios.watch.statements import StatementLocator, StatementNumber
from emulator.sysbios.watch.threads import Routine, ThreadWatch

#: Structures of more scalars hold data.
_LARGE: Final = 32
#: Timer interrupts, which come periodically.  A program clears such a flag to wait for the next one.
PERIODIC: Final = frozenset({13, 14, 38})


@dataclass(slots=True)
class Flag:
    """A scalar that may tell of an event."""

    #: When `main` read it last (cycle; -1: never).
    seen: int = -1
    #: The interrupt that has set it since then; when its operation was started, and when it set the flag (cycles).
    number: int = 0
    started: int = -1
    set: int = -1
    #: The statement that cleared it after that.
    cleared: StatementNumber = 0


class LostEvents:
    """Listens to every access of an object, and to the operations that `main` starts."""

    def __init__(
        self, threads: ThreadWatch, locator: StatementLocator, findings: Findings, modules: Collection[Module]
    ) -> None:  # fmt: skip
        self._threads, self._locator, self._findings, self._modules = threads, locator, findings, modules
        self._clock = findings.clock
        #: Interrupt -> when the operation that ends in it was started last.
        self._started: dict[int, int] = {}
        #: The scalars that may be flags, by object and word.
        self._flags: dict[tuple[Object, int], Flag] = {}
        #: The cycle of the first access that was reported here.  Accesses are reported from the first interrupt on.
        self._since = -1
        self._clearing: set[tuple[str, int]] | None = None

    def start(self, number: int) -> None:
        """An operation begins that ends in interrupt `number`."""
        self._started[number] = self._clock.now

    def touch(self, obj: Object, word: int, write: bool) -> None:
        """The running thread reads or writes a word of an object."""
        flag = self._flags.get((obj, word))
        if flag is None:
            if self._since < 0:
                self._since = self._clock.now
            declared = obj.declaration
            if declared.function or isinstance(declared.ctype, ArrayType) or declared.ctype.leaves > _LARGE:
                return
            flag = self._flags[obj, word] = Flag()
        what = self._threads.current.what
        if isinstance(what, Routine):
            if write and what.number not in PERIODIC:
                started = self._started.get(what.number, -1)
                flag.number, flag.started, flag.set, flag.cleared = what.number, started, self._clock.now, 0
        elif write:
            if flag.set > flag.started > max(flag.seen, self._since) and self._clears(self._locator.here()):
                flag.cleared = self._locator.here()
            flag.set = -1
        else:
            if flag.cleared and self._started.get(flag.number) == flag.started:
                self._report(obj, word, flag)
            flag.seen, flag.set, flag.cleared = self._clock.now, -1, 0

    def _clears(self, statement: StatementNumber) -> bool:
        """Whether a statement sets something to 0."""
        if self._clearing is None:
            self._clearing = {
                (s.where.file, s.where.line)
                for module in self._modules for function in module.functions for s in statements(function.body)
                if isinstance(s, Assign) and isinstance(s.value, Const) and s.value.value == 0
            }  # fmt: skip
        place = self._locator.place(statement)
        return place is not None and place[:2] in self._clearing

    def _report(self, obj: Object, word: int, flag: Flag) -> None:
        place = self._locator.place(flag.cleared)
        if place is not None:
            leaf = obj.leaf(word)
            path = scalar_path(obj.declaration.path, obj.declaration.ctype, leaf[0] if leaf is not None else 0)
            after = us(self._clock.now - flag.started)
            self._findings.report_at(
                place, "event-lost",
                f"{path} is cleared after the transfer was started: the interrupt had already set it, nothing had read "
                f"it, and main waits for it {after:.0f} us after the start", object=path,
                declaration=str(obj.declaration), how="dynamic",
            )  # fmt: skip
