"""Who is told of the accesses of a program to its objects, in an image that is linked with `watch`."""

from __future__ import annotations

from collections.abc import Callable

from emulator.c28x.memory import Object


class Watcher:
    """Is told of each access to a file-scope object, or to a local whose address was taken, right before it happens.

    This one lets every access pass: where the statements of the image are followed instead.
    """

    __slots__ = ()

    def touch(self, obj: Object, word: int, write: bool) -> None:
        """The running function reads or writes the scalar at word `word` of an object."""


class CallingWatcher(Watcher):
    """Calls a function, `told(object, word, write)`."""

    __slots__ = ("_told",)

    def __init__(self, told: Callable[[Object, int, bool], None]) -> None:
        self._told = told

    def touch(self, obj: Object, word: int, write: bool) -> None:
        """Tell it."""
        self._told(obj, word, write)
