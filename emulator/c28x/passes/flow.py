"""Pass `flow`: which objects are certainly written at each point of a function, and which statements are reachable.

One forward walk carries a `FlowState` along every path.  It stores on the nodes: `LValue.unwritten`, `Stmt.reached`,
`For.turns`, `Function.ends`.  Pass `guards` makes the run-time checks from these.  `FlowReport` makes static findings:
locals read before they are written, missing returns, unreachable statements.

The written objects are a set of variables and elements.  An element is identified by its subscripts, if they consist of
constants and plain locals; a new value of such a local makes the element unknown.  Conditions on plain locals are
remembered: "if `found` is not zero, `place` has been written" survives where paths join, so that a flag that guards a
value is understood.  A loop whose condition first holds by constants runs at least once.

Objects that can hold few values (a register's bit) are followed too: behind `if (d == 0) ... else if (d == 1) ...`
without an `else` there is no path on which neither was true.  Objects in memory keep their values until a call of the
program, or a store that may reach them.

If a switch names every constant of an enumeration, the source intends no path past its cases, but the variable may hold
another value.  Such a path is *unexpected*: static findings ignore it, run-time checks do not.
"""

from __future__ import annotations

import operator
from collections.abc import Mapping, Set
from dataclasses import dataclass, field, replace
from typing import Any, Final, NamedTuple

