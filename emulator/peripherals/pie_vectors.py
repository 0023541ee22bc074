"""The vector table as firmware without a kernel uses it: routines written into `PieVectTable`.

Modelled: an entry runs when its interrupt is taken, nested on the interrupted stack; EALLOW (by the register core).  An
entry that the kernel took belongs to the kernel until firmware writes over it, as on silicon.  IRET restores IER, so
what a routine writes to it holds only until its end (SPRU430; the kernel's dispatcher keeps it).
A C function without the keyword `interrupt` is told when it returns (`isr-keyword`).
Not modelled: what such a function does to the registers of the interrupted code (CHOICE: it returns like a routine).
Time: none of its own; the core accounts for entry and return, the routine for itself.
Sources: TRM PIE; HDR F2837xS_pievect.h.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from emulator.c28x.memory import NULL
from emulator.c28x.sites import Place
from emulator.cpu import Cpu
from emulator.peripherals.pie import Pie, vector_id
from emulator.registers.core import ALL
from emulator.registers.pie_vectors import PieVectTable, Vector
from emulator.signal import Signal

Routine = Callable[[], Any]


class VectorTable:
    """Behaviour of `PieVectTable`."""

    def __init__(self, cpu: Cpu, pie: Pie, regs: PieVectTable) -> None:
        self._cpu, self._pie = cpu, pie
        self.registers = regs
        self._routines: dict[int, Routine] = {}
        #: Where the routine of an entry begins, if it does not return as from an interrupt, until that was told.
        self._returning: dict[int, Place] = {}
        self._ids = {name: entry.id for name, entry in regs.layout.items() if isinstance(entry, Vector)}
        self._names = {number: name for name, number in self._ids.items()}
        self._around: Callable[[Routine], Routine] = lambda routine: routine
        #: (number, name): a routine begins; it has ended.
        self.began: Signal[int, str] = Signal()
        self.ended: Signal[int, str] = Signal()
        for name, number in self._ids.items():
            regs.bind(name, read=partial(self._read, number), write=partial(self._write, number))

    def wrap_with(self, around: Callable[[Routine], Routine]) -> None:
        """Run routines that are written to an entry from now on as `around(routine)`, e.g. with a test's time limit."""
        self._around = around

    def clear(self) -> None:
        """Remove the routines of all entries, as TI's InitPieVectTable does: it writes one that only stops."""
        for number in self._ids.values():
            self._write(number, 0)

    def routine(self, group: int, n: int) -> str | None:
        """The name of the routine of PIE interrupt `group`.`n`, written by firmware or kernel; None: it has none."""
        number = vector_id(group, n)
        routine = self._routines.get(number)
        return routine.__name__ if routine is not None else "the kernel's" if self._pie.has_vector(number) else None

    def entry(self, group: int, n: int) -> str:
        """The name of the entry of PIE interrupt `group`.`n` in the table; empty for a reserved one."""
        return self._names.get(vector_id(group, n), "")

    def cpu_routine(self, number: int) -> str | None:
        """The name of the routine of vector `number` of the CPU itself (13: CPU timer 1); None: it has none."""
        routine = self._routines.get(number)
        return routine.__name__ if routine is not None else None

    def stands_for_all(self, number: int) -> bool:
        """Whether the routine of vector `number` is in most entries that have one: it handles what nobody expects."""
        routine = self._routines.get(number)
        return 2 * sum(other == routine for other in self._routines.values()) > len(self._routines) > 2

    def _read(self, number: int) -> Any:
        return self._routines.get(number, NULL)

    def _write(self, number: int, routine: Any, _lanes: int = ALL) -> None:
        if not routine:
            self._routines.pop(number, None)
            self._pie.set_vector(number, None)
            return
        self._routines[number] = routine
        run = partial(self._run, self._around(routine), routine.__name__, number)
        begins = self._cpu.findings.beginnings.get(routine)
        self._returning.pop(number, None)
        if begins is not None and self._cpu.findings.interrupts.get(begins) is False:
            self._returning[number] = begins
        self._pie.set_vector(number, run, begins)

    def _run(self, routine: Routine, name: str, number: int) -> None:
        cpu = self._cpu
        outer, cpu.isr = cpu.isr, f"Isr:{name}"
        who, cpu.position.who = cpu.position.who, cpu.isr
        ier = cpu.ier
        for listener in self.began.listeners:
            listener(number, name)
        try:
            routine()
        finally:
            for listener in self.ended.listeners:
                listener(number, name)
            cpu.isr = outer
            cpu.position.who = who
            cpu.ier = ier
        begins = self._returning.pop(number, None)
        if begins is not None:
            cpu.findings.report_at(
                begins, "isr-keyword", f"{name} has returned to what it interrupted, and is not declared `interrupt`",
                how="dynamic", object=name, task=f"Isr:{name}",
            )  # fmt: skip
