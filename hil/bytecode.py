"""A compiled file (`.pyc`) that Python left incomplete: what to do about it.

Python before 3.12.8 keeps what it could write of a compiled file when the disk is full (CPython issue 126606).  From
then on each import of that module ends with an EOFError, which names neither the file nor the remedy.
"""

from __future__ import annotations

import traceback


def incomplete_file(error: EOFError) -> str:
    """The compiled file that an import could not read, "" if it is not that: the importing frame has its path."""
    for frame, _ in traceback.walk_tb(error.__traceback__):
        if frame.f_code.co_filename.startswith("<frozen importlib") and "bytecode_path" in frame.f_locals:
            return str(frame.f_locals["bytecode_path"] or "")
    return ""


def remedy(path: str) -> str:
    """The line for the user."""
    return f"{path}: Python could not write this compiled file whole (a full disk?): delete it, it is made again"
