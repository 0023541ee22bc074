"""What a figure of the bad day is: cases by seed, each of which says what went wrong with it."""

from __future__ import annotations

import os
import resource
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

# Imported here, so that a child that is forked finds everything in memory.
import hil.audit.run
import hil.bench
import hil.drivers.check
import hil.instruments.export
import hil.page.page
import hil.recording.plot
import hil.reports.html
import hil.rta.picture
import hil.scenarios.running  # noqa: F401
from tests.hil.waiting import TIMEOUT_S

REPOSITORY = Path(__file__).parents[2]


class Figure(NamedTuple):
    """A kind of bad luck."""

    name: str
    about: str
    #: The case of a seed, in an empty folder that is the working directory: "" or what went wrong.
    case: Callable[[int], str]
    #: How many cases a run of all tests takes, and how many of them one test.
    few: int
    batch: int
    #: Why it cannot be run here; "" if it can.
    missing: Callable[[], str] = lambda: ""


class Outcome(NamedTuple):
    """What a command line came to: `status` is negative for a signal."""

    status: int
    error: str
    grown_bytes: int
    cpu_s: float


def forked(command: Callable[[], int], timeout_s: float = TIMEOUT_S) -> Outcome:
    """Run something in a child that has no input and a limited time; its output is lost."""
    before = int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()
    # A pipe: files of the child may be limited.
    read, write = os.pipe()
    child = os.fork()
    if not child:
        status = 99
        try:
            os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
            os.dup2(write, 2)
            os.close(write)
            sys.stdout, sys.stderr = os.fdopen(1, "w"), os.fdopen(2, "w")
            signal.signal(signal.SIGALRM, signal.SIG_DFL)
            signal.setitimer(signal.ITIMER_REAL, timeout_s)
            status = command()
            sys.stdout.flush()
            sys.stderr.flush()
        finally:
            os._exit(status)
    os.close(write)
    with open(read, "rb") as said:
        error = said.read().decode("utf-8", "replace")
    _, waited, used = os.wait4(child, 0)
    cpu_s = used.ru_utime + used.ru_stime
    return Outcome(os.waitstatus_to_exitcode(waited), error, used.ru_maxrss * 1024 - before, cpu_s)


def short(arguments: tuple[str, ...]) -> str:
    """A command line as it is shown."""
    return " ".join(each if len(each) < 40 else f"{each[:20]}..." for each in arguments)
