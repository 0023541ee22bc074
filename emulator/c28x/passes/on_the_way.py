"""The tests on the way to a statement, in its function and in those that call it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final, NamedTuple

from emulator.c28x.passes.state_values import constant_of
from emulator.c28x.tree import Call, Compare, Expr, Function, If, Stmt, Switch, While
from emulator.c28x.tree_queries import blocks, leaves, own_nodes, parts

#: So many calls up, the tests are read.
_DEPTH: Final = 4


class Turn(NamedTuple):
    """A test on the way to a statement: its block is entered by it, or control has come past it."""

    function: Function
    test: Expr
    enters: bool
    #: The values that the tested word has then, if it is compared with some.
    values: tuple[int, ...] = ()


def with_turns(function: Function) -> Iterator[tuple[tuple[Turn, ...], Stmt]]:
    """The statements of a function, each with the tests on the way to it."""
    return _in_block(function, function.body, ())


def ways_to(function: Function, functions: Iterable[Function], depth: int = _DEPTH) -> Iterator[tuple[Turn, ...]]:
    """The tests on each way to the calls of a function, so far up as it is followed; none if nobody calls it."""
    functions = list(functions)
    for caller in functions if depth else ():
        for turns, s in with_turns(caller):
            if any(isinstance(p, Call) and p.function.path == function.path for p in own_nodes(s)):
                further = list(ways_to(caller, [f for f in functions if f is not function], depth - 1))
                yield from ((*before, *turns) for before in further or [()])


def _in_block(
    function: Function, body: list[Stmt], turns: tuple[Turn, ...]
) -> Iterator[tuple[tuple[Turn, ...], Stmt]]:  # fmt: skip
    for s in body:
        yield turns, s
        match s:
            case If(test=test, then=then, otherwise=otherwise):
                yield from _in_block(function, then, (*turns, Turn(function, test, True, _equal(test))))
                yield from _in_block(function, otherwise, (*turns, Turn(function, test, True)))
                if leaves(then) != leaves(otherwise):
                    turns += (Turn(function, test, False),)
            case Switch(subject=subject, cases=cases):
                for values, block in cases:
                    turn = Turn(function, subject, True, tuple(values or ()))
                    yield from _in_block(function, block, (*turns, turn))
            case While(test=test, body=block):
                yield from _in_block(function, block, (*turns, Turn(function, test, True)))
                turns += (Turn(function, test, False),)
            case _:
                for block in blocks(s):
                    yield from _in_block(function, block, turns)


def _equal(test: Expr) -> tuple[int, ...]:
    """The values with which a test says that something is equal."""
    compared = (p for p in parts(test) if isinstance(p, Compare) and p.op == "==")
    values = (constant_of(side) for p in compared for side in (p.left, p.right))
    return tuple(value for value in values if value is not None)
