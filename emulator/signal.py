"""One way to listen: what happens is a `Signal`, and whoever wants to know of it connects to it.

    disconnect = wire.changed.connect(listener)    # listener(level) at every change from now on
    disconnect()                                   # and no more

The owner tells: `emit(...)`, or its loop written out where that is hot.

    for listener in self.changed.listeners:
        listener(level)

Listeners are told in the order in which they connected.  An emission is to those who listened when it began: who
connects meanwhile hears the next one, who disconnects meanwhile may still hear this one.  The same function connected
twice is told twice, and each `disconnect` ends its own connection; to call it again does nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Generic, ParamSpec

P = ParamSpec("P")


class Signal(Generic[P]):
    """Something that happens, told to any number of listeners.

    `wanted(True)` is called before the first one connects, `wanted(False)` when the last one has gone: for an owner to
    whom it costs something to know.
    """

    __slots__ = ("_connected", "_latest", "_wanted", "listeners")

    def __init__(self, wanted: Callable[[bool], None] | None = None) -> None:
        #: Who is told, in their order; another tuple after every connection and disconnection.
        self.listeners: tuple[Callable[P, object], ...] = ()
        self._wanted = wanted
        self._connected: dict[int, Callable[P, object]] = {}
        self._latest = 0

    def connect(self, listener: Callable[P, object]) -> Callable[[], None]:
        """Call `listener` whenever it happens from now on; what is returned ends that."""
        if self._wanted is not None and not self._connected:
            self._wanted(True)
        self._latest += 1
        self._connected[self._latest] = listener
        self.listeners = tuple(self._connected.values())
        return partial(self._disconnect, self._latest)

    def emit(self, *args: P.args, **kwargs: P.kwargs) -> None:
        """It happened: tell it."""
        for listener in self.listeners:
            listener(*args, **kwargs)

    def _disconnect(self, connection: int) -> None:
        if self._connected.pop(connection, None) is None:
            return
        self.listeners = tuple(self._connected.values())
        if self._wanted is not None and not self._connected:
            self._wanted(False)
