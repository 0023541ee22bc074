"""C files beside headers, such as those of driverlib: which of them defines a function or an object.

If a program uses a name that none of its files defines, it is taken from such a file, as a linker takes it from a
library.  The search covers the folders of `-I`, and a folder `source` beside one called `include`.  This module only
finds where functions and objects of a file begin; the C reader reads the files.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

#: Larger files are skipped: they are not drivers.
_LARGEST_BYTES: Final = 2_000_000
_SKIPPED: Final = re.compile(
    r"""//[^\n]*|/\*.*?(?:\*/|\Z)|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'|^[ \t]*\#(?:\\\n|[^\n])*""",
    re.DOTALL | re.MULTILINE,
)
#: Possessive, so that it never backtracks, however long a name is or however many parentheses are open.
_HEAD: Final = re.compile(r"\b(\w++)\s*+\([^(){};]*+(?:\([^(){};]*+\)[^(){};]*+)*+\)\s*+$")
#: What stands before the `=` or the `;` of a definition: type, name, lengths.
_OBJECT: Final = re.compile(r"\b(\w++)\s*+(?:\[[^][]*+\]\s*+)*+$")
#: The first words of what is no definition of an object that other files can use.
_NO_OBJECT: Final = frozenset({"extern", "static", "typedef"})
_TAGGED: Final = frozenset({"struct", "union", "enum"})


class NeighbourFiles:
    """The C files of some folders, by the names that they define.  They are read at the first request."""

    def __init__(self, folders: Iterable[str | Path]) -> None:
        self._folders = [Path(folder) for folder in folders]
        self._found: dict[str, Path] | None = None

    @property
    def folders(self) -> list[Path]:
        """The folders that are searched: a change in them may change a program."""
        sources = [folder.parent / "source" for folder in self._folders if folder.name == "include"]
        return [*self._folders, *(folder for folder in sources if folder.is_dir())]

    def file(self, name: str) -> Path | None:
        """The file that defines a name; None: there is none.  Of several, it is the first by folder and name."""
        if self._found is None:
            self._found = {}
            for path in self._files():
                text = path.read_text(encoding="latin-1")
                names = list(functions(text))
                if "main" not in names:  # it is another program, not a library
                    for defined in (*names, *objects(text)):
                        self._found.setdefault(defined, path)
        return self._found.get(name)

    def _files(self) -> Iterator[Path]:
        for folder in self.folders:
            here = folder.resolve()
            for path in sorted(folder.iterdir() if folder.is_dir() else ()):
                real = path.resolve()
                mine = path.suffix.lower() == ".c" and real.parent == here and real.is_file()
                if mine and real.stat().st_size <= _LARGEST_BYTES:
                    yield real


def functions(text: str) -> Iterator[str]:
    """The names before `(...) {` outside of all braces."""
    depth, begun = 0, 0
    plain = _SKIPPED.sub(" ", text)
    for brace in re.finditer(r"[{};]", plain):
        if brace[0] == "{":
            head = _HEAD.search(plain, begun, brace.start()) if depth == 0 else None
            if head is not None:
                yield head[1]
            depth += 1
        elif brace[0] == "}":
            depth = max(depth - 1, 0)
        begun = brace.end() if depth == 0 else begun


def objects(text: str) -> Iterator[str]:
    """The names before `= ...;` or `;` outside of all braces that other files can use; of several in one, the first."""
    depth, begun, initialised = 0, 0, False
    plain = _SKIPPED.sub(" ", text)
    for mark in re.finditer(r"[{};=]", plain):
        if depth == 0 and mark[0] in ";=" and not initialised:
            words = plain[begun : mark.start()].split(",")[0]
            name = _OBJECT.search(words)
            before = words[: name.start()].split() if name is not None else []
            typed = bool(before) and before[0] not in _NO_OBJECT and before[-1] not in _TAGGED
            if name is not None and typed and "(" not in words and not name[1][0].isdigit():
                yield name[1]
        if mark[0] == "=":
            initialised = depth == 0 or initialised
            continue
        depth = max(depth + (mark[0] == "{") - (mark[0] == "}"), 0)
        if depth == 0 and (mark[0] == ";" or not initialised):
            begun, initialised = mark.end(), False
