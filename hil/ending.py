"""How a command is ended from outside: Ctrl-C, SIGTERM, the end of its terminal; from its first line to its last.

All of them mean the same.  While modules are imported there is nothing to tidy up, and the process leaves.  Then they
are a KeyboardInterrupt, which `hil.cli` turns into one line; commands with something to show ask for more
(`show.ended_by_signals`).  After the last line they do nothing: what was to be done is done.  Before the first line is
Python's own start (some 30 ms), where a signal is Python's to tell.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from types import FrameType
from typing import Final, NoReturn

#: What ends a command.
SIGNALS: Final = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
#: What a shell gives for a command that Ctrl-C ended.
EXIT_INTERRUPTED: Final = 130
#: Wrappers that forward Ctrl-C to a group deliver it twice; a second one later than this means it.
REPEAT_S: Final = 1.0
#: Processor time that an interrupted command may still take.  Python drops an exception in places (a finaliser); such a
#: command ends within the second, too.
DEADLINE_S: Final = 0.7


def ending_signals() -> tuple[int, ...]:
    """What ends a command here.

    The end of the terminal does not, where nohup had it ignored.  Ctrl-C always does: a shell's `&` in a script ignores
    it too, and whoever sends it to us then means it.
    """
    hangup = getattr(signal, "SIGHUP", None)
    return tuple(each for each in SIGNALS if each != hangup or signal.getsignal(each) is not signal.SIG_IGN)


def leaves() -> None:
    """From now on a signal ends the process as it stands, with one line."""
    _handle(_leave)


def interrupts() -> None:
    """From now on a signal is a KeyboardInterrupt, and what still runs `DEADLINE_S` later is ended."""
    heard: list[float] = []

    def interrupt(_number: int, _frame: FrameType | None) -> None:
        now = time.monotonic()
        if heard and now - heard[-1] < REPEAT_S:
            return
        heard.append(now)
        if hasattr(signal, "setitimer"):
            signal.signal(signal.SIGPROF, _leave)
            signal.setitimer(signal.ITIMER_PROF, DEADLINE_S)
        raise KeyboardInterrupt

    _handle(interrupt)


def ignored() -> None:
    """From now on no signal changes what comes out."""
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_PROF, 0)
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def _handle(handler: signal._HANDLER) -> None:
    for number in ending_signals():
        signal.signal(number, handler)


def _leave(_number: int, _frame: FrameType | None) -> NoReturn:
    os.write(sys.__stderr__.fileno() if sys.__stderr__ else 2, b"hil: error: interrupted\n")
    os._exit(EXIT_INTERRUPTED)
