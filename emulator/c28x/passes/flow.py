"""Pass `flow`: what is certainly written at each point, and between which bounds each integer lies.

One walk forwards over a function.  It leaves on the nodes: `Expr.bounds`, `Binary.exact`, `LValue.unwritten`, and of a
`For` whether Python's own loop does the same (`plain`, `trips`) or which `test` stands at its head.

What is certainly written is a set of variables and of elements.  An element is known by its subscript as far as that is
made of constants and plain locals; a new value of such a local makes what was known by it meaningless.
"""

from __future__ import annotations

from typing import Any

from emulator.c28x.ctypes import INT, IntType, usual
from emulator.c28x.passes.intervals import bounds, combine
from emulator.c28x.tree import (
    Assign,
    Binary,
    Break,
    Compare,
    Const,
    Continue,
    Convert,
    CopyStruct,
    Declare,
    Expr,
    FallThrough,
    For,
    Function,
    If,
    Interval,
    LeaveSwitch,
    Load,
    LValue,
    RegisterAt,
    RegisterRef,
    Return,
    Stmt,
    Switch,
    Unary,
    Variable,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import (
    assigned_variables,
    children,
    observable,
    parts,
    polls,
    renewed,
    roots,
)  # fmt: skip

#: What is written on every way that arrives: variables, and elements as (variable, subscripts); None: no way arrives.
Written = frozenset[Any] | None

def meet(*states: Written) -> Written:
    """What is written on every way that arrives."""
    arriving = [s for s in states if s is not None]
    return frozenset.intersection(*arriving) if arriving else None


class Flow:
    """The walk over one function."""

    def __init__(self, function: Function) -> None:
        self.function = function
        self.written: Written = frozenset()
        #: The locals in the subscripts of what has been written.
        self.subscripts: set[Variable] = set()
        #: What is known of locals that count.
        self.ranges: dict[Variable, Interval] = {}
        #: For each loop or switch that can be left from within: what is written where it is left, and at `continue`.
        self.loops: list[tuple[list[Written], list[Written]]] = []
        self.switches: list[list[Written]] = []

    def run(self) -> None:
        """Walk the function; says on it whether its end is reached."""
        self.block(self.function.body)
        self.function.ends = self.written is not None

    # Statements

    def block(self, body: list[Stmt]) -> None:
        for s in body:
            self.statement(s)

    def statement(self, s: Stmt) -> None:
        match s:
            case If(test=test, then=then, otherwise=otherwise):
                self.expression(test)
                before = self.written
                after_then = self.branch(then, before)
                self.written = meet(after_then, self.branch(otherwise, before))
            case While():
                self.while_loop(s)
            case For():
                self.for_loop(s)
            case Switch():
                self.switch(s)
            case Declare(variable=variable, value=None):
                # A local of an inner block has no value at the beginning of each turn.
                if renewed(variable) and self.loops and self.written is not None:
                    self.written -= {variable}
            case _:
                for root in roots(s):
                    self.place(root) if isinstance(root, LValue) else self.anything(root)
                self.simple(s)

    def simple(self, s: Stmt) -> None:
        """What a statement without inner blocks makes known."""
        match s:
            case Assign(target=LValue() as target):
                self.stored(target)
            case Declare(variable=variable):
                self.write(variable)
            case CopyStruct(target=LValue(root=root)):
                # What was never written in the source is so in the target now.
                if self.written is not None:
                    self.written = frozenset(k for k in self.written if k is not root and _variable(k) is not root)
            case Return():
                self.written = None
            case Break():
                self.loops[-1][0].append(self.written)
                self.written = None
            case Continue():
                self.loops[-1][1].append(self.written)
                self.written = None
            case LeaveSwitch():
                self.switches[-1].append(self.written)
                self.written = None

    def branch(self, body: list[Stmt], before: Written) -> Written:
        self.written = before
        self.block(body)
        return self.written

    def switch(self, s: Switch) -> None:
        self.expression(s.subject)
        before = self.written
        ends: list[Written] = []
        self.switches.append(ends)
        falling: Written = None
        for _, body in s.cases:
            after = self.branch(body, meet(before, falling))
            falls = bool(body) and isinstance(body[-1], FallThrough)
            falling = after if falls else None
            if not falls:
                ends.append(after)
        ends.append(falling)
        if not any(values is None for values, _ in s.cases):
            ends.append(before)
        self.switches.pop()
        self.written = meet(*ends)

    def while_loop(self, s: While) -> None:
        self.forget_changed(s)
        entry = self.written
        if s.first or polls(s):
            self.expression(s.test)
        if polls(s):
            if isinstance(s.test, Const) and s.test.value != 0:
                self.written = None
            return
        endless = isinstance(s.test, Const) and s.test.value != 0
        self.loops.append(([], []))
        self.block(s.body)
        breaks, continues = self.loops.pop()
        if s.step:
            self.written = meet(self.written, *continues)
            self.block(s.step)
        if not s.first:
            self.written = entry = meet(self.written, *continues)
            self.expression(s.test)
        self.written = meet(*breaks) if endless else meet(entry, *breaks)

    def for_loop(self, s: For) -> None:
        root = s.variable.root
        assert isinstance(root, Variable)
        for e in (s.start, s.stop):
            self.expression(e)
        self.forget_changed(s)
        match s.start, s.stop:
            case Const(value=int(first)), Const(value=int(last)):
                s.trips = range(first, last, s.step)
        s.plain = self.runs_alone(s, root) and self.counts_plainly(s, root)
        start, stop = s.start.bounds, s.stop.bounds
        self.write(root)
        self.place(s.variable)
        s.variable.unwritten = False
        if s.plain:
            assert start is not None and stop is not None  # noqa: PT018
            if s.step > 0:
                self.ranges[root] = (start[0], max(start[0], stop[1] - 1))
            else:
                self.ranges[root] = (min(start[1], stop[0] + 1), start[1])
        else:
            assert isinstance(root.ctype, IntType)
            common = usual(root.ctype, s.stop.ctype)
            variable = Convert(common, Load(root.ctype, s.variable, where=s.where), where=s.where)
            op = "<" if s.step > 0 else ">"
            s.test = Compare(INT, op, variable, Convert(common, s.stop, where=s.stop.where), where=s.where)
            self.expression(s.test)
        entry = self.written
        self.loops.append(([], []))
        self.block(s.body)
        end = self.written
        s.turns = end is not None
        breaks, continues = self.loops.pop()
        if not s.plain:
            self.written = meet(entry, *breaks)
        else:
            del self.ranges[root]
            self.written = meet(end, *continues, *breaks) if s.trips else meet(entry, end, *breaks)
        self.write(root)

    def runs_alone(self, s: For, root: Variable) -> bool:
        """Whether nothing but the loop itself changes its variable, and nothing changes its bound."""
        changed = assigned_variables(s.body)
        used = [p.root for p in parts(s.stop) if isinstance(p, LValue) and isinstance(p.root, Variable)]
        return (
            not root.in_memory and root.kind != "global" and root not in changed and not observable(s.stop)
            and not any(v is root or v in changed or (v.in_memory and v.escapes) for v in used)
        )  # fmt: skip

    def counts_plainly(self, s: For, root: Variable) -> bool:
        """Whether no conversion of the test matters and the variable can hold the value behind the loop."""
        if not isinstance(s.stop.ctype, IntType) or not isinstance(root.ctype, IntType):
            return False
        common = usual(root.ctype, s.stop.ctype)
        assert isinstance(common, IntType)
        assert s.start.bounds is not None
        assert s.stop.bounds is not None
        (start_low, _), (stop_low, stop_high) = s.start.bounds, s.stop.bounds
        if min(start_low, stop_low) < common.low:
            return False
        if s.trips is not None:
            return not s.trips or root.ctype.low <= s.trips[-1] + s.step <= root.ctype.high
        return stop_high + s.step - 1 <= root.ctype.high if s.step > 0 else stop_low + s.step + 1 >= root.ctype.low

    def forget_changed(self, loop: While | For) -> None:
        """At a loop's head nothing is known of elements whose subscript its turns change, nor of what they change."""
        changed = assigned_variables(loop.body + (loop.step if isinstance(loop, While) else []))
        if self.written is not None:
            self.written = frozenset(k for k in self.written if not (isinstance(k, tuple) and changed & k[2]))
        self.ranges = {v: r for v, r in self.ranges.items() if v not in changed}

    # What is written

    def write(self, variable: Variable) -> None:
        """`variable` has a new value."""
        if self.written is not None and variable not in self.subscripts:
            self.written |= {variable}
        elif self.written is not None:
            kept = (k for k in self.written if not (isinstance(k, tuple) and variable in k[2]))
            self.written = frozenset((*kept, variable))

    def stored(self, target: LValue) -> None:
        """Something was assigned to `target`."""
        root = target.root
        if not isinstance(root, Variable) or self.written is None or target.bits is not None:
            return
        if not root.in_memory and root.kind != "global":
            self.write(root)
            return
        key = element(target)
        if key is not None and not root.escapes and root.kind != "global":
            # Through a pointer, or by another function, a never-written value may be copied in later.
            self.written |= {key}
            self.subscripts |= key[2]
        if not target.indices and root.kind != "global" and root.ctype.leaves == 1:
            self.write(root)

    def may_be_unwritten(self, place: LValue) -> bool:
        """Whether `place` may be read before anything was written to it."""
        root = place.root
        if not isinstance(root, Variable) or root.kind in ("parameter", "temporary"):
            return False
        in_memory = root.in_memory or root.kind == "global"
        if root.initialised and not (in_memory and root.escapes):
            return False
        if self.written is None or (root in self.written and not root.escapes):
            return False
        return (element(place) if in_memory else root) not in self.written

    # Expressions

    def anything(self, e: Any) -> None:
        """The expressions within an lvalue, a register or an expression."""
        match e:
            case Expr():
                self.expression(e)
            case LValue():
                self.place(e)
            case RegisterAt(block=block):
                self.expression(block)
            case RegisterRef():
                pass

    def place(self, place: LValue) -> None:
        """The way to an object."""
        for index in place.indices:
            self.expression(index.expr)
        if isinstance(place.root, Expr):
            self.expression(place.root)

    def expression(self, e: Expr) -> None:
        for inner in children(e):
            self.anything(inner)
        if isinstance(e, Load):
            e.lvalue.unwritten = self.may_be_unwritten(e.lvalue)
        if isinstance(e, Binary) and isinstance(e.ctype, IntType):
            e.exact = combine(e.op, bounds_of(e.left), bounds_of(e.right))
        if isinstance(e.ctype, IntType):
            e.bounds = bounds(e, self.ranges, bounds_of)


def bounds_of(e: Expr) -> Interval:
    """The bounds that the walk has found."""
    assert e.bounds is not None
    return e.bounds


def element(place: LValue) -> tuple[Variable, Any, frozenset[Variable]] | None:
    """What tells an element apart: its object, its subscripts as structure, the locals in them; None if it moves."""
    root = place.root
    if not isinstance(root, Variable):
        return None
    used: set[Variable] = set()
    steps = [(_structure(index.expr, used), index.leaves) for index in place.indices]
    if any(structure is None for structure, _ in steps):
        return None
    return (root, (place.leaf, tuple(steps)), frozenset(used))


def _structure(e: Expr, used: set[Variable]) -> Any:
    """A subscript as a value that is equal for equal subscripts; None if it is more than constants and plain locals."""
    match e:
        case Const(value=value):
            return value
        case Load(lvalue=LValue(root=Variable(in_memory=False) as root)) if root.kind != "global":
            used.add(root)
            return root
        case Convert(operand=operand):
            inner = _structure(operand, used)
            kept = operand.bounds is not None and e.bounds == operand.bounds
            return inner if inner is None or kept else (e.ctype, inner)
        case Binary(op=op, left=left, right=right):
            a, b = _structure(left, used), _structure(right, used)
            return None if a is None or b is None else (op, e.ctype, a, b)
        case Unary(op=op, operand=operand):
            inner = _structure(operand, used)
            return None if inner is None else (op, e.ctype, inner)
    return None


def _variable(key: Any) -> Variable | None:
    return key[0] if isinstance(key, tuple) else None
