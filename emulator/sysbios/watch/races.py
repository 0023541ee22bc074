"""Objects of the firmware that several threads use: `race`, `race-long`, `race-word`, `unmasked-long`, `wrong-gate`.

The C28x loads and stores a 16-bit scalar with one instruction, and an aligned 32-bit one with MOVL or MOV32.  So a
thread can be interrupted only between two scalars, or within a statement that reads and writes one.  With a plain
integer or pointer, one thread can also tell another that data is ready: the reader then knows what the last writer had
done before the write.

Without the kernel the threads are `main` and the routines of the vector table.  INTM, IER, PIEIER or the enable of its
peripheral holds a routine off.  In such a program a single integer is correct without protection, unless one statement
reads and writes it.

Two things are not seen: accesses that are not made through an object (address 0, registers), and the order that a
comparison of times or a peripheral's own interrupt enable gives.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import Final

from emulator.c28x.ctypes import ArrayType, CType, FloatType, StructType
from emulator.c28x.findings import Finding, Findings
from emulator.c28x.memory import Memory, Object
from emulator.c28x.symbols import Module
from emulator.clock import us
from emulator.sysbios.watch.accesses import NONE, LatestAccess, ReadyFlag, SharedCell
from emulator.sysbios.watch.kept_off import (
    ScalarCondition,
    UseConditions,
    Word,
    alternating,
    averaged,
    rereading_lines,
    ring_indices,
    shown_in_turn,
)
from emulator.sysbios.watch.names import HandleNames
from emulator.sysbios.watch.pairs import (
    HandOver,
    Pair,
    arrays_of_flags,
    continued,
    divided,
    flag_members,
    handed_over,
    pairs,
    turned_by_both,
)
from emulator.sysbios.watch.statements import Function, StatementLocator, StatementNumber
from emulator.sysbios.watch.threads import HWI_LEVEL, SWI_LEVEL, Gate, Routine, Thread, ThreadWatch, excluded
from emulator.sysbios.watch.untold import untold_words
from emulator.sysbios.watch.whole_words import whole_words

_RANK: Final = {"race-word": 1, "unmasked-long": 1, "race-long": 2, "race": 3}
#: When this many locals are kept, those of functions that have returned are dropped.
_LOCALS_KEPT: Final = 256
_DETAILS: Final = 8


class SharedObject:
    """An object that several threads may use: its cells by word offset, and how its uses were protected."""

    __slots__ = (
        "apart", "beside", "cells", "conflicting", "findings", "hands_over", "joint", "known", "marks", "object",
        "pairs", "per_element", "rank", "record", "run", "under", "users", "written", "wrote",
    )  # fmt: skip

    def __init__(
        self, obj: Object, flags: bool = False, record: bool = True, marks: frozenset[int] = frozenset()
    ) -> None:  # fmt: skip
        ctype = obj.declaration.ctype
        self.object = obj
        self.cells: dict[int, SharedCell] = {}
        #: Words per element of an array of structures, each of which is judged alone; 0 for all other objects.
        self.per_element = _stride(ctype)
        #: Whether words belong together of which only one thread writes several.
        self.record = record
        self.conflicting: dict[int, set[int]] = {}
        #: Without the kernel: words that one run of a routine wrote together; the latest run, and the words it wrote.
        self.joint: set[int] = set()
        self.run: tuple[int, set[int]] = (0, set())
        #: From the source: words that belong together; by routine and pair, those that `main` has read unprotected.
        self.pairs: list[Pair] | None = None
        self.apart: dict[tuple[Thread, Pair], set[int]] = {}
        #: If it has pairs: the clock of each thread at its latest write.
        self.wrote: dict[Thread, int] = {}
        #: Plain integers that such a run wrote too.  One of them may tell `main` whether the words are complete.
        self.beside: set[Object] = set()
        self.findings: dict[str, Finding] = {}
        self.rank = 0
        #: Whether its integers may tell that other data is ready.  Elements of an array do so if they are flags.
        self.hands_over = flags or not isinstance(ctype, ArrayType)
        #: In a structure, or in each element of an array of structures: the offsets of members that are flags.
        self.marks = marks
        #: Gate -> the functions that use the object while they hold it, each with a statement; the threads that use
        #: the object under any gate.
        self.under: dict[Gate, dict[Function, StatementNumber]] = {}
        self.users: set[Thread] = set()
        #: Uses under gates that are known already.
        self.known: set[tuple[StatementNumber, Thread, frozenset[Gate]]] = set()
        self.written = False

    def marks_at(self, offset: int) -> bool:
        """Whether the scalar at word `offset` is a member that is a flag."""
        return (offset % self.per_element if self.per_element else offset) in self.marks

    def flag(self, offset: int) -> ReadyFlag | None:
        """The scalar at word `offset`, if its value may tell a reader that other data is ready."""
        leaf = self.object.leaf(offset) if self.hands_over or self.marks_at(offset) else None
        if leaf is None or isinstance(leaf[1], FloatType):
            return None
        return ReadyFlag(self.object.declaration.path, offset, self.object.data, leaf[0])


def _stride(ctype: CType) -> int:
    element = ctype.element if isinstance(ctype, ArrayType) else None
    return element.words if element is not None and element.leaves > 1 else 0


def _words(shared: SharedObject, offset: int) -> int:
    """The words of the scalar at a word of an object; 1 for a part of a structure that is no scalar of its own."""
    leaf = shared.object.leaf(offset)
    return 1 if leaf is None else leaf[1].words


def _names_one(threads: Iterable[Thread], routines: Collection[str]) -> bool:
    """Whether one of two threads is one of these routines."""
    return any(isinstance(thread.what, Routine) and thread.what.name in routines for thread in threads)


def _has_array(ctype: CType) -> bool:
    return isinstance(ctype, StructType) and any(isinstance(member.ctype, ArrayType) for member in ctype.members)


class Races:
    """Checks every access of an object that several threads can reach."""

    def __init__(
        self, threads: ThreadWatch, locator: StatementLocator, names: HandleNames, findings: Findings, memory: Memory,
        modules: Collection[Module],
    ) -> None:  # fmt: skip
        self._modules = modules
        #: What the source of a program without the kernel shows; read after its first interrupt.
        self._pairs: dict[str, list[Pair]] | None = None
        self._continued: dict[str, set[tuple[str, str]]] = {}
        self._turned: dict[str, set[str]] = {}
        self._handed: dict[str, set[HandOver]] = {}
        #: Double buffers, from the source: path -> the paths of what selects the part that a routine uses.
        self._alternating: dict[str, set[str]] = {}
        #: Arrays of which a routine uses one element in each run, from the source: path -> such routines.
        self._in_turn: dict[str, set[str]] = {}
        #: Words that a routine, by its name, also writes in runs in which it tells nothing, from the source.
        self._untold: dict[str, set[Word]] = {}
        #: Early hand-over -> the words that `main` still uses while the routine may use them too.
        self._late: dict[HandOver, set[tuple[Object, int]]] = {}
        #: What keeps `main` and a routine apart without a mask: see kept_off.py.
        self._conditions = UseConditions(())
        self._rereading: frozenset[tuple[str, int]] = frozenset()
        self._of_path: dict[str, SharedObject] = {}
        #: Arrays of flags, from the source (None: not read yet), and members of structures that are flags.
        self._flags: set[str] | None = None
        self._marks: set[tuple[StructType, int]] = set()
        #: Structures in which threads have members of their own, from the source; None: not read yet.
        self._divided: set[StructType] | None = None
        #: Indices of ring buffers, from the source; None: not read yet.
        self._indices: dict[Word, bool] | None = None
        #: 32-bit objects that functions move as a whole, from the source; None: not read yet.
        self._whole: Mapping[str, Mapping[Function, int]] | None = None
        self._threads = threads
        self._locator = locator
        self._names = names
        self._findings = findings
        self._memory = memory
        self._clock = findings.clock
        self._position = findings.position
        self._objects: dict[Object, SharedObject] = {}
        #: Without the kernel: the number of the latest run of a routine, and the objects that it has written.
        self._written: tuple[int, set[SharedObject]] = (0, set())
        self._locals: dict[Object, SharedObject] = {}

    def touch(self, obj: Object, offset: int, write: bool) -> None:
        """The running thread reads or writes the scalar at word `offset`."""
        threads = self._threads
        thread = threads.current
        if (thread is threads.main and not threads.routines) or obj.readonly:
            return
        shared = self._objects.get(obj) or self._shared(obj)
        cell = shared.cells.get(offset)
        if cell is None:
            cell = shared.cells[offset] = SharedCell(thread, shared.flag(offset))
        if not write and cell.hands_over and thread.level >= SWI_LEVEL:
            thread.seen[cell] = cell.value, (-1 if cell.handed is None else cell.handed[0].level)
        if shared.pairs is not None:
            if write:
                shared.wrote[thread] = thread.clock
            elif thread is threads.main:
                self._read_together(shared, offset)
        if cell.owner is not thread:
            cell.owner = None
            self._shared_touch(shared, cell, offset, write, thread)
        if cell.owner is not thread:
            return
        if write:
            if thread not in cell.writers:
                shared.written = True
                cell.writers.add(thread)
            if threads.routines:
                self._joint(shared, offset)
            if cell.hands_over and not obj.ended:
                cell.hand_over(thread, self._position.at, self._clock.now)
        if thread.entered:
            self._gates(shared, threads.gates(thread), thread, self._locator.here())

    def _shared_touch(self, shared: SharedObject, cell: SharedCell, offset: int, write: bool, thread: Thread) -> None:
        """As `touch`, for a scalar that several threads use."""
        position = self._position
        statement = position.at or position.innermost()
        protection = self._threads.protection()
        last = cell.last
        if cell.calm and not write and last is not None and last.thread is thread and last.protection is protection:
            cell.keep(thread, False, protection, statement, self._clock.now)
            cell.reader_statement = statement
            return
        conflicts, by_time = cell.conflicts(thread, protection), NONE
        # While the kernel runs, threads change their levels and hold gates.
        cell.calm = not write and not conflicts and not self._threads.kernel.active
        if write and self._threads.routines:
            self._joint(shared, offset)
            unfinished = cell.unfinished(thread, protection)
            by_time = tuple(other for other in unfinished if cell.apart_by_time(other, thread))
            if by_time and shared.object.declaration.path in self._alternating:
                by_time = tuple(other for other in by_time if self._turned_since(shared, thread, other))
            conflicts += tuple(other for other in unfinished if other not in by_time)
        if conflicts and shared.object.declaration.path in self._alternating:
            conflicts = tuple(other for other in conflicts if not self._turned_since(shared, thread, other))
        if conflicts and (routines := self._in_turn.get(shared.object.declaration.path)):
            conflicts = tuple(other for other in conflicts if not _names_one((thread, other.thread), routines))
        if conflicts or by_time:
            access = LatestAccess(thread, write, protection, thread.clock, statement, self._clock.now)
            for other in conflicts:
                if not self._held_off(shared, offset, other, thread) and not self._reread(other, access):
                    self._conflict(shared, cell, offset, other, access)
            for other in by_time:
                if not self._reread(other, access):
                    self._alone(shared, offset, other, access)
        cell.keep(thread, write, protection, statement, self._clock.now)
        if write:
            if cell.reader is thread and (cell.reader_statement == statement or self._locator.takes(statement)):
                cell.changed.setdefault(thread, {})[protection] = statement
                if shared.rank < _RANK["race"] and thread is self._threads.main:
                    self._turned_by(self._turned.get(shared.object.declaration.path, ()), shared, statement)
            shared.written = True
            cell.writers.add(thread)
            if cell.hands_over and not shared.object.ended:
                cell.hand_over(thread, statement, self._clock.now)
        else:
            cell.take_over(thread)
            cell.reader, cell.reader_statement = thread, statement
        if protection.gates:
            self._gates(shared, protection.gates, thread, statement)

    def _turned_since(self, shared: SharedObject, thread: Thread, access: LatestAccess) -> bool:
        """Whether `thread` has turned to another part of a double buffer since another thread used a word of it.

        The other thread had the time until then.  If it was too slow, it goes on after the turn: with words that
        nothing has handed over to it.
        """
        for path in self._alternating[shared.object.declaration.path]:
            selector = self._of_path.get(path)
            for cell in selector.cells.values() if selector is not None else ():
                if cell.handed is not None and cell.handed[0] is thread and cell.handed_at > access.time:
                    return True
        return False

    def _held_off(self, shared: SharedObject, offset: int, other: LatestAccess, thread: Thread) -> bool:
        """Whether a flag keeps an access of a higher level off, as far as the source does not say that it does not."""
        path, what = shared.object.declaration.path, other.thread.what
        routine = what.name if isinstance(what, Routine) else ""
        return any(
            not self._conditions.denies(routine, path, offset, other.write, (flag.path, flag.word))
            for flag in other.held_off(thread)
        )

    def _reread(self, *accesses: LatestAccess) -> bool:
        """Whether one of the accesses is a read that its loop repeats if the object has changed."""
        for access in accesses if self._rereading else ():
            place = self._locator.place(access.statement)
            if not access.write and place is not None and (place.file, place.line) in self._rereading:
                return True
        return False

    def _turned_by(self, routines: Collection[str], shared: SharedObject, statement: StatementNumber) -> None:
        """`main` moves an index of a ring buffer.  The source shows that a routine moves it too, when the ring is full.

        The run need not have shown that.  Report a race if nothing holds such a routine off.
        """
        threads = self._threads
        for routine in threads.all if routines else ():
            if not isinstance(routine.what, Routine) or routine.what.name not in routines:
                continue
            if not excluded(threads.main, threads.protection(), routine, routine.protection):
                self._by_text(shared, statement, self._sentence(shared, "race", True, threads.main, routine, None))
                return

    def _by_text(self, shared: SharedObject, statement: StatementNumber, message: str) -> None:
        """Report a race of which the run has shown `main`'s access, and the source the routine's."""
        shared.rank = _RANK["race"]
        place = self._locator.place(statement)
        assert place is not None
        self._findings.report_at(
            place, "race", message, object=shared.object.declaration.path, declaration=str(shared.object.declaration),
            how="dynamic",
        )  # fmt: skip

    def _read_together(self, shared: SharedObject, offset: int) -> None:
        """`main` reads a word of a pair that the source shows: a routine sets several words, `main` uses them together.

        Report a race if `main` has read two of them while nothing held the routine off.
        """
        threads = self._threads
        assert shared.pairs is not None
        statement = self._locator.here()
        for pair in shared.pairs if shared.rank < _RANK["race"] else ():
            if offset not in pair.words or not self._reads(pair, statement):
                continue
            for routine in threads.all:
                if not isinstance(routine.what, Routine) or routine.what.name not in pair.routines:
                    continue
                read = shared.apart.setdefault((routine, pair), set())
                apart = excluded(threads.main, threads.protection(), routine, routine.protection)
                conditions = self._conditions.writing(routine.what.name, shared.object.declaration.path)
                if apart or self._kept_off(conditions):
                    read.clear()
                elif read or self._goes_on(shared, pair, routine.what.name) or not self._told_before(
                    shared, routine, routine.what.name
                ):  # fmt: skip
                    read.add(offset)
                if len(read) > 1:
                    self._by_text(shared, statement, self._sentence(shared, "race", False, threads.main, routine, None))
                    return

    def _kept_off(self, conditions: Collection[ScalarCondition]) -> bool:
        """Whether one of the conditions of a routine is not met until `main` changes a flag, and `main` knows it."""
        main = self._threads.main
        for condition in conditions:
            flag = self._of_path.get(condition.path)
            cell = None if flag is None else flag.cells.get(condition.word)
            if cell is None or not cell.hands_over or condition.true_of(cell.value):
                continue
            if cell.handed is None or main.knows(cell.handed[0], cell.handed[1]):
                return True
        return False

    def _goes_on(self, shared: SharedObject, pair: Pair, routine: str) -> bool:
        """Whether a routine writes a word of a pair whatever `main` does, also in runs in which it tells nothing."""
        path, untold = shared.object.declaration.path, self._untold.get(routine, ())
        return any((path, word) in untold for word in pair.words)

    def _told_before(self, shared: SharedObject, thread: Thread, routine: str) -> bool:
        """Whether a routine that does not wait for `main` has told `main` that the object is complete.

        Then only time keeps the two apart.  If that fails, a conflict shows it.
        """
        conditions = self._conditions.writing(routine, shared.object.declaration.path)
        known = shared.wrote.get(thread, thread.run[0])
        return self._threads.main.knows(thread, known) and not any(condition.answered for condition in conditions)

    def _reads(self, pair: Pair, statement: StatementNumber) -> bool:
        """Whether a statement is one that uses the words of a pair together."""
        place = self._locator.place(statement)
        return place is not None and (place.file, place.function) == pair.reader and pair.line in (0, place.line)

    def _shared(self, obj: Object) -> SharedObject:
        known = self._locals.get(obj)
        if known is not None:
            return known
        flags, marks, ctype = False, frozenset[int](), obj.declaration.ctype
        if isinstance(ctype, ArrayType | StructType):
            if self._flags is None:
                self._flags, self._marks = arrays_of_flags(self._modules), flag_members(self._modules)
            flags = obj.declaration.path in self._flags
            one = ctype.element if isinstance(ctype, ArrayType) else ctype
            if isinstance(one, StructType):
                marks = frozenset(words for holder, words in self._marks if holder == one)
        shared = SharedObject(obj, flags, self._is_record(ctype), marks)
        if self._threads.routines:
            if self._pairs is None:  # Read late, because most images do not need it.
                self._pairs, self._continued = pairs(self._modules), continued(self._modules)
                self._turned, self._handed = turned_by_both(self._modules), handed_over(self._modules)
                self._alternating = alternating(self._modules)
                self._in_turn = shown_in_turn(self._modules) | averaged(self._modules)
                self._untold = untold_words(self._modules)
                self._conditions, self._rereading = UseConditions(self._modules), rereading_lines(self._modules)
            shared.pairs = self._pairs.get(obj.declaration.path)
        if not obj.declaration.function:
            self._objects[obj] = self._of_path[obj.declaration.path] = shared
            return shared
        if len(self._locals) >= _LOCALS_KEPT:
            live = set(self._memory.live_locals)
            self._locals = {item: kept for item, kept in self._locals.items() if item in live}
        self._locals[obj] = shared
        return shared

    def _is_record(self, ctype: CType) -> bool:
        """Whether the members of a structure are parts of one thing; words of other objects are.

        If its type has no name, they are objects with a common prefix: nobody can copy them or pass them on as a whole.
        So they are if two threads keep members of their own in it: the state of a module.
        """
        if not isinstance(ctype, StructType):
            return True
        if self._divided is None:
            self._divided = divided(self._modules)
        return ctype.has_name and ctype not in self._divided

    # Conflicts

    def _conflict(
        self, shared: SharedObject, cell: SharedCell, offset: int, other: LatestAccess, access: LatestAccess
    ) -> None:
        other_gates, access_gates = other.protection.gates, access.protection.gates
        if other_gates and access_gates:
            self._wrong_gate(shared, other, access)
            return
        element = offset // shared.per_element if shared.per_element else 0
        conflicting = shared.conflicting.setdefault(element, set())
        if shared.record or (other.write and access.write):
            conflicting.add(offset)
        lower, higher = sorted((other, access), key=lambda each: each.thread.level)
        low, high = lower.thread, higher.thread
        cut = cell.cut(low, higher)
        if low.level == HWI_LEVEL and cut is None:  # Two handlers can nest either way round.
            cut = cell.cut(high, lower)
        lost = cut is not None
        bare, goes_on, early = bool(self._threads.routines), False, ""
        if bare:
            # These words belong together: the words of a buffer; words of a structure that one run of a routine writes;
            # the halves of a 32-bit scalar that some code accesses half by half.
            words = (set() if shared.beside else shared.joint) if shared.hands_over else conflicting
            several = len(conflicting & words) > 1
            several |= offset + 1 in shared.cells and shared.object.leaf(offset + 1) is None
            early = self._early(shared, offset, lower, higher)
            several |= bool(early)
        else:
            # A flag by itself is read and written at once; what it stands for is judged by its own words.
            several = len(conflicting) > 1 or (not shared.marks_at(offset) and self._several(shared, offset))
        if lost or several:
            rule = "race"
        else:
            size = _words(shared, offset)
            rule = "race-word" if size == 1 else "race-long" if size == 2 else "race"
            if bare and size <= 2:
                goes_on = rule == "race-word" and self._check_continued(shared, lower, higher)
                if rule == "race-word" and not goes_on:
                    return  # a flag, counter or index: programs without a kernel rightly do it so
                rule = "race" if goes_on else "unmasked-long"
            elif rule == "race-long" and self._is_whole(shared, cell, other, access):
                rule = "race-word"
        if rule == "race-word" and self._is_index(shared, cell, offset, lower, higher):
            return
        if _RANK[rule] <= shared.rank:
            self._again(shared, other, access)
            return
        shared.rank = _RANK[rule]
        if bare and access.thread is not low:
            # Report it at the statement that must hold the interrupt off.
            access, other = other, access
        at = (access.statement if cut is None else cut) if bare else 0
        if not bare and other_gates and not access_gates:
            at = access.statement
        elif not bare and access_gates and not other_gates:
            access, other, at = other, access, other.statement  # reported where the gate is missing
        said = self._sentence(shared, rule, lost, low, high, access, "writes" if other.write else "reads")
        if goes_on:
            said += ": it goes on with this object and with others, which are set one by one"
        elif early and not lost:
            said += f", because {early} is handed over before that"
        self._report(shared, rule, said, other, at)

    def _is_whole(self, shared: SharedObject, cell: SharedCell, other: LatestAccess, access: LatestAccess) -> bool:
        """Whether one thread writes a 32-bit object, and each access moves it whole; a reader looks at it once."""
        if self._whole is None:
            self._whole = whole_words(self._modules)
        reads = self._whole.get(shared.object.declaration.path, {})
        once = all(
            function in reads and (each.write or reads[function] < 2)
            for each in (other, access) for function in (self._locator.function(each.statement),)
        )
        return once and len(cell.writers | {each.thread for each in (other, access) if each.write}) == 1

    def _is_index(
        self, shared: SharedObject, cell: SharedCell, offset: int, lower: LatestAccess, higher: LatestAccess
    ) -> bool:  # fmt: skip
        """Whether a word is an index of a ring buffer that one thread moves, and that the other one sees move.

        It does if it is volatile, or if nobody can move it while the other one runs.
        """
        if self._indices is None:
            self._indices = ring_indices(self._modules)
        place = shared.object.declaration.path, offset
        return len(cell.writers) == 1 and place in self._indices and (self._indices[place] or not higher.write)

    def _alone(self, shared: SharedObject, offset: int, other: LatestAccess, access: LatestAccess) -> None:
        """A read that only time keeps apart from a write: a 32-bit scalar by itself may be read in two halves."""
        words = _words(shared, offset)
        if words == 1 or shared.rank >= _RANK["unmasked-long"]:
            return
        shared.rank = _RANK["unmasked-long"]
        said = self._sentence(shared, "unmasked-long", False, other.thread, access.thread, other, words=words)
        self._report(shared, "unmasked-long", said, access, other.statement)

    def _check_continued(self, shared: SharedObject, lower: LatestAccess, higher: LatestAccess) -> bool:
        """Whether `main` sets a count or index that a routine changes and depends on together with other objects."""
        what = higher.thread.what
        if not lower.write or lower.thread is not self._threads.main or not isinstance(what, Routine):
            return False
        _, function = self._locator.function(lower.statement)
        path = shared.object.declaration.path
        return (what.name, function) in self._continued.get(path, ()) and not self._kept_off(
            self._conditions.stepping(what.name, path)
        )

    def _early(self, shared: SharedObject, offset: int, lower: LatestAccess, higher: LatestAccess) -> str:
        """The flag that `main` has handed over too early, if it uses several words after that; else an empty text."""
        what = higher.thread.what
        if lower.thread is self._threads.main and isinstance(what, Routine):
            for one in self._handed.get(shared.object.declaration.path, ()):
                if one.routine == what.name:
                    words = self._late.setdefault(one, set())
                    words.add((shared.object, offset))
                    if len(words) > 1:
                        return one.flag
        return ""

    def _joint(self, shared: SharedObject, offset: int) -> None:
        """A run of a routine writes a word.  All words of one object that a run writes belong together."""
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
                return  # a ring buffer: its indices tell which part of it is complete
            run, words = shared.run
            if run != threads.runs:
                shared.run = threads.runs, {offset}
                return
            words.add(offset)
            if len(words) > 1:
                shared.joint |= words

    @staticmethod
    def _several(shared: SharedObject, offset: int) -> bool:
        """Whether several threads use, and some write, another scalar of the same structure too."""
        if not shared.record or not (shared.hands_over or shared.per_element):
            return False
        stride = shared.per_element or shared.object.words
        first = offset // stride * stride
        cells = (cell for at, cell in shared.cells.items() if first <= at < first + stride and at != offset)
        return any(cell.owner is None and cell.writers for cell in cells)

    def _sentence(
        self, shared: SharedObject, rule: str, lost: bool, low: Thread, high: Thread, access: LatestAccess | None,
        does: str = "writes", *, words: int = 2,
    ) -> str:  # fmt: skip
        """The message of a finding; `does`: what the other thread does.  If `access` is None, `low` only reads.

        `words` is the size of the scalar, where that matters.
        """
        if access is None:
            access = LatestAccess(low, False, low.protection, 0, 0, 0)
        verb = "writes" if access.write else "reads"
        other = high if access.thread is low else low
        nothing = "the interrupt is not masked" if self._threads.routines else "they share no gate"
        said = f"{shared.object.declaration.path}: {access.thread} {verb} what {other} {does}, and {nothing}: "
        if lost:
            return said + f"a write of {high} between a read and a write of {low} is lost"
        if rule == "race":
            return said + f"{high} can interrupt {low} between related parts"
        if access.write and rule != "unmasked-long":
            return said + "the last write wins"
        if words > 2:
            return said + f"no instruction moves its {16 * words} bits at once"
        if rule in ("race-long", "unmasked-long"):
            return said + "it is atomic only while the compiler moves its 32 bits with one instruction"
        return said + "each access is atomic, but a second read may give another value"

    def _report(self, shared: SharedObject, rule: str, message: str, other: LatestAccess, at: StatementNumber) -> None:
        """Report at the statement `at`, or at the running one if `at` is 0."""
        obj = shared.object
        declaration, details = str(obj.declaration), (self._access_text(other),)
        place = self._locator.place(at) if at else None
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

    def _again(self, shared: SharedObject, *accesses: LatestAccess) -> None:
        """The same race of an object has occurred again: count it, and keep the place if it is new."""
        for rule, finding in shared.findings.items():
            if _RANK.get(rule) == shared.rank:
                self._findings.count(finding)
                for access in accesses:
                    told = self._access_text(access, timed=False)
                    if len(finding.details) < _DETAILS and not any(
                        detail.startswith(told) for detail in finding.details
                    ):
                        finding.details += (told,)

    def _access_text(self, access: LatestAccess, *, timed: bool = True) -> str:
        verb = "writes" if access.write else "reads"
        gates = access.protection.gates
        under = " under " + ", ".join(sorted(map(self._names.of, gates))) if gates else ""
        at = f", at {us(access.time):.3f} us" if timed else ""
        return f"{access.thread} {verb} it{under} in {self._locator.text(access.statement)}{at}"

    # Gates

    def _wrong_gate(self, shared: SharedObject, other: LatestAccess, access: LatestAccess) -> None:
        """Two threads use an object under different gates, which do not exclude each other."""
        one, another = (", ".join(sorted(map(self._names.of, each.protection.gates))) for each in (other, access))
        how = f"under {one} by {other.thread} and under {another} by {access.thread}"
        self._add_detail(shared, how, self._access_text(other), access.statement)

    def _gates(self, shared: SharedObject, gates: frozenset[Gate], thread: Thread, statement: StatementNumber) -> None:
        """Report an object that most functions use under one gate, and one function under another gate."""
        use = (statement, thread, gates)
        if not gates or not statement or use in shared.known:
            return
        shared.known.add(use)
        shared.users.add(thread)
        function = self._locator.function(statement)
        if all(function in shared.under.get(gate, ()) for gate in gates):
            return
        for gate in gates:
            shared.under.setdefault(gate, {})[function] = statement
        if len(shared.under) < 2 or len(shared.users) < 2 or not shared.written:
            return
        usual = max(shared.under, key=lambda gate: len(shared.under[gate]))
        functions = shared.under[usual]
        if len(functions) < 2:
            return
        for gate, users in shared.under.items():
            for user, where in users.items():
                if user not in functions and len(users) < len(functions):
                    most, one = self._names.of(usual), self._names.of(gate)
                    how = f"under {most} by {len(functions)} functions, but under {one} by {user[1]}"
                    first = self._locator.text(next(iter(functions.values())))
                    self._add_detail(shared, how, f"under {most} in {first}", where)

    def _add_detail(self, shared: SharedObject, how: str, detail: str, statement: StatementNumber) -> None:
        known = shared.findings.get("wrong-gate")
        if known is not None:
            self._findings.count(known)
            return
        obj = shared.object
        message = f"{obj.declaration.path} is used {how}: neither gate keeps the other's users off"
        place = self._locator.place(statement)
        if place is not None:
            finding = self._findings.report_at(
                place, "wrong-gate", message, object=obj.declaration.path, declaration=str(obj.declaration),
                details=(detail,), how="dynamic",
            )  # fmt: skip
            if finding is not None:
                shared.findings["wrong-gate"] = finding
