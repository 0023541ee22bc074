"""Static checks of objects that ought to remember what was before, or to count a time down: `never-updated`.

    static unsigned last = 1;
    ...
    if (now == 0 && last == 1) presses++;    /* and nowhere `last = now;` */

    if (message.number != expected) lost++;

The name says that the object remembers (`last`, `previous`, `expected`, in English, German and Spanish).  A last one
may also be the end of a row (`if (channel == lastChannel)`): so the check is silent where the object `last` is compared
with something that the program counts up by one.  It is silent about objects that do not begin with 0, 1 or -1, and
about what is expected but is no number of a row (`expectedVersion`).

The check needs a whole program.  A `volatile` object may be set by a debugger.  A local by itself that is compared with
a constant is a `constant-condition`.

    if (blocked) { mode = REST; rest = REST_PERIODS; }
    ...
    if (rest == 0) mode = MOVE;              /* and nowhere `rest--;` */

The name of the object, or of the macro, says that this is a time.  The check is silent where anything but 0 tests reads
the object, or where a statement sets it to 0: then it is a flag, or a limit.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from emulator.c28x.ctypes import FloatType, IntType
from emulator.c28x.passes.begun_again import is_latched
from emulator.c28x.passes.declared import name_at, words_of
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of, start_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Binary,
    Compare,
    Const,
    Declaration,
    Declare,
    Evaluate,
    Expr,
    For,
    Function,
    If,
    Load,
    Logic,
    LValue,
    Not,
    Return,
    Stmt,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    added,
    addressed,
    assigned,
    bare,
    own_nodes,
    parts,
    source_text,
    statements,
    within,
    without_end,
)

#: Words of names that remember, and those that may also be the end of a row.
_BEFORE: Final = frozenset((
    "prev", "previous", "previously", "old", "vorherig", "vorherige", "vorherigen", "vorige", "voriger", "voriges",
    "anterior", "previo", "previa", "viejo", "vieja", "since", "seit", "desde",
))  # fmt: skip
_LAST: Final = frozenset(("last", "letzte", "letzter", "letztes", "letzten", "ultimo", "ultima"))
#: What is expected next, and the words that may stand with it: an expected version or identifier is a constant.
_EXPECTED: Final = frozenset(("expected", "erwartet", "erwartete", "erwarteter", "esperado", "esperada"))
_NUMBER: Final = frozenset((
    "number", "num", "nr", "no", "seq", "sequence", "next", "count", "index", "frame", "msg", "message", "packet",
    "numero", "nummer", "folge", "secuencia", "siguiente", "mensaje",
))  # fmt: skip
#: What a memory begins with.
_STARTS: Final = frozenset((0, 1, -1, 0xFFFF))
#: Words of times, and of what is left of one, in names of objects: in English, German and Spanish.
_TIMES: Final = frozenset((
    "ticks", "periods", "cycles", "samples", "ms", "millis", "seconds", "time", "timer", "count", "counter",
    "countdown", "delay", "hold", "holdoff", "pause", "rest", "wait", "timeout", "left", "remaining", "remain",
    "cooldown", "dwell", "zeit", "restzeit", "takte", "perioden", "zyklen", "zaehler", "warten", "wartezeit",
    "verzoegerung", "sperre", "sperrzeit", "nachlauf", "tiempo", "ciclos", "periodos", "muestras", "cuenta", "contador",
    "espera", "pausa", "retardo", "restante", "restantes", "segundos",
))  # fmt: skip
#: Words of macros that can be nothing but times.
_DURATIONS: Final = frozenset((
    "ticks", "periods", "cycles", "ms", "millis", "seconds", "time", "delay", "duration", "zeit", "takte", "perioden",
    "zyklen", "dauer", "tiempo", "ciclos", "periodos", "segundos", "retardo", "duracion",
))  # fmt: skip
#: Words of numbers that stand for something, and that may rightly stay.
_CODES: Final = frozenset((
    "mode", "state", "status", "phase", "step", "flag", "code", "error", "err", "fault", "cause", "reason", "alarm",
    "id", "level", "kind", "type", "trip", "mask", "event", "fail", "failure", "result", "choice", "select", "modus",
    "zustand", "fehler", "stufe", "grund", "modo", "estado", "fallo", "causa", "nivel", "paso", "codigo",
))  # fmt: skip


def check_never_updated(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the comparisons with objects that ought to remember, and that nothing sets."""
    owners = {function: report for module, report in reports.items() for function in module.functions}
    if not any(function.name == "main" and function.body for function in owners):
        return
    written: set[Declaration] = set()
    counted: set[Declaration] = set()
    begins: dict[Declaration, int] = {}
    for function in owners:
        for s in statements(function.body):
            v = assigned(s)
            if isinstance(s, Declare) and (start := constant_of(s.value)) is not None:
                begins[s.variable.declaration] = start
            elif v is not None:
                written.add(v.declaration)
                if (by := added(s)) is not None and constant_of(by) == 1:
                    counted.add(v.declaration)
            if isinstance(s, For):
                written.add(s.counter.declaration)
                counted.add(s.counter.declaration)
        written |= {v.declaration for v in addressed(within(function.body))}
        counted |= set(_wrapped(function))
    for function, report in owners.items():
        told: set[Declaration] = set()
        for s in _repeated(function):
            for v, other in _compared(s):
                name = v.declaration
                start = start_of(v) if v.kind == "global" else begins.get(name)
                if start is None or name in written or name in told or not _remembers(v, start, other, counted):
                    continue
                told.add(name)
                message = f"no statement sets {name.name}: each time it is what it was at the start"
                report.report(function, s.where, "never-updated", message, object=name.path, declaration=name)


