"""Files that a user names: read whole and within bounds, written whole or not at all."""

from __future__ import annotations

import errno
import json
import os
import re
import shutil
import stat
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO, Final, TextIO, TypeAlias

#: Larger than any scenario, map, table or baseline that somebody writes; a log of a day fits, too.
MAX_BYTES: Final = 64 << 20
_AT_LINE: Final = re.compile(r" \(at line (\d+), column \d+\)")
# A FIFO that nobody writes to would keep a plain open waiting.
_FLAGS: Final = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)


#: What writes a file each.
Writes: TypeAlias = list[Callable[[], object]]


class NotWritten(OSError):
    """A file that could not be written; it names the file."""


def opened(path: str | Path) -> BinaryIO:
    """A plain file to read from.  Raises ValueError, naming it, for anything else; OSError."""
    handle = os.open(path, _FLAGS)
    if not stat.S_ISREG(os.fstat(handle).st_mode):
        os.close(handle)
        raise ValueError(f"{path}: not a plain file")
    return open(handle, "rb")


def read_bytes(path: str | Path, most: int = MAX_BYTES) -> bytes:
    """The whole of a plain file: a device could go on for ever.

    Raises ValueError, naming the file, for anything else and for more than `most` bytes; OSError.
    """
    with opened(path) as file:
        content = file.read(most + 1)
    if len(content) > most:
        raise ValueError(f"{path}: larger than {most:,} bytes")
    return content


def read_text(path: str | Path, most: int = MAX_BYTES) -> str:
    """The same as text, without a byte order mark.  Raises ValueError, naming the file and the byte, for no UTF-8."""
    try:
        return read_bytes(path, most).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{path}: byte {error.start} is not UTF-8; save the file as UTF-8 text") from None


def parse_toml(content: str, file: str) -> dict[str, Any]:
    """The table of a TOML text.  Raises ValueError naming the file, and the line where there is one."""
    try:
        return tomllib.loads(content)
    except RecursionError:
        raise ValueError(f"{file}: brackets are nested too deeply") from None
    except tomllib.TOMLDecodeError as error:
        text = str(error)
        found = _AT_LINE.search(text)
        line = int(found[1]) if found else len(content.splitlines()) or 1
        raise ValueError(f"{file}:{line}: not TOML: {_AT_LINE.sub('', text)}") from None
    except ValueError:
        raise ValueError(f"{file}: a number has thousands of digits") from None


def parse_json(content: str, file: str) -> Any:
    """What a JSON text says.  Raises ValueError naming the file, and the line where there is one."""
    try:
        return json.loads(content)
    except RecursionError:
        raise ValueError(f"{file}: brackets are nested too deeply") from None
    except json.JSONDecodeError as error:
        raise ValueError(f"{file}:{error.lineno}: not JSON: {error.msg}") from None
    except ValueError:
        raise ValueError(f"{file}: a number has thousands of digits") from None


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """A path to write to.  What was written replaces `path` when the block ends, and leaves no trace if it fails.

    A device, a pipe that somebody reads, is written to directly.  Raises NotWritten.
    """
    target = _target(path)
    plain = target.is_file() or not target.exists()
    # With the suffix, which tells libraries the format.
    new = target.with_name(f".{target.stem[:100]}.{os.getpid()}{target.suffix}") if plain else Path(path)
    pipe = None if plain or not target.is_fifo() else _reached(path)
    try:
        yield new
        if plain:
            if target.exists():
                shutil.copymode(target, new)
            os.replace(new, target)
    except OSError as error:
        if error.filename not in (None, str(new)):
            raise  # of another file
        raise NotWritten(error.errno, error.strerror or str(error), str(path)) from error
    finally:
        if plain:
            new.unlink(missing_ok=True)
        if pipe is not None:
            os.close(pipe)


@contextmanager
def at_last() -> Iterator[Writes]:
    """A list for what writes files: called when the block ends, after it has told its results.

    Each is tried, whatever becomes of the others.  Raises the last NotWritten; those before are its context.
    """
    writes: Writes = []
    try:
        yield writes
    finally:
        _each(writes)


def _each(writes: Writes) -> None:
    if writes:
        try:
            writes[0]()
        finally:
            _each(writes[1:])


class GrowingFile:
    """A text file that takes what it can.  A full disk ends the file, not what is told in it: writing never raises."""

    def __init__(self, path: str | Path, file: TextIO) -> None:
        """`path` is how errors name it."""
        self._path = path
        self._file = file
        self._failed: NotWritten | None = None

    def write(self, text: str) -> None:
        """More text, as long as the file takes it."""
        self._try(lambda: self._file.write(text))

    def flush(self) -> None:
        """Hand over to the system what was written."""
        self._try(self._file.flush)

    def failure(self) -> NotWritten | None:
        """Why the file is not whole; it names the file."""
        self.flush()
        return self._failed

    def _try(self, act: Callable[[], object]) -> None:
        if self._failed is None:
            try:
                act()
            except OSError as error:
                self._failed = NotWritten(error.errno, error.strerror or str(error), str(self._path))


@contextmanager
def growing(path: str | Path, encoding: str) -> Iterator[GrowingFile]:
    """A text file that grows while something runs, empty at first.

    Raises OSError if it cannot be opened, for a pipe that nobody reads; NotWritten at the end if it did not take
    everything.
    """
    pipe = _reached(path) if Path(path).is_fifo() else None
    failed = None
    try:
        with open(path, "w", encoding=encoding, newline="\n") as file:
            log = GrowingFile(path, file)
            try:
                yield log
            finally:
                failed = log.failure()
    except OSError:
        if failed is None:  # else it is the same, told again by `close`
            raise
    finally:
        if pipe is not None:
            os.close(pipe)
    if failed is not None:
        raise failed


def check_target(path: str | Path) -> None:
    """Raise ValueError, before anything runs, if it is plain that no file can be written there."""
    try:
        target = _target(path)
    except OSError as error:
        raise ValueError(f"{path}: {error.strerror}") from None
    if not target.parent.is_dir():
        raise ValueError(f"{path}: there is no folder {target.parent}")
    if target.is_dir():
        raise ValueError(f"{path}: it is a folder; expected the name of a file")


def _target(path: str | Path) -> Path:
    """Where a path leads: a link stays one.  Raises OSError for links in a circle."""
    try:
        return Path(path).resolve()
    except (RuntimeError, OSError) as error:  # RuntimeError before Python 3.13
        raise OSError(errno.ELOOP, "the links form a loop", str(path)) from error


def _reached(path: str | Path) -> int:
    """The near end of a named pipe.  Raises OSError where nobody reads it: to wait for that could take for ever."""
    try:
        return os.open(path, os.O_WRONLY | os.O_NONBLOCK)
    except OSError as error:
        if error.errno == errno.ENXIO:
            raise OSError(error.errno, "nobody reads this pipe", str(path)) from None
        raise
