"""The output of an eCAP in APWM mode, as the X-BARs take it: ECAPn.OUT.

Part of `ecap.py`, which reports changes to it.
"""

from __future__ import annotations

from collections.abc import Callable

from emulator.signal import Signal


class ApwmOutput:
    """The level of the output.  `look()` returns it; `wanted(on)` requests its changes while there are listeners."""

    __slots__ = ("_look", "_reported", "_wanted", "changed", "has_listeners")

    def __init__(self, look: Callable[[], int], wanted: Callable[[], None]) -> None:
        self._look, self._wanted = look, wanted
        self._reported = 0
        #: Whether there are listeners to the changes.
        self.has_listeners = False
        #: (level): every change, while there is a listener.
        self.changed: Signal[int] = Signal(self._listened)

    @property
    def level(self) -> int:
        """The level now."""
        return self._look()

    def report_level(self) -> None:
        """The level may have changed: report a change to the listeners."""
        level = self._look()
        if level != self._reported:
            self._reported = level
            self.changed.emit(level)

    def _listened(self, on: bool) -> None:
        self.has_listeners = on
        self._reported = self._look()
        self._wanted()
