"""Static check of buffers that `main` gives back to an interrupt routine before it has read them: `released-early`.

    Ready = 0;
    for (i = 0; i < length; i++)
        order[i] = Line[i];

The routine writes `Line` only while `Ready` is 0, or it begins anew where `Length` says.  If it comes after the first
statement, `main` reads what belongs to the next message.  The mirror is `published.py`: data before the word that
publishes it there, data before the word that releases it here.

The check speaks only if `main` has read that word before (so the buffer is full), and until it reads it again.

    if (Ready) { for (i = 0; i < 5; i++) order[i] = Line[i]; Ready = 0; }

Where nothing that `main` sets keeps the routine from writing `Line`, it must be read before the next message begins:
`read-in-time`, a note, for the sender may always wait so long.
"""

from __future__ import annotations

from collections.abc import Iterator

from emulator.c28x.passes.interrupted import (
    OnTheWay,
    Place,
    RoutineWrite,
    Sides,
    mentions,
    off_at,
    place_of,
    reads,
    scalar_of,
    switched,
    test_of,
    written,
)
from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.tree import Assign, Binary, Compare, Expr, Function, Load, Logic, LValue, Not, Stmt, While
from emulator.c28x.tree_queries import bare, blocks, leaves, own_nodes, source_text, statements, within

#: A word whose value gives a buffer to the routine -> the buffers, each with those values.
_Releases = dict[Place, dict[Place, set[int]]]


def check_released(sides: Sides) -> None:
    """Report the words by which `main` gives a buffer back before it reads the buffer."""
    releases = _releases(sides)
    for function, body in sides.bodies.items() if releases else ():
        before: list[Stmt] = []
        for s, following in _followed(body, []):
            word = written(s)
            value = constant_of(s.value) if isinstance(s, Assign) else None
            buffers = {b for b, values in releases[word].items() if value in values} if word in releases else set()
            if word is not None and buffers and _asked_before(sides, function, before, word, frozenset()):
                off = off_at(body, {id(s)}) or sides.mask_of_caller(function)
                later = _late_read(sides, following, word, buffers, off)
                if later is not None and isinstance(s, Assign) and isinstance(s.target, LValue):
                    _report(sides, function, s, s.target, later)
            before.append(s)


def check_read_in_time(sides: Sides) -> None:
    """Report the buffers that `main` reads when a word says that they are full, and that nothing keeps as they are."""
    told: set[Place] = set()
    tests = [test for body in sides.bodies.values() for s in statements(body) if (test := test_of(s)) is not None]
    for buffer, word, routine in _unguarded(sides):
        for function, body in sides.bodies.items() if any(mentions(test, word) for test in tests) else ():
            read = next((s for s in statements(body) if _name_read(s, {buffer})), None)
            masked = read is None or off_at(body, {id(read)}) or sides.mask_of_caller(function)
            if read is not None and not masked and buffer not in told:
                told.add(buffer)
                name = _name_read(read, {buffer})
                message = (
                    f"nothing keeps {routine.name} from writing the next message into {name}, which is read here: it "
                    "must be read before that begins"
                )
                sides.owners[function].report(function, read.where, "read-in-time", message, object=name)


def _unguarded(sides: Sides) -> Iterator[tuple[Place, Place, Function]]:
    """The buffers that a routine fills from an index of its own whatever `main` does; a word that it sets then."""
    known = {place_of(p) for body in sides.bodies.values() for p in within(body) if isinstance(p, LValue)}
    changed = {written(s) for body in sides.bodies.values() for s in statements(body)}
    for buffer, its in _buffers(sides).items():
        routine = next(r for r in sides.routines if its[0].function in r)
        set_to: dict[Place, list[int | None]] = {}
        for w in sides.routine_writes:
            if (word := written(w.statement)) is not None and w.function in routine:
                set_to.setdefault(word, []).append(constant_of(w.statement.value))
        targets = [(w, w.statement.target) for w in its]
        at = [sides.asked(w.function, i.expr) for w, t in targets if isinstance(t, LValue) for i in t.indices]
        asked = set[Place]().union(*at, *(sides.asked(w.function, c.test) for w in its for c in w.conditions))
        own = all(any(None in set_to.get(place, ()) for place in places) for places in at)
        if not own or len(at) != len(its) or asked & changed or known & set[Place]().union(*at):
            continue  # `main` keeps it off, or knows how far it is
        for word, values in set_to.items():
            given = {constant_of(s.value) for s in sides.main_writes.get(word, [])}
            if given and None not in given and None not in values and not given & set(values):
                yield buffer, word, routine[0]


def _buffers(sides: Sides) -> dict[Place, list[RoutineWrite]]:
    """The arrays of which the routines write elements."""
    writes: dict[Place, list[RoutineWrite]] = {}
    for w in sides.routine_writes:
        target = w.statement.target
        if isinstance(target, LValue) and target.indices and (buffer := place_of(target)) is not None:
            writes.setdefault(buffer, []).append(w)
    return writes


def _report(sides: Sides, function: Function, s: Assign, target: LValue, later: tuple[Stmt, str]) -> None:
    name, buffer = source_text(Load(target.ctype, target)), later[1]
    message = (
        f"{name} gives {buffer} back to an interrupt routine, and {buffer} is read after that (line {later[0].line}): "
        "what comes meanwhile is written over it"
    )
    sides.owners[function].report(function, s.where, "released-early", message, object=name)


