"""The output of an eCAP in APWM mode, as the X-BARs take it: ECAPn.OUT.

Part of `ecap.py`, which reports changes to it.
"""

from __future__ import annotations

from collections.abc import Callable

from emulator.signal import Signal


class ApwmOutput:
    """The level of the output.  `look()` returns it; `wanted(on)` requests its changes while there are listeners."""

    __slots__ = ("_look", "_told", "_wanted", "changed", "heard")

    def __init__(self, look: Callable[[], int], wanted: Callable[[], None]) -> None:
        self._look, self._wanted = look, wanted
        self._told = 0
        #: Whether there are listeners to the changes.
        self.heard = False
        #: (level): every change, while there is a listener.
        self.changed: Signal[int] = Signal(self._listened)

    @property
    def level(self) -> int:
        """The level now."""
        return self._look()

    def tell(self) -> None:
        """The level may have changed: report a change to the listeners."""
        level = self._look()
        if level != self._told:
            self._told = level
            self.changed.emit(level)

    def _listened(self, on: bool) -> None:
        self.heard = on
        self._told = self._look()
        self._wanted()
