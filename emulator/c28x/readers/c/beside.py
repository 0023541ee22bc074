"""C files that lie beside headers, as those of driverlib do: which of them defines a function.

Looked into are the folders of `-I`, and `source` beside one called `include`: a function that a program uses and no
file of it defines is taken from there, as a linker takes it from a library.  Here the files are only searched for the
beginnings of functions; what they say is read by the reader.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

#: A larger file is no driver.
_LARGEST_BYTES: Final = 2_000_000
_SKIPPED: Final = re.compile(
    r"""//[^\n]*|/\*.*?(?:\*/|\Z)|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'|^[ \t]*\#(?:\\\n|[^\n])*""",
    re.DOTALL | re.MULTILINE,
)
#: Nothing is tried twice, however long a name is or how many parentheses stand open.
_HEAD: Final = re.compile(r"\b(\w++)\s*+\([^(){};]*+(?:\([^(){};]*+\)[^(){};]*+)*+\)\s*+$")


class Beside:
    """The C files of some folders by the functions that they define; read when first asked."""

    def __init__(self, folders: Iterable[str | Path]) -> None:
        self._folders = [Path(folder) for folder in folders]
        self._found: dict[str, Path] | None = None

    @property
    def folders(self) -> list[Path]:
        """Where C files are sought: a change of what lies there may change a program."""
        sources = [folder.parent / "source" for folder in self._folders if folder.name == "include"]
        return [*self._folders, *(folder for folder in sources if folder.is_dir())]

    def file(self, function: str) -> Path | None:
        """The file that defines a function; None: there is none.  Of several it is the first by folder and name."""
        if self._found is None:
            self._found = {}
            for path in self._files():
                names = list(functions(path.read_text(encoding="latin-1")))
                if "main" not in names:  # another program, which is no library
                    for name in names:
                        self._found.setdefault(name, path)
        return self._found.get(function)

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
