"""Rigs and robots made ready before the process is copied: a child finds them linked and booted.

An `Order` says what is wanted.  `take` gives what was made ready for it, or makes it; which of the two does not show in
anything but the time.
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

#: So often something is missed until it is made ready for the next child, if nothing speaks for it before.
_AGAIN = 2


class Order(Protocol[Made]):
    """Everything that determines a rig or a robot: equal orders make equal ones.  Hashable, and can be pickled."""

    @property
    def common(self) -> bool:
        """Whether others will want the same, so that it is made ready as soon as it was missed once."""

    def make(self) -> Made:
        """A new one."""


class Templates:
    """What was made ready in this process.  A copy of the process has it, each thing once."""

    def __init__(self) -> None:
        self._ready: dict[Order[Any], Any] = {}
        self._asked: Counter[Order[Any]] = Counter()
        self._missed: list[Order[Any]] = []

    def take(self, order: Order[Result]) -> Result:
        """What is ready for `order`, which is then gone; or a new one."""
        if order in self._ready:
            made: Result = self._ready.pop(order)
            return made
        self._missed.append(order)
        return order.make()

    def using(self, function: Callable[[], Result]) -> tuple[Result, list[Order[Any]]]:
        """What `function` returns where `take` finds these; and the orders for which nothing was ready.

        For a copy of the process: what was taken is gone.
        """
        token = _TEMPLATES.set(self)
        try:
            return function(), self._missed
        finally:
            _TEMPLATES.reset(token)

    def make_ready(self, missed: Iterable[Order[Any]]) -> None:
        """Learn what was missed in a copy, and make ready what was missed again."""
        for order in missed:
            self._asked[order] += 1
            if self._asked[order] == (1 if order.common else _AGAIN):
                with uncollected(), suppress(Exception):  # whoever asks for it meets the error
                    self._ready[order] = order.make()


_TEMPLATES: ContextVar[Templates | None] = ContextVar("templates", default=None)


def take(order: Order[Result]) -> Result:
    """What `order` wants, ready or new."""
    templates = _TEMPLATES.get()
    return order.make() if templates is None else templates.take(order)
