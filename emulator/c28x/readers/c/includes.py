"""The headers that a C file may read: found in any case, and never outside of the given folders.

A name is split at `/` and `\\` and followed from one of the allowed folders, using only listings of folders.  No name
reaches the file system before it is known to be below an allowed folder.  Links are resolved before a file is opened,
and only regular files are opened.
"""

from __future__ import annotations

import codecs
import os
import re
import stat
from collections.abc import Callable, Iterable
from functools import lru_cache
from pathlib import Path

from emulator.c28x.readers.c.tokens import SourceText

#: With these flags, open neither waits for a pipe that has replaced the file, nor follows a link.
_FLAGS = os.O_RDONLY
for _name in ("O_NONBLOCK", "O_NOFOLLOW", "O_BINARY", "O_CLOEXEC"):
    _FLAGS |= getattr(os, _name, 0)
_DRIVE = re.compile(r"[A-Za-z]:")
#: Names of headers of the device.
_OF_DEVICE = re.compile(r"f28x_project\.h$|f2837x[sd]_")


@lru_cache(maxsize=64)
def _header_of_emulator(name: str, text: str) -> SourceText:
    """One of our headers, which is not a file."""
    return SourceText(f"<{name}>", text, keep=True)


def _below(path: str, root: str) -> list[str]:
    """The parts of a path below the folder `root`, which contains it."""
    return path.split(os.sep)[len(root.rstrip(os.sep).split(os.sep)) :]


class Refused(Exception):
    """A file is not read; the text says why."""


