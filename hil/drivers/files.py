"""Finds the driver files to check: files by name, and the driver files directly in a folder."""

from __future__ import annotations

import stat
from collections.abc import Iterable
from pathlib import Path
from typing import Final

from hil.image import SUFFIXES

#: A larger file is not accepted as a driver.
LARGEST_BYTES: Final = 2_000_000
#: A Python file in a folder is a driver only if it mentions this.
_MARK: Final = "emulator.c28x.language"
_ENDINGS: Final = " or ".join(f"*{suffix}" for suffix in SUFFIXES)


def is_driver_name(path: Path) -> bool:
    """Whether a file of this name is a driver file."""
    return path.suffix.lower() in SUFFIXES


def driver_files(paths: Iterable[Path]) -> list[Path]:
    """The driver files of `paths`, each once, in their order; those of a folder by name.

    Raises ValueError, one line with the path, for a path that is no driver; OSError for one that cannot be read.
    """
    found: dict[Path, Path] = {}
    for path in paths:
        for file in _of_folder(path) if path.is_dir() else [path]:
            _regular(file)
            found.setdefault(file.resolve(), file)
    return list(found.values())


def _of_folder(folder: Path) -> list[Path]:
    files = [file for file in sorted(folder.iterdir()) if is_driver_name(file) and not file.is_dir()]
    files = [file for file in files if file.suffix != ".py" or _mentions(file)]
    if not files:
        raise ValueError(f"{folder}: no driver files ({_ENDINGS}) lie directly in this folder")
    return files


def _mentions(file: Path) -> bool:
    mode = file.stat().st_mode
    return stat.S_ISREG(mode) and _MARK in file.read_bytes()[:LARGEST_BYTES].decode(errors="replace")


def _regular(file: Path) -> None:
    if not file.exists():
        raise ValueError(f"{file}: there is no such file")
    if not is_driver_name(file):
        raise ValueError(f"{file}: not a driver file: expected {_ENDINGS}, or a folder of them")
    status = file.stat()
    if not stat.S_ISREG(status.st_mode):
        raise ValueError(f"{file}: not a plain file")
    if status.st_size > LARGEST_BYTES:
        raise ValueError(f"{file}: {status.st_size} bytes: no driver is larger than {LARGEST_BYTES}")


def folders(given: Iterable[Path]) -> list[Path]:
    """Folders of headers (`-I`).  Raises ValueError for one that is none."""
    listed = list(given)
    for folder in listed:
        if not folder.is_dir():
            raise ValueError(f"-I {folder}: there is no such folder")
    return listed


def defines(given: Iterable[str]) -> list[str]:
    """Macros (`-D NAME`, `-D NAME=VALUE`).  Raises ValueError for a name that is not valid."""
    listed = list(given)
    for define in listed:
        name = define.partition("=")[0]
        if not (name.isidentifier() and name.isascii()):
            raise ValueError(f"-D {define}: expected NAME or NAME=VALUE")
    return listed
