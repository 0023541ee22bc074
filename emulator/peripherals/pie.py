"""The peripheral interrupt expansion: 12 groups of 16 lines in front of the CPU's INT1..INT12, and the vectors.

Modelled: PIEIFR, PIEIER, PIEACK, ENPIE; PIEVECT for every vector that is fetched from the table; priority within a
group; vectors of INT13 and INT14, which bypass the groups; the INTx.1 vector for a request that has disappeared before
its fetch.
Not modelled: the vector table as memory (`set_vector` writes an entry; firmware writes it through `pie_vectors.py`),
PIE vector parity errors, NMI, boot-ROM vectors with ENPIE = 0 (nothing is delivered then).
Reported, at the routine: an interrupt that only a missing acknowledge blocks; a flag that blocks further interrupts of
its source (`flag-not-cleared`).
Time: none of its own.  A pulse is latched at once; the CPU takes it at its next charge and accounts for its entry.
Sources: TRM PIE; HDR F2837xS_piectrl.h, hw_ints.h; BIOS family/c28/Hwi_disp_asm.s28 (the dispatcher takes the number of
every interrupt from PIEVECT, of INT13 and INT14 as well: it is the address of their entry).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final

from emulator.c28x.findings import Cause
from emulator.c28x.sites import Place
from emulator.clock import CYCLES_PER_MS, Clock
from emulator.cpu import Cpu
from emulator.registers.core import ALL
from emulator.registers.pie import PieCtrlRegs
from emulator.registers.pie_vectors import PieVectTable, Vector

GROUPS: Final = 12
LINES: Final = 16
#: HDR: address of the vector table; vector `id` is the 32-bit word at VECTOR_TABLE + 2*id.
VECTOR_TABLE: Final = 0x0D00
#: CPU interrupts 13 (CPU timer 1) and 14 (CPU timer 2) have these vector ids.
DIRECT_VECTORS: Final = (13, 14)
#: Vectors have the ids 0 to 0xDF.
VECTORS: Final = 0x80 + 8 * GROUPS
#: CHOICE: if an interrupt waits for its acknowledge for 100 ms, the program contains no such acknowledge.
LONG_CYCLES: Final = 100 * CYCLES_PER_MS
#: The entries of the vector table by id.
_ENTRIES: Final = {entry.id: name for name, entry in PieVectTable.layout.items() if isinstance(entry, Vector)}


def vector_id(group: int, n: int) -> int:
    """The vector id of interrupt `group`.`n` (1..12, 1..16): lines 1-8 from 0x20, 9-16 from 0x80.  HDR hw_ints.h."""
    if not (1 <= group <= GROUPS and 1 <= n <= LINES):
        raise ValueError(f"PIE interrupt {group}.{n}: expected group 1..12 and line 1..16")
    return 0x20 + 8 * (group - 1) + n - 1 if n <= 8 else 0x80 + 8 * (group - 1) + n - 9


def _name(vector: int) -> str:
    """The name of a vector's interrupt: `interrupt 1.7`, or the number of a CPU line."""
    if vector < 0x20:
        return f"interrupt {vector} of the CPU"
    first, line = (0x20, 1) if vector < 0x80 else (0x80, 9)
    group, n = divmod(vector - first, 8)
    return f"interrupt {group + 1}.{n + line}"


