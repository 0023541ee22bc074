"""Words that an interrupt routine also writes in runs in which it tells `main` nothing, found in the source.

    Phase += Increment;
    if (Phase < Increment)
        Position += Direction;          // in any run
    if (++Sub == 20) { Sub = 0; Millis++; }     // in one of 20

`main` waits for `Millis`, so in a run of the program it may always come right behind the twentieth.  The source shows
that it need not: the routine goes on, and asks nothing that `main` sets.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, Final

from emulator.c28x.passes.interrupted import test_of
from emulator.c28x.passes.on_the_way import Turn, with_turns
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Assign, Call, CallPointer, Declare, Expr, Function, LValue, RegisterLoad, Stmt, Variable
from emulator.c28x.tree_queries import own_nodes, parts, statements, within
from emulator.sysbios.watch.kept_off import Word, object_path
from emulator.sysbios.watch.ways import interrupt_routines

#: So many statements of a routine are looked at, each on each way to it.
_MOST: Final = 10_000


def untold_words(modules: Iterable[Module]) -> dict[str, set[Word]]:
    """By the name of a routine, the words (object path, offset) that it also writes without telling anything."""
    own = {function.path: function for module in modules for function in module.functions}
    routines = list(interrupt_routines(own))
    inside = {function.path for _, reached in routines for function in reached}
    known = {
        path for function in own.values() if function.path not in inside
        for part in within(function.body) if (path := object_path(part)) is not None
    }  # fmt: skip
    tested = {
        word for function in own.values() if function.path not in inside
        for s in statements(function.body) if (test := test_of(s)) is not None
        for part in parts(test) if (word := _word(part)) is not None
    }  # fmt: skip
    return {routine.name: set(_untold(routine, own, known, tested)) for routine, _ in routines}


def _word(part: Any) -> Word | None:
    path = object_path(part)
    return (path, part.words) if path is not None else None


def _untold(routine: Function, own: dict[str, Function], known: set[str], tested: set[Word]) -> Iterator[Word]:
    """The words of one routine.

    `known` are the objects that the rest of the program has to do with: each other one may tell it something, and a
    word of the same object if it is `tested`.
    """
    writes: list[tuple[Word, tuple[Turn, ...]]] = []
    for ran, (turns, s) in enumerate(_run(routine, own, (), frozenset())):
        if ran > _MOST:
            return  # there are too many ways through what it calls
        if isinstance(s, Assign) and (word := _word(s.target)) is not None and word[0] in known:
            writes.append((word, turns))
    for word, turns in writes:
        if all(_is_private(turn.function, turn.test, known, 2) for turn in turns) and not any(
            _begins(turns, before) for other, before in writes if other[0] != word[0] or other in tested
        ):  # fmt: skip
            yield word


def _run(
    function: Function, own: dict[str, Function], turns: tuple[Turn, ...], callers: frozenset[str]
) -> Iterator[tuple[tuple[Turn, ...], Stmt]]:  # fmt: skip
    """The statements that a function runs, itself and in what it calls, with the tests on the way to them."""
    for here, s in with_turns(function):
        yield (*turns, *here), s
        for path in {p.function.path for p in own_nodes(s) if isinstance(p, Call)} - callers - {function.path}:
            if path in own:
                yield from _run(own[path], own, (*turns, *here), callers | {function.path})


def _begins(turns: tuple[Turn, ...], before: tuple[Turn, ...]) -> bool:
    """Whether a statement behind the tests `before` runs in each run in which one behind `turns` does."""
    return len(before) <= len(turns) and all(
        one.test is other.test and one.enters == other.enters for one, other in zip(turns, before, strict=False)
    )


def _is_private(function: Function, e: Any, known: set[str], depth: int) -> bool:
    """Whether an expression depends on nothing but what the routine alone has to do with."""
    for p in parts(e):
        match p:
            case RegisterLoad() | Call() | CallPointer():
                return False
            case LValue(root=Variable(kind="global") as root):
                if root.declaration.path in known:
                    return False
            case LValue(root=Variable() as local):
                given = [
                    s.value for s in statements(function.body)
                    if (isinstance(s, Declare) and s.variable is local and isinstance(s.value, Expr))
                    or (isinstance(s, Assign) and isinstance(s.target, LValue) and s.target.root is local)
                ]  # fmt: skip
                if not given or not depth or not all(_is_private(function, v, known, depth - 1) for v in given):
                    return False
            case LValue():
                return False
    return True
