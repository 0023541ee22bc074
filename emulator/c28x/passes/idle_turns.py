"""Pass `idle_turns`: the turns of a loop that change nothing, so that the next one does the same.

A turn is idle if it only reads named objects and registers, compares them, and sets locals that it does not read
before.  As long as no event comes, each turn after an idle one is idle too, and takes the same cycles.  So time can
skip whole turns (`Runtime.turn`), up to the next event.

A register may change by itself, or notice that it is read.  The loop asks each of them at run time (`Cell.steady`).

`while (1) { now = Ticks; if (now - last >= 10) { last = now; Report(); } }` has such turns: those in which the test
fails.  What begins a turn that is not idle is marked.
"""

from __future__ import annotations

from collections.abc import Iterable

from emulator.c28x.tree import (
    Assign,
    Break,
    Call,
    CallPointer,
    Continue,
    Declare,
    Expr,
    FallThrough,
    Function,
    If,
    Jump,
    LValue,
    RegisterAt,
    RegisterLoad,
    RegisterRef,
    Return,
    Stmt,
    Variable,
    While,
)
from emulator.c28x.tree_queries import parts, polls, statements


def idle_turns(function: Function) -> tuple[dict[int, list[RegisterRef]], dict[int, list[int]]]:
    """The loops of a function that have idle turns, and the statements that end the idleness of a turn.

    Returns identities: of loops, each with the registers that idle turns read, and of statements, each with those of
    the loops whose turn it is part of.
    """
    loops: dict[int, list[RegisterRef]] = {}
    marks: dict[int, list[int]] = {}
    for s in statements(function.body):
        if isinstance(s, While) and s.body and not polls(s):
            turn = _Turn(set())
            idle = turn.of(s)
            while turn.set & turn.read:
                turn = _Turn(turn.carried | turn.set & turn.read)
                idle = turn.of(s)
            if idle:
                loops[id(s)] = list(turn.registers.values())
                for statement in turn.busy:
                    marks.setdefault(id(statement), []).append(id(s))
    return loops, marks


class _Turn:
    """One turn of a loop; `carried`: the locals that a turn hands to the next one, so that no idle turn sets them."""

    def __init__(self, carried: set[Variable]) -> None:
        self.carried = carried
        #: The statements before which a turn is idle, and after which it is not.
        self.busy: list[Stmt] = []
        #: The locals that idle turns set, and those that they read before they have set them.
        self.set: set[Variable] = set()
        self.read: set[Variable] = set()
        #: The registers that they read, by block and name.
        self.registers: dict[tuple[str, str], RegisterRef] = {}
        #: Whether a `continue` ends an idle turn; a test that follows it.
        self.carries_on = False
        self.last: list[Expr] = []

    def of(self, loop: While) -> bool:
        """Whether the loop has idle turns."""
        if loop.step or not _pure([loop.test]):
            return False
        known: set[Variable] = set()
        self.last = [] if loop.first else [loop.test]
        if loop.first:
            self._reads([loop.test], known)
        after = self._block(loop.body, known)
        if after is not None:
            self._reads(self.last, after)
        return after is not None or self.carries_on

    def _block(self, body: list[Stmt], known: set[Variable]) -> set[Variable] | None:
        """Follow an idle turn through a block; `known`: the locals that it has set.

        Returns those that it has set at the end; None: no idle turn reaches the end.
        """
        for s in body:
            match s:
                case Continue():
                    self.carries_on = True
                    self._reads(self.last, known)
                    return None
                case Break() | Return() | Jump():
                    return None  # the loop ends
                case Declare(value=None) | FallThrough():
                    pass
                case Assign(target=LValue(root=Variable() as target, indices=[]), value=value) | Declare(
                    variable=target, value=Expr() as value
                ) if target.plain and target not in self.carried and _pure([value]):  # fmt: skip
                    self._reads([value], known)
                    self.set.add(target)
                    known = {*known, target}
                case If(test=test, then=then, otherwise=otherwise) if _pure([test]):
                    self._reads([test], known)
                    ends = [e for e in (self._block(then, known), self._block(otherwise, known)) if e is not None]
                    if not ends:
                        return None
                    known = set.intersection(*ends)
                case While(first=True, test=test, body=[first, *_]) if _pure([test]):
                    self._reads([test], known)
                    self.busy.append(first)
                case _:
                    self.busy.append(s)
                    return None
        return known

    def _reads(self, values: Iterable[Expr], known: set[Variable]) -> None:
        for value in values:
            for part in parts(value):
                if isinstance(part, LValue) and isinstance(part.root, Variable) and part.root not in known:
                    self.read.add(part.root)
                elif isinstance(part, RegisterLoad) and isinstance(part.register, RegisterRef):
                    self.registers.setdefault((part.register.block, part.register.register), part.register)


def _pure(values: Iterable[Expr]) -> bool:
    """Whether expressions only read named objects and registers: no call, no pointer."""
    for part in (p for value in values for p in parts(value)):
        match part:
            case Call() | CallPointer() | LValue(root=Expr()) | RegisterLoad(register=RegisterAt()):
                return False
    return True
