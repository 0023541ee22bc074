"""Static check of definite assignment: locals read before they are written, missing returns, unreachable statements.

A walk over the tree carries what is written on every way that arrives.  Conditions are remembered as far as they are
made of locals: "if `found` is not zero, `place` has been written" survives joins, so that a flag that guards a value is
understood; and a loop whose condition holds at first by constants runs at least once.  Aggregates and locals whose
address is taken are left to the shadow memory at run time.
"""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass, field, replace
from typing import Final

from emulator.c28x.ctypes import VOID
from emulator.c28x.passes.facts import evaluate, fingerprint
from emulator.c28x.passes.report import StaticReport
from emulator.c28x.tree import (
    Assign,
    Break,
    Compare,
    Const,
    Continue,
    Convert,
    CopyStruct,
    Declare,
    Evaluate,
    Expr,
    FallThrough,
    For,
    Function,
    If,
    Index,
    LeaveSwitch,
    Load,
    Logic,
    LValue,
    Not,
    Return,
    Stmt,
    Switch,
    Variable,
    Where,
    While,
)  # fmt: skip
from emulator.c28x.tree_queries import assigned_variables, different, statements


@dataclass(frozen=True)
class State:
    """What is known at one point: written on every way, written on some way, constants, and what conditions imply.

    `implied[key]` are the variables that are written if the condition `key` holds; None means any (the condition does
    not hold on this way).  A key is "=" or "!" (the condition is false) and its text.
    """

    must: frozenset[Variable] = frozenset()
    may: frozenset[Variable] = frozenset()
    known: dict[Variable, int] = field(default_factory=dict)
    implied: dict[str, frozenset[Variable] | None] = field(default_factory=dict)


def join(*states: State | None) -> State | None:
    """What is known where several ways meet (None does not arrive)."""
    arriving = [s for s in states if s is not None]
    if not arriving:
        return None
    result = arriving[0]
    for other in arriving[1:]:
        implied: dict[str, frozenset[Variable] | None] = {}
        for key in result.implied.keys() & other.implied.keys():
            a, b = result.implied[key], other.implied[key]
            left = None if a is None else a | result.must
            right = None if b is None else b | other.must
            implied[key] = right if left is None else (left if right is None else left & right)
        for mine, its in ((result, other), (other, result)):
            for key, variables in mine.implied.items():
                if key not in its.implied:
                    implied[key] = its.must if variables is None else (variables | mine.must) & its.must
        known = {v: c for v, c in result.known.items() if other.known.get(v) == c}
        result = State(result.must & other.must, result.may | other.may, known, implied)
    return result


#: What holds at the end of a turn, and at every break.
Turn = tuple[State | None, list[State | None]]

#: What may stand where nothing leads to: C wants a `break` there, or a compiler a `return`.
_MAY_FOLLOW: Final = (Return, Break, Continue, LeaveSwitch, FallThrough, Declare)
#: After so many turns what is known at a loop's head is given up.
_TURNS: Final = 8
_KEY: Final = {True: "=", False: "!"}


