"""Objects of the firmware that several threads use: `race`, `race-long`, `race-word`, `unmasked-long`, `wrong-gate`.

On the C28x a 16-bit scalar, and an aligned 32-bit one by MOVL or MOV32, is loaded and stored by one instruction, so
what can be torn is more than one scalar, or a statement that reads and writes one.  A plain integer or pointer is also
how one thread tells another that something is ready: whoever reads it knows what its last writer had done before.

Without the kernel the threads are `main` and the routines of the vector table, and what holds a routine off is INTM,
IER, PIEIER or the enable of its peripheral.  There a single integer that nobody reads and writes in one statement is
right as it is.

Not seen: accesses that do not come through an object (address 0, registers), and the order that a comparison of times
or a peripheral's own interrupt enable gives.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Final

from emulator.c28x.ctypes import ArrayType, CType, FloatType, StructType
from emulator.c28x.findings import Finding, Findings
from emulator.c28x.memory import Memory, Object
from emulator.c28x.symbols import Module
from emulator.clock import us
from emulator.sysbios.watch.accesses import LatestAccess, SharedObject
from emulator.sysbios.watch.names import HandleNames
from emulator.sysbios.watch.pairs import Pair, continued, pairs, turned_by_both
from emulator.sysbios.watch.spots import Function, Spot, StatementSpots
from emulator.sysbios.watch.threads import HWI_LEVEL, Gate, Routine, Thread, ThreadWatch, at_clock, excluded, joined

_RANK: Final = {"race-word": 1, "unmasked-long": 1, "race-long": 2, "race": 3}
#: Locals of functions that have returned are forgotten whenever this many were seen.
_LOCALS_KEPT: Final = 256
_DETAILS: Final = 8


class Shared:
    """An object, its cells by word offset, and what is known of its protection."""

    __slots__ = (
        "apart", "beside", "cells", "conflicting", "findings", "hands_over", "joint", "known", "object", "pairs",
        "per_element", "rank", "run", "under", "users", "written",
    )  # fmt: skip

    def __init__(self, obj: Object) -> None:
        ctype = obj.declaration.ctype
        self.object = obj
        self.cells: dict[int, SharedObject] = {}
        #: Words per element for an array of structures: its elements are apart.
        self.per_element = _stride(ctype)
        self.conflicting: dict[int, set[int]] = {}
        #: Without the kernel: words that a run of a routine wrote together with others; the latest run, and its words.
        self.joint: set[int] = set()
        self.run: tuple[int, set[int]] = (0, set())
        #: Of the text: words that belong together; which of them `main` has read unprotected, by the routine and pair.
        self.pairs: list[Pair] | None = None
        self.apart: dict[tuple[Thread, Pair], set[int]] = {}
        #: Plain integers that such a run wrote too: one of them may say whether the words are whole.
        self.beside: set[Object] = set()
        self.findings: dict[str, Finding] = {}
        self.rank = 0
        #: Whether its integers may say that something else is ready: elements of an array are data.
        self.hands_over = not isinstance(ctype, ArrayType)
        #: Gate -> the functions that use the object under it, with a statement; the threads that use it under a gate.
        self.under: dict[Gate, dict[Function, Spot]] = {}
        self.users: set[Thread] = set()
        #: Uses under gates that are known already.
        self.known: set[tuple[Spot, Thread, frozenset[Gate]]] = set()
        self.written = False

    def may_hand_over(self, offset: int) -> bool:
        """Whether the scalar at word `offset` may say that something else is ready."""
        leaf = self.object.leaf(offset) if self.hands_over else None
        return leaf is not None and not isinstance(leaf[1], FloatType)


def _stride(ctype: CType) -> int:
    element = ctype.element if isinstance(ctype, ArrayType) else None
    return element.words if element is not None and element.leaves > 1 else 0


def _has_array(ctype: CType) -> bool:
    return isinstance(ctype, StructType) and any(isinstance(m.ctype, ArrayType) for m in ctype.members)


class Races:
    """Gets every access of an object that several threads can reach."""

    def __init__(
        self, threads: ThreadWatch, spots: StatementSpots, names: HandleNames, findings: Findings, memory: Memory,
        modules: Collection[Module],
    ) -> None:  # fmt: skip
        self._modules = modules
        #: What the text says of programs without the kernel, read when their first routine has come.
        self._pairs: dict[str, list[Pair]] | None = None
        self._continued: dict[str, set[tuple[str, str]]] = {}
        self._turned: dict[str, set[str]] = {}
        self._threads = threads
        self._spots = spots
        self._names = names
        self._findings = findings
        self._memory = memory
        self._clock = findings.clock
        self._position = findings.position
        self._objects: dict[Object, Shared] = {}
        #: Without the kernel: what the latest run of a routine has written.
        self._written: tuple[int, set[Shared]] = (0, set())
        self._locals: dict[Object, Shared] = {}

    def touch(self, obj: Object, offset: int, write: bool) -> None:
        """The running thread reads or writes the scalar at word `offset`."""
        threads = self._threads
        thread = threads.current
        if (thread is threads.main and not threads.routines) or obj.readonly:
            return
        shared = self._objects.get(obj) or self._shared(obj)
        cell = shared.cells.get(offset)
        if cell is None:
            cell = shared.cells[offset] = SharedObject(thread, shared.may_hand_over(offset))
        if cell.owner is not thread:
            cell.owner = None
            self._shared_touch(shared, cell, offset, write, thread)
        if shared.pairs is not None and not write and thread is threads.main:
            self._taken_together(shared, offset)
        if cell.owner is not thread:
            return
        if write:
            if thread not in cell.writers:
                shared.written = True
                cell.writers.add(thread)
            if threads.routines:
                self._joint(shared, offset)
            if cell.hands_over and not obj.ended:
                cell.handed = (thread, thread.clock, thread.vc)
                thread.clock += 1
        if thread.entered:
            self._gates(shared, threads.gates(thread), thread, self._spots.here())

    def _shared_touch(self, shared: Shared, cell: SharedObject, offset: int, write: bool, thread: Thread) -> None:
        """As `touch`, of a scalar that several threads use."""
        position = self._position
        spot = position.at or position.innermost()
        protection = self._threads.protection()
        conflicts = cell.conflicts(thread, protection)
        if write and self._threads.routines:
            self._joint(shared, offset)
            conflicts += cell.unfinished(thread, protection)
        if conflicts:
            access = LatestAccess(thread, write, protection, thread.clock, spot, self._clock.now)
            for other in conflicts:
                self._conflict(shared, cell, offset, other, access)
        cell.keep(thread, write, protection, spot, self._clock.now)
        if write:
            if cell.reader is thread and (cell.reader_spot == spot or self._spots.takes(spot)):
                cell.changed.setdefault(thread, {})[protection] = spot
                if shared.rank < _RANK["race"] and thread is self._threads.main:
                    self._turned_by(self._turned.get(shared.object.declaration.path, ()), shared, spot)
            shared.written = True
            cell.writers.add(thread)
            if cell.hands_over and not shared.object.ended:
                cell.handed = (thread, thread.clock, thread.vc)
                thread.clock += 1
        else:
            handed = cell.handed
            if handed is not None and not thread.knows(handed[0], handed[1]):
                writer, clock, vc = handed
                thread.vc = joined(thread.vc, at_clock(vc, writer.index, clock))
            cell.reader, cell.reader_spot = thread, spot
        if protection.gates:
            self._gates(shared, protection.gates, thread, spot)

    def _turned_by(self, routines: Collection[str], shared: Shared, spot: Spot) -> None:
        """`main` moves an index of a ring that a routine moves too, though not in this run: when the ring is full."""
        threads = self._threads
        for routine in threads.all if routines else ():
            if not isinstance(routine.what, Routine) or routine.what.name not in routines:
                continue
            if not excluded(threads.main, threads.protection(), routine, routine.protection):
                self._by_text(shared, spot, self._sentence(shared, "race", True, threads.main, routine, None))
                return

    def _by_text(self, shared: Shared, spot: Spot, message: str) -> None:
        """A race of which this run has seen the half that is `main`'s."""
        shared.rank = _RANK["race"]
        place = self._spots.place(spot)
        assert place is not None
        self._findings.report_at(
            place, "race", message, object=shared.object.declaration.path, declaration=str(shared.object.declaration),
            how="dynamic",
        )  # fmt: skip

    def _taken_together(self, shared: Shared, offset: int) -> None:
        """`main` reads a word; a routine sets it and others, though not in this run, and `main` takes them together."""
        threads = self._threads
        assert shared.pairs is not None
        spot = self._spots.here()
        for pair in shared.pairs if shared.rank < _RANK["race"] else ():
            if offset not in pair.words or self._spots.function(spot) != pair.reader:
                continue
            for routine in threads.all:
                if not isinstance(routine.what, Routine) or routine.what.name not in pair.routines:
                    continue
                read = shared.apart.setdefault((routine, pair), set())
                if excluded(threads.main, threads.protection(), routine, routine.protection):
                    read.clear()
                    continue
                read.add(offset)
                if len(read) > 1:
                    self._by_text(shared, spot, self._sentence(shared, "race", False, threads.main, routine, None))
                    return

    def _shared(self, obj: Object) -> Shared:
        known = self._locals.get(obj)
        if known is not None:
            return known
        shared = Shared(obj)
        if self._threads.routines:
            if self._pairs is None:  # Most images never ask.
                self._pairs, self._continued = pairs(self._modules), continued(self._modules)
                self._turned = turned_by_both(self._modules)
            shared.pairs = self._pairs.get(obj.declaration.path)
        if not obj.declaration.function:
            self._objects[obj] = shared
            return shared
        if len(self._locals) >= _LOCALS_KEPT:
            live = set(self._memory.live_locals)
            self._locals = {o: s for o, s in self._locals.items() if o in live}
        self._locals[obj] = shared
        return shared

    # Conflicts

    def _conflict(
        self, shared: Shared, cell: SharedObject, offset: int, other: LatestAccess, access: LatestAccess
    ) -> None:
        p, q = other.protection.gates, access.protection.gates
        if p and q:
            self._wrong_gate(shared, other, access)
            return
        element = offset // shared.per_element if shared.per_element else 0
        conflicting = shared.conflicting.setdefault(element, set())
        conflicting.add(offset)
        lower, higher = sorted((other, access), key=lambda a: a.thread.level)
        low, high = lower.thread, higher.thread
        cut = cell.cut(low, higher)
        if low.level == HWI_LEVEL and cut is None:  # Two handlers can nest either way round.
            cut = cell.cut(high, lower)
        lost = cut is not None
        bare, goes_on = bool(self._threads.routines), False
        if bare:
            # What belongs together: words of a buffer; those of a structure of which a run of a routine writes several;
            # those of a 32-bit scalar that somebody takes by halves.
            words = (set() if shared.beside else shared.joint) if shared.hands_over else conflicting
            several = len(conflicting & words) > 1
            several |= offset + 1 in shared.cells and shared.object.leaf(offset + 1) is None
        else:
            several = len(conflicting) > 1 or self._several(shared, offset)
        if lost or several:
            rule = "race"
        else:
            leaf = shared.object.leaf(offset)
            rule = "race-word" if leaf is None or leaf[1].words == 1 else "race-long"
            if bare:
                goes_on = rule == "race-word" and self._goes_on(shared, lower, higher)
                if rule == "race-word" and not goes_on:
                    return  # a flag, a counter, an index: how programs without a kernel do it
                rule = "race" if goes_on else "unmasked-long"
        if _RANK[rule] <= shared.rank:
            self._again(shared, other, access)
            return
        shared.rank = _RANK[rule]
        if bare and access.thread is not low:
            # Told at the statement that must hold the interrupt off.
            access, other = other, access
        at = (access.spot if cut is None else cut) if bare else 0
        if not bare and p and not q:
            at = access.spot
        elif not bare and q and not p:
            access, other, at = other, access, other.spot  # told where the gate is missing
        said = self._sentence(shared, rule, lost, low, high, access)
        if goes_on:
            said += ": it goes on with this object and with others, which are set one by one"
        self._report(shared, rule, said, other, at)

    def _goes_on(self, shared: Shared, lower: LatestAccess, higher: LatestAccess) -> bool:
        """Whether `main` sets anew what a routine goes on with, a count or an index among other objects."""
        what = higher.thread.what
        if not lower.write or lower.thread is not self._threads.main or not isinstance(what, Routine):
            return False
        _, function = self._spots.function(lower.spot)
        return (what.name, function) in self._continued.get(shared.object.declaration.path, ())

    def _joint(self, shared: Shared, offset: int) -> None:
        """A run of a routine writes a word; with another one of the object, they belong together."""
        threads = self._threads
        if threads.current is not threads.main and shared.hands_over:
            at, written = self._written
            if at != threads.runs:
                self._written = threads.runs, (written := set())
            for other in written:
                for one, two in ((shared, other), (other, shared)):
                    if one is not two and two.object.declaration.ctype.leaves == 1:
                        one.beside.add(two.object)
            written.add(shared)
            if _has_array(shared.object.declaration.ctype):
                return  # a ring: its indices say what of it is whole
            run, words = shared.run
            if run != threads.runs:
                shared.run = threads.runs, {offset}
                return
            words.add(offset)
            if len(words) > 1:
                shared.joint |= words

    @staticmethod
    def _several(shared: Shared, offset: int) -> bool:
        """Whether more than this scalar of a structure is shared."""
        if not shared.hands_over and not shared.per_element:
            return False
        stride = shared.per_element or shared.object.words
        first = offset // stride * stride
        cells = (cell for at, cell in shared.cells.items() if first <= at < first + stride and at != offset)
        return any(cell.owner is None and cell.writers for cell in cells)

    def _sentence(
        self, shared: Shared, rule: str, lost: bool, low: Thread, high: Thread, access: LatestAccess | None
    ) -> str:
        """`access` None: `low` reads what `high` writes."""
        if access is None:
            access = LatestAccess(low, False, low.protection, 0, 0, 0)
        verb = "writes" if access.write else "reads"
        writer = high if access.thread is low else low
        nothing = "the interrupt is not masked" if self._threads.routines else "they share no gate"
        said = f"{shared.object.declaration.path}: {access.thread} {verb} what {writer} writes, and {nothing}: "
        if lost:
            return said + f"a write of {high} between a read and a write of {low} is lost"
        if rule == "race":
            return said + f"{high} can interrupt {low} between related parts"
        if access.write and rule != "unmasked-long":
            return said + "the last write wins"
        if rule in ("race-long", "unmasked-long"):
            return said + "it is atomic only while the compiler moves its 32 bits with one instruction"
        return said + "each access is atomic, but the value can change between two reads"

    def _report(self, shared: Shared, rule: str, message: str, other: LatestAccess, at: Spot) -> None:
        """Report at the statement that runs, or at another one."""
        obj = shared.object
        declaration, details = str(obj.declaration), (self._told(other),)
        place = self._spots.place(at) if at else None
        if place is None:
            finding = self._findings.report(
                rule, message, object=obj.declaration.path, declaration=declaration, details=details
            )
        else:
            finding = self._findings.report_at(
                place, rule, message, object=obj.declaration.path, declaration=declaration, details=details,
                how="dynamic",
            )  # fmt: skip
        if finding is not None:
            shared.findings[rule] = finding

    def _again(self, shared: Shared, *accesses: LatestAccess) -> None:
        """The same object once more: counted, and the place kept if it is a new one."""
        for rule, finding in shared.findings.items():
            if _RANK.get(rule) == shared.rank:
                finding.count += 1
                for access in accesses:
                    told = self._told(access, timed=False)
                    if len(finding.details) < _DETAILS and not any(d.startswith(told) for d in finding.details):
                        finding.details += (told,)

    def _told(self, access: LatestAccess, *, timed: bool = True) -> str:
        verb = "writes" if access.write else "reads"
        gates = access.protection.gates
        under = " under " + ", ".join(sorted(map(self._names.of, gates))) if gates else ""
        at = f", at {us(access.time):.3f} us" if timed else ""
        return f"{access.thread} {verb} it{under} in {self._spots.text(access.spot)}{at}"

    # Gates

    def _wrong_gate(self, shared: Shared, other: LatestAccess, access: LatestAccess) -> None:
        """Two gates, each of which keeps somebody off, but not each other."""
        a, b = (", ".join(sorted(map(self._names.of, x.protection.gates))) for x in (other, access))
        how = f"under {a} by {other.thread} and under {b} by {access.thread}"
        self._wrong(shared, how, self._told(other), access.spot)

    def _gates(self, shared: Shared, gates: frozenset[Gate], thread: Thread, spot: Spot) -> None:
        """An object that several functions use under one gate is used under another by one."""
        use = (spot, thread, gates)
        if not gates or not spot or use in shared.known:
            return
        shared.known.add(use)
        shared.users.add(thread)
        function = self._spots.function(spot)
        if all(function in shared.under.get(gate, ()) for gate in gates):
            return
        for gate in gates:
            shared.under.setdefault(gate, {})[function] = spot
        if len(shared.under) < 2 or len(shared.users) < 2 or not shared.written:
            return
        usual = max(shared.under, key=lambda gate: len(shared.under[gate]))
        functions = shared.under[usual]
        if len(functions) < 2:
            return
        for gate, users in shared.under.items():
            for user, where in users.items():
                if user not in functions and len(users) < len(functions):
                    a, b = self._names.of(usual), self._names.of(gate)
                    how = f"under {a} by {len(functions)} functions, but under {b} by {user[1]}"
                    first = self._spots.text(next(iter(functions.values())))
                    self._wrong(shared, how, f"under {a} in {first}", where)

    def _wrong(self, shared: Shared, how: str, detail: str, spot: Spot) -> None:
        known = shared.findings.get("wrong-gate")
        if known is not None:
            known.count += 1
            return
        obj = shared.object
        message = f"{obj.declaration.path} is used {how}: neither gate keeps the other's users off"
        place = self._spots.place(spot)
        if place is not None:
            finding = self._findings.report_at(
                place, "wrong-gate", message, object=obj.declaration.path, declaration=str(obj.declaration),
                details=(detail,), how="dynamic",
            )  # fmt: skip
            if finding is not None:
                shared.findings["wrong-gate"] = finding
