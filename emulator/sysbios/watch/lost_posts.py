"""Posts of a binary semaphore that are lost: `post-lost`.

A binary semaphore keeps one post.  Posts beyond it are lost.  This is reported where each post matters: one statement
posts several times before its thread ends or blocks, and the task does one thing for each pend, without a loop that
would empty a queue.  A task that posts once in each turn, as it sleeps between them, only says that there is news.

It is also reported where a binary semaphore is the one half of a pair that counts the places of a buffer: it is posted
only behind a pend on a counting semaphore which began with several places, and each pend on it gives back one of them.
Places are lost for good as soon as two posts come before the pend.  If the task that pends has the higher priority, and
waits nowhere else, they cannot.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from typing import Final, NamedTuple

from emulator.c28x.findings import Findings
from emulator.c28x.link import Linked
from emulator.c28x.tree import Call, For, Function, Stmt, While
from emulator.c28x.tree_queries import all_blocks, blocks, own_nodes, statements
from emulator.sysbios.semaphore import Semaphore
from emulator.sysbios.watch.calls import Calls
from emulator.sysbios.watch.names import HandleNames, calls_before, first_argument
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
        #: The count of each semaphore when it was first used.
        self._began: dict[Semaphore, int] = {}
        #: The highest level from which each semaphore was posted.
        self._level: dict[Semaphore, int] = {}
        #: How often each thread has pended on each semaphore.
        self._taken: defaultdict[Semaphore, Counter[Thread]] = defaultdict(Counter)
        calls.before("Semaphore_post", callback=self._posting)
        calls.before("Semaphore_pend", callback=self._pending)
        calls.before(*_BLOCKING, callback=self._blocking)

    def _blocking(self, *_arguments: object) -> None:
        self._blocked[self._threads.current] += 1

    def _pending(self, semaphore: Semaphore, _timeout: int) -> None:
        self._began.setdefault(semaphore, semaphore.count)
        self._taken[semaphore][self._threads.current] += 1

    def _posting(self, semaphore: Semaphore) -> None:
        self._began.setdefault(semaphore, semaphore.count)
        self._level[semaphore] = max(self._level.get(semaphore, 0), self._threads.current.level)
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

    def finish(self) -> None:
        """Report binary semaphores that should count, beside others that count the places of a buffer."""
        for semaphore, (post, _) in self._last.items():
            place = self._locator.place(post.statement)
            if place is None or semaphore in self._reported or not self._names.whole or self._is_prompt(semaphore):
                continue
            for places, count in self._began.items():
                if count > 1 and not places.mode & _BINARY and self._are_pair(semaphore, places):
                    name, other = self._names.of(semaphore), self._names.of(places)
                    self._findings.report_at(
                        place, "post-lost", f"{name} is a binary semaphore, and {other} lets {count} posts come here "
                        f"before one is taken: each post that is lost takes a place of {other} with it", object=name,
                        how="dynamic",
                    )  # fmt: skip
                    break

    def _is_prompt(self, semaphore: Semaphore) -> bool:
        """Whether what pends on a semaphore runs at once after each post of it: it has the priority, and waits here."""
        takers = self._taken.get(semaphore, Counter[Thread]())
        return all(t.level > self._level[semaphore] and self._blocked[t] == pends for t, pends in takers.items())

    def _are_pair(self, semaphore: Semaphore, places: Semaphore) -> bool:
        """Whether each post of `semaphore` is behind a pend on `places`, and each pend on it gives one place back."""
        posts, pends = self._names.objects(semaphore), self._names.objects(places)
        given = taken = False
        for function in self._names.functions:
            for call, before in calls_before(function.body, "Semaphore_post", "Semaphore_pend"):
                match first_argument(call):
                    case None:
                        return False
                    case path if path in posts:
                        given = True
                        if not any(first_argument(pend) in pends for pend in before):
                            return False
                    case path if path in pends:
                        taken = True
                        on_it = [pend for pend in before if first_argument(pend) in posts]
                        if not on_it or not _beside(function.body, call, on_it[-1]):
                            return False
        return given and taken

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


def _beside(body: list[Stmt], one: Call, other: Call) -> bool:
    """Whether two calls are in the statements of one block, so that both run equally often."""
    return any(
        {id(one), id(other)} <= {id(part) for statement in block for part in own_nodes(statement)}
        for block in all_blocks(body)
    )


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
