"""The page of what is modelled and what is not: what each module says of itself in its first lines."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from importlib.resources import files
from importlib.resources.abc import Traversable
from itertools import zip_longest
from types import MappingProxyType
from typing import Final

from emulator.blocks import UNMODELLED

#: Where such modules are, by the title of the section.
FOLDERS: Final[Mapping[str, tuple[str, str]]] = MappingProxyType({
    "Peripherals of the chip": ("emulator", "peripherals"),
    "Parts around the chip": ("emulator", "devices"),
    "Kernel": ("emulator", "sysbios"),
    "The C library": ("emulator", "c28x"),
    "The world": ("hil", "world"),
})
#: What a module says begins with one of these words, and ends with the next.
_WORDS: Final = ("Modelled", "Not modelled", "Reported", "Reported as well", "Time", "Sources", "CHOICE")
_HEAD: Final = re.compile(rf"^({'|'.join(sorted(_WORDS, key=len, reverse=True))})(?:: *|$)", re.MULTILINE)

_BEGIN: Final = """# Modelled, and not modelled

What the modules of the emulator say of themselves. Where firmware uses something that is not modelled, it is told by a
finding of the rule `unmodelled`, or of one that names the thing; nothing is ignored in silence. What of C is understood
stands in [the language](language.md), what the manual and data sheets leave open at each `CHOICE:` in the sources.

Nothing is modelled of the blocks below: a register of one holds what is written to it, and touching it is told.

"""


def page() -> str:
    """The page as Markdown."""
    blocks = ", ".join(f"`{name}`" for name in sorted(UNMODELLED))
    return f"{_BEGIN}{blocks}.\n" + "".join(_section(title, *folder) for title, folder in FOLDERS.items())


def _section(title: str, package: str, folder: str) -> str:
    parts = [f"\n## {title}\n"]
    for module, text in docstrings(files(package) / folder):
        said = statements(text)
        if "Modelled" not in said and "Not modelled" not in said:
            continue
        first = text.partition("\n\n")[0].replace("\n", " ").rstrip(".")
        parts.append(f"\n### {module}\n\n{first}.\n")
        parts += [f"\n**{word}:** {said[word]}\n" for word in ("Modelled", "Not modelled", "Time") if word in said]
    return "".join(parts)


def docstrings(folder: Traversable) -> Iterator[tuple[str, str]]:
    """The modules of a folder by name, each with its docstring; no module is imported."""
    for file in sorted(folder.iterdir(), key=lambda file: file.name):
        if file.name.endswith(".py") and file.name != "__init__.py":
            text = ast.get_docstring(ast.parse(file.read_text(encoding="utf-8")))
            if text:
                yield file.name.removesuffix(".py"), text


def statements(docstring: str) -> dict[str, str]:
    """What a docstring says under "Modelled", "Not modelled" and "Time", each as one paragraph."""
    found: dict[str, str] = {}
    marks = [*_HEAD.finditer(docstring)]
    for mark, after in zip_longest(marks, marks[1:]):
        text = docstring[mark.end() : after.start() if after else len(docstring)]
        # A blank line ends it, but behind a title that stands alone.
        text = text.strip().partition("\n\n")[0]
        found.setdefault(mark[1], " ".join(text.split()))
    return found