def _releases(sides: Sides) -> _Releases:
    """The words that keep a routine from writing a buffer, or that say where in it the routine goes on."""
    writes = _buffers(sides)
    set_to: dict[Place, set[int | None]] = {}
    stepped: set[Place] = set()
    for w in sides.routine_writes:
        if (word := written(w.statement)) is not None:
            value = constant_of(w.statement.value)
            set_to.setdefault(word, set()).add(value)
            if isinstance(bare(w.statement.value), Binary):
                stepped.add(word)
    found: _Releases = {}
    for buffer, its in writes.items():
        guards = False
        for word, values in set_to.items():
            given = {constant_of(s.value) for s in sides.main_writes.get(word, [])}
            full = {v for v in values if v is not None}
            free = {
                v for v in given
                if v is not None and not any(_forbids(w, word, v) for w in its)
                and any(all(_forbids(w, word, f) for w in its) for f in full)
            }  # fmt: skip
            if free:
                found.setdefault(word, {})[buffer] = free
                guards = True
        for word in stepped if not guards else ():
            given = {constant_of(s.value) for s in sides.main_writes.get(word, [])}
            if given == {0} and all(_at(sides, w, word) for w in its) and not _kept_off(sides, its, word):
                found.setdefault(word, {})[buffer] = {0}
    return found


def _at(sides: Sides, w: RoutineWrite, word: Place) -> bool:
    """Whether a routine writes the element whose number a word is."""
    target = w.statement.target
    indices = target.indices if isinstance(target, LValue) else []
    return len(indices) == 1 and word in sides.asked(w.function, indices[0].expr)


def _kept_off(sides: Sides, its: list[RoutineWrite], word: Place) -> bool:
    """Whether `main` can keep a routine off a buffer by another word than its index."""
    asked = {place for w in its for c in w.conditions for place in sides.asked(w.function, c.test)}
    return any(place != word and place in sides.main_writes for place in asked)


def _forbids(w: RoutineWrite, word: Place, value: int) -> bool:
    """Whether a routine does not write while a word has a value, whatever other objects are."""
    return any(_reached(c, word, value) is False for c in w.conditions)


def _reached(condition: OnTheWay, word: Place, value: int) -> bool | None:
    """Whether a condition lets through while a word has a value; None: other objects decide, too."""
    result = _truth(condition.test, word, value)
    return None if result is None else result == condition.holds


def _truth(e: Expr, word: Place, value: int) -> bool | None:
    match bare(e):
        case Not(operand=operand):
            inner = _truth(operand, word, value)
            return None if inner is None else not inner
        case Compare(op="==" | "!=" as op, left=left, right=right):
            constant = constant_of(right)
            if scalar_of(left) == word and constant is not None:
                return (value == constant) == (op == "==")
        case Logic(op=op, operands=operands):
            results = [_truth(o, word, value) for o in operands]
            decides = op == "or"
            if decides in results:
                return decides
            return None if None in results else not decides
        case Load() as load if scalar_of(load) == word:
            return value != 0
    return None


def _followed(body: list[Stmt], after: list[Stmt]) -> Iterator[tuple[Stmt, list[Stmt]]]:
    """Every statement in the order of the text, with those that follow it in its block and in the blocks around."""
    for number, s in enumerate(body):
        following = body[number + 1 :]
        rest = following if leaves(body) else following + after
        yield s, rest
        for inner in blocks(s):
            yield from _followed(inner, [] if isinstance(s, While) else rest)


def _asked_before(
    sides: Sides, function: Function, before: list[Stmt], word: Place, seen: frozenset[str]
) -> bool:  # fmt: skip
    """Whether the text before a statement, or before the call of its function, reads a word."""
    if any(reads(s, word) for s in before):
        return True
    for caller, calling in sides.calls_of(function) if function.path not in seen else ():
        earlier: list[Stmt] = []
        for s in statements(sides.bodies[caller]):
            if id(s) in calling:
                break
            earlier.append(s)
        if _asked_before(sides, caller, earlier, word, seen | {function.path}):
            return True
    return False


def _late_read(
    sides: Sides, following: list[Stmt], word: Place, buffers: set[Place], off: bool
) -> tuple[Stmt, str] | None:
    """The first statement behind a release that reads a buffer that the routine may write, and the buffer's name."""
    for s in statements(following):
        inner = [t for f in sides.below(s) for t in statements(f.body)]
        if written(s) == word or reads(s, word) or any(written(t) == word or reads(t, word) for t in inner):
            return None
        for t in [s, *inner] if not off else ():
            if name := _name_read(t, buffers):
                return s, name
        off = switched(s, off)
    return None


def _name_read(s: Stmt, buffers: set[Place]) -> str:
    """The name of a buffer that a statement itself reads; empty: it reads none."""
    target = s.target if isinstance(s, Assign) else None
    for p in own_nodes(s):
        if isinstance(p, LValue) and p is not target and place_of(p) in buffers:
            return p.text.split("[")[0] or "the buffer"
    return ""
