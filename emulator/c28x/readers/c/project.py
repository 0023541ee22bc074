"""The include folders and macros of a Code Composer project, from its `.cproject`.

    project = read(Path("lab3/.cproject"))
    Program(names, include=project.include, defines=project.defines)

The file is XML of Eclipse CDT.  Compiler options contain `<listOptionValue value="...">`: folders if the name of the
option contains INCLUDE_PATH, macros if it contains DEFINE.  A project has several configurations (Debug, Release); the
first one with any values is used.  Values may contain `${NAME}`: only variables for the project's own folder are known.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final
from xml.etree import ElementTree

#: The name of the file, the same in every project.
NAME: Final = ".cproject"
#: CHOICE: project files have some tens of kilobytes; a larger file is not one.
LARGEST_BYTES: Final = 2_000_000
_VARIABLE: Final = re.compile(r"\$\{([^}]*)\}")
#: Variables that name the folder of the project.
_ROOTS: Final = ("PROJECT_ROOT", "PROJECT_LOC", "ProjDirPath", "project_loc")
_DEFINE: Final = re.compile(r"[A-Za-z_]\w*(\(\w*\))?(=.*)?", re.ASCII | re.DOTALL)


@dataclass(frozen=True)
class CcsProject:
    """Folders and macros in their order.  `notes`: what was left out and why, one line each."""

    include: tuple[str, ...] = ()
    defines: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def read(path: Path) -> CcsProject:
    """Read a `.cproject`.

    Raises ValueError, in one line, for a file that is not one: not regular, too large, not XML, or with a DOCTYPE
    (which could define entities).  Raises OSError if it cannot be read.
    """
    if not path.is_file():
        raise ValueError(f"{path}: there is no such file")
    with path.open("rb") as file:
        data = file.read(LARGEST_BYTES + 1)
    if len(data) > LARGEST_BYTES:
        raise ValueError(f"{path}: no project of Code Composer has more than {LARGEST_BYTES:,} bytes")
    try:
        root = _parse(data)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise ValueError(f"{path}: not a project of Code Composer: {error}") from None
    for configuration in root.iter("cconfiguration"):
        found = _settings(configuration, path)
        if found != CcsProject():
            return found
    return _settings(root, path)


class _ProjectTreeBuilder(ElementTree.TreeBuilder):
    """Builds the tree; rejects a DOCTYPE, because it can define entities."""

    def doctype(self, name: str, pubid: str | None, system: str | None) -> None:
        """Called for a DOCTYPE, which no project has."""
        raise ValueError(f"a DOCTYPE ({name}) is not read")


def _parse(data: bytes) -> ElementTree.Element:
    parser = ElementTree.XMLParser(target=_ProjectTreeBuilder())
    parser.feed(data)
    root: ElementTree.Element = parser.close()
    return root


def _settings(element: ElementTree.Element, path: Path) -> CcsProject:
    include: dict[str, None] = {}
    defines: dict[str, None] = {}
    notes: dict[str, None] = {}
    for option in element.iter("option"):
        kind = f"{option.get('superClass', '')} {option.get('id', '')} {option.get('valueType', '')}".upper()
        is_folder = "INCLUDE_PATH" in kind or "INCLUDEPATH" in kind
        if not is_folder and "DEFINE" not in kind:
            continue
        for entry in option.iter("listOptionValue"):
            value = entry.get("value", "").strip().strip('"').strip()
            if not value:
                continue
            if is_folder:
                _folder(value, path, include, notes)
            elif _VARIABLE.search(value) or not _DEFINE.fullmatch(value):
                notes[f"{path}: macro {value!r} is left out"] = None
            else:
                defines[value] = None
    return CcsProject(tuple(include), tuple(defines), tuple(notes))


def _folder(value: str, path: Path, include: dict[str, None], notes: dict[str, None]) -> None:
    """Add the folder that `value` names to `include`, or the reason why it is left out to `notes`."""
    here = path.resolve().parent
    unknown: list[str] = []

    def known(match: re.Match[str]) -> str:
        name = match[1]
        own = name in _ROOTS or (name.startswith("workspace_loc:") and name.rstrip("/").endswith("${ProjName"))
        if not own and not (name.startswith("workspace_loc:/") and _below(name, here)):
            unknown.append(name)
            return ""
        return str(here) if own else _below(name, here)

    # The project's name can be inside of another variable: ${workspace_loc:/${ProjName}/include}.
    text = value.replace("${ProjName}", here.name)
    folder = _VARIABLE.sub(known, text).replace("\\", "/")
    if unknown:
        notes[f"{path}: include folder {value!r} is left out: ${{{unknown[0]}}} is not known here"] = None
        return
    resolved = here / folder
    if not resolved.is_dir():
        notes[f"{path}: include folder {value!r} is left out: there is no {resolved}"] = None
        return
    include[str(resolved)] = None


def _below(name: str, here: Path) -> str:
    """The folder of a `workspace_loc:/PROJECT/...` in this project; empty for a folder of another project."""
    project, _, rest = name.removeprefix("workspace_loc:/").partition("/")
    return str(here / rest) if project == here.name else ""
