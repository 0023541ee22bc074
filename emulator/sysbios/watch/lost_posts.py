"""Posts of a binary semaphore that are lost: `post-lost`.

A binary semaphore keeps one post.  Posts beyond it are lost.  This is reported where each post matters: one statement
posts repeatedly in one call, and the task does one thing for each pend, without a loop that would empty a queue.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from emulator.c28x.findings import Findings
from emulator.c28x.link import Linked
from emulator.c28x.tree import Call, Convert, For, Function, Load, LValue, Stmt, Variable, While
from emulator.c28x.tree_queries import blocks, own_nodes, statements
from emulator.sysbios.semaphore import Semaphore
from emulator.sysbios.watch.calls import Calls
from emulator.sysbios.watch.names import HandleNames
from emulator.sysbios.watch.statements import Call as RunningCall
from emulator.sysbios.watch.statements import StatementLocator, StatementNumber

#: The bit of the mode that makes a semaphore binary.
_BINARY: Final = 1
#: Report when one statement has lost this many posts in one call.
_LOST: Final = 2


class LostPosts:
    """Listens to posts."""

    def __init__(
        self, locator: StatementLocator, names: HandleNames, findings: Findings, calls: Calls, linked: Linked
    ) -> None:
        self._locator, self._names, self._findings, self._linked = locator, names, findings, linked
        #: Semaphore -> the statement and call that posted it last, and how many posts that one has lost.
        self._last: dict[Semaphore, tuple[StatementNumber, RunningCall | None, int]] = {}
        self._reported: set[Semaphore] = set()
        calls.before("Semaphore_post", callback=self._posting)

    def _posting(self, semaphore: Semaphore) -> None:
        if not semaphore.mode & _BINARY:
            return
        statement, call = self._locator.here(), self._locator.call()
        before = self._last.get(semaphore)
        lost = before[2] if before is not None and before[0] == statement and before[1] is call else 0
        lost += bool(semaphore.count) and before is not None and before[0] == statement and before[1] is call
        self._last[semaphore] = statement, call, lost
        if lost >= _LOST and semaphore not in self._reported:
            self._reported.add(semaphore)
            self._report(semaphore, statement)

    def _report(self, semaphore: Semaphore, statement: StatementNumber) -> None:
        objects = self._names.objects(semaphore)
        loops = [drains for path, drains in self._pends() if path in objects]
        place = self._locator.place(statement)
        if loops and not any(loops) and place is not None:
            name = self._names.of(semaphore)
            self._findings.report_at(
                place, "post-lost", f"{name} is a binary semaphore: this statement posted it again before the last "
                "post was taken, and the task that pends on it does one thing for each post", object=name,
                how="dynamic",
            )  # fmt: skip

    def _pends(self) -> Iterator[tuple[str | None, bool]]:
        """The pends of the source: the object that holds the semaphore, and whether a loop may take several things."""
        own = {
            function.path: function for module in self._linked.program.modules.values() for function in module.functions
        }
        for function in own.values():
            yield from _in(function.body, None, own)


def _in(body: list[Stmt], around: Stmt | None, own: dict[str, Function]) -> Iterator[tuple[str | None, bool]]:
    for statement in body:
        for call in (part for part in own_nodes(statement) if isinstance(part, Call)):
            if call.function.name == "Semaphore_pend":
                argument = call.arguments[0]
                path = None
                match argument.operand if isinstance(argument, Convert) else argument:
                    case Load(lvalue=LValue(root=Variable(kind="global") as variable)):
                        path = variable.declaration.path
                yield path, around is None or _loops(around, own)
        for block in blocks(statement):
            yield from _in(block, statement if isinstance(statement, While | For) else around, own)


def _loops(loop: Stmt, own: dict[str, Function]) -> bool:
    """Whether a loop contains a `while` loop, in its own body or in a function that it calls."""
    seen: set[str] = set()
    waiting = [statement for block in blocks(loop) for statement in statements(block)]
    while waiting:
        statement = waiting.pop()
        if isinstance(statement, While):
            return True
        for call in (part for part in own_nodes(statement) if isinstance(part, Call)):
            path = call.function.path
            if path in own and path not in seen:
                seen.add(path)
                waiting += statements(own[path].body)
    return False
