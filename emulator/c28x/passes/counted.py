"""Counting loops: bounds of the locals that step in them, and the values of their counters after the loops.

Only plain locals, and loops from one constant to another.  Pass `values` checks conditions with these bounds.
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
    Jump,
    Load,
    LValue,
    Not,
    Stmt,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import assigned, assigned_variables, bare, blocks, statements


def known_locals(function: Function, *, counted: bool) -> dict[Variable, tuple[int, int]]:
    """Bounds of locals that are only set to constants, and only stepped in one direction, if at all.

    `counted`: the numbers of turns of loops are used as well.
    """
    steps = LoopSteps(function).steps if counted else {}
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
                up = _is_increment(s)
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


class LoopSteps:
    """How far steps in loops move the locals of a function.

    A step in loops counts once for each turn of these loops, outwards to the loop before which the local is set to a
    constant.  If one of these loops has no known number of turns, nothing is known of the local.
    """

    def __init__(self, function: Function) -> None:
        self._unknown: set[Variable] = set()
        self._single: dict[Variable, int] = {}
        self._loops: dict[Variable, int] = {}
        self._block(function.body, [])
        #: Local -> the sum of all its steps.
        self.steps = {
            variable: self._single.get(variable, 0) + self._loops.get(variable, 0)
            for variable in {*self._single, *self._loops} - self._unknown
        }

    def _block(self, body: list[Stmt], around: list[tuple[int | None, frozenset[Variable]]]) -> None:
        """`around`: for each enclosing loop, from the outermost, its number of turns and the locals set before it."""
        begun: frozenset[Variable] = frozenset()
        for s in body:
            match s:
                case Declare(variable=variable, value=Const()) | Assign(
                    target=LValue(root=Variable() as variable, indices=[]), value=Const()
                ):
                    begun |= {variable}
                case Assign(target=LValue(root=Variable() as variable), value=value) if _is_increment(s) is not None:
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
        """Count a step of a local within loops."""
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
    """Identity of each statement -> the counters of the loops around it."""
    found: dict[int, frozenset[Variable]] = {}
    for s in body:
        if around:
            found[id(s)] = around
        for inner in blocks(s):
            found |= turning(inner, around | {s.counter} if isinstance(s, For) else around)
    return found


def turns(start: int, stop: int, step: int) -> int:
    """The number of turns of a loop that counts from `start` up, or down, to `stop`."""
    return len(range(start, stop, step))


def _assigns(body: list[Stmt], variable: Variable) -> bool:
    return any(assigned(s) is variable for s in statements(body))


def _is_increment(s: Stmt) -> bool | None:
    """True if a statement adds a positive constant to a local, False if it subtracts one; None: neither."""
    match s:
        case Assign(target=LValue(root=Variable() as root), value=value):
            match bare(value):
                case Binary(op="+" | "-" as op, left=left, right=Const(value=int(by))) if by > 0:
                    match bare(left):
                        case Load(lvalue=LValue(root=stepped)) if stepped is root:
                            return op == "+"
    return None


class CounterEndValues:
    """The values of loop counters after their loops, until a statement changes them."""

    def __init__(self, body: list[Stmt]) -> None:
        #: Identity of a statement behind such a loop -> the counters, with their values there.
        self.behind: dict[int, dict[Variable, int]] = {}
        #: Identity of an `if` that compares a counter with 0 after a loop that has counted past 0 -> the counter.
        self.too_late: dict[int, Variable] = {}
        self._block(body, {})

    def _block(self, body: list[Stmt], known: dict[Variable, int]) -> None:
        previous: Stmt | None = None
        for s in body:
            changed = assigned_variables([s])
            kept = {v: end for v, end in known.items() if v not in changed}
            # The test of a loop sees the changes of its turns; the test of an `if` does not see those of its branches.
            self.behind[id(s)] = kept if isinstance(s, For | While) else known
            for inner in blocks(s):
                self._block(inner, kept)
            known = kept | _end_of(s)
            counter = _counts_past(previous) if previous is not None else None
            if counter is not None and isinstance(s, If) and _against_zero(s.test, counter):
                self.too_late[id(s)] = counter
            previous = s


def _end_of(s: Stmt) -> dict[Variable, int]:
    """The value of the counter after a loop that nothing leaves early; empty if it is not known."""
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
    """The local that `while (n-- > 0)`, or `while (n--)`, counts: it has passed 0 when the test ends the loop.

    In the tree, the body begins with the step of the test.  Nothing else changes the local.
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
    """Whether a condition tests whether a local is 0, or whether it is not."""
    match bare(e):
        case Not(operand=operand):
            return _against_zero(operand, counter)
        case Compare(op="==" | "!=", left=left, right=Const(value=0)):
            return _against_zero(left, counter)
        case Load(lvalue=LValue(root=root, indices=[])):
            return root is counter
    return False


def _breaks(body: list[Stmt]) -> bool:
    """Whether the body of a loop contains a `break` of that loop; that of a switch is another node."""
    return any(
        isinstance(s, Break | Jump) or (not isinstance(s, For | While) and any(map(_breaks, blocks(s)))) for s in body
    )