class AssignmentFlow:
    """The walk over one function."""

    def __init__(self, function: Function, report: StaticReport) -> None:
        self.function = function
        self.to = report
        self.tracked = {v for v in function.locals if not v.in_memory}
        #: For each loop or switch that can be left from within: what holds where it is left, and at `continue`.
        self.loops: list[tuple[list[State | None], list[State | None]]] = []
        self.switches: list[list[State | None]] = []
        self.where = function.where
        self.seen: set[Variable] = set()
        #: Locals that every case of a switch without default writes -> the place of that switch.
        self.undefaulted: dict[Variable, Where] = {}
        #: A loop's body is walked only to see what holds at its head.
        self.quiet = False
        #: What came out of such walks, by the loop: loops within loops would be walked again and again.
        self.walked: dict[int, list[tuple[State, Turn]]] = {}

    def run(self) -> None:
        """Report what the function's body shows."""
        first = {v for v in self.function.parameters if not v.in_memory}
        end = self.block(self.function.body, State(frozenset(first), frozenset(first)))
        if end is not None and self.function.ctype.result != VOID and self.function.name != "main":
            returns = any(isinstance(s, Return) and s.value is not None for s in statements(self.function.body))
            how = "can come to its end without a return value" if returns else "never returns a value"
            message = f"{self.function.path} {how}: the caller gets what the register holds"
            place = last_place(self.function)
            self.to.report(self.function, place, "missing-return", message, object=self.function.path)

    # Statements

    def block(self, body: list[Stmt], state: State | None) -> State | None:
        told = False
        for s in body:
            self.where = s.where
            if state is None:
                if not self.quiet and not told and not isinstance(s, _MAY_FOLLOW):
                    told = True
                    message = f"nothing leads to this statement of {self.function.path}"
                    self.to.report(self.function, s.where, "unreachable", message, object=self.function.path)
                continue
            state = self.statement(s, state)
        return state

    def statement(self, s: Stmt, state: State) -> State | None:
        match s:
            case Assign(target=target, value=value):
                self.read(value, state)
                if isinstance(target, LValue):
                    self.read_way(target, state)
                    if isinstance(target.root, Variable) and not target.indices:
                        return self.write(target.root, value, state)
            case Declare(variable=variable, value=value):
                for part in different(value) if isinstance(value, list) else [value]:
                    if isinstance(part, Expr):
                        self.read(part, state)
                if value is not None:
                    return self.write(variable, value if isinstance(value, Expr) else None, state)
                if variable.nested:
                    return replace(state, must=state.must - {variable}, may=state.may - {variable})
            case CopyStruct(target=target, source=source):
                self.read_way(source, state)
                self.read_way(target, state)
            case Evaluate(value=value):
                self.read(value, state)
            case Return(value=value):
                if value is not None:
                    self.read(value, state)
                return None
            case Break():
                self.loops[-1][0].append(state)
                return None
            case Continue():
                self.loops[-1][1].append(state)
                return None
            case LeaveSwitch():
                self.switches[-1].append(state)
                return None
            case If(test=test, then=then, otherwise=otherwise):
                self.read(test, state)
                a = self.block(then, self.assume(test, True, state))
                b = self.block(otherwise, self.assume(test, False, state))
                return join(a, b)
            case While():
                return self.while_loop(s, state)
            case For():
                return self.for_loop(s, state)
            case Switch():
                return self.switch(s, state)
        return state

    def while_loop(self, s: While, state: State) -> State | None:
        runs = not s.first or evaluate(s.test, state.known)
        endless = isinstance(s.test, Const) and s.test.value != 0
        if s.first:
            self.read(s.test, state)
        inside = self.head(state, s)
        turned, breaks = self.turn(inside, s)
        if endless:
            return join(*breaks)
        if turned is not None:
            self.where = s.where
        out = turned if runs else join(inside, turned)
        after = self.assume(s.test, False, out) if out is not None else None
        return join(after, *breaks)

    def for_loop(self, s: For, state: State) -> State | None:
        self.read(s.start, state)
        self.read(s.stop, state)
        start, stop = evaluate(s.start, state.known), evaluate(s.stop, state.known)
        root = s.variable.root
        assert isinstance(root, Variable)
        state = self.write(root, None, state)
        inside = self.head(state, s)
        turned, breaks = self.turn(inside, s)
        runs = start is not None and stop is not None and (start < stop if s.step > 0 else start > stop)
        return join(turned if runs else join(inside, turned), *breaks)

    def turn(self, head: State, s: While | For) -> Turn:
        """One turn of a loop: what holds behind its step, and at every break."""
        if not self.quiet:
            return self.walk(head, s)
        known = self.walked.setdefault(id(s), [])
        for before, outcome in known:
            if before == head:
                return outcome
        outcome = self.walk(head, s)
        known.append((head, outcome))
        return outcome

    def walk(self, head: State, s: While | For) -> Turn:
        """The turn, whatever is known of such walks."""
        self.loops.append(([], []))
        end = self.block(s.body, self.assume(s.test, True, head) if isinstance(s, While) and s.first else head)
        breaks, continues = self.loops.pop()
        end = join(end, *continues)
        if isinstance(s, While) and end is not None:
            end = self.block(s.step, end)
            if not s.first and end is not None:
                self.read(s.test, end)
        return end, breaks

    def head(self, state: State, s: While | For) -> State:
        """What holds at the head of a loop in every turn."""
        quiet, self.quiet = self.quiet, True
        changed = assigned_variables([s])
        head = replace(state, known={v: c for v, c in state.known.items() if v not in changed})
        for _ in range(_TURNS):
            end, _ = self.turn(head, s)
            if isinstance(s, While) and not s.first and end is not None:
                end = self.assume(s.test, True, end)
            following = join(head, end)
            assert following is not None
            if following.implied == head.implied and following.must == head.must:
                break
            head = replace(following, known=head.known)
        else:
            head = forget(state, changed)
        self.quiet = quiet
        return replace(head, may=state.may)

    def switch(self, s: Switch, state: State) -> State | None:
        self.read(s.subject, state)
        ends: list[State | None] = []
        self.switches.append(ends)
        falling: State | None = None
        default = s.complete
        labels: set[int] = set()
        for values, body in s.cases:
            where = body[0].where if body else self.where
            for value in values or []:
                if value in labels and not self.quiet:
                    message = f"case {value} stands here a second time and is never taken"
                    self.to.report(self.function, where, "unreachable", message, object=self.function.path)
                labels.add(value)
            default = default or values is None
            after = self.block(body, join(state, falling))
            falls = bool(body) and isinstance(body[-1], FallThrough)
            falling = after if falls else None
            if not falls:
                ends.append(after)
        ends.append(falling)
        self.switches.pop()
        self.where = s.where
        if default:
            return join(*ends)
        arriving = [e for e in ends if e is not None]
        everywhere = frozenset.intersection(*(e.must for e in arriving)) - state.may if arriving else frozenset()
        for variable in sorted(everywhere, key=lambda v: v.name):
            self.undefaulted[variable] = s.where
        return join(state, *ends)

    # Expressions

    def read(self, e: Expr | LValue | Index, state: State) -> None:
        match e:
            case Logic(op=op, operands=operands):
                for operand in operands:
                    self.read(operand, state)
                    state = self.assume(operand, op == "and", state)
            case Load(lvalue=LValue(root=Variable() as root)):
                self.use(root, state, e.lvalue.where if e.lvalue.where.line else self.where)
                self.read_way(e.lvalue, state)
            case Expr():
                for value in vars(e).values():
                    for inner in value if isinstance(value, list) else [value]:
                        if isinstance(inner, LValue):
                            self.read_way(inner, state)
                        elif isinstance(inner, Expr) and not isinstance(e, Const):
                            self.read(inner, state)

    def read_way(self, lvalue: LValue, state: State) -> None:
        """The subscripts and the pointer on the way to an object."""
        for index in lvalue.indices:
            self.read(index.expr, state)
        if isinstance(lvalue.root, Expr):
            self.read(lvalue.root, state)

    def use(self, variable: Variable, state: State, where: Where) -> None:
        if self.quiet or variable not in self.tracked or variable in state.must or variable in self.seen:
            return
        self.seen.add(variable)
        path = variable.declaration.path
        if variable in self.undefaulted:
            message = f"without a default {path} has no value in any other case (it is read in line {where.line})"
            self.to.report(
                self.function, self.undefaulted[variable], "switch-no-default", message, object=path,
                declaration=variable.declaration,
            )  # fmt: skip
        sure = "is" if variable not in state.may else "can be"
        message = f"{path} {sure} read here before anything was written to it"
        self.to.report(
            self.function, where, "maybe-uninitialised", message, object=path, declaration=variable.declaration
        )

    def write(self, variable: Variable, value: Expr | None, state: State) -> State:
        if variable not in self.tracked and (variable.in_memory or variable.kind == "global"):
            return state
        constant = evaluate(value, state.known) if value is not None else None
        known = {v: c for v, c in state.known.items() if v is not variable}
        implied = {k: v for k, v in state.implied.items() if variable.name not in k[1:].split()}
        source = fingerprint(value) if value is not None else ""
        for key in _KEY.values():  # what a value implies, its copy implies
            if key + source in implied:
                implied[key + f" {variable.name} "] = implied[key + source]
        if constant is not None:
            known[variable] = constant
            implied[_KEY[not constant] + f" {variable.name} "] = None
        return State(state.must | {variable}, state.may | {variable}, known, implied)

    # Conditions

    def assume(self, test: Expr, holds: bool, state: State) -> State:
        """The state in which `test` has come out true (or false)."""
        match test:
            case Not(operand=operand):
                return self.assume(operand, not holds, state)
            case Logic(op=op, operands=operands):
                if (op == "and") == holds:
                    for operand in operands:
                        state = self.assume(operand, holds, state)
                return state
            case Convert(operand=operand):
                return self.assume(operand, holds, state)
            case Compare(op="==" | "!=" as op, left=left, right=Const(value=value)):
                if value == 0:
                    return self.assume(left, (op == "!=") == holds, state)
                if (op == "==") == holds:
                    state = self.assume(left, True, state)
            case Compare(op=">", left=left, right=Const(value=value)) if holds and value >= 0:
                state = self.assume(left, True, state)
        text = fingerprint(test)
        if not text:
            return state
        implied = state.implied.get(_KEY[holds] + text, frozenset())
        if implied is None:  # no way leads here
            implied = frozenset(self.tracked)
        return replace(
            state, must=state.must | implied, may=state.may | implied,
            implied={**state.implied, _KEY[not holds] + text: None},
        )  # fmt: skip


def forget(state: State, changed: Set[Variable]) -> State:
    """What still holds when variables have been changed."""
    names = {v.name for v in changed}
    return replace(
        state, known={v: c for v, c in state.known.items() if v not in changed},
        implied={k: v for k, v in state.implied.items() if not names & set(k[1:].split())},
    )  # fmt: skip


def last_place(function: Function) -> Where:
    """The place of the last statement of a function."""
    return max((s.where for s in statements(function.body)), key=lambda where: where.line, default=function.where)
