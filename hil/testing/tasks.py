"""The fixture `kernel`: a user's own `main` and tasks under SYS/BIOS, without the robot's.

Functions of the firmware, and plain Python functions that call the kernel's (`kernel.Semaphore_pend(...)`), are tasks
alike.  Nothing runs before time is moved: `advance`, `until`.
"""

from __future__ import annotations

from collections.abc import Callable
from inspect import unwrap
from typing import Any, Final

from emulator.sysbios.kernel import Kernel
from emulator.sysbios.scheduler import Task
from hil.board import Board
from hil.testing.timeline import Timeline

STACK_WORDS: Final = 512


class Tasks:
    """A kernel that a test fills and starts.  Every C function of SYS/BIOS is an attribute."""

    def __init__(self, board: Board, timeline: Timeline) -> None:
        self.kernel: Kernel = board.kernel
        self._board = board
        self._timeline = timeline
        self._started = False

    def __getattr__(self, name: str) -> Any:
        return getattr(self.kernel, name)

    def task(
        self, function: Callable[..., Any], *, priority: int = 1, name: str = "", stack_words: int = STACK_WORDS,
        arg0: int = 0, arg1: int = 0,
    ) -> Task:  # fmt: skip
        """A task, as `Task_create` in `main` makes it; before `start`.  Raises ValueError for a wrong priority."""
        if self._started:
            raise ValueError("create tasks before start(); after it, only the firmware creates them, with Task_create")
        if not 1 <= priority <= 15:
            raise ValueError(f"priority {priority}: 1 to 15")
        tasks = self.kernel.tasks
        stack = tasks.stacks.allocate(stack_words, 0, None, (arg0, arg1))
        assert stack is not None
        return tasks.add(translated(function), priority, stack, (arg0, arg1), True, name)

    def start(self, main: Callable[[], Any] | None = None) -> None:
        """Begin with the firmware's `main`, or with `BIOS_start` for the tasks that were made here.

        It has run up to its first moment of time; what follows needs `advance` or `until`.
        """
        if self._started:
            raise ValueError("the kernel was started already")
        self._started = True
        clock = self._board.clock
        clock.schedule(clock.now, self.kernel.pause)
        self._timeline.run_kernel()
        self.kernel.start(self.kernel.BIOS_start if main is None else translated(main))

    def named(self, name: str) -> Task:
        """The task of a name.  Raises ValueError."""
        for task in self.kernel.tasks.all:
            if task.name == name:
                return task
        raise ValueError(f"no task {name}: {', '.join(task.name for task in self.kernel.tasks.all) or 'none exists'}")


def translated(function: Callable[..., Any]) -> Callable[..., Any]:
    """What the kernel calls for a function of a linked image (`firmware.app.main`); any other as it is."""
    inner: Callable[..., Any] = unwrap(getattr(function, "translated", function))
    return inner
