"""Runs tasks of the firmware by hand: a given number of turns of a task's endless loop, without a kernel."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from typing import Any

from hil.audit.rig import Rig, Variant


class _TurnsDoneError(Exception):
    """The task has made its turns."""


class TaskRig(Rig):
    """A rig on which tasks run.  Gates are always free, a pend is one turn, calls that start peripherals are left out.

    `each_turn()` is called before each turn.
    """

    def __init__(
        self, fixes: Variant | Iterable[str], each_turn: Callable[[], None] = lambda: None,
        **externs: Callable[..., Any],
    ) -> None:  # fmt: skip
        self._left = 0
        self._each_turn = each_turn

        def nothing(*_arguments: Any) -> int:
            return 0

        idle = dict.fromkeys(
            ("GateMutexPri_enter", "GateMutexPri_leave", "Clock_start", "Log_write1", "Send_ODO_Trayect"), nothing
        )
        super().__init__(fixes, externs=idle | {"Semaphore_pend": self._pend} | externs)

    def _pend(self, _semaphore: Any, _timeout: int) -> int:
        if self._left == 0:
            raise _TurnsDoneError
        self._left -= 1
        self._each_turn()
        return 1

    def turns(self, task: str, count: int = 1) -> None:
        """Run `task` from its start until it has made `count` turns."""
        self._left = count
        with suppress(_TurnsDoneError):
            getattr(self.fw.main_robot, task)(0, 0)
