"""Compares what names say about a routine's period with the period that a run shows.

`CONTROL_S 0.01` says that a control runs each 10 ms.  Where an interrupt routine always divides by it, or multiplies
with it, the routine has to run so often.  A difference by a power of ten is told: the timer or the name changed, and
the other one did not.

A constant that is handed to a function from which alone the function computes the period of a CPU timer
(`startTimer(1, SAMPLE_HZ)`) says how often that timer underflows.  A slower timer is told: a program can divide a
faster one.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from math import isclose, log10
from typing import Final

from emulator.c28x.declarations import lines_with_comments
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Break,
    Call,
    Const,
    Continue,
    Declare,
    Expr,
    Function,
    If,
    LeaveSwitch,
    Load,
    LValue,
    Return,
    Stmt,
    Variable,
    Where,
)  # fmt: skip
from emulator.c28x.tree_queries import assigned, bare, parts, roots, statements, variables
from emulator.clock import SYSCLK_HZ
from hil.board import Board
from hil.drivers.units import UnitMismatch

#: A period is known after so many intervals, none of which differs from their mean by more than this part of it.
_ENOUGH: Final = 20
_STEADY: Final = 0.5
#: A power of ten is exact up to this: dividers round.
_EXACT: Final = 0.02
#: The words of a name one of which says whose period it is, its last ones with the unit in seconds (Hz: 0).
PERIOD_WORDS: Final = frozenset({
    "CONTROL", "CONTROLLER", "CTRL", "LOOP", "SAMPLE", "SAMPLING", "TICK", "DT", "TS", "ISR", "PID",
    "ABTAST", "ABTASTUNG", "REGEL", "REGELUNG", "REGLER", "TAKT", "MUESTREO", "MUESTRA", "LAZO",
})  # fmt: skip
_UNITS: Final = {"S": 1.0, "SEC": 1.0, "MS": 1e-3, "US": 1e-6, "HZ": 0.0, "KHZ": 0.0}
#: Words of names that are other times.
_OTHERS: Final = frozenset({"TAU", "FILTER", "DELAY", "TIMEOUT", "RAMP", "MAX", "MIN", "LIMIT", "RISE", "PER", "WAIT"})
_DEFINITION: Final = re.compile(r"^\s*#\s*define\s+(\w+)\s+\(*\s*[\d.]")


class RoutinePeriods:
    """Measures how often the interrupt routines of a board run."""

    def __init__(self, board: Board) -> None:
        self._clock = board.clock
        #: Routine -> first and last time, number of runs, shortest and longest interval.
        self._seen: dict[str, tuple[int, int, int, int, int]] = {}
        board.vectors.began.connect(self._begins)

    def _begins(self, number: int, name: str) -> None:
        now = self._clock.now
        if name not in self._seen:
            self._seen[name] = now, now, 1, 1 << 62, 0
            return
        first, last, times, shortest, longest = self._seen[name]
        self._seen[name] = first, now, times + 1, min(shortest, now - last), max(longest, now - last)

    def periods(self) -> dict[str, float]:
        """Routine -> its period in seconds, if it is steady."""
        found = {}
        for name, (first, last, times, shortest, longest) in self._seen.items():
            mean = (last - first) / max(1, times - 1)
            if times > _ENOUGH and shortest > mean * (1 - _STEADY) and longest < mean * (1 + _STEADY):
                found[name] = mean / SYSCLK_HZ
        return found


def wrong_periods(modules: Iterable[Module], periods: dict[str, float]) -> Iterator[UnitMismatch]:
    """The uses of constants that are named after a period, in routines that run with another one."""
    functions = [function for module in modules for function in module.functions]
    by_path = {function.path: function for function in functions}
    for routine in functions:
        if routine.name not in periods or sum(f.name == routine.name for f in functions) > 1:
            continue
        # What another routine or main calls too runs with another period as well.
        others = [f.path for f in functions if f is not routine and (f.interrupt or f.name in (*periods, "main"))]
        elsewhere = _reached(by_path, others)
        for function, s in _always(routine, by_path, set()):
            if function.path not in elsewhere:
                yield from _told(function, s, routine, periods[routine.name])


def wrong_timers(modules: Iterable[Module], board: Board) -> Iterator[UnitMismatch]:
    """The calls that hand on a constant's period, for CPU timers that are slower at the end of a run."""
    functions = [function for module in modules for function in module.functions]
    for n, timer in enumerate(board.timers):
        set_by, cycles = timer.period_by, timer.period_cycles
        path = board.findings.path(set_by.at, set_by.calls) if set_by is not None and cycles else ()
        of: frozenset[Variable] | None = None
        inner = ""
        for place in path:
            found = _handed_on(functions, place, inner, of)
            if found is None:
                break
            s, f, arguments = found
            for constant in arguments:
                name, seconds = _stated(constant)
                if name and seconds and cycles / SYSCLK_HZ > seconds * (1 + _EXACT):
                    message = (
                        f"{name} is {seconds:g} s by its name, and CPU timer {n}, whose period is computed from it, "
                        f"underflows every {cycles / SYSCLK_HZ:.4g} s"
                    )  # fmt: skip
                    yield UnitMismatch(_place(f, s), message, name, "period-by-name")
            of = frozenset(_given_by(f, arguments))
            inner = place.function
            if not of:
                break