class IncludePath:
    """The search path of headers: the source folders, the folders of `-I` in order, and our own headers."""

    def __init__(
        self, sources: Iterable[str | Path], folders: Iterable[str | Path], builtin: Callable[[str], str | None],
        file_bytes: int, fallback: Callable[[str], str | None] = lambda name: None,
        standard: Callable[[str], bool] = lambda name: False,
    ) -> None:  # fmt: skip
        """`builtin` is called before any folder is searched, `fallback` after; the name is in lower case, with `/`.

        A header of C's library (`standard`) is not built in if the name is in quotes and the folder of the including
        file has a file of that name.  A file may have at most `file_bytes`.
        """
        self._builtin = builtin
        self._fallback = fallback
        self._standard = standard
        self._file_bytes = file_bytes
        #: Resolved folder -> the folder as the user wrote it.
        self._roots: dict[str, str] = {}
        self._sources = [self._root(folder) for folder in sources]
        self._folders = [self._root(folder) for folder in folders]
        self._listings: dict[str, tuple[set[str], dict[str, str]]] = {}
        self._found: dict[tuple[str, bool, str | None], SourceText] = {}
        self._read: dict[str, SourceText] = {}

    def _root(self, folder: str | Path) -> str:
        real = os.path.realpath(folder)
        self._roots.setdefault(real, str(folder))
        return real

    def main(self, path: str | Path) -> SourceText:
        """The file to translate.  Raises Refused."""
        real = os.path.realpath(path)
        if not self._allowed(real):
            raise Refused(f"it is a link to {real}, outside its folder: name that folder with -I")
        return self._open(real, str(path))

    def find(self, name: str, quoted: bool, folder: str | None) -> SourceText:
        """The header `name`, included by a file in `folder`.  Raises Refused."""
        key = (name, quoted, folder)
        if (known := self._found.get(key)) is None:
            known = self._found[key] = self._find(name, quoted, folder)
        return known

    def _find(self, name: str, quoted: bool, folder: str | None) -> SourceText:
        name = name.replace("\\", "/")
        if not name or "\0" in name:
            raise Refused("that is not a file name")
        beside = quoted and folder is not None and self._standard(name.lower()) and self._lies_in(folder, name)
        if not beside and (text := self._builtin(name.lower())) is not None:
            return _header_of_emulator(name, text)
        last = name.lower().rpartition("/")[2]
        if _OF_DEVICE.match(last) and (text := self._builtin(last)) is not None:
            return _header_of_emulator(last, text)  # with the way to it, as projects with a copy of TI's headers write
        absolute = name.startswith("/") or _DRIVE.match(name) is not None
        if absolute:
            places = [""]
        elif quoted:
            places = [*([folder] if folder else []), *self._sources, *self._folders]
        else:
            places = [*self._folders, *self._sources]
        outside = False
        for place in dict.fromkeys(places):
            target = os.path.normpath(os.path.join(place, name))
            root = self._root_of(target)
            if root is None:
                outside = True
                continue
            path = self._follow(root, _below(target, root))
            if path is None:
                continue
            real = os.path.realpath(path)
            if not self._allowed(real):
                raise Refused(f"{name} is a link to {real}, outside the include path: name its folder with -I FOLDER")
            return self._open(real, os.path.join(self._roots[root], os.path.relpath(path, root)))
        if (text := self._fallback(name.lower())) is not None:
            return _header_of_emulator(name, text)
        if outside:
            raise Refused(f"{name} leaves the include path: name its folder with -I FOLDER")
        made = " (SysConfig makes it: name the folder syscfg of a build)" if name.lower() == "board.h" else ""
        raise Refused(f"there is no header {name}: name its folder with -I FOLDER{made}")

    def _lies_in(self, folder: str, name: str) -> bool:
        """Whether the file `name` exists in `folder` or below it, within the allowed folders.  Raises Refused."""
        target = os.path.normpath(os.path.join(folder, name))
        root = self._root_of(target)
        return root is not None and self._follow(root, _below(target, root)) is not None

    def _root_of(self, path: str) -> str | None:
        """The innermost allowed folder that contains `path`.  Case is ignored here; the listings decide later."""
        folded = path.casefold()
        found = None
        for root in self._roots:
            below = root.casefold().rstrip(os.sep) + os.sep
            if folded.startswith(below) and (found is None or len(root) > len(found)):
                found = root
        return found

    def _allowed(self, real: str) -> bool:
        """Whether `real`, with links resolved, is below one of the folders."""
        real = os.path.normcase(real)
        return any(real.startswith(os.path.normcase(root).rstrip(os.sep) + os.sep) for root in self._roots)

    def _follow(self, root: str, parts: list[str]) -> str | None:
        """The file below `root` with the path `parts`, in any case.  Raises Refused for a link that leads outside."""
        path = root
        for part in parts:
            if not self._allowed(os.path.join(os.path.realpath(path), part)):
                raise Refused(f"{path} is a link that leaves the include path: name its folder with -I FOLDER")
            exact, folded = self._listing(path)
            found = part if part in exact else folded.get(part.casefold())
            if found is None:
                return None
            path = os.path.join(path, found)
        return path

    def _listing(self, folder: str) -> tuple[set[str], dict[str, str]]:
        """The names in `folder`; and each name in lower case -> the name itself."""
        if (names := self._listings.get(folder)) is None:
            try:
                listed = sorted(os.listdir(folder), reverse=True)
            except OSError:
                listed = []
            names = self._listings[folder] = set(listed), {name.casefold(): name for name in listed}
        return names

    def _open(self, real: str, shown: str) -> SourceText:
        if (known := self._read.get(real)) is not None:
            return known
        try:
            if not stat.S_ISREG(os.lstat(real).st_mode):
                raise Refused(f"{shown} is not a regular file")
            with open(os.open(real, _FLAGS), "rb") as file:
                if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
                    raise Refused(f"{shown} is not a regular file")
                data = file.read(self._file_bytes + 1)
        except OSError as error:
            raise Refused(f"{shown} cannot be read: {error.strerror}") from None
        if len(data) > self._file_bytes:
            raise Refused(f"{shown} has more than {self._file_bytes:,} bytes")
        if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            raise Refused(f"{shown} is UTF-16: save it as UTF-8")
        try:
            text = data.decode()
        except UnicodeDecodeError:
            text = data.decode("latin-1")
        source = self._read[real] = SourceText(shown, text, os.path.dirname(real))
        return source

    @property
    def files(self) -> dict[str, SourceText]:
        """Every file that was read: resolved path -> source."""
        return dict(self._read)
