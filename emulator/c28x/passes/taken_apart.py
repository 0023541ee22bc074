"""Static check of objects of an interrupt routine that belong together, and that are not used under one mask: `race`.

    way = travel;                       /* the routine does `travel += delta;` */
    travel = 0;

    DINT;
    n = count;                          /* the routine does `count++;` */
    EINT;
    count = 0;

    return seconds * 1000 + millis;     /* the routine does `if (++millis >= 1000) { millis = 0; seconds++; }` */

What the routine adds between the two statements is lost.  And if the routine carries from one object into the other
between the two reads, the sum is wrong by all of the carry.

The functions are those of the loop of `main`; of a driver, those that its application calls, but not those that set it
up.  A count that is taken without any mask is told only if a function masks other objects of the same routine: the
functions are called with the interrupts on, then.  Silent too if the routine adds only while something that the loop
sets lets it, if the function goes by what the routine has set (it may not come then), and about a pair that the
function compares: it may have read it again.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from emulator.c28x.passes.interrupted import OnTheWay, RoutineWrite, Sides, switched, test_of
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.tree import (
    Assign,
    Binary,
    Call,
    CallPointer,
    Compare,
    Declare,
    Evaluate,
    Expr,
    Function,
    If,
    Load,
    LValue,
    Stmt,
    Variable,
)
from emulator.c28x.tree_queries import all_blocks, bare, blocks, gives, leaves, own_nodes, parts, statements, within

#: An object at file scope and the offset of a scalar in it.  A `Place` does not tell structures of one type apart; a
#: count, or a pair, is of one object.
_Word = tuple[Variable, int]
#: Interrupts are on; it is not known whether they are.  Any other number is that of a section in which they are off.
_ON, _UNKNOWN = 0, -1


class _ReadAndClear(NamedTuple):
    """A count that statements read and clear, and the number of the section of each."""

    word: _Word
    read: Stmt
    clear: Assign
    sections: tuple[int, int]


class _Carry(NamedTuple):
    """A routine that carries from one word into another one."""

    high: _Word
    low: _Word
    routine: Function


def check_taken_apart(sides: Sides) -> None:
    """Report counts that are read and cleared, and pairs that are read, while the routine may come in between."""
    counted = _counted(sides)
    carries = list(_carries(sides))
    for function, body in sides.bodies.items() if counted or carries else ():
        if sides.mask_of_caller(function):
            continue
        sections = _Sections(sides)
        sections.number(body, _ON)
        for taken in _taken(body, sections.of):
            write = counted.get(taken.word)
            if write is not None and _comes_between(sides, function, taken, write):
                _report_taken(sides, function, taken, write.function)
        for carry, high, low in _combined(body, carries):
            of_high, of_low = sections.of.get(id(high), _UNKNOWN), sections.of.get(id(low), _UNKNOWN)
            apart = _UNKNOWN not in (of_high, of_low) and (of_high == _ON or of_high != of_low)
            if apart and not _in_step(sides, carry.routine, {carry.high, carry.low}):
                name, other = carry.high[0].declaration.name, carry.low[0].declaration.name
                message = (
                    f"{name} and {other} are read one by one, and the interrupt is not masked: "
                    f"{carry.routine.name} may carry from {other} into {name} in between"
                )
                at = high if of_high == _ON else low
                sides.owners[function].report(function, at.where, "race", message, object=name)


def _report_taken(sides: Sides, function: Function, taken: _ReadAndClear, routine: Function) -> None:
    name = taken.word[0].declaration.name
    read, clear = taken.sections
    at: Stmt = taken.read if read == _ON and clear != _ON else taken.clear
    message = (
        f"{name} is read in line {taken.read.line} and cleared in line {taken.clear.line}, and the interrupt is not "
        f"masked all the time: what {routine.name} adds in between is lost"
    )
    sides.owners[function].report(function, at.where, "race", message, object=name)


class _Sections:
    """The sections of a function in which interrupts are off."""

    def __init__(self, sides: Sides) -> None:
        self.sides = sides
        #: Identity of each statement -> the number of the section in which it is.
        self.of: dict[int, int] = {}
        self._last = _ON

    def number(self, body: list[Stmt], section: int) -> int:
        """Number the statements of a block; the section behind it."""
        for s in body:
            section = self._behind(s, section)
            self.of[id(s)] = section
            inner = blocks(s)
            ends = {end for block in inner for end in [self.number(block, section)] if not leaves(block)}
            if inner and (not isinstance(s, If) or not s.otherwise):
                ends.add(section)
            if ends:
                section = ends.pop() if len(ends) == 1 else _UNKNOWN
        return section

    def _behind(self, s: Stmt, section: int) -> int:
        """The section behind what a statement itself does."""
        if any(isinstance(p, CallPointer) for p in own_nodes(s)):
            return _UNKNOWN
        switching = [s]
        for path in {p.function.path for p in own_nodes(s) if isinstance(p, Call)} & self.sides.own.keys():
            inner = statements(self.sides.own[path].body)
            offs, ons = any(switched(each, False) for each in inner), any(not switched(each, True) for each in inner)
            if offs and ons:
                return _UNKNOWN if section != _ON else _ON
            switching += inner
        if any(not switched(each, True) for each in switching):
            return _ON
        if section in (_ON, _UNKNOWN) and any(switched(each, False) for each in switching):
            self._last += 1
            return self._last
        return section


def _word(lvalue: LValue) -> _Word | None:
    match lvalue:
        case LValue(root=Variable(kind="global") as root, indices=[], bits=None, words=words, ctype=ctype):
            return (root, words) if ctype.leaves == 1 else None
    return None


def _read(e: Expr) -> _Word | None:
    """The word of which an expression is just the value."""
    inner = bare(e)
    return _word(inner.lvalue) if isinstance(inner, Load) else None


def _step(function: Function, s: Stmt) -> _Word | None:
    """The word to which a statement adds something, or from which it takes it."""
    if not isinstance(s, Assign) or not isinstance(s.target, LValue) or (word := _word(s.target)) is None:
        return None
    value = bare(s.value)
    if isinstance(value, Load) and isinstance(copy := value.lvalue.root, Variable) and copy.kind != "global":
        given = [v for each in statements(function.body) if (g := gives(each)) and g[0].root is copy for v in [g[1]]]
        value = bare(given[0]) if len(given) == 1 else value
    if isinstance(value, Binary) and value.op in ("+", "-") and word in (_read(value.left), _read(value.right)):
        return word
    return None


def _counted(sides: Sides) -> dict[_Word, RoutineWrite]:
    """The words to which routines add, whatever the other side does."""
    steps = [(word, w) for w in sides.routine_writes if (word := _step(w.function, w.statement)) is not None]
    words = {word for word, _ in steps}
    found: dict[_Word, RoutineWrite] = {}
    for word, write in steps:
        decisive = [c for c in write.conditions if not _ends_count(c, words)]
        asked = {place for c in decisive for place in sides.asked(write.function, c.test)}
        if not asked & sides.main_writes.keys():
            found.setdefault(word, write)
    others = [w for w in sides.routine_writes if isinstance(w.statement.target, LValue)]
    return {
        word: write for word, write in found.items()
        if all((word, w) in steps for w in others if _word(w.statement.target) == word)  # type: ignore[arg-type]
    }  # fmt: skip


def _ends_count(condition: OnTheWay, words: set[_Word]) -> bool:
    """Whether a test only keeps a count from its limit."""
    match bare(condition.test):
        case Compare(op="<" | "<=" | "!=", left=left, right=right) if condition.holds:
            return _read(left) in words and constant_of(right) is not None
    return False


def _taken(body: list[Stmt], sections: dict[int, int]) -> Iterator[_ReadAndClear]:
    """The words that one statement reads and a later one of its block clears, with nothing but assignments between."""
    for block in all_blocks(body):
        read: dict[_Word, Stmt] = {}
        for s in block:
            if blocks(s) or not isinstance(s, Assign | Declare | Evaluate):
                read.clear()
                continue
            word = _word(s.target) if isinstance(s, Assign) and isinstance(s.target, LValue) else None
            if word is not None and word in read:
                assert isinstance(s, Assign)
                before = read.pop(word)
                numbers = sections.get(id(before), _UNKNOWN), sections.get(id(s), _UNKNOWN)
                if constant_of(s.value) == 0:
                    yield _ReadAndClear(word, before, s, numbers)
                continue
            if any(isinstance(p, CallPointer) or (isinstance(p, Call) and not _switches(s)) for p in own_nodes(s)):
                read.clear()
            read |= {w: s for p in own_nodes(s) if isinstance(p, Load) and (w := _word(p.lvalue)) is not None}


def _switches(s: Stmt) -> bool:
    """Whether a statement switches interrupts off or on."""
    return switched(s, False) or not switched(s, True)


def _comes_between(sides: Sides, function: Function, taken: _ReadAndClear, write: RoutineWrite) -> bool:
    """Whether the interrupts are on between the read and the clearing of a count, when the routine may come."""
    read, clear = taken.sections
    if _UNKNOWN in (read, clear) or (read == clear and read != _ON):
        return False
    if read != clear:
        return True
    its = _written_by(sides, write.function)
    return not _in_step(sides, write.function, {taken.word}) and any(
        _masks(sides, other, its) for other in sides.bodies if other is not function
    )


def _written_by(sides: Sides, function: Function) -> set[_Word]:
    """The words that the routine of a function writes."""
    routine = next(r for r in sides.routines if function in r)
    return {word for w in sides.routine_writes if w.function in routine and (word := _target(w.statement)) is not None}


def _in_step(sides: Sides, function: Function, words: set[_Word]) -> bool:
    """Whether the other side goes by other words of a routine: it may be done before the routine comes again."""
    telling = _written_by(sides, function) - words
    tests = (test for body in sides.bodies.values() for s in statements(body) if (test := test_of(s)) is not None)
    return any(isinstance(p, LValue) and _word(p) in telling for test in tests for p in parts(test))


def _target(s: Stmt) -> _Word | None:
    return _word(s.target) if isinstance(s, Assign) and isinstance(s.target, LValue) else None


def _masks(sides: Sides, function: Function, words: set[_Word]) -> bool:
    """Whether a function uses one of some words while it keeps interrupts off."""
    sections = _Sections(sides)
    sections.number(sides.bodies[function], _ON)
    masked = [s for s in statements(sides.bodies[function]) if sections.of.get(id(s), _UNKNOWN) > _ON]
    return any(isinstance(p, LValue) and _word(p) in words for s in masked for p in own_nodes(s))


def _carries(sides: Sides) -> Iterator[_Carry]:
    """The routines that count one word, and another one when the first one begins anew."""
    for routine in sides.routines:
        for function in routine:
            counted = {word for s in statements(function.body) if (word := _step(function, s)) is not None}
            for s in statements(function.body):
                if not isinstance(s, If):
                    continue
                match bare(s.test):
                    case Compare(op="==" | ">=" | ">", left=left, right=right):
                        limit = constant_of(right)
                    case _:
                        continue
                tested = _read(left) or _copied(function, left)
                if tested not in counted or tested is None:
                    continue
                anew = any(_target(each) == tested and isinstance(each, Assign) and constant_of(each.value) == 0
                           for each in s.then)  # fmt: skip
                for each in s.then if anew or limit == 0 else ():
                    high = _step(function, each)
                    if high is not None and high != tested:
                        yield _Carry(high, tested, routine[0])


def _copied(function: Function, e: Expr) -> _Word | None:
    """The word that gets the value of a local, as `++word` does."""
    match bare(e):
        case Load(lvalue=LValue(root=Variable() as copy)) if copy.kind != "global":
            for s in statements(function.body):
                if isinstance(s, Assign) and isinstance(value := bare(s.value), Load) and value.lvalue.root is copy:
                    return _target(s)
    return None


def _combined(body: list[Stmt], carries: list[_Carry]) -> Iterator[tuple[_Carry, Stmt, Stmt]]:
    """The sums of a pair: with the statements that read its words."""
    compared = {
        word for p in within(body) if isinstance(p, Compare)
        for q in parts(p) if isinstance(q, LValue) and (word := _word(q)) is not None
    }  # fmt: skip
    copies: dict[Variable, list[tuple[_Word | None, Stmt]]] = {}
    for s in statements(body):
        given = gives(s)
        if given is not None and isinstance(given[0].root, Variable) and given[0].root.kind != "global":
            copies.setdefault(given[0].root, []).append((_read(given[1]), s))
    told: set[int] = set()
    for s in statements(body):
        for sum_ in own_nodes(s):
            if not isinstance(sum_, Binary) or sum_.op not in ("+", "|"):
                continue
            for one, other in ((sum_.left, sum_.right), (sum_.right, sum_.left)):
                match bare(one):
                    case Binary(op="*" | "<<", left=left, right=right) if constant_of(right) is not None:
                        weighted = _source(left, s, copies)
                    case Binary(op="*", left=left, right=right) if constant_of(left) is not None:
                        weighted = _source(right, s, copies)
                    case _:
                        continue
                added = _source(other, s, copies)
                for carry in carries:
                    if (
                        weighted is not None and added is not None and (weighted[0], added[0]) == carry[:2]
                        and not compared & {carry.high, carry.low} and id(s) not in told
                    ):  # fmt: skip
                        told.add(id(s))
                        yield carry, weighted[1], added[1]


def _source(
    e: Expr, s: Stmt, copies: dict[Variable, list[tuple[_Word | None, Stmt]]]
) -> tuple[_Word, Stmt] | None:  # fmt: skip
    """The word that an expression reads, itself or through a local that is set once; the statement that reads it."""
    word = _read(e)
    if word is not None:
        return word, s
    match bare(e):
        case Load(lvalue=LValue(root=Variable() as copy, indices=[])) if len(given := copies.get(copy, [])) == 1:
            return (given[0][0], given[0][1]) if given[0][0] is not None else None
    return None
