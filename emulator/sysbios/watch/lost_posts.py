"""Posts of a binary semaphore that are lost: `post-lost`.

A binary semaphore keeps one post.  Posts beyond it are lost.  This is reported where each post matters: one statement
posts several times before its thread ends or blocks, and the task does one thing for each pend, without a loop that
would empty a queue.  A task that posts once in each turn, as it sleeps between them, only says that there is news.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Final, NamedTuple

from emulator.c28x.findings import Findings
from emulator.c28x.link import Linked
from emulator.c28x.tree import Call, For, Function, Stmt, While
from emulator.c28x.tree_queries import blocks, own_nodes, statements
from emulator.sysbios.semaphore import Semaphore
from emulator.sysbios.watch.calls import Calls
from emulator.sysbios.watch.names import HandleNames, first_argument
from emulator.sysbios.watch.statements import Call as RunningCall
from emulator.sysbios.watch.statements import StatementLocator, StatementNumber
from emulator.sysbios.watch.threads import Thread, ThreadWatch

#: The bit of the mode that makes a semaphore binary.
_BINARY: Final = 1
#: Report when one statement has lost this many posts before its thread ended or blocked.
_LOST: Final = 2
_BLOCKING: Final = ("Semaphore_pend", "Event_pend", "Mailbox_pend", "Mailbox_post", "Task_sleep", "Task_yield")


class _Post(NamedTuple):
    """A post: its statement, the call with which its thread began, and how often that had called what may block."""

    statement: StatementNumber
    began: RunningCall | None
    blocked: int

    def follows(self, other: _Post) -> bool:
        """Whether the same statement made both, and its thread has neither ended nor blocked between them."""
        return self.began is other.began and (self.statement, self.blocked) == (other.statement, other.blocked)


class LostPosts:
    """Listens to posts."""

    def __init__(
        self, threads: ThreadWatch, locator: StatementLocator, names: HandleNames, findings: Findings, calls: Calls,
        linked: Linked,
    ) -> None:  # fmt: skip
        self._threads, self._locator, self._names, self._findings = threads, locator, names, findings
        self._linked = linked
        #: Semaphore -> its last post, and how many posts that statement has lost since its thread began or blocked.
        self._last: dict[Semaphore, tuple[_Post, int]] = {}
        #: How often each thread has called a function that may block.
        self._blocked: Counter[Thread] = Counter()
        self._reported: set[Semaphore] = set()
        calls.before("Semaphore_post", callback=self._posting)
        calls.before(*_BLOCKING, callback=self._blocking)

    def _blocking(self, *_arguments: object) -> None:
        self._blocked[self._threads.current] += 1

    def _posting(self, semaphore: Semaphore) -> None:
        if not semaphore.mode & _BINARY:
            return
        statement = self._locator.here()
        post = _Post(statement, self._locator.outermost_call(), self._blocked[self._threads.current])
        before, lost = self._last.get(semaphore, (None, 0))
        lost = lost + bool(semaphore.count) if before is not None and post.follows(before) else 0
        self._last[semaphore] = post, lost
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
                yield first_argument(call), around is None or _loops(around, own)
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
