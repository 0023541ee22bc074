"""The output of an eCAP in APWM mode, as the X-BARs take it: ECAPn.OUT.

Part of `ecap.py`, which tells it.
"""

from __future__ import annotations

from collections.abc import Callable

from emulator.signal import Signal


class ApwmOutput:
    """The level now, by `look()`, and its changes, which `wanted(on)` requests while there are listeners."""

    __slots__ = ("_look", "_told", "_wanted", "changed", "heard")

    def __init__(self, look: Callable[[], int], wanted: Callable[[], None]) -> None:
        self._look, self._wanted = look, wanted
        self._told = 0
        #: Somebody hears the changes.
        self.heard = False
        #: (level): every change, while somebody hears it.
        self.changed: Signal[int] = Signal(self._listened)

    @property
    def level(self) -> int:
        """The level now."""
        return self._look()

    def tell(self) -> None:
        """The level may have changed."""
        level = self._look()
        if level != self._told:
            self._told = level
            self.changed.emit(level)

    def _listened(self, on: bool) -> None:
        self.heard = on
        self._told = self._look()
        self._wanted()