def _wrapped(function: Function) -> Iterator[Declaration]:
    """The objects that become the next number of a row: `n = (n + 1) % 8`."""
    for s in statements(function.body):
        v = assigned(s)
        if v is not None and isinstance(s, Assign):
            for p in parts(s.value):
                if isinstance(p, Binary) and p.op == "+" and constant_of(p.right) == 1 and _value_of(p.left) is v:
                    yield v.declaration


def _repeated(function: Function) -> Iterator[Stmt]:
    """The statements that run again: all of a function, but of `main` and of tasks those of the endless loop."""
    loops = [s for s in function.body if isinstance(s, While) and without_end(s)]
    yield from statements([x for loop in loops for x in loop.body] if loops else function.body)


def _compared(s: Stmt) -> Iterator[tuple[Variable, Expr | None]]:
    """The objects that a statement compares or subtracts, each with the other side; None: it is a test by itself."""
    roots: list[Expr] = [s.test] if isinstance(s, If | While) else []
    value = s.value if isinstance(s, Assign | Declare | Return | Evaluate) else None
    roots += [value] if isinstance(value, Expr) else []
    for root in roots:
        for p in parts(root):
            match p:
                case Compare(op="==" | "!=", left=left, right=right) | Binary(op="-" | "^", left=left, right=right):
                    for one, other in ((left, right), (right, left)):
                        if (v := _value_of(one)) is not None and not isinstance(bare(other), Const):
                            yield v, other
                case Logic(operands=operands):
                    for one in operands:
                        if (v := _truth_of(one)) is not None and v.kind == "global":
                            yield v, None


def _truth_of(e: Expr) -> Variable | None:
    """The object whose truth a test asks for, or that it compares with a constant."""
    match bare(e):
        case Not(operand=operand):
            return _truth_of(operand)
        case Compare(op="==" | "!=", left=left, right=right) if constant_of(right) is not None:
            return _value_of(left)
    return _value_of(e)


def _value_of(e: Expr) -> Variable | None:
    """The object of which an expression is just the value."""
    match bare(e):
        case Load(lvalue=LValue(root=Variable(ctype=IntType() | FloatType()) as v, indices=[], bits=None)):
            return v
    return None


def _remembers(v: Variable, start: int, other: Expr | None, counted: set[Declaration]) -> bool:
    """Whether an object that nothing sets ought to remember, by its name, its start and what it is compared with."""
    words = set(words_of(v.declaration.name))
    if v.kind not in ("global", "local") or v.constant or v.volatile or v.address is not None or v.escapes:
        return False
    if start not in _STARTS:
        return False
    if words & _BEFORE or (words & _EXPECTED and words <= _EXPECTED | _NUMBER):
        return True
    if not words & _LAST:
        return False
    named = {p.root.declaration for p in parts(other) if isinstance(p, LValue) and isinstance(p.root, Variable)}
    return not named & counted