from emulator.c28x.arithmetic import COMPARE, divide_int, modulo_int
from emulator.c28x.ctypes import VOID, FloatType, IntType, PointerType, StructType, usual
from emulator.c28x.passes.intervals import RING
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.tree import (
    Assign,
    Binary,
    Break,
    Call,
    CallPointer,
    Compare,
    Conditional,
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
    Jump,
    LeaveSwitch,
    Load,
    Logic,
    LValue,
    Not,
    RegisterLoad,
    Return,
    Stmt,
    Switch,
    Unary,
    Unwritten,
    Variable,
    Where,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import assigned_variables, bare, blocks, children, own_nodes, parts, roots, statements

#: After so many turns, the walk gives up what it knows at the head of a loop.
_TURNS: Final = 8
#: CHOICE: only the newest conditions are kept, so that a function with thousands of them is analysed quickly.
_CONDITIONS: Final = 100
#: CHOICE: objects with up to this many values are followed.
_VALUES: Final = 16


class Term(NamedTuple):
    """An expression of constants and plain locals: equal terms have equal values while these locals keep theirs."""

    shape: Any
    uses: frozenset[Variable]


class Element(NamedTuple):
    """A scalar of an object in memory: the object, the place of the scalar in it, the locals in its subscripts."""

    root: Variable
    place: Any
    uses: frozenset[Variable]


class Spot(NamedTuple):
    """A scalar in memory: the object or pointer that leads to it, its place from there, the locals in the pointer."""

    root: Any
    place: Any
    uses: frozenset[Variable]


class Condition(NamedTuple):
    """The condition that a term is not zero (`holds`), or that it is zero."""

    holds: bool
    term: Term


@dataclass(frozen=True)
class FlowState:
    """What is known at one point of the function."""

    #: The plain locals that are written on every expected path (`written`), and on some path (`touched`).
    written: frozenset[Variable] = frozenset()
    touched: frozenset[Variable] = frozenset()
    #: The objects in memory, and elements of them, that are written on every path.
    stored: frozenset[Variable | Element] = frozenset()
    #: The plain locals with a known constant value here.
    known: Mapping[Variable, int] = field(default_factory=dict)
    #: Condition -> the plain locals that are written if it holds; None: it cannot hold here.
    implied: Mapping[Condition, frozenset[Variable] | None] = field(default_factory=dict)
    #: The values that plain locals and scalars in memory can have here, where they are few; empty: no path leads here.
    values: Mapping[Variable | Spot, frozenset[int]] = field(default_factory=dict)
    #: The plain locals that may be unwritten on an unexpected path.
    doubtful: frozenset[Variable] = frozenset()
    #: Only unexpected paths lead here.
    unexpected: bool = False

    def if_holds(self, condition: Condition) -> frozenset[Variable] | None:
        """The plain locals that are written if `condition` holds; None: it cannot hold."""
        implied = self.implied.get(condition, frozenset())
        if implied is None:
            return None
        return implied | self.written if implied else self.written


#: A jump out of a loop: the label of the switch that it ends, and the state there.
JumpState = tuple[str, FlowState]
#: The states at the end of a turn, and at every break; None: no path arrives there.  The jumps out of the loop.
Turn = tuple[FlowState | None, list[FlowState | None], list[JumpState]]


class Flow:
    """The forward walk over one function."""

    def __init__(self, function: Function) -> None:
        self.function = function
        self.tracked = frozenset(v for v in function.locals if v.plain)
        #: For each enclosing loop: the states at its `break`s and at its `continue`s; for each switch, at its `break`s.
        self.loops: list[tuple[list[FlowState | None], list[FlowState | None]]] = []
        self.switches: list[list[FlowState | None]] = []
        #: For each enclosing loop the jumps out of it, for each switch with a label the states at its end; by label, ""
        #: for a loop.
        self.jumps: list[tuple[str, list[JumpState]]] = []
        #: Locals that every case of a switch without default writes -> the place of that switch.
        self.undefaulted: dict[Variable, Where] = {}
        #: Locals that every case of a complete switch without default writes -> the places of such switches; the places
        #: of complete switches whose every case leaves the function or the turn.
        self.completed: dict[Variable, frozenset[Where]] = {}
        self.left_by: frozenset[Where] = frozenset()
        #: The body of a loop is walked only to find the state at its head: nothing is stored on the nodes.
        self.quiet = False
        #: The results of such walks, by loop: otherwise nested loops would be walked again and again.
        self.walked: dict[int, list[tuple[FlowState, Turn]]] = {}

    def run(self) -> None:
        """Walk the function."""
        first = frozenset(v for v in self.function.parameters if v.plain)
        end = self.block(self.function.body, FlowState(first, first))
        self.function.ends = end is not None
        self.function.expected_end = end is not None and not end.unexpected
        if end is not None and end.unexpected:
            self.function.left_by = self.left_by

    # Statements

    def block(self, body: list[Stmt], state: FlowState | None) -> FlowState | None:
        for s in body:
            if not self.quiet:
                s.reached = state is not None and not state.unexpected
            if state is not None:
                state = self.statement(s, state)
        return state

    def statement(self, s: Stmt, state: FlowState) -> FlowState | None:
        if state.values and _may_store(s):
            state = replace(state, values={k: v for k, v in state.values.items() if isinstance(k, Variable)})
        match s:
            case If(test=test, then=then, otherwise=otherwise):
                self.read(test, state)
                passed = self.assumed(test, False, state)
                if not otherwise and not all(passed.values.values()):
                    passed = replace(passed, unexpected=True)
                return self.join(
                    self.block(then, self.assume(test, True, state)), self.block(otherwise, possible(passed))
                )
            case While():
                return self.while_loop(s, state)
            case For():
                return self.for_loop(s, state)
            case Switch():
                return self.switch(s, state)
        for root in roots(s):
            self.read(root, state)
        match s:
            case Assign(target=LValue() as target, value=value):
                return self.store(target, value, replace(state, values=after_store(target, value, state.values)))
            case Declare(variable=variable, value=None):
                # A local of an inner block has no value at the beginning of each turn.
                return self.begin(variable, state) if variable.nested and variable.plain else state
            case Declare(variable=variable, value=value):
                whole = isinstance(value, Expr) and isinstance(variable.ctype, StructType) and not variable.plain
                return copied(variable, state) if whole else self.write(variable, value, state)
            case CopyStruct(target=LValue(root=Variable() as root)):
                return copied(root, state)
            case Return():
                return None
            case Break():
                self.loops[-1][0].append(state)
                return None
            case Continue():
                self.loops[-1][1].append(state)
                return None
            case Jump(label=label):
                self.jump((label, state))
                return None
            case LeaveSwitch():
                self.switches[-1].append(state)
                return None
        return state

    def jump(self, taken: JumpState) -> None:
        """A jump goes to the end of its switch; or to the end of the loop around, which passes it on."""
        next(arrived for label, arrived in reversed(self.jumps) if label in ("", taken[0])).append(taken)

    def switch(self, s: Switch, state: FlowState) -> FlowState | None:
        self.read(s.subject, state)
        ends: list[FlowState | None] = []
        self.switches.append(ends)
        if s.label:
            self.jumps.append((s.label, []))
        falling: FlowState | None = None
        for _, body in s.cases:
            after = self.block(body, self.join(state, falling))
            falls = bool(body) and isinstance(body[-1], FallThrough)
            falling = after if falls else None
            if not falls:
                ends.append(after)
        ends.append(falling)
        self.switches.pop()
        if s.label:
            ends += [arrived for _, arrived in self.jumps.pop()[1]]
        if any(values is None for values, _ in s.cases):
            return self.join(*ends)
        everywhere = [end.written for end in ends if end is not None]
        common = frozenset.intersection(*everywhere) if everywhere else frozenset[Variable]()
        if s.complete:
            if not everywhere:
                self.left_by |= {s.where}
            for variable in common - state.written:
                self.completed[variable] = self.completed.get(variable, frozenset()) | {s.where}
            return self.join(replace(state, unexpected=True), *ends)
        self.undefaulted |= dict.fromkeys(common - state.touched, s.where)
        return self.join(state, *ends)

    # Loops

    def while_loop(self, s: While, state: FlowState) -> FlowState | None:
        runs = s.first and evaluate(s.test, state.known)
        head = self.head(s, state, assigned_variables([s]))
        if s.first:
            self.read(s.test, head)
        end, breaks = self.last_turn(s, head)
        if isinstance(s.test, Const) and s.test.value != 0:
            return self.join(*breaks)
        out = end if runs or not s.first else self.join(head, end)
        return self.join(None if out is None else self.assume(s.test, False, out), *breaks)

    def for_loop(self, s: For, state: FlowState) -> FlowState | None:
        root = s.counter
        self.read(s.start, state)
        self.read(s.stop, state)
        common = usual(root.ctype, s.stop.ctype)
        first, last = evaluate(s.start, state.known), evaluate(s.stop, state.known)
        runs = False
        if first is not None and last is not None and isinstance(common, IntType):
            runs = COMPARE["<" if s.step > 0 else ">"](common.wrap(first), common.wrap(last))
        state = self.write(root, None, state)
        head = self.head(s, state, assigned_variables([s]))
        self.read(s.variable, head)
        if s.test is not None:
            self.read(s.test, head)
        end, breaks = self.last_turn(s, head)
        return self.join(end if runs else self.join(head, end), *breaks)

    def last_turn(self, loop: While | For, head: FlowState) -> tuple[FlowState | None, list[FlowState | None]]:
        """One turn of a loop from the state that is valid in every turn; its jumps go on behind the loop."""
        end, breaks, jumps = self.turn(loop, head)
        for taken in jumps:
            self.jump(taken)
        return end, breaks

    def turn(self, loop: While | For, head: FlowState) -> Turn:
        """One turn of a loop, from its head to the next evaluation of its test; a quiet walk uses known results."""
        if not self.quiet:
            return self.walk(loop, head)
        known = self.walked.setdefault(id(loop), [])
        for before, outcome in known:
            if before == head:
                return outcome
        outcome = self.walk(loop, head)
        known.append((head, outcome))
        return outcome

    def walk(self, loop: While | For, head: FlowState) -> Turn:
        """Walk one turn of a loop."""
        self.loops.append(([], []))
        self.jumps.append(("", []))
        end = self.block(
            loop.body, self.assume(loop.test, True, head) if isinstance(loop, While) and loop.first else head
        )
        if isinstance(loop, For) and not self.quiet:
            loop.turns = end is not None
        breaks, continues = self.loops.pop()
        _, jumps = self.jumps.pop()
        end = self.join(end, *continues)
        if end is None:
            return None, breaks, jumps
        if isinstance(loop, For):
            return self.write(loop.counter, None, end), breaks, jumps
        end = self.block(loop.step, end)
        if end is not None and not loop.first:
            self.read(loop.test, end)
        return end, breaks, jumps

    def head(self, loop: While | For, state: FlowState, changed: Set[Variable]) -> FlowState:
        """The state at the head of a loop that is valid in every turn."""
        quiet, self.quiet = self.quiet, True
        head = replace(
            state, known={v: c for v, c in state.known.items() if v not in changed},
            values={k: v for k, v in state.values.items() if isinstance(k, Variable) and k not in changed},
        )  # fmt: skip
        for _ in range(_TURNS):
            end, _, _ = self.turn(loop, head)
            if end is not None and isinstance(loop, While) and not loop.first:
                end = self.assume(loop.test, True, end)
            following = self.join(head, end)
            assert following is not None
            following = replace(following, known=head.known, values=head.values, touched=state.touched)
            if following == head:
                break
            head = following
        else:
            head = self.forget(state, changed)
        self.quiet = quiet
        return head

    def forget(self, state: FlowState, changed: Set[Variable]) -> FlowState:
        """The state after a loop that may have changed the variables `changed`."""
        return replace(
            state,
            stored=frozenset(),
            known={v: c for v, c in state.known.items() if v not in changed},
            values={k: v for k, v in state.values.items() if isinstance(k, Variable) and k not in changed},
            implied={k: v for k, v in state.implied.items() if not changed & k.term.uses},
            doubtful=self.tracked - (state.written - state.doubtful),
        )

    # What is written

    def write(self, variable: Variable, value: Any, state: FlowState) -> FlowState:
        """The state after `variable` gets a new value."""
        if not variable.plain:
            return replace(state, stored=state.stored | {variable})
        known = {v: c for v, c in state.known.items() if v is not variable}
        implied = {k: v for k, v in state.implied.items() if variable not in k.term.uses}
        values = {k: v for k, v in state.values.items() if variable not in (k.uses if isinstance(k, Spot) else (k,))}
        if isinstance(value, Expr) and (few := few_values(value)):
            values[variable] = few
        own = Term(variable, frozenset({variable}))
        source = term(true_part(value)) if isinstance(value, Expr) else None
        for holds in (True, False):  # a copy implies what the original implies
            if source is not None and Condition(holds, source) in implied:
                implied[Condition(holds, own)] = implied[Condition(holds, source)]
        constant = evaluate(value, state.known)
        if constant is not None:
            known[variable] = constant
            implied[Condition(not constant, own)] = None
        return replace(
            state, written=state.written | {variable}, touched=state.touched | {variable},
            stored=frozenset(k for k in state.stored if not (isinstance(k, Element) and variable in k.uses)),
            known=known, implied=implied, values=values, doubtful=state.doubtful - {variable},
        )  # fmt: skip

    def begin(self, variable: Variable, state: FlowState) -> FlowState:
        """The state after `variable` is declared without a value."""
        state = self.write(variable, None, state)
        return replace(
            state, written=state.written - {variable}, touched=state.touched - {variable},
            implied={k: None if v is None else v - {variable} for k, v in state.implied.items()},
        )  # fmt: skip

    def store(self, target: LValue, value: Expr, state: FlowState) -> FlowState:
        """The state after an assignment to `target`."""
        root = target.root
        if not isinstance(root, Variable) or root.kind == "global" or target.bits is not None:
            return state
        if root.plain:
            return self.write(root, value, state)
        if isinstance(target.ctype, StructType):
            return copied(root, state)
        key = element(target)
        if key is not None and not root.escapes:
            # Not if a pointer or another function can reach it: they may copy a never-written value in later.
            state = replace(state, stored=state.stored | {key})
        return self.write(root, value, state) if not target.indices and root.ctype.leaves == 1 else state

    def unwritten(self, place: LValue, state: FlowState) -> Unwritten | None:
        """How `place` can be read before anything was written to it."""
        root = place.root
        if not isinstance(root, Variable):
            return None
        if root.kind in ("parameter", "temporary") and not isinstance(root.ctype, StructType) and not root.escapes:
            return None  # a value; a structure is a copy, whose source may never have been written
        if root.plain:
            expected = root not in state.written and not state.unexpected
            if root in state.written and root not in state.doubtful:
                return None
            root.unwritten = True
            complete = frozenset() if expected else self.completed.get(root, frozenset())
            return Unwritten(root not in state.touched, expected, self.undefaulted.get(root), complete)
        if root.kind == "global" and root.initialised and not root.escapes:
            return None
        written = (root in state.stored and not root.escapes) or element(place) in state.stored
        return None if written else Unwritten()

    # Expressions

    def read(self, e: Any, state: FlowState) -> None:
        """Store on every lvalue that is read whether it can be unwritten."""
        if self.quiet:
            return
        match e:
            case Logic(op=op, operands=operands):
                for operand in operands:
                    self.read(operand, state)
                    state = self.assume(operand, op == "and", state)
                return
            case Conditional(test=test, then=then, otherwise=otherwise):
                self.read(test, state)
                self.read(then, self.assume(test, True, state))
                self.read(otherwise, self.assume(test, False, state))
                return
            case Load(lvalue=lvalue):
                lvalue.unwritten = self.unwritten(lvalue, state)
        for inner in children(e):
            self.read(inner, state)

    def assume(self, test: Expr, holds: bool, state: FlowState) -> FlowState:
        """The state after `test` was true (or false).  A branch that cannot run may be there to be safe."""
        return possible(self.assumed(test, holds, state))

    def assumed(self, test: Expr, holds: bool, state: FlowState) -> FlowState:
        """The state after `test` was true (or false).  If that cannot be, an object has no value there."""
        test = true_part(test)
        if state.values:
            state = replace(state, values=compared(test, holds, state.values))
        match test:
            case Not(operand=operand):
                return self.assumed(operand, not holds, state)
            case Logic(op=op, operands=operands):
                if (op == "and") == holds:
                    for operand in operands:
                        state = self.assumed(operand, holds, state)
                return state
            case Compare(op="==" | "!=" as op, left=left, right=Const(value=value)):
                if value == 0:
                    return self.assumed(left, (op == "!=") == holds, state)
                if (op == "==") == holds:
                    state = self.assumed(left, True, state)
            case Compare(op=">", left=left, right=Const(value=value)) if holds and value >= 0:
                state = self.assumed(left, True, state)
        of = term(test)
        if of is None or not of.uses:
            return state
        implied = state.implied.get(Condition(holds, of), frozenset())
        if implied is None:  # no path leads here
            implied = self.tracked
        return replace(
            state, written=state.written | implied, touched=state.touched | implied,
            implied={**state.implied, Condition(not holds, of): None},
        )  # fmt: skip

    # Where paths join

    def join(self, *states: FlowState | None) -> FlowState | None:
        """The state where several paths join.  A path that is None does not arrive."""
        arriving = [s for s in states if s is not None]
        expected = [s for s in arriving if not s.unexpected] or arriving
        if not expected:
            return None
        result = expected[0]
        for other in expected[1:]:
            result = meet(result, other)
        if len(expected) == len(arriving):
            return result
        sure = frozenset.intersection(*(s.written - s.doubtful for s in arriving))
        return replace(
            result,
            stored=frozenset.intersection(*(s.stored for s in arriving)),
            known={v: c for v, c in result.known.items() if all(s.known.get(v) == c for s in arriving)},
            doubtful=result.doubtful | (self.tracked - sure),
        )


def meet(one: FlowState, other: FlowState) -> FlowState:
    """The state where two paths join."""
    written = one.written & other.written
    implied: dict[Condition, frozenset[Variable] | None] = {}
    for key in {**one.implied, **other.implied}:
        a, b = one.if_holds(key), other.if_holds(key)
        both = b if a is None else a if b is None else a & b
        if both is None or not both <= written:  # or it says nothing that is not known without it
            implied[key] = both
    for key in list(implied)[:-_CONDITIONS]:
        del implied[key]
    return FlowState(
        written, one.touched | other.touched, one.stored & other.stored,
        {v: c for v, c in one.known.items() if other.known.get(v) == c}, implied,
        {k: v | other.values[k] for k, v in one.values.items() if k in other.values},
        one.doubtful | other.doubtful, one.unexpected,
    )  # fmt: skip


def copied(root: Variable, state: FlowState) -> FlowState:
    """The state after a copy of a structure to `root`: never-written scalars of the source stay so in the target."""
    return replace(
        state,
        stored=frozenset(k for k in state.stored if k is not root and not (isinstance(k, Element) and k.root is root)),
    )


# Objects with few values


def few_values(value: Expr) -> frozenset[int]:
    """The values that an integer expression can have, if they are few and not negative; else empty."""
    inner = bare(value)
    if not isinstance(value.ctype, IntType) or value.bounds is None:
        return frozenset()
    low, high = value.bounds
    if isinstance(inner, RegisterLoad) and inner.register.field is not None:
        low, high = 0, (1 << inner.register.field.width) - 1
    return frozenset(range(low, high + 1)) if low >= 0 and high - low < _VALUES else frozenset()


def spot(place: LValue) -> Variable | Spot | None:
    """The identity of a scalar, or None: it is volatile, or it depends on more than plain locals."""
    root, steps = place.root, []
    if place.volatile or (isinstance(root, Variable) and root.volatile):
        return None
    for index in place.indices:
        if not isinstance(index.expr, Const):
            return None
        steps.append((index.expr.value, index.leaves))
    where = (place.leaf, tuple(steps), str(place.bits))
    if isinstance(root, Variable):
        return root if root.plain else Spot(root, where, frozenset())
    pointer = term(root)
    return None if pointer is None else Spot(pointer.shape, where, pointer.uses)


def after_store(
    target: LValue, value: Expr, values: Mapping[Variable | Spot, frozenset[int]]
) -> Mapping[Variable | Spot, frozenset[int]]:
    """The values after an assignment to `target`, if it is in memory."""
    if isinstance(target.root, Variable) and target.root.plain:
        return values
    stored = spot(target)
    kept = {k: v for k, v in values.items() if isinstance(k, Variable) or _beside(k, stored)}
    if stored is not None and (few := few_values(value)):
        kept[stored] = few
    return kept


def _beside(kept: Spot, stored: Variable | Spot | None) -> bool:
    """Whether a store does not reach a scalar: it is in another object, or at another place behind the same pointer.

    A pointer to a structure does not lead to an object that is a mere number (ISO C 6.5 p7).
    """
    if not isinstance(stored, Spot):
        return False
    if kept.root == stored.root:
        return bool(kept.place != stored.place)
    if not isinstance(kept.root, Variable) or not isinstance(stored.root, Variable):
        return False
    if not kept.uses and not stored.uses:
        return True
    pointer, named = (kept, stored) if kept.uses else (stored, kept)
    if named.uses or not isinstance(pointer.root.ctype, PointerType):
        return False
    return isinstance(pointer.root.ctype.target, StructType) and isinstance(named.root.ctype, IntType | FloatType)


def _may_store(s: Stmt) -> bool:
    """Whether a statement may store in any object of the program: it copies a structure, or calls a function."""
    return isinstance(s, CopyStruct) or any(
        isinstance(p, CallPointer) or (isinstance(p, Call) and not p.function.extern)
        for p in own_nodes(s)
    )


def compared(
    test: Expr, holds: bool, values: Mapping[Variable | Spot, frozenset[int]]
) -> Mapping[Variable | Spot, frozenset[int]]:
    """The values where a comparison of an object with a constant, or the object as a condition, is true (or false)."""
    match test:
        case Compare(op=op, left=left, right=Const(value=int(number))):
            subject = true_part(left)
        case _:
            op, subject, number = "!=", test, 0
    if not isinstance(subject, Load):
        return values
    key = spot(subject.lvalue)
    if key is None or key not in values:
        return values
    return {**values, key: frozenset(v for v in values[key] if COMPARE[op](v, number) == holds)}


def possible(state: FlowState) -> FlowState:
    """The state without what says that no path leads there."""
    if all(state.values.values()):
        return state
    return replace(state, values={k: v for k, v in state.values.items() if v})


# Expressions


def element(place: LValue) -> Element | None:
    """The identity of an element within its object; None if its subscripts are not terms."""
    terms = [term(index.expr) for index in place.indices]
    if not isinstance(place.root, Variable) or None in terms:
        return None
    steps = tuple((t.shape, index.leaves) for t, index in zip(terms, place.indices, strict=True) if t is not None)
    return Element(
        place.root, (place.leaf, steps), frozenset[Variable]().union(*(t.uses for t in terms if t is not None))
    )


def term(e: Expr) -> Term | None:
    """An expression as a `Term`; None if it contains more than constants and plain locals."""
    match e:
        case Const(value=value):
            return Term(value, frozenset())
        case Load(lvalue=LValue(root=Variable(plain=True) as root)):
            return Term(root, frozenset({root}))
        case Convert(operand=operand):
            inner = term(operand)
            if inner is None or (e.bounds is not None and e.bounds == operand.bounds):
                return inner
            return Term((e.ctype, inner.shape), inner.uses)
        case Unary(op=op, operand=operand):
            inner = term(operand)
            return None if inner is None else Term((op, e.ctype, inner.shape), inner.uses)
        case Binary(op=op, left=left, right=right) | Compare(op=op, left=left, right=right):
            a, b = term(left), term(right)
            return None if a is None or b is None else Term((op, e.ctype, a.shape, b.shape), a.uses | b.uses)
    return None


def true_part(e: Expr) -> Expr:
    """An expression without the conversions that give 0 only for 0."""
    while isinstance(e, Convert):
        match e.ctype, e.operand.ctype:
            case IntType(bits=bits), IntType(bits=before) if bits >= before or e.bounds == e.operand.bounds:
                e = e.operand
            case FloatType(), IntType():
                e = e.operand
            case _:
                break
    return e


def evaluate(e: Any, known: Mapping[Variable, int]) -> int | None:
    """The integer value of an expression, with the known values of locals; None if it is not known."""
    match e:
        case Const(value=int(value)):
            return value
        case Load(lvalue=LValue(root=Variable() as root)):
            return known.get(root)
        case Convert(ctype=IntType() as ctype, operand=Expr(ctype=IntType()) as operand):
            inner = evaluate(operand, known)
            return None if inner is None else ctype.wrap(inner)
        case Not(operand=operand):
            inner = evaluate(operand, known)
            return None if inner is None else int(not inner)
        case Logic(op=op, operands=operands):
            values = [evaluate(o, known) for o in operands]
            decided = [v for v in values if v is not None and bool(v) == (op == "or")]
            if decided:
                return int(op == "or")
            return None if None in values else int(op == "and")
        case Compare(op=op, left=left, right=right):
            a, b = evaluate(left, known), evaluate(right, known)
            return None if a is None or b is None else int(COMPARE[op](a, b))
        case Binary(ctype=IntType() as ctype, op=op, left=left, right=right) if op in RING or op in "/%":
            a, b = evaluate(left, known), evaluate(right, known)
            if a is None or b is None or (op in "/%" and b == 0):
                return None
            compute = {"+": operator.add, "-": operator.sub, "*": operator.mul, "/": divide_int, "%": modulo_int}
            return ctype.wrap(compute[op](a, b))
    return None


# Static findings


class FlowReport:
    """Makes static findings from the results of the walk over one function."""

    def __init__(self, function: Function, report: StaticReport) -> None:
        self.function = function
        self.to = report
        self.seen: set[Variable] = set()

    def run(self) -> None:
        """Report all of them."""
        f = self.function
        self.block(f.body)
        if f.expected_end and f.ctype.result != VOID and f.name != "main":
            returns = any(isinstance(s, Return) and s.value is not None for s in statements(f.body))
            how = "can come to its end without a return value" if returns else "never returns a value"
            message = f"{f.path} {how}: the caller gets what the register holds"
            place = max((s.where for s in statements(f.body)), key=lambda where: where.line, default=f.where)
            self.to.report(f, place, "missing-return", message)

    def block(self, body: list[Stmt]) -> None:
        told = False
        for s in body:
            if s.reached:
                self.statement(s)
            elif not told and not isinstance(s, Return | Break | Continue | LeaveSwitch | FallThrough | Declare):
                told = True
                self.unreachable(s.where, f"this statement of {self.function.path} can never run")

    def unreachable(self, where: Where, message: str) -> None:
        self.to.report(self.function, where, "unreachable", message)

    def statement(self, s: Stmt) -> None:
        # The assigned value is read before the subscripts of its target.
        for root in reversed(roots(s)) if isinstance(s, Assign | CopyStruct) else roots(s):
            for e in parts(root):
                if isinstance(e, Load) and isinstance(e.lvalue.root, Variable) and e.lvalue.unwritten is not None:
                    self.read(e.lvalue.root, e.lvalue.unwritten, e.lvalue.where if e.lvalue.where.line else s.where)
        if isinstance(s, Switch):
            self.switch(s)
        else:
            for inner in blocks(s):
                self.block(inner)

    def switch(self, s: Switch) -> None:
        labels: set[int] = set()
        for values, body in s.cases:
            where = body[0].where if body else s.where
            for value in values or []:
                if value in labels:
                    self.unreachable(where, f"case {value} is here a second time and is never taken")
                labels.add(value)
            self.block(body)

    def read(self, variable: Variable, how: Unwritten, where: Where) -> None:
        """Report a read before any write, once for each local."""
        if not how.expected or variable in self.seen:
            return
        self.seen.add(variable)
        declaration = variable.declaration
        path = declaration.path
        if how.switch is not None:
            message = f"without a default {path} has no value in any other case (it is read in line {where.line})"
            self.to.report(self.function, how.switch, "switch-no-default", message, declaration=declaration)
        message = f"{path} {'is' if how.surely else 'can be'} read here before anything was written to it"
        self.to.report(self.function, where, "maybe-uninitialised", message, declaration=declaration)