def _handed_on(
    functions: list[Function], place: Place, inner: str, of: frozenset[Variable] | None
) -> tuple[Stmt, Function, list[Expr]] | None:  # fmt: skip
    """The statement at a place, its function, and what the period depends on there.

    `inner` is the function that it calls, and `of` its parameters that decide on the period; None: it sets the period
    itself.  Returns None if this is not known.
    """
    for f in functions:
        if f.name != place.function or f.where.file != place.file:
            continue
        for s in statements(f.body):
            calls = [p for root in roots(s) for p in parts(root) if isinstance(p, Call)]
            if of is None:
                if isinstance(s, Assign) and _is_at(place, s.where):
                    return s, f, [bare(s.value)]
                for call in calls:  # of a function of ours, which has no place of its own
                    ours = not call.function.body or call.function.where.file.startswith("<")
                    if ours and (_is_at(place, call.where) or _is_at(place, s.where)):
                        given = map(bare, call.arguments)
                        return s, f, [value for value in given if not isinstance(value, AddressOf)]
                continue
            for call in calls:
                if call.function.name == inner and (_is_at(place, call.where) or _is_at(place, s.where)):
                    both = zip(call.function.parameters, call.arguments, strict=False)
                    return s, f, [bare(argument) for parameter, argument in both if parameter in of]
    return None


def _is_at(place: Place, where: Where) -> bool:
    return (place.line, place.column) == (where.line, where.column)


def _given_by(f: Function, values: list[Expr]) -> set[Variable]:
    """The one parameter of a function on which values depend, and nothing else that changes; empty: there is none."""
    stores = [(v, s) for s in statements(f.body) if (v := assigned(s)) is not None]
    seen: set[Variable] = set()
    waiting = list(values)
    while waiting:
        for variable in variables(parts(waiting.pop())):
            if variable in seen:
                continue
            seen.add(variable)
            if variable not in f.parameters:
                set_to = [s.value for v, s in stores if v is variable and isinstance(s, Assign | Declare)]
                if variable.kind != "local" or len(set_to) != 1 or not isinstance(set_to[0], Expr):
                    return set()
                waiting.append(set_to[0])
    given = seen.intersection(f.parameters)
    return given if len(given) == 1 and not any(v in given for v, _ in stores) else set()


def _place(function: Function, s: Stmt) -> Place:
    return Place(function.where.file, s.where.line, function.name, function.c_file, s.where.column)


def _told(function: Function, s: Stmt, routine: Function, period: float) -> Iterator[UnitMismatch]:
    for root in roots(s):
        for factor in _factors(root):
            name, seconds = _stated(factor)
            if not name or not seconds:
                continue
            power = round(log10(seconds / period))
            if power and isclose(seconds / period, 10.0**power, rel_tol=_EXACT):
                message = f"{name} is {seconds:g} s by its name, and {routine.name} runs every {period:.4g} s"
                yield UnitMismatch(_place(function, s), message, name, "period-by-name")


