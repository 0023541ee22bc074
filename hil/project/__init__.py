"""A project for a driver of one's own: C or Python, a board, tests, and what editor and CI want.

`template` is such a project, and runs as it lies there; `make` writes it under another name.  A name in it, `ranger`,
stands for the user's: in files' names and, as `ranger`, `Ranger` and `RANGER`, in their text.
"""

from __future__ import annotations

import keyword
import re
import shutil
import sys
import tempfile
from importlib.machinery import PathFinder
from importlib.resources import as_file, files
from pathlib import Path
from types import MappingProxyType
from typing import Final

from emulator.c28x.readers.c.parser import KEYWORDS

#: The driver of the template.
_DRIVER: Final = "ranger"
#: What a folder of the template is called in a project: a package does not carry hidden files.
_HIDDEN: Final = MappingProxyType({"vscode": ".vscode", "github": ".github", "gitignore": ".gitignore"})
#: Files that are there in one of the languages only.
_OF_LANGUAGE: Final = MappingProxyType({"ranger.c": "c", "ranger.h": "c", "ranger.py": "python"})
LANGUAGES: Final = ("c", "python")
_NAME: Final = re.compile(r"[a-z][a-z0-9_]{0,30}")
#: Modules of the project and of its tests, and headers of the C library.
_TAKEN: Final = frozenset({
    "board", "main", "pytest", "hil", "emulator",
    "assert", "ctype", "errno", "float", "limits", "locale", "math", "setjmp", "signal", "stdarg", "stdbool", "stddef",
    "stdint", "stdio", "stdlib", "string", "time",
})  # fmt: skip


def make(folder: Path, language: str = "c") -> list[Path]:
    """Write a project into a new or empty folder; its last part names the driver.  Returns the files, by name.

    Raises ValueError, with nothing written, for a name that C cannot have, or a folder in use.
    """
    name = folder.name.replace("-", "_")
    if not _NAME.fullmatch(name):
        raise ValueError(f"{folder.name!r}: expected a name of small letters, digits and - or _, as in pressure-sensor")
    if keyword.iskeyword(name) or name in KEYWORDS or name in _TAKEN or name.startswith("test_"):
        raise ValueError(f"{folder.name!r} means something already, to C, Python or the project: expected another name")
    if language == "python" and _shadows(name):
        raise ValueError(f"{folder.name!r} is a module of Python or of an installed package: expected another name")
    if language not in LANGUAGES:
        raise ValueError(f"no language {language!r}: {' or '.join(LANGUAGES)}")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise ValueError(f"{folder} is there already, and not empty: nothing was written")
    try:
        return _write(folder, name, language)
    except OSError as error:
        raise ValueError(f"{folder}: nothing was written: {error.strerror or error}") from error


def _shadows(name: str) -> bool:
    """Whether a module `name` of a test's folder would hide one that Python or a package imports by that name."""
    installed = [entry for entry in sys.path if Path(entry).resolve() != Path.cwd()]
    return name in sys.stdlib_module_names or PathFinder.find_spec(name, installed) is not None


def _write(folder: Path, name: str, language: str) -> list[Path]:
    folder.parent.mkdir(parents=True, exist_ok=True)
    # Beside the folder, which comes to be with all files or not at all.
    with tempfile.TemporaryDirectory(dir=folder.parent, prefix=f".{folder.name}-") as made:
        project = Path(made, folder.name)
        with as_file(files(__package__).joinpath("template")) as template:
            for source in sorted(path for path in template.rglob("*") if path.is_file()):
                inside = source.relative_to(template)
                if "__pycache__" in inside.parts or _OF_LANGUAGE.get(str(inside), language) != language:
                    continue
                target = project.joinpath(*(_HIDDEN.get(part, _named(part, name)) for part in inside.parts))
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_text(_text(source.read_text(encoding="utf-8"), name, language), encoding="utf-8")
        if folder.exists():
            folder.rmdir()
        shutil.move(project, folder)
    return sorted(path for path in folder.rglob("*") if path.is_file())


def _named(text: str, name: str) -> str:
    """The text with the user's name in the place of the template's, however it is written there."""
    camel = "".join(part.capitalize() for part in name.split("_"))
    text = text.replace("RangerBoard", f"{camel}Board").replace("Ranger", name.capitalize())
    return text.replace(_DRIVER.upper(), name.upper()).replace(_DRIVER, name)


def _text(text: str, name: str, language: str) -> str:
    if language == "python":
        text = text.replace('firmware("ranger.c")', 'firmware("ranger.py")')
        text = text.replace("`ranger.c`, `ranger.h`", "`ranger.py`").replace("c2000-hil[c]", "c2000-hil")
    return _named(text, name)
