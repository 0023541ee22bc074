"""`msvcrt` for a terminal: keys one by one, without waiting for Enter.

As Microsoft's C runtime has it (Python's library reference, msvcrt, "Console I/O"); file operations are not modelled.
Arrow keys arrive as the terminal's escape sequences, not as Windows' two-byte codes.
"""

from __future__ import annotations

import os
import select
import sys
import termios
import tty
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def _unbuffered() -> Iterator[int]:
    """Standard input, handing over each key at once and without echo while this lasts."""
    fd = sys.stdin.fileno()
    if not os.isatty(fd):
        yield fd
        return
    before = termios.tcgetattr(fd)
    try:
        tty.setcbreak(fd, termios.TCSANOW)
        yield fd
    finally:
        termios.tcsetattr(fd, termios.TCSANOW, before)


def kbhit() -> bool:
    """Whether a key waits."""
    with _unbuffered() as fd:
        return bool(select.select([fd], [], [], 0)[0])


def getch() -> bytes:
    """Wait for a key and return its byte; nothing is shown.  Ctrl-C raises KeyboardInterrupt, as in a terminal."""
    with _unbuffered() as fd:
        return os.read(fd, 1)


def getche() -> bytes:
    """`getch`, with echo."""
    key = getch()
    putch(key)
    return key


def getwch() -> str:
    """`getch` for a character of any alphabet."""
    data = getch()
    while data:
        try:
            return data.decode("utf-8")
        except UnicodeDecodeError as error:
            if error.reason != "unexpected end of data":
                return "\ufffd"
            data += getch()
    return ""


def putch(char: bytes) -> None:
    """Print a byte at once."""
    sys.stdout.flush()
    os.write(sys.stdout.fileno(), char)


def putwch(char: str) -> None:
    """`putch` for a character of any alphabet."""
    putch(char.encode("utf-8"))
