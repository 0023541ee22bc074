"""Commands from other threads to the machine's thread: one queue, in which some wait until the machine is at rest."""

from __future__ import annotations

import queue
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Final

#: The longest wait of a thread that has nothing to do.
WAIT_S: Final = 0.25


@dataclass(slots=True)
class _Command:
    done: Future[Any]
    work: Callable[[], Any]
    #: Whether it changes the run; then it runs only while the machine is at rest.
    changes: bool


class Commands:
    """A queue that any thread fills and one thread empties."""

    def __init__(self) -> None:
        self._queue: queue.SimpleQueue[_Command] = queue.SimpleQueue()
        self._deferred: list[_Command] = []
        self._closed = False

    def put(self, work: Callable[[], Any], *, changes: bool = False) -> Future[Any]:
        """Queue `work()`.  The future gets its result or error; it is cancelled when the queue has ended."""
        done: Future[Any] = Future()
        self._queue.put(_Command(done, work, changes))
        if self._closed:
            self.cancel()
        return done

    def serve(self, *, at_rest: bool, wait: bool = False) -> int:
        """Run the queued commands; with `wait`, wait a while for the first.  Returns the number of commands that ran.

        Without `at_rest`, commands that change the run stay queued.
        """
        count = 0
        if at_rest:
            waiting, self._deferred = self._deferred, []
            for command in waiting:
                count += _do(command)
        while True:
            try:
                command = self._queue.get(timeout=WAIT_S) if wait else self._queue.get_nowait()
            except queue.Empty:
                return count
            wait = False
            if command.changes and not at_rest:
                self._deferred.append(command)
            else:
                count += _do(command)

    def cancel(self) -> None:
        """Cancel all queued commands, and those that are queued later."""
        self._closed = True
        waiting, self._deferred = self._deferred, []
        with suppress(queue.Empty):
            while True:
                waiting.append(self._queue.get_nowait())
        for command in waiting:
            command.done.cancel()


def _do(command: _Command) -> bool:
    if not command.done.set_running_or_notify_cancel():
        return False
    try:
        command.done.set_result(command.work())
    except Exception as error:
        command.done.set_exception(error)
    return True
