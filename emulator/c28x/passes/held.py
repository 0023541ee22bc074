"""The trees of a program in which a local that only holds a value for the next statement is that value.

    int tooLate = stateMs > LIMIT;
    if (tooLate) ...                        if (stateMs > LIMIT) ...

Checks look for a value where it is used: in a test, an argument, an assignment.  One statement gives such a local its
value, and one place reads it, in a statement right behind.  Between them may be declarations that run no function.

The value stays where it is if the way would show: a function may change what it reads first, or what it accesses
(a call, a register, a volatile object) would come after another part of the statement, or perhaps not at all.  A local
that is a constant has a name for it: it may be a choice of the build.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from copy import copy
from typing import Any, Final

from emulator.c28x.ctypes import FloatType, IntType
from emulator.c28x.passes.rewriting import Rewriting
from emulator.c28x.passes.values import depends, volatile
from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    Assign,
    Call,
    CallPointer,
    Declare,
    Evaluate,
    Expr,
    Function,
    If,
    Load,
    LValue,
    Return,
    Stmt,
    Switch,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import all_blocks, bare, calls, once, own_nodes, parts, roots, within

#: The statements that evaluate their expressions once, before anything else.
_ONCE: Final = (Assign, Declare, Evaluate, If, Return, Switch)


def with_held_values(modules: Iterable[Module]) -> list[Module]:
    """The modules of a program, with values in the place of the locals that hold them for the next statement."""
    found = []
    for module in modules:
        written = copy(module)
        written.functions = list(map(_written, module.functions))
        found.append(written)
    return found


@once
def _written(function: Function) -> Function:
    held: dict[Variable, Expr] = {}
    left_out: set[int] = set()
    mentions = Counter(p.root for p in within(function.body) if isinstance(p, LValue) and isinstance(p.root, Variable))
    for block in all_blocks(function.body):
        for number, s in enumerate(block):
            given = _given(s)
            if given is None or mentions[given[0]] != 1 + isinstance(s, Assign):
                continue
            user = next((x for x in block[number + 1 :] if _reads(x, given[0]) or not _only_declares(x)), None)
            if user is not None and _can_stand(*given, user):
                held[given[0]] = given[1]
                left_out.add(id(s))
    return _HeldView(held, left_out).function(function)


def _given(s: Stmt) -> tuple[Variable, Expr] | None:
    """The number, no constant, that a statement gives to a local; None: it does something else."""
    match s:
        case (
            Declare(variable=Variable(kind="local", in_memory=False, volatile=False) as held, value=Expr() as value)
            | Assign(target=LValue(root=Variable(kind="local", in_memory=False, volatile=False) as held), value=value)
        ) if isinstance(held.ctype, IntType | FloatType) and depends(value):  # fmt: skip
            return held, value
    return None


def _only_declares(s: Stmt) -> bool:
    """Whether a statement changes nothing but a new local."""
    return isinstance(s, Declare) and not any(map(_orderly, roots(s)))


def _orderly(e: Any) -> bool:
    """Whether it matters when, and how often, an expression is evaluated."""
    return calls(e) or volatile(e)


def _reads(s: Stmt, held: Variable) -> bool:
    return any(isinstance(p, LValue) and p.root is held for p in own_nodes(s))


def _can_stand(held: Variable, value: Expr, user: Stmt) -> bool:
    """Whether a value can stand where a statement reads the local that holds it."""
    if not isinstance(user, _ONCE) or not _reads(user, held):
        return False
    if any(isinstance(p, Call | CallPointer) and not _within(p, held) for p in own_nodes(user)):
        return False
    return not _orderly(value) or any(_is(root, held) for root in roots(user))


def _within(e: Expr, held: Variable) -> bool:
    return any(isinstance(p, LValue) and p.root is held for p in parts(e))


def _is(e: Any, held: Variable) -> bool:
    """Whether an expression is just the value of a local."""
    inner = bare(e) if isinstance(e, Expr) else None
    return isinstance(inner, Load) and inner.lvalue.root is held


class _HeldView(Rewriting):
    """Writes a function anew, with the values that locals hold."""

    def __init__(self, held: dict[Variable, Expr], left_out: set[int]) -> None:
        super().__init__(held)
        self._held = held
        self._left_out = left_out

    def instead(self, node: Any) -> Any:
        """The value for a local that holds it."""
        while isinstance(node, Load) and isinstance(node.lvalue.root, Variable) and node.lvalue.root in self._held:
            node = self._held[node.lvalue.root]
        return node

    def kept(self, node: Any) -> bool:
        """Whether a part of a list stays: not the statement that gives such a value."""
        return id(node) not in self._left_out
