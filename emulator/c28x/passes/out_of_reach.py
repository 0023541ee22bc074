"""Static check of tests that ask for more than a counter can reach: `constant-condition`.

    if (age < LIMIT) age++;             /* stays at LIMIT */
    if (age > LIMIT) stop();            /* never */

    missed = 0;                         /* in each call */
    if (missed < MAX) missed++;
    if (missed >= MAX) valid = 0;       /* never: it is 1 here */

All statements that change the counter are known: it is `static`, or the program has a `main`.  They set it to
constants or step it by constants, and one function alone steps it.  The bounds follow from the tests around the steps.
A counter that is only ever set to 0, and tested against a limit, is one that nobody counts.  Members of structures are
counters, too, if all accesses to them are known (`members.py`).

The check is silent about subscripts (a test against the end of an array may be a precaution), about tests that only set
the counter itself to a limit, about assertions, and where text that this build leaves out changes the counter.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Final, NamedTuple

from emulator.c28x.ctypes import IntType
from emulator.c28x.passes.begun_again import is_number, step_of
from emulator.c28x.passes.intervals import interval
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.passes.state_values import constant_of, start_of
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Break,
    Call,
    Compare,
    Conditional,
    Const,
    Convert,
    Declare,
    Evaluate,
    Expr,
    For,
    Function,
    FunctionRef,
    If,
    Index,
    Interval,
    Load,
    Logic,
    LValue,
    Not,
    Return,
    Stmt,
    Switch,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    OPPOSITE,
    TURNED,
    addressed,
    assigned,
    assigned_variables,
    bare,
    below,
    blocks,
    calls,
    leaves,
    parts,
    runs_function,
    source_text,
    statements,
    variables,
    within,
)

#: Limits that nobody is meant to reach, and values that stand for "none".
_NEVER: Final = frozenset((0x7F, 0xFF, 0x7FFF, 0xFFFF, 0x7FFFFFFF, 0xFFFFFFFF))
#: From this value on a limit is one: 0 and 1 switch something off, or are truth values.
_LEAST: Final = 2
#: How often the bounds are made narrower.
_ROUNDS: Final = 3
_FAILS: Final = OPPOSITE | {"==": "!=", "!=": "=="}
#: Functions that begin something once; the first state of a counter is no count that is begun again.
_BEGINS: Final = re.compile(r"init|setup|config|open|main", re.IGNORECASE)
_ASSERTS: Final = re.compile(r"assert|abort|panic|exit|unreachable|estop|impossible", re.IGNORECASE)
_COMMENTS: Final = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)

_State = dict[Variable, Interval]


class _Counter(NamedTuple):
    """What is known of one counter."""

    #: The function that steps it; None: nothing does.
    by: Function | None
    #: The bounds at any time, and those of the constants that other functions give it (None: they give none).
    always: Interval
    others: Interval | None
    #: Other functions may give it these at any time.
    anytime: bool = False


def check_out_of_reach(modules: Iterable[Module], reports: dict[Module, StaticReport]) -> None:
    """Report the tests of counters against values that they never have."""
    own = [module for module in modules if not module.brought]
    functions = [function for module in own for function in module.functions]
    counters = _counters(own, functions)
    for module in own:
        for function in module.functions:
            if variables(within(function.body)) & counters.keys():
                _CounterWalk(function, counters, reports[module]).run()


def _counters(modules: list[Module], functions: list[Function]) -> dict[Variable, _Counter]:
    """The counters all of whose changes are known."""
    whole = any(function.name == "main" and function.body for function in functions)
    indices: set[Variable] = set()
    taken: set[Variable] = set()
    writes: dict[Variable, list[tuple[Function, Stmt]]] = {}
    for function in functions:
        nodes = list(within(function.body))
        taken |= addressed(nodes)
        indices |= {v for p in nodes if isinstance(p, Index) for v in variables(parts(p))}
        for s in statements(function.body):
            if (v := assigned(s)) is not None and v.kind == "global":
                writes.setdefault(v, []).append((function, s))
    # What is entered by its address may be an interrupt routine too.
    entered = {p.function.path for f in functions for p in within(f.body) if isinstance(p, FunctionRef)}
    entered |= {f.path for f in functions if f.interrupt}
    own = {f.path: f for f in functions}
    apart = set(below(entered, own))
    again = {f for f in functions if f in below(f.calls, own)}
    found: dict[Variable, _Counter] = {}
    for module in modules:
        for v in module.variables:
            known = v.static or (whole and not v.volatile)
            plain = is_number(v) and not v.constants and not v.escapes and v.declaration.name not in module.placed
            of = writes.get(v, [])
            if not (known and plain and of) or v in taken or v in indices or _left_out(v, of, module):
                continue
            if all(isinstance(s, Assign) and constant_of(s.value) == 0 for _, s in of):
                if not v.volatile and start_of(v) == 0 and _begun(v, of, module):
                    found[v] = _Counter(None, (0, 0), None)
            elif not again & {function for function, _ in of} and (counter := _counter(v, of, apart)) is not None:
                found[v] = counter
    return found


def _begun(v: Variable, writes: list[tuple[Function, Stmt]], module: Module) -> bool:
    """Whether a count that is only set to 0 is begun again in a run, and the source says 0: no choice of a build."""
    lines = module.text.split("\n")
    zero = re.compile(rf"\b{re.escape(v.declaration.name)}\s*=[^;]*\b0[uUlL]*\b")
    literal = all(s.where.line <= len(lines) and zero.search(lines[s.where.line - 1]) for _, s in writes)
    return literal and any(not _BEGINS.search(function.name) for function, _ in writes)


def _counter(v: Variable, writes: list[tuple[Function, Stmt]], apart: set[Function]) -> _Counter | None:
    """What is known of a counter by all statements that change it; None: nothing.

    `apart`: the functions that may interrupt others.
    """
    assert isinstance(v.ctype, IntType)
    constants: list[tuple[Function, int]] = []
    stepping: dict[Function, bool] = {}
    for function, s in writes:
        for value in _chosen(s.value) if isinstance(s, Assign) else [None]:
            step = step_of(Assign(s.where, LValue(v.ctype, v), value), v) if value is not None else None
            if (constant := constant_of(value)) is not None:
                constants.append((function, constant))
            elif step is not None:
                stepping[function] = stepping.get(function, False) or step > 0
            else:
                return None
    if len(stepping) != 1 or not any(stepping.values()):
        return None
    (by,) = stepping
    others = [value for function, value in constants if function is not by]
    given = (min(others), max(others)) if others else None
    anytime = any(function in apart for function, _ in constants if function is not by)
    start = start_of(v)
    counter = _Counter(by, (v.ctype.low, v.ctype.high), given, anytime)
    for _ in range(_ROUNDS):
        walk = _CounterWalk(by, {v: counter}, None)
        walk.run()
        always = _join(_join(walk.given.get(v, (start, start)), (start, start)), given)
        counter = counter._replace(always=always)
    return counter


def _chosen(e: Expr) -> Iterator[Expr]:
    """The values of which an expression is one."""
    inner = bare(e)
    if isinstance(inner, Conditional):
        yield from _chosen(inner.then)
        yield from _chosen(inner.otherwise)
    else:
        yield inner


def _left_out(v: Variable, writes: list[tuple[Function, Stmt]], module: Module) -> bool:
    """Whether text of the file changes an object of this name in a line where no statement of this build does."""
    name = re.escape(v.declaration.name)
    change = re.compile(rf"(?:\+\+|--)\s*{name}\b|(?<![.>\w]){name}\s*(?:\+\+|--|(?:[-+*/%&|^]|<<|>>)?=(?!=))")
    lines = {s.where.line for _, s in writes} | {v.declaration.line}
    first, last = 0, 1 << 30
    if v.declaration.function:
        begins = sorted(f.where.line for f in module.functions)
        first = max((at for at in begins if at <= v.declaration.line), default=0)
        last = min((at for at in begins if at > v.declaration.line), default=last)
    text = _COMMENTS.sub(lambda found: "\n" * found[0].count("\n"), module.text)
    return any(
        first <= number < last and number not in lines and change.search(line)
        for number, line in enumerate(text.split("\n"), 1)
    )


class _CounterWalk:
    """One way through a function: the bounds of counters and plain locals at each statement."""

    def __init__(
        self, function: Function, counters: Mapping[Variable, _Counter], report: StaticReport | None
    ) -> None:  # fmt: skip
        """`report`: where to tell what is found; None: only the bounds are wanted."""
        self.function = function
        self.counters = counters
        self.report = report
        #: The counters that it steps: no other function can raise them meanwhile.
        self.own = {v: counter for v, counter in counters.items() if counter.by is function}
        #: The bounds of all that the function gives the counters.
        self.given: dict[Variable, Interval] = {}

    def run(self) -> None:
        """Walk through the function."""
        self._block(self.function.body, {v: counter.always for v, counter in self.counters.items()})

    def _block(self, body: list[Stmt], state: _State) -> _State | None:
        """The bounds behind some statements; None: their end is not reached."""
        now: _State | None = state
        for s in body:
            if now is None:
                return None  # what follows is unreachable, and is told as such
            now = self._statement(s, now)
        return now

    def _statement(self, s: Stmt, state: _State) -> _State | None:
        state = self._others(s, state)
        match s:
            case If(test=test, then=then, otherwise=otherwise):
                self._tests(s, test, state)
                a = self._block(then, self._where(test, state, holds=True))
                b = self._block(otherwise, self._where(test, state, holds=False))
                return _joined(a, b)
            case While(test=test, body=body, step=step, first=first):
                state = self._unknown(s, state)
                inside = self._where(test, state, holds=True) if first else state
                self._block(body, inside)
                self._block(step, state)
                ends = not any(isinstance(x, Break) for x in statements(body))
                return self._where(test, state, holds=False) if ends else state
            case For() | Switch():
                state = self._unknown(s, state)
                for inner in blocks(s):
                    self._block(inner, state)
                return state
            case Assign(target=LValue(root=Variable() as v, indices=[]), value=value):
                self._tests(s, value, state)
                return self._give(v, value, state)
            case Declare(variable=v, value=Expr() as value):
                self._tests(s, value, state)
                return self._give(v, value, state)
            case Return(value=value):
                if value is not None:
                    self._tests(s, value, state)
                return None
            case Assign(value=value):
                self._tests(s, value, state)
        return None if leaves([s]) else state

    def _give(self, v: Variable, value: Expr, state: _State) -> _State:
        """The bounds after an object got a value."""
        rest = {other: bounds for other, bounds in state.items() if other is not v}
        if not isinstance(v.ctype, IntType) or not isinstance(value.ctype, IntType):
            return rest
        if v in self.counters:
            bounds = self._value(value, state)
            self.given[v] = _join(bounds, self.given.get(v))
            return rest | {v: bounds if v in self.own else state[v]}
        return rest | {v: interval(value, state)} if v.plain and not v.volatile else rest

    def _value(self, e: Expr, state: _State) -> Interval:
        match e:
            case Conditional(test=test, then=then, otherwise=otherwise):
                a = self._value(then, self._where(test, state, holds=True))
                return _join(a, self._value(otherwise, self._where(test, state, holds=False)))
            case Convert(ctype=IntType() as ctype, operand=Conditional() as choice):
                low, high = self._value(choice, state)
                return (low, high) if ctype.low <= low and high <= ctype.high else (ctype.low, ctype.high)
        return interval(e, state)

    def _others(self, s: Stmt, state: _State) -> _State:
        """The bounds after other functions may have run in a statement, with its blocks, or before it."""
        return self._joined_with_others(state, runs=any(map(runs_function, statements([s]))))

    def _joined_with_others(self, state: _State, *, runs: bool) -> _State:
        more = {v: c.others for v, c in self.own.items() if c.others is not None and (runs or c.anytime)}
        return state | {v: _join(state[v], others) for v, others in more.items()}

    def _unknown(self, s: Stmt, state: _State) -> _State:
        """The bounds in and behind a statement that may repeat its blocks."""
        changed = assigned_variables([s])
        found = {v: bounds for v, bounds in state.items() if v not in changed}
        return found | {v: self.counters[v].always for v in changed if v in self.counters}

    def _where(self, test: Expr, state: _State, *, holds: bool) -> _State:
        """The bounds where a test holds, or where it does not."""
        match test:
            case Not(operand=operand):
                return self._where(operand, state, holds=not holds)
            case Logic(op=op, operands=operands) if (op == "and") == holds:
                for operand in operands:
                    state = self._where(operand, state, holds=holds)
                if calls(test):  # which may run behind a comparison
                    state = self._joined_with_others(state, runs=True)
            case Compare(op=op, left=left, right=right):
                for side, other, turned in ((left, right, op), (right, left, TURNED[op])):
                    v = _kept(side, state)
                    limits = interval(other, state) if isinstance(other.ctype, IntType) else None
                    if v is not None and limits is not None and self._bounded(v):
                        state = _limit(state, v, turned if holds else _FAILS[turned], limits)
            case _ if (v := _kept(test, state)) is not None and self._bounded(v):
                state = _limit(state, v, "!=" if holds else "==", (0, 0))
        return state

    def _bounded(self, v: Variable) -> bool:
        """Whether a test of an object says what it is afterwards."""
        return v in self.own or v not in self.counters

    # What is told

    def _tests(self, s: Stmt, test: Expr, state: _State) -> None:
        """Look at the comparisons of a test, or of a truth value that is given."""
        if self.report is None:
            return
        match bare(test):
            case Logic(op=op, operands=operands):
                for operand in operands:
                    self._tests(s, operand, state)
                    state = self._where(operand, state, holds=op == "and")
            case Compare(op=op, left=left, right=right) as compare:
                for side, other, turned in ((left, right, op), (right, left, TURNED[op])):
                    v = _kept(side, state)
                    limit = constant_of(other)
                    if v in self.counters and v is not None and limit is not None:
                        self._compare(s, compare, v, (turned, limit), state[v])

    def _compare(self, s: Stmt, compare: Compare, v: Variable, what: tuple[str, int], now: Interval) -> None:
        assert self.report is not None
        op, limit = what
        counter = self.counters[v]
        need = limit + (op in (">", "<="))
        never = op in (">", ">=") or (op == "==" and counter.by is not None)
        if not never and op not in ("<", "<="):
            return
        if need <= now[1] or need < _LEAST or need in _NEVER or limit in _NEVER:
            return
        if isinstance(s, If) and not _matters(s, compare, v, never=never):
            return
        name = v.declaration
        if counter.by is None:
            why = f"no statement counts {name.name}, it is always 0"
        elif need <= counter.always[1]:
            why = f"{name.name} is set anew before it in each pass, and is at most {now[1]} here"
        else:
            why = f"{name.name} is counted to {now[1]} at most"
        place = (self.function.where.file, s.where.line)
        found = (f for f in self.report.found if f.rule == "constant-condition")
        if any((f.place.file, f.place.line) == place for f in found):
            return  # another check says it
        message = f"{source_text(compare)} is always {str(not never).lower()}: {why}"
        self.report.report(
            self.function, s.where, "constant-condition", message, object=name.path, declaration=name
        )  # fmt: skip


def _matters(s: If, compare: Compare, v: Variable, *, never: bool) -> bool:
    """Whether what a test never lets happen is more than a precaution."""
    if not never:
        alone = bare(s.test) is compare
        return alone and bool(s.otherwise) and all(assigned(x) is not v for x in statements(s.then)) and (
            not _precaution(s.otherwise, v)
        )  # fmt: skip
    return not _precaution(s.then, v)


def _precaution(body: list[Stmt], v: Variable) -> bool:
    """Whether statements only set the counter itself, or are an assertion, or stop for a debugger."""
    return all(
        assigned(x) is v
        or (isinstance(x, Evaluate) and isinstance(x.value, Call) and _ASSERTS.search(x.value.function.name))
        or (isinstance(x, While) and isinstance(x.test, Const))
        for x in body
    )


def _kept(e: Expr, state: _State) -> Variable | None:
    """The object whose value an expression is, if no conversion changes it."""
    match bare(e):
        case Load(lvalue=LValue(root=Variable(ctype=IntType()) as v, indices=[], bits=None)) if v in state:
            return v if isinstance(e.ctype, IntType) and interval(e, state) == state[v] else None
    return None


def _limit(state: _State, v: Variable, op: str, limits: Interval) -> _State:
    """The bounds where an object compares so with a value; those before if no value does."""
    low, high = state[v]
    match op:
        case "<":
            high = min(high, limits[1] - 1)
        case "<=":
            high = min(high, limits[1])
        case ">":
            low = max(low, limits[0] + 1)
        case ">=":
            low = max(low, limits[0])
        case "==":
            low, high = max(low, limits[0]), min(high, limits[1])
        case "!=" if limits[0] == limits[1]:
            low, high = low + (low == limits[0]), high - (high == limits[0])
    return state | {v: (low, high)} if low <= high else state


def _join(a: Interval, b: Interval | None) -> Interval:
    return a if b is None else (min(a[0], b[0]), max(a[1], b[1]))


def _joined(a: _State | None, b: _State | None) -> _State | None:
    """The bounds where two ways meet."""
    if a is None or b is None:
        return b if a is None else a
    return {v: _join(a[v], b[v]) for v in a if v in b}