# Times that nothing counts down


def check_never_counted(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the tests whether a time is over, of whole programs that begin the time and never count it."""
    owners = {function: report for module, report in reports.items() for function in module.functions}
    if not any(function.name == "main" and function.body for function in owners):
        return
    again = {id(s) for function in owners for s in _repeated(function)}
    begun: dict[Declaration, list[Const]] = {}
    others: set[Declaration] = set()
    for function in owners:
        loops = any(isinstance(s, While) and without_end(s) for s in function.body)
        for s in statements(function.body):
            v = assigned(s)
            if v is None:
                continue
            number = bare(s.value) if isinstance(s, Assign | Declare) and isinstance(s.value, Expr) else None
            if isinstance(s, Declare):
                # A local is what it was in the turn before only if the loop is within its function.
                fine = loops and id(s) not in again and constant_of(s.value) == 0
            else:
                fine = isinstance(number, Const) and isinstance(number.value, int) and number.value > 1
                # What each call does at once may only set the program up.
                fine = fine and id(s) in again and not any(s is first for first in function.body)
            if not fine:
                others.add(v.declaration)
            elif isinstance(s, Assign) and isinstance(number, Const):
                begun.setdefault(v.declaration, []).append(number)
        others |= {v.declaration for v in addressed(within(function.body))}
    times = {name for name, numbers in begun.items() if name not in others and _is_time(name, numbers)}
    tests: dict[Declaration, list[tuple[Function, Stmt, Expr]]] = {}
    for function in owners if times else ():
        for s in statements(function.body):
            asked = [(v, e) for root in own_nodes(s) if isinstance(root, Expr) for v, e in _zero_tests(root, s)]
            for v, e in asked:
                tests.setdefault(v.declaration, []).append((function, s, e))
            read = [p.lvalue.root for p in own_nodes(s) if isinstance(p, Load) and isinstance(p.lvalue.root, Variable)]
            for v in read:
                if read.count(v) != sum(other is v for other, _ in asked) or not _may_count(v):
                    times.discard(v.declaration)
    for name in times & tests.keys():
        function, s, test = tests[name][0]
        begin = begun[name][0]
        value = name_at(begin.where) or str(begin.value)
        text = source_text(test)
        message = f"nothing counts {name.name} down: once it is {value}, {text} has the same result for good"
        owners[function].report(function, s.where, "never-updated", message, object=name.path, declaration=name)


def _may_count(v: Variable) -> bool:
    """Whether only statements can change an object that begins with 0."""
    if v.kind == "global" and (start_of(v) != 0 or is_latched(v)):
        return False
    return v.kind in ("global", "local") and isinstance(v.ctype, IntType) and not (
        v.constant or v.volatile or v.escapes or v.address is not None
    )  # fmt: skip


def _is_time(name: Declaration, numbers: list[Const]) -> bool:
    """Whether the names of an object and of the macros that it gets say that it is a time."""
    words = set(words_of(name.name))
    macros = set()
    for number in numbers:
        macro = name_at(number.where)
        if macro and number.where.macro is None:
            return False  # one of an enumeration
        macros |= set(words_of(macro))
    if _CODES & (words | macros):
        return False
    return bool(words & _TIMES or macros & _DURATIONS)


def _zero_tests(e: Expr, s: Stmt) -> Iterator[tuple[Variable, Expr]]:
    """The object of which an expression asks whether it is 0, once for each such test in a statement."""
    match e:
        case Compare(op="==" | "!=" | ">" | "<=", left=left, right=right) if constant_of(right) == 0:
            if not name_at(bare(right).where) and (v := _value_of(left)) is not None:
                yield v, e
        case Not(operand=operand) if (v := _value_of(operand)) is not None:
            yield v, e
        case Logic(operands=operands):
            for one in operands:
                if (v := _value_of(one)) is not None:
                    yield v, one
    if isinstance(s, If | While) and e is s.test and (v := _value_of(e)) is not None:
        yield v, e
