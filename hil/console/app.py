"""Reads from the source of a console program which packages and which files on a Windows drive it needs.

Only top-level imports count.  The program can run without an import in a function or in a ``try``.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from hil.console.runner import STAND_INS
from hil.files import read_bytes

_DRIVE_PATH = re.compile(r"[A-Za-z]:/[^\n]*")
#: The size of the largest file that is read as a console program.
MAX_BYTES: Final = 4 << 20
#: Modules of Python that are often installed as a package of their own.
_APART: Final = frozenset({"tkinter"})


@dataclass(frozen=True, slots=True)
class App:
    """A console program."""

    path: Path
    #: The top-level packages that it imports and that may be missing.
    packages: tuple[str, ...]
    #: The files that it names with a drive (``C:/...``).  On other systems than Windows, these are relative paths.
    drive_paths: tuple[str, ...]

    @property
    def draws(self) -> bool:
        """Whether it opens windows."""
        return "tkinter" in self.packages


def read_app(path: Path) -> App:
    """Read a program.  Raises ValueError if it is no Python program, OSError if it cannot be read."""
    if path.is_dir():
        inside = path / "main.py"
        raise ValueError(f"{path}: is a folder" + (f"; give {inside}" if inside.is_file() else ""))
    try:
        tree = ast.parse(read_bytes(path, MAX_BYTES), str(path))
    except (SyntaxError, ValueError) as error:  # ValueError: a null byte
        line = getattr(error, "lineno", None)
        where = f", line {line}" if line else ""
        raise ValueError(f"{path}{where}: is no Python program ({getattr(error, 'msg', error)})") from None
    return App(path.resolve(), _packages(tree), _drive_paths(tree))


def _packages(tree: ast.Module) -> tuple[str, ...]:
    known = (sys.stdlib_module_names - _APART) | set(STAND_INS)
    return tuple(sorted({name for name in _imports(tree.body) if name not in known}))


def _imports(body: list[ast.stmt]) -> Iterator[str]:
    for statement in body:
        if isinstance(statement, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in statement.names)
        elif isinstance(statement, ast.ImportFrom) and statement.module and not statement.level:
            yield statement.module.partition(".")[0]


def _drive_paths(tree: ast.Module) -> tuple[str, ...]:
    texts = (node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str))
    return tuple(sorted({text for text in texts if _DRIVE_PATH.fullmatch(text)}))
