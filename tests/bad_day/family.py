"""All figures of the bad day."""

from __future__ import annotations

import contextlib
import os
import tempfile

from tests.bad_day import commands, files, serial, signals, view
from tests.bad_day.figure import Figure
from tests.hil.mutants import fuzz


def _no_c() -> str:
    try:
        import pycparser  # noqa: F401
    except ImportError:
        return "needs the extra c: pip install 'c2000-hil[c]'"
    return ""


def _no_fork() -> str:
    return "" if hasattr(os, "fork") else "needs os.fork, which this system lacks"


def _mutant(seed: int) -> str:
    return fuzz.failure(seed // 2, fuzz.LANGUAGES[seed % 2])


FIGURES = (
    Figure("command lines", "values that nobody means, for each option and argument", commands.case, 120, 20, _no_fork),
    Figure("signals", "Ctrl-C, SIGTERM, SIGHUP at any moment of long commands", signals.case, 9, 3, _no_fork),
    Figure("files", "outputs and logs: disk full, no folder, killed", files.case, len(files.OUTPUTS), 13, _no_fork),
    Figure("slow readers", "pseudo-terminal, TCP, RFC 2217, slower than the line", serial.readers, 9, 9, _no_fork),
    Figure("crowds", "ports opened, closed and shouted at by many", serial.crowds, 30, 30, _no_fork),
    Figure("serial bytes", "bytes to the robot that are no orders, or nearly", serial.hostile_bytes, 30, 30),
    Figure("firmware mutants", "drivers broken as people break them", _mutant, 0, 1, _no_c),
    Figure("view", "twenty pages at once, or callers who talk nonsense", view.case, 3, 3, view.missing),
)


def tried(figure: Figure, seed: int) -> str:
    """A case in an empty folder of its own: "" or what went wrong."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        return figure.case(seed)
