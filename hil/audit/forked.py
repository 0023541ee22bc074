"""Calls functions in child processes that begin as copies of this one, with everything that is linked and booted here.

The return value comes back by pickle over a pipe.  A child never returns into the code that forked it, leaves no
zombie, and ends when its parent does not wait for it any more.
"""

from __future__ import annotations

import contextlib
import gc
import os
import pickle
import selectors
import signal
import threading
from collections.abc import Callable, Generator, Iterable
from typing import Any, Final, NoReturn, TypeVar

from hil.ending import SIGNALS

_PIECE: Final = 1 << 16

Key = TypeVar("Key")


class ChildDied(Exception):
    """A child gave no result; the message says why, in one line."""


def possible() -> bool:
    """Whether this process can be copied: the system supports it, and there is no other thread, which a copy lacks."""
    return hasattr(os, "fork") and threading.active_count() == 1


class Child:
    """A process that calls `function` and hands over what it returns."""

    def __init__(self, function: Callable[[], Any]) -> None:
        self._pieces: list[bytes] = []
        self._read, write = os.pipe()
        try:
            self._pid = os.fork()
            if self._pid == 0:
                os.close(self._read)  # or it would wait for a reader that is itself, if its parent is killed
                _live(function, write)
        except OSError:
            os.close(self._read)
            raise
        finally:
            os.close(write)

    def fileno(self) -> int:
        """The file descriptor that becomes readable when there is something for `receive`."""
        return self._read

    def receive(self) -> bool:
        """Take the data that has come; wait if there is none.  Returns True when all has come."""
        piece = os.read(self._read, _PIECE)
        self._pieces.append(piece)
        return not piece

    def result(self) -> Any:
        """The return value, once all was received.  Raises ChildDied if there is none, or if the function raised."""
        status = self._reap()
        try:
            returned, value = pickle.loads(b"".join(self._pieces))
        except (EOFError, pickle.UnpicklingError):
            raise ChildDied(_ended(status)) from None
        if not returned:
            raise ChildDied(value)
        return value

    def end(self) -> None:
        """Kill the process if it still runs, and forget it."""
        if self._pid:
            with contextlib.suppress(ProcessLookupError):
                os.kill(self._pid, signal.SIGKILL)
            self._reap()

    def _reap(self) -> int:
        os.close(self._read)
        _, status = os.waitpid(self._pid, 0)
        self._pid = 0
        return status


def _live(function: Callable[[], Any], write: int) -> NoReturn:
    """The whole run of a child.  Its parent's stack is below it, and it must not return there."""
    status = 1
    try:
        for number in SIGNALS:
            signal.signal(number, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)
        gc.disable()  # it lives for seconds; to collect is to copy every page that it shares with its parent
        try:
            answer = pickle.dumps((True, function()))
        except Exception as error:
            answer = pickle.dumps((False, f"{type(error).__name__}: {error}"))
        with os.fdopen(write, "wb") as pipe:
            pipe.write(answer)
        status = 0
    finally:
        os._exit(status)


def _ended(status: int) -> str:
    """How a process without a result ended, from its wait status."""
    code = os.waitstatus_to_exitcode(status)
    if code >= 0:
        return f"its process ended with status {code} and gave no result"
    return f"its process was killed by {signal.Signals(-code).name}"


@contextlib.contextmanager
def _undisturbed() -> Generator[None, None, None]:
    """Hold signals that end a command back until a new child is known, so that no child is left behind."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def in_child(function: Callable[[], Any]) -> Any:
    """The return value of `function`, called in its own child.  Raises ChildDied."""
    child = Child(function)
    try:
        while not child.receive():
            pass
        return child.result()
    finally:
        child.end()


def in_children(
    calls: Iterable[tuple[Key, Callable[[], Any]]], *, at_once: int
) -> Generator[tuple[Key, Any], None, None]:
    """Each call's key, and its result or the ChildDied, as they come; at most `at_once` run side by side.

    A call is taken when a child is free for it, so it finds everything that was prepared before.  Closing the generator
    ends every child.
    """
    waiting = iter(calls)
    running: dict[Child, Key] = {}
    with selectors.DefaultSelector() as selector:
        try:
            while True:
                while len(running) < at_once and (call := next(waiting, None)) is not None:
                    with _undisturbed():
                        child = Child(call[1])
                        running[child] = call[0]
                    selector.register(child, selectors.EVENT_READ)
                if not running:
                    return
                for ready, _ in selector.select():
                    child = ready.fileobj  # type: ignore[assignment]
                    if not child.receive():
                        continue
                    selector.unregister(child)
                    key = running[child]
                    try:
                        result: Any = child.result()
                    except ChildDied as died:
                        result = died
                    del running[child]
                    yield key, result
        finally:
            for child in running:
                child.end()
