"""One way to listen: each kind of event is a `Signal`, and listeners connect to it.

    disconnect = wire.changed.connect(listener)    # listener(level) at every change from now on
    disconnect()                                   # and no more

The owner calls `emit(...)`.  Where speed matters, it writes out the loop of `emit` itself.

    for listener in self.changed.listeners:
        listener(level)

Listeners are called in the order in which they connected.  An emission goes to those that were connected when it began.
A listener that connects meanwhile gets the next emission; one that disconnects meanwhile may still get this one.  A
function that is connected twice is called twice.  Each `disconnect` ends its own connection; calling it again does
nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Generic, ParamSpec

P = ParamSpec("P")


class Signal(Generic[P]):
    """A kind of event, reported to any number of listeners.

    `wanted(True)` is called before the first listener connects, `wanted(False)` when the last one has gone.  So an
    owner can do work for the signal only while there are listeners.
    """

    __slots__ = ("_connected", "_latest", "_wanted", "listeners")

    def __init__(self, wanted: Callable[[bool], None] | None = None) -> None:
        #: The listeners in their order.  It is a new tuple after every connection and disconnection.
        self.listeners: tuple[Callable[P, object], ...] = ()
        self._wanted = wanted
        self._connected: dict[int, Callable[P, object]] = {}
        self._latest = 0

    def connect(self, listener: Callable[P, object]) -> Callable[[], None]:
        """Call `listener` at every emission from now on.  Returns a function that ends this."""
        if self._wanted is not None and not self._connected:
            self._wanted(True)
        self._latest += 1
        self._connected[self._latest] = listener
        self.listeners = tuple(self._connected.values())
        return partial(self._disconnect, self._latest)

    def emit(self, *args: P.args, **kwargs: P.kwargs) -> None:
        """Call all listeners."""
        for listener in self.listeners:
            listener(*args, **kwargs)

    def _disconnect(self, connection: int) -> None:
        if self._connected.pop(connection, None) is None:
            return
        self.listeners = tuple(self._connected.values())
        if self._wanted is not None and not self._connected:
            self._wanted(False)