class Pie:
    """PIE behaviour over its registers.  It handles the CPU's lines 1..14."""

    def __init__(self, clock: Clock, cpu: Cpu, regs: PieCtrlRegs) -> None:
        self._clock, self._cpu, self._regs = clock, cpu, regs
        registers = regs.registers
        self._ctrl, self._ack = registers["PIECTRL"], registers["PIEACK"]
        self._ier = tuple(registers[f"PIEIER{x}"] for x in range(1, GROUPS + 1))
        self._ifr = tuple(registers[f"PIEIFR{x}"] for x in range(1, GROUPS + 1))
        #: Vector -> the function that runs when it is taken, and where that begins if it is the firmware's own.
        self._vectors: dict[int, tuple[Callable[[], None], Place | None]] = {}
        #: The last vector that each group took, and how often each group was acknowledged.
        self._taken = [0] * GROUPS
        self._acknowledged = [0] * GROUPS
        #: The flags of each group that the firmware has set by writing PIEIFR.
        self._forced = [0] * GROUPS
        #: Vector -> the statement that has enabled its line last.
        self._enabled_by: dict[int, Cause | None] = {}
        #: For each vector, when its routine ended, if there has been no pulse since; else -1.
        self._served = [-1] * VECTORS
        #: For each vector, whether it was ever taken.
        self._has_run = [False] * VECTORS
        #: (group, number) -> the flag that kept an event back, the routine that left it, and its end in cycles.
        self._blocked: dict[tuple[int, int], tuple[str, Place, int]] = {}
        regs.bind("PIECTRL", write=self._write_PIECTRL)
        regs.bind("PIEACK", write=self._write_PIEACK)
        for x in range(GROUPS):
            regs.bind(f"PIEIER{x + 1}", write=partial(self._write_PIEIERx, x))
            regs.bind(f"PIEIFR{x + 1}", write=partial(self._write_PIEIFRx, x))
            cpu.connect(x + 1, partial(self._fetch, x), partial(self._describe, x + 1))
        for line in DIRECT_VECTORS:
            cpu.connect(line, partial(self._run, line), partial(self._describe, line))

    def reset(self) -> None:
        """Registers to 0.  Vectors stay: they are RAM."""
        self._regs.reset()

    # --- for the board and the kernel --------------------------------------------------------------------------------

    def line(self, group: int, n: int) -> Callable[[], None]:
        """The input of interrupt `group`.`n`: call it for a pulse.  Raises ValueError outside 1..12, 1..16."""
        served, vector = self._served, vector_id(group, n)
        ifr, ier, bit, x = self._ifr[group - 1], self._ier[group - 1], 1 << n - 1, group - 1

        def pulse() -> None:
            if served[vector] >= 0:
                served[vector] = -1
            if ier.value & bit:
                if self._ack.value & 1 << x:
                    self._check_blocked(x, n, again=bool(ifr.value & bit))
                ifr.value |= bit
                self._deliver(x)
            else:
                ifr.value |= bit

        return pulse

    def flag_left(self, group: int, n: int, flag: str, *, at_once: bool = False) -> bool:
        """The source of interrupt `group`.`n` gives no pulse for an event because its `flag` is still set.

        It is reported at the routine of that interrupt, if this has run since the last pulse and has left the flag for
        long (`at_once`: for any time).  Returns False if there is no such routine.
        """
        vector = vector_id(group, n)
        since = self._served[vector]
        handler, begins = self._vectors.get(vector, (None, None))
        if since < 0 or begins is None or handler is None:
            return False
        self._blocked[group, n] = flag, begins, since
        if at_once or self._clock.now >= since + LONG_CYCLES:
            self._report_blocked(flag, begins, group, n)
        return True

    def finish(self) -> None:
        """The run ends.  Report also flags that have kept an interrupt back for half of that time.

        A routine that has run since then was called for what came: it had the flag to clear, and had not ended.
        """
        for (group, n), (flag, begins, since) in self._blocked.items():
            if since == self._served[vector_id(group, n)] and self._clock.now >= since + LONG_CYCLES // 2:
                self._report_blocked(flag, begins, group, n)

    def _report_blocked(self, flag: str, begins: Place, group: int, n: int) -> None:
        self._cpu.findings.report_at(
            begins, "flag-not-cleared",
            f"{flag} is still set after the routine of interrupt {group}.{n}: no further interrupt is generated until "
            "it is cleared",
            how="dynamic", object=flag, task=self._cpu.routine_at(begins),
        )  # fmt: skip

    def enabled(self, group: int, n: int) -> bool:
        """Whether PIEIER lets interrupt `group`.`n` through."""
        return bool(self._ier[group - 1].value & 1 << n - 1)

    def kept_out(self, group: int, n: int) -> bool:
        """Whether interrupt `group`.`n` is pending, and PIEIER does not let it through."""
        return bool(self._ifr[group - 1].value & ~self._ier[group - 1].value & 1 << n - 1)

    def was_enabled(self, group: int, n: int) -> bool:
        """Whether PIEIER has ever let interrupt `group`.`n` through."""
        return vector_id(group, n) in self._enabled_by

    def has_run(self, group: int, n: int) -> bool:
        """Whether interrupt `group`.`n` was ever taken."""
        return self._has_run[vector_id(group, n)]

    def waits(self, group: int, n: int) -> bool:
        """Whether interrupt `group`.`n` is pending and enabled while no interrupt of its group was ever taken."""
        return bool(self._ifr[group - 1].value & self._ier[group - 1].value & 1 << n - 1) and not self._taken[group - 1]

    def left_by(self, group: int, n: int) -> Place | None:
        """The place of the firmware's routine of interrupt `group`.`n`, if it has run since the last pulse."""
        return self.routine(group, n) if self._served[vector_id(group, n)] >= 0 else None

    def routine(self, group: int, n: int) -> Place | None:
        """The place of the firmware's routine of interrupt `group`.`n`."""
        return self._vectors.get(vector_id(group, n), (None, None))[1]

    def set_vector(self, vector_id: int, handler: Callable[[], None] | None, begins: Place | None = None) -> None:
        """Write a vector: `handler` runs when interrupt `vector_id` is taken (13..0xDF).  None: nothing runs.

        15 to 31 are the core's own (data log, RTOS, emulation, NMI, traps), which nothing here takes.
        `begins`: the place of the firmware's routine, where findings about it are reported.
        """
        if not DIRECT_VECTORS[0] <= vector_id < VECTORS:
            raise ValueError(f"PIE vector {vector_id:#x}: expected 0xd..0xdf")
        if handler is None:
            self._vectors.pop(vector_id, None)
        else:
            self._vectors[vector_id] = handler, begins

    def has_vector(self, vector_id: int) -> bool:
        """Whether a function runs when interrupt `vector_id` is taken."""
        return vector_id in self._vectors

    @property
    def has_routines(self) -> bool:
        """Whether a vector is a function of the firmware."""
        return any(begins is not None for _, begins in self._vectors.values())

    def enable(self) -> None:
        """Set ENPIE."""
        self._write_PIECTRL(self._ctrl.value | 1)

    # --- the flow ----------------------------------------------------------------------------------------------------

    def _deliver(self, x: int) -> None:
        """Pass group `x` (from 0) on to the CPU if a line is latched and enabled and no acknowledge is missing."""
        ack = 1 << x
        if self._ifr[x].value & self._ier[x].value and not self._ack.value & ack and self._ctrl.value & 1:
            self._ack.value |= ack
            self._cpu.raise_line(x + 1)

    def _check_blocked(self, x: int, n: int, *, again: bool) -> None:
        """A missing acknowledge holds an interrupt back.  Report it if one is lost (`again`) or waits for long."""
        if again:
            self._not_acknowledged(x, n)
        elif not self._cpu.in_interrupt:
            before = self._acknowledged[x]
            self._clock.after(LONG_CYCLES, partial(self._report_if_blocked, x, n, before))

    def _report_if_blocked(self, x: int, n: int, acknowledged: int) -> None:
        if self._acknowledged[x] == acknowledged:
            self._not_acknowledged(x, n)

    def is_blocked(self, group: int, n: int) -> bool:
        """Whether a missing acknowledge holds a pending interrupt `group`.`n` back.  Then report it."""
        x = group - 1
        waits = self._ifr[x].value & self._ier[x].value & 1 << n - 1
        return bool(waits and self._ack.value & 1 << x) and self._not_acknowledged(x, n)

    def _not_acknowledged(self, x: int, n: int) -> bool:
        cpu = self._cpu
        handler, begins = self._vectors.get(self._taken[x], (None, None))
        if cpu.ifr & 1 << x or cpu.in_interrupt or handler is None:
            return False  # not taken yet, not over yet; or nothing was there to acknowledge, which has been told
        name = f"{self._ack.path}.ACK{x + 1}"
        message = (
            f"{name} is still set after the last interrupt of group {x + 1}: interrupt {x + 1}.{n} came again and is "
            f"not taken, nor is any of its group; a routine ends with {self._ack.path}.all = PIEACK_GROUP{x + 1}"
        )
        if begins is None:
            cpu.findings.report("flag-not-cleared", message, object=name)
        else:
            cpu.findings.report_at(
                begins, "flag-not-cleared", message, how="dynamic", object=name, task=cpu.routine_at(begins)
            )  # fmt: skip
        return True

    def _deliver_all(self) -> None:
        for x in range(GROUPS):
            if self._ifr[x].value:
                self._deliver(x)

    def _fetch(self, x: int) -> None:
        """The CPU takes INT(x+1).  The lowest latched and enabled line gives the vector; its flag is cleared."""
        if not self._ctrl.value & 1:
            # CHOICE: if disabled between latch and fetch, nothing runs (silicon would use the boot ROM's vector).
            return
        bit = self._next(x)
        self._ifr[x].value &= ~bit
        self._forced[x] &= ~bit
        vector = vector_id(x + 1, bit.bit_length())
        self._taken[x] = vector
        self._has_run[vector] = True
        self._run(vector)
        self._served[vector] = self._clock.now

    def _next(self, x: int) -> int:
        """The flag whose vector is fetched next for group `x`.  TRM: if none is left, it is that of INTx.1."""
        active = self._ifr[x].value & self._ier[x].value
        return active & -active if active else 1

    def _describe(self, line: int) -> tuple[str, str, Place | None]:
        """The interrupt that waits at a CPU line: its vector, its source, and where its routine begins."""
        vector, forced = line, False
        if line <= GROUPS:
            bit = self._next(line - 1)
            vector, forced = vector_id(line, bit.bit_length()), bool(self._forced[line - 1] & bit)
        name = _ENTRIES.get(vector, f"vector {vector:#04x}")
        source = f"its source {name.removesuffix('_INT')}"
        if forced:
            source = f"the firmware itself, which sets PIEIFR{line}.INTx{bit.bit_length()},"
        _, begins = self._vectors.get(vector, (None, None))
        return f"{name} ({_name(vector)})", source, begins

    def _run(self, vector: int) -> None:
        if self._ctrl.value & 1:  # the vector comes from the table
            self._ctrl.value = VECTOR_TABLE + 2 * vector | 1
        entry = self._vectors.get(vector)
        if entry is not None:
            entry[0]()
        else:
            reserved = "the line is reserved, no module of this chip requests it, and its entry is not modelled"
            empty = "nothing was written to its entry of PieVectTable"
            self._cpu.findings.report(
                "interrupt-without-handler",
                f"{_name(vector)} (vector id {vector:#04x}) was taken but has no handler: "
                f"{empty if vector in _ENTRIES else reserved}",
                object=f"vector {vector:#04x}", cause=self._enabled_by.get(vector),
            )  # fmt: skip

    # --- register handlers -------------------------------------------------------------------------------------------

    def _write_PIECTRL(self, word: int, lanes: int = ALL) -> None:
        self._ctrl.store(word, lanes)
        self._deliver_all()

    def _write_PIEACK(self, word: int, lanes: int = ALL) -> None:
        released = self._ack.value & word
        self._ack.store(word, lanes)
        while released:
            bit = released & -released
            released ^= bit
            self._acknowledged[bit.bit_length() - 1] += 1
            self._deliver(bit.bit_length() - 1)

    def _write_PIEIERx(self, x: int, word: int, lanes: int = ALL) -> None:
        added = word & lanes & ~self._ier[x].value
        for n in range(1, LINES + 1) if added else ():
            if added & 1 << n - 1:
                self._enabled_by[vector_id(x + 1, n)] = self._cpu.findings.mark()
        self._ier[x].store(word, lanes)
        self._deliver(x)

    def _write_PIEIFRx(self, x: int, word: int, lanes: int = ALL) -> None:
        # Writing 1 latches an interrupt.  Writing 0 loses an interrupt that came after the program read the word.
        self._forced[x] |= word & lanes & ~self._ifr[x].value
        self._ifr[x].store(word, lanes)
        self._deliver(x)