def _factors(e: object) -> Iterator[Expr]:
    """The named constants that an expression multiplies with, or divides by: macros, and `const` objects."""
    for p in parts(e):
        if isinstance(p, Const) and p.source is not None:
            yield from _factors(p.source)
        if isinstance(p, Binary) and p.op in ("*", "/"):
            for side in (p.left, p.right):
                factor = bare(side)
                if (isinstance(factor, Const) and factor.where.macro is not None) or isinstance(factor, Load):
                    yield factor


def _stated(e: Expr) -> tuple[str, float]:
    """The name of a constant, and the period in seconds that it states; 0: none."""
    name, value = _named(e)
    words = name.upper().split("_")
    if words[-1] not in _UNITS or not PERIOD_WORDS.intersection(words) or _OTHERS.intersection(words) or value <= 0:
        return "", 0.0
    size = _UNITS[words[-1]]
    return name, value * size if size else 1 / (value * (1e3 if words[-1] == "KHZ" else 1.0))


def _named(e: Expr) -> tuple[str, float]:
    """The name of a macro, or of a `const` object or a member of one, and its value; "": it is none."""
    match e:
        case Const() if e.where.macro is not None and _of_one_macro(e, e.where.macro):
            lines = lines_with_comments(e.where.macro.file)
            line = lines[e.where.macro.line - 1][0] if 0 < e.where.macro.line <= len(lines) else ""
            match = _DEFINITION.match(line)
            return (match[1], float(e.value)) if match is not None else ("", 0.0)
        case Load(lvalue=LValue(root=Variable(constant=True, initial=[*initial]), indices=[]) as lvalue):
            value = initial[lvalue.leaf] if lvalue.bits is None and lvalue.leaf < len(initial) else None
            if isinstance(value, Const):
                return lvalue.text.rpartition(".")[2], float(value.value)
    return "", 0.0


def _of_one_macro(e: Expr, macro: Where) -> bool:
    """Whether all of a constant comes from the definition at a place: `LOOP_HZ / 10` is another number."""
    for part in parts(e):
        if isinstance(part, Const):
            at = part.where.macro
            if at is None or (at.file, at.line) != (macro.file, macro.line):
                return False
            if part.source is not None and not _of_one_macro(part.source, macro):
                return False
    return True


def _always(function: Function, by_path: dict[str, Function], seen: set[str]) -> Iterator[tuple[Function, Stmt]]:
    """The statements that each run of a function executes, with those of the functions that it always calls."""
    if function.path in seen:
        return
    seen.add(function.path)
    for s in _straight(function.body):
        yield function, s
    for path in sorted(_always_called(function.body)):
        if path in by_path:
            yield from _always(by_path[path], by_path, seen)


def _straight(body: list[Stmt]) -> Iterator[Stmt]:
    """The statements of a body up to the first that may leave it, without those in inner blocks."""
    for s in body:
        yield s
        if any(isinstance(x, Return | Break | Continue | LeaveSwitch) for x in statements([s])):
            return


def _always_called(body: list[Stmt]) -> set[str]:
    found: set[str] = set()
    for s in _straight(body):
        if isinstance(s, If):
            found |= _always_called(s.then) & _always_called(s.otherwise)
        found |= {p.function.path for root in roots(s) for p in parts(root) if isinstance(p, Call)}
    return found


def _called(body: list[Stmt]) -> set[str]:
    return {p.function.path for s in statements(body) for root in roots(s) for p in parts(root) if isinstance(p, Call)}


def _reached(by_path: dict[str, Function], first: list[str]) -> set[str]:
    found: set[str] = set()
    waiting = list(first)
    while waiting:
        path = waiting.pop()
        if path not in found and path in by_path:
            found.add(path)
            waiting += _called(by_path[path].body)
    return found
