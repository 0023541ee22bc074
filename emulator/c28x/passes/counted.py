"""Counting loops: bounds of the locals that are stepped in them, and the values of their counters after them.

Only plain locals, and loops from one constant to another one.  `values` holds conditions against it.
"""

from __future__ import annotations

from emulator.c28x.ctypes import IntType
from emulator.c28x.tree import (
    Assign,
    Binary,
    Break,
    Compare,
    Const,
    Declare,
    Expr,
    For,
    Function,
    If,
    Load,
    LValue,
    Not,
    Stmt,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import assigned, assigned_variables, bare, blocks, statements


def known_locals(function: Function, *, counted: bool) -> dict[Variable, tuple[int, int]]:
    """Bounds of locals that get nothing but constants and are stepped, if at all, in one direction.

    `counted`: how often loops turn bounds them, too.
    """
    steps = Counted(function).steps if counted else {}
    given: dict[Variable, list[int]] = {}
    ways: dict[Variable, set[bool]] = {}
    unknown: set[Variable] = set()
    for s in statements(function.body):
        match s:
            case Declare(variable=variable, value=Const(value=int(value))):
                given.setdefault(variable, []).append(value)
            case Declare(variable=variable, value=None):
                pass
            case Assign(target=LValue(root=Variable() as variable, indices=[]), value=Const(value=int(value))):
                given.setdefault(variable, []).append(value)
            case For(variable=LValue(root=Variable() as variable), start=Const(value=int(value)), step=step):
                given.setdefault(variable, []).append(value)
                ways.setdefault(variable, set()).add(step > 0)
            case _:
                written = assigned(s)
                up = _goes_up(s)
                if written is not None and up is not None:
                    ways.setdefault(written, set()).add(up)
                elif written is not None:
                    unknown.add(written)
    found: dict[Variable, tuple[int, int]] = {}
    for variable, values in given.items():
        stepped = ways.get(variable, set())
        plain = variable.kind == "local" and not variable.in_memory and not variable.volatile
        if not plain or variable in unknown or len(stepped) > 1 or not isinstance(variable.ctype, IntType):
            continue
        low, high = min(values), max(values)
        if stepped:
            most = steps.get(variable)
            if most is not None:
                low, high = (low - most, high) if False in stepped else (low, high + most)
            if most is None or low < variable.ctype.low or high > variable.ctype.high:
                if not variable.ctype.signed:  # it wraps
                    continue
                low = variable.ctype.low if False in stepped else min(values)
                high = variable.ctype.high if True in stepped else max(values)
        found[variable] = (low, high)
    return found


class Counted:
    """Bounds of a function's locals that begin at constants and are stepped in loops.

    A step within loops is taken as often as these turn, out to the statement that gives the local a constant before
    they begin.  A loop that is not known to count ends the look: then nothing is known.
    """

    def __init__(self, function: Function) -> None:
        self._unknown: set[Variable] = set()
        self._single: dict[Variable, int] = {}
        self._loops: dict[Variable, int] = {}
        self._block(function.body, [])
        #: By the local: how far all its steps together bring it away.
        self.steps = {
            variable: self._single.get(variable, 0) + self._loops.get(variable, 0)
            for variable in {*self._single, *self._loops} - self._unknown
        }

    def _block(self, body: list[Stmt], around: list[tuple[int | None, frozenset[Variable]]]) -> None:
        """`around`, the loops from the outermost one: how often each turns, the locals that are set before it."""
        begun: frozenset[Variable] = frozenset()
        for s in body:
            match s:
                case Declare(variable=variable, value=Const()) | Assign(
                    target=LValue(root=Variable() as variable, indices=[]), value=Const()
                ):
                    begun |= {variable}
                case Assign(target=LValue(root=Variable() as variable), value=value) if _goes_up(s) is not None:
                    step = bare(value)
                    assert isinstance(step, Binary)
                    assert isinstance(step.right, Const)
                    self._step(variable, int(step.right.value), around if variable not in begun else [])
                case For(start=Const(value=int(start)), stop=Const(value=int(stop)), step=step, body=inner):
                    times = turns(start, stop, step)
                    self._loops[s.counter] = max(self._loops.get(s.counter, 0), times * abs(step))
                    if _assigns(inner, s.counter):
                        self._unknown.add(s.counter)
                        self._block(inner, [*around, (None, begun)])
                    else:
                        self._block(inner, [*around, (times, begun)])
                case For(body=inner):
                    self._unknown.add(s.counter)
                    self._block(inner, [*around, (None, begun)])
                case While(body=inner, step=step):
                    self._block([*inner, *step], [*around, (None, begun)])
                case _:
                    for inner in blocks(s):
                        self._block(inner, [*around, (1, begun)])

    def _step(self, variable: Variable, by: int, around: list[tuple[int | None, frozenset[Variable]]]) -> None:
        """A step of a local within loops."""
        times = 1
        for often, begun in reversed(around):
            if often is None:
                self._unknown.add(variable)
                return
            times *= often
            if variable in begun:
                break
        self._single[variable] = self._single.get(variable, 0) + by * times


def turning(body: list[Stmt], around: frozenset[Variable]) -> dict[int, frozenset[Variable]]:
    """By the statement: the counters of the loops around it."""
    found: dict[int, frozenset[Variable]] = {}
    for s in body:
        if around:
            found[id(s)] = around
        for inner in blocks(s):
            found |= turning(inner, around | {s.counter} if isinstance(s, For) else around)
    return found


def turns(start: int, stop: int, step: int) -> int:
    """How often a loop turns that counts from `start` up to `stop`, or down to it."""
    return len(range(start, stop, step))


def _assigns(body: list[Stmt], variable: Variable) -> bool:
    return any(assigned(s) is variable for s in statements(body))


def _goes_up(s: Stmt) -> bool | None:
    """Whether a statement adds a positive constant to a local (False: takes one away); None: neither."""
    match s:
        case Assign(target=LValue(root=Variable() as root), value=value):
            match bare(value):
                case Binary(op="+" | "-" as op, left=left, right=Const(value=int(by))) if by > 0:
                    match bare(left):
                        case Load(lvalue=LValue(root=stepped)) if stepped is root:
                            return op == "+"
    return None


class Ends:
    """The values of loop counters after the end of their loops, until something changes them."""

    def __init__(self, body: list[Stmt]) -> None:
        #: By the statement behind such a loop: the counters, and what they are there.
        self.behind: dict[int, dict[Variable, int]] = {}
        #: By the statement: the counter that it holds against 0 where the test of the loop before has gone past 0.
        self.too_late: dict[int, Variable] = {}
        self._block(body, {})

    def _block(self, body: list[Stmt], known: dict[Variable, int]) -> None:
        previous: Stmt | None = None
        for s in body:
            changed = assigned_variables([s])
            kept = {v: end for v, end in known.items() if v not in changed}
            # The test of a loop sees what its turns have changed, that of a choice does not.
            self.behind[id(s)] = kept if isinstance(s, For | While) else known
            for inner in blocks(s):
                self._block(inner, kept)
            known = kept | _end_of(s)
            counter = _counts_past(previous) if previous is not None else None
            if counter is not None and isinstance(s, If) and _against_zero(s.test, counter):
                self.too_late[id(s)] = counter
            previous = s


def _end_of(s: Stmt) -> dict[Variable, int]:
    """What a loop that nothing leaves makes of its counter."""
    match s:
        case For(start=Const(value=int(start)), stop=Const(value=int(stop)), step=step, body=body):
            counter = s.counter
            if not counter.plain or _breaks(body) or _assigns(body, counter):
                return {}
            assert isinstance(counter.ctype, IntType)
            end = start + turns(start, stop, step) * step
            return {counter: end} if counter.ctype.low <= end <= counter.ctype.high else {}
    past = _counts_past(s)
    if past is not None and isinstance(s, While) and not _breaks(s.body[3:]):
        assert isinstance(past.ctype, IntType)
        return {past: past.ctype.wrap(-1)}
    return {}


def _counts_past(s: Stmt) -> Variable | None:
    """The local that `while (n-- > 0)`, or `while (n--)`, counts: it is below 0 when the test ends the loop.

    The step of the test is what the body begins with; nothing else changes the local.
    """
    match s:
        case While(
            test=Const(),
            step=[],
            body=[
                Declare(variable=before, value=Load(lvalue=LValue(root=Variable(kind="local", plain=True) as counter))),
                Assign(target=LValue(root=stepped), value=Binary(op="-", right=Const(value=1))),
                If(test=Not(operand=test), then=[Break()], otherwise=[]),
                *rest,
            ],
        ) if stepped is counter and not _assigns(rest, counter):
            match bare(test):
                case Compare(op=">" | "!=", left=left, right=Const(value=0)):
                    test = bare(left)
            match bare(test):
                case Load(lvalue=LValue(root=tested)) if tested is before:
                    return counter
    return None


def _against_zero(e: Expr, counter: Variable) -> bool:
    """Whether a condition is that a local is 0, or that it is not."""
    match bare(e):
        case Not(operand=operand):
            return _against_zero(operand, counter)
        case Compare(op="==" | "!=", left=left, right=Const(value=0)):
            return _against_zero(left, counter)
        case Load(lvalue=LValue(root=root, indices=[])):
            return root is counter
    return False


def _breaks(body: list[Stmt]) -> bool:
    """Whether a statement of a loop's body leaves that loop; a switch is left by another statement."""
    return any(
        isinstance(s, Break) or (not isinstance(s, For | While) and any(map(_breaks, blocks(s)))) for s in body
    )
