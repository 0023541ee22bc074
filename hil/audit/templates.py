"""Rigs and robots that are prepared before the process is copied, so that a child finds them linked and booted.

An `Order` describes a rig or robot.  `take` returns the one that was prepared for the order, or makes one.  The two
cases differ only in time.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from contextlib import suppress
from contextvars import ContextVar
from typing import Any, Protocol, TypeVar

from hil.collector import uncollected

Made = TypeVar("Made", covariant=True)
Result = TypeVar("Result")

#: An order that is not `common` is prepared for the next child after it was missing this many times.
_AGAIN = 2


class Order(Protocol[Made]):
    """All that determines a rig or robot: equal orders make equal ones.  It is hashable and can be pickled."""

    @property
    def common(self) -> bool:
        """Whether other entries will need the same.  Then it is prepared as soon as it was missing once."""

    def make(self) -> Made:
        """Make a new rig or robot."""


class Templates:
    """The prepared rigs and robots of this process.  A copy of the process has each of them once."""

    def __init__(self) -> None:
        self._ready: dict[Order[Any], Any] = {}
        self._asked: Counter[Order[Any]] = Counter()
        self._missed: list[Order[Any]] = []

    def take(self, order: Order[Result]) -> Result:
        """The prepared object for `order`, which is removed here; or a new one."""
        if order in self._ready:
            made: Result = self._ready.pop(order)
            return made
        self._missed.append(order)
        return order.make()

    def using(self, function: Callable[[], Result]) -> tuple[Result, list[Order[Any]]]:
        """Call `function` so that `take` uses these templates.  Returns its result, and the orders that were missing.

        Use it in a copy of the process, because objects that are taken are removed.
        """
        token = _TEMPLATES.set(self)
        try:
            return function(), self._missed
        finally:
            _TEMPLATES.reset(token)

    def make_ready(self, missed: Iterable[Order[Any]]) -> None:
        """Count the orders that were missing in a copy, and prepare those that were missing often enough."""
        for order in missed:
            self._asked[order] += 1
            if self._asked[order] == (1 if order.common else _AGAIN):
                with uncollected(), suppress(Exception):  # a later `take` of the order raises the error again
                    self._ready[order] = order.make()


_TEMPLATES: ContextVar[Templates | None] = ContextVar("templates", default=None)


def take(order: Order[Result]) -> Result:
    """The rig or robot for `order`, prepared or new."""
    templates = _TEMPLATES.get()
    return order.make() if templates is None else templates.take(order)
