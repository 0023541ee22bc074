"""What decides whether a statement of `main` runs, in the source of a program without the kernel.

A flag that a routine sets keeps it and `main` apart: `main` copies a structure, or uses a part of a peripheral, only
while the flag says so.  A statement that runs whatever the routine has done is kept apart by nothing but a mask.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from typing import Any

from emulator.c28x.tree import (
    Break,
    Call,
    CallPointer,
    Continue,
    Expr,
    Function,
    If,
    Jump,
    LValue,
    RegisterLoad,
    Return,
    Stmt,
    Switch,
    Variable,
    While,
)
from emulator.c28x.tree_queries import assigned, below, blocks, called, own_nodes, parts, reached, roots, statements


def interrupt_routines(own: dict[str, Function]) -> Iterator[tuple[Function, list[Function]]]:
    """The interrupt routines, each with itself and the functions that it calls, directly or not."""
    for routine in own.values():
        if routine.interrupt:
            yield routine, below([routine.path], own)



def always_told(_part: Call | RegisterLoad) -> bool:
    """A register or the result of a call may depend on what a routine has done."""
    return True


def free_ways(
    functions: Iterable[Function], own: dict[str, Function], telling: Collection[str],
    told: Callable[[Call | RegisterLoad], bool] = always_told,
) -> list[Ways]:  # fmt: skip
    """The functions that are only called whatever the routines have told, each with its statements of that kind.

    `telling` are the paths of the objects that the routines write.  `told` says whether a register or the result of a
    call may depend on what a routine has done.
    """
    ways = _all_ways(functions, telling, told)
    decided = {called.path for way in ways for path in way.decided for called in below([path], own)}
    return [way for way in ways if way.function.path not in decided]


def reached_freely(
    functions: Iterable[Function], telling: Collection[str], told: Callable[[Call | RegisterLoad], bool] = always_told
) -> list[Ways]:
    """As `free_ways`, but with all functions that some path of such calls leads to, whoever else calls them."""
    ways = {way.function.path: way for way in _all_ways(functions, telling, told)}
    inner = {path for way in ways.values() for path in way.function.calls if path != way.function.path}

    def freely_called(path: str) -> list[str]:
        return [name for s in ways[path].undecided for name in called(own_nodes(s)) if name in ways]

    return [ways[path] for path in reached((path for path in ways if path not in inner), freely_called)]


def _all_ways(
    functions: Iterable[Function], telling: Collection[str], told: Callable[[Call | RegisterLoad], bool]
) -> list[Ways]:
    functions, known = list(functions), set(telling)
    while True:
        ways = [Ways(function, known, told) for function in functions]
        more = {path for way in ways for path in way.passed_on} - known
        if not more:
            return ways
        known |= more


class Ways:
    """Which statements of a function run whatever the routines have told it.

    A test that reads one of the objects `telling` may be what keeps `main` and a routine apart.  So may a test of a
    register or of the result of a call, if `told` says so, and a test of what was set where such a test decides.
    """

    def __init__(
        self, function: Function, telling: Collection[str], told: Callable[[Call | RegisterLoad], bool]
    ) -> None:  # fmt: skip
        self.function = function
        self._telling = telling
        self._part_tells = told
        #: Locals that have such a value.
        self._told: set[Variable] = set()
        #: The functions (paths) that are called where such a test decides, and the shared objects that are set there.
        self.decided: set[str] = set()
        self.passed_on: set[str] = set()
        known = -1
        while known != len(self._told):
            known, self.undecided = len(self._told), list[Stmt]()
            for statement in statements(function.body):
                root = assigned(statement)
                if root is not None and root.kind != "global" and any(map(self.tells, roots(statement))):
                    self._told.add(root)
            self._walk(function.body, free=True)

    def _walk(self, body: list[Stmt], *, free: bool) -> bool:
        """Follow a block.  `free`: it is entered whatever the routines have told.

        Returns whether its end is reached whatever they have told.
        """
        for statement in body:
            if free:
                self.undecided.append(statement)
            else:
                self.decided.update(called(own_nodes(statement)))
                root = assigned(statement)
                if root is not None and root.kind == "global":
                    self.passed_on.add(root.declaration.path)
                elif root is not None:
                    self._told.add(root)
            test = (
                statement.test
                if isinstance(statement, If | While)
                else statement.subject
                if isinstance(statement, Switch)
                else None
            )
            told = test is not None and self.tells(test)
            ends = [self._walk(block, free=free and not told) for block in blocks(statement)]
            leaves = any(
                isinstance(inner, Return | Break | Continue | Jump)
                for branch in blocks(statement)
                for inner in statements(branch)
            )
            if (told and (leaves or isinstance(statement, While))) or (free and not told and not all(ends)):
                free = False
        return free

    def tells(self, expression: Any) -> bool:
        """Whether the value of an expression may depend on what the routines have done."""
        for part in parts(expression):
            match part:
                case Call() | RegisterLoad() if self._part_tells(part):
                    return True
                case CallPointer() | LValue(root=Expr()):
                    return True
                case LValue(root=Variable() as root) if root in self._told or root.declaration.path in self._telling:
                    return True
        return False
