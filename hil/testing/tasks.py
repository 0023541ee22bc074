"""The fixture `kernel`: a user's own `main` and tasks under SYS/BIOS, without the robot's firmware.

Functions of the firmware can be tasks, and so can Python functions that call the kernel's functions
(`kernel.Semaphore_pend(...)`).  They run only while time passes: `advance`, `until`.
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
    """A kernel whose tasks a test creates and starts.  Every C function of SYS/BIOS is an attribute."""

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
        """Create a task, as `Task_create` in `main` does.  Call it before `start`.

        Raises ValueError for a wrong priority.
        """
        if self._started:
            raise ValueError("create tasks before start(); after it, only the firmware creates them, with Task_create")
        if not 1 <= priority <= 15:
            raise ValueError(f"priority {priority}: 1 to 15")
        tasks = self.kernel.tasks
        stack = tasks.stacks.allocate(stack_words, 0, None, (arg0, arg1))
        assert stack is not None
        return tasks.add(translated(function), priority, stack, (arg0, arg1), True, name)

    def start(self, main: Callable[[], Any] | None = None) -> None:
        """Start with the firmware's `main`, or with `BIOS_start` for the tasks that were created here.

        The kernel runs until virtual time would pass.  Then call `advance` or `until`.
        """
        if self._started:
            raise ValueError("the kernel was started already")
        self._started = True
        clock = self._board.clock
        clock.schedule(clock.now, self.kernel.pause)
        self._timeline.run_kernel()
        self.kernel.start(self.kernel.BIOS_start if main is None else translated(main))

    def named(self, name: str) -> Task:
        """The task with a name.  Raises ValueError if there is none."""
        for task in self.kernel.tasks.all:
            if task.name == name:
                return task
        raise ValueError(f"no task {name}: {', '.join(task.name for task in self.kernel.tasks.all) or 'none exists'}")


def translated(function: Callable[..., Any]) -> Callable[..., Any]:
    """The function that the kernel calls for a function of a linked image (`firmware.app.main`); others unchanged."""
    inner: Callable[..., Any] = unwrap(getattr(function, "translated", function))
    return inner
