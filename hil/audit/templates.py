"""Rigs and robots that are prepared before the process is copied, so that a child finds them linked and booted.

An `Order` describes a rig or robot.  `take` returns the one that was prepared for the order, or makes one.  The two
cases differ only in time.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable
from contextlib import suppress
from contextvars import ContextVar
from typing import Any, Protocol, TypeVar

from hil.collector import uncollected

Made = TypeVar("Made", covariant=True)
Result = TypeVar("Result")

#: An order that is not `common` is prepared after this many children took it.
_AGAIN = 2


class Order(Protocol[Made]):
    """All that determines a rig or robot: equal orders make equal ones.  It is hashable and can be pickled."""

    @property
    def common(self) -> bool:
        """Whether other entries will need the same.  Then it is prepared as soon as one took it."""

    def make(self) -> Made:
        """Make a new rig or robot."""


class Templates:
    """The prepared rigs and robots of this process.  A copy of the process has each of them once."""

    def __init__(self) -> None:
        self._ready: defaultdict[Order[Any], list[Any]] = defaultdict(list)
        self._asked: Counter[Order[Any]] = Counter()
        self._taken: Counter[Order[Any]] = Counter()

    def take(self, order: Order[Result]) -> Result:
        """A prepared object for `order`, which is removed here; or a new one."""
        self._taken[order] += 1
        if self._ready[order]:
            made: Result = self._ready[order].pop()
            return made
        return order.make()

    def using(self, function: Callable[[], Result]) -> tuple[Result, Counter[Order[Any]]]:
        """Call `function` so that `take` uses these templates.  Returns its result, and how often it took each order.

        Use it in a copy of the process, because objects that are taken are removed.
        """
        token = _TEMPLATES.set(self)
        try:
            return function(), self._taken
        finally:
            _TEMPLATES.reset(token)

    def make_ready(self, taken: Counter[Order[Any]]) -> None:
        """Prepare what a copy took, as many as it took, if it was taken in enough copies."""
        for order, times in taken.items():
            self._asked[order] += 1
            if self._asked[order] >= (1 if order.common else _AGAIN):
                with uncollected(), suppress(Exception):  # a later `take` of the order raises the error again
                    while len(self._ready[order]) < times:
                        self._ready[order].append(order.make())


_TEMPLATES: ContextVar[Templates | None] = ContextVar("templates", default=None)


def take(order: Order[Result]) -> Result:
    """The rig or robot for `order`, prepared or new."""
    templates = _TEMPLATES.get()
    return order.make() if templates is None else templates.take(order)
